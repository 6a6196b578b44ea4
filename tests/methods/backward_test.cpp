/// Adaptive methods back in time: runs whose clock falls, runs that turn, and what they keep of runs that go forward.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "integrators/first_order_system.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace noether;

namespace {

/// Every method that chooses its steps, implicit ones with each way of solving their systems.
std::vector<MethodChoice> adaptive_methods(double tolerance) {
  std::vector<MethodChoice> all;
  for (const MethodInfo* info : methods::all()) {
    if (!info->adaptive) continue;
    MethodOptions options;
    if (info->rtol > 1e-15) options.rtol = options.atol = tolerance;
    all.push_back({info, options});
    if (!info->takes(*linear_solver)) continue;
    options.jacobian = JacobianForm::matrix_free;
    all.push_back({info, options});
  }
  return all;
}

std::string name_of(const MethodChoice& choice) {
  return std::string(choice.info->name) + (choice.options.jacobian ? ", matrix-free" : "");
}

Simulation<double> planets(const MethodChoice& choice, Direction direction, ParticleSystem<double> start) {
  return {std::move(start), test::classical_over(Gravity{.G = test::outer_G}, choice),
          Clock<double>::free(0, direction)};
}
Simulation<double> planets(const MethodChoice& choice, Direction direction) {
  return planets(choice, direction, test::outer_planets());
}

/// The same particles with all velocities turned round.
ParticleSystem<double> turned(ParticleSystem<double> s) {
  for (Index i = 0; i < s.size(); ++i) s.velocities().set(i, -Vec3<double>(s.velocities()[i]));
  return s;
}

/// Largest difference of positions [au].
double apart(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) {
    const Vec3<double> d = a.positions()[i] - b.positions()[i];
    worst = std::max(worst, std::sqrt(norm2(d)));
  }
  return worst;
}

/// y' = cos(t) y, from y(0) = 1: y = exp(sin t). Its derivative by t is found by differences: it is in double only.
struct Breathing {
  Index size() const { return 1; }
  std::vector<double> start() const { return {1}; }
  void rates(const double& t, const Vector<double>& y, Vector<double>& dy) const { dy[0] = std::cos(t) * y[0]; }
};

/// y' = -rate y: back in time it grows beyond all numbers.
struct FastDecay {
  double rate = 1000;
  Index size() const { return 1; }
  std::vector<double> start() const { return {1}; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = Real(-rate) * y[0];
  }
};

struct Moment {
  std::int64_t step;
  double time, label, y;
};
/// Keeps what it sees: the first variable, or x of particle 1.
struct Diary {
  std::vector<Moment>* seen;
  void observe(const Snapshot<double>& now) const {
    const auto& s = now.state();
    seen->push_back({now.step(), now.time(), s.time(), s.size() > 0 ? s.positions()[1][0] : s.variables()[0]});
  }
};

}  // namespace

TEST_CASE("back in time is forward with velocities turned round, bit for bit", "[backward]") {
  for (const MethodChoice& choice : adaptive_methods(1e-8)) {
    CAPTURE(name_of(choice));
    auto back = planets(choice, Direction::backward);
    auto mirrored = planets(choice, Direction::forward, turned(test::outer_planets()));
    REQUIRE(back.run(60).ok());
    REQUIRE(mirrored.run(60).ok());
    CHECK(back.time() < 0);
    CHECK(back.time() == -mirrored.time());
    CHECK(test::same_bits(back.particles(), turned(mirrored.particles())));
    CHECK(back.evaluations().force == mirrored.evaluations().force);
    CHECK(back.evaluations().rejected == mirrored.evaluations().rejected);
  }
}

