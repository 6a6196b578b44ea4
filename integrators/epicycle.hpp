#pragma once
/// The epicycle: the motion of a free particle in a frame that turns, exact for any time, by shears.

#include "engine/box.hpp"
#include "numbers/real.hpp"
#include "numbers/types.hpp"
#include "numbers/units.hpp"

#include <cmath>
#include <type_traits>

namespace noether {

/// What two rates make of a frame that turns: x points away from the primary, y along the motion.
///
///     x'' = 2 Omega y' + 3 Omega^2 x,   y'' = - 2 Omega x',   z'' = - Omega_z^2 z
struct SheetRates {
  double Omega = 1, Omega_z = 1;  ///< [1/time]
};

/// The motion of `SheetRates` for one length of time h, r = Omega h, with w = y' + 3 Omega x/2:
///
///     a = x' + T w,   x -> x + a sin r/Omega,  y' -> y' - 2 a sin r,   x' -> a + T w,   T = 2 tan(r/2)
///     y -> y - 3 r x/2 + (8 tan(r/2) - 3 r) w/Omega - 2 (1 - cos r) a/Omega
///     z: likewise, about 0
///
/// x' and w turn by r on an ellipse, and three shears do that: whatever their numbers are rounded to, the map has
/// determinant 1, so that no amplitude grows or fades, and y' + 2 Omega x stays. T is that of the other two numbers as
/// they are rounded, so that the angle of a step is right to half a unit in its last place. Nothing is computed from y,
/// or from differences of what is large. r beyond pi/2 is a whole number of half turns, which change signs alone, and a
/// rest.
/// @cost 29 operations for a particle; what is computed once is some 40 operations of Quad
/// @source ReinTremaine2011
template <class Real> class Epicycle {
 public:
  Epicycle() = default;
  Epicycle(const SheetRates& rates, const Real& h) {
    if constexpr (std::is_same_v<Real, double>) {
      set<Quad>(rates, Quad(h));
    } else {
      set<Real>(rates, h);
    }
  }

  /// The same with numbers in `Real` itself, for an epicycle that few particles make: angles are those of its rounding.
  static Epicycle plain(const SheetRates& rates, const Real& h) {
    Epicycle made;
    made.template set<Real>(rates, h);
    return made;
  }

  /// By how much a particle moves.
  struct Change {
    Vec3<Real> x, v;
  };
  Change change(const Vec3<Real>& x, const Vec3<Real>& v) const {
    Change all{Vec3<Real>(Real(0), Real(0), Real(0)), Vec3<Real>(Real(0), Real(0), Real(0))};
    if (turns_) all = half_turns(x, v);
    const Vec3<Real> x0 = x + all.x, v0 = v + all.v;
    const Real w = v0[1] + drift_ * x0[0];
    const Real a = v0[0] + tilt_ * w;
    const Real dx = across_ * a, dv = along_ * a;
    const Real w1 = (v0[1] + dv) + drift_ * (x0[0] + dx);
    const Real b = v0[2] - tilt_z_ * x0[2];
    const Real dz = across_z_ * b, z1 = x0[2] + dz;
    all.x += Vec3<Real>(dx, shear_ * x0[0] + glide_ * w - bend_ * a, dz);
    all.v += Vec3<Real>(tilt_ * (w + w1), dv, -tilt_z_ * (x0[2] + z1));
    return all;
  }
  /// The same where v holds (x', w, z'), and y is y + 3 Omega x t/2, which does not shear: without what is left to be
  /// added to y, 3 Omega t/2 times the change of x, with t the time at the end.
  Change change_in_shear(const Real& z, const Vec3<Real>& v) const {
    Change all{Vec3<Real>(Real(0), Real(0), Real(0)), Vec3<Real>(Real(0), Real(0), Real(0))};
    if (turns_) {
      const Real across = far_ * v[1];
      all.x = Vec3<Real>(across, whole_glide_ * v[1] - far_ * v[0] + shear_ * across, -back_z_ * z);
      all.v = -Vec3<Real>(back_ * v[0], back_ * v[1], back_z_ * v[2]);
    }
    const Vec3<Real> v0 = v + all.v;
    const Real z0 = z + all.x[2];
    const Real a = v0[0] + tilt_in_shear_ * v0[1], dw = -half_ * a;
    const Real b = v0[2] - tilt_z_ * z0, dz = across_z_ * b;
    all.x += Vec3<Real>(across_ * a, glide_ * v0[1] - bend_ * a, dz);
    all.v += Vec3<Real>(tilt_in_shear_ * (v0[1] + (v0[1] + dw)), dw, -tilt_z_ * (z0 + (z0 + dz)));
    return all;
  }
  /// The same for many particles, columns apart and without half turns: v, w, q hold (x', w, z') and become what they
  /// are after it, dx, dy, dz are the changes. In lanes where the compiler finds some.
  static void change_in_shear(const Epicycle& e, const Real* __restrict z, Real* __restrict v, Real* __restrict w,
                              Real* __restrict q, Real* __restrict dx, Real* __restrict dy, Real* __restrict dz,
                              Index count) {
    for (Index i = 0; i < count; ++i) {
      const Real a = v[i] + e.tilt_in_shear_ * w[i], dw = -e.half_ * a;
      const Real b = q[i] - e.tilt_z_ * z[i], moved = e.across_z_ * b;
      dx[i] = e.across_ * a;
      dy[i] = e.glide_ * w[i] - e.bend_ * a;
      dz[i] = moved;
      v[i] += e.tilt_in_shear_ * (w[i] + (w[i] + dw));
      w[i] += dw;
      q[i] += -e.tilt_z_ * (z[i] + (z[i] + moved));
    }
  }
  /// Whether it has half turns, which `move` leaves out.
  bool turns() const { return turns_; }

  /// Moves particles of [begin, end), columns apart; in lanes where the compiler finds some.
  static void move(const Epicycle& e, Real* __restrict x, Real* __restrict y, Real* __restrict z, Real* __restrict u,
                   Real* __restrict v, Real* __restrict q, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Real w = v[i] + e.drift_ * x[i];
      const Real a = u[i] + e.tilt_ * w;
      y[i] += e.shear_ * x[i] + e.glide_ * w - e.bend_ * a;
      x[i] += e.across_ * a;
      v[i] += e.along_ * a;
      const Real w1 = v[i] + e.drift_ * x[i];
      u[i] = a + e.tilt_ * w1;
      const Real b = q[i] - e.tilt_z_ * z[i];
      z[i] += e.across_z_ * b;
      q[i] = b - e.tilt_z_ * z[i];
    }
  }

