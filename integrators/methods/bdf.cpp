#include "integrators/methods/bdf.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/newton.hpp"

#include <cmath>
#include <limits>

namespace noether {

template <class Real> void BackwardDifferences<Real>::bind(Index n, std::size_t count) {
  d_.assign(count, Vector<Real>(n));
  for (auto& d : d_) d.setZero();
  work_.assign(count * (count + 1), Real(0));
}

template <class Real>
void BackwardDifferences<Real>::evaluate(std::size_t order, const Real& s, Vector<Real>& y) const {
  Real basis(1);
  y = d_[0];
  for (std::size_t j = 1; j <= order; ++j) {
    basis *= (s + Real(static_cast<double>(j - 1))) / Real(static_cast<double>(j));
    for (Index i = 0; i < y.size(); ++i) y[i] += basis * d_[j][i];
  }
}

/// D'_k = sum_i (-1)^i binomial(k, i) p(t_n - i factor h) is a combination of D_1 to D_q: the constant drops out, so
/// that small differences keep their digits.
template <class Real> void BackwardDifferences<Real>::respace(std::size_t order, const Real& factor) {
  const std::size_t count = d_.size();
  Real* const row = work_.data();              // basis functions at one node, then old differences of one component
  Real* const weights = work_.data() + count;  // of D_j in D'_k
  std::fill(weights, weights + count * count, Real(0));
  for (std::size_t i = 0; i <= order; ++i) {
    const Real s = -factor * Real(static_cast<double>(i));
    row[0] = Real(1);
    for (std::size_t j = 1; j <= order; ++j) {
      row[j] = row[j - 1] * (s + Real(static_cast<double>(j - 1))) / Real(static_cast<double>(j));
    }
    double signed_binomial = i % 2 == 0 ? 1 : -1;
    for (std::size_t k = i; k <= order; ++k) {
      for (std::size_t j = 1; j <= order; ++j) weights[k * count + j] += Real(signed_binomial) * row[j];
      signed_binomial = signed_binomial * static_cast<double>(k + 1) / static_cast<double>(k + 1 - i);
    }
  }
  for (Index n = 0; n < d_[0].size(); ++n) {
    for (std::size_t j = 1; j <= order; ++j) row[j] = d_[j][n];
    for (std::size_t k = 1; k <= order; ++k) {
      Real sum(0);
      for (std::size_t j = 1; j <= order; ++j) sum += weights[k * count + j] * row[j];
      d_[k][n] = sum;
    }
  }
}

template <class Real> void BackwardDifferences<Real>::append(std::size_t last) {
  for (std::size_t j = last; j-- > 0;) {
    for (Index i = 0; i < d_[j].size(); ++i) d_[j][i] += d_[j + 1][i];
  }
}

template <class Real> void BackwardDifferences<Real>::replace(std::size_t last, const Vector<Real>& y) {
  for (Index i = 0; i < y.size(); ++i) {
    const Real change = y[i] - d_[0][i];
    for (std::size_t j = 1; j <= last; ++j) d_[j][i] += change;
  }
  d_[0] = y;
}

template <class Real> void BackwardDifferences<Real>::save(SavedState& saved, const std::string& prefix) const {
  std::vector<Real> all;
  for (const auto& d : d_) all.insert(all.end(), d.data(), d.data() + d.size());
  save_value(saved, prefix + "differences", all);
}

template <class Real> void BackwardDifferences<Real>::load(const SavedState& saved, const std::string& prefix) {
  std::vector<Real> all;
  load_value(saved, prefix + "differences", all);
  std::size_t at = 0;
  for (auto& d : d_) {
    for (Index i = 0; i < d.size(); ++i) d[i] = detail::element(all, at++);
  }
}

namespace {

/// How accurately Newton's iteration solves a step: a small part of the tolerance, but not below rounding.
double newton_tolerance(const Tolerance& tolerance, double rounding) {
  if (!(tolerance.rtol > 0)) return 0.01;
  return std::max(10 * rounding / tolerance.rtol, std::min(0.03, std::sqrt(tolerance.rtol)));
}

/// past = sum of (1 + 1/2 + ... + 1/j) D_j, j from 1 to `last`; predicted = sum of D_j, j from 0.
template <class Real>
void predict_from(const BackwardDifferences<Real>& d, std::size_t last, Vector<Real>& predicted, Vector<Real>& past) {
  predicted = d[0];
  past.setZero(predicted.size());
  Real harmonic(0);
  for (std::size_t j = 1; j <= last; ++j) {
    harmonic += Real(1) / Real(static_cast<double>(j));
    for (Index i = 0; i < predicted.size(); ++i) {
      predicted[i] += d[j][i];
      past[i] += harmonic * d[j][i];
    }
  }
}

}  // namespace

template <class Real>
Bdf<Real>::Bdf(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      tolerance_(info, options),
      form_(options.jacobian),
      first_(options.first.value_or(0)),
      newton_tolerance_(newton_tolerance(tolerance_, static_cast<double>(std::numeric_limits<Real>::epsilon()))) {
  for (std::size_t q = 1; q <= highest; ++q) {
    harmonic_[q] = harmonic_[q - 1] + Real(1) / Real(static_cast<double>(q));
  }
}

template <class Real> void Bdf<Real>::bind(const VectorField<Real>& f) {
  jacobian_.bind(f, {.form = form_, .tolerance = tolerance_});
  d_.bind(f.size(), highest + 3);
  for (Vector<Real>* v : {&predicted_, &past_, &correction_, &y1_, &update_}) v->setZero(f.size());
  order_ = next_order_ = 1;
  h_ = next_h_ = factorized_for_ = 0;
  equal_ = 0;
  started_ = have_jacobian_ = false;
}

template <class Real>
double Bdf<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (next_h_ == 0) next_h_ = first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, 1, tolerance_, h);
  return shorter(next_h_, h, f.scales(y, tolerance_.rtol));
}

