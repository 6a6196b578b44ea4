#pragma once
/// How long the next step of an adaptive method is to be.

#include "engine/saved_state.hpp"
#include "integrators/method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace noether {

/// Tolerances: a step passes if the norm of its error estimate is at most 1.
///
/// Of particles the worst one counts, by vectors as wholes; who they are measured against, `ParticleScales` says:
///
///     |e| = max_i max(|e_x,i| / (atol + rtol p_i L_i), |e_v,i| / (atol + rtol p_i S_i))
///
/// Here L, S and p are length, speed and part of particle i, to which rounding of x and v is added, since no step is
/// better. Without a neighbor they are the larger of |x| at both ends of the step, but no less than a thousandth of the
/// largest of all particles; velocities likewise. Systems of first order have the weighted norm of all variables:
///
///     |e| = sqrt(sum (e_i / (atol + rtol max(|y0_i|, |y1_i|)))^2 / n)
struct Tolerance {
  double rtol = 1e-6;
  std::optional<double> atol = {};  ///< default: 0 for particles, `of_variables` for systems of first order
  double of_variables = 1e-9;

  Tolerance(double relative, double least) : rtol(relative), atol(least) {}
  Tolerance(const MethodInfo& info, const MethodOptions& options)
      : rtol(options.rtol.value_or(info.rtol)), atol(options.atol), of_variables(info.atol) {}

  /// The absolute one, of particles or of variables.
  double absolute(bool of_particles) const { return atol.value_or(of_particles ? 0 : of_variables); }

  /// @param scales  of the field, at y0
  template <class Real>
  double norm(const ParticleScales& scales, const Vector<Real>& e, const Vector<Real>& y0,
              const Vector<Real>& y1) const {
    return scales.particles() > 0 ? of_worst(scales, e, y0, y1) : of_all(e, y0, y1);
  }

 private:
  template <class Real> double of_all(const Vector<Real>& e, const Vector<Real>& y0, const Vector<Real>& y1) const {
    const double least = absolute(false);
    double sum = 0;
    for (Index i = 0; i < e.size(); ++i) {
      const double size = std::max(std::abs(static_cast<double>(y0[i])), std::abs(static_cast<double>(y1[i])));
      const double one = static_cast<double>(e[i]) / (least + rtol * size);
      sum += one * one;
    }
    return std::sqrt(sum / static_cast<double>(std::max<Index>(e.size(), 1)));
  }
  template <class Real>
  double of_worst(const ParticleScales& scales, const Vector<Real>& e, const Vector<Real>& y0,
                  const Vector<Real>& y1) const;
};

/// The length of a vector; squares of it may leave the range of doubles.
inline double length_of(double x, double y, double z) {
  const double squares = x * x + y * y + z * z;
  return squares > 1e-280 && squares < 1e300 ? std::sqrt(squares) : std::hypot(x, y, z);
}
/// |y_i|, or |y_i - z_i|, of vector i among n: component k stands at k n + i.
template <class Real> double length_of(const Vector<Real>& y, Index i, Index n) {
  const auto x = [&](Index k) { return static_cast<double>(y[k * n + i]); };
  return length_of(x(0), x(1), x(2));
}
template <class Real> double length_of(const Vector<Real>& y, const Vector<Real>& z, Index i, Index n) {
  const auto x = [&](Index k) { return static_cast<double>(y[k * n + i] - z[k * n + i]); };
  return length_of(x(0), x(1), x(2));
}

