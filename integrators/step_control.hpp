#pragma once
/// How long the next step of an adaptive method is to be.

#include "engine/saved_state.hpp"
#include "integrators/method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

/// Tolerances: a step passes if the weighted norm of its error estimate is at most 1.
///
///     |e| = sqrt(sum (e_i / (atol + rtol max(|y0_i|, |y1_i|)))^2 / n)
struct Tolerance {
  double rtol = 1e-6, atol = 1e-9;

  template <class Real> double norm(const Vector<Real>& e, const Vector<Real>& y0, const Vector<Real>& y1) const {
    double sum = 0;
    for (Index i = 0; i < e.size(); ++i) {
      const double size = std::max(std::abs(static_cast<double>(y0[i])), std::abs(static_cast<double>(y1[i])));
      const double one = static_cast<double>(e[i]) / (atol + rtol * size);
      sum += one * one;
    }
    return std::sqrt(sum / static_cast<double>(std::max<Index>(e.size(), 1)));
  }
};

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

/// A first step with the sign of `towards`, from the sizes of y, y' and y'': algorithm of Hairer, Noersett and Wanner,
/// II.4.
/// @cost two evaluations
template <class Real>
double first_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, int order, const Tolerance& tolerance,
                  double towards) {
  Vector<Real> f0(y.size()), y1(y.size()), f1(y.size());
  f.rate(t, y, f0);
  const double d0 = tolerance.norm(y, y, y), d1 = tolerance.norm(f0, y, y);
  double h0 = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1;
  if (!std::isfinite(h0)) h0 = 1e-6;
  const Real probe(std::copysign(h0, towards));
  for (Index i = 0; i < y.size(); ++i) y1[i] = y[i] + probe * f0[i];
  f.rate(t + probe, y1, f1);
  for (Index i = 0; i < y.size(); ++i) f1[i] = f1[i] - f0[i];
  const double d2 = tolerance.norm(f1, y, y) / h0;
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
                 fmt::format("the tolerance asks for a step of {:.3g} at time {:.9g}, below the resolution of time; "
                             "two bodies may have collided, or the tolerance is below rounding",
                             h, t)};
}

}  // namespace noether
