/// Two bodies that fall straight into each other.

#include "integrators/classical.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/problems.hpp"

#include <numbers>

namespace noether::test {

namespace {

/// Two bodies at (-1, 0, 0) and (1, aside, 0) that approach at a speed each.
ParticleSystem<double> head_on(double mass, double speed, double aside = 0) {
  ParticleSystem<double> s;
  s.add("left", mass, {-1, 0, 0}, {speed, 0, 0});
  s.add("right", mass, {1, aside, 0}, {-speed, 0, 0});
  return s;
}

/// Two bodies of mass 1 at rest, at a distance of 2: a = 1, mu = 2 (G = 1), back after 2 pi / sqrt(2).
constexpr double fall_period = std::numbers::pi * std::numbers::sqrt2;

/// Whether the bodies are mirror images, bit for bit.
bool is_mirrored(const ParticleSystem<double>& s) {
  const Vec3<double> x = s.positions()[0], y = s.positions()[1], v = s.velocities()[0], w = s.velocities()[1];
  return x == -y && v == -w;
}

/// A softened fall through each other: worst error of the energy.
double softened_fall(const Scheme& scheme, std::int64_t steps) {
  const double dt = 12.0 / static_cast<double>(steps);
  WatchedRun run(head_on(1, 0), compose(kinetic_potential(Gravity{.G = 1.0, .softening = 0.3}), scheme), dt);
  const Outcome outcome = run.simulation.run(steps);
  check_named_end(run.simulation, outcome, dt);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(is_mirrored(run.simulation.particles()));
  return run.energy.worst();
}

MethodOptions adaptive() {
  MethodOptions options;
  options.adaptive = true;
  return options;
}

/// Straight lines at a speed of 1: a step of 0.03 is six times the distance that counts as a collision.
template <class I> Outcome meeting(double aside, const I& integrator) {
  Simulation simulation(head_on(1e-30, 1, aside), integrator, 0.03);
  simulation.stop_when(closer_than(0.01), 1);
  const Outcome outcome = simulation.run(70);
  check_named_end(simulation, outcome, 0.03);
  return outcome;
}

}  // namespace

TEST_CASE("bodies that fall head-on bounce back over arcs after the period of Kepler", "[extremes]") {
  // Neither the ends of steps nor, for verlet_aba, their middles are the collision itself, halfway.
  for (const auto& [scheme, steps] : {std::pair{&schemes::verlet, 7}, {&schemes::verlet_aba, 6}}) {
    const double dt = fall_period / steps;
    CAPTURE(scheme->name);
    WatchedRun run(head_on(1, 0), compose(wisdom_holman({.G = 1.0}), *scheme), dt, steps);
    const Outcome outcome = run.simulation.run(steps);
    check_named_end(run.simulation, outcome, dt);
    CHECK(outcome.kind == Outcome::Kind::completed);
    // Eight roundings of each arc; an arc that ends at r changes a by 4/r of them, the phase by 3 pi times that. Arcs
    // end no nearer than a phase of pi/7, or r = 0.4; at the turning point the phase counts for little, so all in all
    // less than 2 + 10 pi per arc.
    const double error = distance(run.simulation.particles(), head_on(1, 0));
    CHECK(error < 8 * rounding * 2 * steps * (2 + 10 * std::numbers::pi));
    CHECK(run.energy.worst() < 8 * rounding * 2 * steps * 10);
  }
}

TEST_CASE("an arc that ends in the collision itself has a finite end or a named one", "[extremes]") {
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::symplectic_euler_a}) {
    for (const int halves : {1, 2, 3, 4}) {
      const double dt = fall_period / (2 * halves);
      CAPTURE(scheme->name, halves);
      Simulation simulation(head_on(1, 0), compose(wisdom_holman({.G = 1.0}), *scheme), dt);
      const Outcome outcome = simulation.run(10 * halves);
      check_named_end(simulation, outcome, dt);
      CHECK((outcome.ok() || outcome.kind == Outcome::Kind::diverged || outcome.kind == Outcome::Kind::solver_failure));
    }
  }
}

