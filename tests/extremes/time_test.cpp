/// No steps, steps backwards, and more steps than one can wait for.

#include "io/digest.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <limits>

namespace noether::test {

namespace {

constexpr std::int64_t billion = 1'000'000'000;

/// The time of a step, rounded once: a product of 53 and of at most 53 bits is exact in 113.
double exact_time(std::int64_t step, double dt) { return static_cast<double>(Quad(step) * Quad(dt)); }

/// Counts the moments whose time is not the exact one.
struct WrongTimes {
  double dt = 0;
  std::int64_t seen = 0, wrong = 0;
  std::string name() const { return "wrong_times"; }
  template <class Real> void observe(const Snapshot<Real>& now) {
    ++seen;
    if (now.time() != exact_time(now.step(), dt)) ++wrong;
  }
};

ParticleSystem<double> slow_body() {
  ParticleSystem<double> s;
  s.add("body", 1, {0, 0, 0}, {0x1p-20, 0, 0});
  return s;
}

/// One particle between no others: the cheapest step there is.
auto cheapest_integrator() { return compose(kinetic_potential(Gravity{.G = 1.0}), schemes::symplectic_euler_a); }

/// The same particles with all velocities turned round.
ParticleSystem<double> turned(ParticleSystem<double> s) {
  for (Index i = 0; i < s.size(); ++i) s.velocities().set(i, -Vec3<double>(s.velocities()[i]));
  return s;
}

/// Backwards in time is forwards with velocities turned round: sums and products lose only their signs.
template <class H> void check_mirrored_time(const H& hamiltonian, const Scheme& scheme) {
  CAPTURE(scheme.name);
  Simulation backward(planets(1e-3), compose(hamiltonian, scheme), -0.05);
  Simulation forward(turned(planets(1e-3)), compose(hamiltonian, scheme), 0.05);
  REQUIRE(backward.run(50).ok());
  REQUIRE(forward.run(50).ok());
  CHECK(backward.time() == -forward.time());
  CHECK(same_bits(backward.particles(), turned(forward.particles())));
}

/// Roundings, in units of the largest number, that are left after going there and back.
template <class H> double left_after_return(const H& hamiltonian, const Scheme& scheme, std::int64_t steps) {
  const auto start = planets(1e-3);
  Simulation simulation(start, compose(hamiltonian, scheme), 0.1);
  REQUIRE(simulation.run(steps).ok());
  simulation.change_step(-0.1);
  auto& times = simulation.every(1, Energy{});
  const Outcome outcome = simulation.run(steps);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.step == 2 * steps);
  CHECK(outcome.time == 0);  // to the bit: n h + n h - 2 n h
  CHECK(std::isfinite(times.worst()));
  return distance(simulation.particles(), start) / (3.8 * rounding);
}

}  // namespace

TEST_CASE("steps backwards return to the start, at time 0", "[extremes]") {
  constexpr std::int64_t steps = 200;
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4, &schemes::yoshida_8}) {
    CAPTURE(scheme->name);
    // Each flow rounds once or twice, and along the orbits with 3/2 of the time; largest is 3.8.
    const double bound = 2.0 * static_cast<double>(2 * steps * scheme->word.size()) * (1 + 1.5 * 0.1 * steps);
    CHECK(left_after_return(kinetic_potential(Gravity{.G = 1.0}), *scheme, steps) < bound);
    CHECK(left_after_return(wisdom_holman({.G = 1.0}), *scheme, steps) < bound);
  }
  CHECK(left_after_return(kinetic_potential(Gravity{.G = 1.0}), schemes::symplectic_euler_a, steps) > 1e9);
}

TEST_CASE("backwards in time is forwards with velocities turned round, bit for bit", "[extremes]") {
  for (const Scheme* scheme : schemes::all()) {
    check_mirrored_time(kinetic_potential(Gravity{.G = 1.0}), *scheme);
    check_mirrored_time(wisdom_holman({.G = 1.0}), *scheme);
    if (scheme->scheme_class == SchemeClass::rkn) continue;
    check_mirrored_time(wisdom_holman({.G = 1.0, .coordinates = Coordinates::democratic}), *scheme);
  }
}

TEST_CASE("a run of no steps looks once and changes nothing", "[extremes]") {
  for (const bool arcs : {false, true}) {
    const auto start = planets(1e-3);
    const AnyIntegrator<double> integrator =
        arcs ? AnyIntegrator<double>(compose(wisdom_holman({.G = 1.0}), schemes::aba_10_6_4))
             : AnyIntegrator<double>(compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet));
    WatchedRun run(start, integrator, 0.1);
    for (int k = 0; k < 3; ++k) {
      const Outcome outcome = run.simulation.run(0);
      check_named_end(run.simulation, outcome, 0.1);
      CHECK(outcome.kind == Outcome::Kind::completed);
      CHECK(outcome.step == 0);
    }
    CHECK(run.simulation.run_until(0).kind == Outcome::Kind::completed);
    CHECK(run.energy.report().samples == 1);
    CHECK(same_bits(run.simulation.particles(), start));
    CHECK(io::digest(run.simulation.particles()) == io::digest(start));
  }
}