template <class Real>
double Tolerance::of_worst(const ParticleScales& scales, const Vector<Real>& e, const Vector<Real>& y0,
                           const Vector<Real>& y1) const {
  constexpr double rounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const Index n = scales.particles();
  const double least = absolute(true);
  double worst = 0;
  const auto count = [&](double error, double tolerable) {
    const double one = error > 0 ? error / tolerable : error;
    if (one > worst || std::isnan(one)) worst = one;
  };
  for (Index i = 0; i < n; ++i) {
    const double x = length_of(y0, i, n), v = length_of(y0, i + 3 * n, n);
    double length = scales.length[static_cast<std::size_t>(i)], speed = scales.speed[static_cast<std::size_t>(i)];
    double least_x = least, least_v = least;
    if (length == 0) {
      length = std::max({x, length_of(y1, i, n), 1e-3 * scales.size});
      speed = std::max({v, length_of(y1, i + 3 * n, n), 1e-3 * scales.fastest});
      if (!atol && scales.size == 0) least_x = of_variables;  // nothing has a size yet
      if (!atol && scales.fastest == 0) least_v = of_variables;
    } else if (!scales.gravity) {
      speed = std::max({speed, length_of(y0, y1, i + 3 * n, n), 1e-3 * scales.fastest});
    }
    // Forces are as right as the distances that they are computed from.
    const double lost = length > 0 ? x / length : 0, relative = rtol * scales.part[static_cast<std::size_t>(i)];
    count(length_of(e, i, n), least_x + relative * length + rounding * x);
    count(length_of(e, i + 3 * n, n), least_v + relative * speed + rounding * (v + lost * speed));
  }
  return worst;
}

/// The controller of Hairer, Noersett and Wanner: proportional and integral parts, no growth right after a rejection.
///
///     h_new = h clamp(0.9 err^-(1/k - 0.75 b) err_old^b, 0.2, most),  b = 0.4 / k
///
/// k is the order of the error estimate plus one.
/// @source HairerNoersettWanner1993
class StepController {
 public:
  explicit StepController(int k = 5, double most = 10, bool integral = true)
      : k_(k), most_(most), b_(integral ? 0.4 / k : 0) {}

  /// Step to be tried next [time], signed as the steps before; 0: nothing is known yet.
  double next() const { return next_; }
  void start(double h) { next_ = h; }
  void forget() {
    next_ = 0;
    old_ = 1e-4;
    rejected_ = false;
  }
  /// Tells how a step of `h` went: error norm `error`. @return whether it passes
  bool accept(double h, double error) {
    if (!(error <= 1)) {
      const double factor = std::isfinite(error) ? std::max(0.2, 0.9 * std::pow(error, -1.0 / k_)) : 0.1;
      next_ = h * std::min(factor, 0.95);
      rejected_ = true;
      return false;
    }
    const double e = std::max(error, 1e-10);
    double factor = std::clamp(0.9 * std::pow(e, 0.75 * b_ - 1.0 / k_) * std::pow(old_, b_), 0.2, most_);
    if (rejected_) factor = std::min(factor, 1.0);
    next_ = h * factor;
    old_ = std::max(error, 1e-4);
    rejected_ = false;
    return true;
  }

  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "next", next_);
    save_value(saved, prefix + "error", old_);
    save_value(saved, prefix + "rejected", rejected_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    load_value(saved, prefix + "next", next_);
    load_value(saved, prefix + "error", old_);
    load_value(saved, prefix + "rejected", rejected_);
  }

 private:
  int k_;
  double most_, b_;
  double next_ = 0, old_ = 1e-4;
  bool rejected_ = false;
};

/// The shorter of two steps of one sign.
inline double shorter(double h, double most) { return std::abs(most) < std::abs(h) ? most : h; }
/// A step that jumps over no encounter of particles.
inline double shorter(double h, double most, const ParticleScales& scales) {
  return shorter(shorter(h, most), std::copysign(scales.ahead(h).longest, h));
}

/// The shortest time in which a particle falls on its neighbor or goes round it, or in which its own coordinates
/// change, from rates f0 at y; infinity where nothing tells [time].
template <class Real>
double shortest_time(const ParticleScales& scales, const Vector<Real>& y, const Vector<Real>& f0) {
  const Index n = scales.particles();
  double fastest = 0;
  const auto compare = [&](double speed, double length) {
    if (length > 0) fastest = std::max(fastest, speed / length);
  };
  for (Index i = 0; i < n; ++i) {
    const double length = scales.length[static_cast<std::size_t>(i)], speed = scales.speed[static_cast<std::size_t>(i)];
    const double x = length > 0 ? length : length_of(y, i, n), a = length_of(f0, i + 3 * n, n);
    const double v = length > 0 ? speed : length_of(y, i + 3 * n, n);
    compare(v, x);
    if (length > 0 && scales.gravity) continue;
    compare(a, v);
    if (x > 0) fastest = std::max(fastest, std::sqrt(a / x));
  }
  return 1 / fastest;
}

