#pragma once
/// The search for the reference of a scene.

#include "scene/scene.hpp"
#include "study/sampling.hpp"
#include "study/truth.hpp"

namespace noether {

/// The reference of a scene in extended precision, at the moments of a sampling.
///
/// The method of highest order that is known in extended precision, extrapolation, beside one of another family,
/// Gauss's 8 stages, which is run finer where the two differ by more than rounding in double precision; their
/// difference is the truth's own error bar. Where Gauss's iteration does not get on, as on stiff systems, extrapolation
/// stands beside itself at other tolerances, and the note says so. Where this cannot be had (a force written for
/// doubles only, constraints, a cost beyond the budget, chaos), the kind is `invariants`, and the note says why.
Truth find_truth(const Scene& scene, const Sampling& sampling, const TruthOptions& options = {});

}  // namespace noether
