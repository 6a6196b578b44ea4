#pragma once
/// Where methods become unstable on the oscillator.

#include "study/known_method.hpp"

#include <optional>

namespace noether {

/// Where a method becomes unstable on the oscillator.
struct StabilityLimit {
  double z =
      0;  ///< first unstable h omega, to 2e-4 (5 % of an iteration); 0: at every step, infinity: nowhere up to 12
  bool of_iteration = false;  ///< beyond it a step is not unstable, but cannot be made
};

/// First h omega at which the oscillator grows by more than 1e-15 a step: by the matrix of one step where a step is a
/// map; else by a run whose start is disturbed, and by the growth of what remains once the disturbance has decayed.
/// Empty for methods without steps of one length.
std::optional<StabilityLimit> stability_limit_of(const KnownMethod& known);

}  // namespace noether
