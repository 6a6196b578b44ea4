#pragma once
/// Potentials of angles: energy and force without a loss of digits at 0 and 180 degrees, where cosines hide the angle.

#include "forces/bond_potentials.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cmath>
#include <type_traits>

namespace noether::angle_potential {

/// The angle theta between a and b, two arms from one vertex.
///
///     cos theta = a.b / (|a| |b|),   sin theta = |a x b| / (|a| |b|)
template <class Real> struct Bend {
  Vec3<Real> a, b, normal;  ///< normal = a x b
  Real a2, b2;              ///< squares of the arms
  Real lengths;             ///< |a| |b|
  Real along;               ///< a.b
  Real across2;             ///< |a x b|^2

  Bend(const Vec3<Real>& one, const Vec3<Real>& other)
      : a(one),
        b(other),
        normal(cross(a, b)),
        a2(norm2(a)),
        b2(norm2(b)),
        lengths(product(a2, b2)),
        along(dot(a, b)),
        across2(norm2(normal)) {}

  Real cosine() const { return along / lengths; }
  /// 1 + cos theta, all digits of it near 180 degrees.
  Real one_plus_cosine() const {
    if (along > Real(0)) return Real(1) + cosine();
    return across2 / (lengths * (lengths - along));
  }
  /// theta in [0, pi].
  Real angle() const {
    using std::atan2, std::sqrt;
    return atan2(sqrt(across2), along);
  }
  /// (The angle that is left to 0 degrees (side = 1) or to 180 (side = -1)) / |a x b|: smooth where that angle is 0,
  /// with arctan(tau)/tau as a series.
  Real rest_over_across(int side) const {
    const Real towards = Real(side) * along;
    using std::atan2, std::sqrt;
    if (!(towards > Real(0)) || !(across2 < Real(1e-4) * along * along)) {
      const Real across = sqrt(across2);
      return atan2(across, towards) / across;
    }
    const Real t = across2 / (along * along);
    Real sum(0);
    for (int k = 8; k >= 0; --k) sum = Real(1) / Real(2 * k + 1) - t * sum;  // the next term is below 1e-37
    return sum / towards;
  }

 private:
  static Real product(const Real& a2, const Real& b2) {
    using std::sqrt;
    return sqrt(a2) * sqrt(b2);
  }
};

/// Which end of [0, pi] an angle is, to rounding: 1 for 0 degrees, -1 for 180, 0 for what lies between.
inline int end_of(double angle) {
  constexpr double pi = 3.14159265358979323846, rounding = 1e-15;
  if (std::abs(angle) < rounding) return 1;
  return std::abs(angle - pi) < rounding ? -1 : 0;
}

/// A spring in the angle.
///
///     U = k (theta - angle)^2 / 2
///
/// It is smooth at 180 degrees if `angle` is that; else U has a tip there and no direction of force: exactly in line
/// the force is 0.
/// @throws never
/// @source Allen2017
template <class Real> struct Harmonic {
  Real k;      ///< [energy]
  Real angle;  ///< at rest
  int end;     ///< of [0, pi], if it is one

  explicit Harmonic(const std::array<double, 6>& p) : k(p[0]), angle(p[1]), end(end_of(p[1])) {}

  /// dU / d cos theta = - U'(theta) / sin theta
  Real slope(const Bend<Real>& bend) const {
    if (bend.across2 == Real(0) && !(Real(end) * bend.along > Real(0))) return Real(0);
    if (end != 0) return -Real(end) * k * bend.rest_over_across(end) * bend.lengths;
    using std::sqrt;
    return -k * (bend.angle() - angle) * bend.lengths / sqrt(bend.across2);
  }
  Real energy(const Bend<Real>& bend) const {
    if (end != 0 && Real(end) * bend.along > Real(0)) {
      const Real ratio = bend.rest_over_across(end);
      return k * bend.across2 * ratio * ratio / Real(2);
    }
    const Real rest = bend.angle() - angle;
    return k * rest * rest / Real(2);
  }
};

/// The stiffness of a chain.
///
///     U = k (1 + cos theta)
///
/// @throws never
/// @source Allen2017
template <class Real> struct Cosine {
  Real k;  ///< [energy]

  explicit Cosine(const std::array<double, 6>& p) : k(p[0]) {}

  Real slope(const Bend<Real>& /*the same everywhere*/) const { return k; }
  Real energy(const Bend<Real>& bend) const { return k * bend.one_plus_cosine(); }
};

/// A spring in the cosine of the angle.
///
///     U = k (cos theta - cos angle)^2 / 2
///
/// @throws never
/// @source Allen2017
template <class Real> struct CosineSquared {
  Real k;       ///< [energy]
  Real cosine;  ///< of the angle at rest
  bool straight;

  explicit CosineSquared(const std::array<double, 6>& p)
      : k(p[0]), cosine(cosine_of(p)), straight(end_of(p[1]) == -1) {}

  Real slope(const Bend<Real>& bend) const { return k * stretch(bend); }
  Real energy(const Bend<Real>& bend) const {
    const Real rest = stretch(bend);
    return k * rest * rest / Real(2);
  }

 private:
  static Real cosine_of(const std::array<double, 6>& p) {
    using std::cos;
    if constexpr (std::is_same_v<Real, double>) return p[5];  // the same number, computed once
    return cos(Real(p[1]));
  }
  Real stretch(const Bend<Real>& bend) const { return straight ? bend.one_plus_cosine() : bend.cosine() - cosine; }
};

/// A spring in the angle, and one between its ends.
///
///     U = k (theta - angle)^2 / 2 + k_ends (r - length)^2 / 2,   r = |x_1 - x_3|
///
/// CHARMM and LAMMPS leave out the halves.
/// @throws never
/// @source MacKerell1998
template <class Real> struct UreyBradley {
  Harmonic<Real> spring;
  bond_potential::Harmonic<Real> ends;  ///< what acts between the ends

  explicit UreyBradley(const std::array<double, 6>& p) : spring(p), ends({p[2], p[3], 0, 0, 0, 0}) {}

  Real slope(const Bend<Real>& bend) const { return spring.slope(bend); }
  Real energy(const Bend<Real>& bend) const { return spring.energy(bend); }
};

}  // namespace noether::angle_potential