 private:
  template <class Wide> static Real rounded(const Wide& number) { return static_cast<Real>(number); }

  template <class Wide> static Wide half_turn_in() {
    if constexpr (std::is_constructible_v<Wide, Quad>) {
      return static_cast<Wide>(units::pi);
    } else {
      return Wide(static_cast<double>(units::pi));
    }
  }
  /// What is left of an angle beyond half turns, and their number.
  template <class Wide> static Wide without_half_turns(const Wide& angle, Wide& turns) {
    const Wide half_turn = half_turn_in<Wide>();
    turns = detail::nearest_whole(Wide(angle / half_turn));
    return angle - turns * half_turn;
  }

  template <class Wide> void set(const SheetRates& rates, const Wide& h) {
    using std::cos, std::sin;
    const Wide Omega(rates.Omega), Omega_z(rates.Omega_z);
    Wide turns, turns_z;
    const Wide r = without_half_turns(Wide(Omega * h), turns), rz = without_half_turns(Wide(Omega_z * h), turns_z);
    const Wide half = r / Wide(2), half_z = rz / Wide(2);
    const Wide s = sin(half), c = cos(half), sz = sin(half_z), cz = cos(half_z);
    drift_ = rounded(Wide(Wide(1.5) * Omega));
    across_ = rounded(Wide(Wide(2) * s * c / Omega));
    along_ = rounded(Wide(Wide(-4) * s * c));
    shear_ = rounded(Wide(Wide(-1.5) * r));
    glide_ = rounded(Wide((Wide(8) * s / c - Wide(3) * r) / Omega));
    bend_ = rounded(Wide(Wide(4) * s * s / Omega));
    across_z_ = rounded(rates.Omega_z == 0 ? h : Wide(Wide(2) * sz * cz / Omega_z));
    half_ = rounded(Wide(s * c));
    Wide tilt = Wide(2) * s / c, tilt_in_shear = tilt, tilt_z = Omega_z * sz / cz;
    if constexpr (!std::is_same_v<Wide, Real>) {
      // As the numbers of the other shears are rounded: 2 - T (- y' - 3 Omega x/2) is to be 2 cos r.
      const Wide turned = -(Wide(along_) + Wide(drift_) * Wide(across_));
      if (turned != Wide(0)) tilt = Wide(2) * s * s / turned;
      if (half_ != 0) tilt_in_shear = Wide(2) * s * s / Wide(half_);
      if (across_z_ != 0) tilt_z = Wide(2) * sz * sz / Wide(across_z_);
    }
    tilt_ = rounded(tilt);
    tilt_in_shear_ = rounded(tilt_in_shear);
    tilt_z_ = rounded(tilt_z);
    set_turns(rates, turns, turns_z);
  }
  template <class Wide> void set_turns(const SheetRates& rates, const Wide& turns, const Wide& turns_z) {
    const auto odd = [](const Wide& count) {  // 0 or 1
      const Wide left = count - Wide(2) * detail::nearest_whole(Wide(count / Wide(2)));
      return Wide(left * left);
    };
    const Wide half_turn = half_turn_in<Wide>();
    if constexpr (requires { turns.lane; }) {
      turns_ = true;
    } else {
      turns_ = turns != Wide(0) || turns_z != Wide(0);
    }
    back_ = rounded(Wide(Wide(2) * odd(turns)));
    back_z_ = rounded(Wide(Wide(2) * odd(turns_z)));
    far_ = rounded(Wide(Wide(4) * odd(turns) / Wide(rates.Omega)));
    whole_shear_ = rounded(Wide(Wide(-1.5) * turns * half_turn));
    whole_glide_ = rounded(Wide(Wide(-3) * turns * half_turn / Wide(rates.Omega)));
  }
  Change half_turns(const Vec3<Real>& x, const Vec3<Real>& v) const {
    const Real w = v[1] + drift_ * x[0];
    return {Vec3<Real>(far_ * w, whole_shear_ * x[0] + whole_glide_ * w - far_ * v[0], -back_z_ * x[2]),
            Vec3<Real>(-back_ * v[0], Real(-4) * back_ * w, -back_z_ * v[2])};
  }

  Real drift_ = Real(0);                                     ///< 3 Omega/2
  Real tilt_ = Real(0);                                      ///< T
  Real tilt_in_shear_ = Real(0), half_ = Real(0);            ///< T and sin(r)/2, as they are where w itself is kept
  Real across_ = Real(0), along_ = Real(0);                  ///< of x and y', by a
  Real shear_ = Real(0), glide_ = Real(0), bend_ = Real(0);  ///< of y, by x, w and a
  Real tilt_z_ = Real(0), across_z_ = Real(0);
  bool turns_ = false;  ///< half turns come first
  Real back_ = Real(0), back_z_ = Real(0), far_ = Real(0), whole_shear_ = Real(0), whole_glide_ = Real(0);
};

}  // namespace noether