TEST_CASE("so it is where steps are rejected, and orders and lengths chosen anew", "[backward]") {
  // From the apocentre of an ellipse of e = 0.9, with a first step much too long.
  ParticleSystem<double> s;
  s.add("heavy", 0.75, {-0.25 * 1.9, 0, 0}, {0, -0.25 * std::sqrt(0.1 / 1.9), 0});
  s.add("light", 0.25, {0.75 * 1.9, 0, 0}, {0, 0.75 * std::sqrt(0.1 / 1.9), 0});
  for (MethodChoice choice : adaptive_methods(1e-6)) {
    CAPTURE(name_of(choice));
    choice.options.first = 5;
    Simulation<double> back(s, test::classical_over(Gravity{.G = 1}, choice),
                            Clock<double>::free(0, Direction::backward));
    Simulation<double> mirrored(turned(s), test::classical_over(Gravity{.G = 1}, choice), Clock<double>::free(0));
    REQUIRE(back.run_until(-7).ok());
    REQUIRE(mirrored.run_until(7).ok());
    CHECK(back.step() == mirrored.step());
    CHECK(test::same_bits(back.particles(), turned(mirrored.particles())));
    CHECK(back.evaluations().force == mirrored.evaluations().force);
    CHECK(back.evaluations().rejected == mirrored.evaluations().rejected);
    CHECK(back.evaluations().rejected > 0);
  }
}

TEST_CASE("a run that turns comes back to its start within its errors", "[backward]") {
  for (const double tolerance : {1e-6, 1e-9}) {
    for (const MethodChoice& choice : adaptive_methods(tolerance)) {
      CAPTURE(name_of(choice), tolerance);
      // At rounding level one way is one throw of dice; methods of low order take too long for many.
      const int ways = choice.options.rtol || choice.info->order < 12 ? 1 : 25;
      std::vector<double> left;
      for (int way = 0; way < ways; ++way) {
        ParticleSystem<double> start = test::outer_planets();
        start.positions().component(0)[1] *= 1 + 1e-9 * way;
        auto run = planets(choice, Direction::forward, start);
        REQUIRE(run.run_until(4000).ok());
        const Outcome outcome = run.run_until(0);
        CHECK(outcome.kind == Outcome::Kind::completed);
        CHECK(outcome.time == 0);
        CHECK(run.time() == 0);
        CHECK(run.particles().time() == 0);
        left.push_back(apart(run.particles(), start));
      }
      std::nth_element(left.begin(), left.begin() + left.size() / 2, left.end());
      // Variable orders are the farthest away: 3900 tolerances after a year of Jupiter's, there and back.
      CHECK(left[left.size() / 2] < (choice.options.rtol ? 5000 * tolerance : 1e-14));
    }
  }
}

TEST_CASE("a force of time is followed to negative times, and shown on the way", "[backward]") {
  for (const MethodChoice& choice : adaptive_methods(1e-8)) {
    if (choice.info->name == "dprkn_12") continue;
    CAPTURE(name_of(choice));
    std::vector<Moment> seen, steps;
    Simulation<double> run(initial_state(Breathing{}), classical(Breathing{}, choice),
                           Clock<double>::free(0, Direction::backward));
    run.every_time(-0.37, Diary{&seen});
    run.every(1, Diary{&steps});
    const Outcome outcome = run.run_until(-10);
    CHECK(outcome.kind == Outcome::Kind::completed);
    CHECK(outcome.time == -10);
    const double bound = choice.options.rtol ? 200 * 1e-8 : 1e-12;
    CHECK(std::abs(run.particles().variables()[0] - std::exp(std::sin(-10.0))) < bound);
    REQUIRE(seen.size() == 28);
    double worst = 0, worst_step = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      CHECK(seen[k].time == std::round(-37.0 * static_cast<double>(k)) / 100);  // as it would be written
      CHECK(seen[k].label == seen[k].time);
      CHECK(steps[static_cast<std::size_t>(seen[k].step)].time >= seen[k].time);
      worst = std::max(worst, std::abs(seen[k].y - std::exp(std::sin(seen[k].time))));
    }
    for (const Moment& m : steps) worst_step = std::max(worst_step, std::abs(m.y - std::exp(std::sin(m.time))));
    CHECK(worst_step < bound);
    CHECK(worst < 8 * worst_step);
  }
}

