/// Spins on orbits, by Kepler arcs with turns and by drifts with turns: a small long body in a resonance against the
/// equation of its angle, and a planet about whose own axis moons go.

#include "engine/given_orbit.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "monitors/spin.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

const double pi = std::acos(-1.0);

/// A body of 1e-9 of the mass and `size` of the distance, at its pericenter, on an orbit of period 2 pi.
ParticleSystem<double> satellite(double e, double asphericity, double angle, double rate, double size) {
  ParticleSystem<double> s(unit_system("reduced"));
  const double m = 1e-9;
  s.add("planet", 1 - m, Vec3<double>::Zero(), Vec3<double>::Zero());
  const auto [x, v] = state_of_orbit({.a = 1, .e = e}, 1);
  const Vec3<double> moments = m * size * size * Vec3<double>(1 - asphericity, 1, 1);
  add_body(s, body_of_inertia("moon", m, moments),
           {.x = x,
            .v = v,
            .orientation = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
            .angular_velocity = Vec3<double>(0, 0, rate)});
  return s;
}

AnyHamiltonian<double> kepler_arcs(Coordinates coordinates = Coordinates::jacobi) {
  ForceField<double> figure;
  figure.add(GravityOfBodies{.point_masses = false});
  return Rotating<AnyHamiltonian<double>>(
      WisdomHolman<double, ForceField<double>>({.coordinates = coordinates}, std::move(figure)));
}
AnyHamiltonian<double> drifts() {
  ForceField<double> all;
  all.add(GravityOfBodies{});
  return test::turning(std::move(all));
}

/// theta - p M and theta'/n at the pericenter after so many orbits.
std::pair<double, double> after(int orbits, ParticleSystem<double> s, AnyHamiltonian<double> h,
                                const std::string& scheme, int steps) {
  Simulation sim(std::move(s), compose(std::move(h), *schemes::find(scheme)), 2 * pi / steps);
  REQUIRE(sim.run(std::int64_t{orbits} * steps).ok());
  const ParticleSystem<double>& now = sim.particles();
  const Mat3<double> r = test::matrix_of(now, 1);
  const double angle = std::atan2(r(1, 0), r(0, 0));  // M is whole turns there, 3/2 of it half turns
  return {angle - pi * std::round(angle / pi), now.column<BodySpin>()[1][2] / now.column<BodyInertia>()[1][2]};
}

}  // namespace

TEST_CASE("a small body librates in 3:2 as the equation of its angle says", "[integrators][spin_orbit]") {
  // e = 0.2056, (B - A)/C = 1e-3, from theta = 0.02 and a rate of 1.5 n at the pericenter; references of 28 digits.
  struct Moment {
    int orbits;
    double angle, rate;
  };
  for (const Moment& m :
       {Moment{1, 0.01523250863799300, 1.49978267499637302}, Moment{10, -0.02380065531194590, 1.50093299366238267},
        Moment{30, -0.02240357073351189, 1.50017955285792809}}) {
    CAPTURE(m.orbits);
    const auto small = satellite(0.2056, 1e-3, 0.02, 1.5, 1e-5);
    const auto [angle, rate] = after(m.orbits, small, kepler_arcs(), "aba_8_6_4", 60);
    CHECK(std::abs(angle - m.angle) < 1e-6);
    CHECK(std::abs(rate - m.rate) < 1e-6);
    const auto [by_drifts, rate_by_drifts] = after(m.orbits, small, drifts(), "srkn14a", 60);
    CHECK(std::abs(by_drifts - m.angle) < 1e-6);
    CHECK(std::abs(rate_by_drifts - m.rate) < 1e-6);
  }
}

