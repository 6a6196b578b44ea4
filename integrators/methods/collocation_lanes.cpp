#include "integrators/force_motion.hpp"
#include "integrators/lane_method.hpp"
#include "integrators/methods/collocation.hpp"
#include "integrators/methods/lane_sums_simd.hpp"
#include "integrators/varied_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
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

using SomeLanes = std::array<bool, lanes>;

bool has_any(const SomeLanes& some) {
  return std::any_of(some.begin(), some.end(), [](bool one) { return one; });
}

/// `Collocation` with steps of one length. Every lane is swept until its own rates stand still, by the rules that hold
/// for one system; then they stay while others go on. A lane whose sweeps do not converge makes the step by itself, by
/// `Collocation` in doubles, which knows what to do.
///
/// y has parts: the systems, and each of the changes that go along. The stages of a change are swept likewise, once
/// those of the systems stand. Where that does not converge, or those of its system have not, it makes the step beside
/// its system by `Collocation` over a `VariedField`.
class CollocationLanes final : public LaneMethod {
 public:
  CollocationLanes(const MethodChoice& choice, const CollocationTable& table)
      : choice_(choice),
        table_(table),
        stages_(static_cast<std::size_t>(table.stages())),
        foreseen_(settled * (table.stages() == lane_count ? 1 : 0x1p-6)) {}

  std::vector<LaneNumbers*> memory() override {
    std::vector<LaneNumbers*> all{&low_};
    for (LaneNumbers& of_part : previous_) all.push_back(&of_part);
    return all;
  }
  void scale_change(std::size_t lane, std::size_t change, double factor) override {
    parts_.scale_change(low_, lane, change, factor);
    scale_lane(previous_[1 + change].data(), stages_ * part_, lane, factor);
  }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    make_weights(h);
    half_ = y.size() / 2;
    part_ = lanes * static_cast<std::size_t>(f.part());
    parts_ = LaneParts(f);
    low_.assign(y.size(), 0);
    for (auto* parts : {&previous_, &rates_}) parts->assign(half_ / part_, LaneNumbers(stages_ * part_));
    for (LaneNumbers* all : {&trial_, &q_}) all->resize(stages_ * part_);
    v_.resize(f.velocity_dependent() ? stages_ * part_ : 0);
    dq_.resize(f.changes() > 0 ? q_.size() : 0);
    dv_.resize(f.changes() > 0 ? v_.size() : 0);
    LaneNumbers start(half_);
    f.accelerations(t, y.data(), y.data() + half_, start.data());
    for (std::size_t part = 0; part < previous_.size(); ++part) {
      for (std::size_t j = 0; j < stages_; ++j)
        std::copy_n(start.data() + part * part_, part_, previous_[part].data() + j * part_);
    }
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
  std::ptrdiff_t variables() const { return static_cast<std::ptrdiff_t>(part_ / lanes); }
  /// Positions, and velocities where they matter, of all stages of a part. @param ahead  by the rates of the last step
  void form(std::size_t part, const LaneNumbers& y, const LaneNumbers& rates, bool ahead, LaneNumbers& q,
            LaneNumbers& v) const {
    const std::size_t begin = part * part_;
    const auto sum = [&](const StageWeights& by, std::size_t from, LaneNumbers& out) {
      lane_sums_kernels().stages({variables(), static_cast<int>(stages_), rates.data(), y.data() + from,
                                  low_.data() + from, y.data() + half_ + begin, by.d.data(), by.d_low.data(),
                                  by.w[0].data(), out.data()});
    };
    sum(ahead ? positions_ahead_ : positions_, begin, q);
    if (!v.empty()) sum(ahead ? velocities_ahead_ : velocities_, half_ + begin, v);
  }
  /// Rates of a part at the states that `rates` lead to. @pre for a change: `q_` and `v_` are the stages of the systems
  void evaluate(LaneField& f, double t, std::size_t part, const LaneNumbers& y, const LaneNumbers& rates, bool ahead,
                LaneNumbers& out) {
    form(part, y, rates, ahead, part == 0 ? q_ : dq_, part == 0 ? v_ : dv_);
    for (std::size_t i = 0; i < stages_; ++i) {
      const std::size_t at = i * part_;
      const auto stage = [at](const LaneNumbers& of) { return of.empty() ? nullptr : of.data() + at; };
      const double time = t + positions_.d[i];
      if (part == 0) {
        f.of_systems(time, stage(q_), stage(v_), out.data() + at);
      } else {
        f.of_change(time, stage(q_), stage(v_), stage(dq_), stage(dv_), out.data() + at);
      }
    }
  }
  /// Takes a part of one lane, as (q, v).
  const Vector<double>& of_lane(std::size_t lane, std::size_t part, const LaneNumbers& y) {
    of_lane_.resize(2 * variables());
    double* to = of_lane_.data();
    for (const std::size_t from : {part * part_, half_ + part * part_}) {
      for (std::size_t at = from; at < from + part_; at += lanes) *to++ = y[at + lane];
    }
    return of_lane_;
  }
  SomeLanes sweep(LaneField& f, double t, std::size_t part, const LaneNumbers& y, const SomeLanes& without);
  std::optional<Failure> step_alone(LaneField& f, double t, std::size_t lane, std::size_t part,
                                    const LaneNumbers& begin, LaneNumbers& y);