TEST_CASE("a driven oscillator is followed to negative times by every method for q'' = a", "[backward]") {
  // q = cos t / 3 + sin 2t
  test::Motion<double> f(1,
                         [](const double& t, const Vector<double>& y, double* a) { a[0] = -4 * y[0] + std::cos(t); });
  Vector<double> start(2);
  start << 1.0 / 3, 2;
  for (const MethodChoice& choice : adaptive_methods(1e-8)) {
    CAPTURE(name_of(choice));
    const auto made = make_method<double>(*choice.info, choice.options);
    const Vector<double> end = test::travel<double>(*made, f, start, -10);
    CHECK(std::abs(end[0] - std::cos(10.0) / 3 + std::sin(20.0)) < (choice.options.rtol ? 400 * 1e-8 : 1e-9));
  }
}

TEST_CASE("back in time in 113 bits an ellipse closes to the digits of the method", "[backward]") {
  using std::atan2;
  const Quad period = Quad(8) * atan2(Quad(1), Quad(1));
  for (const char* name : {"dop853", "gauss_8", "ias15", "dprkn_12", "gragg_bulirsch_stoer"}) {
    CAPTURE(name);
    const bool collocation = method(name).info->family == "collocation";
    const auto made =
        test::make<Quad>(name, collocation ? MethodOptions{} : MethodOptions{.rtol = 1e-20, .atol = 1e-20});
    auto f = test::kepler<Quad>();
    const auto start = test::kepler_start<Quad>(Quad(0.6));
    const double left = test::distance(test::travel<Quad>(*made, f, start, -period), start);
    CHECK(left < (collocation ? 1e-14 : 1e-16));
  }
}

TEST_CASE("a run back in time goes on bit for bit after a restart, whatever looked on", "[backward][restart]") {
  for (const MethodChoice& choice : adaptive_methods(1e-8)) {
    CAPTURE(name_of(choice));
    auto whole = planets(choice, Direction::backward), first = planets(choice, Direction::backward),
         second = planets(choice, Direction::backward);
    for (auto* run : {&first, &second}) {
      run->every(3, Energy{});
      run->every_time(-33.0, Momentum{});
    }
    REQUIRE(whole.run_until(-3000).ok());
    for (const double until : {-500.0, -501.0, -1700.0}) REQUIRE(first.run_until(until).ok());
    second.restore(first.save());
    CHECK(second.time() == -1700);
    CHECK(test::same_bits(second.particles(), first.particles()));
    REQUIRE(second.run_until(-3000).ok());
    CHECK(test::same_bits(whole.particles(), second.particles()));
    CHECK(whole.evaluations().force == second.evaluations().force);
    CHECK(whole.evaluations().jacobian == second.evaluations().jacobian);
  }
}

TEST_CASE("a run that has turned is a run back from where it stood, and turns again", "[backward]") {
  for (const MethodChoice& choice : adaptive_methods(1e-8)) {
    CAPTURE(name_of(choice));
    auto run = planets(choice, Direction::forward);
    REQUIRE(run.run_until(1000).ok());
    auto other = Simulation<double>(run.particles(), test::classical_over(Gravity{.G = test::outer_G}, choice),
                                    Clock<double>::free(1000, Direction::backward));
    const std::int64_t before = run.step();
    REQUIRE(run.run_until(300).ok());
    REQUIRE(other.run_until(300).ok());
    CHECK(run.step() == before + other.step());
    CHECK(apart(run.particles(), other.particles()) == 0);
    // Saved on its way back, it goes on as one that was made to go back.
    auto resumed = planets(choice, Direction::backward);
    resumed.restore(run.save());
    REQUIRE(run.run_until(-200).ok());
    REQUIRE(resumed.run_until(-200).ok());
    CHECK(test::same_bits(run.particles(), resumed.particles()));
    REQUIRE(run.run_until(1000).ok());
    CHECK(run.time() == 1000);
  }
}

