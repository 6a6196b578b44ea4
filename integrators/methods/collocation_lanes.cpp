#include "integrators/force_motion.hpp"
#include "integrators/lane_method.hpp"
#include "integrators/methods/collocation.hpp"
#include "integrators/methods/lane_sums_simd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace noether::lane_methods {

namespace {

constexpr std::size_t lanes = LaneField::lanes;

/// What states take from rates in a step of one length, by rate [j][i], and from velocities; in the layout of
/// `LaneStages`.
struct StageWeights {
  StageMatrix<double> w{};
  StageLanes<double> d{}, d_low{};
};

using QuadMatrix = std::vector<std::vector<Quad>>;

/// w_ij, times a factor. What rounding has taken from a row goes to its own stage.
StageWeights rounded_rows(const QuadMatrix& rows, const Quad& factor) {
  StageWeights made;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Quad left = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const Quad exact = factor * rows[i][j];
      made.w[j][i] = static_cast<double>(exact);
      left += exact - Quad(made.w[j][i]);
    }
    made.w[i][i] += static_cast<double>(left);
  }
  return made;
}

/// L_kj: what the polynomial through nodes c has at 1 + c_k from node j.
QuadMatrix one_step_ahead(const std::vector<Quad>& c) {
  QuadMatrix ahead(c.size(), std::vector<Quad>(c.size(), Quad(1)));
  for (std::size_t k = 0; k < c.size(); ++k) {
    for (std::size_t j = 0; j < c.size(); ++j) {
      for (std::size_t m = 0; m < c.size(); ++m) {
        if (m != j) ahead[k][j] *= (Quad(1) + c[k] - c[m]) / (c[j] - c[m]);
      }
    }
  }
  return ahead;
}

QuadMatrix product(const QuadMatrix& a, const QuadMatrix& b) {
  QuadMatrix made(a.size(), std::vector<Quad>(a.size(), Quad(0)));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      for (std::size_t k = 0; k < a.size(); ++k) made[i][j] += a[i][k] * b[k][j];
    }
  }
  return made;
}

/// What the rates of a step add to y, in two words.
struct EndWeights {
  StageLanes<double> high{}, low{};

  EndWeights() = default;
  EndWeights(const std::vector<Quad>& weights, const Quad& factor) {
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const Quad exact = factor * weights[j];
      high[j] = static_cast<double>(exact);
      low[j] = static_cast<double>(exact - Quad(high[j]));
    }
  }
};

/// One lane by itself, by the method in doubles.
struct LaneAlone {
  ForceMotion<ForceField<double>, double> field;
  Collocation<double> method;
  Vector<double> y;
  AlignedVector<double> low, rates;
};

/// `Collocation` with steps of one length. Every lane is swept until its own rates stand still, by the rules that hold
/// for one system; then they stay while others go on. A lane whose sweeps do not converge makes the step by itself, by
/// `Collocation` in doubles, which knows what to do.
class CollocationLanes final : public LaneMethod {
 public:
  CollocationLanes(const MethodChoice& choice, const CollocationTable& table)
      : choice_(choice),
        table_(table),
        stages_(static_cast<std::size_t>(table.stages())),
        foreseen_(settled * (table.stages() == lane_count ? 1 : 0x1p-6)) {}

  std::vector<LaneNumbers*> memory() override { return {&low_, &previous_}; }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    make_weights(h);
    half_ = y.size() / 2;
    low_.assign(y.size(), 0);
    for (LaneNumbers* all : {&previous_, &rates_, &trial_, &q_}) all->resize(stages_ * half_);
    v_.resize(f.velocity_dependent() ? stages_ * half_ : 0);
    f.accelerations(t, y.data(), y.data() + half_, previous_.data());
    for (std::size_t j = 1; j < stages_; ++j) std::copy_n(previous_.data(), half_, previous_.data() + j * half_);
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override;

 private:
  static constexpr double settled = 0x1p-54;

