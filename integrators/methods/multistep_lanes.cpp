#include "integrators/lane_method.hpp"
#include "integrators/methods/adams.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/methods/lane_sums_simd.hpp"
#include "integrators/methods/lane_terms.hpp"
#include "integrators/methods/stormer_cowell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace noether::lane_methods {

namespace {

constexpr std::size_t lanes = LaneField::lanes;

/// Numbers with the rounding errors of the sums they went through, as `CompensatedVector`.
struct CompensatedLanes {
  LaneNumbers value, low;

  void set(const LaneNumbers& y) {
    value = y;
    low.assign(y.size(), 0);
  }
  /// value + low += x, for `count` numbers from number `at` on.
  void add(std::size_t at, std::size_t count, const double* x) {
    lane_sums_kernels().add(static_cast<std::ptrdiff_t>(count), x, value.data() + at, low.data() + at);
  }
};

/// As `Starter`: a step by several short ones of DOP853.
class LaneStarter {
 public:
  explicit LaneStarter(int parts)
      : parts_(parts), c_(as_real<double>(tableaus::dop853().c)), end_(LaneTerms::of_stages(tableaus::dop853().b)) {
    for (const auto& row : tableaus::dop853().a) rows_.push_back(LaneTerms::of_stages(row));
  }

  void begin(std::size_t numbers) {
    for (LaneNumbers& k : k_) k.resize(numbers);
    y_.resize(numbers);
  }
  void go(LaneField& f, double t, double h, CompensatedLanes& y) {
    const double part = h / parts_;
    for (int p = 0; p < parts_; ++p) {
      const double begin = t + p * part;
      for (std::size_t i = 0; i < stages; ++i) {
        rows_[i].sum(y.value, part, k_, y_);
        lane_rate(f, begin + c_[i] * part, y_, k_[i]);
      }
      std::fill(y_.begin(), y_.end(), 0.0);
      end_.sum(y_, part, k_, y_);
      y.add(0, y_.size(), y_.data());
    }
  }

 private:
  static constexpr std::size_t stages = 12;

  int parts_;
  std::vector<double> c_;
  std::vector<LaneTerms> rows_;
  LaneTerms end_;
  std::vector<LaneNumbers> k_ = std::vector<LaneNumbers>(stages);
  LaneNumbers y_;
};

/// The last vectors of a run, the newest first, and how many steps have put one there: in all lanes the same.
class LaneHistory {
 public:
  explicit LaneHistory(std::size_t most) : kept_(most) {}

  void begin(std::size_t numbers) {
    for (LaneNumbers& one : kept_) one.assign(numbers, 0);
    count_.assign(lanes, 0);
  }
  std::size_t most() const { return kept_.size(); }
  std::size_t count() const { return static_cast<std::size_t>(count_[0]); }
  const std::vector<LaneNumbers>& all() const { return kept_; }
  LaneNumbers& newest() { return kept_.front(); }

  /// The vector to be filled: it becomes the newest, and the oldest is lost.
  LaneNumbers& push() {
    std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
    std::fill(count_.begin(), count_.end(), std::min(count_[0] + 1, static_cast<double>(most())));
    return kept_.front();
  }
  void add_to(std::vector<LaneNumbers*>& memory) {
    memory.push_back(&count_);
    for (LaneNumbers& one : kept_) memory.push_back(&one);
  }

 private:
  std::vector<LaneNumbers> kept_;
  LaneNumbers count_;  ///< beside what it counts, so that it is kept with it
};

/// `Adams` with steps of one length.
class AdamsLanes final : public LaneMethod {
 public:
  explicit AdamsLanes(const Adams<double>& method)
      : method_(method),
        implicit_(method.implicit_weights()[0]),
        ahead_(LaneTerms::of_past(method.explicit_weights())),
        known_terms_(LaneTerms::of_past({method.implicit_weights().begin() + 1, method.implicit_weights().end()})),
        starter_(Adams<double>::parts_of_start),
        rates_(method.explicit_weights().size()) {}

  bool goes_on_from_steps() const override { return true; }
  std::vector<LaneNumbers*> memory() override {
    std::vector<LaneNumbers*> all;
    rates_.add_to(all);
    return all;
  }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    h_ = h;
    starter_.begin(y.size());
    rates_.begin(y.size());
    for (LaneNumbers* one : {&known_, &y1_, &f1_, &trial_}) one->resize(y.size());
    lane_rate(f, t, y, rates_.push());
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override {
    const double end = t + h_;
    std::optional<Failure> failure;
    if (rates_.count() < rates_.most()) {
      start_.set(y);
      starter_.go(f, t, h_, start_);
      y = start_.value;
    } else if (method_.kind() == AdamsKind::bashforth) {
      ahead_.sum(y, h_, rates_.all(), y);
    } else {
      ahead_.sum(y, h_, rates_.all(), y1_);
      known_terms_.sum(y, h_, rates_.all(), known_);
      if (method_.kind() == AdamsKind::pece) {
        lane_rate(f, end, y1_, f1_);
        const double weight = h_ * implicit_;
        for (std::size_t i = 0; i < y.size(); ++i) y[i] = known_[i] + weight * f1_[i];
      } else {
        failure = iterate(f, t, y);
        std::swap(y, y1_);
        rates_.push() = f1_;
        return failure;
      }
    }
    lane_rate(f, end, y, rates_.push());
    return failure;
  }

 private:
  /// Solves the implicit formula in each lane by itself, as `Adams::iterate`: the new point in `y1_`, its rate in
  /// `f1_`.
  std::optional<Failure> iterate(LaneField& f, double t, const LaneNumbers& y);