/// Puts the differences at distances `h`.
template <class Real> void Bdf<Real>::space(double h) {
  if (h == h_) return;
  d_.respace(order_, Real(h) / Real(h_));
  h_ = h;
  equal_ = 0;
}

/// One Newton iteration with the present factors, from the predicted value; it ends where what is left is small.
template <class Real> typename Bdf<Real>::Solved Bdf<Real>::iterate(VectorField<Real>& f, const Real& end) {
  constexpr int most = 5;
  const double weight_in_double = h_ / static_cast<double>(harmonic_[order_]);
  const Real weight = Real(h_) / harmonic_[order_];
  if (factorized_for_ != weight_in_double) {
    factorized_for_ = 0;
    if (!jacobian_.factorize(Real(1), weight)) return Solved::singular;
    factorized_for_ = weight_in_double;
  }
  correction_.setZero();
  y1_ = predicted_;
  double before = 0;
  for (int k = 1; k <= most; ++k) {
    f.rate(end, y1_, update_);
    for (Index i = 0; i < y1_.size(); ++i) {
      update_[i] = weight * update_[i] - past_[i] / harmonic_[order_] - correction_[i];
    }
    if (!jacobian_.solve(f, update_)) return Solved::slowly;
    const double now = tolerance_.norm(*scales_, update_, predicted_, y1_);
    if (!std::isfinite(now)) return Solved::slowly;
    for (Index i = 0; i < y1_.size(); ++i) {
      correction_[i] += update_[i];
      y1_[i] = predicted_[i] + correction_[i];
    }
    if (now == 0) return Solved::yes;
    if (k > 1) {
      const double rate = now / before;
      if (rate >= 1 && now > newton_tolerance_) return Solved::slowly;
      if (now <= newton_tolerance_ * std::max(1e-3, (1 - rate) / rate)) return Solved::yes;
      if (std::pow(rate, most - k) / (1 - rate) * now > newton_tolerance_) return Solved::slowly;
    }
    before = now;
  }
  return Solved::slowly;
}

