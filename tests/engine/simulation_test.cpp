/// A run: where it is cut, how it ends, what may be changed in between.

#include "engine/simulation.hpp"

#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <thread>

namespace noether {
namespace {

constexpr double G = test::outer_G;
using Times = std::vector<std::pair<std::int64_t, double>>;

auto verlet() { return compose(test::kinetic_potential(Gravity{.G = G}), schemes::verlet); }

auto wisdom_holman(const Scheme& scheme, CompositionOptions options = {}) {
  return compose(test::wisdom_holman({.G = G}), scheme, options);
}

Simulation<double> planets(double dt = 40) { return Simulation(test::outer_planets(), verlet(), dt); }

/// Keeps steps and times at which it has looked.
struct Looks {
  Times* seen;
  static constexpr auto describe() { return part<Looks>("diary", "keeps when it looked"); }
  template <class Real> void observe(const Snapshot<Real>& now) const { seen->emplace_back(now.step(), now.time()); }
};

/// Two bodies that fall towards each other on a line; steps of 1/8 lead them to one point exactly.
ParticleSystem<double> head_on() {
  ParticleSystem<double> s;
  s.add("left", 1, {-1, 0, 0}, {1, 0, 0});
  s.add("right", 1, {1, 0, 0}, {-1, 0, 0});
  return s;
}

/// No potential: forces without an energy.
struct Push {
  static ForceClaims claims() { return {.energy = false}; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) out.acceleration(i, Vec3<Real>(Real(1), Real(0), Real(0)));
  }
};

TEST_CASE("a monitor whose type is known at run time is attached as any other, by one cadence", "[simulation]") {
  ParticleSystem<double> s;
  s.add("one", 1, {1, 0, 0}, {0, 1, 0});
  const auto run_with = [&](const auto& attach) {
    Simulation<double> run(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::verlet), 0.1);
    const Energy* energy = attach(run);
    CHECK(run.run(50).ok());
    return energy->worst();
  };
  const double by_type = run_with([](Simulation<double>& run) { return &run.every(7, Energy{}); });
  const double erased = run_with([](Simulation<double>& run) {
    AnyMonitor<double>& first = run.attach(Energy{}, {.steps = 7});
    for (int k = 0; k < 20; ++k) run.attach(Momentum{}, {.interval = 0.5});
    return first.get<Energy>();
  });
  CHECK(by_type == erased);
  static_assert(std::is_nothrow_move_constructible_v<Simulation<double>>, "vectors of simulations grow");
  Simulation<double> run(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::verlet), 0.1);
  CHECK_THROWS_WITH(run.attach(Energy{}, {}),
                    "monitor 'energy' has 0 cadences; give one: steps, an interval of time, wall time, or a list of "
                    "times");
  CHECK_THROWS_WITH(run.attach(Energy{}, {.steps = 1, .wall = 2}),
                    "monitor 'energy' has 2 cadences; give one: steps, an interval of time, wall time, or a list of "
                    "times");
}

}  // namespace

