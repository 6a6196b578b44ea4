#pragma once
/// How large a state is: what stays bounded, or does not.

#include "study/truth.hpp"

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
    double sum = 0;
    if (s.size() == 0) {
      for (const double y : s.variables()) sum += y * y;
      return std::sqrt(sum);
    }
    Vec3<double> X = Vec3<double>::Zero(), V = Vec3<double>::Zero();
    if (about_center_) center(s, X, V);
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> x = s.positions()[i] - X, v = s.velocities()[i] - V;
      sum += norm2(v) + frequency_ * frequency_ * norm2(x);
    }
    return std::sqrt(sum);
  }

 private:
  static void center(const ParticleSystem<double>& s, Vec3<double>& X, Vec3<double>& V) {
    double mass = 0;
    for (Index i = 0; i < s.size(); ++i) {
      const double m = s.masses()[i];
      mass += m;
      X += m * s.positions()[i];
      V += m * s.velocities()[i];
    }
    if (mass > 0) X /= mass;
    if (mass > 0) V /= mass;
  }

  double frequency_;
  bool about_center_;
};

}  // namespace noether
