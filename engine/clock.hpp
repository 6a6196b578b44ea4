#pragma once
/// Time: counted in whole steps, never accumulated.

#include "numbers/real.hpp"

#include <cstdint>
#include <limits>

namespace noether {

enum class ClockMode : std::uint8_t {
  fixed,  ///< integer n and dt; t = t0 + n dt
  free,   ///< integer n and t as a double-double, for methods that choose their steps
};

/// Which way time goes.
enum class Direction : std::uint8_t { forward, backward };

/// The clock of a run, and the stage time within a step that time-dependent forces see.
///
///     t = t0 + (n + c) dt        fixed; c is the fraction of the step that letters with time have covered so far
///     t = t_high + t_low         free
///
/// It alone knows which way the run goes: the sign of dt says so, or the direction of a free clock.
template <class Real> class Clock {
 public:
  /// A fixed clock of step `dt` [time] that stands at step `step`.
  static Clock fixed(double start, double dt, std::int64_t step = 0) {
    Clock clock;
    clock.start_ = start;
    clock.dt_ = dt;
    clock.step_ = step;
    return clock;
  }

  /// A free clock standing at `start` [time].
  static Clock free(double start, Direction direction = Direction::forward) {
    Clock clock;
    clock.mode_ = ClockMode::free;
    clock.direction_ = direction;
    clock.start_ = start;
    clock.high_ = start;
    return clock;
  }

  ClockMode mode() const { return mode_; }
  std::int64_t step() const { return step_; }
  double start() const { return start_; }
  double dt() const { return dt_; }

  Direction direction() const {
    if (mode_ == ClockMode::free) return direction_;
    return dt_ < 0 ? Direction::backward : Direction::forward;
  }
  /// 1 where time rises, -1 where it falls.
  double sign() const { return direction() == Direction::forward ? 1 : -1; }
  /// A time that this clock does not come to.
  double never() const { return sign() * std::numeric_limits<double>::infinity(); }
  /// Whether this clock comes to time `a` later than to time `b`.
  bool is_later(double a, double b) const { return direction() == Direction::forward ? a > b : a < b; }
  /// Turns a free clock round; where it stands is its start from now on.
  void turn() {
    direction_ = direction_ == Direction::forward ? Direction::backward : Direction::forward;
    start_ = high_;
  }

  /// Time of the current stage; between steps, of the last whole step [time].
  Real time() const {
    if (mode_ == ClockMode::fixed) return Real(start_) + (Real(step_) + fraction_) * Real(dt_);
    return Real(high_) + Real(low_) + stage_offset_;
  }

  /// Time at step `n` of a fixed clock [time].
  double time_at(std::int64_t n) const { return start_ + static_cast<double>(n) * dt_; }
  /// Time of the last whole step [time].
  double at_step() const { return mode_ == ClockMode::fixed ? time_at(step_) : high_; }
  /// How far time `t` lies beyond the last whole step [time], rounded by nothing but `t` itself.
  Quad until(double t) const {
    const Quad whole = mode_ == ClockMode::fixed ? Quad(start_) + Quad(step_) * Quad(dt_) : Quad(high_) + Quad(low_);
    return Quad(t) - whole;
  }

  void set_fraction(const Real& c) { fraction_ = c; }
  Real fraction() const { return fraction_; }

  /// Ends a step of the fixed clock; `c` is the fraction at which the next step stands (0, or minus a pending drift).
  void tick(const Real& c) {
    ++step_;
    fraction_ = c;
  }

  /// Ends a step of `h` [time], signed as the clock is, of the free clock, in double-double.
  void advance(double h) {
    const double sum = high_ + h;
    const double back = sum - high_;
    const double error = (high_ - (sum - back)) + (h - back);
    low_ += error;
    high_ = sum + low_;
    low_ -= high_ - sum;
    ++step_;
    stage_offset_ = Real(0);
  }
  /// Puts the clock of a copy to time `t` [time], a fixed one within a step; the step count stays.
  void move_to(double t) {
    if (mode_ == ClockMode::fixed) {
      fraction_ = Real(until(t) / Quad(dt_));
      return;
    }
    high_ = t;
    low_ = 0;
    stage_offset_ = Real(0);
  }
  void set_stage_offset(const Real& h) { stage_offset_ = h; }
  double high() const { return high_; }
  double low() const { return low_; }

  /// Every number of the clock, for checkpoints.
  struct Raw {
    ClockMode mode;
    std::int64_t step;
    double start, dt, high, low;
    Real fraction;
    Direction direction = Direction::forward;  ///< of a free clock
  };
  Raw raw() const { return {mode_, step_, start_, dt_, high_, low_, fraction_, direction_}; }
  static Clock from_raw(const Raw& r) {
    Clock clock;
    clock.mode_ = r.mode;
    clock.step_ = r.step;
    clock.start_ = r.start;
    clock.dt_ = r.dt;
    clock.high_ = r.high;
    clock.low_ = r.low;
    clock.fraction_ = r.fraction;
    clock.direction_ = r.direction;
    return clock;
  }

 private:
  ClockMode mode_ = ClockMode::fixed;
  Direction direction_ = Direction::forward;
  std::int64_t step_ = 0;
  double start_ = 0, dt_ = 0;
  double high_ = 0, low_ = 0;
  Real fraction_ = Real(0), stage_offset_ = Real(0);
};

}  // namespace noether
