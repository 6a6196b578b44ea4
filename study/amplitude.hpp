#pragma once
/// How large a state is: what stays bounded, or does not.

#include "engine/moments.hpp"
#include "engine/sums.hpp"
#include "study/position_error.hpp"

#include <cmath>

namespace noether {

/// The size of a state, positions weighed against velocities by a frequency [1/time].
///
///     A^2 = sum over particles of |v - V|^2 + omega^2 |x - X|^2
///
/// about the centre of mass, where the forces keep it moving straight, else about the origin; of a system, A = |y|.
class Amplitude {
 public:
  Amplitude(const Scene& scene, double frequency) : frequency_(frequency), about_center_(about_center(scene)) {}

  double operator()(const ParticleSystem<double>& s) const {
    if (s.size() == 0) {
      double squares = 0;
      for (const double y : s.variables()) squares += y * y;
      return std::sqrt(squares);
    }
    Vec3<double> X = Vec3<double>::Zero(), V = Vec3<double>::Zero();
    if (about_center_) center(s, X, V);
    return std::sqrt(sum_over<double>(s.size(), [&](Index i) {
      const Vec3<double> x = s.positions()[i] - X, v = s.velocities()[i] - V;
      return norm2(v) + frequency_ * frequency_ * norm2(x);
    }));
  }

 private:
  static void center(const ParticleSystem<double>& s, Vec3<double>& X, Vec3<double>& V) {
    const double mass = sum_over<double>(s.size(), [&](Index i) { return s.masses()[i]; });
    if (!(mass > 0)) return;
    X = rounded(weighted_sum(s, s.positions())) / mass;
    V = rounded(weighted_sum(s, s.velocities())) / mass;
  }

  double frequency_;
  bool about_center_;
};

}  // namespace noether
