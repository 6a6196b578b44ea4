#include "integrators/methods/extrapolation.hpp"

#include "integrators/all_methods.hpp"

#include <cmath>

namespace noether {

template <class Real>
Extrapolation<Real>::Extrapolation(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name),
      tolerance_(info, options),
      first_(options.first.value_or(0)),
      length_(most + 1, 0),
      per_time_(most + 1, 0) {}

template <class Real> void Extrapolation<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  leapfrog_ = field.second_order && !field.velocity_dependent;
  parts_.assign(most + 2, 0);
  work_.assign(most + 2, 1);
  for (std::size_t j = 1; j < parts_.size(); ++j) {
    parts_[j] = static_cast<int>(leapfrog_ ? j : 2 * j);
    work_[j] = work_[j - 1] + parts_[j];
  }
  t_.assign(most + 1, Vector<Real>(f.size()));
  for (Vector<Real>* v : {&f0_, &f1_, &y1_, &past_, &sum_}) v->resize(f.size());
  // The lower the tolerance, the more rows: about what the first step will need.
  const double digits = -std::log10(std::max(tolerance_.rtol, 1e-36));
  target_ = std::clamp<std::size_t>(static_cast<std::size_t>(0.6 * digits + 1.5), 2, most - 1);
  next_ = 0;
  begun_ = rejected_ = false;
}

template <class Real>
double Extrapolation<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (next_ == 0)
    next_ =
        first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, 2 * static_cast<int>(target_) - 2, tolerance_, h);
  return shorter(next_, h, f.scales(y, tolerance_.rtol));
}

template <class Real>
StepResult Extrapolation<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  if (leapfrog_) {
    f.acceleration(t, y, f0_);
  } else {
    f.rate(t, y, f0_);
  }
  while (true) {
    made.h = next_step(f, t, y, h);
    made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
    if (made.failure) return made;
    const Verdict verdict = trial(f, t, y, made.h);
    if (verdict == Verdict::passed) break;
    ++made.rejected;
    if (verdict == Verdict::hopeless) {
      next_ = 0.5 * made.h;
      rejected_ = true;
    } else {
      after_rejection();
    }
  }
  y = y1_;
  after_success();
  return made;
}

/// Rows until the step passes or is given up.
template <class Real>
typename Extrapolation<Real>::Verdict Extrapolation<Real>::trial(VectorField<Real>& f, const Real& t,
                                                                 const Vector<Real>& y, double h) {
  double before = 0;
  for (std::size_t row = 1;; ++row) {
    const double error = add_row(f, t, y, h, row);
    rows_ = row;
    if (row == 1) continue;
    const Verdict verdict = judge(row, error, before);
    if (verdict != Verdict::go_on) return verdict;
    before = error;
  }
}

/// What an error norm after a row means: rows before the last but one that is expected do not count.
template <class Real>
typename Extrapolation<Real>::Verdict Extrapolation<Real>::judge(std::size_t row, double error, double before) const {
  if (!std::isfinite(error) || (row > 2 && error >= std::max(4 * before, 1.0))) return Verdict::hopeless;
  if (error <= 1 && (row + 1 >= target_ || !begun_)) return Verdict::passed;
  // Each further row j makes the error smaller by (n_j / n_1)^2 at most.
  const auto gain = [&](std::size_t j) { return std::pow(static_cast<double>(parts_[j]) / parts_[1], 2); };
  if (row + 1 == target_ && begun_ && error > gain(target_) * gain(target_ + 1)) return Verdict::rejected;
  if (row == target_ && error > gain(target_ + 1)) return Verdict::rejected;
  if (row == target_ + 1 || row == most) return error <= 1 ? Verdict::passed : Verdict::rejected;
  return Verdict::go_on;
}

/// One more row of the tableau. @return the error norm of its end
template <class Real>
double Extrapolation<Real>::add_row(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h,
                                    std::size_t row) {
  if (leapfrog_) {
    leapfrog(f, t, y, h, parts_[row], t_[row]);
  } else {
    midpoint(f, t, y, h, parts_[row], t_[row]);
  }
  const Index n = y.size();
  for (std::size_t k = row - 1; k > 0; --k) {
    const double now = parts_[row], then = parts_[k];
    const Real weight = Real(then * then) / Real(now * now - then * then);
    for (Index i = 0; i < n; ++i) t_[k][i] = t_[k + 1][i] + weight * (t_[k + 1][i] - t_[k][i]);
  }
  per_time_[row] = std::numeric_limits<double>::infinity();
  length_[row] = h;
  if (row == 1) return 0;
  for (Index i = 0; i < n; ++i) {
    y1_[i] = y[i] + t_[1][i];
    sum_[i] = t_[1][i] - t_[2][i];
  }
  const double error = tolerance_.norm(f.scales(y, tolerance_.rtol), sum_, y, y1_);
  const double power = 1.0 / static_cast<double>(2 * row - 1), least = std::pow(0.02, power);
  const double factor = std::clamp(0.94 * std::pow(0.65 / error, power), least / 4, 1 / least);
  length_[row] = h * factor;
  per_time_[row] = work_[row] / std::abs(length_[row]);
  return error;
}

