#pragma once
/// How `kepler_arc` works; docs/theory/kepler.md has the formulae in order. Only for further number types.

#include "integrators/kepler.hpp"
#include "integrators/universal_functions.hpp"

#include <cmath>

namespace noether::detail {

/// What an arc is asked for, time running forward: t(s) = r0 s + eta0 G2 + zeta0 G3 = h is to be solved.
template <class Real> struct KeplerEquation {
  Real mu, h;         // h > 0
  Real r, r_inverse;  // distance at the start
  Real eta;           // x . v = dr/ds
  Real zeta;          // d2r/ds2 = mu - beta r
  Real beta;          // 2 mu / r - v^2, minus twice the energy
  Real momentum2;     // |x cross v|^2
};

/// Where a trial s is on the arc, and by how much it misses.
template <class Real> struct KeplerTrial {
  UniversalFunctions<Real> g;
  Real r, eta, zeta;
  Real missing;  // h - t(s)
  Real terms;    // sum of the absolute values in t(s), the measure of its rounding error

  KeplerTrial(const KeplerEquation<Real>& a, const Real& s) : g(a.beta, s) {
    using std::abs;
    if (a.beta * s * s < Real(-1)) {
      by_exponentials(a, s);
    } else {
      const Real linear = a.r * s, quadratic = a.eta * g.g2, cubic = a.zeta * g.g3;
      missing = (a.h - linear) - (quadratic + cubic);
      terms = abs(linear) + abs(quadratic) + abs(cubic);
      r = a.r + (a.eta * g.g1 + a.zeta * g.g2);
      eta = a.eta * g.g0 + a.zeta * g.g1;
    }
    zeta = a.mu - a.beta * r;
  }

 private:
  /// Long hyperbolic arcs: r = A e^(ws) + B e^(-ws) - a. A body that comes in from afar has A << B, and the sum over
  /// G_n would lose a factor (r/a)^2; the smaller of A and B comes from their product instead.
  void by_exponentials(const KeplerEquation<Real>& a, const Real& s) {
    using std::abs;
    using std::sqrt;
    const Real w = sqrt(-a.beta), w2 = -a.beta, axis = a.mu / w2;
    const Real larger = (a.zeta + w * abs(a.eta)) / (Real(2) * w2);
    const Real smaller = (axis * axis + a.momentum2 / w2) / (Real(4) * larger);
    const Real rising = a.eta < Real(0) ? smaller : larger, falling = a.eta < Real(0) ? larger : smaller;
    const Real growth = g.g0 + w * g.g1, grown = g.g1 + w * g.g2;  // e^(ws), (e^(ws) - 1) / w
    const Real rise = rising * grown, fall = falling * (grown / growth), steady = axis * s;
    missing = (a.h - rise) - (fall - steady);
    terms = rise + fall + abs(steady);
    r = (rising * growth - axis) + falling / growth;
    eta = w * (rising * growth - falling / growth);
  }
};

/// Root of the Taylor polynomial of t at one point by reversion, order 5, and how far to trust it.
template <class Real> struct KeplerCorrection {
  Real step;
  Real size;  // squared ratio of the step to the radius within which the series is good

  KeplerCorrection(const Real& missing, const Real& r_inverse, const Real& eta, const Real& zeta, const Real& beta) {
    using std::abs;
    const Real d = missing * r_inverse;
    const Real p = eta * d * r_inverse, q = zeta * d * d * r_inverse, u = beta * d * d;
    const Real p2 = p * p;
    step = d + d * (p * (Real(-0.5) + (Real(10) * q - Real(15) * p2 + u) / Real(24)) + (p2 / Real(2) - q / Real(6)));
    size = p2 + abs(q) + abs(u) / Real(16);
  }

  bool usable() const { return size < Real(0.25); }
  /// Is the error of the step, and of one Taylor shift over it, well below rounding of s?
  bool final(const Real& s) const {
    using std::abs;
    constexpr Real negligible = kepler_constant<Real>(power_of_two(-kepler_digits<Real> - 11));
    return usable() && abs(step) * size * size <= negligible * abs(s);
  }
};

/// Where to try next: at the root of the correction, its lower half of digits cut off.
///
/// The last step is then many roundings long and of either sign. Without this it would often be a fraction of one
/// rounding, always to the same side, and rounding to nearest would drop it: a bias. Not where orbits turn so sharply
/// that the last step must be short.
template <class Real> Real next_trial(const Real& s, const KeplerCorrection<Real>& c) {
  constexpr int cut = (kepler_digits<Real> + 1) / 2;
  constexpr Real split = kepler_constant<Real>(power_of_two(cut) + Quad(1));
  constexpr Real sharp = kepler_constant<Real>(power_of_two(2 * cut - 20));
  const Real next = s + c.step, wide = split * next;
  return c.size * next * next <= sharp * (c.step * c.step) ? wide - (wide - next) : next;
}

/// A trial, and the step from it to the root.
template <class Real> struct KeplerRoot {
  Real s, step;
  KeplerTrial<Real> trial;
  int iterations;
  bool converged;
};

/// The ordinary case: reversion at the start, then at each trial, as long as the series are good.
template <class Real> KeplerRoot<Real> solve_by_series(const KeplerEquation<Real>& a) {
  constexpr int most_trials = 8;
  const KeplerCorrection<Real> start(a.h, a.r_inverse, a.eta, a.zeta, a.beta);
  Real s = next_trial(Real(0), start);
  KeplerTrial<Real> trial(a, s);
  for (int n = 1; start.usable(); ++n) {
    const KeplerCorrection<Real> c(trial.missing, Real(1) / trial.r, trial.eta, trial.zeta, a.beta);
    if (c.final(s)) return {s, c.step, trial, n, true};
    if (!c.usable() || n == most_trials) break;
    s = next_trial(s, c);
    trial = KeplerTrial<Real>(a, s);
  }
  return {s, Real(0), trial, most_trials, false};
}

/// The root between two trials, or above the lower one while none above is known.
template <class Real> class KeplerBracket {
 public:
  void narrow(const Real& s, const Real& missing) {
    if (missing > Real(0)) {
      low_ = s;
    } else {
      high_ = s;
      closed_ = true;
    }
  }
  /// `s` where it lies inside and the bracket shrinks; else the middle, or twice and half of what is known.
  Real inside(const Real& s) {
    if (!closed_) return Real(2) * low_;
    if (!(low_ > Real(0))) return high_ / Real(8);
    const Real width = high_ - low_;
    const bool slow = !(width < Real(0.5) * width_ || ++slow_trials_ < 3);
    if (width < Real(0.5) * width_ || slow) slow_trials_ = 0, width_ = width;
    return !slow && s > low_ && s < high_ ? s : low_ + width / Real(2);
  }
  bool spent() const {
    constexpr Real least = kepler_constant<Real>(power_of_two(2 - kepler_digits<Real>));
    return closed_ && !(high_ - low_ > least * high_);
  }

 private:
  Real low_{0}, high_{0}, width_{1e300};
  int slow_trials_ = 0;
  bool closed_ = false;
};

/// Laguerre's step for degree 5, which converges from nearly anywhere; not finite where it has no meaning.
template <class Real> Real laguerre_step(const KeplerTrial<Real>& t) {
  using std::abs;
  using std::sqrt;
  const Real root = sqrt(abs(Real(16) * t.r * t.r + Real(20) * t.missing * t.eta));
  return Real(5) * t.missing / (t.r + root);
}

/// A first s of the right order: along the tangent, or from the center, whichever is shorter.
template <class Real> Real crude_start(const KeplerEquation<Real>& a) {
  using std::sqrt;
  Real s = a.h * a.r_inverse;
  if (a.mu > Real(0)) {
    const Real fourth = sqrt(sqrt(Real(6) * a.h / a.mu)), sixteenth = sqrt(sqrt(fourth));
    const Real center = fourth * sixteenth * sqrt(sqrt(sixteenth));  // about the cube root
    if (center < s) s = center;
  }
  if (a.beta < Real(0)) {
    const Real scale = Real(2) / sqrt(-a.beta);
    if (scale < s) s = scale;
  }
  return s;
}

/// Any case: t(s) is monotone, so a bracket exists; Laguerre's step inside it, bisection where that stalls.
template <class Real> KeplerRoot<Real> solve_by_bracket(const KeplerEquation<Real>& a) {
  constexpr int most_trials = 390;
  constexpr Real rounding = kepler_constant<Real>(power_of_two(-kepler_digits<Real>));
  using std::abs;
  KeplerBracket<Real> bracket;
  Real s = crude_start(a);
  for (int n = 1;; ++n) {
    const KeplerTrial<Real> trial(a, s);
    const KeplerCorrection<Real> c(trial.missing, Real(1) / trial.r, trial.eta, trial.zeta, a.beta);
    const bool good = trial.r > Real(0) && c.usable();
    if (good && c.final(s)) return {s, c.step, trial, n, true};
    bracket.narrow(s, trial.missing);
    if (abs(trial.missing) <= rounding * trial.terms || bracket.spent()) return {s, Real(0), trial, n, true};
    if (n == most_trials) return {s, Real(0), trial, n, false};
    s = bracket.inside(good ? next_trial(s, c) : s + laguerre_step(trial));
  }
}

/// A type with more digits, to reduce many periods without loss; the type itself where there is none.
template <class Real> struct WiderType { using type = Real; };
template <> struct WiderType<double> { using type = Quad; };

/// Takes whole periods out of `h` so that at most half a period remains, and gives the s of those taken out.
template <class Real> Real take_whole_periods(const Vec3<Real>& x, const Vec3<Real>& v, KeplerEquation<Real>& a) {
  using std::abs;
  using std::floor;
  using std::sqrt;
  using Wide = typename WiderType<Real>::type;
  const Vec3<Wide> wide_x = x.template cast<Wide>(), wide_v = v.template cast<Wide>();
  const Wide mu(a.mu), h(a.h);
  const Wide beta = Wide(2) * mu / sqrt(norm2(wide_x)) - norm2(wide_v);
  a.beta = static_cast<Real>(beta);
  if (!(beta > Wide(0))) return Real(0);
  const Wide two_pi = kepler_constant<Wide>(6.28318530717958647692528676655900576839_q), root = sqrt(beta);
  const Wide period = two_pi * mu / (beta * root), count = floor(h / period + Wide(0.5));
  Wide rest = h - count * period;
  if (!(abs(rest) <= period)) rest = Wide(0);  // so many periods that no digit of the phase is left
  a.h = static_cast<Real>(rest);
  return static_cast<Real>(count * (two_pi / root));
}

/// Position and velocity from the root; the step that is still to be made is made in the functions themselves.
template <class Real>
KeplerArc<Real> arc_at_root(const Vec3<Real>& x, const Vec3<Real>& v, const KeplerEquation<Real>& a,
                            const KeplerRoot<Real>& root, const Real& sense) {
  using std::abs;
  using std::sqrt;
  UniversalFunctions<Real> g = root.trial.g;
  const Real d = root.step, u = a.beta * d * d;
  const Real c1 = d - d * u * (Real(20) - u) / Real(120), c2 = d * d * (Real(12) - u) / Real(24);
  const Real c3 = d * d * d * (Real(20) - u) / Real(120);
  g.shift(a.beta, d, c1, c2, c3);
  Real r = root.trial.r + (root.trial.eta * c1 + root.trial.zeta * c2);
  // Two forms of g: the one whose terms are smaller rounds less, on long arcs by a quarter.
  const Real delay = a.mu * g.g3, along = a.r * g.g1, across = a.eta * g.g2;
  const bool early = abs(delay) <= abs(along) + abs(across);
  const Real advance = sense * (early ? a.h - delay : along + across);
  KeplerArc<Real> arc;
  arc.dx = -(a.mu * g.g2 * a.r_inverse) * x + advance * v;
  constexpr Real lost = kepler_constant<Real>(power_of_two(4 - kepler_digits<Real>));
  if (!(r > lost * a.r)) r = sqrt(norm2(Vec3<Real>(x + arc.dx)));
  arc.dv = -(a.mu / r) * ((sense * g.g1 * a.r_inverse) * x + g.g2 * v);
  arc.s = sense * (root.s + d);
  arc.iterations = root.iterations;
  arc.status = root.converged ? KeplerStatus::converged : KeplerStatus::not_converged;
  return arc;
}

template <class Real> bool all_finite(const KeplerArc<Real>& arc) {
  // A number minus itself is zero unless it is infinite or not a number.
  const Real sum = arc.dx[0] * Real(0) + arc.dx[1] * Real(0) + arc.dx[2] * Real(0) + arc.dv[0] * Real(0) +
                   arc.dv[1] * Real(0) + arc.dv[2] * Real(0) + arc.s * Real(0);
  return sum == Real(0);
}

template <class Real> KeplerArc<Real> not_finite_arc(int iterations) {
  KeplerArc<Real> arc;
  arc.iterations = iterations;
  arc.status = KeplerStatus::not_finite;
  return arc;
}

/// The arc where squares of the inputs neither overflow nor vanish.
template <class Real>
KeplerArc<Real> ordinary_arc(const Vec3<Real>& x, const Vec3<Real>& v, const Real& mu, const Real& h) {
  using std::sqrt;
  constexpr Real pi_squared = kepler_constant<Real>(9.86960440108935861883449099987615113531_q);
  KeplerEquation<Real> a;
  const Real v2 = norm2(v);
  a.mu = mu;
  a.h = h;
  a.r = sqrt(norm2(x));
  a.r_inverse = Real(1) / a.r;
  a.eta = dot(x, v);
  a.zeta = a.r * v2 - mu;
  a.beta = Real(2) * mu / a.r - v2;
  Real whole(0);
  if (a.beta > Real(0) && h * h * (a.beta * a.beta * a.beta) > pi_squared * (mu * mu)) {
    whole = take_whole_periods(x, v, a);
  }
  a.momentum2 = a.beta < Real(0) ? norm2(cross(x, v)) : Real(0);
  const Real sense = a.h < Real(0) ? Real(-1) : Real(1);
  a.h *= sense;
  a.eta *= sense;
  if (!(a.h > Real(0))) {
    KeplerArc<Real> arc;
    arc.s = whole;
    return arc;
  }
  KeplerRoot<Real> root = solve_by_series(a);
  if (!root.converged) root = solve_by_bracket(a);
  KeplerArc<Real> arc = arc_at_root(x, v, a, root, sense);
  arc.s += whole;
  return all_finite(arc) ? arc : not_finite_arc<Real>(root.iterations);
}

/// mu = 0: a straight line, and the integral of dt/r along it.
template <class Real> KeplerArc<Real> free_arc(const Vec3<Real>& x, const Vec3<Real>& v, const Real& h) {
  using std::abs;
  using std::log1p;
  using std::sqrt;
  KeplerArc<Real> arc;
  arc.dx = h * v;
  const Real path = sqrt(norm2(arc.dx)), ends = sqrt(norm2(x)) + sqrt(norm2(Vec3<Real>(x + arc.dx)));
  if (path > Real(0) && ends > path) {
    arc.s = h * (log1p(Real(2) * path / (ends - path)) / path);
  } else if (ends > path) {
    arc.s = Real(2) * h / ends;
  }
  return all_finite(arc) ? arc : not_finite_arc<Real>(0);
}

template <class Real>
KeplerArc<Real> arc_in_range(const Vec3<Real>& x, const Vec3<Real>& v, const Real& mu, const Real& h) {
  return mu == Real(0) ? free_arc(x, v, h) : ordinary_arc(x, v, mu, h);
}

/// The largest power of two up to a positive number.
template <class Real> Real power_of_two_below(const Real& x) {
  constexpr int stride = 32;
  const Real jump = kepler_constant<Real>(power_of_two(stride));
  Real p(1);
  while (p * jump <= x) p *= jump;
  while (p > x) p /= p / jump > Real(0) ? jump : Real(2);  // below the normal numbers in small steps
  while (p * Real(2) <= x) p *= Real(2);
  return p;
}

template <class Real> Real largest_component(const Vec3<Real>& a) {
  using std::abs;
  Real most = abs(a[0]);
  if (abs(a[1]) > most) most = abs(a[1]);
  return abs(a[2]) > most ? abs(a[2]) : most;
}

/// Very large or small inputs, in units that are powers of two, and whatever is not finite.
template <class Real>
KeplerArc<Real> scaled_arc(const Vec3<Real>& x, const Vec3<Real>& v, const Real& mu, const Real& h) {
  using std::abs;
  using std::sqrt;
  KeplerArc<Real> inputs;
  inputs.dx = x;
  inputs.dv = v;
  inputs.s = mu * Real(0) + h * Real(0);
  const Real size = largest_component(x);
  if (!all_finite(inputs) || (size == Real(0) && mu != Real(0))) return not_finite_arc<Real>(0);
  const Real length = size == Real(0) ? Real(1) : power_of_two_below(size);
  Real speed = largest_component(v);
  const Real circular = sqrt(abs(mu / length));
  if (circular > speed) speed = circular;
  if (!(speed > Real(0))) return free_arc(x, v, h);
  if (speed * Real(0) != Real(0)) return not_finite_arc<Real>(0);
  const Real unit = power_of_two_below(speed);
  const Real way = h * unit;  // in which order nothing overflows depends on the case
  const Real time = way * Real(0) == Real(0) && way != Real(0) ? way / length : (h / length) * unit;
  KeplerArc<Real> arc = arc_in_range<Real>(x / length, v / unit, mu / length / unit / unit, time);
  arc.dx *= length;
  arc.dv *= unit;
  arc.s /= unit;
  return all_finite(arc) ? arc : not_finite_arc<Real>(arc.iterations);
}

}  // namespace noether::detail

namespace noether {

template <class Real> KeplerArc<Real> kepler_arc(const Vec3<Real>& x, const Vec3<Real>& v, Real mu, Real h) {
  using std::abs;
  // Within these no product of the solution overflows or vanishes; a comparison with a NaN is false.
  const Real most(1e30), least(1e-30), longest(1e20), r2 = norm2(x);
  if (r2 > least && r2 < most && norm2(v) < most && abs(mu) < most && abs(h) < longest) {
    return detail::arc_in_range(x, v, mu, h);
  }
  return detail::scaled_arc(x, v, mu, h);
}

}  // namespace noether
