/// Time is counted, not accumulated: labels are right after any number of steps.

#include "engine/clock.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

namespace noether {
namespace {

constexpr std::int64_t billion = 1'000'000'000;

}  // namespace

TEST_CASE("the time of a fixed clock is the product of steps and step, rounded once", "[clock]") {
  const double dt = 0.1;
  auto clock = Clock<double>::fixed(0, dt, billion - 1);
  clock.tick(0);
  CHECK(clock.step() == billion);
  const double exact = static_cast<double>(Quad(billion) * Quad(dt));
  CHECK(clock.time() == exact);
  CHECK(clock.time_at(billion) == exact);
  CHECK(Clock<Quad>::fixed(0, dt, billion).time() == Quad(billion) * Quad(dt));
}

TEST_CASE("a sum of as many steps would be wrong, so the label is none", "[clock]") {
  auto clock = Clock<double>::fixed(0, 0.1);
  double sum = 0;
  for (int n = 0; n < 1'000'000; ++n) {
    clock.tick(0);
    sum += 0.1;
  }
  CHECK(clock.time() == static_cast<double>(Quad(1'000'000) * Quad(0.1)));
  CHECK(sum != clock.time());
}

TEST_CASE("stages see the fraction of the step that the drifts have covered", "[clock]") {
  auto clock = Clock<double>::fixed(100, 8, 3);
  clock.set_fraction(0.25);
  CHECK(clock.time() == 126);
  CHECK(clock.fraction() == 0.25);
  clock.tick(0);
  CHECK(clock.time() == 132);
  CHECK(clock.start() == 100);
  CHECK(clock.dt() == 8);
}

TEST_CASE("a fixed clock may run backwards", "[clock]") { CHECK(Clock<double>::fixed(10, -2, 7).time() == -4); }

TEST_CASE("a free clock adds its steps in double-double", "[clock]") {
  auto clock = Clock<double>::free(1e6);
  const double h = 0.1;
  constexpr int steps = 1'000'000;
  double plain = 1e6;
  for (int n = 0; n < steps; ++n) {
    clock.advance(h);
    plain += h;
  }
  const Quad exact = Quad(1e6) + Quad(steps) * Quad(h);
  const Quad reached = Quad(clock.high()) + Quad(clock.low());
  // One rounding of the low word for each step: at most half an ulp of an ulp of the time.
  const Quad ulp = Quad(std::ldexp(1.0, -52)) * exact;
  CHECK(abs(reached - exact) < Quad(steps) * ulp * Quad(std::ldexp(1.0, -53)));
  CHECK(clock.high() == static_cast<double>(exact));
  CHECK(plain != clock.high());
  CHECK(clock.step() == steps);
  CHECK(clock.mode() == ClockMode::free);
}

TEST_CASE("the words of a free clock do not overlap", "[clock]") {
  auto clock = Clock<double>::free(0);
  for (int n = 1; n < 1000; ++n) {
    clock.advance(1.0 / n);
    REQUIRE(clock.high() + clock.low() == clock.high());
  }
}

TEST_CASE("stage offsets of a free clock end with the step", "[clock]") {
  auto clock = Clock<double>::free(5);
  clock.set_stage_offset(0.5);
  CHECK(clock.time() == 5.5);
  clock.advance(1);
  CHECK(clock.time() == 6);
  clock.set_stage_offset(0.5);
  clock.move_to(6.25);
  CHECK(clock.time() == 6.25);
  CHECK(clock.step() == 1);
}

TEST_CASE("a clock comes back from its raw numbers", "[clock]") {
  auto fixed = Clock<Quad>::fixed(1, 0.1, 12);
  fixed.set_fraction(Quad(1) / Quad(3));
  const auto again = Clock<Quad>::from_raw(fixed.raw());
  CHECK(again.time() == fixed.time());
  CHECK(again.step() == 12);
  CHECK(again.mode() == ClockMode::fixed);

  auto free = Clock<double>::free(1e9);
  for (int n = 0; n < 100; ++n) free.advance(1e-3);
  const auto free_again = Clock<double>::from_raw(free.raw());
  CHECK(free_again.high() == free.high());
  CHECK(free_again.low() == free.low());
  CHECK(free_again.start() == 1e9);
  CHECK(free_again.step() == 100);
  CHECK(free.low() != 0);
  CHECK(free_again.direction() == Direction::forward);
  CHECK(Clock<double>::from_raw(Clock<double>::free(0, Direction::backward).raw()).direction() == Direction::backward);
}

TEST_CASE("a clock knows which way it goes", "[clock]") {
  for (const auto& forward : {Clock<double>::fixed(3, 0.5), Clock<double>::free(3)}) {
    CHECK(forward.direction() == Direction::forward);
    CHECK(forward.sign() == 1);
    CHECK(forward.is_later(2, 1));
    CHECK(!forward.is_later(1, 1));
    CHECK(forward.is_later(forward.never(), 1e300));
  }
  for (const auto& back : {Clock<double>::fixed(3, -0.5), Clock<double>::free(3, Direction::backward)}) {
    CHECK(back.direction() == Direction::backward);
    CHECK(back.sign() == -1);
    CHECK(back.is_later(1, 2));
    CHECK(!back.is_later(1, 1));
    CHECK(back.is_later(back.never(), -1e300));
  }
}

TEST_CASE("a free clock that turns starts where it stands, and keeps all its digits", "[clock]") {
  auto clock = Clock<double>::free(1);
  for (int n = 0; n < 100; ++n) clock.advance(0.1);
  const double high = clock.high(), low = clock.low();
  CHECK(low != 0);
  clock.turn();
  CHECK(clock.direction() == Direction::backward);
  CHECK(clock.start() == high);
  CHECK(clock.step() == 100);
  for (int n = 0; n < 100; ++n) clock.advance(-0.1);
  CHECK(clock.high() == 1);
  CHECK(clock.low() == 0);
  CHECK(low != clock.low());
  clock.turn();
  CHECK(clock.direction() == Direction::forward);
}

}  // namespace noether
