#include "integrators/methods/adams.hpp"

#include "integrators/methods/difference_formulas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Order of the explicit formula: the implicit one predicts from the rates it keeps anyway.
int explicit_order(AdamsKind kind, int order) { return kind == AdamsKind::moulton ? std::max(order - 1, 1) : order; }

}  // namespace

template <class Real>
Adams<Real>::Adams(std::string_view name, AdamsKind kind, int order)
    : name_(name),
      kind_(kind),
      order_(order),
      explicit_(as_real<Real>(ordinates(differences::adams_bashforth(explicit_order(kind, order))))),
      implicit_(as_real<Real>(ordinates(differences::adams_moulton(order)))) {}

template <class Real> MethodClaims Adams<Real>::claims() const {
  // The trapezoidal rule looks the same from both ends.
  return {.name = name_, .order = order_, .reversible = kind_ == AdamsKind::moulton && order_ == 2};
}

template <class Real> void Adams<Real>::bind(const VectorField<Real>& f) {
  rates_.bind(explicit_.size(), f.size());
  starter_.bind(f.size());
  for (Vector<Real>* v : {&known_, &y1_, &f1_}) v->resize(f.size());
  begin_.resize(f.size());
  have_rate_ = false;
  h_ = 0;
}

template <class Real> StepResult Adams<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  if (h != h_) {
    rates_.forget();
    have_rate_ = false;
    h_ = h;
  }
  if (!have_rate_) f.rate(t, y, rates_.push());
  have_rate_ = false;
  if (rates_.count() < explicit_.size()) {
    start(f, t, y, h);
    return made;
  }
  const Real step(h);
  for (Index i = 0; i < y.size(); ++i) {
    Real sum(0);
    for (std::size_t j = explicit_.size(); j-- > 0;) sum += explicit_[j] * rates_[j][i];
    y1_[i] = y[i] + step * sum;
  }
  if (kind_ != AdamsKind::bashforth) {
    for (Index i = 0; i < y.size(); ++i) {
      Real sum(0);
      for (std::size_t j = implicit_.size(); j-- > 1;) sum += implicit_[j] * rates_[j - 1][i];
      known_[i] = y[i] + step * sum;
    }
  }
  if (kind_ == AdamsKind::pece) {
    f.rate(t + step, y1_, f1_);
    correct(y, h);
  }
  if (kind_ == AdamsKind::moulton) made.failure = iterate(f, t + step, y, h);
  y = y1_;
  return made;
}

template <class Real> void Adams<Real>::start(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  begin_.set(y);
  starter_.go(f, t, begin_, h);
  y = begin_.value;
}

/// Puts the rate `f1_` into the implicit formula. @return by how much it moved the new point, in units of its own size
template <class Real> double Adams<Real>::correct(const Vector<Real>& y, double h) {
  using std::abs;
  const Real weight = Real(h) * implicit_[0];
  double worst = 0;
  for (Index i = 0; i < y.size(); ++i) {
    const Real next = known_[i] + weight * f1_[i], moved = abs(next - y1_[i]);
    y1_[i] = next;
    if (moved == Real(0)) continue;
    const Real size = std::max({Real(abs(y[i])), Real(abs(next)), Real(abs(Real(h) * rates_[0][i]))});
    const double one = static_cast<double>(moved / size);
    if (!(one <= worst) && !std::isnan(worst)) worst = one;  // not a number is the worst
  }
  return worst;
}

template <class Real>
std::optional<Failure> Adams<Real>::iterate(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  const double ulp = static_cast<double>(std::numeric_limits<Real>::epsilon());
  double before = 0, rate = 0;
  for (int n = 1;; ++n) {
    f.rate(t, y1_, f1_);
    const double change = correct(y, h);
    // Rounding errors of the rates may keep it moving by some ulp for ever.
    if (change <= 2 * ulp || (change <= 1000 * ulp && n > 1 && change >= before / 2)) break;
    if (n > 1 && before > 0) rate = change / before;
    if (n == adams_iterations || !std::isfinite(change)) {
      return not_solved(static_cast<double>(t) - h, h, change, n, rate);
    }
    before = change;
  }
  rates_.push() = f1_;
  have_rate_ = true;
  return {};
}

template <class Real>
Failure Adams<Real>::not_solved(double t, double h, double change, int iterations, double rate) const {
  const std::string advice = rate > 0 && std::isfinite(rate)
                                 ? fmt::format("a step below {:.2g}", 0.5 * std::abs(h) / std::max(rate, 0.5))
                                 : std::string("a shorter step");
  return {Outcome::Kind::solver_failure, -1, "step",
          fmt::format("'{}' could not solve its implicit step of {:.6g} at time {:.9g}: fixed-point iteration still "
                      "changed the solution by {:.2g} of its size after {} iterations; take {}, or an implicit method "
                      "that solves by Newton's iteration",
                      name_, h, t, change, iterations, advice)};
}

template <class Real> void Adams<Real>::moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  if (have_rate_) f.rate(t, y, rates_.newest());
}

template <class Real> void Adams<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "step", h_);
  save_value(saved, prefix + "have_rate", have_rate_);
  rates_.save(saved, prefix + "rates");
}

template <class Real> void Adams<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "step", h_);
  load_value(saved, prefix + "have_rate", have_rate_);
  rates_.load(saved, prefix + "rates");
}

template class Adams<double>;
template class Adams<Quad>;

}  // namespace noether
