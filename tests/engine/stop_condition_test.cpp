/// Escapes and collisions: found between two looks, told with the time the interpolated motion gives.

#include "engine/stop_condition.hpp"

#include "engine/orbital_elements.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/files.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/planets.hpp"

#include <numbers>

namespace noether {
namespace {

/// A body and a tracer that pass each other on straight lines: nearest, at distance 1, when t = 10.
ParticleSystem<double> passing() {
  ParticleSystem<double> s;
  s.add("rock", 1e-30, {0, 0, 0}, {0, 0, 0});
  s.add("probe", 0, {-30, 1, 0}, {3, 0, 0});
  return s;
}

auto free_motion() { return compose(test::kinetic_potential(Gravity{.G = 1e-30}), schemes::verlet); }

/// Time on the ellipse below since its pericentre, at eccentric anomaly E.
Quad time_at(const Quad& E) { return E - sin(E) / Quad(2); }

/// Two bodies on an ellipse of semi-major axis 1, eccentricity 1/2 and period 2 pi about their centre of mass, at
/// eccentric anomaly E.
ParticleSystem<Quad> ellipse(const Quad& E) {
  const Quad e = 0.5, root = sqrt(Quad(1) - e * e), speed = Quad(1) / (Quad(1) - e * cos(E));
  const Vec3<Quad> x(cos(E) - e, root * sin(E), Quad(0)), v(-speed * sin(E), speed * root * cos(E), Quad(0));
  const Quad heavy = 0.75, light = 0.25;
  ParticleSystem<Quad> s;
  s.add("heavy", heavy, -light * x, -light * v);
  s.add("light", light, heavy * x, heavy * v);
  return s;
}

/// When the rule held, looked at every `interval` from eccentric anomaly E on, by the interpolated motion.
/// Wisdom-Holman makes no error with two bodies: nothing but the interpolation is seen.
double time_found(const StopRule& rule, double interval, const Quad& E) {
  struct Look {
    StopCheck<Quad>* check;
    std::optional<double>* found;
    void observe(const Snapshot<Quad>& now) const {
      const auto reason = check->look(now);
      if (reason && !*found) *found = reason->time;
    }
  };
  Simulation<Quad> run(ellipse(E), compose(test::wisdom_holman<Quad>({.G = 1.0}), schemes::verlet_aba), interval);
  StopCheck<Quad> check(rule);
  std::optional<double> found;
  run.every(1, Look{&check, &found});
  for (int n = 0; n < 1000 && !found; ++n) CHECK(run.run(1).ok());
  return found.value() + static_cast<double>(time_at(E));
}

/// Order at which the time found converges, in the worst of eight phases: the event falls anywhere between two looks.
double measured_order(const StopRule& rule, double truth) {
  std::vector<test::ErrorPoint> points;
  for (const int looks : {32, 48, 64, 96, 128}) {
    const double interval = 2 * std::numbers::pi / looks;
    double worst = 0;
    for (int k = 0; k < 8; ++k) {
      const Quad E = Quad(1) + Quad(k) * Quad(interval) / Quad(8);
      worst = std::max(worst, std::abs(time_found(rule, interval, E) - truth));
    }
    points.push_back({interval, worst});
  }
  CAPTURE(test::to_text(points));
  CHECK(points.back().error > 1e-13);
  CHECK(points.back().error < 1e-6);
  return test::fitted_slope(points);
}

}  // namespace

TEST_CASE("a distance that cannot stop a run is refused", "[stop]") {
  CHECK_THROWS_WITH(StopCheck<double>(farther_than(0)),
                    "a distance of 0 cannot stop a run; a finite distance above 0 is expected");
  CHECK_THROWS_WITH(StopCheck<double>(closer_than(-1)),
                    "a distance of -1 cannot stop a run; a finite distance above 0 is expected");
  CHECK_THROWS(StopCheck<double>(closer_than(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("a passage that is over at the next look is found, with its distance and time", "[stop]") {
  for (const std::int64_t steps : {1, 3, 40}) {
    Simulation run(passing(), free_motion(), 0.5);
    run.stop_when(closer_than(1.5), steps);
    const Outcome outcome = run.run(1000);
    CAPTURE(steps);
    CHECK(outcome.kind == Outcome::Kind::stopped);
    CHECK(outcome.ok());
    REQUIRE(outcome.particle.has_value());
    CHECK(outcome.particle->name == "probe");
    CHECK(outcome.particle->index == 1);
    if (steps == 40) {
      CHECK(outcome.step == 40);  // the look at t = 20; the state stays at the last whole step
      CHECK(outcome.message == "collision of rock and probe, distance 1 below 1.5 since time 9.627322");
      CHECK(run.particles().positions()[1][0] == 30);
    }
  }
}

TEST_CASE("a passage outside the distance does not stop", "[stop]") {
  Simulation run(passing(), free_motion(), 0.5);
  run.stop_when(closer_than(0.999), 7);
  CHECK(run.run(1000).kind == Outcome::Kind::completed);
}

TEST_CASE("two tracers do not collide", "[stop]") {
  auto s = passing();
  s.masses()[0] = 0;
  Simulation run(std::move(s), free_motion(), 0.5);
  run.stop_when(closer_than(1.5), 1);
  CHECK(run.run(100).kind == Outcome::Kind::completed);
}

TEST_CASE("bodies too near at the start stop the run there", "[stop]") {
  Simulation run(passing(), free_motion(), 0.5);
  run.stop_when(closer_than(31), 10);
  const Outcome outcome = run.run(100);
  CHECK(to_text(outcome) == "stopped at step 0: collision of rock and probe, distance 30.0167 below 31 since time 0");
}

TEST_CASE("an escape is told with the time of the crossing", "[stop]") {
  Simulation run(passing(), free_motion(), 0.5);
  run.stop_when(farther_than(50), 8);
  const Outcome outcome = run.run(1000);
  // |x| = 50 at t = 10 + sqrt(50^2 - 1)/3; looks every 4.
  CHECK(to_text(outcome) == "stopped at step 56: escape of probe, distance 54.0093 above 50 since time 26.663333");
  CHECK(outcome.time == 28);
  CHECK(std::abs(test::number_after(outcome.message, "since time ") - (10 + std::sqrt(2499.0) / 3)) < 1e-7);
}

TEST_CASE("the last step is looked at whatever the cadence, and a run that goes on does not notice", "[stop]") {
  Simulation run(passing(), free_motion(), 0.5), whole(passing(), free_motion(), 0.5);
  run.stop_when(farther_than(50), 1000);
  const Outcome last = run.run(60);
  CHECK(last.kind == Outcome::Kind::stopped);
  CHECK(last.step == 60);
  CHECK(last.message.find("escape of probe") == 0);

  Simulation cut(passing(), free_motion(), 0.5);
  for (Simulation<double>* one : {&cut, &whole}) one->stop_when(closer_than(1.5), 8);
  CHECK(cut.run(10).kind == Outcome::Kind::completed);
  CHECK(cut.run(30).message == whole.run(40).message);
}

TEST_CASE("a collision in the last part of a run with steps of its own is found", "[stop]") {
  // On the ellipse of a = 1, e = 1/2 from its apocenter to the pericenter at pi; 0.6 is passed at cos E = 4/5.
  ParticleSystem<double> s;
  s.add("S", 1, {0, 0, 0}, {0, 0, 0});
  s.add("t", 0, {1.5, 0, 0}, {0, std::sqrt(1.0 / 3), 0});
  const double since = std::numbers::pi - (std::acos(0.8) - 0.3);
  for (const double rtol : {1e-6, 1e-9, 1e-12}) {
    for (const double end : {2.998091544796509, 2.8}) {
      CAPTURE(rtol, end);
      Simulation<double> run(s,
                             test::classical_over(Gravity{}, {methods::find("dop853"), {.rtol = rtol, .atol = rtol}}));
      run.stop_when(closer_than(0.6), 1);
      CHECK(run.run_until(2.7).kind == Outcome::Kind::completed);
      const Outcome outcome = run.run_until(end);
      CHECK(outcome.kind == Outcome::Kind::stopped);
      CHECK(outcome.unresolved == 0);
      CHECK(std::abs(test::number_after(outcome.message, "since time ") - since) < 100 * rtol + 1e-8);
    }
  }
}

TEST_CASE("a passage that steps jump over is found along the orbit of the pair, for steps of any length", "[stop]") {
  // Past the Sun at 0.003 au, on an orbit of 10 au: below 0.00465 au from some hours before the pericenter on.
  const double mu = 2.9591220828559e-4, a = 10, e = 0.9997, M = -std::numbers::pi / 3, limit = 0.00465;
  const double E = std::acos((1 - limit / a) / e), motion = std::sqrt(mu / (a * a * a));
  const double since = (-(E - e * std::sin(E)) - M) / motion;
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Sun", 1, {0, 0, 0}, {0, 0, 0});
  const auto [x, v] = state_from_elements<double>({a, e, 1.4, 0.3, 0.2, 2 * std::numbers::pi + M}, mu);
  s.add("grazer", 0, x, v);
  for (const double step : {100.0, 30.0, 7.0, 1.0, 0.5, 0.1}) {
    CAPTURE(step);
    Simulation<double> run(s, compose(test::wisdom_holman<double>({.G = mu}), schemes::verlet), step);
    run.stop_when(closer_than(limit), 1);
    const Outcome outcome = run.run(static_cast<std::int64_t>(6000 / step));
    REQUIRE(outcome.kind == Outcome::Kind::stopped);
    CHECK(outcome.unresolved == 0);
    CHECK(std::abs(test::number_after(outcome.message, "since time ") - since) < 1e-4);
    CHECK(std::abs(test::number_after(outcome.message, "distance ") / (a * (1 - e)) - 1) < 1e-4);
  }
  // The pericenter is outside of a smaller distance, and time may run back.
  Simulation<double> past(s, compose(test::wisdom_holman<double>({.G = mu}), schemes::verlet), 30.0);
  past.stop_when(closer_than(0.0029), 1);
  const Outcome whole = past.run(200);
  CHECK(whole.kind == Outcome::Kind::completed);
  CHECK(whole.unresolved == 0);
  Simulation<double> back(past.particles(), compose(test::wisdom_holman<double>({.G = mu}), schemes::verlet), -30.0);
  back.stop_when(closer_than(limit), 1);
  CHECK(back.run(200).kind == Outcome::Kind::stopped);
}

TEST_CASE("what no orbit of a pair explains is counted", "[stop]") {
  ParticleSystem<double> s;
  s.add("rock", 1, {0, 0, 0}, {0, 0, 0});
  s.add("ball", 1, {1, 0.01, 0}, {0, 0, 0});  // swings through the middle, on a spring
  Simulation<double> run(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::yoshida_8), 0.01);
  run.stop_when(closer_than(0.02), 230);
  const Outcome outcome = run.run(460);
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(outcome.unresolved >= 1);
  // The count goes on over a restart.
  Simulation<double> first(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::yoshida_8), 0.01);
  Simulation<double> second(s, compose(test::kinetic_potential(HarmonicField{.k = 1}), schemes::yoshida_8), 0.01);
  for (auto* one : {&first, &second}) one->stop_when(closer_than(0.02), 230);
  CHECK(first.run(300).ok());
  second.restore(first.save());
  CHECK(second.run(160).unresolved == outcome.unresolved);
}

TEST_CASE("a stopped run may go on", "[stop]") {
  Simulation run(passing(), free_motion(), 0.5);
  run.stop_when(closer_than(1.5), 1);
  CHECK(run.run(1000).kind == Outcome::Kind::stopped);
  Outcome outcome = run.run(1000);
  while (outcome.kind == Outcome::Kind::stopped) outcome = run.run(1000 - run.step());
  CHECK(outcome.kind == Outcome::Kind::completed);
  CHECK(run.step() > 21);
}

TEST_CASE("looking for events does not change the trajectory", "[stop]") {
  const auto final_state = [](std::int64_t cadence) {
    Simulation run(test::outer_planets(), compose(test::wisdom_holman({.G = test::outer_G}), schemes::verlet), 50.0);
    if (cadence > 0) {
      run.stop_when(farther_than(1000), cadence);
      run.stop_when(closer_than(1e-6), cadence + 1);
    }
    CHECK(run.run(100).ok());
    return run.particles();
  };
  const auto bare = final_state(0);
  CHECK(test::same_bits(bare, final_state(1)));
  CHECK(test::same_bits(bare, final_state(7)));
}

TEST_CASE("particles changed by hand do not make an event between the looks", "[stop]") {
  // The edit carries the probe past the rock: no motion did.
  Simulation run(passing(), free_motion(), 0.5);
  run.stop_when(closer_than(1.5), 4);
  CHECK(run.run(4).ok());
  run.edit([](ParticleSystem<double>& s) { s.positions().set(1, {30, 1, 0}); });
  CHECK(run.run(100).kind == Outcome::Kind::completed);
}

TEST_CASE("events are found alike after a restart", "[stop]") {
  const auto make = [] {
    Simulation run(passing(), free_motion(), 0.5);
    run.stop_when(closer_than(1.5), 16);
    return run;
  };
  auto whole = make();
  const std::string expected = to_text(whole.run(100));
  auto first = make();
  CHECK(first.run(18).kind == Outcome::Kind::completed);
  const SavedRun saved = first.save();
  auto second = make();
  second.restore(saved);
  CHECK(to_text(second.run(82)) == expected);
  CHECK(expected.find("distance 1 below") != std::string::npos);
}

TEST_CASE("the time of an escape converges at order 6 with the interval between looks", "[stop]") {
  // The light body is at 3 r/4 from the centre of mass: beyond 0.9 where 1 - cos(E)/2 > 1.2.
  const double order = measured_order(farther_than(0.9), static_cast<double>(time_at(acos(Quad(-0.4)))));
  CHECK(std::abs(order - 6) < 0.4);
}

TEST_CASE("the time of a collision converges at order 6 with the interval between looks", "[stop]") {
  const double order =
      measured_order(closer_than(0.7), -static_cast<double>(time_at(acos(Quad(0.6)))) + 2 * std::numbers::pi);
  CHECK(std::abs(order - 6) < 0.4);
}

TEST_CASE("of two collisions between two looks the first is told", "[stop]") {
  auto s = passing();
  s.add("early", 0, {-20, 1, 0}, {4, 0, 0});  // nearest when t = 5, within 1.5 since t = 5 - sqrt(1.25)/4
  Simulation run(std::move(s), free_motion(), 0.5);
  run.stop_when(closer_than(1.5), 40);
  CHECK(run.run(100).message == "collision of rock and early, distance 1 below 1.5 since time 4.7204915");
}

}  // namespace noether
