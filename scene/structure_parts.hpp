#pragma once
/// Constraints that find their particles in a structure, as scenes name them.

#include "constraints/structure_constraints.hpp"
#include "engine/description.hpp"

#include <string_view>

namespace noether {

namespace detail {
inline constexpr std::string_view lengths_help =
    "equilibrium: of the kinds of bonds and angles, or the start where they have none; start: all as they start";
}  // namespace detail

/// `bonds` of a scene.
struct RigidBonds {
  static constexpr RigidTerms what = RigidTerms::bonds;
  HeldLengths lengths = HeldLengths::equilibrium;

  static constexpr auto describe() {
    return part<RigidBonds>("bonds", "keeps every bond of the structure at its length", formula("|x_i - x_j| = d_ij"),
                            source("RyckaertCiccottiBerendsen1977"),
                            field<&RigidBonds::lengths>("lengths", "1", detail::lengths_help));
  }
};

/// `hydrogen_bonds` of a scene.
struct RigidHydrogenBonds {
  static constexpr RigidTerms what = RigidTerms::hydrogen_bonds;
  HeldLengths lengths = HeldLengths::equilibrium;

  static constexpr auto describe() {
    return part<RigidHydrogenBonds>("hydrogen_bonds", "keeps every bond of a hydrogen at its length",
                                    formula("|x_i - x_j| = d_ij where i or j is a hydrogen"),
                                    source("RyckaertCiccottiBerendsen1977"),
                                    field<&RigidHydrogenBonds::lengths>("lengths", "1", detail::lengths_help));
  }
};

/// `bonds_and_angles` of a scene.
struct RigidBondsAndAngles {
  static constexpr RigidTerms what = RigidTerms::bonds_and_angles;
  HeldLengths lengths = HeldLengths::equilibrium;

  static constexpr auto describe() {
    return part<RigidBondsAndAngles>(
        "bonds_and_angles", "keeps every bond of the structure at its length, and every angle between two bonds",
        formula("|x_i - x_j| = d_ij,  |x_i - x_k|^2 = d_ij^2 + d_jk^2 - 2 d_ij d_jk cos theta_ijk"),
        source("RyckaertCiccottiBerendsen1977"),
        field<&RigidBondsAndAngles::lengths>("lengths", "1", detail::lengths_help));
  }
};

/// `rigid_molecules` of a scene.
struct RigidMolecules {
  static constexpr RigidTerms what = RigidTerms::molecules;
  HeldLengths lengths = HeldLengths::equilibrium;

  static constexpr auto describe() {
    return part<RigidMolecules>("rigid_molecules", "keeps every molecule of the structure rigid",
                                formula("|x_i - x_j| = d_ij for 1 pair of two particles, 3 of three, 3 N - 6 of N > 3"),
                                source("CiccottiFerrarioRyckaert1982"),
                                field<&RigidMolecules::lengths>("lengths", "1", detail::lengths_help));
  }
};

}  // namespace noether
