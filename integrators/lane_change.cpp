#include "integrators/lane_change.hpp"

#include "integrators/particle_vector.hpp"
#include "numbers/error.hpp"
#include "numbers/pack.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

void LaneChange::begin(std::int64_t step, std::vector<double> c) {
  start_ = std::move(c);
  since_ = seen_step_ = step;
  double squares[2] = {0, 0};
  for (std::size_t i = 0; i < start_.size(); ++i) squares[2 * i < start_.size() ? 0 : 1] += start_[i] * start_[i];
  square_ = seen_square_ = square(squares[0], squares[1]);
}

void LaneChange::grow(std::int64_t step, double square) {
  growths_.emplace_back(step - since_, 0.5 * std::log(square / square_));
  since_ = step;
  square_ = square;
}

void LaneChange::measured(std::int64_t step, double x2, double v2) {
  grow(step, square(x2, v2));
  seen_step_ = step;
}

void LaneChange::seen(std::int64_t step, double x2, double v2) {
  seen_step_ = step;
  seen_square_ = square(x2, v2);
}

double LaneChange::factor() const {
  constexpr double far = 0x1p200;  // of |c|; squares of doubles reach 2^1023
  if (square_ > far * far) return 1 / far;
  return square_ < 1 / (far * far) && square_ > 0 ? far : 1;
}

void LaneChange::go_back() {
  growths_.resize(kept_.growths);
  since_ = seen_step_ = kept_.since;
  square_ = seen_square_ = kept_.square;
}

void FollowedChanges::add(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by) {
  const auto later = [&](const Followed& one) { return one.change > change; };
  followed_.insert(std::find_if(followed_.begin(), followed_.end(), later), {lane, change, std::move(by)});
}

void FollowedChanges::forget(std::size_t lane) {
  std::erase_if(followed_, [&](const Followed& one) { return one.lane == lane; });
}

std::int64_t FollowedChanges::stride(std::int64_t step, std::int64_t most) const {
  for (const Followed& one : followed_) most = std::min(most, one.by->next(step));
  return most;
}

void FollowedChanges::measure(std::int64_t step, bool due, const std::function<void(std::size_t, double*)>& squares,
                              const std::function<void(std::size_t, std::size_t, double)>& scale) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  alignas(64) double of_lanes[2 * Pack::lanes];
  std::size_t measured = none;
  for (const Followed& one : followed_) {
    if (due && one.by->next(step) > 0) continue;
    if (one.change != measured) squares(one.change, of_lanes);
    measured = one.change;
    const double x2 = of_lanes[one.lane], v2 = of_lanes[one.lane + Pack::lanes];
    if (!due) {
      one.by->seen(step, x2, v2);
      continue;
    }
    one.by->measured(step, x2, v2);
    const double factor = one.by->factor();
    if (factor == 1) continue;
    scale(one.lane, one.change, factor);
    one.by->scaled(factor);
  }
}

void FollowedChanges::keep() {
  for (const Followed& one : followed_) one.by->keep();
}
void FollowedChanges::go_back() {
  for (const Followed& one : followed_) one.by->go_back();
}

namespace {

class LaneTangents final : public TangentFlow<double> {
 public:
  LaneTangents(std::shared_ptr<LaneChange> change, Index numbers) : change_(std::move(change)), numbers_(numbers) {}

  std::unique_ptr<TangentFlow> clone() const override { return std::make_unique<LaneTangents>(*this); }
  Index size() const override { return numbers_; }
  void gather(const ParticleSystem<double>& now, State& y) const override { detail::gather_particles(now, y); }
  void begin(const Clock<double>& clock, const State& /*the run's*/, const Changes& changes) override {
    change_->begin(clock.step(), std::vector<double>(changes.data(), changes.data() + changes.rows()));
  }
  std::optional<Failure> advance(std::int64_t /*steps*/) override { throw made_by_the_run(); }
  void read(State& /*y*/, Changes& /*changes*/) override { throw made_by_the_run(); }
  void measure_along(std::int64_t stride, const double& scale) override { change_->ask(stride, scale); }
  bool tell_growth(const std::function<void(std::int64_t, const double&)>& grown) override {
    change_->tell(grown);
    return true;
  }

 private:
  static LogicError made_by_the_run() {
    return LogicError("steps were requested of a change that goes along with a run");
  }

  std::shared_ptr<LaneChange> change_;
  Index numbers_;
};

}  // namespace

std::unique_ptr<TangentFlow<double>> tangent_flow_in_lanes(std::shared_ptr<LaneChange> change, Index numbers) {
  return std::make_unique<LaneTangents>(std::move(change), numbers);
}

}  // namespace noether
