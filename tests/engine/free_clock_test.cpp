/// Runs whose integrator chooses its own steps: outputs at exact times, and no step of the run ever shortened for them.

#include "engine/simulation.hpp"

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>

namespace noether {
namespace {

/// Bogacki and Shampine's pair of orders 3 and 2 over gravity, with an elementary step control: the smallest integrator
/// that owns a free clock.
class AdaptiveTest {
 public:
  using real = double;
  using System = ParticleSystem<double>;

  explicit AdaptiveTest(Gravity gravity, double first_step) : gravity_(gravity), next_(first_step) {}

  IntegratorClaims claims() const {
    return {.method = "adaptive_test", .hamiltonian = "gravity", .order = 3, .clock = ClockMode::free};
  }
  void bind(System& s) {
    for (auto* column : {&a_, &x_, &v_}) *column = VectorColumn<double>(s.size());
    for (std::size_t k = 0; k < 4; ++k) kx_[k] = kv_[k] = VectorColumn<double>(s.size());
  }
  Advance advance(System& s, const Span& span) {
    std::int64_t done = 0;
    while (done < span.steps) {
      if (s.clock().high() + next_ > span.limit) return {done, true, {}};
      const double h = next_;
      const double error = step(s, h);
      next_ = h * std::clamp(0.9 * std::cbrt(1e-7 / error), 0.2, 3.0);
      if (error > 1e-7) {
        undo(s);
        continue;
      }
      s.clock().advance(h);
      ++done;
      if (span.stop != nullptr && span.stop->load()) break;
    }
    return {done, false, {}};
  }
  void settle(const System& raw, System& out, Request /*wanted*/, std::optional<double> at, bool /*corrected*/) {
    out.assign_state(raw);
    if (!at) return;
    const std::int64_t counted = forces_;
    step(out, *at - raw.clock().high());
    forces_ = counted;
    out.clock().move_to(*at);
  }
  EnergyTerms<double> energy(const System& s) {
    ForceSink<double> sink(a_, s, {.energy = true});
    gravity_.add_to(sink, s);
    return {kinetic_energy(s), sink.potential()};
  }
  void accelerations(const System& s, VectorColumn<double>& a) {
    ForceSink<double> sink(a, s, {});
    gravity_.add_to(sink, s);
  }
  Evaluations evaluations() const { return {.force = forces_}; }
  void save(SavedState& saved, const std::string& prefix) const {
    save_value(saved, prefix + "next", next_);
    save_value(saved, prefix + "forces", forces_);
  }
  void load(const SavedState& saved, const std::string& prefix) {
    load_value(saved, prefix + "next", next_);
    load_value(saved, prefix + "forces", forces_);
  }

 private:
  /// One step of length h; returns the largest difference of the two orders.
  double step(System& s, double h) {
    x_ = std::as_const(s).positions();
    v_ = std::as_const(s).velocities();
    stage(s, 0);
    put(s, h, {1.0 / 2, 0, 0});
    stage(s, 1);
    put(s, h, {0, 3.0 / 4, 0});
    stage(s, 2);
    put(s, h, {2.0 / 9, 1.0 / 3, 4.0 / 9});
    stage(s, 3);
    constexpr std::array<double, 4> difference = {-5.0 / 72, 1.0 / 12, 1.0 / 9, -1.0 / 8};
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
      for (Index i = 0; i < s.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += difference[k] * kx_[k].component(c)[i];
        worst = std::max(worst, std::abs(h * sum));
      }
    }
    return std::max(worst, 1e-300);
  }
  void stage(System& s, std::size_t k) {
    ++forces_;
    ForceSink<double> sink(kv_[k], s, {});
    gravity_.add_to(sink, s);
    kx_[k] = std::as_const(s).velocities();
  }
  void put(System& s, double h, const std::array<double, 3>& weights) {
    for (int c = 0; c < 3; ++c) {
      for (Index i = 0; i < s.size(); ++i) {
        double x = x_.component(c)[i], v = v_.component(c)[i];
        for (std::size_t k = 0; k < 3; ++k) {
          x += h * weights[k] * kx_[k].component(c)[i];
          v += h * weights[k] * kv_[k].component(c)[i];
        }
        s.positions().component(c)[i] = x;
        s.velocities().component(c)[i] = v;
      }
    }
  }
  void undo(System& s) {
    s.positions() = x_;
    s.velocities() = v_;
  }

