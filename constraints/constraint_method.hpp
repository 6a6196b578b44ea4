#pragma once
/// The solvers of constraints: which there are, what scenes call them, how they are made.

#include "engine/description.hpp"
#include "numbers/real.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

namespace noether {

/// How the equations of constraints are solved.
enum class ConstraintMethod : std::uint8_t {
  newton,  ///< all at once, to rounding: sparse factorisations, chord steps, fresh matrices where these are slow
  rattle,  ///< one after the other in sweeps, to a tolerance (SHAKE for positions, RATTLE for velocities)
  settle   ///< rigid molecules of three sites, two of them equal, in closed form
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
  bool to_rounding;                 ///< else to ConstraintOptions::tolerance in at most ConstraintOptions::iterations
  MoleculeKernelsInUse* lanes;      ///< for molecules held by distances alone; null: for no others
  MoleculeKernelsInUse* triangles;  ///< for rigid ones of three sites
  MakeConstraintStages<double>* make;
  MakeConstraintStages<Quad>* make_quad;
};

// Each in the file of its name.
template <class Real>
std::unique_ptr<ConstraintStages<Real>> newton_constraints(const ConstraintEquations<Real>& equations);
template <class Real>
std::unique_ptr<ConstraintStages<Real>> sweep_constraints(const ConstraintEquations<Real>& equations);

// In `molecule_lanes.cpp`.
const MoleculeKernels& newton_in_lanes();
const MoleculeKernels& sweeps_in_lanes();
const MoleculeKernels& triangles_in_lanes();
const MoleculeKernels& settle_in_lanes();

/// Every solver, in the order of ConstraintMethod.
inline constexpr std::array constraint_methods{
    ConstraintMethodInfo{ConstraintMethod::newton, "newton", true, newton_in_lanes, triangles_in_lanes,
                         newton_constraints, newton_constraints},
    ConstraintMethodInfo{ConstraintMethod::rattle, "rattle", false, sweeps_in_lanes, sweeps_in_lanes, sweep_constraints,
                         sweep_constraints},
    ConstraintMethodInfo{ConstraintMethod::settle, "settle", true, nullptr, settle_in_lanes, newton_constraints,
                         newton_constraints},
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
