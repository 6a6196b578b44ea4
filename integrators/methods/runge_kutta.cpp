#include "integrators/methods/runge_kutta.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/explicit_tableaus.hpp"

#include <utility>

namespace noether {

template <class Real>
RungeKutta<Real>::RungeKutta(const MethodInfo& info, const MethodOptions& options, const Tableau& table)
    : name_(info.name),
      order_(table.order),
      adaptive_(info.is_adaptive(options)),
      first_same_as_last_(table.first_same_as_last),
      tolerance_(info, options),
      first_(options.first.value_or(0)),
      a_(as_real<Real>(table.a)),
      b_(as_real<Real>(table.b)),
      c_(as_real<Real>(table.c)),
      e_(as_real<Real>(table.e)),
      control_(info.name == "dop853" ? 8 : table.embedded_order + 1, info.name == "dop853" ? 6 : 10) {}

template <class Real> MethodClaims RungeKutta<Real>::claims() const {
  return {.name = name_, .order = order_, .adaptive = adaptive_};
}

template <class Real> void RungeKutta<Real>::bind(const VectorField<Real>& f) {
  k_.assign(b_.size(), Vector<Real>(f.size()));
  for (Vector<Real>* v : {&y0_, &y1_, &e1_}) v->resize(f.size());
  have_first_ = false;
  control_.forget();
}

template <class Real>
double RungeKutta<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (control_.next() == 0)
    control_.start(first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, order_, tolerance_, h));
  return shorter(control_.next(), h, f.scales(y, tolerance_.rtol));
}

template <class Real>
void RungeKutta<Real>::combine(const std::vector<Real>& w, double h, const Vector<Real>& y, Vector<Real>& out) const {
  const Index n = y.size();
  const Real step(h);
  Real* sum = out.data();
  bool first = true;
  for (std::size_t j = 0; j < w.size(); ++j) {
    if (w[j] == Real(0)) continue;
    const Real* k = k_[j].data();
    if (first) {
      for (Index i = 0; i < n; ++i) sum[i] = w[j] * k[i];
    } else {
      for (Index i = 0; i < n; ++i) sum[i] += w[j] * k[i];
    }
    first = false;
  }
  for (Index i = 0; i < n; ++i) sum[i] = first ? y[i] : y[i] + step * sum[i];
}

template <class Real>
StepResult RungeKutta<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made;
  if (!have_first_) f.rate(t, y, k_[0]);
  while (true) {
    made.h = adaptive_ ? next_step(f, t, y, h) : h;
    if (adaptive_) {
      made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
      if (made.failure) return made;
    }
    for (std::size_t i = 1; i < b_.size(); ++i) {
      combine(a_[i], made.h, y, y1_);
      f.rate(t + c_[i] * Real(made.h), y1_, k_[i]);
    }
    // With FSAL the last stage stands at the new point already.
    if (!first_same_as_last_) combine(b_, made.h, y, y1_);
    if (!adaptive_ || control_.accept(made.h, error(f.scales(y, tolerance_.rtol), made.h, y))) break;
    ++made.rejected;
  }
  y0_ = y;
  y = y1_;
  t0_ = t;
  h_ = made.h;
  have_first_ = first_same_as_last_;
  if (have_first_) std::swap(k_[0], k_[b_.size() - 1]);
  return made;
}

template <class Real> double RungeKutta<Real>::error(const ParticleScales& scales, double h, const Vector<Real>& y) {
  e1_.setZero();
  for (std::size_t j = 0; j < e_.size(); ++j) {
    if (e_[j] == Real(0)) continue;
    for (Index i = 0; i < y.size(); ++i) e1_[i] += e_[j] * k_[j][i];
  }
  for (Index i = 0; i < y.size(); ++i) e1_[i] *= Real(h);
  return tolerance_.norm(scales, e1_, y, y1_);
}

template <class Real> void RungeKutta<Real>::save(SavedState& saved, const std::string& prefix) const {
  control_.save(saved, prefix + "control/");
  save_value(saved, prefix + "have_first", have_first_);
  std::vector<Real> first;
  if (have_first_) first.assign(k_[0].data(), k_[0].data() + k_[0].size());
  save_value(saved, prefix + "first", first);
}

