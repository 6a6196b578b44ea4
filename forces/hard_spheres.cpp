#include "forces/hard_spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

void HardSpheres::check() const {
  if (!(restitution >= 0 && restitution <= 1))
    refuse_field("restitution", restitution, "is not a coefficient of restitution; a number from 0 to 1 is expected");
  if (!(restitution_exponent <= 0) || !std::isfinite(restitution_exponent)) {
    refuse_field("restitution_exponent", restitution_exponent,
                 "would let faster spheres rebound better; 0 (a constant coefficient) or less is expected");
  }
  if (restitution_speed && (!(*restitution_speed > 0) || !std::isfinite(*restitution_speed)))
    refuse_field("restitution_speed", *restitution_speed, "is not a valid speed; a number above 0 is expected");
  if (restitution_exponent != 0 && !restitution_speed) {
    refuse_field("restitution_exponent", restitution_exponent,
                 "needs the speed at which the coefficient is restitution; give restitution_speed");
  }
  if (minimum_rebound && (!(*minimum_rebound > 0) || !std::isfinite(*minimum_rebound))) {
    refuse_field("minimum_rebound", *minimum_rebound,
                 "would let spheres touch infinitely often in a finite time; a number above 0 is expected");
  }
}

template <class Real> void HardSpheres::check(const ParticleSystem<Real>& s) const {
  bool any = false;
  for (Index i = 0; s.template has<BodyRadius>() && i < s.size(); ++i) {
    const auto radius = static_cast<double>(s.template column<BodyRadius>()[i]);
    if (!(radius >= 0) || !std::isfinite(radius))
      throw Error(fmt::format("the radius of '{}' is {}; 0 or more is expected", s.name(i), radius));
    any = any || radius > 0;
  }
  if (!any) throw Error("no particle is a sphere; give at least one a radius");
}

double HardSpheres::rebound(double approach, double least) const {
  double epsilon = restitution;
  if (restitution_exponent != 0)
    epsilon = std::min(1.0, restitution * std::pow(approach / restitution_speed.value_or(1), restitution_exponent));
  return std::max(epsilon * approach, minimum_rebound.value_or(least));
}

template void HardSpheres::check(const ParticleSystem<double>&) const;
template void HardSpheres::check(const ParticleSystem<Quad>&) const;

}  // namespace noether