/// Gragg's rule: the change of y over the step, and over its last two parts a mean that takes the oscillation away.
template <class Real>
void Extrapolation<Real>::midpoint(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, int parts,
                                   Vector<Real>& change) {
  const Index n = y.size();
  const Real part = Real(h) / Real(parts);
  for (Index i = 0; i < n; ++i) {
    past_[i] = Real(0);
    change[i] = part * f0_[i];
  }
  for (int p = 1; p <= parts; ++p) {
    for (Index i = 0; i < n; ++i) y1_[i] = y[i] + change[i];
    f.rate(t + Real(p) * part, y1_, f1_);
    if (p == parts) break;
    for (Index i = 0; i < n; ++i) {
      const Real next = past_[i] + Real(2) * part * f1_[i];
      past_[i] = change[i];
      change[i] = next;
    }
  }
  for (Index i = 0; i < n; ++i) change[i] = (past_[i] + change[i] + part * f1_[i]) / Real(2);
}

/// Stoermer's rule for q'' = a(t, q): half a kick, then drifts and kicks in turn, half a kick.
template <class Real>
void Extrapolation<Real>::leapfrog(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, int parts,
                                   Vector<Real>& change) {
  const Index half = y.size() / 2;
  const Real part = Real(h) / Real(parts);
  y1_ = y;
  for (Index i = 0; i < half; ++i) {
    change[i] = Real(0);
    sum_[i] = f0_[i] / Real(2);
  }
  for (int p = 1; p <= parts; ++p) {
    for (Index i = 0; i < half; ++i) {
      change[i] += part * (y[half + i] + part * sum_[i]);
      y1_[i] = y[i] + change[i];
    }
    f.acceleration(t + Real(p) * part, y1_, f1_);
    for (Index i = 0; i < half; ++i) sum_[i] += p == parts ? f1_[i] / Real(2) : f1_[i];
  }
  for (Index i = 0; i < half; ++i) change[half + i] = part * sum_[i];
}

/// Row and step of least work per time for the step that follows.
template <class Real> void Extrapolation<Real>::after_success() {
  const std::size_t row = rows_, top = most - 1;
  std::size_t best;
  if (row == 2) {
    best = rejected_ ? 2 : std::min<std::size_t>(3, top);
  } else if (row <= target_) {
    best = row;
    if (per_time_[row - 1] < 0.8 * per_time_[row]) best = row - 1;
    if (per_time_[row] < 0.9 * per_time_[row - 1]) best = std::min(row + 1, top);
  } else {
    best = row - 1;
    if (row > 3 && per_time_[row - 2] < 0.8 * per_time_[row - 1]) best = row - 2;
    if (per_time_[row] < 0.9 * per_time_[best]) best = std::min(row, top);
  }
  best = std::max<std::size_t>(best, 2);
  if (best <= row) {
    next_ = length_[best];
  } else {
    next_ = length_[row] * work_[best] / work_[row];
  }
  if (rejected_) {
    // No rise right after a rejected trial.
    best = std::min(best, row);
    next_ = shorter(next_, length_[best]);
  }
  target_ = best;
  begun_ = true;
  rejected_ = false;
}

template <class Real> void Extrapolation<Real>::after_rejection() {
  target_ = std::max<std::size_t>(std::min({target_, rows_, most - 1}), 2);
  if (target_ > 2 && per_time_[target_ - 1] < 0.8 * per_time_[target_]) --target_;
  next_ = length_[target_];
  rejected_ = true;
}

template <class Real> void Extrapolation<Real>::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "next", next_);
  save_value(saved, prefix + "target", target_);
  save_value(saved, prefix + "begun", begun_);
  save_value(saved, prefix + "rejected", rejected_);
}

template <class Real> void Extrapolation<Real>::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "next", next_);
  load_value(saved, prefix + "target", target_);
  load_value(saved, prefix + "begun", begun_);
  load_value(saved, prefix + "rejected", rejected_);
  if (target_ < 2 || target_ >= most) throw Error("a saved extrapolation refers to a row that does not exist");
}

template class Extrapolation<double>;
template class Extrapolation<Quad>;

namespace methods {

namespace {

template <class Real>
std::unique_ptr<Method<Real>> extrapolation(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Extrapolation<Real>>(info, options);
}

}  // namespace

std::span<const MethodInfo> extrapolation_list() {
  static const MethodInfo list[] = {
      {.name = "gragg_bulirsch_stoer",
       .aliases = "gbs bulirsch_stoer odex",
       .summary = "extrapolated midpoint rule, or leapfrog where forces depend on positions only; steps and orders "
                  "chosen by the method, up to 16 in double and 24 in Quad",
       .use = "errors near rounding over short times, extended precision above all",
       .source = "HairerNoersettWanner1993",
       .family = "extrapolation",
       .order = 16,
       .fixed = false,
       .adaptive = true,
       .make = extrapolation<double>,
       .make_quad = extrapolation<Quad>},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