TEST_CASE("events back in time are found where the motion turned round has them", "[backward]") {
  // The bodies come within 0.5 where 1 - 0.6 cos E = 0.5: on the way back from the apocentre at time 0.
  ParticleSystem<double> s;
  s.add("heavy", 0.75, {-0.25 * 1.6, 0, 0}, {0, -0.25 * 0.5, 0});
  s.add("light", 0.25, {0.75 * 1.6, 0, 0}, {0, 0.75 * 0.5, 0});
  const double E = std::acos(5.0 / 6), when = -(std::numbers::pi - (E - 0.6 * std::sin(E)));
  for (const char* name : {"dop853", "ias15", "gauss_8", "bdf"}) {
    CAPTURE(name);
    Simulation<double> run(s, test::classical_over(Gravity{.G = 1}, method(name)),
                           Clock<double>::free(0, Direction::backward));
    run.stop_when(closer_than(0.5), 1);
    const Outcome outcome = run.run_until(-20);
    CHECK(outcome.kind == Outcome::Kind::stopped);
    const std::string since = outcome.message.substr(outcome.message.find("since time ") + 11);
    CHECK(std::abs(std::stod(since) - when) < 1e-3);
    CHECK(outcome.time <= std::stod(since));
    CHECK(outcome.time > -20);
  }
}

TEST_CASE("what grows beyond all numbers back in time ends with a name, at finite numbers", "[backward]") {
  for (const MethodChoice& choice : adaptive_methods(1e-6)) {
    if (choice.info->name == "dprkn_12") continue;
    CAPTURE(name_of(choice));
    Simulation<double> run(initial_state(FastDecay{}), classical(FastDecay{}, choice),
                           Clock<double>::free(0, Direction::backward));
    const Outcome outcome = run.run_until(-10);
    CAPTURE(outcome.message);
    const bool named = outcome.kind == Outcome::Kind::diverged || outcome.kind == Outcome::Kind::step_underflow;
    CHECK(named);
    CHECK(outcome.time < 0);
    CHECK(outcome.time > -0.72);  // exp(1000 t) is a number up to 0.7098
    CHECK(std::isfinite(run.particles().variables()[0]));
  }
}

TEST_CASE("what looks the other way is refused, and what knows no way back", "[backward]") {
  const MethodChoice dop853 = method("dop853");
  auto back = planets(dop853, Direction::backward), forward = planets(dop853, Direction::forward);
  CHECK_THROWS_WITH(back.every_time(1, Energy{}),
                    "monitor 'energy' cannot sample every 1 of time; a finite time below 0 is expected");
  REQUIRE(back.run(3).ok());
  REQUIRE(forward.run(3).ok());
  CHECK_THROWS_WITH(back.restore(forward.save()), "the saved run goes forward in time, but this one goes back");
  CHECK_THROWS_WITH(forward.restore(back.save()), "the saved run goes back in time, but this one goes forward");
  forward.every_time(1, Energy{});
  REQUIRE(forward.run_until(1000).ok());
  CHECK_THROWS_WITH(forward.run_until(50),
                    "time 50 has passed: the run is already at 1000, and monitor 'energy' samples every 1 of time, so "
                    "the run cannot turn back; attach it by steps");
  CHECK_THROWS(make_method<double>(*dop853.info, {.first = -0.1}));
}

TEST_CASE("a first step is as long back in time as forward", "[backward]") {
  for (const Direction direction : {Direction::forward, Direction::backward}) {
    auto run = planets(method("dop853", {.rtol = 1e-6, .atol = 1e-6, .first = 0.5}), direction);
    REQUIRE(run.run(1).ok());
    CHECK(run.time() == (direction == Direction::forward ? 0.5 : -0.5));
  }
}
