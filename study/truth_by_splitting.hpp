#pragma once
/// The reference of a scene whose Hamiltonian moves more than positions and velocities.

#include "study/position_error.hpp"
#include "study/sampling.hpp"
#include "study/truth.hpp"
#include "study/wide_scene.hpp"

namespace noether {

/// States of the splitting itself in extended precision, along two compositions of order 10 whose steps are halved
/// until both agree to rounding in double precision, or the budget is spent.
/// @param wide  with a splitting
/// @param error  how states are compared
Truth truth_by_splitting(const WideScene& wide, const Sampling& sampling, const TruthOptions& options,
                         PositionError& error);

}  // namespace noether