  MethodChoice choice_;
  const CollocationTable& table_;
  std::size_t stages_;
  double foreseen_, h_ = 0;
  StageWeights positions_, positions_ahead_, velocities_, velocities_ahead_;
  EndWeights once_, twice_;
  std::size_t half_ = 0, part_ = 0;                  ///< numbers of all lanes' q; of one part of them
  LaneParts parts_;                                  ///< of numbers laid out as y
  LaneNumbers low_;                                  ///< rounding errors of y
  std::vector<LaneNumbers> previous_, rates_;        ///< by part, each by stage: of the last step; of the one at hand
  LaneNumbers trial_, q_, v_, dq_, dv_, low_begin_;  ///< of the step at hand; stages of the systems and of a change
  std::vector<SomeLanes> diverged_;                  ///< by part
  Vector<double> of_lane_;
  std::optional<LaneAlone> alone_;  ///< once a lane has asked for it
};

/// Sweeps over the stages of a part until they stand still in every lane. @param without  lanes that are left alone
/// @return lanes whose sweeps have not converged, those without any among them
SomeLanes CollocationLanes::sweep(LaneField& f, double t, std::size_t part, const LaneNumbers& y,
                                  const SomeLanes& without) {
  constexpr int most = 300, patience = 6;
  constexpr double noise = 1e-12;
  alignas(64) std::array<std::int64_t, lanes> on{};
  alignas(64) std::array<double, lanes> change{}, size{}, before{};
  SomeLanes diverged = without;
  LaneNumbers& rates = rates_[part];
  for (std::size_t k = 0; k < lanes; ++k) on[k] = without[k] ? 0 : -1;
  evaluate(f, t, part, y, previous_[part], true, rates);
  auto going = std::count(on.begin(), on.end(), -1);
  for (int round = 2; going > 0; ++round) {
    evaluate(f, t, part, y, rates, false, trial_);
    lane_sums_kernels().take(static_cast<std::ptrdiff_t>(stages_) * variables(), trial_.data(), on.data(), rates.data(),
                             change.data(), size.data());
    for (std::size_t k = 0; k < lanes; ++k) {
      if (on[k] == 0) continue;
      // As `Collocation::sweep`.
      const double relative = size[k] > 0 ? change[k] / size[k] : change[k] > 0 ? 1.0 : 0.0;
      const double shrinks = round == 2 ? 1.0 : relative / before[k];
      before[k] = relative;
      const bool finite = std::isfinite(size[k] + change[k]);
      bool converged = relative <= settled || relative * std::min(shrinks, 1.0) * 0.5 < foreseen_;
      if (round > 2 && shrinks >= 1 && !converged) {
        converged = relative < noise || is_rounding(of_lane(k, part, y), RatesOf::velocities, h_, change[k]);
      }
      if (finite && !converged && round < most && !(round > patience && shrinks >= 1)) continue;
      diverged[k] = !finite || !converged;
      on[k] = 0;
      --going;
    }
  }
  return diverged;
}

