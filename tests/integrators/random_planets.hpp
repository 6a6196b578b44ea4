#pragma once
/// Random systems of planets and tracers about a star, and how far a motion in doubles is from that of 113 bits.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/composition.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {

/// A field that pulls at nothing and keeps planets out of lanes.
inline const UniformField no_field{.acceleration = {0, 0, 0}};

/// A place on an orbit about a star of mass 1 at rest, and the velocity there.
inline std::pair<Vec3<double>, Vec3<double>> random_place(double G, double a, double e, std::mt19937_64& random) {
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const double turn = 2 * std::numbers::pi, E = turn * uniform(), w = turn * uniform(), tilt = 0.2 * uniform();
  const double rate = std::sqrt(G / (a * a * a)) / (1 - e * std::cos(E)), flat = std::sqrt(1 - e * e);
  const auto turned = [&](double p, double q) {
    const double up = std::sin(w) * p + std::cos(w) * q;
    return Vec3<double>(std::cos(w) * p - std::sin(w) * q, up * std::cos(tilt), up * std::sin(tilt));
  };
  return {turned(a * (std::cos(E) - e), a * flat * std::sin(E)),
          turned(-a * rate * std::sin(E), a * flat * rate * std::cos(E))};
}

/// A star and n planets, from the innermost out, and tracers within, among and beyond them.
inline ParticleSystem<double> random_planets(int n, std::mt19937_64& random, bool calm = false, int tracers = 0) {
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  ParticleSystem<double> s(unit_system("solar"));
  const double G = s.units().G;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  const double shape = uniform();
  const auto eccentricity = [&] {
    return calm ? 0.05 * uniform() : shape < 0.3 ? 0.95 * uniform() : shape < 0.6 ? 0.95 : 0.1 * uniform();
  };
  const double innermost = 0.2 + 0.4 * uniform();
  double a = innermost;
  for (int k = 0; k < n; ++k, a *= 1.3 + uniform()) {
    const double e = eccentricity(), mass = std::pow(10, -8 + (calm ? 3 : 5) * uniform());
    const auto [x, v] = random_place(G, a, e, random);
    s.add("planet " + std::to_string(k), mass, x, v);
  }
  for (int k = 0; k < tracers; ++k) {
    const double axis = 0.7 * innermost * std::pow(2 * a / innermost, uniform());
    const auto [x, v] = random_place(G, axis, eccentricity(), random);
    s.add("tracer " + std::to_string(k), 0, x, v);
  }
  move_to_barycenter(s);
  return s;
}

/// Many planets of different masses on near orbits, far from each other.
inline ParticleSystem<double> crowd_of_planets(int n) {
  std::mt19937_64 random(61);
  std::uniform_real_distribution<double> uniform(0, 1);
  ParticleSystem<double> s(unit_system("solar"));
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  for (int k = 0; k < n; ++k) {
    const auto [x, v] = random_place(s.units().G, 1 + 0.02 * k, 0.01 * uniform(random), random);
    s.add("planet " + std::to_string(k), std::pow(10, -9 + 2 * uniform(random)), x, v);
  }
  move_to_barycenter(s);
  return s;
}

template <class Real> using Planets = std::vector<std::pair<Vec3<Real>, Vec3<Real>>>;

/// Positions and velocities about the star after steps of a word from these doubles, with x and v a little larger.
template <class Real>
Planets<Real> after(const ParticleSystem<double>& start, const AnyHamiltonian<Real>& hamiltonian, const Scheme& scheme,
                    double dt, std::int64_t steps, double size = 1, double speed = 1, CompositionOptions options = {}) {
  auto s = start.as<Real>();
  for (Index i = 0; i < s.size(); ++i) {
    s.positions().set(i, Real(size) * std::as_const(s).positions()[i]);
    s.velocities().set(i, Real(speed) * std::as_const(s).velocities()[i]);
  }
  Simulation<Real> run(std::move(s), Composition<AnyHamiltonian<Real>>(hamiltonian, scheme, options), dt);
  REQUIRE(run.run(steps).ok());
  const ParticleSystem<Real> end = run.particles();
  Planets<Real> found;
  for (Index i = 1; i < end.size(); ++i) {
    found.emplace_back(end.positions()[i] - end.positions()[0], end.velocities()[i] - end.velocities()[0]);
  }
  return found;
}

inline double length(const Vec3<Quad>& d) { return std::sqrt(static_cast<double>(norm2(d))); }

/// The largest error of a planet in units of what a rounding of all x or of all v does to it, and the mean.
struct Roundings {
  double worst = 0, sum = 0;
  int count = 0;
};
template <class Run> void compare(const Run& exact, const Planets<double>& found, Roundings& roundings) {
  const Planets<Quad> truth = exact(1, 1), longer = exact(1 + 0x1p-52, 1), faster = exact(1, 1 + 0x1p-52);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const auto error = [&](auto part, const Vec3<double>& mine) {
      const Vec3<Quad> right = part(truth[k]);
      const double unit = length(part(longer[k]) - right) + length(part(faster[k]) - right) + 0x1p-52 * length(right);
      return length(mine.cast<Quad>() - right) / unit;
    };
    const double x = error([](const auto& planet) { return planet.first; }, found[k].first);
    const double v = error([](const auto& planet) { return planet.second; }, found[k].second);
    const double larger = x > v || !(x == x) ? x : v;
    if (!(larger <= roundings.worst)) roundings.worst = larger;
    roundings.sum += larger;
    ++roundings.count;
  }
}

/// A run that ends in the middle of a word, however it is made.
struct Course {
  ParticleSystem<double> start;
  AnyHamiltonian<double> hamiltonian;
  const Scheme* scheme;
  double dt;
  CompositionOptions options = {};

  Simulation<double> begin() const {
    return Simulation<double>(start, Composition<AnyHamiltonian<double>>(hamiltonian, *scheme, options), dt);
  }
};

inline ParticleSystem<double> end_of(const Course& course, std::int64_t steps) {
  auto run = course.begin();
  REQUIRE(run.run(steps).ok());
  return run.particles();
}

}  // namespace noether::test
