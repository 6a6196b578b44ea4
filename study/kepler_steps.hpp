#pragma once
/// What is known in closed form of steps along Kepler arcs: where they resonate, and what passages they must resolve.

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace noether {

/// The fastest Kepler orbits of a scene, by the osculating elements at the start: about its first body, and of moons
/// about theirs.
struct KeplerSteps {
  double period = 0;  ///< the shortest about the first body, 2 pi sqrt(a^3 / mu); 0 where no orbit is closed [time]
  std::string period_of = {};  ///< the body's name
  /// Of the fastest passage of a pericenter: one turn at the angular speed there, 2 pi sqrt(q^3 / (mu (1 + e))) [time].
  /// Moons count, which no Kepler arc follows: what is bound to another body and within its Hill radius.
  double passage = 0;
  std::string passage_of = {};  ///< the body's name, or "Moon about Earth"

  static constexpr int resonances = 6;  ///< those that are told, n = 1 to 6

  /// The step that goes n times into the shortest period: kicks meet the body where they did before [time].
  /// @source WisdomHolman1992
  double resonance(int n) const { return period / n; }

  /// A rule and no limit: 16 to 20 steps resolve the fastest passage. On an eccentric orbit the resonances of longer
  /// steps overlap, and what moves on it becomes chaotic [time].
  /// @source RauchHolman1999
  double longest() const { return passage / 16; }
  double recommended() const { return passage / 20; }
};

/// @return empty without gravity, and where nothing moves about the first body
std::optional<KeplerSteps> kepler_steps(const Scene& scene);

}  // namespace noether
