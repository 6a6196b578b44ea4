#pragma once
/// What steps rigid bodies that turn ask for.

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace noether {

/// The fastest turn of a scene, by the rates at the start.
struct TurningSteps {
  double period = 0;                          ///< of one turn [time]
  std::string body = {};                      ///< that turns so
  std::optional<Rotor> rotor = Rotor::exact;  ///< empty: a method on the group of rotations

  /// A rule and no limit: turns that are not exact have errors as those of leapfrog, which takes 20 steps in a period;
  /// exact ones follow at any step [time].
  std::optional<double> recommended() const {
    return rotor == Rotor::exact ? std::nullopt : std::optional(period / 20);
  }
  /// About where the discrete body has no turn any more, h |Omega| = 1 [time].
  std::optional<double> limit() const;
};

/// By the rotor of the scene's method. @return empty where no body turns
std::optional<TurningSteps> turning_steps(const Scene& scene);

}  // namespace noether
