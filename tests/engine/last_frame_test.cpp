// Who writes files looks where a run stops or fails, due or not, once; and at no other end.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

/// The moments that somebody has been shown: step, time, and where the second particle was.
struct ShownMoment {
  std::int64_t step;
  double time, x;
  bool operator==(const ShownMoment&) const = default;
};

/// Writes as files do, into memory.
struct MomentWriter {
  static constexpr auto describe() { return part<MomentWriter>("moment_writer", "what it is shown, in memory"); }
  void observe(const Snapshot<double>& now) {
    seen->push_back({now.step(), now.time(), now.state().positions()[now.state().size() - 1][0]});
  }
  void record(const Sample&) {}

  std::vector<ShownMoment>* seen;
};

/// The same, but no writer.
struct MomentWatcher {
  static constexpr auto describe() { return part<MomentWatcher>("moment_watcher", "what it is shown, in memory"); }
  void observe(const Snapshot<double>& now) { seen->push_back({now.step(), now.time(), 0}); }

  std::vector<ShownMoment>* seen;
};

/// A body and a tracer that pass each other on straight lines: nearest, at distance 1, when t = 10.
ParticleSystem<double> passing_by() {
  ParticleSystem<double> s;
  s.add("rock", 1e-30, {0, 0, 0}, {0, 0, 0});
  s.add("probe", 0, {-30, 1, 0}, {3, 0, 0});
  return s;
}

/// A run of both with steps of 1/2, whose writer looks every `steps`.
struct PassingRun {
  explicit PassingRun(std::int64_t steps)
      : simulation(passing_by(), compose(kinetic_potential(Gravity{.G = 1e-30}), schemes::verlet), 0.5) {
    simulation.every(steps, MomentWriter{&written});
    simulation.every(steps, MomentWatcher{&watched});
  }
  std::vector<ShownMoment> written, watched;
  Simulation<double> simulation;
};

}  // namespace

TEST_CASE("the state at a stop is written, once", "[stop][last_frame]") {
  PassingRun run(100);
  run.simulation.stop_when(closer_than(1.5), 7);
  const Outcome outcome = run.simulation.run(1000);
  CHECK(outcome.kind == Outcome::Kind::stopped);
  CHECK(outcome.step == 21);  // within 1.5 since t = 9.63; looked at every 3.5
  CHECK(run.written == std::vector<ShownMoment>{{0, 0, -30}, {21, 10.5, 1.5}});
  CHECK(run.watched.size() == 1);  // who writes nothing keeps to its cadence

  PassingRun due(7);
  due.simulation.stop_when(closer_than(1.5), 7);
  CHECK(due.simulation.run(1000).step == 21);
  CHECK(due.written.size() == 4);
  CHECK(due.written.back() == ShownMoment{21, 10.5, 1.5});
}

TEST_CASE("so is one that is found when the run ends", "[stop][last_frame]") {
  PassingRun run(100);
  run.simulation.stop_when(closer_than(1.5), 1000);
  const Outcome outcome = run.simulation.run(40);
  CHECK(outcome.kind == Outcome::Kind::stopped);
  CHECK(run.written == std::vector<ShownMoment>{{0, 0, -30}, {40, 20, 30}});
}

TEST_CASE("an end that was asked for, and an interrupted run, write what is due", "[last_frame]") {
  PassingRun run(15);
  CHECK(run.simulation.run(40).kind == Outcome::Kind::completed);
  REQUIRE(run.written.size() == 3);
  CHECK(run.written.back().step == 30);
  const std::atomic<bool> stop = true;
  run.simulation.stop_on(&stop);
  CHECK(run.simulation.run(10).kind == Outcome::Kind::interrupted);
  CHECK(run.written.size() == 3);
}