TEST_CASE("point masses that fall head-on under kicks end with a name, as mirror images", "[extremes]") {
  for (const char* name : {"symplectic_euler_b", "verlet", "verlet_aba", "yoshida_8", "srkn14a"}) {
    for (const double dt : {0.1, 0.01, 0.001}) {
      CAPTURE(name, dt);
      WatchedRun run(head_on(1, 0), compose(kinetic_potential(Gravity{.G = 1.0}), *schemes::find(name)), dt);
      const Outcome outcome = run.simulation.run(5000);
      check_named_end(run.simulation, outcome, dt);
      CHECK((outcome.kind == Outcome::Kind::completed || outcome.kind == Outcome::Kind::diverged));
      CHECK(is_mirrored(run.simulation.particles()));
      CHECK(run.momentum.worst() == 0);
      CHECK(std::isfinite(run.energy.worst()));
    }
  }
}

TEST_CASE("a softened fall through each other keeps its energy with the order of the scheme", "[extremes]") {
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4}) {
    const double coarse = softened_fall(*scheme, 4000), fine = softened_fall(*scheme, 8000);
    CAPTURE(scheme->name, coarse, fine);
    CHECK(std::abs(std::log2(coarse / fine) - scheme->order.classical) < 0.25);
  }
}

TEST_CASE("bodies that stand in one place after a step end the run with a name, unless they are softened",
          "[extremes]") {
  const auto start = head_on(0x1p-100, 1);  // too light to be turned aside: 4 steps of 0.25 are exact
  for (const double softening : {0.0, 0.001}) {
    WatchedRun run(start, compose(kinetic_potential(Gravity{.G = 1.0, .softening = softening}), schemes::verlet), 0.25);
    const Outcome outcome = run.simulation.run(8);
    check_named_end(run.simulation, outcome, 0.25);
    if (softening > 0) {
      CHECK(outcome.kind == Outcome::Kind::completed);
      CHECK(Vec3<double>(run.simulation.particles().positions()[0]) == Vec3<double>(1, 0, 0));
      CHECK(run.energy.worst() < 0x1p-80);  // potential beside kinetic energy: G m / softening beside 1
    } else {
      CHECK(outcome.kind == Outcome::Kind::diverged);
      CHECK(outcome.step == 3);  // the last whole step before
      CHECK(outcome.message == "velocity of left is not finite");
      CHECK(Vec3<double>(run.simulation.particles().positions()[0]) == Vec3<double>(-0.25, 0, 0));
    }
  }
}

TEST_CASE("bodies that pass within the distance of a collision between two steps stop the run", "[extremes]") {
  for (const double aside : {1e-5, 1e-3, 0.005}) {
    CAPTURE(aside);
    for (const bool arcs : {false, true}) {
      const Outcome outcome = arcs ? meeting(aside, compose(wisdom_holman({.G = 1.0}), schemes::verlet))
                                   : meeting(aside, compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet));
      CHECK(outcome.kind == Outcome::Kind::stopped);
      CHECK(outcome.step == 34);
      CHECK(has(outcome.message, "collision of left and right"));
    }
    CHECK(meeting(0.02, compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet)).kind ==
          Outcome::Kind::completed);
  }
}

TEST_CASE("bodies that meet exactly head-on between two steps stop the run too", "[extremes]") {
  CHECK(meeting(0, compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet)).kind == Outcome::Kind::stopped);
}

