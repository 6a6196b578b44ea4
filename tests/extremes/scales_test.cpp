/// Distances from 1e-100 to 1e100: forces against 113 bits, orbits that must scale, and what becomes of numbers beyond.

#include "forces/oblateness.hpp"
#include "numbers/simd.hpp"
#include "tests/extremes/support.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/settings.hpp"

namespace noether::test {

namespace {

/// Largest error of an acceleration, relative to its length, against the same force over `Quad`.
template <class F> double worst_force_error(const F& force, const ParticleSystem<double>& s) {
  const auto wide = s.as<Quad>();
  VectorColumn<double> a(s.size());
  VectorColumn<Quad> exact(s.size());
  ForceSink<double> sink(a, s, {});
  ForceSink<Quad> wide_sink(exact, wide, {});
  force.add_to(sink, s);
  force.add_to(wide_sink, wide);
  double worst = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> found = std::as_const(a)[i];
    const Vec3<Quad> expected = std::as_const(exact)[i];
    const Quad length = sqrt(norm2(expected));
    if (length == Quad(0)) continue;
    const double error = static_cast<double>(sqrt(norm2(Vec3<Quad>(found.cast<Quad>() - expected))) / length);
    worst = std::isfinite(error) ? std::max(worst, error) : std::numeric_limits<double>::infinity();
  }
  return worst;
}

/// A body of a mass in the origin and another at distance r, in no special direction.
ParticleSystem<double> pair_at(double r, double mass = 1) {
  ParticleSystem<double> s;
  s.add("origin", mass, Vec3<double>::Zero(), Vec3<double>::Zero());
  s.add("other", mass, r * Vec3<double>(0.48, -0.6, 0.64), Vec3<double>::Zero());
  return s;
}

/// One body in the origin, and a tracer at each of the distances: enough of them for lanes.
ParticleSystem<double> shells(int first, int last) {
  ParticleSystem<double> s;
  s.add("origin", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  for (int k = first; k <= last; ++k) {
    s.add("shell", 0, std::pow(10.0, k) * Vec3<double>(0.48, -0.6, 0.64), Vec3<double>::Zero());
  }
  return s;
}

/// The ellipse of `kepler_pair(0.3)` with lengths times 4^k: speeds times 2^-k, times times 8^k, all exact.
ParticleSystem<double> scaled_pair(int k) {
  const auto s = kepler_pair(0.3);
  ParticleSystem<double> scaled;
  for (Index i = 0; i < 2; ++i) {
    scaled.add(s.name(i), s.masses()[i], std::ldexp(1, 2 * k) * Vec3<double>(s.positions()[i]),
               std::ldexp(1, -k) * Vec3<double>(s.velocities()[i]));
  }
  return scaled;
}

/// A run of 100 steps of the scaled ellipse, brought back to the scale of 1.
template <class I> ParticleSystem<double> unscaled_end(int k, const I& integrator) {
  const double dt = std::ldexp(0.0625, 3 * k);
  WatchedRun run(scaled_pair(k), integrator, dt);
  const Outcome outcome = run.simulation.run(100);
  check_named_end(run.simulation, outcome, dt);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(run.energy.worst() < 1e-2);  // 2e-4 by the method, for any k
  CHECK(std::isfinite(run.angular.worst()));
  ParticleSystem<double> end = run.simulation.particles();
  for (Index i = 0; i < 2; ++i) {
    end.positions().set(i, std::ldexp(1, -2 * k) * Vec3<double>(std::as_const(end).positions()[i]));
    end.velocities().set(i, std::ldexp(1, k) * Vec3<double>(std::as_const(end).velocities()[i]));
  }
  return end;
}

/// One body that is so fast that its energy is above the range of doubles.
ParticleSystem<double> fast_body() {
  ParticleSystem<double> s;
  s.add("fast", 1, Vec3<double>::Zero(), {1e200, 0, 0});
  return s;
}

const Oblateness flat_unit{.J2 = 0.01, .J4 = -1e-3, .radius = 1, .axis = {0.1, 0.2, 1}, .G = 1.0};

/// The worst error of the oblateness at 1.5 to 150 radii, for radii 10^first to 10^last.
double worst_oblateness(int first, int last, double J4) {
  double worst = 0;
  for (int k = first; k <= last; ++k) {
    Oblateness force = flat_unit;
    force.radius = std::pow(10.0, k);
    force.J4 = J4;
    for (const double far : {1.5, 15.0, 150.0}) {
      worst = std::max(worst, worst_force_error(force, pair_at(far * force.radius)));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("gravity of a pair is right to rounding from 1e-100 to 1e100, softened or not", "[extremes]") {
  // Differences, squares, root, quotient and products: seven operations and a half, sums of the three components.
  constexpr double bound = 10 * rounding;
  for (int k = -100; k <= 100; ++k) {
    const double r = std::pow(10.0, k);
    CAPTURE(k);
    CHECK(worst_force_error(Gravity{.G = 1.0}, pair_at(r)) < bound);
    for (const double softening : {1e-3 * r, r}) {
      CHECK(worst_force_error(Gravity{.G = 1.0, .softening = softening}, pair_at(r)) < bound);
    }
    if (k < 98) CHECK(worst_force_error(Gravity{.G = 1.0, .softening = 1e3 * r}, pair_at(r)) < bound);
  }
}

TEST_CASE("gravity in lanes is right to rounding from 1e-100 to 1e100 at every SIMD level", "[extremes]") {
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    const AtLevel at(level);
    CAPTURE(name(level));
    CHECK(worst_force_error(Gravity{.G = 1.0}, shells(-100, 100)) < 3e-15);  // what tests/forces holds lanes to
    CHECK(worst_force_error(Gravity{.G = 1.0, .softening = 1e-50}, shells(-50, 100)) < 3e-15);
  }
}

TEST_CASE("gravity is right to rounding at 1e100 with the constant of a unit system too", "[extremes]") {
  // G = 6.7e-11 over r^3 = 1e300 is below the normal numbers, before a mass makes up for it.
  CHECK(worst_force_error(Gravity{.G = 6.6743e-11}, pair_at(1e100, 2e30)) < 10 * rounding);
}

TEST_CASE("the oblateness of a body is right to rounding for radii from 1e-40 to 1e40", "[extremes]") {
  // Polynomials of degree 4 in c, whose terms are up to ten times their sum, in some twenty operations.
  CHECK(worst_oblateness(-40, 40, flat_unit.J4) < 200 * rounding);
}

TEST_CASE("the oblateness of a body is right to rounding for radii from 1e-98 to 1e98", "[extremes]") {
  CHECK(worst_oblateness(-98, 98, 0) < 200 * rounding);
  CHECK(worst_oblateness(-98, 98, flat_unit.J4) < 200 * rounding);
}

TEST_CASE("an ellipse under kicks has the same bits at every scale from 4^-165 to 4^165", "[extremes]") {
  for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4}) {
    const auto integrator = compose(kinetic_potential(Gravity{.G = 1.0}), *scheme);
    const auto unit = unscaled_end(0, integrator);
    for (const int k : {-165, -100, -30, -1, 1, 30, 100, 165}) {
      CAPTURE(scheme->name, k);
      CHECK(same_bits(unscaled_end(k, integrator), unit));
    }
  }
}

TEST_CASE("an ellipse of arcs is the same to rounding at every scale from 4^-165 to 4^165", "[extremes]") {
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic}) {
    const auto integrator = compose(wisdom_holman({.G = 1.0, .coordinates = coordinates}), schemes::verlet);
    const auto unit = unscaled_end(0, integrator);
    for (const int k : {-165, -100, -30, -1, 1, 30, 100, 165}) {
      CAPTURE(k);
      // 300 flows that round by 8, at speeds up to 1.4 over a time of 6: see `rounding_of_ellipse`.
      CHECK(distance(unscaled_end(k, integrator), unit) < 300 * 8 * rounding * (1 + 3 * 6.25 * 1.4));
    }
  }
}

