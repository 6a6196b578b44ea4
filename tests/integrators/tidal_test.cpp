/// Tides with a constant lag, against closed forms of what they do to spins and orbits.

#include "integrators/tidal.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace noether::tides {
namespace {

const double pi = std::acos(-1.0);

struct TidalBody {
  double love, radius, lag;
};

void give_tides(ParticleSystem<double>& s, Index i, const TidalBody& body) {
  if (!s.has<LoveNumber>()) {
    s.add_column<LoveNumber>();
    s.add_column<BodyRadius>();
    s.add_column<TideLag>();
  }
  s.column<LoveNumber>()[i] = body.love;
  s.column<BodyRadius>()[i] = body.radius;
  s.column<TideLag>()[i] = body.lag;
}

/// A point of mass 1 and a spherical body of mass `mass` about it, at pericentre of an orbit of a = 1.
ParticleSystem<double> moon(double mass, double moment, double e, const Vec3<double>& spin, const TidalBody& tides) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("planet", 1, {0, 0, 0}, {0, 0, 0});
  const double speed = std::sqrt((1 + mass) * (1 + e) / (1 - e));
  add_body(s, body_of_inertia("moon", mass, Vec3<double>::Constant(moment)),
           {.x = {1 - e, 0, 0}, .v = {0, speed, 0}, .spin = spin});
  give_tides(s, 1, tides);
  return s;
}

using AnyH = AnyHamiltonian<double>;

AnyH on_arcs(const Tides& tides = {}) {
  return AnyH(with_letter(tides, AnyH(Rotating<AnyH>(AnyH(WisdomHolman<double>({}))))));
}
AnyH on_kicks(const Tides& tides = {}) {
  ForceField<double> forces;
  forces.add(GravityOfBodies{});
  return AnyH(with_letter(tides, AnyH(test::turning(forces))));
}

/// The semi-major axis of particle 1 about particle 0, of points.
double axis_of(const ParticleSystem<double>& s) {
  const Vec3<double> d = s.positions()[1] - s.positions()[0], v = s.velocities()[1] - s.velocities()[0];
  const double mu = s.masses()[0] + s.masses()[1];
  return 1 / (2 / d.norm() - v.squaredNorm() / mu);
}

/// Two bodies with tides, tilted spins and an eccentric orbit.
ParticleSystem<double> two_tidal_bodies(double lag) {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("one", 1, {0.02, 0.025, 0.03}), {.spin = Vec3<double>(0.02, -0.01, 0.05)});
  add_body(s, body_of_inertia("two", 0.4, {0.002, 0.002, 0.003}),
           {.x = {1, 0.2, -0.1},
            .v = {0.1, 1.1, 0.3},
            .orientation = {1, 0.5, 0.2, 0},
            .spin = Vec3<double>(0.001, 0.002, -0.003)});
  give_tides(s, 0, {0.4, 0.3, lag});
  give_tides(s, 1, {0.3, 0.15, 2 * lag});
  return s;
}

}  // namespace

TEST_CASE("tides bring a spin to the rate of its circular orbit, as the exponential says", "[integrators][tides]") {
  // Omega - n = (Omega_0 - n) exp(-t/T), 1/T = 3 G k2 m^2 R^5 lag/(a^6 C).
  const double moment = 1e-12, rate = 0.02, n = std::sqrt(2.0);
  const TidalBody tides{0.3, 0.01, rate * moment / (3 * 0.3 * std::pow(0.01, 5))};
  const auto error = [&](const AnyH& h, double step) {
    Simulation sim(moon(1, moment, 0, moment * Vec3<double>(0, 0, 5 * n), tides), compose(h, schemes::verlet), step);
    REQUIRE(sim.run_until(60).ok());
    const double left = (sim.particles().column<BodySpin>()[1][2] / moment - n) / (4 * n);
    return std::abs(left - std::exp(-rate * 60));
  };
  CHECK(error(on_arcs(), 0.02) < 2e-8);
  const double by_kicks = error(on_kicks(), 0.01);
  CHECK(by_kicks < 2e-4);
  CHECK(std::abs(std::log2(error(on_kicks(), 0.02) / by_kicks) - 2) < 0.1);
}

