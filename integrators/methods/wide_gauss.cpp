#include "integrators/methods/wide_gauss.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/last_polynomial.hpp"
#include "integrators/methods/wide_gauss_simd.hpp"

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

/// The largest change of any stage's rate of one of n bodies, relative to its largest rate; `rates` become `fresh`.
/// @param words  a number has: 1 or 2
double take_rates(std::size_t n, std::size_t words, const AlignedVector<double>& fresh, AlignedVector<double>& rates) {
  const std::size_t size = 8 * words;
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double change = 0, largest = 0;
    for (std::size_t s = 0; s < 8; ++s) {
      double change2 = 0, size2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = size * (k * n + i) + s;
        double difference = fresh[at] - rates[at];
        if (words > 1) difference += fresh[at + 8] - rates[at + 8];
        change2 += difference * difference;
        size2 += fresh[at] * fresh[at];
      }
      if (!std::isfinite(change2)) return change2;
      change = std::max(change, change2);
      largest = std::max(largest, size2);
    }
    if (change == 0) continue;
    const double relative = largest > 0 ? change / largest : 1;
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
  const auto put = [](const Quad& x, double(&words)[2][8], std::size_t lane) {
    const DoubleDouble both(x);
    words[0][lane] = both.high;
    words[1][lane] = both.low;
  };
  for (std::size_t i = 0; i < stages; ++i) {
    c_[i] = static_cast<double>(table.c[i]);
    b_[i] = DoubleDouble(table.b[i]);
    twice_end_[i] = DoubleDouble(twice_end[i]);
    put(table.c[i], weights_.c, i);
    for (std::size_t j = 0; j < stages; ++j) put(twice[i][j], weights_.twice[j], i);
  }
}

void WideGauss::bind(const VectorField<double>& f) {
  const std::optional<double> G = f.gravity_of_points();
  if (!G) throw SchemeMismatch(fmt::format("method '{}' is for gravity; use 'gauss_8'", name_));
  n_ = f.particles();
  coordinates_ = 3 * n_;
  const Vector<double> masses = f.masses();
  gm_.clear();
  gm_low_.clear();
  for (Index i = 0; i < n_; ++i) {
    const DoubleDouble gm = DoubleDouble::product(*G, masses[i]);
    gm_.push_back(gm.high);
    gm_low_.push_back(gm.low);
  }
  beside_ = f.has_forces_beside_gravity();
  const auto count = static_cast<std::size_t>(coordinates_);
  for (auto* all : {&x_, &x_low_, &v_, &v_low_}) all->assign(count, 0);
  for (auto* all : {&rates_, &fresh_, &q_, &pushes_}) all->assign(stages * count, 0);
  for (auto* all : {&wide_rates_, &wide_fresh_, &wide_q_}) all->assign(2 * stages * count, 0);
  stage_.setZero(f.size());
  stage_push_.setZero(coordinates_);
  for (Vector<double>* words : {&low_, &start_, &start_low_, &inside_low_}) words->setZero(f.size());
  h_ = 0;
}

StepResult WideGauss::step(VectorField<double>& f, const double& t, Vector<double>& y, double h) {
  StepResult made{.h = h};
  t_ = t;
  start_ = y;
  start_low_ = low_;
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
    const DoubleDouble x = DoubleDouble::sum(y[at], low_[at]);
    const DoubleDouble v = DoubleDouble::sum(y[coordinates_ + at], low_[coordinates_ + at]);
    x_[k] = x.high, x_low_[k] = x.low;
    v_[k] = v.high, v_low_[k] = v.low;
    double* const rates = &rates_[stages * k];
    Lanes<double> before;
    std::copy_n(rates, stages, before.begin());
    std::fill_n(rates, stages, 0.0);
    if (h != h_) continue;
    for (std::size_t i = 0; i < stages; ++i) {
      for (std::size_t j = 0; j < stages; ++j) rates[i] += ahead_[i][j] * before[j];
    }
  }
}

/// Forces that are not gravity of points, at the stages as doubles have them: they are evaluated in doubles.
void WideGauss::add_forces_beside(VectorField<double>& f, double t, double h) {
  if (!beside_) return;
  const auto n = static_cast<std::size_t>(coordinates_);
  for (std::size_t s = 0; s < stages; ++s) {
    for (std::size_t k = 0; k < n; ++k) stage_[static_cast<Index>(k)] = q_[stages * k + s];
    f.accelerations_beside_gravity(t + c_[s] * h, stage_, stage_push_);
    for (std::size_t k = 0; k < n; ++k) pushes_[stages * k + s] = stage_push_[static_cast<Index>(k)];
  }
}

