#include "integrators/methods/adams_pece.hpp"

#include "integrators/methods/difference_formulas.hpp"

#include <cmath>

namespace noether {

template <class Real>
AdamsPece<Real>::AdamsPece(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name), tolerance_(info, options), first_(options.first.value_or(0)) {
  const std::vector<Quad> coefficients = differences::adams_moulton(static_cast<int>(most));
  for (std::size_t j = 0; j < most; ++j) moulton_[j] = std::abs(static_cast<double>(coefficients[j]));
}

template <class Real> void AdamsPece<Real>::bind(const VectorField<Real>& f) {
  for (auto* vectors : {&d_, &star_, &trial_}) vectors->assign(most, Vector<Real>(f.size()));
  for (Vector<Real>* v : {&y0_, &y1_, &last_}) v->resize(f.size());
  past_.clear();
  past_.reserve(most);
  k_ = 1;
  known_ = constant_ = used_ = 0;
  next_ = h_ = 0;
  rising_ = true;
  failed_ = 0;
}

template <class Real>
double AdamsPece<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (next_ == 0) next_ = first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, 1, tolerance_, h);
  return shorter(next_, h, f.scales(y, tolerance_.rtol));
}

template <class Real> StepResult AdamsPece<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  if (known_ == 0) {
    f.rate(t, y, d_[0]);
    known_ = 1;
  }
  y0_ = y;
  scales_ = &f.scales(y, tolerance_.rtol);
  failed_ = 0;
  while (true) {
    made.h = next_step(f, t, y, h);
    made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
    if (made.failure) return made;
    prepare(made.h);
    predict(y, made.h);
    f.rate(t + Real(made.h), y1_, trial_[0]);
    differences(k_);
    const Errors errors = estimate(made.h);
    const double error = std::abs(made.h * static_cast<double>(g_[k_] - g_[k_ - 1])) * norm(trial_[k_]);
    if (error <= 1) {
      accept(f, t, y, made.h, errors);
      return made;
    }
    ++made.rejected;
    reject(made.h, errors);
  }
}

/// Everything that depends on the grid of times only, and d*.
template <class Real> void AdamsPece<Real>::prepare(double h) {
  const Real step(h);
  since_[0] = step;
  for (std::size_t i = 0; i + 1 < most; ++i) since_[i + 1] = since_[i] + Real(i < past_.size() ? past_[i] : h);
  basis_[0].fill(Real(0));
  basis_[0][0] = Real(1);
  for (std::size_t j = 0; j <= k_; ++j) {
    g_[j] = integral(j, Real(1));
    // B_(j+1) = B_j (s h + t_n - t_(n-j)) / (h + t_n - t_(n-j)): all coefficients are positive.
    const Real slope = step / since_[j], constant = (since_[j] - step) / since_[j];
    basis_[j + 1].fill(Real(0));
    for (std::size_t m = 0; m <= j; ++m) {
      basis_[j + 1][m] += constant * basis_[j][m];
      basis_[j + 1][m + 1] += slope * basis_[j][m];
    }
  }
  Real beta(1);
  for (std::size_t j = 0; j < known_; ++j) {
    for (Index i = 0; i < y0_.size(); ++i) star_[j][i] = beta * d_[j][i];
    if (j + 1 < known_) beta *= since_[j] / (since_[j + 1] - step);
  }
}

/// Integral of B_j from 0 to s.
template <class Real> Real AdamsPece<Real>::integral(std::size_t j, const Real& s) const {
  Real sum(0);
  for (std::size_t m = j + 1; m-- > 0;) sum = sum * s + basis_[j][m] / Real(static_cast<double>(m + 1));
  return sum * s;
}

template <class Real> void AdamsPece<Real>::predict(const Vector<Real>& y, double h) {
  for (Index i = 0; i < y.size(); ++i) {
    Real sum(0);
    for (std::size_t j = k_; j-- > 0;) sum += g_[j] * star_[j][i];
    y1_[i] = y[i] + Real(h) * sum;
  }
}

/// Differences at the new point, from its rate in `trial_[0]`, up to number `last`.
template <class Real> void AdamsPece<Real>::differences(std::size_t last) {
  for (std::size_t j = 0; j < last; ++j) {
    for (Index i = 0; i < y0_.size(); ++i) trial_[j + 1][i] = trial_[j][i] - star_[j][i];
  }
}

template <class Real> typename AdamsPece<Real>::Errors AdamsPece<Real>::estimate(double h) const {
  // What the difference of number j would be if the last j steps had been as long as this one.
  const auto error = [&](std::size_t j) {
    double equal = 1;
    for (std::size_t i = 1; i <= j; ++i) equal *= static_cast<double>(i) * h / static_cast<double>(since_[i - 1]);
    return std::abs(h) * moulton_[j] * equal * norm(trial_[j]);
  };
  return {error(k_), k_ > 1 ? error(k_ - 1) : 0, k_ > 2 ? error(k_ - 2) : 0};
}

