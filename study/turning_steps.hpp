#pragma once
/// What steps rigid bodies that turn ask for.

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace noether {

/// The fastest turn of a scene, by the rates at the start.
struct TurningSteps {
  double period = 0;      ///< of one turn [time]
  std::string body = {};  ///< that turns so
  bool by_axes = false;   ///< turns are maps of order 2, not exact

  /// A rule and no limit: turns axis by axis have the errors of leapfrog, which takes 20 steps in a period; exact ones
  /// follow at any step [time].
  std::optional<double> recommended() const { return by_axes ? std::optional(period / 20) : std::nullopt; }
};

/// @return empty where no body turns
std::optional<TurningSteps> turning_steps(const Scene& scene);

}  // namespace noether
