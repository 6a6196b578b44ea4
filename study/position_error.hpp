#pragma once
/// How far positions are from the truth.

#include "engine/particle_system.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace noether {

/// How positions (or the variables of a first-order system) are compared: over all bodies about the centre of mass,
/// where the equations keep it moving straight, relative to |x*|; a single body, and bodies in an outer field, are
/// compared where they stand, relative to the rms of |x*| over the moments, since x* may pass through 0. Of rigid
/// bodies the error is the angle [rad] by which the worst one is turned from the truth, where that is larger.
class PositionError {
 public:
  PositionError(const ParticleSystem<double>& particles, bool about_center);

  /// Takes the sizes of all truth states. @param y  as in `Truth`
  void set_scale(const std::vector<Vector<Quad>>& y);
  /// norm(x - x*) / norm(x*), or the angle; of a first-order system, once it knows their sizes, the root mean square
  /// over the variables of each one's error, relative to the largest it ever is: a trace of 1e-5 counts as much as what
  /// is whole.
  /// @param y, truth  shape (size of the state)
  double operator()(const Vector<Quad>& y, const Vector<Quad>& truth) const;
  /// norm(x), of what is compared.
  double size(const Vector<Quad>& y) const;
  /// Whether some of the particles are rigid bodies.
  bool any_turns() const { return any_turns_; }
  /// The angle by which the worst of the bodies is turned from the truth [rad].
  /// @param y, truth  shape (10 n), as `state_of` has them
  double turned_apart(const Vector<Quad>& y, const Vector<Quad>& truth) const;

 private:
  std::vector<Quad> positions(const Vector<Quad>& y) const;
  double moved_apart(const Vector<Quad>& y, const Vector<Quad>& truth) const;

  std::vector<Quad> masses_;
  bool about_center_ = false;
  bool any_turns_ = false;
  double scale_ = 0;           ///< 0: relative to |x*| of the moment
  std::vector<double> sizes_;  ///< of the variables of a first-order system: largest |y*|
};

/// Whether positions of a scene are compared about the centre of mass.
bool about_center(const Scene& scene);

}  // namespace noether