/// Solves a step, with the kept Jacobian, then with one from here.
template <class Real> bool Bdf<Real>::solve(VectorField<Real>& f, const Real& end) {
  if (have_jacobian_ && iterate(f, end) == Solved::yes) return true;
  jacobian_.evaluate(f, end, predicted_);
  have_jacobian_ = true;
  factorized_for_ = 0;
  return iterate(f, end) == Solved::yes;
}

/// Norm of the error that a step of `order` makes, by the difference beyond it.
template <class Real> double Bdf<Real>::error(std::size_t order, const Vector<Real>& y) {
  const Vector<Real>& d = d_[order + 1];
  return tolerance_.norm(*scales_, d, y, y1_) / static_cast<double>(order + 1);
}

template <class Real> StepResult Bdf<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  scales_ = &f.scales(y, tolerance_.rtol);
  const double tried = next_step(f, t, y, h);
  if (!started_) {
    h_ = next_h_;
    f.rate(t, y, d_[1]);
    for (Index i = 0; i < y.size(); ++i) d_[1][i] *= Real(h_);
    started_ = true;
  }
  d_[0] = y;
  if (order_ != next_order_) equal_ = 0;
  order_ = next_order_;
  space(tried);
  double norm = 0;
  for (int failed = 0;; ++made.rejected) {
    made.h = h_;
    made.failure = underflow(static_cast<double>(t), h_, *scales_);
    if (made.failure) return made;
    const Real end = t + Real(h_);
    predict_from(d_, order_, predicted_, past_);
    if (!solve(f, end)) {
      space(0.3 * h_);
      continue;
    }
    norm = tolerance_.norm(*scales_, correction_, y, y1_) / static_cast<double>(order_ + 1);
    if (norm <= 1) break;
    const double factor = 0.9 * std::pow(norm, -1.0 / static_cast<double>(order_ + 1));
    // What does not look like the past is followed at a lower order.
    if (++failed > 2 && order_ > 1) --order_;
    space(h_ * (std::isfinite(norm) ? std::clamp(factor, 0.2, 0.9) : 0.1));
  }
  for (Index i = 0; i < y.size(); ++i) d_[order_ + 2][i] = correction_[i] - d_[order_ + 1][i];
  d_[order_ + 1] = correction_;
  d_.append(order_ + 1);
  ++equal_;
  choose(norm, y);
  y = y1_;
  d_[0] = y;
  return made;
}

/// Chooses step and order of the next step: the order that allows the longest, with a preference for the present one.
template <class Real> void Bdf<Real>::choose(double now, const Vector<Real>& y) {
  next_h_ = h_;
  next_order_ = order_;
  if (equal_ < static_cast<std::int64_t>(order_) + 1) return;
  const auto factor = [](double norm, std::size_t order, double caution) {
    return std::pow(std::max(norm, 1e-10), -1.0 / static_cast<double>(order + 1)) / caution;
  };
  double best = factor(now, order_, 1.2);
  if (order_ > 1) {
    const double lower = factor(error(order_ - 1, y), order_ - 1, 1.3);
    if (lower > best) best = lower, next_order_ = order_ - 1;
  }
  if (order_ < highest) {
    const double higher = factor(error(order_ + 1, y), order_ + 1, 1.4);
    if (higher > best) best = higher, next_order_ = order_ + 1;
  }
  if (best >= 1.2 || best < 0.9) {
    next_h_ = h_ * std::clamp(best, 0.2, 10.0);
  } else {
    next_order_ = order_;
  }
}

template <class Real> void Bdf<Real>::interpolate(VectorField<Real>& /*f*/, const Real& theta, Vector<Real>& y) {
  d_.evaluate(order_, theta - Real(1), y);
}

template <class Real> void Bdf<Real>::moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& y) {
  if (started_) d_.replace(order_ + 2, y);
}

