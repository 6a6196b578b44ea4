#pragma once
/// What steps of a shearing sheet have to resolve. Its epicycles and the contacts of its spheres are exact at any step.

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace noether {

/// The fastest times of a scene in a turning frame, at the start; 0 where there are none.
struct SheetSteps {
  double turn = 0;     ///< of the frame, 2 pi/Omega [time]
  bool kicks = false;  ///< whether forces act: without them every step is right
  /// The shortest turn at the surface of a sphere, 2 pi sqrt(r^3/(G m)): no two spheres go about each other faster
  /// [time].
  double surface = 0;
  std::string surface_of = {};
  /// The shortest time in which a sphere goes as far as its diameter, by its velocity about the shear [time].
  double crossing = 0;
  std::string crossing_of = {};

  /// A rule and no limit: between two kicks a hundredth of a turn of the frame, a twentieth of one at a surface, and no
  /// sphere further than its radius.
  std::optional<double> recommended() const;
  /// What that resolves: "a hundredth of a turn of the frame".
  std::string reason() const;
};

/// @return empty for other scenes than those in a turning frame
std::optional<SheetSteps> sheet_steps(const Scene& scene);

}  // namespace noether