TEST_CASE("distances beyond the range of doubles end with a name and a finite state", "[extremes]") {
  for (const double r : {1e-300, 1e-200, 1e-120, 1e120, 1e200, 1e300}) {
    for (const double dt : {1.0, 1e-150, 1e150}) {
      for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba}) {
        CAPTURE(r, dt, scheme->name);
        Simulation kicks(pair_at(r), compose(kinetic_potential(Gravity{.G = 1.0}), *scheme), dt);
        check_named_end(kicks, kicks.run(20), dt);
        Simulation arcs(pair_at(r), compose(wisdom_holman({.G = 1.0}), *scheme), dt);
        check_named_end(arcs, arcs.run(20), dt);
      }
    }
  }
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba}) {
    Simulation flat(pair_at(1e-100), compose(kinetic_potential(flat_unit), *scheme), 1.0);
    const Outcome outcome = flat.run(20);
    check_named_end(flat, outcome, 1.0);
    CHECK(outcome.kind == Outcome::Kind::diverged);
  }
}

TEST_CASE("an energy beyond the range of doubles is told", "[extremes]") {
  Simulation simulation(fast_body(), compose(kinetic_potential(Gravity{.G = 1.0}), schemes::verlet), 1.0);
  const auto& energy = simulation.every(1, Energy{});
  const Outcome outcome = simulation.run(3);
  CHECK((!outcome.ok() || explains_itself(energy.report())));
}

TEST_CASE("the program tells an energy beyond the range of doubles", "[extremes]") {
  ExtremeScene scene{.bodies = {body_text(fast_body(), 0)}, .steps = 3};
  const SceneFolder folder(scene.text());
  const ProcessResult result = noether(folder, "run scene.toml --json");
  REQUIRE(is_json_line(result.out));
  CHECK((result.exit_code == 1 || !lacks_figures(result.out) || has(result.out, "\"reason\":")));
}

TEST_CASE("the program runs pairs from 1e-100 to 1e100 apart, and names what has diverged", "[extremes]") {
  for (const int k : {-165, 165}) {
    const auto pair = scaled_pair(k);
    ExtremeScene scene{
        .bodies = {body_text(pair, 0), body_text(pair, 1)}, .step = std::ldexp(0.0625, 3 * k), .steps = 20};
    CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"completed\"");
    scene.hamiltonian = wisdom_holman_table;
    CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"completed\"");
  }
  const auto close = pair_at(1e-200);
  const ExtremeScene scene{.bodies = {body_text(close, 0), body_text(close, 1)}, .steps = 20};
  const ProcessResult diverged = run_scene(SceneFolder(scene.text()));
  CHECK(outcome_of(diverged) == "\"diverged\"");
  CHECK(json_member(diverged.out, "step") == "0");
}

TEST_CASE("a body nearer to its star than the normal numbers reach does not hang the program", "[extremes][slow]") {
  const SceneFolder folder(
      "units = \"reduced\"\n[particles]\nbody = [{ mass = 1 }, { mass = 0, x = [1e-320, 0, 0], "
      "v = [0, 1, 0] }]\n[hamiltonian]\ntype = \"wisdom_holman\"\n[integrator]\n"
      "method = \"verlet_aba\"\nstep = 1\nsteps = 2\n");
  std::vector<std::string> line{"timeout", "-s", "KILL", "5"};
  for (const std::string& word : command("run scene.toml --fresh --json")) line.push_back(word);
  CHECK(run_process(line, folder.path()).exit_code <= 1);
}

}  // namespace noether::test