template <class Real> void RungeKutta<Real>::load(const SavedState& saved, const std::string& prefix) {
  control_.load(saved, prefix + "control/");
  load_value(saved, prefix + "have_first", have_first_);
  std::vector<Real> first;
  load_value(saved, prefix + "first", first);
  if (!have_first_) return;
  for (Index i = 0; i < k_[0].size(); ++i) k_[0][i] = detail::element(first, static_cast<std::size_t>(i));
}

template <class Real>
DormandPrince5<Real>::DormandPrince5(const MethodInfo& info, const MethodOptions& options)
    : RungeKutta<Real>(info, options, tableaus::dormand_prince_5()),
      d_(as_real<Real>(tableaus::dormand_prince_5_dense())) {}

/// The cubic through both ends with their slopes, and one term of degree 4.
template <class Real>
void DormandPrince5<Real>::interpolate(VectorField<Real>& /*f*/, const Real& theta, Vector<Real>& y) {
  const Real h(this->h_), left = Real(1) - theta;
  // After the step the stages at its ends have changed places.
  const auto stage = [&](std::size_t j) -> const Vector<Real>& { return this->k_[j == 0 ? 6 : j == 6 ? 0 : j]; };
  for (Index i = 0; i < y.size(); ++i) {
    const Real change = this->y1_[i] - this->y0_[i], bend = h * stage(0)[i] - change;
    const Real twist = change - h * stage(6)[i] - bend;
    Real last(0);
    for (std::size_t j = 0; j < d_.size(); ++j) {
      if (d_[j] != Real(0)) last += d_[j] * stage(j)[i];
    }
    y[i] = this->y0_[i] + theta * (change + left * (bend + theta * (twist + left * (h * last))));
  }
}

template <class Real>
Dop853<Real>::Dop853(const MethodInfo& info, const MethodOptions& options)
    : RungeKutta<Real>(info, options, tableaus::dop853()),
      e3_(as_real<Real>(tableaus::dop853_third_order_error())),
      more_a_(as_real<Real>(tableaus::dop853_dense().a)),
      d_(as_real<Real>(tableaus::dop853_dense().d)),
      more_c_(as_real<Real>(tableaus::dop853_dense().c)) {}

template <class Real> void Dop853<Real>::bind(const VectorField<Real>& f) {
  RungeKutta<Real>::bind(f);
  for (std::size_t j = 0; j < more_a_.size(); ++j) this->k_.emplace_back(f.size());
  terms_.assign(7, Vector<Real>(f.size()));
  have_terms_ = false;
}

template <class Real> StepResult Dop853<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  have_terms_ = false;
  return RungeKutta<Real>::step(f, t, y, h);
}

template <class Real> double Dop853<Real>::error(const ParticleScales& scales, double h, const Vector<Real>& y) {
  const auto norm = [&](const std::vector<Real>& weights) {
    this->e1_.setZero();
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (weights[j] == Real(0)) continue;
      for (Index i = 0; i < y.size(); ++i) this->e1_[i] += weights[j] * this->k_[j][i];
    }
    return this->tolerance_.norm(scales, this->e1_, y, this->y1_);
  };
  const double five = norm(this->e_), three = norm(e3_);
  const double both = five * five + 0.01 * three * three;
  return both > 0 ? std::abs(h) * five * five / std::sqrt(both) : both;
}

template <class Real> void Dop853<Real>::interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) {
  const Real h(this->h_);
  auto& k = this->k_;
  if (!have_terms_) {
    std::swap(k[0], k[12]);  // as they were during the step
    for (std::size_t s = 0; s < more_a_.size(); ++s) {
      this->combine(more_a_[s], this->h_, this->y0_, this->e1_);
      f.rate(this->t0_ + more_c_[s] * h, this->e1_, k[13 + s]);
    }
    for (Index i = 0; i < y.size(); ++i) {
      const Real change = this->y1_[i] - this->y0_[i], bend = h * k[0][i] - change;
      terms_[0][i] = change;
      terms_[1][i] = bend;
      terms_[2][i] = change - h * k[12][i] - bend;
    }
    for (std::size_t q = 0; q < d_.size(); ++q) {
      terms_[3 + q].setZero();
      for (std::size_t j = 0; j < d_[q].size(); ++j) {
        if (d_[q][j] == Real(0)) continue;
        for (Index i = 0; i < y.size(); ++i) terms_[3 + q][i] += h * d_[q][j] * k[j][i];
      }
    }
    std::swap(k[0], k[12]);
    have_terms_ = true;
  }
  const Real left = Real(1) - theta;
  for (Index i = 0; i < y.size(); ++i) {
    Real sum = terms_[6][i] * theta;
    sum = (sum + terms_[5][i]) * left;
    sum = (sum + terms_[4][i]) * theta;
    sum = (sum + terms_[3][i]) * left;
    sum = (sum + terms_[2][i]) * theta;
    sum = (sum + terms_[1][i]) * left;
    y[i] = this->y0_[i] + theta * (sum + terms_[0][i]);
  }
}