TEST_CASE("the angle of the resonance librates with the period of the averaged equation", "[integrators][spin_orbit]") {
  // gamma'' = - n^2 (3/2) (B - A)/C H sin 2 gamma for small angles: a period of 1/sqrt(3 (B - A)/C |H|) orbits, with
  // H(3/2, e) = 7 e/2 - 123 e^3/16 + 489 e^5/128.
  const double e = 0.2056, asphericity = 1e-3;
  const double h = 3.5 * e - 123 * std::pow(e, 3) / 16 + 489 * std::pow(e, 5) / 128;
  const double period = 1 / std::sqrt(3 * asphericity * std::abs(h));
  CHECK(std::abs(period / 22.5729 - 1) < 1e-5);
  Spin spin("moon");
  spin.resonance = {3, 2};
  spin.G = 1;
  Simulation sim(satellite(e, asphericity, 0.02, 1.5, 1e-5), compose(kepler_arcs(), *schemes::find("aba_8_6_4")),
                 2 * pi / 60);
  auto& watched = sim.every(1, spin);
  // At the pericenters, where the angle is not moved by what averages out in an orbit.
  std::vector<double> crossings;
  double before = 0;
  for (int orbit = 0; orbit < 140; ++orbit) {
    REQUIRE(sim.run(60).ok());
    const double angle = watched.angle();
    CHECK(std::abs(angle) < 0.025);
    if (orbit > 0 && before < 0 && angle >= 0) crossings.push_back(orbit + 1 - angle / (angle - before));
    before = angle;
  }
  REQUIRE(crossings.size() >= 5);
  const double found = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  CAPTURE(found);
  CHECK(std::abs(found / period - 1) < 0.02);
}

TEST_CASE("a body of a size turns its orbit, by the square of its size", "[integrators][spin_orbit]") {
  const auto off = [](double size) {
    return after(10, satellite(0.1, 0.02, 0.1, 1, size), kepler_arcs(), "aba_8_6_4", 60).first + 0.05152074577799952;
  };
  CHECK(std::abs(off(1e-5)) < 1e-6);
  CHECK(std::abs(std::log2(off(2e-2) / off(1e-2)) - 2) < 0.1);
}

TEST_CASE("Kepler arcs with turns keep the order of Wisdom-Holman schemes", "[integrators][spin_orbit]") {
  const auto error = [](const std::string& scheme, int steps) {
    const auto start = satellite(0.1, 0.3, 0.4, 1.2, 3e-2);
    const auto [angle, rate] = after(2, start, kepler_arcs(), scheme, steps);
    const auto [exact, exact_rate] = after(2, start, drifts(), "srkn14a", 400);
    return std::max(std::abs(angle - exact), std::abs(rate - exact_rate));
  };
  CHECK(std::abs(std::log2(error("verlet_aba", 100) / error("verlet_aba", 200)) - 2) < 0.1);
  CHECK(std::abs(std::log2(error("yoshida_4", 100) / error("yoshida_4", 200)) - 4) < 0.3);
}

TEST_CASE("free points and tracers beside bodies move on Kepler arcs as by drifts", "[integrators][spin_orbit]") {
  const auto start = [] {
    auto s = satellite(0.1, 0.3, 0.4, 1.2, 3e-2);
    const auto [x, v] = state_of_orbit({.a = 2.3, .e = 0.05, .inc = 0.1}, 1);
    s.add("point", 1e-3, x, v);
    const auto [far, slow] = state_of_orbit({.a = 4, .e = 0.2, .inc = 0.3, .M = 2}, 1);
    s.add("tracer", 0, far, slow);
    move_to_barycenter(s);
    return s;
  };
  const auto end = [&](AnyHamiltonian<double> h, const std::string& scheme, int steps) {
    Simulation sim(start(), compose(std::move(h), *schemes::find(scheme)), 4 * pi / steps);
    REQUIRE(sim.run(steps).ok());
    return sim.particles();
  };
  const auto momentum = [](const ParticleSystem<double>& s) {
    Vec3<double> all = Vec3<double>::Zero();
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> x = s.positions()[i], v = s.velocities()[i], spin = s.column<BodySpin>()[i];
      all += s.masses()[i] * cross(x, v) + spin;
    }
    return all;
  };
  const ParticleSystem<double> exact = end(drifts(), "srkn14a", 800), begin = start();
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds}) {
    const auto errors = [&](int steps) {
      const ParticleSystem<double> found = end(kepler_arcs(coordinates), "verlet_aba", steps);
      CHECK(std::sqrt(norm2(Vec3<double>(momentum(found) - momentum(begin)))) < 1e-17);
      std::array<double, 4> all = {};
      for (Index i = 1; i < found.size(); ++i) {
        all[static_cast<std::size_t>(i)] = std::sqrt(norm2(Vec3<double>(found.positions()[i] - exact.positions()[i])));
      }
      const Vec3<double> spin = found.column<BodySpin>()[1] - exact.column<BodySpin>()[1];
      all[0] = std::sqrt(norm2(spin)) / begin.column<BodySpin>()[1][2];
      return all;
    };
    const auto coarse = errors(200), fine = errors(400);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      CAPTURE(static_cast<int>(coordinates), i, coarse[i], fine[i]);
      CHECK(std::abs(std::log2(coarse[i] / fine[i]) - 2) < 0.2);
    }
  }
}