  void make_weights(double h) {
    h_ = h;
    const Quad exact(h);
    const QuadMatrix twice = table_.twice(), ahead = one_step_ahead(table_.c);
    positions_ = rounded_rows(twice, exact * exact);
    positions_ahead_ = rounded_rows(product(twice, ahead), exact * exact);
    velocities_ = rounded_rows(table_.a, exact);
    velocities_ahead_ = rounded_rows(product(table_.a, ahead), exact);
    for (std::size_t i = 0; i < stages_; ++i) {
      const Quad node = exact * table_.c[i];
      const auto rounded = static_cast<double>(node);
      for (StageWeights* of : {&positions_, &positions_ahead_}) {
        of->d[i] = rounded;
        of->d_low[i] = static_cast<double>(node - Quad(rounded));
      }
    }
    once_ = {table_.b, exact};
    twice_ = {table_.twice_end(), exact * exact};
  }
  std::ptrdiff_t variables() const { return static_cast<std::ptrdiff_t>(half_ / lanes); }
  LaneStages sums(const StageWeights& by, const LaneNumbers& rates, const LaneNumbers& y, std::size_t from,
                  LaneNumbers& out) const {
    return {
        variables(), static_cast<int>(stages_), rates.data(),   y.data() + from, low_.data() + from, y.data() + half_,
        by.d.data(), by.d_low.data(),           by.w[0].data(), out.data()};
  }
  /// Rates at the states that `rates` lead to.
  void evaluate(LaneField& f, double t, const LaneNumbers& y, const LaneNumbers& rates, bool ahead, LaneNumbers& out) {
    lane_sums_kernels().stages(sums(ahead ? positions_ahead_ : positions_, rates, y, 0, q_));
    if (!v_.empty()) lane_sums_kernels().stages(sums(ahead ? velocities_ahead_ : velocities_, rates, y, half_, v_));
    for (std::size_t i = 0; i < stages_; ++i) {
      const std::size_t at = i * half_;
      f.accelerations(t + positions_.d[i], q_.data() + at, v_.empty() ? nullptr : v_.data() + at, out.data() + at);
    }
  }
  bool is_rounding_in(std::size_t lane, const LaneNumbers& y, double change) {
    of_lane_.resize(static_cast<Index>(y.size() / lanes));
    for (Index i = 0; i < of_lane_.size(); ++i) of_lane_[i] = y[lanes * static_cast<std::size_t>(i) + lane];
    return is_rounding(of_lane_, RatesOf::velocities, h_, change);
  }
  std::optional<Failure> step_alone(LaneField& f, double t, std::size_t lane, const LaneNumbers& begin, LaneNumbers& y);

  MethodChoice choice_;
  const CollocationTable& table_;
  std::size_t stages_;
  double foreseen_, h_ = 0;
  StageWeights positions_, positions_ahead_, velocities_, velocities_ahead_;
  EndWeights once_, twice_;
  std::size_t half_ = 0;                           ///< numbers of all lanes' q
  LaneNumbers low_, previous_;                     ///< rounding errors of y; rates of the last step, by stage
  LaneNumbers rates_, trial_, q_, v_, low_begin_;  ///< of the step at hand
  Vector<double> of_lane_;
  std::optional<LaneAlone> alone_;  ///< once a lane has asked for it
};

