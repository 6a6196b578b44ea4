#pragma once
/// Potentials of dihedral and improper angles: by both cosine and sine, so that no digits are lost anywhere.

#include "numbers/types.hpp"

#include <array>
#include <cmath>

namespace noether::dihedral_potential {

/// The dihedral angle phi of four particles in a row, 0 if the ends are on one side (cis), 180 degrees if they are on
/// opposite sides (trans), positive if the far end is turned clockwise (IUPAC).
///
///     f = x_1 - x_2,  g = x_2 - x_3,  h = x_4 - x_3,   A = f x g,  B = h x g
///     cos phi = A.B / (|A| |B|),   sin phi = |g| h.A / (|A| |B|)
///
/// @source BlondelKarplus1996
template <class Real> struct Twist {
  Vec3<Real> f, g, h, A, B;
  Real A2, B2;        ///< squares of the normals; 0 where three particles are in line, and phi is not defined
  Real length;        ///< |g|
  Real cosine, sine;  ///< times |A| |B|
  Real normals;       ///< |A| |B|

  Twist(const Vec3<Real>& one, const Vec3<Real>& axis, const Vec3<Real>& other)
      : f(one), g(axis), h(other), A(cross(f, g)), B(cross(h, g)), A2(norm2(A)), B2(norm2(B)) {
    using std::sqrt;
    length = sqrt(norm2(g));
    cosine = dot(A, B);
    sine = length * dot(h, A);
    normals = sqrt(A2) * sqrt(B2);
  }

  bool is_defined() const { return !(A2 == Real(0)) && !(B2 == Real(0)); }
  /// phi in (-pi, pi].
  Real angle() const {
    using std::atan2;
    return atan2(sine, cosine);
  }
};

/// A periodic barrier.
///
///     U = k (1 + cos(n phi - phase))
///
/// @throws never
/// @source Allen2017
template <class Real> struct Periodic {
  Real k;      ///< [energy]
  Real n;      ///< wells per turn
  Real phase;  ///< where n phi is at a maximum

  explicit Periodic(const std::array<double, 6>& p) : k(p[0]), n(p[1]), phase(p[2]) {}

  /// dU / d phi
  Real slope(const Twist<Real>& twist) const {
    using std::sin;
    return -k * n * sin(n * twist.angle() - phase);
  }
  Real energy(const Twist<Real>& twist) const {
    using std::cos;
    return k * (Real(1) + cos(n * twist.angle() - phase));
  }
};

/// A polynomial in the cosine, with the angle counted from trans.
///
///     U = sum_{n=0}^5 c_n cos^n psi,   psi = phi - 180 degrees
///
/// @throws never
/// @source RyckaertBellemans1978
template <class Real> struct RyckaertBellemans {
  const std::array<double, 6>& c;  ///< [energy]

  explicit RyckaertBellemans(const std::array<double, 6>& p) : c(p) {}

  Real slope(const Twist<Real>& twist) const {
    const Real z = -twist.cosine / twist.normals;
    Real derivative(0);
    for (int n = 5; n >= 1; --n) derivative = derivative * z + Real(n) * coefficient(n);
    return derivative * twist.sine / twist.normals;
  }
  Real energy(const Twist<Real>& twist) const {
    const Real z = -twist.cosine / twist.normals;
    Real sum(0);
    for (int n = 5; n >= 0; --n) sum = sum * z + coefficient(n);
    return sum;
  }

 private:
  Real coefficient(int n) const { return Real(c[static_cast<std::size_t>(n)]); }
};

/// A spring in the angle chi between the planes of particles 1-2-3 and 2-3-4.
///
///     U = k (chi - angle)^2 / 2,   chi = |phi|
///
/// With `angle` 0 it keeps four particles in a plane; with another one, both mirror images are at rest.
/// @throws never
/// @source Allen2017
template <class Real> struct HarmonicImproper {
  Real k;      ///< [energy]
  Real angle;  ///< at rest

  explicit HarmonicImproper(const std::array<double, 6>& p) : k(p[0]), angle(p[1]) {}

  Real slope(const Twist<Real>& twist) const {
    const Real phi = twist.angle();
    return phi < Real(0) ? k * (phi + angle) : k * (phi - angle);
  }
  Real energy(const Twist<Real>& twist) const {
    using std::abs;
    const Real rest = abs(twist.angle()) - angle;
    return k * rest * rest / Real(2);
  }
};

/// The pair force between the ends of a dihedral, three bonds apart, where it is another one than of other pairs.
///
///     U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) + charges/r,   r = |x_1 - x_4|
///
/// There is no cutoff. What is left of it is a part of epsilon and charges.
/// @throws never
/// @source MacKerell1998
template <class Real> struct OneFour {
  Real epsilon;  ///< [energy]
  Real sigma;    ///< [length]
  Real charges;  ///< coulomb_constant q_1 q_4 [energy length]

  explicit OneFour(const std::array<double, 6>& p) : epsilon(p[0]), sigma(p[1]), charges(p[2]) {}

  /// -U'(r) / r
  Real force_over_r(const Real& r2) const {
    using std::sqrt;
    const Real s2 = sigma * sigma / r2, s6 = s2 * s2 * s2;
    return (Real(24) * epsilon * s6 * (Real(2) * s6 - Real(1)) + charges / sqrt(r2)) / r2;
  }
  Real energy(const Real& r2) const {
    using std::sqrt;
    const Real s2 = sigma * sigma / r2, s6 = s2 * s2 * s2;
    return Real(4) * epsilon * s6 * (s6 - Real(1)) + charges / sqrt(r2);
  }
};

}  // namespace noether::dihedral_potential