  Gravity gravity_;
  double next_;
  std::int64_t forces_ = 0;
  VectorColumn<double> a_, x_, v_;
  std::array<VectorColumn<double>, 4> kx_, kv_;
};
static_assert(Integrator<AdaptiveTest>);

/// Two bodies on an ellipse of eccentricity 0.6, period 2 pi: steps vary by a factor of about five.
ParticleSystem<double> ellipse() {
  ParticleSystem<double> s;
  s.add("heavy", 0.75, {-0.25 * 1.6, 0, 0}, {0, -0.25 * 0.5, 0});
  s.add("light", 0.25, {0.75 * 1.6, 0, 0}, {0, 0.75 * 0.5, 0});
  return s;
}

Simulation<double> make_run() { return Simulation(ellipse(), AdaptiveTest(Gravity{.G = 1}, 0.01)); }

/// Keeps the moments it has seen and the position of the light body then.
struct Moment {
  std::int64_t step;
  double time;
  Vec3<double> x;
  double label;
};
struct Diary {
  std::vector<Moment>* seen;
  void observe(const Snapshot<double>& now) const {
    seen->push_back({now.step(), now.time(), now.state().positions()[1], now.state().time()});
  }
};

/// Times of all steps of a run to time 20.
std::vector<double> steps_of(const std::vector<Moment>& every_step) {
  std::vector<double> times;
  for (const Moment& moment : every_step) times.push_back(moment.time);
  return times;
}

/// Where the light body is at time t, by many small steps of order 6.
Vec3<double> reference(double t) {
  const std::int64_t n = 20000;
  Simulation run(ellipse(), compose(test::kinetic_potential(Gravity{.G = 1}), schemes::blanes_moan_s10),
                 t / static_cast<double>(n));
  CHECK(run.run(n).ok());
  return run.particles().positions()[1];
}

}  // namespace

TEST_CASE("monitors by time look at exact times that the steps of the run do not meet", "[free clock]") {
  auto run = make_run();
  std::vector<Moment> timed, stepped;
  run.every_time(0.7, Diary{&timed});
  run.every(1, Diary{&stepped});
  CHECK(run.run_until(20).ok());
  REQUIRE(timed.size() == 29);
  const std::vector<double> steps = steps_of(stepped);
  for (std::size_t k = 0; k < timed.size(); ++k) {
    CHECK(timed[k].time == static_cast<double>(7 * k) / 10);
    CHECK(timed[k].label == timed[k].time);
    // It was reached from the last whole step before it.
    CHECK(steps[static_cast<std::size_t>(timed[k].step)] <= timed[k].time);
    const auto next = static_cast<std::size_t>(timed[k].step) + 1;
    if (next < steps.size()) CHECK(steps[next] > timed[k].time);
    if (k > 0) CHECK(std::find(steps.begin(), steps.end(), timed[k].time) == steps.end());
  }
}

TEST_CASE("a monitor by time that comes late looks from the present on, at the multiples it would have had",
          "[free clock]") {
  for (const double comes : {3.0, 2.8, 2.8000001}) {
    auto run = make_run();
    CHECK(run.run_until(comes).ok());
    std::vector<Moment> early, timed;
    run.every_time(0.7, Diary{&timed});
    CHECK(run.run_until(5).ok());
    auto whole = make_run();
    whole.every_time(0.7, Diary{&early});
    CHECK(whole.run_until(5).ok());
    std::erase_if(early, [&](const Moment& m) { return m.time < comes; });
    REQUIRE(timed.size() == (comes == 2.8 ? 4u : 3u));
    REQUIRE(timed.size() == early.size());
    for (std::size_t k = 0; k < timed.size(); ++k) {
      CHECK(timed[k].time == early[k].time);
      CHECK(timed[k].x == early[k].x);
    }
  }
}

TEST_CASE("what is shown between two steps is as accurate as the steps", "[free clock]") {
  auto run = make_run();
  std::vector<Moment> timed, stepped;
  run.every_time(0.7, Diary{&timed});
  run.every(1, Diary{&stepped});
  CHECK(run.run_until(7).ok());
  const auto error = [](const Moment& m) { return std::sqrt(norm2(Vec3<double>(m.x - reference(m.time)))); };
  double between = 0;
  for (std::size_t k = 1; k < timed.size(); ++k) between = std::max(between, error(timed[k]));
  double at_steps = 0;
  for (std::size_t k = stepped.size() / 10; k < stepped.size(); k += stepped.size() / 10) {
    at_steps = std::max(at_steps, error(stepped[k]));
  }
  CHECK(at_steps > 0);
  CHECK(between < 2 * at_steps);
}

