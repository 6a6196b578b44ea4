#pragma once
/// What the tests of the shadow Hamiltonian share: watched runs, and a method that only poses as symplectic.

#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

namespace noether::test {

/// The orders that are watched unless somebody asks for others.
inline const std::vector<std::int64_t> shadow_orders = {4, 8, 12, 16, 20, 24};

/// A watched run of `steps` steps, and the monitor at its end.
template <class I>
ShadowHamiltonian<typename I::real> shadow_of(I integrator, const ParticleSystem<double>& start, double h,
                                              std::int64_t steps, const std::vector<std::int64_t>& orders) {
  using Real = typename I::real;
  Simulation simulation(start.as<Real>(), std::move(integrator), h);
  auto& shadow = simulation.every(1, ShadowHamiltonian<Real>(orders));
  REQUIRE(simulation.run(steps).ok());
  return shadow;
}

/// Energy 0.069 on the potential of Henon and Heiles: irregular, but bounded.
inline ParticleSystem<double> henon_heiles_start() { return particle_in_plane(0, 0.1, 0.35, 0.05); }

/// The Runge-Kutta method of order 4, which claims to be symplectic and gives the action of its stages.
template <class F, class Real = double> class PosingRungeKutta {
 public:
  using real = Real;
  explicit PosingRungeKutta(F force) : force_(std::move(force)) {}

  IntegratorClaims claims() const {
    return {.method = "posing_rk4", .hamiltonian = "kinetic_potential", .order = 4, .symplectic = true};
  }
  void bind(ParticleSystem<Real>&) {}
  Advance advance(ParticleSystem<Real>& s, const Span& span) {
    Real ignored(0);
    return advance_with_action(s, span, ignored);
  }
  Advance advance_with_action(ParticleSystem<Real>& s, const Span& span, Real& action) {
    const Real h(s.clock().dt());
    for (std::int64_t k = 0; k < span.steps; ++k) {
      const ParticleSystem<Real> start = s;
      auto stage = s;
      const Real weights[] = {Real(1) / Real(6), Real(1) / Real(3), Real(1) / Real(3), Real(1) / Real(6)};
      const Real next[] = {Real(1) / Real(2), Real(1) / Real(2), Real(1), Real(0)};
      for (int i = 0; i < 4; ++i) {
        VectorColumn<Real> a(s.size());
        ForceSink<Real> sink(a, stage, {.energy = true});
        force_.add_to(sink, stage);
        const VectorColumn<Real> v = std::as_const(stage).velocities();
        action += h * weights[i] * (kinetic_energy(stage) - sink.potential());
        s.positions().add_scaled(h * weights[i], v);
        s.velocities().add_scaled(h * weights[i], a);
        stage = start;
        stage.positions().add_scaled(h * next[i], v);
        stage.velocities().add_scaled(h * next[i], a);
      }
      s.clock().tick(Real(0));
    }
    return {.steps = span.steps};
  }
  Real settle(const ParticleSystem<Real>& raw, ParticleSystem<Real>& out, Request, std::optional<double>, bool) {
    out.assign_state(raw);
    return Real(0);
  }
  EnergyTerms<Real> energy(const ParticleSystem<Real>& s) {
    VectorColumn<Real> a(s.size());
    ForceSink<Real> sink(a, s, {.energy = true});
    force_.add_to(sink, s);
    return {kinetic_energy(s), sink.potential()};
  }
  void accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
    ForceSink<Real> sink(a, s, {});
    force_.add_to(sink, s);
  }
  Evaluations evaluations() const { return {}; }

 private:
  F force_;
};

}  // namespace noether::test