  Adams<double> method_;  ///< one system's, whose weights it has
  double implicit_;       ///< weight of the new rate
  LaneTerms ahead_, known_terms_;
  LaneStarter starter_;
  LaneHistory rates_;  ///< the newest is that of the present point
  CompensatedLanes start_;
  LaneNumbers known_, y1_, f1_, trial_;
  double h_ = 0;
};

std::optional<Failure> AdamsLanes::iterate(LaneField& f, double t, const LaneNumbers& y) {
  constexpr double ulp = std::numeric_limits<double>::epsilon();
  using PerLane = std::array<double, lanes>;
  alignas(64) std::array<std::int64_t, lanes> on{};
  alignas(64) PerLane change{};
  PerLane before{}, rate{};
  std::optional<Failure> failure;
  on.fill(-1);
  std::size_t going = lanes;
  for (int n = 1; going > 0; ++n) {
    lane_rate(f, t + h_, y1_, trial_);
    lane_sums_kernels().correct({.n = static_cast<std::ptrdiff_t>(y.size() / lanes),
                                 .h = h_,
                                 .weight = h_ * implicit_,
                                 .y = y.data(),
                                 .rate = rates_.newest().data(),
                                 .known = known_.data(),
                                 .fresh = trial_.data(),
                                 .on = on.data(),
                                 .point = y1_.data(),
                                 .of_rate = f1_.data()},
                                change.data());
    for (std::size_t k = 0; k < lanes; ++k) {
      if (on[k] == 0) continue;
      // As `Adams::iterate`.
      const bool solved = change[k] <= 2 * ulp || (change[k] <= 1000 * ulp && n > 1 && change[k] >= before[k] / 2);
      if (!solved && n > 1 && before[k] > 0) rate[k] = change[k] / before[k];
      before[k] = change[k];
      if (!solved && n < adams_iterations && std::isfinite(change[k])) continue;
      if (!solved && !failure) failure = method_.not_solved(t, h_, change[k], n, rate[k]);
      on[k] = 0;
      --going;
    }
  }
  return failure;
}

/// `StormerCowell` with steps of one length.
class StormerCowellLanes final : public LaneMethod {
 public:
  explicit StormerCowellLanes(const StormerCowell<double>& method)
      : next_position_(LaneTerms::of_past(method.position_weights())),
        position_(LaneTerms::of_past(method.present_position_weights())),
        velocity_(LaneTerms::of_past(method.velocity_weights())),
        starter_(StormerCowell<double>::parts_of_start),
        pulls_(method.velocity_weights().size()) {}

  bool goes_on_from_steps() const override { return true; }
  std::vector<LaneNumbers*> memory() override {
    std::vector<LaneNumbers*> all = {&sums_.value, &sums_.low};
    pulls_.add_to(all);
    return all;
  }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    h_ = h;
    half_ = y.size() / 2;
    starter_.begin(y.size());
    pulls_.begin(half_);
    past_.resize(half_);
    sums_.set(y);
    remember(f, t, y);
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override {
    const double end = t + h_;
    if (pulls_.count() < pulls_.most()) {
      starter_.go(f, t, h_, sums_);
      y = sums_.value;
      remember(f, end, y);
      if (pulls_.count() == pulls_.most()) set_up_sums();
      return {};
    }
    const double *const S = sums_.value.data(), *const S_low = sums_.low.data();
    const double *const D = S + half_, *const D_low = S_low + half_;
    next_position_.sum(S, S_low, 1, pulls_.all(), half_, y.data());
    remember(f, end, y);
    sums_.add(half_, half_, pulls_.newest().data());
    sums_.add(0, half_, D);
    sums_.add(0, half_, D_low);
    velocity_.sum(D, D_low, 1, pulls_.all(), half_, y.data() + half_);
    const double per_h = 1 / h_;
    for (std::size_t i = half_; i < 2 * half_; ++i) y[i] *= per_h;
    return {};
  }

 private:
  void remember(LaneField& f, double t, const LaneNumbers& y) {
    LaneNumbers& newest = pulls_.push();
    f.accelerations(t, y.data(), nullptr, newest.data());
    for (double& pull : newest) pull *= h_ * h_;
  }
  /// past_ = - sum w_j h^2 a_(n-j).
  void take_past(LaneTerms& weights) {
    std::fill(past_.begin(), past_.end(), 0.0);
    weights.sum(past_, -1, pulls_.all(), past_);
  }
  /// From y, where the start has arrived, to the sums there: h v = D + ..., q = S - D + ...
  void set_up_sums() {
    for (LaneNumbers* numbers : {&sums_.value, &sums_.low}) {
      for (std::size_t i = half_; i < 2 * half_; ++i) (*numbers)[i] *= h_;
    }
    take_past(velocity_);
    sums_.add(half_, half_, past_.data());
    take_past(position_);
    sums_.add(0, half_, past_.data());
    sums_.add(0, half_, sums_.value.data() + half_);
    sums_.add(0, half_, sums_.low.data() + half_);
  }

  LaneTerms next_position_, position_, velocity_;
  LaneStarter starter_;
  LaneHistory pulls_;      ///< h^2 a
  CompensatedLanes sums_;  ///< during the start y, later (S, D)
  LaneNumbers past_;
  double h_ = 0;
  std::size_t half_ = 0;
};

}  // namespace

std::unique_ptr<LaneMethod> multistep(const MethodChoice& choice) {
  if (choice.info->family != "multistep") return nullptr;
  const std::unique_ptr<Method<double>> made = make_method<double>(*choice.info, choice.options);
  if (const auto* adams = dynamic_cast<const Adams<double>*>(made.get())) return std::make_unique<AdamsLanes>(*adams);
  if (const auto* cowell = dynamic_cast<const StormerCowell<double>*>(made.get()))
    return std::make_unique<StormerCowellLanes>(*cowell);
  return nullptr;
}

}  // namespace noether::lane_methods
