#include "integrators/methods/wide_gauss.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/last_polynomial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace noether {

namespace {

/// Sweeps end when the next one is expected to change rates by no more than this part of them.
constexpr double settled_stages = 1e-16, settled_wide = 1e-20;
/// Changes below may be rounding, where bodies are so near to each other that doubles hardly tell their distance.
constexpr double stages_may_round = 1e-9;
/// So many sweeps are made before one that changes more than the one before it ends the step.
constexpr int patient_sweeps = 12;
constexpr int most_stage_sweeps = 60, most_wide_sweeps = 60;

/// r^-3 from r^2; in double-double by one step of Newton's from doubles.
double inverse_cube(double r2) { return 1 / (r2 * std::sqrt(r2)); }
DoubleDouble inverse_cube(const DoubleDouble& r2) {
  const double rough = inverse_cube(r2.high);
  const DoubleDouble left = 1.0 - r2 * r2 * r2 * DoubleDouble::product(rough, rough);
  return DoubleDouble::ordered_sum(rough, 0.5 * rough * left.high);
}

double high_word(double x) { return x; }
double high_word(const DoubleDouble& x) { return x.high; }

/// The largest change of any stage's rate of a body, relative to its largest rate; `rates` become `fresh`.
template <class Coordinates> double take_rates(Index n, const Coordinates& fresh, Coordinates& rates) {
  double worst = 0;
  for (Index i = 0; i < n; ++i) {
    double change = 0, size = 0;
    for (std::size_t s = 0; s < fresh.front().size(); ++s) {
      double change2 = 0, size2 = 0;
      for (Index k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k * n + i);
        const double rate = high_word(fresh[at][s]), difference = high_word(fresh[at][s] - rates[at][s]);
        change2 += difference * difference;
        size2 += rate * rate;
      }
      if (!(change2 <= change)) change = change2;  // a NaN stays
      if (!(size2 <= size)) size = size2;
    }
    if (change == 0) continue;
    const double relative = change / size;
    if (!std::isfinite(relative)) return relative;
    worst = std::max(worst, relative);
  }
  rates = fresh;
  return std::sqrt(worst);
}

}  // namespace

WideGauss::WideGauss(std::string_view name) : name_(name), ahead_(last_polynomial(gauss_table(stages))) {
  const CollocationTable& table = gauss_table(stages);
  const auto twice = table.twice();
  const auto twice_end = table.twice_end();
  const auto put = [](const Quad& x, double& high, DoubleDouble& both) {
    high = static_cast<double>(x);
    both = DoubleDouble(x);
  };
  for (std::size_t i = 0; i < stages; ++i) {
    put(table.c[i], table_.c[i], wide_table_.c[i]);
    put(table.b[i], table_.b[i], wide_table_.b[i]);
    put(twice_end[i], table_.twice_end[i], wide_table_.twice_end[i]);
    for (std::size_t j = 0; j < stages; ++j) put(twice[i][j], table_.twice[i][j], wide_table_.twice[i][j]);
  }
}

void WideGauss::bind(const VectorField<double>& f) {
  const std::optional<double> G = f.gravity_of_points();
  if (!G) throw SchemeMismatch(fmt::format("method '{}' is for gravity; use 'gauss_8'", name_));
  n_ = f.particles();
  coordinates_ = 3 * n_;
  const Vector<double> masses = f.masses();
  gm_.clear();
  for (Index i = 0; i < n_; ++i) gm_.push_back(DoubleDouble::product(*G, masses[i]));
  beside_ = f.has_forces_beside_gravity();
  const auto count = static_cast<std::size_t>(coordinates_);
  x_.assign(count, {});
  v_.assign(count, {});
  for (auto* all : {&rates_, &fresh_, &q_, &pushes_}) all->assign(count, Lanes<double>{});
  for (auto* all : {&wide_rates_, &wide_fresh_, &wide_q_}) all->assign(count, Lanes<DoubleDouble>{});
  stage_.setZero(f.size());
  stage_push_.setZero(coordinates_);
  low_.setZero(f.size());
  h_ = 0;
}

