/// What classical methods claim, measured for every one of them: none can be added without.

#include "engine/orbital_elements.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "forces/sum.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"

#include <cmath>

using namespace noether;

namespace {

/// A method as it can be run: with steps of one length, or of its own choice.
struct Way {
  const MethodInfo* info;
  MethodOptions options;
  bool adaptive;
};

std::vector<Way> every_way() {
  std::vector<Way> ways;
  for (const MethodInfo* info : methods::all()) {
    const auto add = [&](MethodOptions options, bool adaptive) {
      ways.push_back({info, options, adaptive});
      if (!info->takes(*linear_solver)) return;
      options.jacobian = JacobianForm::matrix_free;
      ways.push_back({info, options, adaptive});
    };
    MethodOptions options;
    if (info->fixed && info->adaptive) options.adaptive = false;
    if (info->fixed) add(options, false);
    if (!info->adaptive) continue;
    options = {};
    if (info->rtol > 1e-15) options.rtol = options.atol = 1e-8;
    add(options, true);
  }
  return ways;
}

/// A Kepler orbit of e = 0.3 in Quad after some steps of a fixed length, by a method bound for them.
Vector<Quad> steps_on_ellipse(Method<Quad>& method, VectorField<Quad>& f, Vector<Quad> y, double h, int steps) {
  method.bind(f);
  Quad t(0);
  for (int n = 0; n < steps; ++n) {
    const StepResult made = method.step(f, t, y, h);
    REQUIRE(!made.failure);
    t += Quad(h);
  }
  return y;
}

/// Steps long enough to show what a method of this order loses.
double long_step(const MethodInfo& info) { return info.order >= 10 ? 0.5 : 0x1p-5; }

double angular_momentum_change(const MethodChoice& choice) {
  const auto method = make_method<Quad>(*choice.info, choice.options);
  auto f = test::kepler<Quad>();
  const Vector<Quad> start = test::kepler_start<Quad>(Quad(0.25));
  const Vector<Quad> end = steps_on_ellipse(*method, f, start, long_step(*choice.info), 8);
  const auto l = [](const Vector<Quad>& y) { return y[0] * y[3] - y[1] * y[2]; };
  return std::abs(static_cast<double>(l(end) / l(start) - Quad(1)));
}

/// How far a step back ends from where a step forth began.
double way_back(const MethodChoice& choice) {
  auto f = test::kepler<Quad>();
  const Vector<Quad> start = test::kepler_start<Quad>(Quad(0.25));
  const auto forth = make_method<Quad>(*choice.info, choice.options),
             back = make_method<Quad>(*choice.info, choice.options);
  const Vector<Quad> there = steps_on_ellipse(*forth, f, start, long_step(*choice.info), 1);
  return test::distance(steps_on_ellipse(*back, f, there, -long_step(*choice.info), 1), start);
}

/// |det M - 1| of one step on a pendulum, q'' = -sin q, by central differences of width 1e-11 in 113 bits.
double area_change(const MethodChoice& choice) {
  auto f = test::pendulum<Quad>();
  const Quad d = Quad(1e-11);
  Matrix<Quad> m(2, 2);
  for (Index k = 0; k < 2; ++k) {
    Vector<Quad> ends[2];
    for (int side = 0; side < 2; ++side) {
      Vector<Quad> y(2);
      y << Quad(0.75), Quad(0.5);
      y[k] += side == 0 ? -d : d;
      const auto method = make_method<Quad>(*choice.info, choice.options);
      ends[side] = steps_on_ellipse(*method, f, y, choice.info->order >= 10 ? 2 : 0.25, 1);
    }
    for (Index i = 0; i < 2; ++i) m(i, k) = (ends[1][i] - ends[0][i]) / (Quad(2) * d);
  }
  return std::abs(static_cast<double>(m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0) - Quad(1)));
}

Simulation<double> planets(const Way& way) {
  auto integrator = test::classical_over(Gravity{.G = test::outer_G}, method(way.info->name, way.options));
  return way.adaptive ? Simulation(test::outer_planets(), integrator)
                      : Simulation(test::outer_planets(), integrator, 20.0);
}

}  // namespace

