#include "integrators/all_schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace noether {
namespace {

using namespace noether::test;

Vec3<Quad> momentum(const ParticleSystem<double>& narrow) {
  const auto s = narrow.as<Quad>();
  Vec3<Quad> sum = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.velocities()[i];
  return sum;
}

Vec3<Quad> angular_momentum(const ParticleSystem<double>& narrow) {
  const auto s = narrow.as<Quad>();
  Vec3<Quad> sum = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    sum += s.masses()[i] * cross(Vec3<Quad>(s.positions()[i]), Vec3<Quad>(s.velocities()[i]));
  }
  return sum;
}

double length(const Vec3<Quad>& v) { return std::sqrt(static_cast<double>(norm2(v))); }

/// sum m |v| and sum m |x| |v|: what rounding errors of momenta are to be compared with.
double momentum_scale(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.velocities()[i].norm();
  return sum;
}
double angular_scale(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.positions()[i].norm() * s.velocities()[i].norm();
  return sum;
}

/// 8 x 2^-53 x sqrt(number of flows): a random walk of rounding errors.
double allowed(const Scheme& scheme, long steps) {
  return 8 * 0x1p-53 * std::sqrt(static_cast<double>(static_cast<long>(scheme.word.size()) * steps));
}

template <class H>
void check_momenta(const H& hamiltonian, const Scheme& scheme, const ParticleSystem<double>& start, double dt,
                   long steps) {
  const auto end = run(hamiltonian, scheme, start, dt, steps);
  const double bound = allowed(scheme, steps);
  const double p = length(momentum(end) - momentum(start)) / momentum_scale(start);
  const double l = length(angular_momentum(end) - angular_momentum(start)) / angular_scale(start);
  INFO(scheme.name << " at step " << dt);
  CHECK(p < bound);
  CHECK(l < bound);
}

TEST_CASE("every scheme keeps momentum and angular momentum to rounding", "[conservation]") {
  const auto hamiltonian = kinetic_potential(Gravity{.G = 1.0});
  for (const Scheme* scheme : schemes::all()) check_momenta(hamiltonian, *scheme, four_bodies(), 0.01, 400);
}

constexpr Coordinates each[] = {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds,
                                Coordinates::barycentric};

TEST_CASE("every scheme keeps momenta over Kepler arcs to rounding, in all coordinates", "[conservation]") {
  for (const Coordinates coordinates : each) {
    const HamiltonianClaims claims = wisdom_holman({.coordinates = coordinates}).claims();
    for (const Scheme* scheme : schemes::all()) {
      if (!claims.quadratic_kinetic && scheme->scheme_class == SchemeClass::rkn) continue;
      if (!claims.inexact.empty() && !scheme->is_composition() && scheme->exact.find('B') != std::string_view::npos) {
        continue;
      }
      check_momenta(wisdom_holman({.coordinates = coordinates}), *scheme, planets(1e-3), 0.05, 200);
    }
  }
}

TEST_CASE("momentum is not kept where the forces do not keep it", "[conservation]") {
  const auto hamiltonian = kinetic_potential(Gravity{.G = 1.0}, UniformField{{1e-12, 0, 0}});
  const auto end = run(hamiltonian, schemes::verlet, four_bodies(), 0.01, 400);
  const double error = length(momentum(end) - momentum(four_bodies())) / momentum_scale(four_bodies());
  CHECK(error > allowed(schemes::verlet, 400));
}

/// Largest difference of positions and velocities after going forward and back, in ulps of the largest component.
template <class H>
double ulps_after_return(const H& hamiltonian, const Scheme& scheme, const ParticleSystem<double>& start, double dt,
                         long steps) {
  const auto there = run(hamiltonian, scheme, start, dt, steps);
  const auto back = run(hamiltonian, scheme, there, -dt, steps);
  double largest = 0;
  for (Index i = 0; i < start.size(); ++i) {
    const Vec3<double> x = start.positions()[i], v = start.velocities()[i];
    largest = std::max({largest, x.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff()});
  }
  return distance(back, start) / (largest * 0x1p-53);
}

TEST_CASE("symmetric schemes return to where they started, the others visibly do not",
          "[conservation][reversibility]") {
  const auto hamiltonian = kinetic_potential(Gravity{.G = 1.0});
  for (const Scheme* scheme : schemes::all()) {
    const double ulps = ulps_after_return(hamiltonian, *scheme, four_bodies(), 0.1, 20);
    INFO(scheme->name << " returns to within " << ulps << " ulp");
    if (scheme->is_symmetric()) {
      CHECK(ulps < 100);
    } else {
      CHECK(ulps > 1e5);
    }
  }
}

TEST_CASE("symmetric schemes over Kepler arcs return to where they started, in all coordinates",
          "[conservation][reversibility]") {
  for (const Coordinates coordinates : each) {
    const auto hamiltonian = wisdom_holman({.coordinates = coordinates});
    for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba, &schemes::yoshida_6, &schemes::abah_10_6_4}) {
      INFO(scheme->name);
      CHECK(ulps_after_return(hamiltonian, *scheme, planets(1e-2), 0.2, 20) < 200);
    }
    CHECK(ulps_after_return(hamiltonian, schemes::symplectic_euler_a, planets(1e-2), 0.2, 20) > 1e6);
  }
}

}  // namespace
}  // namespace noether