StepResult WideGauss::step(VectorField<double>& f, const double& t, Vector<double>& y, double h) {
  StepResult made{.h = h};
  begin(y, h);
  if (!sweep(f, t, h) || !sweep_wide(f, h)) {
    made.failure = f.failure();
    if (made.failure) return made;
    made.failure =
        Failure{Outcome::Kind::solver_failure, -1, "stages",
                fmt::format("the stages of '{}' do not converge with a step of {:.6g}; give a shorter one", name_, h)};
    return made;
  }
  finish(y, h);
  h_ = h;
  return made;
}

/// Rates begin as the polynomial of the last step has them in this one, or at zero.
void WideGauss::begin(const Vector<double>& y, double h) {
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const auto at = static_cast<Index>(k);
    x_[k] = DoubleDouble::sum(y[at], low_[at]);
    v_[k] = DoubleDouble::sum(y[coordinates_ + at], low_[coordinates_ + at]);
    const Lanes<double> before = rates_[k];
    rates_[k].fill(0);
    if (h != h_) continue;
    for (std::size_t i = 0; i < stages; ++i) {
      for (std::size_t j = 0; j < stages; ++j) rates_[k][i] += ahead_[i][j] * before[j];
    }
  }
}

/// Positions of all stages from their rates.
template <class Real>
void WideGauss::place(const Table<Real>& table, double h, const Coordinates<Real>& rates, Coordinates<Real>& q) const {
  const Real step(h), square = step * step;
  for (std::size_t k = 0; k < q.size(); ++k) {
    Real x, way;
    if constexpr (std::is_same_v<Real, double>) {
      x = x_[k].high;
      way = h * v_[k].high;
    } else {
      x = x_[k];
      way = step * v_[k];
    }
    for (std::size_t i = 0; i < stages; ++i) {
      Real sum = table.twice[i][0] * rates[k][0];
      for (std::size_t j = 1; j < stages; ++j) sum += table.twice[i][j] * rates[k][j];
      q[k][i] = x + (table.c[i] * way + square * sum);
    }
  }
}

/// Accelerations by gravity at all stages.
template <class Real> void WideGauss::attract(const Coordinates<Real>& q, Coordinates<Real>& rates) const {
  for (auto& rate : rates) rate.fill(Real(0));
  const auto n = static_cast<std::size_t>(n_);
  for (std::size_t i = 1; i < n; ++i) {
    const Real mi(static_cast<Real>(gm_[i]));
    for (std::size_t j = 0; j < i; ++j) {
      const Real mj(static_cast<Real>(gm_[j]));
      if (mi == Real(0) && mj == Real(0)) continue;
      for (std::size_t s = 0; s < stages; ++s) {
        const Real x = q[j][s] - q[i][s], y = q[n + j][s] - q[n + i][s], z = q[2 * n + j][s] - q[2 * n + i][s];
        const Real cube = inverse_cube(x * x + y * y + z * z), of_i = mj * cube, of_j = mi * cube;
        rates[i][s] += of_i * x;
        rates[n + i][s] += of_i * y;
        rates[2 * n + i][s] += of_i * z;
        rates[j][s] -= of_j * x;
        rates[n + j][s] -= of_j * y;
        rates[2 * n + j][s] -= of_j * z;
      }
    }
  }
}

/// Forces that are not gravity of points, at the stages as doubles have them: they are evaluated in doubles.
void WideGauss::add_forces_beside(VectorField<double>& f, double t, double h) {
  if (!beside_) return;
  for (std::size_t s = 0; s < stages; ++s) {
    for (std::size_t k = 0; k < q_.size(); ++k) stage_[static_cast<Index>(k)] = q_[k][s];
    f.accelerations_beside_gravity(t + table_.c[s] * h, stage_, stage_push_);
    for (std::size_t k = 0; k < q_.size(); ++k) pushes_[k][s] = stage_push_[static_cast<Index>(k)];
  }
}