std::optional<Failure> CollocationLanes::step(LaneField& f, double t, LaneNumbers& y) {
  const std::size_t parts = rates_.size();
  diverged_.assign(1, sweep(f, t, 0, y, {}));
  // Where the rates lead that each lane has ended with, however long others went on.
  if (parts > 1) form(0, y, rates_[0], false, q_, v_);
  for (std::size_t part = 1; part < parts; ++part) diverged_.push_back(sweep(f, t, part, y, diverged_[0]));
  const bool all = std::none_of(diverged_.begin(), diverged_.end(), has_any);
  const LaneNumbers begin = all ? LaneNumbers() : y;
  if (!all) low_begin_ = low_;
  for (std::size_t part = 0, q = 0, v = half_; part < parts; ++part, q += part_, v += part_) {
    lane_sums_kernels().finish({.n = variables(),
                                .stages = static_cast<int>(stages_),
                                .rates = rates_[part].data(),
                                .h = h_,
                                .once = once_.high.data(),
                                .once_low = once_.low.data(),
                                .twice = twice_.high.data(),
                                .twice_low = twice_.low.data(),
                                .q = y.data() + q,
                                .q_low = low_.data() + q,
                                .v = y.data() + v,
                                .v_low = low_.data() + v});
  }
  std::swap(previous_, rates_);
  for (std::size_t part = 0; part < parts && !all; ++part) {
    for (std::size_t k = 0; k < lanes; ++k) {
      if (!diverged_[part][k]) continue;
      if (const std::optional<Failure> failure = step_alone(f, t, k, part, begin, y)) return failure;
    }
  }
  return {};
}

/// Makes the step of a part of one lane. That of a change cannot fail a run: without success it is no number any more.
/// @pre the last step's rates are in `rates_`
std::optional<Failure> CollocationLanes::step_alone(LaneField& f, double t, std::size_t lane, std::size_t part,
                                                    const LaneNumbers& begin, LaneNumbers& y) {
  if (!alone_) {
    const MethodInfo& info = *choice_.info;
    alone_.emplace(LaneAlone{ForceMotion<ForceField<double>, double>(f.forces()),
                             Collocation<double>(info, choice_.options, table_, info.name != "gauss_radau_15"),
                             {},
                             {},
                             {}});
  }
  auto& [motion, method, state, low, rates] = *alone_;
  motion.bind(f.particles(lane));
  // A change goes along as one that is about as long as 1, so that both count in what the method looks at.
  const double size = part == 0 ? 1 : of_lane(lane, part, begin).lpNorm<1>();
  const double length = std::isnormal(size) ? std::exp2(std::ilogb(size)) : 1;
  std::optional<VariedField<double>> varied;
  if (part > 0) varied.emplace(motion.clone(), 1);
  VectorField<double>& field = part == 0 ? static_cast<VectorField<double>&>(motion) : *varied;
  method.bind(field);
  const std::size_t n = part_ / lanes, rows = part == 0 ? 1 : 2;
  state.resize(field.size());
  low.resize(2 * rows * n);
  rates.resize(lane_count * rows * n);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t of = row * part;
    const double scale = row == 0 ? 1 : length;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = lanes * i + lane, q = of * part_ + at, to = row * n + i, v = rows * n + to;
      state[static_cast<Index>(to)] = begin[q] / scale;
      state[static_cast<Index>(v)] = begin[half_ + q] / scale;
      low[to] = low_begin_[q] / scale;
      low[v] = low_begin_[half_ + q] / scale;
      for (std::size_t j = 0; j < lane_count; ++j)
        rates[lane_count * to + j] = rates_[of][(j < stages_ ? j : 0) * part_ + at] / scale;
    }
  }
  method.go_on_from(low, rates, h_);
  const StepResult made = method.step(field, t, state, h_);
  if (made.failure && part == 0) return field.failure() ? field.failure() : made.failure;
  const double scale = made.failure ? std::numeric_limits<double>::quiet_NaN() : length;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = lanes * i + lane, q = part * part_ + at, from = (rows - 1) * n + i, v = rows * n + from;
    y[q] = scale * state[static_cast<Index>(from)];
    y[half_ + q] = scale * state[static_cast<Index>(v)];
    low_[q] = scale * method.low()[from];
    low_[half_ + q] = scale * method.low()[v];
    for (std::size_t j = 0; j < stages_; ++j)
      previous_[part][j * part_ + at] = scale * method.rates()[lane_count * from + j];
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
