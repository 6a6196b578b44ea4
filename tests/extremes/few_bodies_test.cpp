/// As few bodies as there can be, and masses as unequal as can be.

#include "tests/extremes/support.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

namespace noether::test {

namespace {

constexpr double lone_dt = 0.25;
constexpr std::int64_t lone_steps = 64;

/// All numbers, and all products of them with a power of two, are exact.
ParticleSystem<double> lone_body(double mass) {
  ParticleSystem<double> s;
  s.add("alone", mass, {1, 2, 3}, {0.5, -0.25, 0.125});
  return s;
}

/// Checks that every particle has kept the bits of its velocity, and is where this leads.
///
/// Positions stay below 16 even within a step, so each of the flows rounds by 2^-50 at most, and its length by as much.
void check_straight_motion(const ParticleSystem<double>& start, const ParticleSystem<double>& end, double time,
                           double flows) {
  for (Index i = 0; i < start.size(); ++i) {
    const Vec3<double> x = start.positions()[i], v = start.velocities()[i];
    CHECK(Vec3<double>(end.velocities()[i]) == v);
    const Vec3<double> gone = end.positions()[i] - (x + time * v);
    CHECK(gone.cwiseAbs().maxCoeff() <= flows * 0x1p-49);
  }
}

template <class H> void check_lone_body(const H& hamiltonian, const Scheme& scheme, double mass) {
  CAPTURE(scheme.name, mass);
  WatchedRun run(lone_body(mass), compose(hamiltonian, scheme), lone_dt);
  const Outcome outcome = run.simulation.run(lone_steps);
  check_named_end(run.simulation, outcome, lone_dt);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.step == lone_steps);
  check_straight_motion(lone_body(mass), run.simulation.particles(), lone_dt * lone_steps,
                        static_cast<double>(scheme.word.size()) * lone_steps);
  CHECK(run.energy.worst() == 0);
  CHECK(run.momentum.worst() == 0);
}

/// Tracers at places of their own, or all in one.
ParticleSystem<double> tracers_alone(int n, bool apart) {
  ParticleSystem<double> s;
  for (int k = 0; k < n; ++k) {
    const double at = apart ? 0.125 * k : 0;
    s.add("tracer " + std::to_string(k), 0, {at, 1, -at}, {0.25, -0.125, 0.5});
  }
  return s;
}

/// Two bodies of masses 1/(1 + ratio), ratio/(1 + ratio) at rest as a whole, with G = 1: whatever the ratio, the
/// relative motion is one ellipse, a = 1.266, about a mass of 1.
ParticleSystem<double> unequal_pair(double ratio) {
  const double first = 1 / (1 + ratio), second = ratio / (1 + ratio);
  const Vec3<double> x(1, 0, 0), v(0, 1.1, 0);
  ParticleSystem<double> s;
  s.add("first", first, -second * x, -second * v);
  s.add("second", second, first * x, first * v);
  return s;
}

const std::vector<double> mass_ratios = {1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1, 10, 1e3, 1e6, 1e9, 1e12, 1e15};

/// Eight roundings per flow, all to one side, of what a time T makes of them: an error d of velocity or position turns
/// into one of (1 + 3 T) d, since the mean motion changes by 3/2 of the relative change of a, that by 2 a v d, and a v
/// stays below 2.
double rounding_of_ellipse(double flows, double time) { return 8 * rounding * flows * (1 + 3 * time); }

}  // namespace

TEST_CASE("one body alone goes straight on under every scheme and both Hamiltonians, whatever its mass", "[extremes]") {
  for (const Scheme* scheme : schemes::all()) {
    for (const double mass : {0x1p-1000, 1.0, 0x1p1000}) {
      check_lone_body(kinetic_potential(Gravity{}), *scheme, mass);
      check_lone_body(wisdom_holman({}), *scheme, mass);
      if (scheme->scheme_class == SchemeClass::rkn) continue;
      check_lone_body(wisdom_holman({.coordinates = Coordinates::democratic}), *scheme, mass);
    }
  }
}

TEST_CASE("tracers alone go straight on, also all in one place", "[extremes]") {
  for (const int n : {1, 3, 16, 70}) {
    for (const bool apart : {true, false}) {
      for (const Scheme* scheme : {&schemes::verlet, &schemes::symplectic_euler_a, &schemes::yoshida_8}) {
        CAPTURE(n, apart, scheme->name);
        const auto start = tracers_alone(n, apart);
        WatchedRun run(start, compose(kinetic_potential(Gravity{}), *scheme), lone_dt);
        run.simulation.stop_when(closer_than(1), 1);  // tracers do not collide with tracers
        run.simulation.stop_when(farther_than(1e6), 1);
        const Outcome outcome = run.simulation.run(lone_steps);
        check_named_end(run.simulation, outcome, lone_dt);
        CHECK(outcome.kind == Outcome::Kind::completed);
        check_straight_motion(start, run.simulation.particles(), lone_dt * lone_steps,
                              static_cast<double>(scheme->word.size()) * lone_steps);
        CHECK(run.energy.total() == 0);
        CHECK(run.energy.worst() == 0);
        CHECK(run.angular.worst() == 0);
      }
    }
  }
}