TEST_CASE("steps and bits depend neither on monitors nor on the ends of runs", "[free clock]") {
  std::vector<Moment> bare_steps;
  auto bare = make_run();
  bare.every(1, Diary{&bare_steps});
  CHECK(bare.run_until(20).ok());
  const std::vector<double> expected = steps_of(bare_steps);
  CHECK(expected.size() > 100);
  for (const double interval : {0.013, 0.7, 100.0}) {
    for (const double piece : {20.0, 0.31}) {
      CAPTURE(interval, piece);
      auto run = make_run();
      std::vector<Moment> steps, timed;
      run.every_time(interval, Diary{&timed});
      run.every_time(interval, Energy{});
      run.every(1, Diary{&steps});
      for (double until = 0; until < 20; until += piece) CHECK(run.run_until(until).ok());
      CHECK(run.run_until(20).ok());
      CHECK(steps_of(steps) == expected);
      CHECK(test::same_bits(run.particles(), bare.particles()));
      CHECK(run.evaluations().force == bare.evaluations().force);
      CHECK(timed.size() == static_cast<std::size_t>(20 / interval) + 1);
    }
  }
}

TEST_CASE("the end that was asked for is shown on a copy; the run stands at the whole step before", "[free clock]") {
  auto run = make_run();
  const Outcome outcome = run.run_until(3.25);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.time == 3.25);
  CHECK(run.time() == 3.25);
  CHECK(run.particles().time() == 3.25);
  CHECK(run.particles().clock().step() == run.step());
  const auto saved = load_particles<double>(run.save().particles);
  CHECK(saved.clock().high() < 3.25);
  CHECK(saved.clock().step() == run.step());
  const Vec3<double> error = run.particles().positions()[1] - reference(3.25);
  CHECK(std::sqrt(norm2(error)) < 1e-4);  // the whole step before is 1e-2 away
  CHECK(std::sqrt(norm2(Vec3<double>(saved.positions()[1] - reference(3.25)))) > 1e-3);

  CHECK(run.run_until(3.25).ok());
  CHECK_THROWS_WITH(run.run_until(3),
                    "time 3 has passed: the run is already at 3.25, and method 'adaptive_test' cannot go back in time");
  CHECK_THROWS(run.run_until(std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("run(n) makes n whole steps of a free clock", "[free clock]") {
  auto run = make_run();
  std::vector<Moment> timed;
  run.every_time(0.05, Diary{&timed});
  CHECK(run.run(17).ok());
  CHECK(run.step() == 17);
  CHECK(run.run(0).ok());
  CHECK(run.step() == 17);
  const double now = run.time();
  CHECK(timed.size() == static_cast<std::size_t>(now / 0.05) + 1);
  CHECK(load_particles<double>(run.save().particles).clock().high() == now);
}

TEST_CASE("a free run saved between two steps goes on bit for bit", "[free clock]") {
  const auto make = [](std::vector<Moment>* timed) {
    auto run = make_run();
    run.every_time(0.3, Diary{timed});
    return run;
  };
  std::vector<Moment> whole_seen, first_seen, second_seen;
  auto whole = make(&whole_seen), first = make(&first_seen), second = make(&second_seen);
  auto& whole_energy = whole.every_time(0.2, Energy{});
  first.every_time(0.2, Energy{});
  auto& second_energy = second.every_time(0.2, Energy{});
  CHECK(whole.run_until(20).ok());
  CHECK(first.run_until(11.11).ok());
  second.restore(first.save());
  CHECK(second.time() == 11.11);
  CHECK(test::same_bits(second.particles(), first.particles()));
  CHECK(second.run_until(20).ok());
  CHECK(test::same_bits(second.particles(), whole.particles()));
  CHECK(first_seen.size() + second_seen.size() == whole_seen.size());
  CHECK(second_energy.worst() == whole_energy.worst());
  CHECK(second_energy.rms() == whole_energy.rms());
  CHECK(second_energy.slope() == whole_energy.slope());
}

TEST_CASE("events end a free run at a whole step", "[free clock]") {
  // The bodies come within 0.5 where 1 - 0.6 cos E = 0.5: after the apocentre at time 0, at E = 2 pi - acos(5/6).
  auto run = make_run();
  run.stop_when(closer_than(0.5), 1);
  const Outcome outcome = run.run_until(20);
  CHECK(outcome.kind == Outcome::Kind::stopped);
  const double E = std::acos(5.0 / 6);
  const double when = 3.141592653589793 - (E - 0.6 * std::sin(E));
  const std::string since = outcome.message.substr(outcome.message.find("since time ") + 11);
  CHECK(outcome.message.find("collision of heavy and light, distance 0.") == 0);
  CHECK(std::abs(std::stod(since) - when) < 1e-4);
  CHECK(outcome.time == load_particles<double>(run.save().particles).clock().high());
  CHECK(outcome.time >= std::stod(since));
}

TEST_CASE("a raised flag ends a free run after the current step", "[free clock]") {
  auto run = make_run();
  std::atomic<bool> stop{false};
  run.stop_on(&stop);
  struct Raise {
    std::atomic<bool>* flag;
    void observe(const Snapshot<double>& now) const { *flag = now.step() >= 20; }
  };
  run.every(1, Raise{&stop});
  const Outcome outcome = run.run_until(20);
  CHECK(outcome.kind == Outcome::Kind::interrupted);
  CHECK(outcome.step == 20);
  CHECK(outcome.time < 20);
}

TEST_CASE("a free run that loses its numbers ends as diverged", "[free clock]") {
  ParticleSystem<double> s;
  s.add("left", 1, {0, 0, 0}, {0, 0, 0});
  s.add("right", 1, {0, 0, 0}, {0, 0, 0});
  Simulation run(std::move(s), AdaptiveTest(Gravity{.G = 1}, 0.01));
  CHECK(run.run(1).kind == Outcome::Kind::diverged);
}

TEST_CASE("steps of a free clock can be neither given nor changed", "[free clock]") {
  CHECK_THROWS_WITH(Simulation(ellipse(), AdaptiveTest(Gravity{.G = 1}, 0.01), 0.5),
                    "method 'adaptive_test' chooses its steps itself; leave out the step after the integrator");
  CHECK_THROWS_WITH(
      Simulation<double>(ellipse(), AdaptiveTest(Gravity{.G = 1}, 0.01), Clock<double>::free(0, Direction::backward)),
      "method 'adaptive_test' cannot go back in time; give it a clock that goes forward");
  auto run = make_run();
  CHECK_THROWS_WITH(run.change_step(0.5), "method 'adaptive_test' chooses its steps itself; they cannot be set");
  CHECK_THROWS_WITH(run.every_time(-1, Energy{}),
                    "monitor 'energy' cannot sample every -1 of time; a finite time above 0 is expected");
}

namespace {

/// The same, but no state between its steps can be shown in a stretch of time.
class UnshownTest : public AdaptiveTest {
 public:
  using AdaptiveTest::AdaptiveTest;

  void settle(const System& raw, System& out, Request wanted, std::optional<double> at, bool corrected) {
    AdaptiveTest::settle(raw, out, wanted, at, corrected);
    if (at && *at > 2 && *at < 3) out.positions().set(1, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  }
};

}  // namespace

TEST_CASE("a run whose state cannot be shown at a time ends at the whole step before, and says so", "[free clock]") {
  Simulation<double> run(ellipse(), UnshownTest(Gravity{.G = 1}, 0.01));
  std::vector<Moment> timed, stepped;
  run.every_time(0.7, Diary{&timed});
  const Outcome outcome = run.run_until(20);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message ==
        "no step of 'adaptive_test' that ends at time 2.1 succeeds, where the state is to be shown, though the run "
        "itself steps past it; choose other times");
  REQUIRE(timed.size() == 3);
  CHECK(timed.back().time == 1.4);
  auto bare = make_run();
  bare.every(1, Diary{&stepped});
  CHECK(bare.run(outcome.step + 1).ok());
  const std::vector<double> steps = steps_of(stepped);
  const auto last = static_cast<std::size_t>(outcome.step);
  CHECK(steps[last] == outcome.time);
  CHECK(steps[last] < 2.1);
  CHECK(steps[last + 1] > 2.1);
  CHECK(run.particles().positions()[1] == stepped[last].x);
}

}  // namespace noether