namespace {

/// A planet of mass 1 that turns fast about an axis that leans, its moon on an ellipse, and a small one further out.
ParticleSystem<double> planet_with_moons(double moon = 0.02) {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("planet", 1, {0.009, 0.009, 0.01}),
           {.orientation = {std::cos(0.3), std::sin(0.3), 0, 0}, .angular_velocity = Vec3<double>(0.3, -0.2, 4)});
  const auto [x, v] = state_of_orbit({.a = 1, .e = 0.1, .inc = 0.2}, 1 + moon);
  s.add("moon", moon, x, v);
  const auto [far, slow] = state_of_orbit({.a = 2.3, .e = 0.05, .inc = 0.1, .M = 2}, 1 + moon);
  s.add("small", 1e-3, far, slow);
  move_to_barycenter(s);
  return s;
}

/// J2 = (C - A)/(m R^2) of that planet.
const Oblateness own_figure{.J2 = 0.1, .radius = 0.1, .frame = AxisFrame::body};
const Oblateness flat{.J2 = 0.1, .J4 = -5, .radius = 0.1, .axis = {0.1, 0.05, 1}, .frame = AxisFrame::body};

template <class... Fs> ForceField<double> field_of(const Fs&... forces) {
  ForceField<double> all;
  (all.add(forces), ...);
  return all;
}
template <class... Fs> AnyHamiltonian<double> arcs_beside(Coordinates coordinates, const Fs&... forces) {
  return Rotating<AnyHamiltonian<double>>(
      WisdomHolman<double, ForceField<double>>({.coordinates = coordinates}, field_of(forces...)));
}

ParticleSystem<double> run_of(ParticleSystem<double> s, AnyHamiltonian<double> h, const Scheme& scheme, double time,
                              int steps) {
  Simulation sim(std::move(s), compose(std::move(h), scheme), time / steps);
  REQUIRE(sim.run(steps).ok());
  return sim.particles();
}

/// The largest difference of places and orientations, and of spins over the largest one.
double apart(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  double worst = 0;
  const double spin = Vec3<double>(b.column<BodySpin>()[0]).norm();
  for (Index i = 0; i < a.size(); ++i) {
    worst = std::max({worst, Vec3<double>(a.positions()[i] - b.positions()[i]).norm(),
                      Vec3<double>(a.column<BodySpin>()[i] - b.column<BodySpin>()[i]).norm() / spin,
                      (test::matrix_of(a, i) - test::matrix_of(b, i)).cwiseAbs().maxCoeff()});
  }
  return worst;
}

}  // namespace

TEST_CASE("a planet with J2 = (C - A)/(m R^2) about its own axis goes as by its moments of inertia",
          "[integrators][spin_orbit]") {
  const auto both = [](AnyHamiltonian<double> a, AnyHamiltonian<double> b, const Scheme& scheme) {
    return apart(run_of(planet_with_moons(), std::move(a), scheme, 20, 800),
                 run_of(planet_with_moons(), std::move(b), scheme, 20, 800));
  };
  const GravityOfBodies moments{.point_masses = false};
  CHECK(both(test::turning(field_of(Gravity{}, own_figure)), test::turning(field_of(GravityOfBodies{})),
             schemes::verlet) < 1e-13);
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds}) {
    CHECK(both(arcs_beside(coordinates, own_figure), arcs_beside(coordinates, moments), schemes::verlet_aba) < 1e-13);
  }
  // It is no small thing: as a point the planet does not precess.
  CHECK(both(test::turning(field_of(Gravity{}, own_figure)), test::turning(field_of(Gravity{})), schemes::verlet) >
        1e-3);
}

