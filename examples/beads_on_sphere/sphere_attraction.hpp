#pragma once
/// A force the user wrote: two beads on the unit sphere attract each other.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"

#include <cmath>

/// The attraction of each pair of beads on the unit sphere, what gravity is there: the cotangent of their angle.
///     U = - sum_{i<j} m_i m_j c / sqrt(1 - c^2),   c = x_i . x_j
struct SphereAttraction {
  static constexpr auto describe() {
    using namespace noether;
    return part<SphereAttraction>("sphere_attraction", "attraction of beads on the unit sphere",
                                  formula("U = - sum m_i m_j cot(angle of x_i and x_j)"),
                                  source("HairerLubichWanner2006"));
  }
  /// Its torques have no sum, but its forces have one.
  static noether::ForceClaims claims() { return {.keeps_momentum = false}; }

  template <class Real> void add_to(noether::ForceSink<Real>& out, const noether::ParticleSystem<Real>& s) const {
    using namespace noether;
    using std::sqrt;
    for (Index i = 0; i < s.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        const Vec3<Real> x = s.positions()[i], y = s.positions()[j];
        const Real c = dot(x, y), s2 = Real(1) - c * c, root = sqrt(s2);
        const Real mass = s.masses()[i] * s.masses()[j];
        const Real slope = mass / (s2 * root);  // - dU/dc
        out.force(i, slope * y);
        out.force(j, slope * x);
        out.energy(-mass * c / root);
      }
    }
  }
};