/// Sweeps in doubles. @return whether the rates stand still but for rounding
bool WideGauss::sweep(VectorField<double>& f, double t, double h) {
  const WideGaussStart start{coordinates_, x_.data(), x_low_.data(), v_.data(), v_low_.data()};
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_stage_sweeps; ++round) {
    wide_gauss_kernels().place(weights_, start, h, rates_.data(), q_.data());
    wide_gauss_kernels().attract(n_, gm_.data(), gm_low_.data(), q_.data(), fresh_.data());
    f.evaluations().force += stages;
    add_forces_beside(f, t, h);
    if (f.failure()) return false;
    for (std::size_t k = 0; beside_ && k < fresh_.size(); ++k) fresh_[k] += pushes_[k];
    const double change = take_rates(static_cast<std::size_t>(n_), 1, fresh_, rates_);
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
  const WideGaussStart start{coordinates_, x_.data(), x_low_.data(), v_.data(), v_low_.data()};
  for (std::size_t k = 0; k < rates_.size(); ++k) {
    wide_rates_[k + k / stages * stages] = rates_[k];
    wide_rates_[k + (k / stages + 1) * stages] = 0;
  }
  double before = std::numeric_limits<double>::infinity();
  for (int round = 1; round <= most_wide_sweeps; ++round) {
    wide_gauss_kernels().place_wide(weights_, start, h, wide_rates_.data(), wide_q_.data());
    wide_gauss_kernels().attract_wide(n_, gm_.data(), gm_low_.data(), wide_q_.data(), wide_fresh_.data());
    f.evaluations().force += stages;
    for (std::size_t k = 0; beside_ && k < pushes_.size(); ++k) {
      double &high = wide_fresh_[k + k / stages * stages], &low = wide_fresh_[k + (k / stages + 1) * stages];
      const DoubleDouble pushed = DoubleDouble(high, low) + DoubleDouble(pushes_[k]);
      high = pushed.high;
      low = pushed.low;
    }
    const double change = take_rates(static_cast<std::size_t>(n_), 2, wide_fresh_, wide_rates_);
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
    const double* const rates = &wide_rates_[2 * stages * k];
    DoubleDouble way, speed;
    for (std::size_t j = 0; j < stages; ++j) {
      const DoubleDouble rate(rates[j], rates[stages + j]);
      way += twice_end_[j] * rate;
      speed += b_[j] * rate;
      rates_[stages * k + j] = rate.high;
    }
    const DoubleDouble x0(x_[k], x_low_[k]), v0(v_[k], v_low_[k]);
    const DoubleDouble x = x0 + (step * v0 + square * way), v = v0 + step * speed;
    const auto at = static_cast<Index>(k);
    y[at] = x.high;
    low_[at] = x.low;
    y[coordinates_ + at] = v.high;
    low_[coordinates_ + at] = v.low;
  }
}

/// A step from where the last one began, whose sweeps begin with the polynomial of its rates.
void WideGauss::interpolate(VectorField<double>& f, const double& theta, Vector<double>& y) {
  y = start_;
  inside_low_ = start_low_;
  if (theta == 0) return;
  WideGauss part(*this);
  part.ahead_ = inner_polynomial(c_, theta);
  part.low_ = start_low_;
  part.h_ = theta * h_;
  if (part.step(f, t_, y, part.h_).failure) y.setConstant(std::numeric_limits<double>::quiet_NaN());
  inside_low_ = part.low_;
}

void WideGauss::save(SavedState& saved, const std::string& prefix) const {
  save_value(saved, prefix + "h", h_);
  save_value(saved, prefix + "rates", std::vector<double>(rates_.begin(), rates_.end()));
}

void WideGauss::load(const SavedState& saved, const std::string& prefix) {
  load_value(saved, prefix + "h", h_);
  std::vector<double> rates;
  load_value(saved, prefix + "rates", rates);
  for (std::size_t k = 0; k < rates_.size(); ++k) rates_[k] = detail::element(rates, k);
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
