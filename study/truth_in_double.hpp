#pragma once
/// The reference of a scene that is too large, or written for doubles only: in double precision.

#include "study/position_error.hpp"
#include "study/sampling.hpp"
#include "study/truth.hpp"

namespace noether {

/// More particles than these have no reference.
inline constexpr Index most_particles = 20'000;

/// States by the same forces in double precision, by dop853 with tolerances down to 1e-14, or where that cannot serve
/// by a composition of order 8, or the scene's own method, with steps that are halved; its error is the distance
/// between the two finest runs that fit the budget. The kind is `invariants` where two do not, or they differ by 1e-3
/// or more.
Truth truth_in_double(const Scene& scene, const Sampling& sampling, const TruthOptions& options, PositionError& error);

}  // namespace noether