/// Sweeps in doubles. @return whether the rates stand still but for rounding
bool WideGauss::sweep(VectorField<double>& f, double t, double h) {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_stage_sweeps; ++round) {
    place(table_, h, rates_, q_);
    attract(q_, fresh_);
    f.evaluations().force += stages;
    add_forces_beside(f, t, h);
    if (f.failure()) return false;
    for (std::size_t k = 0; beside_ && k < fresh_.size(); ++k) {
      for (std::size_t s = 0; s < stages; ++s) fresh_[k][s] += pushes_[k][s];
    }
    const double change = take_rates(n_, fresh_, rates_);
    if (!std::isfinite(change)) return false;
    const double shrinks = round > 1 ? change / before : 1;
    if (change * std::min(shrinks, 1.0) <= settled_stages) return true;
    if (round > 2 && shrinks >= 1) {
      if (change < stages_may_round) return true;
      if (round > patient_sweeps) return false;
    }
    before = change;
  }
  return false;
}

/// Sweeps in double-double, from where doubles have led. @return whether the rates stand still
bool WideGauss::sweep_wide(VectorField<double>& f, double h) {
  for (std::size_t k = 0; k < rates_.size(); ++k) {
    for (std::size_t s = 0; s < stages; ++s) wide_rates_[k][s] = rates_[k][s];
  }
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_wide_sweeps; ++round) {
    place(wide_table_, h, wide_rates_, wide_q_);
    attract(wide_q_, wide_fresh_);
    f.evaluations().force += stages;
    for (std::size_t k = 0; beside_ && k < wide_fresh_.size(); ++k) {
      for (std::size_t s = 0; s < stages; ++s) wide_fresh_[k][s] += DoubleDouble(pushes_[k][s]);
    }
    const double change = take_rates(n_, wide_fresh_, wide_rates_);
    if (!std::isfinite(change)) return false;
    const double shrinks = round > 1 ? change / before : 1;
    if (round > 1 && change * std::min(shrinks, 1.0) <= settled_wide) return true;
    if (round > patient_sweeps && shrinks >= 1) return false;
    before = change;
  }
  return false;
}

void WideGauss::finish(Vector<double>& y, double h) {
  const DoubleDouble step(h), square = DoubleDouble::product(h, h);
  for (std::size_t k = 0; k < x_.size(); ++k) {
    DoubleDouble way, speed;
    for (std::size_t j = 0; j < stages; ++j) {
      way += wide_table_.twice_end[j] * wide_rates_[k][j];
      speed += wide_table_.b[j] * wide_rates_[k][j];
      rates_[k][j] = wide_rates_[k][j].high;
    }
    const DoubleDouble x = x_[k] + (step * v_[k] + square * way), v = v_[k] + step * speed;
    const auto at = static_cast<Index>(k);
    y[at] = x.high;
    low_[at] = x.low;
    y[coordinates_ + at] = v.high;
    low_[coordinates_ + at] = v.low;
  }
}

void WideGauss::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "h", h_);
  std::vector<double> rates;
  for (const auto& rate : rates_) rates.insert(rates.end(), rate.begin(), rate.end());
  save_value(saved, prefix + "rates", rates);
}

void WideGauss::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "h", h_);
  std::vector<double> rates;
  load_value(saved, prefix + "rates", rates);
  std::size_t at = 0;
  for (auto& rate : rates_) {
    for (double& x : rate) x = detail::element(rates, at++);
  }
}

namespace methods {

namespace {

std::unique_ptr<Method<double>> wide_gauss(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<WideGauss>(info.name);
}

}  // namespace

std::span<const MethodInfo> wide_gauss_list() {
  static const MethodInfo list[] = {
      {.name = "wide_gauss_8",
       .summary = "Gauss and Legendre's collocation with 8 stages on states of double-doubles, for gravity",
       .use = "bodies none of which dominates, with errors below the rounding of doubles",
       .source = "HairerLubichWanner2006",
       .family = "collocation",
       .order = 16,
       .gravity_only = true,
       .make = wide_gauss,
       .make_quad = nullptr},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