TEST_CASE("times behind a billion steps are exact products, not sums", "[extremes]") {
  for (const double dt : {0.1, -0.1, 1.0 / 3, 1e-9}) {
    CAPTURE(dt);
    Simulation<double> simulation(slow_body(), AnyIntegrator<double>(cheapest_integrator()),
                                  Clock<double>::fixed(0, dt, billion));
    const auto& times = simulation.every(1, WrongTimes{.dt = dt});
    REQUIRE(simulation.run(1000).ok());
    CHECK(times.seen == 1001);
    CHECK(times.wrong == 0);
    CHECK(simulation.step() == billion + 1000);
  }
  double sum = 0;
  for (int k = 0; k < 1000; ++k) sum += 0.1;
  CHECK(sum != exact_time(1000, 0.1));  // what such a clock is better than
}

TEST_CASE("a saved run goes on from step 1e9 and from 2^53 - 1000 with exact times", "[extremes]") {
  for (const std::int64_t from : {billion, (std::int64_t{1} << 53U) - 1000}) {
    Simulation simulation(slow_body(), cheapest_integrator(), 0.1);
    auto& times = simulation.every(1, WrongTimes{.dt = 0.1});
    REQUIRE(simulation.run(10).ok());
    SavedRun saved = simulation.save();
    std::get<std::vector<std::int64_t>>(saved.particles.at("clock/counts")).at(1) = from;
    simulation.restore(saved);
    const Outcome outcome = simulation.run(1000);
    check_named_end(simulation, outcome, 0.1);
    CHECK(outcome.step == from + 1000);
    CHECK(times.seen == 11 + 1001);
    CHECK(times.wrong == 0);
  }
}

TEST_CASE("as many steps as there are can be asked for behind the first too", "[extremes]") {
  ParticleSystem<double> pair = slow_body();
  pair.add("heavy", 1e30, {0, 0, 0}, {0, 0, 0});
  Simulation simulation(std::move(pair), compose(kinetic_potential(), schemes::verlet), 1.0);
  simulation.stop_when(farther_than(0x1p-10), 1);
  REQUIRE(simulation.run(10).step == 10);
  const Outcome outcome = simulation.run(std::numeric_limits<std::int64_t>::max());
  CHECK(outcome.kind == Outcome::Kind::stopped);
  CHECK(outcome.step == 1025);
}

TEST_CASE("a billion steps are made, and their time is exact", "[extremes][nightly]") {
  Simulation simulation(slow_body(), cheapest_integrator(), 0.1);
  const Outcome outcome = simulation.run(billion);
  check_named_end(simulation, outcome, 0.1);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.step == billion);
  CHECK(outcome.time == exact_time(billion, 0.1));
  CHECK(simulation.evaluations().force == billion);
  // Each step rounds a place below 128 by 2^-47 at most.
  CHECK(std::abs(simulation.particles().positions()[0][0] - 0x1p-20 * outcome.time) < billion * 0x1p-47);
}

// A billion steps of the program are a verdict of study/suite/drift.toml.
TEST_CASE("the program makes the million steps that an end in time asks for, with an exact time", "[extremes]") {
  const SceneFolder folder(
      "units = \"reduced\"\n[particles]\nbody = [{ mass = 1 }]\n[hamiltonian]\n"
      "type = \"kinetic_potential\"\nforce = [{ type = \"gravity\" }]\n[integrator]\n"
      "method = \"verlet\"\nstep = 0.1\nuntil = 1e5\n");
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 0);
  CHECK(json_member(result.out, "step") == "1000000");
  CHECK(json_member(result.out, "time") == "1e+05");
}

TEST_CASE("the program runs no steps, forwards and backwards, with report, files and digest", "[extremes]") {
  const auto start = planets(1e-3);
  ExtremeScene scene{.bodies = {}, .step = 0.1, .steps = 0};
  for (Index i = 0; i < start.size(); ++i) scene.bodies.push_back(body_text(start, i));
  for (const bool arcs : {false, true}) {
    if (arcs) scene.hamiltonian = wisdom_holman_table;
    scene.step = arcs ? -0.1 : 0.1;
    const SceneFolder folder(scene.text());
    const ProcessResult result = run_scene(folder);
    CHECK(outcome_of(result) == "\"completed\"");
    CHECK(json_member(result.out, "step") == "0");
    CHECK(json_member(result.out, "samples") == "1");
    CHECK(json_member(result.out, "digest") == "\"" + io::digest(start) + "\"");
#if NOETHER_HDF5
    CHECK(io::info(folder / "scene.out/run.h5").frames == 1);
    CHECK(io::info(folder / "scene.out/checkpoint.h5").digest == io::digest(start));
    const ProcessResult again = noether(folder, "run scene.toml --json --resume --set integrator.steps=3");
    CHECK(json_member(again.out, "resumed_from_step") == "0");
    CHECK(json_member(again.out, "step") == "3");
#endif
  }
}

TEST_CASE("the program runs backwards to the bits of a simulation", "[extremes]") {
  const auto start = planets(1e-3);
  ExtremeScene scene{.bodies = {}, .step = -0.1, .steps = 100};
  for (Index i = 0; i < start.size(); ++i) scene.bodies.push_back(body_text(start, i));
  const ProcessResult result = run_scene(SceneFolder(scene.text()));
  Simulation simulation(start, compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet), -0.1);
  REQUIRE(simulation.run(100).ok());
  CHECK(json_member(result.out, "digest") == "\"" + io::digest(simulation.particles()) + "\"");
  CHECK(json_member(result.out, "time") == "-10");
}

}  // namespace noether::test