TEST_CASE("tracers alone are refused where something must lie in the middle", "[extremes]") {
  const auto tracers = tracers_alone(3, true);
  CHECK_THROWS_WITH(
      Simulation(tracers, compose(wisdom_holman({}), schemes::verlet), 1.0),
      Catch::Contains("'tracer 0' comes first, so it is the primary of wisdom_holman, but its mass is 0"));
  auto moved = tracers;
  CHECK_THROWS_WITH(move_to_barycenter(moved), Catch::Contains("every particle is a tracer of mass 0"));
}

TEST_CASE("the centre of mass of tracers alone is no number without a reason", "[extremes]") {
  Simulation simulation(tracers_alone(3, true), compose(kinetic_potential(Gravity{}), schemes::verlet), lone_dt);
  const auto& center = simulation.every(1, CenterOfMass{});
  REQUIRE(simulation.run(3).ok());
  CHECK(explains_itself(center.report()));
}

TEST_CASE("masses in any ratio from 1e-15 to 1e15 move alike about each other under kicks", "[extremes]") {
  constexpr double dt = 0.05;
  constexpr std::int64_t steps = 200;
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4, &schemes::srkn14a}) {
    const double flows = static_cast<double>(scheme->word.size()) * steps;
    const auto hamiltonian = kinetic_potential(Gravity{.G = 1.0});
    const auto even = relative_motion(run(hamiltonian, *scheme, unequal_pair(1), dt, steps));
    for (const double ratio : mass_ratios) {
      CAPTURE(scheme->name, ratio);
      WatchedRun watched(unequal_pair(ratio), compose(hamiltonian, *scheme), dt);
      const Outcome outcome = watched.simulation.run(steps);
      check_named_end(watched.simulation, outcome, dt);
      CHECK(outcome.kind == Outcome::Kind::completed);
      CHECK(distance(relative_motion(watched.simulation.particles()), even) < rounding_of_ellipse(flows, dt * steps));
      CHECK(watched.momentum.worst() < 8 * rounding * flows);
      CHECK(watched.angular.worst() < 8 * rounding * flows);
    }
  }
}

TEST_CASE("masses in any ratio from 1e-15 to 1e15 follow Kepler to rounding over arcs, the lighter first too",
          "[extremes]") {
  constexpr double dt = 0.3;  // a fifth of the way from pericenter to apocenter and less
  constexpr std::int64_t steps = 100;
  for (const Scheme* scheme : {&schemes::verlet, &schemes::symplectic_euler_b, &schemes::aba_10_6_4}) {
    const double flows = static_cast<double>(scheme->word.size()) * steps;
    for (const double ratio : mass_ratios) {
      CAPTURE(scheme->name, ratio);
      const auto start = unequal_pair(ratio);
      WatchedRun watched(start, compose(wisdom_holman({.G = 1.0}), *scheme), dt);
      const Outcome outcome = watched.simulation.run(steps);
      check_named_end(watched.simulation, outcome, dt);
      CHECK(outcome.kind == Outcome::Kind::completed);
      const auto exact = kepler_motion(start.as<Quad>(), Quad(watched.simulation.time()));
      const auto motion = relative_motion(watched.simulation.particles().as<Quad>());
      CHECK(distance(motion, exact) < rounding_of_ellipse(flows, dt * steps));
      // Behind a lighter primary the velocity of a heavy body is a small difference of relative velocities up to 1.1.
      CHECK(watched.momentum.worst() * watched.momentum.scale().value() < 8 * rounding * flows * 1.1);
    }
  }
}

TEST_CASE("masses in any ratio end with a name in democratic coordinates", "[extremes]") {
  for (const double ratio : mass_ratios) {
    for (const Scheme* scheme : {&schemes::verlet, &schemes::aba_10_6_4}) {
      CAPTURE(ratio, scheme->name);
      WatchedRun watched(unequal_pair(ratio),
                         compose(wisdom_holman({.G = 1.0, .coordinates = Coordinates::democratic}), *scheme), 0.05);
      const Outcome outcome = watched.simulation.run(200);
      check_named_end(watched.simulation, outcome, 0.05);
      CHECK(std::isfinite(watched.energy.worst()));
    }
  }
}

TEST_CASE("the program runs one body, tracers alone and masses of any ratio, or says why not", "[extremes]") {
  const auto tracers = tracers_alone(2, true);
  const auto small = unequal_pair(1e-15), large = unequal_pair(1e15);
  for (const bool arcs : {false, true}) {
    ExtremeScene scene{.bodies = {"mass = 1, x = [1, 2, 3], v = [0.5, 0, 0]"}, .step = 0.25, .steps = 8};
    if (arcs) scene.hamiltonian = wisdom_holman_table;
    const ProcessResult one = run_scene(SceneFolder(scene.text()));
    CHECK(outcome_of(one) == "\"completed\"");
    CHECK(json_member(one.out, "worst") == "0");
    for (const auto* pair : {&small, &large}) {
      scene.bodies = {body_text(*pair, 0), body_text(*pair, 1)};
      CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"completed\"");
    }
    scene.bodies = {body_text(tracers, 0), body_text(tracers, 1)};
    const ProcessResult none = run_scene(SceneFolder(scene.text()));
    CHECK(none.exit_code == (arcs ? 2 : 0));
    if (arcs) CHECK(has(none.err, "scene.toml:8: 'tracer 0' comes first, so it is the primary of wisdom_holman"));
  }
}

}  // namespace noether::test