TEST_CASE("methods keep angular momentum, areas and the way back if they claim so, and only then", "[claims]") {
  for (const Way& way : every_way()) {
    if (way.adaptive || way.info->make_quad == nullptr) continue;
    // In Quad its second derivatives have to be exact, which this motion's are not: energy_exact_test.cpp.
    if (way.info->name == "avf_4") continue;
    const MethodChoice choice{way.info, way.options};
    const MethodClaims claims = make_method<Quad>(*way.info, way.options)->claims();
    CAPTURE(way.info->name);
    CHECK(claims.name == way.info->name);
    CHECK((angular_momentum_change(choice) < 1e-28) == claims.keeps_angular_momentum);
    // Methods with a past take their first step by another method.
    if (way.info->family == "multistep") continue;
    CHECK((way_back(choice) < 1e-28) == claims.reversible);
    CHECK((area_change(choice) < 1e-18) == claims.symplectic);
  }
}

TEST_CASE("every method goes on bit for bit after a restart, whatever looked on", "[restart]") {
  for (const Way& way : every_way()) {
    CAPTURE(way.info->name, way.adaptive);
    auto whole = planets(way), first = planets(way), second = planets(way);
    first.every(3, Energy{});
    second.every(3, Energy{});
    if (way.adaptive) {
      first.every_time(33.0, Momentum{});
      second.every_time(33.0, Momentum{});
    }
    REQUIRE(whole.run(50).ok());
    REQUIRE(first.run(23).ok());
    second.restore(first.save());
    REQUIRE(second.run(27).ok());
    CHECK(test::same_bits(whole.particles(), second.particles()));
    CHECK(whole.evaluations().force == second.evaluations().force);
    CHECK(whole.evaluations().jacobian == second.evaluations().jacobian);
  }
}

/// Where the second body of a pair is, at whatever moments are asked for.
struct Diary {
  std::vector<std::pair<double, Vec3<double>>>* seen;
  void observe(const Snapshot<double>& now) const {
    seen->emplace_back(now.time(), test::relative_motion(now.state()).x);
  }
};

TEST_CASE("every method that chooses its steps tells states between them, and when a distance is passed",
          "[dense output]") {
  const double e = 0.3, distance = 1.1;  // of the pair; the lighter body is 3/4 of it from the centre of mass
  const ParticleSystem<double> start = test::kepler_pair(e);
  const double anomaly = std::acos((1 - distance) / e);  // r = 1 - e cos E
  const double passed = anomaly - e * std::sin(anomaly);
  for (const Way& way : every_way()) {
    if (!way.adaptive) continue;
    std::vector<std::pair<double, Vec3<double>>> seen;
    Simulation run(start, test::classical_over(Gravity{}, method(way.info->name, way.options)));
    run.every_time(0.0625, Diary{&seen});
    REQUIRE(run.run_until(6).ok());
    REQUIRE(seen.size() == 97);
    const auto off = [&](double time, const Vec3<double>& x) {
      return std::sqrt(norm2(Vec3<double>(x - test::kepler_motion(start, time).x)));
    };
    double worst = 0;
    for (const auto& [time, x] : seen) worst = std::max(worst, off(time, x));
    const bool reference = way.info->rtol < 1e-15;
    CAPTURE(way.info->name, worst);
    CHECK(worst < (reference ? 1e-13 : 2e-5));

    Simulation watched(start, test::classical_over(Gravity{}, method(way.info->name, way.options)));
    watched.stop_when(farther_than(0.75 * distance), 1);
    const Outcome outcome = watched.run_until(6);
    CAPTURE(outcome.message, passed);
    REQUIRE(outcome.kind == Outcome::Kind::stopped);
    const std::string words = " since time ";
    const auto at = outcome.message.rfind(words);
    REQUIRE(at != std::string::npos);
    // Between two steps the motion is a quintic polynomial, however long they are.
    CHECK(std::abs(std::stod(outcome.message.substr(at + words.size())) - passed) < 1e-4);
  }
}