TEST_CASE("a run that fails leaves its last sound state", "[last_frame]") {
  // Each step of this spring multiplies the amplitude by 98.
  ParticleSystem<double> s;
  s.add("ball", 1, {1, 0, 0}, {0, 0, 0});
  std::vector<ShownMoment> written;
  Simulation run(std::move(s), compose(kinetic_potential(HarmonicField{.k = 100}), schemes::verlet), 1.0);
  run.every(1000, MomentWriter{&written});
  const Outcome outcome = run.run(2000);
  CHECK(outcome.kind == Outcome::Kind::diverged);
  REQUIRE(written.size() == 2);
  CHECK(written.back().step == outcome.step);
  CHECK(outcome.step > 100);
  CHECK(std::isfinite(written.back().x));
  CHECK(written.back().x == run.particles().positions()[0][0]);
}

TEST_CASE("where steps are chosen by the method the last of what is written is where the run stopped",
          "[stop][last_frame]") {
  // Looked at each step, or only when the run ends, between two steps and after the passage at t = 10.
  for (const std::int64_t steps : {1, 1000}) {
    for (const double interval : {0.75, 4.0, 11.0, 100.0}) {
      CAPTURE(steps, interval);
      std::vector<ShownMoment> written, by_steps;
      Simulation<double> run(passing_by(), classical(Gravity{.G = 1e-30}, method("dop853")));
      run.every_time(interval, MomentWriter{&written});
      run.every(1000, MomentWriter{&by_steps});
      run.stop_when(closer_than(1.5), steps);
      const Outcome outcome = run.run_until(11);
      CHECK(outcome.kind == Outcome::Kind::stopped);
      if (steps == 1000) CHECK(outcome.time == 11);
      REQUIRE(written.size() > 1);
      for (std::size_t k = 1; k < written.size(); ++k) CHECK(written[k].time > written[k - 1].time);
      CHECK(written.back().time == outcome.time);
      CHECK(written.back().x == run.particles().positions()[1][0]);
      CHECK(by_steps.size() == 2);
      CHECK(by_steps.back() == written.back());
    }
  }
}

TEST_CASE("no look shows a state of another time where a step on the way to it fails", "[last_frame]") {
  // x = cosh(100 t): its squares leave the range of doubles when t = 3.556.
  for (const std::string name : {"dop853", "rodas_5p", "dormand_prince_5"}) {
    for (const bool by_list : {false, true}) {
      CAPTURE(name, by_list);
      ParticleSystem<double> s;
      s.add("ball", 1, {1, 0, 0}, {0, 0, 0});
      std::vector<ShownMoment> written;
      Simulation<double> run(std::move(s), classical(HarmonicField{.k = -10'000}, method(name)));
      std::vector<double> times;
      for (int k = 1; k <= 50'000; ++k) times.push_back(0.001 * k);
      if (by_list) run.at_times(times, MomentWriter{&written});
      if (!by_list) run.every_time(0.001, MomentWriter{&written});
      const Outcome outcome = run.run_until(50);
      REQUIRE_FALSE(outcome.ok());
      REQUIRE(outcome.time > 1);
      REQUIRE(written.size() > 1000);
      CHECK(written.back().time == outcome.time);
      CHECK(written.back().step == outcome.step);
      CHECK(written.back().x == run.particles().positions()[0][0]);
      int wrong = 0, back = 0;
      for (std::size_t k = 1; k < written.size(); ++k) {
        const double t = written[k].time, exact = 100 * t + std::log1p(std::exp(-200 * t)) - std::log(2.0);
        wrong += std::abs(std::log(written[k].x) - exact) < 1e-3 ? 0 : 1;
        back += written[k].time > written[k - 1].time ? 0 : 1;
      }
      CHECK(wrong == 0);
      CHECK(back == 0);
    }
  }
}

TEST_CASE("a run that fails before its end in time does not end there", "[last_frame]") {
  for (const double until : {3.559, 3.561, 3.6}) {
    CAPTURE(until);
    ParticleSystem<double> s;
    s.add("ball", 1, {1, 0, 0}, {0, 0, 0});
    Simulation<double> run(std::move(s), classical(HarmonicField{.k = -10'000}, method("dop853")));
    const Outcome outcome = run.run_until(until);
    REQUIRE_FALSE(outcome.ok());
    CHECK(outcome.time < until);
    CHECK(std::abs(std::log(run.particles().positions()[0][0]) - (100 * outcome.time - std::log(2.0))) < 1e-3);
  }
}

}  // namespace noether::test