TEST_CASE("tides on a body that hardly turns shrink its orbit as the eighth power says", "[integrators][tides]") {
  // d(a^8)/dt = -48 G k2 m_0^2 R^5 lag/mu, mu the reduced mass, m_0 that of who raises the tides.
  const double mass = 0.5, reduced = mass / (1 + mass), radius = 0.01, love = 0.9, lag = 2000;
  const double falls = 48 * love * std::pow(radius, 5) * lag / reduced, until = 800;
  const auto error = [&](AnyH h, double step) {
    Simulation sim(moon(mass, 1e9, 0, Vec3<double>::Zero(), {love, radius, lag}),
                   compose(std::move(h), schemes::verlet), step);
    const double before = axis_of(sim.particles());
    REQUIRE(sim.run_until(until).ok());
    return std::abs(std::pow(axis_of(sim.particles()), 8) - std::pow(before, 8) + falls * until);
  };
  CHECK(falls * until > 0.01);
  CHECK(error(on_arcs(), 0.02) < 1e-3 * falls * until);
  CHECK(error(on_kicks(), 0.02) < 2e-3 * falls * until);
}

TEST_CASE("on an eccentric orbit tides bring a spin to the rate that Hut found", "[integrators][tides]") {
  const double e = 0.3, e2 = e * e, n = std::sqrt(2.0), moment = 1e-15;
  const double wanted = n * (1 + 7.5 * e2 + 45. / 8 * e2 * e2 + 5. / 16 * e2 * e2 * e2) /
                        ((1 + 3 * e2 + 3. / 8 * e2 * e2) * std::pow(1 - e2, 1.5));
  const double rate = 0.002;
  const TidalBody tides{0.3, 0.01, rate * moment / (3 * 0.3 * std::pow(0.01, 5))};
  Simulation sim(moon(1, moment, e, moment * Vec3<double>(0, 0, wanted), tides), compose(on_arcs(), schemes::verlet),
                 0.02);
  double sum = 0;
  const Outcome outcome = sim.run(200 * std::llround(2 * pi / n / 0.02));
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  const std::int64_t steps = std::llround(2 * pi / n / 0.02);
  for (std::int64_t k = 0; k < steps; ++k) {
    REQUIRE(sim.run(1).ok());
    sum += sim.particles().column<BodySpin>()[1][2] / moment;
  }
  CHECK(std::abs(sum / static_cast<double>(steps) / wanted - 1) < 1e-4);
  CHECK(wanted > 1.3);
}

TEST_CASE("tides keep momentum and angular momentum, and lose energy only where they lag", "[integrators][tides]") {
  for (const double lag : {0.0, 0.01}) {
    std::vector<double> changes;
    for (const double step : {0.02, 0.01}) {
      Simulation sim(two_tidal_bodies(lag), compose(on_kicks(), schemes::verlet), step);
      auto& momentum = sim.every(1, Momentum{});
      auto& angular = sim.every(1, AngularMomentum{});
      auto& energy = sim.every(1, Energy{});
      REQUIRE(sim.run(1).ok());
      const double start = energy.total();
      double worst = 0;
      for (std::int64_t k = std::llround(10 / step); k > 0; --k) {
        REQUIRE(sim.run(1).ok());
        worst = std::max(worst, std::abs(energy.total() - start));
      }
      CHECK(momentum.worst() < 1e-14);
      CHECK(angular.worst() < 1e-14);
      changes.push_back(worst);
      if (lag > 0) CHECK(energy.total() < start - 0.9 * worst);
    }
    if (lag == 0) CHECK(std::abs(std::log2(changes[0] / changes[1]) - 2) < 0.1);
  }
}

