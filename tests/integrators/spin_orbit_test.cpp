/// Spins on orbits: a small long body in a resonance against the equation of its angle, by Kepler arcs with turns and
/// by drifts with turns.

#include "engine/given_orbit.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

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

}  // namespace noether