template <class Real> bool AdamsPece<Real>::lower_is_better(const Errors& errors) const {
  if (k_ > 2) return std::max(errors.below, errors.far_below) <= errors.here;
  return k_ == 2 && errors.below <= 0.5 * errors.here;
}

template <class Real> void AdamsPece<Real>::reject(double h, const Errors& errors) {
  rising_ = false;
  constant_ = 0;
  ++failed_;
  if (lower_is_better(errors)) --k_;
  double factor = 0.5;
  if (failed_ >= 3) {
    // The past is of no use: a new start.
    k_ = 1;
    const double best = std::sqrt(0.5 / errors.here);
    factor = std::isfinite(best) ? std::clamp(best, 0.01, 0.5) : 0.1;
  }
  next_ = h * factor;
}

template <class Real>
void AdamsPece<Real>::accept(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h, const Errors& errors) {
  last_ = trial_[k_];
  for (Index i = 0; i < y.size(); ++i) y1_[i] += Real(h) * g_[k_] * last_[i];
  f.rate(t + Real(h), y1_, trial_[0]);
  const std::size_t reach = std::min({known_, k_ + 1, most - 1});
  differences(reach);
  constant_ = !past_.empty() && past_.front() == h ? constant_ + 1 : 1;
  if (past_.size() == most - 1) past_.pop_back();
  past_.insert(past_.begin(), h);
  y = y1_;
  h_ = h;
  used_ = k_;
  known_ = reach + 1;
  choose(h, errors);
  d_.swap(trial_);
}

/// Order and length of the next step.
template <class Real> void AdamsPece<Real>::choose(double h, Errors errors) {
  const bool lower = lower_is_better(errors);
  if (lower || k_ == most_order) rising_ = false;
  if (rising_) {
    ++k_;
    next_ = 2 * h;
    return;
  }
  if (lower) {
    --k_;
    errors.here = errors.below;
  } else if (k_ < most_order && constant_ > k_ && known_ > k_ + 1) {
    const double above = std::abs(h) * moulton_[k_ + 1] * norm(trial_[k_ + 1]);
    if (k_ > 1 && errors.below <= std::min(errors.here, above)) {
      --k_;
      errors.here = errors.below;
    } else if (above < (k_ == 1 ? 0.5 : 1) * errors.here) {
      ++k_;
      errors.here = above;
    }
  }
  // Steps of one length are worth more than the best length: the order can only rise along them.
  const double order = static_cast<double>(k_ + 1);
  if (errors.here * std::pow(2.0, order) <= 0.5) {
    next_ = 2 * h;
  } else if (errors.here <= 0.5) {
    next_ = h;
  } else {
    next_ = h * std::clamp(std::pow(0.5 / errors.here, 1 / order), 0.5, 0.9);
  }
}

template <class Real> void AdamsPece<Real>::interpolate(VectorField<Real>& /*f*/, const Real& theta, Vector<Real>& y) {
  std::array<Real, most> weights;
  for (std::size_t j = 0; j <= used_; ++j) weights[j] = Real(h_) * integral(j, theta);
  for (Index i = 0; i < y.size(); ++i) {
    Real sum = weights[used_] * last_[i];
    for (std::size_t j = used_; j-- > 0;) sum += weights[j] * star_[j][i];
    y[i] = y0_[i] + sum;
  }
}

/// A difference of any number is the newest rate less what does not depend on it.
template <class Real> void AdamsPece<Real>::moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  if (known_ == 0) return;
  Vector<Real>& rate = trial_[0];
  f.rate(t, y, rate);
  for (Index i = 0; i < y.size(); ++i) {
    const Real change = rate[i] - d_[0][i];
    for (std::size_t j = 0; j < known_; ++j) d_[j][i] += change;
  }
}

template <class Real> void AdamsPece<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "order", k_);
  save_value(saved, prefix + "known", known_);
  save_value(saved, prefix + "constant", constant_);
  save_value(saved, prefix + "past", past_);
  save_value(saved, prefix + "next", next_);
  save_value(saved, prefix + "rising", rising_);
  for (std::size_t j = 0; j < known_; ++j) save_vector(saved, prefix + "difference/" + std::to_string(j), d_[j]);
}

template <class Real> void AdamsPece<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "order", k_);
  load_value(saved, prefix + "known", known_);
  load_value(saved, prefix + "constant", constant_);
  load_value(saved, prefix + "past", past_);
  load_value(saved, prefix + "next", next_);
  load_value(saved, prefix + "rising", rising_);
  if (known_ > most || k_ < 1 || k_ > most_order || past_.size() >= most) {
    throw Error("a saved Adams method has a longer past than the method can keep");
  }
  past_.reserve(most);
  for (std::size_t j = 0; j < known_; ++j) load_vector(saved, prefix + "difference/" + std::to_string(j), d_[j]);
}

template class AdamsPece<double>;
template class AdamsPece<Quad>;

}  // namespace noether
