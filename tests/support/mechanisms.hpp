#pragma once
/// Mechanical systems with constraints: pendulums, chains, rings of atoms; and the shortest way to run them.

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/surfaces.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/drivers.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace noether::test {

/// Particles and what ties them.
struct Mechanism {
  ParticleSystem<double> particles;
  ConstraintSet constraints;
};

inline constexpr double g_earth = 9.80665;
inline const UniformField weight{{0, 0, -g_earth}};

/// The Hamiltonian of a mechanism under a force, its weight unless told.
template <class Real = double, class F = UniformField>
AnyHamiltonian<Real> hamiltonian_of(const Mechanism& mechanism, const F& force = weight) {
  return kinetic_potential_over(field_of<Real>(force), mechanism.constraints);
}

/// A mass on a rod of length 1 that turns about the vertical as it swings.
inline Mechanism spherical_pendulum() {
  Mechanism m;
  m.particles.add("bob", 1.5, {0.8, 0, -0.6}, {0, 1.7, 0});
  m.constraints.add(m.particles, OnSphere{}, {0});
  return m;
}

/// Two rods of 2 and 3, masses 1 and 2, angles pi/4 and pi/2 from the vertical, angular velocities 0 and pi/8; the
/// first rod hangs from the origin. @param turned  about the vertical, so that no coordinate is idle
inline Mechanism double_pendulum(double turned = 0.3) {
  const double a = M_PI / 4, b = M_PI / 2, c = std::cos(turned), s = std::sin(turned);
  const double x1 = 2 * std::sin(a), z1 = -2 * std::cos(a), x2 = x1 + 3 * std::sin(b), z2 = z1 - 3 * std::cos(b);
  const double u2 = 3 * std::cos(b) * M_PI / 8, w2 = 3 * std::sin(b) * M_PI / 8;
  Mechanism m;
  m.particles.add("elbow", 1, {c * x1, s * x1, z1}, {0, 0, 0});
  m.particles.add("hand", 2, {c * x2, s * x2, z2}, {c * u2, s * u2, w2});
  m.constraints.add(m.particles, OnSphere{.radius = 2}, {0}).add(m.particles, Distance{3}, {0, 1});
  return m;
}

/// `links` rods of length 1 and masses 1 at their ends, hanging from the origin, bent into the third dimension and
/// turning.
inline Mechanism hanging_chain(Index links, ConstraintOptions options = {}) {
  Mechanism m{ParticleSystem<double>(), ConstraintSet(options)};
  Vec3<double> x = Vec3<double>::Zero();
  for (Index i = 0; i < links; ++i) {
    const double k = static_cast<double>(i), polar = 1.1 + 0.3 * std::sin(1.7 * k), azimuth = 0.4 * std::sin(2.3 * k);
    x += Vec3<double>(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), -std::cos(polar));
    m.particles.add("link_" + std::to_string(i + 1), 1, x, {-0.1 * x[1], 0.1 * x[0], 0});
  }
  m.constraints.add(m.particles, OnSphere{}, {0});
  for (Index i = 0; i + 1 < links; ++i) m.constraints.add(m.particles, Distance{}, {i, i + 1});
  return m;
}

/// Bars between free particles in a row, none of them in line: a molecule without a field. Velocities are not along the
/// constraints.
inline Mechanism free_chain(Index particles, ConstraintOptions options = {}) {
  Mechanism m{ParticleSystem<double>(), ConstraintSet(options)};
  for (Index i = 0; i < particles; ++i) {
    const double k = static_cast<double>(i);
    m.particles.add("atom_" + std::to_string(i + 1), 1 + 0.3 * std::sin(k),
                    {k, 0.4 * std::cos(1.3 * k), 0.4 * std::sin(2.1 * k)},
                    {0.3 * std::sin(5 * k), 0.3 * std::cos(3 * k), 0.3 * std::sin(7 * k + 1)});
  }
  for (Index i = 0; i + 1 < particles; ++i) m.constraints.add(m.particles, Distance{}, {i, i + 1});
  return m;
}

/// The settled particles after `steps` steps of `dt`.
template <class Real = double, class F = UniformField>
ParticleSystem<Real> run(const Mechanism& mechanism, const Scheme& scheme, double dt, std::int64_t steps,
                         const F& force = weight) {
  Simulation<Real> sim(mechanism.particles.as<Real>(), compose(hamiltonian_of<Real>(mechanism, force), scheme), dt);
  const Outcome outcome = sim.run(steps);
  if (!outcome.ok()) throw Error(to_text(outcome));
  return sim.particles();
}

/// Largest difference of a position or velocity.
template <class Real> double distance_of_states(const ParticleSystem<Real>& a, const ParticleSystem<Real>& b) {
  using std::abs;
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) {
    for (Index k = 0; k < 3; ++k) {
      worst = std::max(worst, static_cast<double>(abs(a.positions()[i][k] - b.positions()[i][k])));
      worst = std::max(worst, static_cast<double>(abs(a.velocities()[i][k] - b.velocities()[i][k])));
    }
  }
  return worst;
}

/// Largest velocity across a constraint, |G v| / sum |G_i| |v_i|.
template <class Real> double velocity_across(const ConstraintSet& set, const ParticleSystem<Real>& s) {
  using std::abs, std::sqrt;
  double worst = 0;
  for (const auto& group : set.groups()) {
    std::vector<Vec3<Real>> gradients(
        static_cast<std::size_t>(group->size() * group->equations() * group->particles()));
    group->gradients(ConstraintPositions<Real>(s), 0, group->size(), gradients.data());
    const Vec3<Real>* next = gradients.data();
    for (Index c = 0; c < group->size(); ++c) {
      for (Index e = 0; e < group->equations(); ++e) {
        Real sum(0), size(0);
        for (Index k = 0; k < group->particles(); ++k) {
          const Vec3<Real> v = s.velocities()[group->particle(c, k)];
          sum += dot(*next, v);
          size += sqrt(norm2(*next) * norm2(v));
          ++next;
        }
        if (size > Real(0)) worst = std::max(worst, static_cast<double>(abs(sum) / size));
      }
    }
  }
  return worst;
}

}  // namespace noether::test
