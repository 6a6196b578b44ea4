#pragma once
/// Small changes of systems in lanes, on the side of those who look at them.

#include "engine/tangent_flow.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace noether {

/// How the length of a small change grows as it goes along with a run in lanes (`LaneRun`).
class LaneChange {
 public:
  /// What the monitor asks for: to measure every `stride` steps |c|^2 = |dx|^2 + scale^2 |dv|^2.
  void ask(std::int64_t stride, double scale) { stride_ = stride, scale_ = scale; }
  /// @param c  the change, at a step of the run
  void begin(std::int64_t step, std::vector<double> c);
  bool begun() const { return !start_.empty(); }
  const std::vector<double>& start() const { return start_; }

  /// Steps from here to the next one at which the change is to be measured.
  std::int64_t next(std::int64_t step) const { return stride_ - (step - since_); }
  /// Takes |dx|^2 and |dv|^2 of a step at which that is.
  void measured(std::int64_t step, double x2, double v2);
  /// Takes those of a step at which the monitor may look.
  void seen(std::int64_t step, double x2, double v2);
  /// By how much the change is to be made longer, as a power of 2: else it would leave the range of doubles.
  double factor() const;
  void scaled(double factor) { square_ *= factor * factor, seen_square_ *= factor * factor; }

  /// Tells what was measured since this was last asked for: steps, and by how much ln |c| grew in them.
  template <class Told> void tell(const Told& told) {
    if (seen_step_ > since_) grow(seen_step_, seen_square_);
    for (const auto& [steps, growth] : growths_) told(steps, growth);
    growths_.clear();
  }
  void keep() { kept_ = {growths_.size(), since_, square_}; }
  void go_back();

 private:
  struct Kept {
    std::size_t growths = 0;
    std::int64_t since = 0;
    double square = 1;
  };
  double square(double x2, double v2) const { return x2 + scale_ * scale_ * v2; }
  void grow(std::int64_t step, double square);

  std::int64_t stride_ = 1, since_ = 0, seen_step_ = 0;
  double scale_ = 1, square_ = 1, seen_square_ = 1;  ///< |c|^2 at the steps `since_` and `seen_step_`
  std::vector<double> start_;
  std::vector<std::pair<std::int64_t, double>> growths_;
  Kept kept_;
};

/// The changes of a run in lanes that somebody follows.
class FollowedChanges {
 public:
  void add(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by);
  /// Nobody looks at those of a lane any more.
  void forget(std::size_t lane);
  /// Steps from here to the first one at which a change is to be measured, at most so many.
  std::int64_t stride(std::int64_t step, std::int64_t most) const;
  /// Measures changes.
  /// @param due  only those that are to be measured at this step; else all, which may be looked at
  /// @param squares  takes which change, and gives |dx|^2 and |dv|^2 in all lanes, shape (2, 8)
  /// @param scale  takes lane, change, and the factor by which it is to be made longer
  void measure(std::int64_t step, bool due, const std::function<void(std::size_t, double*)>& squares,
               const std::function<void(std::size_t, std::size_t, double)>& scale);
  void keep();
  void go_back();

 private:
  struct Followed {
    std::size_t lane, change;
    std::shared_ptr<LaneChange> by;
  };
  std::vector<Followed> followed_;  ///< by change: each is measured in all lanes at once
};

/// Such a change as the tangent flow of a monitor, which makes no steps of its own.
/// @param numbers  of a state
std::unique_ptr<TangentFlow<double>> tangent_flow_in_lanes(std::shared_ptr<LaneChange> change, Index numbers);

}  // namespace noether
