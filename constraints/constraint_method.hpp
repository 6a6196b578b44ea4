#pragma once
/// The solvers of constraints: which there are, what scenes call them, how they are made.

#include "engine/description.hpp"
#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

namespace noether {

/// How the equations of constraints are solved.
enum class ConstraintMethod : std::uint8_t {
  newton,   ///< all at once, to rounding: sparse factorisations, chord steps, fresh matrices where these are slow
  rattle,   ///< one after the other in sweeps, to a tolerance (SHAKE for positions, RATTLE for velocities)
  settle,   ///< rigid molecules of three sites, two of them equal, in closed form
  m_shake,  ///< molecule by molecule, to rounding: a dense matrix of the moment for each of Newton's steps
  p_shake,  ///< molecule by molecule, to a tolerance: all at once by a matrix that is constant, corrected once
  lincs,    ///< molecule by molecule, by a series of an order, and corrections of lengths by rotation
  p_lincs   ///< the same for all molecules together, by threads that share their constraints
};

/// Where a solver ends.
enum class SolverEnd : std::uint8_t {
  rounding,
  tolerance,  ///< ConstraintOptions::tolerance; a run that needs more than the most iterations ends
  order       ///< after ConstraintOptions::order powers of a series and as many corrections as there are iterations
};

template <class Real> class ConstraintEquations;
template <class Real> class ConstraintStages;

/// Makes a solver for equations that are laid out.
template <class Real>
using MakeConstraintStages = std::unique_ptr<ConstraintStages<Real>>(const ConstraintEquations<Real>&);

struct MoleculeKernels;
/// Kernels of the SIMD level in use.
using MoleculeKernelsInUse = const MoleculeKernels&();

/// A solver of the list.
struct ConstraintMethodInfo {
  ConstraintMethod method;
  std::string_view name;
  SolverEnd end;
  Index iterations = 1000;                ///< as many as it takes unless told otherwise, or makes at most
  bool distances_alone = false;           ///< whether it serves no other constraints
  bool equal_lengths = false;             ///< whether lengths of molecules side by side must be the same within 1 %
  bool direct = false;                    ///< whether it needs no iterations where its closed form has a solution
  MoleculeKernelsInUse* lanes = nullptr;  ///< for molecules held by distances alone; null: for no others than triangles
  MoleculeKernelsInUse* triangles =
      nullptr;  ///< for rigid ones of three sites; null, and `lanes` too: nothing is in lanes
  MakeConstraintStages<double>* make;
  MakeConstraintStages<Quad>* make_quad;  ///< of a run that is the truth for others: never less than these
};

// Each in the file of its name.
template <class Real>
std::unique_ptr<ConstraintStages<Real>> newton_constraints(const ConstraintEquations<Real>& equations);
template <class Real>
std::unique_ptr<ConstraintStages<Real>> sweep_constraints(const ConstraintEquations<Real>& equations);
std::unique_ptr<ConstraintStages<double>> lincs_constraints(const ConstraintEquations<double>& equations);

// In `molecule_lanes.cpp`.
const MoleculeKernels& newton_in_lanes();
const MoleculeKernels& sweeps_in_lanes();
const MoleculeKernels& triangles_in_lanes();
const MoleculeKernels& settle_in_lanes();
const MoleculeKernels& m_shake_in_lanes();
const MoleculeKernels& p_shake_in_lanes();
const MoleculeKernels& lincs_in_lanes();

/// Every solver, in the order of ConstraintMethod.
inline constexpr std::array constraint_methods{
    ConstraintMethodInfo{.method = ConstraintMethod::newton,
                         .name = "newton",
                         .end = SolverEnd::rounding,
                         .lanes = newton_in_lanes,
                         .triangles = triangles_in_lanes,
                         .make = newton_constraints,
                         .make_quad = newton_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::rattle,
                         .name = "rattle",
                         .end = SolverEnd::tolerance,
                         .lanes = sweeps_in_lanes,
                         .triangles = sweeps_in_lanes,
                         .make = sweep_constraints,
                         .make_quad = sweep_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::settle,
                         .name = "settle",
                         .end = SolverEnd::rounding,
                         .direct = true,
                         .triangles = settle_in_lanes,
                         .make = newton_constraints,
                         .make_quad = newton_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::m_shake,
                         .name = "m_shake",
                         .end = SolverEnd::rounding,
                         .lanes = m_shake_in_lanes,
                         .triangles = m_shake_in_lanes,
                         .make = newton_constraints,
                         .make_quad = newton_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::p_shake,
                         .name = "p_shake",
                         .end = SolverEnd::tolerance,
                         .equal_lengths = true,
                         .lanes = p_shake_in_lanes,
                         .triangles = p_shake_in_lanes,
                         .make = newton_constraints,
                         .make_quad = newton_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::lincs,
                         .name = "lincs",
                         .end = SolverEnd::order,
                         .iterations = 1,
                         .distances_alone = true,
                         .lanes = lincs_in_lanes,
                         .triangles = lincs_in_lanes,
                         .make = lincs_constraints,
                         .make_quad = newton_constraints},
    ConstraintMethodInfo{.method = ConstraintMethod::p_lincs,
                         .name = "p_lincs",
                         .end = SolverEnd::order,
                         .iterations = 1,
                         .distances_alone = true,
                         .make = lincs_constraints,
                         .make_quad = newton_constraints},
};

constexpr const ConstraintMethodInfo& info_of(ConstraintMethod method) {
  return constraint_methods[static_cast<std::size_t>(method)];
}

static_assert(
    [] {
      for (std::size_t k = 0; k < constraint_methods.size(); ++k) {
        if (constraint_methods[k].method != static_cast<ConstraintMethod>(k)) return false;
      }
      return true;
    }(),
    "solvers must be in the order of ConstraintMethod");

template <> struct EnumNames<ConstraintMethod> {
  static constexpr auto values = [] {
    std::array<std::pair<ConstraintMethod, std::string_view>, constraint_methods.size()> names{};
    for (std::size_t k = 0; k < names.size(); ++k) {
      names[k].first = constraint_methods[k].method;
      names[k].second = constraint_methods[k].name;
    }
    return names;
  }();
};

}  // namespace noether
