#include "integrators/lane_method.hpp"

#include "integrators/particle_vector.hpp"
#include "numbers/error.hpp"

#include <utility>

namespace noether {

std::unique_ptr<LaneMethod> method_in_lanes(const MethodChoice& choice) {
  if (choice.info->is_adaptive(choice.options)) return nullptr;
  for (const auto& family :
       {lane_methods::runge_kutta, lane_methods::nystrom, lane_methods::collocation, lane_methods::multistep}) {
    if (auto made = family(choice)) return made;
  }
  return nullptr;
}

namespace {

void copy_lane_of(LaneNumbers& numbers, std::size_t from, std::size_t to) {
  for (std::size_t at = 0; at < numbers.size(); at += LaneField::lanes) numbers[at + to] = numbers[at + from];
}

/// A method over eight systems, and changes of them. At whole steps there is nothing to complete: the settled state is
/// in y = (q, v), whose halves hold the systems (part 0), and then each change (parts 1, 2 ...).
class MethodLanes final : public LaneRun {
 public:
  MethodLanes(std::unique_ptr<LaneMethod> method, ForceField<double> forces, const ParticleSystem<double>& like,
              const Clock<double>& clock)
      : method_(std::move(method)),
        field_(std::move(forces), like),
        y_(2 * lanes * static_cast<std::size_t>(field_.size())),
        clock_(clock),
        kept_clock_(clock) {}

  std::int64_t step() const override { return clock_.step(); }

  void put(std::size_t lane, const ParticleSystem<double>& s) override {
    field_.put_masses(lane, s);
    detail::gather_particles(s, one_);
    put_part(lane, 0, one_.data());
  }
  void take(std::size_t lane, ParticleSystem<double>& s) const override {
    Vector<double> of_lane(2 * field_.part());
    double* to = of_lane.data();
    for (const std::size_t half : {0, 1}) {
      for (std::size_t at = place(half, 0); at < place(half, 1); at += lanes) *to++ = y_[at + lane];
    }
    detail::scatter_particles(of_lane, s);
    s.clock() = clock_;
    s.phase() = Phase{};
  }
  void copy_lane(std::size_t from, std::size_t to) override {
    field_.copy_masses(from, to);
    copy_lane_of(y_, from, to);
    if (!begun_) return;
    for (LaneNumbers* numbers : method_->memory()) copy_lane_of(*numbers, from, to);
  }

  void carry(std::size_t changes) override {
    if (method_->goes_on_from_steps())
      throw Error(
          "the method goes on from earlier steps, which changes of a state do not; use a method of single steps");
    const LaneNumbers before = y_;
    const std::size_t v = place(1, 0);
    field_.carry(changes);
    y_.assign(2 * lanes * static_cast<std::size_t>(field_.size()), 0);
    std::copy_n(before.data(), place(0, 1), y_.data());
    std::copy_n(before.data() + v, place(0, 1), y_.data() + place(1, 0));
  }
  void follow(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by) override {
    put_part(lane, 1 + change, by->start().data());
    followed_.add(lane, change, std::move(by));
  }
  void forget(std::size_t lane) override { followed_.forget(lane); }

  bool advance(std::int64_t steps) override {
    if (!begun_ && steps > 0) method_->begin(field_, clock_.time(), clock_.dt(), y_);
    begun_ = begun_ || steps > 0;
    const std::int64_t until = step() + steps;
    while (step() < until) {
      if (!make(followed_.stride(step(), until - step()))) return false;
      measure(true);
    }
    return true;
  }
  const std::optional<Failure>& failure() const override { return failure_; }
  void settle() override { measure(false); }
  void keep() override {
    kept_clock_ = clock_;
    field_.keep();
    followed_.keep();
    kept_.clear();
    kept_.push_back(y_);
    if (!begun_) return;
    for (const LaneNumbers* numbers : method_->memory()) kept_.push_back(*numbers);
  }
  void go_back() override {
    clock_ = kept_clock_;
    y_ = kept_[0];
    begun_ = kept_.size() > 1 || method_->memory().empty();
    for (std::size_t k = 1; k < kept_.size(); ++k) *method_->memory()[k - 1] = kept_[k];
    failure_.reset();
    field_.go_back();
    followed_.go_back();
  }

 private:
  /// Where a part of all q (half 0) or all v (half 1) begins.
  std::size_t place(std::size_t half, std::size_t part) const {
    return lanes * static_cast<std::size_t>(field_.part()) * (half * (1 + field_.changes()) + part);
  }
  void put_part(std::size_t lane, std::size_t part, const double* from) {
    for (const std::size_t half : {0, 1}) {
      for (std::size_t at = place(half, part); at < place(half, part + 1); at += lanes) y_[at + lane] = *from++;
    }
  }
  bool make(std::int64_t steps) {
    for (std::int64_t made = 0; made < steps; ++made) {
      const std::optional<Failure> failure = method_->step(field_, clock_.time(), y_);
      if (failure_ || field_.failure() || failure) {
        if (!failure_) failure_ = field_.failure() ? field_.failure() : failure;
        return false;
      }
      clock_.tick(0.0);
    }
    return true;
  }
  /// @param due  only changes that are to be measured at this step; else those that may be looked at
  void measure(bool due) {
    followed_.measure(
        step(), due,
        [this](std::size_t change, double* squares) {
          for (const std::size_t half : {0, 1}) {
            Pack sum(0);
            for (std::size_t at = place(half, 1 + change); at < place(half, 2 + change); at += lanes) {
              const Pack c = Pack::load(y_.data() + at);
              sum += c * c;
            }
            sum.store(squares + half * lanes);
          }
        },
        [this](std::size_t lane, std::size_t change, double factor) {
          LaneParts(field_).scale_change(y_, lane, change, factor);
          if (begun_) method_->scale_change(lane, change, factor);
        });
  }

  std::unique_ptr<LaneMethod> method_;
  LaneField field_;
  LaneNumbers y_;
  Clock<double> clock_, kept_clock_;
  bool begun_ = false;
  std::vector<LaneNumbers> kept_;  ///< y and, once it has begun, what the method remembers
  FollowedChanges followed_;
  Vector<double> one_;
  std::optional<Failure> failure_;
};

}  // namespace

std::unique_ptr<LaneRun> run_in_lanes(std::unique_ptr<LaneMethod> method, ForceField<double> forces,
                                      const ParticleSystem<double>& like, const Clock<double>& clock) {
  return std::make_unique<MethodLanes>(std::move(method), std::move(forces), like, clock);
}

}  // namespace noether