TEST_CASE("no step is longer than max_step, and an encounter is not jumped over", "[max_step]") {
  // Past a mass of 1e-3 at b = 0.05 with speed 1: deflected by 2 atan(m / (b v^2)).
  ParticleSystem<double> s;
  s.add("M", 1e-3, {0, 0, 0}, {0, 0, 0});
  s.add("t", 0, {-100, 0.05, 0}, {1, 0, 0});
  const double energy = 0.5 - 1e-3 / std::sqrt(1e4 + 0.0025), a = 1e-3 / (2 * energy), momentum = 0.05;
  const double e = std::sqrt(1 + 2 * energy * momentum * momentum / 1e-6);
  for (const Way& way : every_way()) {
    if (!way.adaptive || way.info->rtol < 1e-15) continue;
    MethodOptions options = way.options;
    options.max_step = 0.05;
    CAPTURE(way.info->name);
    std::vector<std::pair<double, Vec3<double>>> seen;
    Simulation<double> run(s, test::classical_over(Gravity{}, {way.info, options}));
    run.every(1, Diary{&seen});
    REQUIRE(run.run_until(200).ok());
    double longest = 0, before = 0;
    for (const auto& [time, x] : seen) longest = std::max(longest, time - std::exchange(before, time));
    CHECK(longest <= 0.05 * (1 + 1e-9));
    // Far out the speed along y is that of the hyperbola: the angle that the asymptotes leave, less what is to come.
    const OrbitalElements<double> o =
        elements_from_state<double>(run.particles().positions()[1], run.particles().velocities()[1], 1e-3);
    CHECK(std::abs(o.a + a) < 1e-5 * a);
    CHECK(std::abs(o.e - e) < 1e-5 * e);
    CHECK(std::abs(run.particles().velocities()[1][1] + 0.0399) < 2e-4);
  }
  CHECK_THROWS_WITH(test::classical_over(Gravity{}, method("dop853", {.max_step = 0})),
                    "max_step = 0 is not a valid longest step; a time above 0 is expected");
  CHECK_THROWS_WITH(test::classical_over(Gravity{}, method("rk4", {.max_step = 1})),
                    "method 'rk4' takes steps of one length here, so max_step has no effect; take it out");
}

TEST_CASE("a fall into a point of mass ends by the references: it is passed, or steps become too short for time",
          "[extremes]") {
  // q = 2.5e-9 from a mass of 1e-3 at x = 1, with the half of the period of a = 0.01; the mass stands where doubles are
  // 2e-16 apart.
  ParticleSystem<double> s;
  s.add("p", 1e-3, {1, 0, 0}, {0, 0, 0});
  s.add("t", 0, {1.019999999, 0, 0}, {0, 7.071067986781228e-05, 0});
  for (const char* name : {"gauss_8", "gauss_radau_15"}) {
    CAPTURE(name);
    Simulation<double> run(s, test::classical_over(Gravity{}, method(name)));
    const Outcome outcome = run.run_until(0.19869176531592206);
    CHECK((outcome.kind == Outcome::Kind::completed || outcome.kind == Outcome::Kind::step_underflow));
    if (outcome.kind != Outcome::Kind::completed) CHECK(std::abs(outcome.time - 0.0993459) < 1e-5);
    CHECK(run.step() < 100'000);
  }
}

TEST_CASE("a saved run goes on by the same method with the same tolerances only", "[restart]") {
  const Way way{methods::find("dop853"), {.rtol = 1e-8}, true}, other{methods::find("dop853"), {.rtol = 1e-9}, true};
  auto run = planets(way), wrong = planets(other);
  REQUIRE(run.run(3).ok());
  CHECK_THROWS_WITH(wrong.restore(run.save()),
                    "the saved run was made with dop853(adaptive = true, rtol = 1e-08, atol = default, first = "
                    "default), but this one has "
                    "dop853(adaptive = true, rtol = 1e-09, atol = default, first = default)");
}

TEST_CASE("a saved run goes on under the same forces only, however small their difference", "[restart]") {
  const auto dragged = [](double rate) {
    return Simulation(test::outer_planets(),
                      test::classical_over(test::field_of(Gravity{.G = test::outer_G}, DragForce{{.rate = rate}}),
                                           method("dop853", {.adaptive = false})),
                      20.0);
  };
  auto run = dragged(1e-9), same = dragged(1e-9), other = dragged(2e-9);
  REQUIRE(run.run(3).ok());
  CHECK_NOTHROW(same.restore(run.save()));
  CHECK_THROWS(other.restore(run.save()));
}
