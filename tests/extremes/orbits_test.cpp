/// Orbits as thin as needles, and bodies that come once and never again.

#include "tests/extremes/support.hpp"
#include "tests/support/problems.hpp"

#include <array>

namespace noether::test {

namespace {

constexpr double thin = 0.999999;
constexpr double pi = 3.14159265358979323846;

/// The relative orbit of `kepler_pair` as that of a tracer about a star of mass 1.
ParticleSystem<double> tracer_on_ellipse(double eccentricity, double anomaly) {
  const auto motion = relative_motion(kepler_pair(eccentricity, anomaly));
  ParticleSystem<double> s;
  s.add("star", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  s.add("tracer", 0, motion.x, motion.v);
  return s;
}

/// What the arcs of one period can lose on an ellipse with a = 1, mu = 1, if none ends nearer than `nearest`.
///
/// An arc between the apocenter, at a distance of 2, and one of r rounds x by a part of 2 and v^2 < 2/r by a part of
/// it: 1/a changes by 2 (2/r^2 + 2/r) of them, at most 8/r^2. The phase gains 3 pi times that, which counts as fast as
/// the body moves where it is seen, in the apocenter: with v = sqrt((1 - e)/(1 + e)).
double lost_on_ellipse(double eccentricity, double arcs, double nearest) {
  const double apocenter_speed = std::sqrt((1 - eccentricity) / (1 + eccentricity));
  return rounding * arcs * 8 / (nearest * nearest) * (1 + 3 * pi * apocenter_speed);
}

template <class H> void check_one_period(const H& hamiltonian, const ParticleSystem<double>& start) {
  constexpr std::int64_t steps = 101;  // odd: halfway there is the pericenter
  constexpr double dt = 2 * pi / steps;
  // Whole steps end no nearer to the pericenter than by a phase of pi/101; stages may end in it, once a period.
  constexpr double nearest = 0.16;
  for (const Scheme* scheme : {&schemes::symplectic_euler_a, &schemes::verlet, &schemes::verlet_aba,
                               &schemes::aba_10_6_4, &schemes::abah_8_4_4}) {
    CAPTURE(scheme->name);
    WatchedRun run(start, compose(hamiltonian, *scheme), dt, steps);
    const Outcome outcome = run.simulation.run(steps);
    check_named_end(run.simulation, outcome, dt);
    CHECK(outcome.kind == Outcome::Kind::completed);
    const auto exact = kepler_motion(start.as<Quad>(), Quad(run.simulation.time()));
    const double error = distance(relative_motion(run.simulation.particles().as<Quad>()), exact);
    const double arcs = static_cast<double>(scheme->word.size()) * steps;
    const bool in_pericenter = scheme->evaluations() > 1 || scheme == &schemes::verlet_aba;
    CHECK(error < lost_on_ellipse(thin, arcs, nearest) + (in_pericenter ? lost_on_ellipse(thin, 2, 1 - thin) : 0));
  }
}

/// Error of the relative position after four of its own times past the pericenter of a thin ellipse, in its distance.
double passage_error(const Scheme& scheme, std::int64_t steps) {
  const double q = 1 - thin, duration = 4 * std::sqrt(q * q * q / (1 + thin));
  const auto start = kepler_pair(thin), wide = run(kinetic_potential(Gravity{.G = 1.0}), scheme, start,
                                                   duration / static_cast<double>(steps), steps);
  const double time = static_cast<double>(steps) * (duration / static_cast<double>(steps));
  const Vec3<Quad> x = kepler_motion(start.as<Quad>(), Quad(time)).x;
  return std::sqrt(static_cast<double>(norm2(Vec3<Quad>(relative_motion(wide.as<Quad>()).x - x)))) / q;
}

/// Sees how large sum m |v| and sum m |x| |v| become: rounding errors of the momenta are relative to them.
struct LargestScale {
  double momentum = 0, angular = 0;
  std::string name() const { return "largest_scale"; }
  template <class Real> void observe(const Snapshot<Real>& now) {
    double linear = 0, about = 0;
    const ParticleSystem<double>& s = now.state();
    for (Index i = 0; i < s.size(); ++i) {
      linear += s.masses()[i] * s.velocities()[i].norm();
      about += s.masses()[i] * s.velocities()[i].norm() * s.positions()[i].norm();
    }
    momentum = std::max(momentum, linear);
    angular = std::max(angular, about);
  }
};

/// A star of mass 1 and a body of mass 0 on a hyperbola with a = -1, at the anomaly -H; it is at +H after 2 (e sinh H -
/// H).
struct FlyBy {
  double e, H;

  double impact() const { return std::sqrt((e - 1) * (e + 1)); }
  double distance() const { return e * std::cosh(H) - 1; }
  double duration() const { return 2 * (e * std::sinh(H) - H); }
  PhasePoint<double> motion(double sign) const {
    const double r = distance(), b = impact();
    return {{e - std::cosh(H), sign * b * std::sinh(H), 0}, {sign * std::sinh(H) / -r, b * std::cosh(H) / r, 0}};
  }
  ParticleSystem<double> start() const {
    ParticleSystem<double> s;
    s.add("star", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
    s.add("visitor", 0, motion(-1).x, motion(-1).v);
    return s;
  }
};

/// Largest error of position (relative to the distance) and velocity after the passage, and of the deflection.
std::pair<double, double> fly_by_errors(const FlyBy& orbit, const ParticleSystem<double>& end) {
  const auto found = relative_motion(end), expected = orbit.motion(1), before = orbit.motion(-1);
  const double position = (found.x - expected.x).norm() / orbit.distance(), velocity = (found.v - expected.v).norm();
  const double angle = std::atan2(cross(before.v, found.v)[2], dot(before.v, found.v));
  // The velocities at both ends are mirror images: tan of half the angle is tanh H / sqrt(e^2 - 1); to the left.
  const double deflection = 2 * std::atan2(std::sinh(orbit.H), orbit.impact() * std::cosh(orbit.H));
  return {std::max(position, velocity), std::abs(std::remainder(angle - deflection, 2 * pi))};
}

}  // namespace

TEST_CASE("an ellipse of eccentricity 0.999999 closes to rounding over arcs, in both coordinates", "[extremes]") {
  check_one_period(wisdom_holman({.G = 1.0}), kepler_pair(thin, pi));
  check_one_period(wisdom_holman({.G = 1.0}), tracer_on_ellipse(thin, pi));
  check_one_period(wisdom_holman({.G = 1.0, .coordinates = Coordinates::democratic}), tracer_on_ellipse(thin, pi));
}

TEST_CASE("kicks pass the pericenter of an ellipse of eccentricity 0.999999 with their order, where steps are short",
          "[extremes]") {
  for (const Scheme* scheme :
       {&schemes::symplectic_euler_a, &schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4}) {
    const double coarse = passage_error(*scheme, 512), fine = passage_error(*scheme, 1024);
    CAPTURE(scheme->name, coarse, fine);
    CHECK(std::abs(std::log2(coarse / fine) - scheme->order.classical) < 0.25);
  }
}

TEST_CASE("kicks too coarse for an ellipse of eccentricity 0.999999 end with a name and tell their error",
          "[extremes]") {
  constexpr double dt = 2 * pi / 100;
  for (const char* name : {"symplectic_euler_a", "verlet", "verlet_aba", "yoshida_8", "srkn14a"}) {
    for (const double anomaly : {0.0, pi}) {
      CAPTURE(name, anomaly);
      const Scheme& scheme = *schemes::find(name);
      WatchedRun run(kepler_pair(thin, anomaly), compose(kinetic_potential(Gravity{.G = 1.0}), scheme), dt);
      const auto& scale = run.simulation.every(1, LargestScale{});
      const Outcome outcome = run.simulation.run(500);
      check_named_end(run.simulation, outcome, dt);
      CHECK(std::isfinite(run.energy.worst()));
      CHECK(run.energy.worst() > 0.1);       // nothing is left of the orbit, and the report says so
      if (scheme.word.size() > 3) continue;  // stages within a step may be farther out than its ends
      // Eight roundings of each of three flows, of what is twice as large in the middle of a step.
      const double bound = 500 * 3 * 8 * rounding * 2;
      CHECK(run.momentum.worst() * run.momentum.scale().value() < bound * scale.momentum);
      CHECK(run.angular.worst() * run.angular.scale().value() < bound * scale.angular);
    }
  }
}

TEST_CASE("a hyperbolic fly-by deflects by its closed form over arcs, in one step or seven", "[extremes]") {
  for (const double e : {1.000001, 1.5, 1000.0}) {
    for (const double H : {1.0, 3.0, 20.0}) {
      for (const std::int64_t steps : {1, 7}) {
        const FlyBy orbit{e, H};
        const double dt = orbit.duration() / static_cast<double>(steps);
        CAPTURE(e, H, steps);
        WatchedRun run(orbit.start(), compose(wisdom_holman({.G = 1.0}), schemes::verlet), dt, steps);
        const Outcome outcome = run.simulation.run(steps);
        check_named_end(run.simulation, outcome, dt);
        CHECK(outcome.kind == Outcome::Kind::completed);
        const auto [motion, angle] = fly_by_errors(orbit, run.simulation.particles());
        // The way of a body that comes from afar is rounded by a part of its distance, which is what it misses the
        // star by: less sideways than b, it turns by up to 2/(1 + b^2) of that more, and goes as far astray behind. A
        // speed rounded at v changes a by 2 v^2 of its rounding, and the time to and from the star by as much.
        const double b2 = 1 + orbit.impact() * orbit.impact(), v2 = 1 + 2 / orbit.distance();
        const double bound = 8 * rounding * static_cast<double>(steps) * (2 + orbit.distance() * 2 / b2) * (1 + 2 * v2);
        CHECK(motion < bound);
        CHECK(angle < bound);
      }
    }
  }
}

TEST_CASE("a hyperbolic fly-by under kicks has the order of its scheme", "[extremes]") {
  const FlyBy orbit{1.5, 3.0};
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_4}) {
    std::array<double, 2> error{};
    for (const std::int64_t steps : {1500, 3000}) {
      const auto end = run(kinetic_potential(Gravity{.G = 1.0}), *scheme, orbit.start(),
                           orbit.duration() / static_cast<double>(steps), steps);
      error[steps == 3000 ? 1 : 0] = fly_by_errors(orbit, end).first;
    }
    CAPTURE(scheme->name, error[0], error[1]);
    CHECK(std::abs(std::log2(error[0] / error[1]) - scheme->order.classical) < 0.25);
  }
}

TEST_CASE("the program runs needles of ellipses and fly-bys, and stops where a visitor escapes", "[extremes]") {
  const auto pair = kepler_pair(thin, pi);
  ExtremeScene scene{.bodies = {body_text(pair, 0), body_text(pair, 1)}, .step = 0.0625, .steps = 200};
  CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"completed\"");
  scene.bodies = {"mass = 1", "mass = 0, a = 1, e = 0.999999, M = 3"};
  scene.hamiltonian = wisdom_holman_table;
  CHECK(outcome_of(run_scene(SceneFolder(scene.text()))) == "\"completed\"");

  const auto visit = FlyBy{1.5, 3.0}.start();
  scene.bodies = {body_text(visit, 0), body_text(visit, 1)};
  scene.rest = "[[stop]]\ntype = \"escape\"\ndistance = 20\nsteps = 1\n";
  scene.steps = 1000;
  const ProcessResult gone = run_scene(SceneFolder(scene.text()));
  CHECK(gone.exit_code == 0);
  CHECK(outcome_of(gone) == "\"stopped\"");
  CHECK(has(json_member(gone.out, "message"), "escape of visitor, distance 20."));
}

}  // namespace noether::test
