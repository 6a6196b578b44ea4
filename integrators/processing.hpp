#pragma once
/// Schemes with words around the run: symplectic correctors, and the kernels that they make more of.

#include "integrators/composition_options.hpp"
#include "integrators/scheme.hpp"

namespace noether {

/// A scheme as the options have it walked: with the word of a corrector before the run and its inverse on copies shown
/// to users, and with another kernel in the place of the plain step.
///
/// Correctors and kernels are made for a drift, a kick and a drift (`verlet_aba`); `verlet`, kick first, is the
/// same map between other points, so that with either option it is walked as `verlet_aba`. `saba_1` to `saba_4` with
/// the modified kernel have the gradient of their kicks at both ends.
/// @throws SchemeMismatch  for an order that no corrector has, and a scheme that has none
Scheme processed(const Scheme& scheme, const CompositionOptions& options);

}  // namespace noether