TEST_CASE("what lags takes power from motion and turns, and nothing else", "[integrators][tides]") {
  const auto power = [](double lag) {
    const ParticleSystem<double> s = two_tidal_bodies(lag);
    VectorColumn<double> a(2), torque(2);
    ForceSink<double> sink(a, s, {});
    sink.set_torques(torque);
    Tides{}.add_to(sink, s);
    double sum = 0;
    for (Index i = 0; i < 2; ++i) {
      const Mat3<double> axes = test::matrix_of(s, i);
      const Vec3<double> in_body = test::in_body_of(s, i), moments = s.column<BodyInertia>()[i];
      const Vec3<double> rate = to_space<double>(axes, in_body.cwiseQuotient(moments));
      sum += s.masses()[i] * s.velocities()[i].dot(std::as_const(a)[i]) + rate.dot(std::as_const(torque)[i]);
    }
    return sum;
  };
  double lost = 0;
  const ParticleSystem<double> s = two_tidal_bodies(0.01);
  for (Index i = 0; i < 2; ++i) {
    const Vec3<double> r = s.positions()[1 - i] - s.positions()[i], w = s.velocities()[1 - i] - s.velocities()[i];
    const Vec3<double> moments = s.column<BodyInertia>()[i], in_body = test::in_body_of(s, i);
    const Vec3<double> rate = to_space<double>(test::matrix_of(s, i), in_body.cwiseQuotient(moments));
    const double r2 = r.squaredNorm(), m = s.masses()[1 - i], love = s.column<LoveNumber>()[i];
    const double f = 3 * love * m * m * std::pow(s.column<BodyRadius>()[i], 5) / std::pow(r2, 4);
    lost += f * s.column<TideLag>()[i] * (2 * r.dot(w) * r.dot(w) / r2 + (w + cross<double>(r, rate)).squaredNorm());
  }
  CHECK(std::abs(power(0) - power(0.01) - lost) < 1e-13 * lost);
  CHECK(lost > 0);
}

TEST_CASE("tides in 113 bits are those in doubles", "[integrators][tides]") {
  const ParticleSystem<double> s = two_tidal_bodies(0.01);
  const ParticleSystem<Quad> wide = s.as<Quad>();
  VectorColumn<double> a(2);
  VectorColumn<Quad> exact(2);
  ForceSink<double> sink(a, s, {.energy = true});
  Tides{}.add_to(sink, s);
  ForceSink<Quad> in_quad(exact, wide, {.energy = true});
  Tides{}.add_to(in_quad, wide);
  for (Index i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(std::as_const(a)[i][k] - static_cast<double>(std::as_const(exact)[i][k])) <
            1e-15 * Vec3<double>(std::as_const(a)[i]).norm());
    }
  }
  CHECK(std::abs(sink.potential() / static_cast<double>(in_quad.potential()) - 1) < 1e-15);
}

TEST_CASE("under the coordinates of Wisdom and Holman three bodies and a tracer have the tides of kicks",
          "[integrators][tides]") {
  const auto system = [] {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("star", 1, {1e-3, 1e-3, 1e-3}), {.spin = Vec3<double>(0, 0, 2e-3)});
    add_body(s, body_of_inertia("inner", 1e-3, {1e-7, 1e-7, 1e-7}),
             {.x = {1, 0, 0}, .v = {0, 1.05, 0.1}, .spin = Vec3<double>(1e-8, 0, 3e-7)});
    add_body(s, body_of_inertia("outer", 2e-3, {1e-7, 1e-7, 1e-7}), {.x = {0, 2.3, 0}, .v = {-0.66, 0, 0}});
    s.add("tracer", 0, {-3.5, 0, 0}, {0, -0.53, 0});
    give_tides(s, 0, {0.1, 0.1, 0.05});
    give_tides(s, 1, {0.3, 0.03, 0.2});
    s.column<LoveNumber>()[1] *= 1e3;  // strong enough to be seen
    return s;
  };
  const auto end = [&](AnyH h, double step, bool compensated = false) {
    Simulation sim(system(), compose(std::move(h), schemes::verlet, {.compensated = compensated}), step);
    REQUIRE(sim.run_until(5).ok());
    return sim.particles();
  };
  const ParticleSystem<double> wanted = end(on_kicks(), 0.0005);
  const auto apart = [&](const ParticleSystem<double>& s) {
    double most = 0;
    for (Index i = 0; i < 4; ++i) most = std::max(most, (s.positions()[i] - wanted.positions()[i]).norm());
    for (Index i = 0; i < 2; ++i) {
      const Vec3<double> spin = wanted.column<BodySpin>()[i];
      most = std::max(most, (s.column<BodySpin>()[i] - spin).norm() / spin.norm());
    }
    return most;
  };
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    for (const bool compensated : {false, true}) {
      const AnyH h(
          with_letter(Tides{}, AnyH(Rotating<AnyH>(AnyH(WisdomHolman<double>({.coordinates = coordinates}))))));
      INFO(static_cast<int>(coordinates) << (compensated ? ", compensated" : ""));
      CHECK(apart(end(h, 0.001, compensated)) < 3e-5);
    }
  }
  ParticleSystem<double> still = system();
  still.column<LoveNumber>()[0] = 0;
  still.column<LoveNumber>()[1] = 1e-30;
  Simulation sim(still, compose(on_kicks(), schemes::verlet), 0.005);
  REQUIRE(sim.run_until(5).ok());
  CHECK(apart(sim.particles()) > 1e-3);  // the tides are seen
}