template class RungeKutta<double>;
template class RungeKutta<Quad>;
template class DormandPrince5<double>;
template class DormandPrince5<Quad>;
template class Dop853<double>;
template class Dop853<Quad>;

namespace methods {

namespace {

const Tableau& table_of(std::string_view name) {
  for (const tableaus::NamedTableau& known : tableaus::all_explicit()) {
    if (known.name == name) return known.table();
  }
  throw LogicError("there is no table of '" + std::string(name) + "'");
}

template <class Real> std::unique_ptr<Method<Real>> plain(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<RungeKutta<Real>>(info, options, table_of(info.name));
}
template <template <class> class M, class Real>
std::unique_ptr<Method<Real>> own(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<M<Real>>(info, options);
}

}  // namespace

std::span<const MethodInfo> runge_kutta_list() {
  static const MethodInfo list[] = {
      {.name = "euler",
       .aliases = "explicit_euler",
       .summary = "explicit Euler: order 1, unstable on every oscillator",
       .use = "teaching: every oscillation grows",
       .source = "HairerNoersettWanner1993",
       .family = "runge-kutta",
       .order = 1,
       .evaluations = 1,
       .stability_limit = 0,
       .make = plain<double>,
       .make_quad = plain<Quad>},
      {.name = "heun",
       .aliases = "rk2 explicit_trapezoidal",
       .summary = "Heun's method: order 2 by two evaluations",
       .use = "teaching, and short runs of smooth systems",
       .source = "HairerNoersettWanner1993",
       .family = "runge-kutta",
       .order = 2,
       .evaluations = 2,
       .stability_limit = 0,
       .make = plain<double>,
       .make_quad = plain<Quad>},
      {.name = "rk4",
       .aliases = "runge_kutta_4 kutta_4",
       .summary = "Kutta's classical method: order 4 by four evaluations; damps oscillations",
       .use = "short runs of smooth systems with steps of one length",
       .source = "HairerNoersettWanner1993",
       .family = "runge-kutta",
       .order = 4,
       .evaluations = 4,
       .stability_limit = 2.8284271247461903,
       .make = plain<double>,
       .make_quad = plain<Quad>},
      {.name = "dormand_prince_5",
       .aliases = "dopri5 rk45 dormand_prince_54",
       .summary = "Dormand and Prince's 5(4): six evaluations per step, dense output",
       .use = "systems of first order that are not stiff, relative errors of 1e-3 to 1e-6",
       .source = "DormandPrince1980",
       .family = "runge-kutta",
       .order = 5,
       .evaluations = 6,
       .adaptive = true,
       .stability_limit = 0.99719,
       .make = own<DormandPrince5, double>,
       .make_quad = own<DormandPrince5, Quad>},
      {.name = "cash_karp_5",
       .aliases = "cash_karp cash_karp_54",
       .summary = "Cash and Karp's 5(4): six evaluations per step",
       .use = "comparison with published runs; dormand_prince_5 costs less and is stable where it oscillates",
       .source = "CashKarp1990",
       .family = "runge-kutta",
       .order = 5,
       .evaluations = 6,
       .adaptive = true,
       .stability_limit = 0,
       .make = plain<double>,
       .make_quad = plain<Quad>},
      {.name = "dop853",
       .aliases = "dormand_prince_8 dormand_prince_853",
       .summary = "Dormand and Prince's 8(5,3): twelve evaluations per step, dense output of order 7",
       .use = "systems that are not stiff, relative errors of 1e-6 to 1e-12; forces of velocities",
       .source = "HairerNoersettWanner1993",
       .family = "runge-kutta",
       .order = 8,
       .evaluations = 12,
       .adaptive = true,
       .stability_limit = 5.96036,
       .make = own<Dop853, double>,
       .make_quad = own<Dop853, Quad>},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