std::optional<Failure> CollocationLanes::step(LaneField& f, double t, LaneNumbers& y) {
  constexpr int most = 300, patience = 6;
  constexpr double noise = 1e-12;
  alignas(64) std::array<std::int64_t, lanes> on{};
  alignas(64) std::array<double, lanes> change{}, size{}, before{};
  std::array<bool, lanes> diverged{};
  on.fill(-1);
  evaluate(f, t, y, previous_, true, rates_);
  std::size_t going = lanes;
  for (int round = 2; going > 0; ++round) {
    evaluate(f, t, y, rates_, false, trial_);
    lane_sums_kernels().take(static_cast<std::ptrdiff_t>(stages_) * variables(), trial_.data(), on.data(),
                             rates_.data(), change.data(), size.data());
    for (std::size_t k = 0; k < lanes; ++k) {
      if (on[k] == 0) continue;
      // As `Collocation::sweep`.
      const double relative = size[k] > 0 ? change[k] / size[k] : change[k] > 0 ? 1.0 : 0.0;
      const double shrinks = round == 2 ? 1.0 : relative / before[k];
      before[k] = relative;
      const bool finite = std::isfinite(size[k] + change[k]);
      bool converged = relative <= settled || relative * std::min(shrinks, 1.0) * 0.5 < foreseen_;
      if (round > 2 && shrinks >= 1) converged = converged || relative < noise || is_rounding_in(k, y, change[k]);
      if (finite && !converged && round < most && !(round > patience && shrinks >= 1)) continue;
      diverged[k] = !finite || !converged;
      on[k] = 0;
      --going;
    }
  }
  const bool all = std::none_of(diverged.begin(), diverged.end(), [](bool one) { return one; });
  const LaneNumbers begin = all ? LaneNumbers() : y;
  if (!all) low_begin_ = low_;
  lane_sums_kernels().finish({.n = variables(),
                              .stages = static_cast<int>(stages_),
                              .rates = rates_.data(),
                              .h = h_,
                              .once = once_.high.data(),
                              .once_low = once_.low.data(),
                              .twice = twice_.high.data(),
                              .twice_low = twice_.low.data(),
                              .q = y.data(),
                              .q_low = low_.data(),
                              .v = y.data() + half_,
                              .v_low = low_.data() + half_});
  std::swap(previous_, rates_);
  std::optional<Failure> failure;
  for (std::size_t k = 0; k < lanes && !all && !failure; ++k) {
    if (diverged[k]) failure = step_alone(f, t, k, begin, y);
  }
  return failure;
}

/// The last step's rates are in `rates_`.
std::optional<Failure> CollocationLanes::step_alone(LaneField& f, double t, std::size_t lane, const LaneNumbers& begin,
                                                    LaneNumbers& y) {
  if (!alone_) {
    const MethodInfo& info = *choice_.info;
    alone_.emplace(LaneAlone{ForceMotion<ForceField<double>, double>(f.forces()),
                             Collocation<double>(info, choice_.options, table_, info.name != "gauss_radau_15"),
                             {},
                             {},
                             {}});
  }
  auto& [field, method, state, low, rates] = *alone_;
  field.bind(f.particles(lane));
  method.bind(field);
  const std::size_t n = half_ / lanes;
  state.resize(static_cast<Index>(2 * n));
  low.resize(2 * n);
  rates.resize(lane_count * n);
  for (std::size_t i = 0; i < 2 * n; ++i) {
    state[static_cast<Index>(i)] = begin[lanes * i + lane];
    low[i] = low_begin_[lanes * i + lane];
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < lane_count; ++j) {
      rates[lane_count * i + j] = rates_[(j < stages_ ? j : 0) * half_ + lanes * i + lane];
    }
  }
  method.go_on_from(low, rates, h_);
  const StepResult made = method.step(field, t, state, h_);
  if (made.failure) return field.failure() ? field.failure() : made.failure;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    y[lanes * i + lane] = state[static_cast<Index>(i)];
    low_[lanes * i + lane] = method.low()[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < stages_; ++j) {
      previous_[j * half_ + lanes * i + lane] = method.rates()[lane_count * i + j];
    }
  }
  return {};
}

}  // namespace

std::unique_ptr<LaneMethod> collocation(const MethodChoice& choice) {
  const CollocationTable* const table = collocation_of(choice.info->name);
  if (table == nullptr) return nullptr;
  return std::make_unique<CollocationLanes>(choice, *table);
}

}  // namespace noether::lane_methods