TEST_CASE("a planet about its own axis is followed to the order of schemes, by drifts and by Kepler arcs",
          "[integrators][spin_orbit]") {
  const auto exact = run_of(planet_with_moons(), test::turning(field_of(Gravity{}, flat)), schemes::srkn14a, 4, 400);
  const auto slope = [&](const AnyHamiltonian<double>& h, const Scheme& scheme, int steps) {
    const double coarse = apart(run_of(planet_with_moons(), h, scheme, 4, steps), exact),
                 fine = apart(run_of(planet_with_moons(), h, scheme, 4, 2 * steps), exact);
    CAPTURE(coarse, fine);
    CHECK(coarse > 1e-10);
    return std::log2(coarse / fine);
  };
  const AnyHamiltonian<double> by_drifts = test::turning(field_of(Gravity{}, flat));
  CHECK(std::abs(slope(by_drifts, schemes::verlet, 200) - 2) < 0.1);
  CHECK(std::abs(slope(by_drifts, schemes::blanes_moan_s6, 60) - 4) < 0.2);
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds}) {
    CAPTURE(static_cast<int>(coordinates));
    const AnyHamiltonian<double> by_arcs = arcs_beside(coordinates, flat);
    CHECK(std::abs(slope(by_arcs, schemes::verlet_aba, 100) - 2) < 0.1);
    CHECK(std::abs(slope(by_arcs, schemes::yoshida_4, 100) - 4) < 0.3);
  }
}

TEST_CASE("a planet about its own axis keeps its angular momentum to rounding, and its energy without a slope",
          "[integrators][spin_orbit]") {
  const auto check = [](AnyHamiltonian<double> h, const Scheme& scheme, double step) {
    Simulation sim(planet_with_moons(), compose(std::move(h), scheme), step);
    auto& energy = sim.every(8, Energy{});
    auto& momentum = sim.every(8, AngularMomentum{});
    auto& spin = sim.every(8, Spin("planet"));
    REQUIRE(sim.run(40000).ok());
    const MonitorReport told = energy.report();
    CAPTURE(told.worst.value(), told.slope.value(), told.slope_error.value());
    CHECK(std::abs(told.slope.value()) < 3 * told.slope_error.value());
    CHECK(told.worst.value() < 2e-5);
    CHECK(momentum.report().worst.value() < 2e-14);
    const ParticleSystem<double>& end = sim.particles();
    const Vec3<double> of_spin = end.column<BodySpin>()[0],
                       of_orbit = cross<double>(end.positions()[1] - end.positions()[0],
                                                end.velocities()[1] - end.velocities()[0]);
    const double lean = std::acos(of_spin.dot(of_orbit) / (of_spin.norm() * of_orbit.norm()));
    CHECK(std::abs(spin.obliquity() - lean) < 1e-12);
    CHECK(lean > 0.1);
  };
  check(test::turning(field_of(Gravity{}, flat)), schemes::verlet, 0.02);
  check(arcs_beside(Coordinates::jacobi, flat), schemes::verlet_aba, 0.05);
}

TEST_CASE("the axis of a fast planet precesses as the mean torque of a distant mass says",
          "[integrators][spin_orbit]") {
  // dpsi/dt = - 3/2 (G M/r^3) ((C - A)/C) cos(obliquity)/rate, of a mass on a circle of period 2 pi, to first order:
  // what is left is as precession to mean motion, and halves where the rate doubles.
  const double lean = 0.4, flattening = 0.02, moment = 0.4e-9 * 1e-6;  // C = 0.4 m R^2, R = 1e-3
  const double J2 = flattening * 0.4;
  const auto error = [&](double rate) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(
        s, body_of_inertia("planet", 1e-9, moment * Vec3<double>(1 - flattening, 1 - flattening, 1)),
        {.orientation = {std::cos(lean / 2), std::sin(lean / 2), 0, 0}, .angular_velocity = Vec3<double>(0, 0, rate)});
    const auto [x, v] = state_of_orbit({.a = 1}, 1);
    s.add("sun", 1, x, v);
    move_to_barycenter(s);
    const int orbits = 40;
    const Oblateness figure{.J2 = J2, .radius = 1e-3, .frame = AxisFrame::body};
    const auto end =
        run_of(s, test::turning(field_of(Gravity{}, figure)), schemes::blanes_moan_s6, 2 * pi * orbits, 60 * orbits);
    const auto node = [](const ParticleSystem<double>& at) {  // of the equator on the plane of the orbit
      const Vec3<double> spin = at.column<BodySpin>()[0];
      return std::atan2(spin[0], -spin[1]);
    };
    const double wanted = -1.5 * flattening * std::cos(lean) / rate * 2 * pi * orbits;
    const double found = std::remainder(node(end) - node(s), 2 * pi);
    CAPTURE(rate, wanted, found);
    CHECK(std::abs(wanted) > 0.01);
    return std::abs(found / wanted - 1);
  };
  const double slow = error(20), fast = error(40);
  CAPTURE(slow, fast);
  CHECK(slow < 3e-3);
  CHECK(std::abs(std::log2(slow / fast) - 1) < 0.2);
}

}  // namespace noether