TEST_CASE("a duration that is no whole number of steps is refused with the two nearest", "[simulation]") {
  const auto run = planets(40);
  CHECK(run.steps_in(4000) == 100);
  CHECK(run.steps_in(0) == 0);
  CHECK(run.steps_in(4000 * (1 + 1e-13)) == 100);
  CHECK_THROWS_WITH(
      run.steps_in(4010),
      "a duration of 4010 is 100.25 steps of 40; the nearest whole numbers are 4000 (100) and 4040 (101)");
  CHECK_THROWS_WITH(run.steps_in(10),
                    "a duration of 10 is 0.25 steps of 40; the nearest whole numbers are 0 (0) and 40 (1)");
  CHECK_THROWS_WITH(run.steps_in(-40), "a duration of -40 lies in the past; steps of 40 go in the opposite direction");
  CHECK_THROWS_WITH(run.steps_in(1e300), "a duration of 1e+300 cannot be counted in steps of 40");
  CHECK_THROWS(run.steps_in(std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("whole numbers of steps are told from others to 1e-9, also where there are many", "[simulation]") {
  const auto run = planets(0.1);
  CHECK(run.steps_in(0.1 * 3) == 3);
  CHECK(run.steps_in(1e8) == 1'000'000'000);
  CHECK_THROWS(run.steps_in(1e8 + 0.05));
  CHECK_THROWS(run.steps_in(0.1 * (3 + 1e-8)));
  CHECK(run.steps_in(0.1 * (3 + 1e-10)) == 3);
}

TEST_CASE("a run ends at the time it is given, and cannot go back", "[simulation]") {
  auto run = planets(40);
  const Outcome outcome = run.run_until(4000);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.step == 100);
  CHECK(outcome.time == 4000);
  CHECK(run.step() == 100);
  CHECK(run.run_until(4000).step == 100);
  CHECK_THROWS_WITH(run.run_until(3960), "time 3960 has passed: the run is already at 4000");
  CHECK_THROWS_WITH(run.run_until(-40), "time -40 has passed: the run is already at 4000");
  CHECK_THROWS_WITH(
      run.run_until(4030),
      "a duration of 4030 is 100.75 steps of 40; the nearest whole numbers are 4000 (100) and 4040 (101)");
  CHECK_THROWS_WITH(run.run(-1), "-1 steps cannot be made; a number of at least 0 is expected");
  CHECK(run.step() == 100);
}

TEST_CASE("with a negative step a run leads back to where it came from", "[simulation]") {
  auto there = planets(40);
  CHECK(there.run_until(4000).ok());
  Simulation back(there.particles(), verlet(), -40);
  CHECK(back.run_until(-4000).step == 100);
  CHECK_THROWS_WITH(back.run_until(40), "time 40 has passed: the run is already at -4000");
  const auto start = test::outer_planets();
  const auto& end = back.particles();
  for (Index i = 0; i < start.size(); ++i) {
    const double error = std::sqrt(norm2(start.positions()[i] - end.positions()[i]) / norm2(end.positions()[i]));
    CHECK(error < 1000 * 0x1p-53);  // reversible: nothing but rounding is left, over 200 steps
  }
}

TEST_CASE("impossible runs are refused before the first step", "[simulation]") {
  CHECK_THROWS_WITH(planets(0), "a step of 0 is not valid; a finite time other than 0 is expected");
  CHECK_THROWS_WITH(planets(std::numeric_limits<double>::infinity()),
                    "a step of inf is not valid; a finite time other than 0 is expected");
  CHECK_THROWS_WITH(Simulation(test::outer_planets(), verlet(), Clock<double>::fixed(0.05, 0)),
                    "a step of 0 is not valid; a finite time other than 0 is expected");
  CHECK_THROWS_WITH(Simulation(ParticleSystem<double>(), verlet(), 1.0),
                    "there are no particles; a run needs at least one");
  CHECK_THROWS_WITH(Simulation(test::outer_planets(), verlet()),
                    "method 'verlet' takes steps of one length; give the step after the integrator");
}

TEST_CASE("impossible cadences are refused, and leave no monitor behind", "[simulation]") {
  auto run = planets(40);
  CHECK_THROWS_WITH(run.every(0, Energy{}), "a cadence of 0 steps is impossible; at least 1 is expected");
  CHECK_THROWS_WITH(run.every_wall(0, Energy{}), "a cadence of 0 s is impossible; a finite time above 0 is expected");
  CHECK_THROWS_WITH(run.every_time(0, Energy{}),
                    "monitor 'energy' cannot sample every 0 of time; a finite time above 0 is expected");
  CHECK_THROWS_WITH(run.every_time(-40, Energy{}),
                    "monitor 'energy' cannot sample every -40 of time; a finite time above 0 is expected");
  CHECK_THROWS_WITH(run.every_time(1e-9, Energy{}), "monitor 'energy' cannot sample every 1e-09 of time; a step is 40");
  CHECK_THROWS_WITH(run.every_time(60, Energy{}),
                    "a duration of 60 is 1.5 steps of 40; the nearest whole numbers are 40 (1) and 80 (2)");
  CHECK_THROWS_WITH(run.stop_when(farther_than(1), -1), "a cadence of -1 steps is impossible; at least 1 is expected");
  int monitors = 0;
  run.for_each_monitor([&](const std::string&, AnyMonitor<double>&) { ++monitors; });
  CHECK(monitors == 0);
  CHECK(run.run(2).ok());
}

TEST_CASE("a monitor of the energy is refused where a force reports none", "[simulation]") {
  Simulation run(test::outer_planets(), compose(test::kinetic_potential(Push{}), schemes::verlet), 1.0);
  CHECK_THROWS_WITH(run.every(1, Energy{}),
                    "monitor 'energy' needs the energy, but a force of this run does not compute one");
  run.every(1, Momentum{});
  CHECK(run.run(1).ok());
}

TEST_CASE("equal monitors are numbered in the order they come", "[simulation]") {
  auto run = planets();
  run.every(1, Energy{});
  run.every(2, Momentum{});
  run.every(3, Energy{});
  run.every(4, Energy{});
  std::vector<std::string> names;
  run.for_each_monitor([&](const std::string& name, AnyMonitor<double>&) { names.push_back(name); });
  CHECK(names == std::vector<std::string>{"energy", "momentum", "energy_2", "energy_3"});
}

TEST_CASE("monitors look at step 0 and at every multiple, with exact times", "[simulation]") {
  auto run = planets(0.1);
  Times threes, sevens;
  run.every(3, Looks{&threes});
  run.every_time(0.7, Looks{&sevens});
  CHECK(run.run(5).ok());
  CHECK(run.run(5).ok());
  CHECK(threes == Times{{0, 0}, {3, 3 * 0.1}, {6, 6 * 0.1}, {9, 9 * 0.1}});
  CHECK(sevens == Times{{0, 0}, {7, 7 * 0.1}});
}

TEST_CASE("a monitor by wall time looks at whole steps only", "[simulation]") {
  auto run = planets(40);
  Times seen;
  run.every_wall(1e-9, Looks{&seen});
  CHECK(run.run(100).ok());
  REQUIRE(!seen.empty());
  for (const auto& [step, time] : seen) CHECK(time == static_cast<double>(step) * 40);
  CHECK(seen.back().first == 100);
}

TEST_CASE("mapped() and state() agree where the scheme has no corrector", "[simulation]") {
  struct Both {
    bool* same;
    void observe(const Snapshot<double>& now) const { *same = test::same_bits(now.mapped(), now.state()); }
  };
  auto run = planets();
  bool same = false;
  run.every(7, Both{&same});
  CHECK(run.run(7).ok());
  CHECK(same);
}

TEST_CASE("particles are added and taken out between steps; ids are never used again", "[simulation]") {
  auto run = planets(40);
  CHECK(run.run(10).ok());
  const ParticleSystem<double> before = run.particles();
  run.edit([](ParticleSystem<double>& s) {
    s.remove(5);
    s.add("Comet", 0, {3, 0, 0}, {0, 0.01, 0});
  });
  CHECK(run.step() == 10);
  CHECK(run.time() == 400);
  REQUIRE(run.particles().size() == 6);
  CHECK(run.particles().ids() == std::vector<std::int64_t>{0, 1, 2, 3, 4, 6});
  CHECK(run.particles().positions()[4] == before.positions()[4]);
  CHECK(run.particles().velocities()[4] == before.velocities()[4]);
  CHECK(run.run(10).time == 800);
  run.edit([](ParticleSystem<double>& s) { s.remove(5); });
  run.edit([](ParticleSystem<double>& s) { s.add("Probe", 0, {3, 0, 0}, {0, 0.01, 0}); });
  CHECK(run.particles().ids().back() == 7);
  CHECK_THROWS_WITH(run.edit([](ParticleSystem<double>& s) {
    while (s.size() > 0) s.remove(0);
  }),
                    "the edit has left no particles; a run needs at least one");
}

TEST_CASE("an edit goes on from settled, inertial state, as a new run would", "[simulation]") {
  const auto integrator = wisdom_holman(schemes::verlet, {.compensated = true});
  Simulation run(test::outer_planets(), integrator, 40.0);
  CHECK(run.run(13).ok());
  Simulation fresh(run.particles(), integrator, 40.0);
  run.edit([](ParticleSystem<double>& s) { CHECK(s.phase() == Phase{}); });
  CHECK(run.run(13).ok());
  CHECK(fresh.run(13).ok());
  for (Index i = 0; i < 6; ++i) {
    CHECK(run.particles().positions()[i] == fresh.particles().positions()[i]);
    CHECK(run.particles().velocities()[i] == fresh.particles().velocities()[i]);
  }
}

TEST_CASE("the step changes, time and step count go on", "[simulation]") {
  auto run = planets(40);
  CHECK(run.run(10).ok());
  run.change_step(30);
  CHECK(run.time() == 400);
  CHECK(run.step() == 10);
  const Outcome outcome = run.run_until(700);
  CHECK(outcome.step == 20);
  CHECK(outcome.time == 700);
  CHECK_THROWS_WITH(run.change_step(0), "a step of 0 is not valid; a finite time other than 0 is expected");
  run.every_time(300, Energy{});
  CHECK_THROWS_WITH(run.change_step(10),
                    "monitor 'energy' samples every 300 of time, which a new step would shift; attach it by steps");
}

TEST_CASE("a collision that the forces cannot bear ends the run by name", "[simulation]") {
  // An attraction too weak to be felt on the way: the two meet in one point at step 8, where the kick is 0/0.
  Simulation run(head_on(), compose(test::kinetic_potential(Gravity{.G = 0x1p-60}), schemes::verlet), 0x1p-3);
  const Outcome outcome = run.run(1000);
  CHECK(outcome.kind == Outcome::Kind::diverged);
  CHECK_FALSE(outcome.ok());
  REQUIRE(outcome.particle.has_value());
  CHECK(outcome.particle->name == "left");
  CHECK(outcome.quantity == "velocity");
  CHECK(outcome.message == "velocity of left is not finite");
  CHECK(outcome.step == 7);
  CHECK(run.step() == 7);
  CHECK(run.particles().positions()[0].allFinite());
  CHECK(run.particles().velocities()[0].allFinite());
}

TEST_CASE("where a run fails does not depend on who looks, and what is left is the last whole step", "[simulation]") {
  // Above h omega = 2 Verlet multiplies the amplitude by 6.85 a step: 1e308 is passed before step 400.
  std::string first;
  std::vector<double> state;
  for (const std::int64_t cadence : {0, 1, 7, 100}) {
    ParticleSystem<double> s;
    s.add("bob", 1, {1, 0, 0}, {0, 0, 0});
    Simulation run(std::move(s), compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::verlet), 3.0);
    if (cadence > 0) run.every(cadence, CenterOfMass{});
    const Outcome outcome = run.run(5000);
    CAPTURE(cadence);
    CHECK(outcome.kind == Outcome::Kind::diverged);
    const auto& end = run.particles();
    const std::vector<double> now = {end.positions()[0][0], end.velocities()[0][0]};
    if (first.empty()) first = to_text(outcome), state = now;
    CHECK(to_text(outcome) == first);
    CHECK(now == state);
    CHECK(std::isfinite(now[0]));
    CHECK(std::abs(now[0]) > 1e300);
    CHECK(run.evaluations().force == outcome.step);
  }
}

TEST_CASE("a state that is not finite is called so by every Hamiltonian", "[simulation]") {
  auto s = test::outer_planets();
  s.add("Twin", 1e-9, s.positions()[3], s.velocities()[3]);
  Simulation run(std::move(s),
                 compose(test::wisdom_holman({.G = G, .coordinates = Coordinates::democratic}), schemes::verlet), 40.0);
  const Outcome outcome = run.run(10);
  CHECK(outcome.kind == Outcome::Kind::diverged);
  CHECK(outcome.message.find("is not finite") != std::string::npos);
}

TEST_CASE("not finite at the start is known before the first step", "[simulation]") {
  auto s = test::outer_planets();
  s.velocities().set(2, Vec3<double>::Constant(std::numeric_limits<double>::quiet_NaN()));
  Simulation run(std::move(s), verlet(), 40.0);
  const Outcome outcome = run.run(10);
  CHECK(to_text(outcome) == "diverged at step 0: velocity of Saturn is not finite");
}

TEST_CASE("a raised flag ends the run after the current step", "[simulation]") {
  auto run = planets(40);
  std::atomic<bool> stop{true};
  run.stop_on(&stop);
  CHECK(run.run(10).kind == Outcome::Kind::interrupted);
  CHECK(run.step() == 0);
  stop = false;
  CHECK(run.run(10).kind == Outcome::Kind::completed);

  std::thread signal([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    stop = true;
  });
  const Outcome outcome = run.run(1'000'000'000'000);
  signal.join();
  CHECK(outcome.kind == Outcome::Kind::interrupted);
  CHECK(outcome.step == run.step());
  CHECK(exit_code(outcome) == 130);
}

TEST_CASE("an interrupted run goes on as if nothing had been", "[simulation]") {
  auto run = planets(40);
  std::atomic<bool> stop{false};
  run.stop_on(&stop);
  struct Raise {
    std::atomic<bool>* flag;
    void observe(const Snapshot<double>& now) const {
      if (now.step() == 33) *flag = true;
    }
  };
  run.every(1, Raise{&stop});
  const Outcome first = run.run(100);
  CHECK(first.kind == Outcome::Kind::interrupted);
  CHECK(first.step == 33);
  stop = false;
  CHECK(run.run(67).ok());
  auto whole = planets(40);
  CHECK(whole.run(100).ok());
  CHECK(test::same_bits(run.particles(), whole.particles()));
}

TEST_CASE("progress is told while the run goes on", "[simulation]") {
  auto run = planets(40);
  std::atomic<bool> stop{false};
  run.stop_on(&stop);
  std::vector<Progress> told;
  run.on_progress([&](const Progress& progress) {
    told.push_back(progress);
    if (told.size() == 2) stop = true;
  });
  const std::int64_t end = 1'000'000'000'000;
  CHECK(run.run(end).kind == Outcome::Kind::interrupted);
  REQUIRE(told.size() == 2);
  CHECK(told[0].end == end);
  CHECK(told[0].step < told[1].step);
  CHECK(told[0].time == static_cast<double>(told[0].step) * 40);
  CHECK(told[0].seconds >= 0.1);
  CHECK(run.seconds() >= told[1].seconds);
}

TEST_CASE("a new run of particles of another run begins at time 0 with its own step", "[simulation]") {
  auto first = planets(40);
  CHECK(first.run(5).ok());
  Simulation second(first.particles(), verlet(), 20.0);
  CHECK(second.step() == 0);
  CHECK(second.run(5).time == 100);
}

TEST_CASE("a saved run keeps masses that an edit has changed", "[simulation]") {
  const auto integrator = wisdom_holman(schemes::verlet_aba);
  Simulation run(test::outer_planets(), integrator, 40.0);
  CHECK(run.run(5).ok());
  run.edit([](ParticleSystem<double>& s) { s.masses()[1] *= 2; });
  CHECK(run.run(5).ok());
  const SavedRun saved = run.save();
  CHECK(run.run(5).ok());
  Simulation again(test::outer_planets(), integrator, 40.0);
  again.restore(saved);
  CHECK(again.run(5).ok());
  CHECK(test::same_bits(run.particles(), again.particles()));
}

}  // namespace noether