TEST_CASE("the high-order methods stop at collisions that their own steps find, without a hint", "[extremes]") {
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    CAPTURE(name);
    // Two equal masses at rest, point masses: stopped within the distance, with the energy at rounding until then.
    for (const double near : {0.1, 1e-3}) {
      Simulation<double> fall(head_on(1, 0), classical_over(Gravity{.G = 1.0}, method(name, adaptive())));
      const Energy& energy = fall.every(1, Energy{});
      fall.stop_when(closer_than(near), 1);
      const Outcome outcome = fall.run_until(fall_period);
      INFO(to_text(outcome));
      CHECK(outcome.kind == Outcome::Kind::stopped);
      CHECK(has(outcome.message, "collision of left and right"));
      CHECK(is_finite(fall.particles()));
      CHECK(relative_motion(fall.particles()).x.norm() < 2 * near);
      CHECK(std::abs(outcome.time - fall_period / 2) < 0.1);
      CHECK(energy.worst() < 1e-10);
    }
    // A tracer that falls on a star, and one that passes it by.
    for (const double aside : {0.0, 0.3}) {
      ParticleSystem<double> s;
      s.add("star", 1, {0, 0, 0}, {0, 0, 0});
      s.add("tracer", 0, {1, 0, 0}, {0, aside, 0});
      Simulation<double> run(s, classical_over(Gravity{.G = 1.0}, method(name, adaptive())));
      run.stop_when(closer_than(0.01), 1);
      const Outcome outcome = run.run_until(10);
      INFO(to_text(outcome));
      CHECK(outcome.kind == (aside == 0 ? Outcome::Kind::stopped : Outcome::Kind::completed));
      CHECK(has(outcome.message, aside == 0 ? "collision of star and tracer" : ""));
    }
  }
}

TEST_CASE("point masses that fall head-on by the high-order methods end with a name", "[extremes]") {
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    CAPTURE(name);
    Simulation<double> run(head_on(1, 0), classical_over(Gravity{.G = 1.0}, method(name, adaptive())));
    const Outcome outcome = run.run_until(fall_period);
    INFO(to_text(outcome));
    CHECK(is_finite(run.particles()));
    CHECK((outcome.ok() || !outcome.message.empty()));
  }
}

TEST_CASE("a slow fall head-on is stopped by a collision wherever a step ends within its distance", "[extremes]") {
  for (const double softening : {0.0, 0.3}) {
    const double dt = 1e-3;
    Simulation simulation(head_on(1, 0),
                          compose(kinetic_potential(Gravity{.G = 1.0, .softening = softening}), schemes::verlet), dt);
    simulation.stop_when(closer_than(0.1), 1);
    const Outcome outcome = simulation.run(10000);
    check_named_end(simulation, outcome, dt);
    CHECK(outcome.kind == Outcome::Kind::stopped);
    // The speed is 2/sqrt(0.1) at most: the step that ends within 0.1 begins within 0.1 + 0.0064.
    const double r = relative_motion(simulation.particles()).x.norm();
    CHECK(r < 0.1);
    CHECK(r > 0.09);
  }
}

TEST_CASE("the program runs head-on falls to a name, stops them, and tells a singular start from a soft one",
          "[extremes]") {
  const auto fall = head_on(1, 0), exact = head_on(0x1p-100, 1);
  ExtremeScene scene{.bodies = {body_text(fall, 0), body_text(fall, 1)}, .step = 0.015625, .steps = 400};
  CHECK(run_scene(SceneFolder(scene.text())).exit_code <= 1);
  scene.rest = "[[stop]]\ntype = \"collision\"\ndistance = 0.5\n";
  CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"stopped\"");
  scene.hamiltonian = wisdom_holman_table;
  CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"stopped\"");

  ExtremeScene meet{.bodies = {body_text(exact, 0), body_text(exact, 1)}, .step = 0.25, .steps = 8};
  const ProcessResult diverged = run_scene(SceneFolder(meet.text()));
  CHECK(diverged.exit_code == 1);
  CHECK(outcome_of(diverged) == "\"diverged\"");
  CHECK(json_member(diverged.out, "step") == "3");
  CHECK(has(diverged.err, "diverged at step 3: velocity of left is not finite"));
  meet.bodies[1] = "mass = 1, x = [-1, 0, 0], v = [0, 0, 0]";
  CHECK(has(run_scene(SceneFolder(meet.text())).err, "are in the same place, where their attraction is infinite"));
  meet.hamiltonian = "type = \"kinetic_potential\"\nforce = [{ type = \"gravity\", softening = 0.1 }]\n";
  CHECK(outcome_of(run_scene(SceneFolder(meet.text()))) == "\"completed\"");
}

}  // namespace noether::test
