#pragma once
/// How one kick turns velocities: the helix of constant fields, and the pushers of particle codes.

#include "numbers/select.hpp"
#include "numbers/small_angle.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace noether {

/// Coefficients of a turn about Omega:
///
///     v -> v + sine v x Omega + versine (v x Omega) x Omega
///     sine = sin(theta)/|Omega|,  versine = (1 - cos(theta))/Omega^2
template <class Real> struct TurnCoefficients { Real sine, versine; };

/// By what angle theta a kick of length h turns velocities about Omega: h |Omega|, or as Boris's steps do.
///
/// One cycle of Boris's is a turn by 2 atan(x), x = h |Omega|/2; with tan x instead of x, to some order, its angle is
/// right to that order. n cycles are n such turns of h/n, multiplied out without trigonometric functions.
/// @source Boris1970, ZenitaniUmeda2018, ZenitaniKato2020
template <class Real> class GyrationAngle {
 public:
  /// The exact angle.
  GyrationAngle() = default;
  /// @param cycles  1 or more
  /// @param order  even, 2 to 16: of the angle
  GyrationAngle(std::int64_t cycles, std::int64_t order) : cycles_(cycles), terms_(order / 2) {
    // tan' = 1 + tan^2, power by power
    tangent_[0] = Real(1);
    for (std::size_t k = 1; k < tangent_.size(); ++k) {
      Real square(0);
      for (std::size_t j = 0; j < k; ++j) square += tangent_[j] * tangent_[k - 1 - j];
      tangent_[k] = square / Real(2 * static_cast<double>(k) + 1);
    }
  }

  /// @param rate2  Omega^2
  TurnCoefficients<Real> over(const Real& h, const Real& rate2) const {
    return cycles_ == 0 ? exact(h, rate2) : in_cycles(h, rate2);
  }

  std::int64_t cycles() const { return cycles_; }  ///< 0: the exact angle
  std::int64_t terms() const { return terms_; }
  /// Of tan x = sum tangent_k x^(2 k + 1).
  const std::array<Real, 8>& tangent() const { return tangent_; }

 private:
  static TurnCoefficients<Real> exact(const Real& h, const Real& rate2) {
    using std::sqrt;
    const auto rests = rate2 == Real(0);
    const Real rate = sqrt(noether::select(rests, Real(1), rate2));
    const auto [sine, cosine] = sine_cosine<Real>(h * rate / Real(2));
    const Real part = Real(2) * sine / rate;
    return {noether::select(rests, h, Real(part * cosine)),
            noether::select(rests, Real(h * h / Real(2)), Real(part * sine / rate))};
  }
  TurnCoefficients<Real> in_cycles(const Real& h, const Real& rate2) const {
    const Real half = h / Real(2 * static_cast<double>(cycles_)), x2 = half * half * rate2;
    Real series = tangent_[static_cast<std::size_t>(terms_ - 1)];
    for (std::int64_t k = terms_ - 1; k-- > 0;) series = series * x2 + tangent_[static_cast<std::size_t>(k)];
    const Real t = half * series, part = Real(2) * t / (Real(1) + t * t * rate2);
    const TurnCoefficients<Real> one{part, t * part};
    TurnCoefficients<Real> all = one;
    for (std::int64_t cycle = 1; cycle < cycles_; ++cycle) {
      const Real versine = all.versine + one.versine * (Real(1) - rate2 * all.versine) + all.sine * one.sine;
      all.sine += one.sine - rate2 * (all.sine * one.versine + one.sine * all.versine);
      all.versine = versine;
    }
    return all;
  }

  std::int64_t cycles_ = 0;  ///< 0: the exact angle
  std::int64_t terms_ = 0;
  std::array<Real, 8> tangent_{};  ///< tan x = sum tangent_k x^(2 k + 1)
};