template <class Real> void Bdf<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "started", started_);
  save_value(saved, prefix + "steps", std::vector<double>{h_, next_h_, factorized_for_});
  save_value(saved, prefix + "orders",
             std::vector<std::int64_t>{static_cast<std::int64_t>(order_), static_cast<std::int64_t>(next_order_),
                                       equal_, have_jacobian_ ? 1 : 0});
  if (!started_) return;
  d_.save(saved, prefix);
  jacobian_.save(saved, prefix + "jacobian/");
}

template <class Real> void Bdf<Real>::load(const SavedState& saved, const std::string& prefix) {
  std::vector<double> steps;
  std::vector<std::int64_t> orders;
  load_value(saved, prefix + "started", started_);
  load_value(saved, prefix + "steps", steps);
  load_value(saved, prefix + "orders", orders);
  h_ = detail::element(steps, 0);
  next_h_ = detail::element(steps, 1);
  factorized_for_ = detail::element(steps, 2);
  const auto order = [&](std::size_t at) {
    const std::int64_t q = detail::element(orders, at);
    if (q < 1 || q > static_cast<std::int64_t>(highest)) throw Error(fmt::format("a saved order of BDF is {}", q));
    return static_cast<std::size_t>(q);
  };
  order_ = order(0);
  next_order_ = order(1);
  equal_ = detail::element(orders, 2);
  have_jacobian_ = detail::element(orders, 3) != 0;
  if (!started_) return;
  d_.load(saved, prefix);
  jacobian_.load(saved, prefix + "jacobian/");
}

template <class Real>
FixedBdf<Real>::FixedBdf(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      order_(static_cast<std::size_t>(info.order)),
      form_(options.jacobian),
      starter_(starting_rosenbrock<Real>(form_)) {}

template <class Real> void FixedBdf<Real>::bind(const VectorField<Real>& f) {
  starter_.bind(f);
  jacobian_.bind(f, {.form = form_});
  d_.bind(f.size(), order_ + 1);
  second_order_ = f.claims().second_order;
  for (Vector<Real>* v : {&predicted_, &past_, &correction_, &y1_, &update_}) v->setZero(f.size());
  known_ = 0;
  h_ = 0;
}

/// Puts y behind the values of the past, of which the oldest falls out.
template <class Real> void FixedBdf<Real>::remember(const Vector<Real>& y) {
  correction_ = y;
  for (std::size_t j = 0; j < std::min(known_ + 1, order_ + 1); ++j) {
    for (Index i = 0; i < y.size(); ++i) {
      const Real next = correction_[i] - d_[j][i];
      d_[j][i] = correction_[i];
      correction_[i] = next;
    }
  }
  if (known_ < order_) ++known_;
}

/// Solves sum_{j=1}^{k} grad^j y1 / j = h f for grad^k y1, from the prediction that it is 0.
template <class Real>
std::optional<Failure> FixedBdf<Real>::solve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  Real harmonic(0);
  for (std::size_t j = 1; j <= order_; ++j) harmonic += Real(1) / Real(static_cast<double>(j));
  const Real weight = Real(h) / harmonic, end = t + Real(h);
  predict_from(d_, order_ - 1, predicted_, past_);
  correction_.setZero();
  y1_ = predicted_;
  const auto correct = [&]() -> std::optional<UpdateSize> {
    f.rate(end, y1_, update_);
    for (Index i = 0; i < y1_.size(); ++i) update_[i] = weight * update_[i] - past_[i] / harmonic - correction_[i];
    if (!jacobian_.solve(f, update_)) return {};
    for (Index i = 0; i < y1_.size(); ++i) {
      correction_[i] += update_[i];
      y1_[i] = predicted_[i] + correction_[i];
    }
    return update_size(update_, predicted_, y1_, second_order_);
  };
  const auto restart = [&] {
    correction_.setZero();
    y1_ = predicted_;
  };
  const auto renew = [&] {
    jacobian_.evaluate(f, end, y1_);
    return jacobian_.factorize(Real(1), weight);
  };
  jacobian_.evaluate(f, t, y);
  if (!jacobian_.factorize(Real(1), weight)) return singular_matrix(h);
  return newton_to_rounding<Real>(correct, restart, renew);
}

