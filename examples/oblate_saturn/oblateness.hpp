#pragma once
/// A force the user wrote: all that is needed for programs and scenes.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"

#include <cmath>

/// Quadrupole of an oblate primary (particle 0), symmetry axis z.
///     U = sum_i m_i (mu J2 R^2 / 2 r^5) (3 z^2 - r^2),   r = x_i - x_0
struct Oblateness {
  double J2 = 0.0;      ///< [1]
  double radius = 0.0;  ///< equatorial radius of the primary [length]
  double mu = 0.0;      ///< G times the mass of the primary [length^3/time^2]

  static constexpr auto describe() {
    using namespace noether;
    return part<Oblateness>("my_oblateness", "J2 quadrupole of particle 0, axis along z",
                            field<&Oblateness::J2>("J2", "1"), field<&Oblateness::radius>("radius", "length"),
                            field<&Oblateness::mu>("mu", "length^3/time^2"));
  }

  template <class Real> void add_to(noether::ForceSink<Real>& out, const noether::ParticleSystem<Real>& s) const {
    using namespace noether;
    using std::sqrt;
    for (Index i = 1; i < s.size(); ++i) {
      const Vec3<Real> d = s.positions()[i] - s.positions()[0];
      const Real r2 = norm2(d), z2 = d.z() * d.z();
      const Real k = 1.5 * mu * J2 * radius * radius / (r2 * r2 * sqrt(r2));
      const Vec3<Real> a = -k * ((1.0 - 5.0 * z2 / r2) * d + 2.0 * d.z() * Vec3<Real>::UnitZ());
      out.pair(i, 0, a * s.masses()[i]);  // Newton's third law
      out.energy(s.masses()[i] * k / 3.0 * (3.0 * z2 - r2));
    }
  }
};