/// By what v changes over h under v' = a + v x Omega, where it turns by the angle of `turn`; the drift a x
/// Omega/Omega^2 is right for any angle.
template <class Real>
Vec3<Real> turned(const Vec3<Real>& v, const Vec3<Real>& a, const Vec3<Real>& rate, const GyrationAngle<Real>& turn,
                  const Real& h) {
  const Real rate2 = norm2(rate);
  const auto rests = rate2 == Real(0);
  const TurnCoefficients<Real> by = turn.over(h, rate2);
  const Vec3<Real> across = cross(v, rate), pulled = cross(a, rate);
  const Real lag = noether::select(rests, Real(0), Real((h - by.sine) / noether::select(rests, Real(1), rate2)));
  return by.sine * across + by.versine * (cross(across, rate) + pulled) + lag * cross(pulled, rate) + h * a;
}

namespace detail {
/// By what u changes in Cayley's turn about t, by 2 atan |t|.
template <class Real> Vec3<Real> full_turn_about(const Vec3<Real>& u, const Vec3<Real>& t) {
  const Vec3<Real> across = cross(u, t);
  return Real(2) / (Real(1) + norm2(t)) * (across + cross(across, t));
}
/// u turned by half of that angle and shortened by its cosine.
template <class Real> Vec3<Real> half_turned_about(const Vec3<Real>& u, const Vec3<Real>& t) {
  return (u + dot(u, t) * t + cross(u, t)) / (Real(1) + norm2(t));
}
/// The gamma of a proper velocity u turned by t = tau/gamma, as Vay's step and Higuera's and Cary's have it: the
/// greater root of gamma^4 - (before^2 - tau^2) gamma^2 - (tau^2 + (u . tau)^2/c^2) = 0.
template <class Real> Real gamma_between(const Vec3<Real>& u, const Vec3<Real>& tau, const Real& c) {
  using std::sqrt;
  const Real tau2 = norm2(tau), along = dot(u, tau) / c;
  const Real sigma = Real(1) + norm2(u) / (c * c) - tau2, rest = tau2 + along * along;
  const Real root = sqrt(sigma * sigma + Real(4) * rest);
  const auto positive = sigma >= Real(0);
  const Real direct = (sigma + root) / Real(2),
             other = Real(2) * rest / noether::select(positive, Real(1), Real(root - sigma));
  return sqrt(noether::select(positive, direct, other));
}
}  // namespace detail

/// By what the proper velocity u = gamma v changes over h under u' = a + v x Omega: Boris's step, whose turn has the
/// gamma between its two half kicks.
/// @source Boris1970
template <class Real>
Vec3<Real> boris_push(const Vec3<Real>& u, const Vec3<Real>& a, const Vec3<Real>& rate, const Real& c, const Real& h) {
  using std::sqrt;
  const Vec3<Real> half = h / Real(2) * a, before = u + half;
  const Vec3<Real> t = h / (Real(2) * sqrt(Real(1) + norm2(before) / (c * c))) * rate;
  return half + half + detail::full_turn_about(before, t);
}

/// The same by Vay's step: the mean of both velocities in the magnetic force. Where E + v x B = 0 nothing changes; it
/// does not keep the volume.
/// @source Vay2008
template <class Real>
Vec3<Real> vay_push(const Vec3<Real>& u, const Vec3<Real>& a, const Vec3<Real>& rate, const Real& c, const Real& h) {
  using std::sqrt;
  const Real gamma = sqrt(Real(1) + norm2(u) / (c * c));
  const Vec3<Real> tau = h / Real(2) * rate;
  const Vec3<Real> ahead = u + h * a + cross(u, tau) / gamma;
  const Real next = detail::gamma_between(ahead, tau, c);
  return detail::half_turned_about(ahead, Vec3<Real>(tau / next)) - u;
}

/// The same by the step of Higuera and Cary: the velocity of the mean proper velocity in the magnetic force. Where
/// E + v x B = 0 nothing changes, and it keeps the volume.
/// @source HigueraCary2017
template <class Real>
Vec3<Real> higuera_cary_push(const Vec3<Real>& u, const Vec3<Real>& a, const Vec3<Real>& rate, const Real& c,
                             const Real& h) {
  const Vec3<Real> half = h / Real(2) * a, before = u + half, tau = h / Real(2) * rate;
  const Vec3<Real> t = tau / detail::gamma_between(before, tau, c);
  return half + half + detail::full_turn_about(before, t);
}

}  // namespace noether