template <class Real> StepResult FixedBdf<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = h};
  if (h != h_) known_ = 0;
  h_ = h;
  if (known_ == 0) remember(y);
  if (known_ < order_) {
    made = starter_.step(f, t, y, h);
  } else {
    made.failure = solve(f, t, y, h);
    if (!made.failure) y = y1_;
  }
  if (!made.failure) remember(y);
  return made;
}

template <class Real> void FixedBdf<Real>::moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& y) {
  if (known_ > 0) d_.replace(known_, y);
}

template <class Real> void FixedBdf<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "known", static_cast<std::int64_t>(known_));
  save_value(saved, prefix + "h", h_);
  d_.save(saved, prefix);
}

template <class Real> void FixedBdf<Real>::load(const SavedState& saved, const std::string& prefix) {
  std::int64_t known = 0;
  load_value(saved, prefix + "known", known);
  load_value(saved, prefix + "h", h_);
  known_ = static_cast<std::size_t>(std::clamp<std::int64_t>(known, 0, static_cast<std::int64_t>(order_)));
  d_.load(saved, prefix);
}

template class BackwardDifferences<double>;
template class BackwardDifferences<Quad>;
template class Bdf<double>;
template class Bdf<Quad>;
template class FixedBdf<double>;
template class FixedBdf<Quad>;

namespace {

template <class Real> std::unique_ptr<Method<Real>> make_bdf(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Bdf<Real>>(info, options);
}
template <class Real>
std::unique_ptr<Method<Real>> make_fixed_bdf(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<FixedBdf<Real>>(info, options);
}

MethodInfo fixed_bdf(std::string_view name, std::string_view summary, std::string_view use, int order, double limit) {
  return {.name = name,
          .summary = summary,
          .use = use,
          .source = "HairerWanner1996",
          .family = "multistep",
          .options = {linear_solver},
          .order = order,
          .stability_limit = limit,
          .make = make_fixed_bdf<double>,
          .make_quad = make_fixed_bdf<Quad>};
}

}  // namespace

std::span<const MethodInfo> methods::bdf_list() {
  static const MethodInfo list[] = {
      {.name = "bdf",
       .aliases = "bdf_variable gear",
       .summary = "backward differentiation of variable step and order 1 to 5 (6 at steps of one length only: bdf_6), "
                  "with Jacobians kept over steps; dense output",
       .use = "large stiff systems: Jacobians are kept, one solution per step",
       .source = "ShampineReichelt1997",
       .family = "multistep",
       .options = {linear_solver},
       .order = 5,
       .fixed = false,
       .adaptive = true,
       .make = make_bdf<double>,
       .make_quad = make_bdf<Quad>},
      fixed_bdf("bdf_2", "backward differentiation, order 2, A-stable",
                "stiff systems with steps of one length; oscillations are damped", 2,
                std::numeric_limits<double>::infinity()),
      fixed_bdf("bdf_3", "backward differentiation, order 3, A(86 degrees)",
                "stiff decay with steps of one length; slow oscillations grow", 3, 0),
      fixed_bdf("bdf_4", "backward differentiation, order 4, A(73 degrees)",
                "stiff decay with steps of one length; slow oscillations grow", 4, 0),
      fixed_bdf("bdf_5", "backward differentiation, order 5, A(51 degrees)",
                "stiff decay with steps of one length, away from oscillations", 5, 0.71081),
      fixed_bdf("bdf_6", "backward differentiation, order 6, A(17 degrees)",
                "comparison: stiff decay only, far from oscillations", 6, 0.84314),
  };
  return list;
}

}  // namespace noether
