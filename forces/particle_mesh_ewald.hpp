#pragma once
/// Charges in a periodic box by smooth particle mesh Ewald.

#include "forces/ewald.hpp"
#include "forces/pair_precision.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace noether {

namespace detail {
struct MeshLayout;
}

/// What a mesh was laid for, and how.
struct ChosenMesh {
  double alpha = 0;  ///< [1/length]
  int order = 0;
  std::array<std::int64_t, 3> points{};
  double error = 0;     ///< of forces by waves, as relative_error
  double rounding = 0;  ///< of forces in single precision, at most; 0 in doubles
};

/// Ewald's sum with its waves on a mesh: charges are spread by B-splines, transformed, and the potential is gathered by
/// the same splines, so that forces are exact slopes of the energy of the mesh. Their sum is not exactly 0.
///
/// What is not of the waves is that of Ewald, their kicks and what goes with them too. Unless they are given, alpha
/// follows from the cutoff and the error asked for (`SplitErrors`), and of the orders, each with the spacing that has
/// this error (`mesh_error`), the one that takes the least time (`mesh_work`). Charges are spread in whole units: bits
/// depend on no thread, and on no order of particles. In 113 bits it is Ewald's sum itself. In mixed precision the mesh
/// of forces is in single precision, and what it loses is bounded
/// (`single_precision_error`); energies and virials are those of doubles.
/// @cost O(n) at a given density, and the transforms: O(n log n)
/// @source EssmannPereraBerkowitzDardenLeePedersen1995, KolafaPerram1992
struct ParticleMeshEwald {
  double cutoff = 0;                          ///< of the near part [length]
  double relative_error = 1e-5;               ///< asked of forces
  std::optional<std::int64_t> order = {};     ///< of the splines
  std::optional<double> alpha = {};           ///< [1/length]
  std::optional<double> mesh_spacing = {};    ///< [length]
  std::optional<std::string> wave_kick = {};  ///< letter of the kicks by the waves; empty: that of the near part
  PairPrecision precision = PairPrecision::full;

  static constexpr auto describe() {
    return part<ParticleMeshEwald>(
        "particle_mesh_ewald", "charges and all their images in a periodic box, with their waves on a mesh",
        formula("that of Ewald's sum, with sum q exp(i k.x) from charges that B-splines spread over a mesh"),
        source("EssmannPereraBerkowitzDardenLeePedersen1995, KolafaPerram1992"),
        field<&ParticleMeshEwald::cutoff>("cutoff", "length", "where the near part of the pairs ends")
            .required("\"0.9 nm\""),
        field<&ParticleMeshEwald::relative_error>(
            "relative_error", "1",
            "root mean square error of forces, of that between two typical charges as far apart as neighbors: C <q^2> "
            "(n/V)^(2/3)"),
        field<&ParticleMeshEwald::order>("order", "1",
                                         "of the splines, 4 to 8; default: with which the mesh takes the least time"),
        field<&ParticleMeshEwald::alpha>("alpha", "1/length",
                                         "where 1/r is split; default: from cutoff and relative_error"),
        field<&ParticleMeshEwald::mesh_spacing>("mesh_spacing", "length",
                                                "widest distance of the points of the mesh; default: from alpha, order "
                                                "and relative_error"),
        field<&ParticleMeshEwald::wave_kick>(
            "wave_kick", "1",
            "letter of the kicks by the waves, for multiple time steps; default: that of the near "
            "part"),
        field<&ParticleMeshEwald::precision>("precision", "1", "mixed: forces in single precision"));
  }
  static constexpr std::string_view only_once = detail::charges_once;
  ForceClaims claims() const {
    return {.keeps_momentum = false,
            .keeps_angular_momentum = false,
            .periodic = true,
            .charges = true,
            .exclusions = true,
            .kicks = detail::kicks_of_split(wave_kick),
            .range = cutoff};
  }
  /// @throws Error  for a cutoff, an error, an order, an alpha or a spacing that are none
  void check() const;
  /// @throws Error  also without a box or charges, and for a mesh that no memory holds
  void check(const ParticleSystem<double>& s) const;

  /// @cost the first call of a thread, and the first one in a box, allocate
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const;

  /// The mesh that it takes for these particles; empty without charges.
  std::optional<ChosenMesh> chosen_for(const ParticleSystem<double>& s) const;

  /// The same sum without a mesh, for truth: right to 1e-13, or with the alpha that is given.
  Ewald reference() const;

  /// The mesh for so many charges in the box of these particles, and its alpha.
  detail::MeshLayout layout_for(const ParticleSystem<double>& s, Index charged) const;
};

namespace detail {  // compiled once, in particle_mesh_ewald.cpp

extern template struct ForceModel<ParticleMeshEwald, double>;

}  // namespace detail

}  // namespace noether