/// A first step with the sign of `towards`. Of particles it is a part of the shortest time of any, whatever the units:
///
///     h = T (rtol / 100)^(1 / (order + 1))
///
/// Else, from the sizes of y, y' and y'', by the algorithm of Hairer, Noersett and Wanner, II.4.
/// @cost one evaluation for particles, else two
template <class Real>
double first_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, int order, const Tolerance& tolerance,
                  double towards) {
  Vector<Real> f0(y.size()), y1(y.size()), f1(y.size());
  f.rate(t, y, f0);
  const ParticleScales& scales = f.scales(y, tolerance.rtol);
  if (scales.particles() > 0) {
    // Where nothing tells, or a force may change sooner than its present value says.
    const double blind = std::max(1e-6, 1e-12 * std::abs(static_cast<double>(t)));
    const double shortest = shortest_time(scales, y, f0), accuracy = std::clamp(tolerance.rtol, 1e-30, 1.0);
    double h = shortest * std::pow(accuracy / 100, 1.0 / (order + 1));
    if (!std::isfinite(h) || !(h > 0)) h = blind;
    return std::copysign(f.claims().time_dependent ? std::min(h, blind) : h, towards);
  }
  const double d0 = tolerance.norm(scales, y, y, y), d1 = tolerance.norm(scales, f0, y, y);
  double h0 = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1;
  if (!std::isfinite(h0)) h0 = 1e-6;
  const Real probe(std::copysign(h0, towards));
  for (Index i = 0; i < y.size(); ++i) y1[i] = y[i] + probe * f0[i];
  f.rate(t + probe, y1, f1);
  for (Index i = 0; i < y.size(); ++i) f1[i] = f1[i] - f0[i];
  const double d2 = tolerance.norm(scales, f1, y, y) / h0;
  const double worst = std::max(d1, d2);
  const double h1 = worst <= 1e-15 ? std::max(1e-6, h0 * 1e-3) : std::pow(0.01 / worst, 1.0 / (order + 1));
  const double h = std::min(100 * h0, h1);
  return std::copysign(std::isfinite(h) && h > 0 ? h : 1e-6, towards);
}

/// What an adaptive method says when its step has become shorter than time can tell.
inline std::optional<Failure> underflow(double t, double h) {
  if (std::abs(h) > 4 * std::numeric_limits<double>::epsilon() * std::abs(t) &&
      std::abs(h) > 1e3 * std::numeric_limits<double>::min()) {
    return {};
  }
  return Failure{Outcome::Kind::step_underflow, -1, "step",
                 fmt::format("the tolerance needs a step of {:.3g} at time {:.9g}, below the resolution of time; "
                             "two bodies may have collided, or the tolerance is below rounding",
                             h, t)};
}

/// The same, and where the tolerance cannot be met at any length, since no step of doubles tells the orbit of a
/// particle.
inline std::optional<Failure> underflow(double t, double h, const ParticleScales& scales) {
  const ParticleScales::Lost& lost = scales.ahead(h).lost;
  if (lost.particle < 0) return underflow(t, h);
  return Failure{
      Outcome::Kind::step_underflow, lost.particle, "step",
      fmt::format(
          "doubles cannot resolve the orbit of {} about {} at time {:.9g}: their distance of {:.3g} is lost in the "
          "rounding of positions; use 'gauss_8', which keeps such distances, or put the origin there",
          lost.name, lost.neighbor_name, t, lost.distance)};
}

}  // namespace noether