TEST_CASE("a run whose tides fail ends where they failed, whenever somebody looks", "[integrators][tides]") {
  std::vector<std::int64_t> ends;
  for (const std::int64_t cadence : {1, 7, 1000}) {
    // Two bodies fall onto each other.
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("one", 1, {0.02, 0.02, 0.03}));
    add_body(s, body_of_inertia("two", 1, {0.02, 0.02, 0.03}), {.x = {1, 0.01, 0}});
    give_tides(s, 0, {0.4, 0.5, 0.1});
    give_tides(s, 1, {0.4, 0.5, 0.1});
    Simulation sim(s, compose(on_kicks(), schemes::verlet), 0.001);
    sim.every(cadence, Energy{});
    const Outcome outcome = sim.run(5000);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    ends.push_back(sim.step());
  }
  CHECK(ends[0] > 100);
  CHECK((ends[1] == ends[0] && ends[2] == ends[0]));
}

TEST_CASE("a body of small spin is followed as well beside one of large spin", "[integrators][tides]") {
  const auto spin_of_moon = [](double spin_of_other) {
    ParticleSystem<double> s = moon(1, 1e-20, 0, 2e-20 * Vec3<double>(0, 0, 1), {0.3, 0.01, 2e-10});
    add_body(s, body_of_inertia("other", 1e-9, {1, 1, 1}),
             {.x = {50, 0, 0}, .spin = Vec3<double>(0, 0, spin_of_other)});
    Simulation sim(s, compose(on_kicks(), schemes::verlet), 0.125);
    REQUIRE(sim.run_until(1).ok());
    return Vec3<double>(sim.particles().column<BodySpin>()[1]);
  };
  CHECK((spin_of_moon(0) - spin_of_moon(0.4)).norm() < 1e-34);
}

TEST_CASE("tides that cannot be are refused", "[integrators][tides][messages]") {
  ParticleSystem<double> s = two_tidal_bodies(0.01);
  const auto refused = [](const ParticleSystem<double>& particles) {
    return test::refusal_of([&] { Tides{}.check(particles); });
  };
  CHECK(refused(s).empty());
  s.column<BodyRadius>()[1] = 0;
  CHECK(refused(s) == "'two' has a love_number, but no radius; give one above 0");
  s.column<BodyRadius>()[1] = -0.3;
  CHECK(refused(s) == "the radius of 'two' is -0.3; a length above 0 is expected");
  s.column<BodyRadius>()[1] = 0.1;
  s.column<TideLag>()[0] = -1;
  CHECK(refused(s) == "the tide_lag of 'one' is -1; 0 or more is expected");
  s.column<TideLag>()[0] = 0;
  s.column<LoveNumber>()[0] = -0.5;
  CHECK(refused(s) == "the love_number of 'one' is -0.5; 0 or more is expected");
  s.column<LoveNumber>()[0] = s.column<LoveNumber>()[1] = 0;
  CHECK(refused(s) == "no body has tides; give at least one a love_number, a radius and a tide_lag");
  s.add("point", 1, {5, 0, 0}, {0, 0, 0});
  s.column<LoveNumber>()[2] = 1;
  CHECK(refused(s) ==
        "'point' has a love_number, but no moments of inertia; tides turn bodies, so make it a rigid body");
  ParticleSystem<double> line(unit_system("reduced"));
  add_body(line, body_of_inertia("line", 1, {1, 1, 0}));
  give_tides(line, 0, {0.4, 0.3, 0.1});
  CHECK(refused(line) ==
        "'line' has a love_number, but is a line, about which tides would turn it; give it three moments of inertia");
  ParticleSystem<double> held = two_tidal_bodies(0.01);
  add_body(held, top("top", 1, {1, 1, 0.5}, {0, 0, 0.5}), {.x = {9, 0, 0}});
  CHECK(refused(held) == "tides move bodies, but a fixed point holds one of them; take tides out, or the fixed point");
}

}  // namespace noether::tides
