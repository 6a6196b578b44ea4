#pragma once
/// The usual assemblies, each behind one type, so that what stands above a force is compiled once and not for every
/// force of every test. They give the bits of `KineticPotential(Gravity{})` and its like (tests/determinism), which
/// stand where a test is about the types themselves.

#include "constraints/constraint_set.hpp"
#include "forces/sum.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/langevin.hpp"
#include "integrators/wisdom_holman.hpp"

#include <cstdint>
#include <optional>
#include <utility>

namespace noether::test {

/// Forces added in order.
template <class Real = double, class... Fs> ForceField<Real> field_of(Fs... forces) {
  ForceField<Real> field;
  (field.add(std::move(forces)), ...);
  return field;
}
template <class Real> ForceField<Real> field_of(ForceField<Real> field) { return field; }

/// `KineticPotential` over a field, and held by constraints.
AnyHamiltonian<double> kinetic_potential_over(ForceField<double> forces, const NeighborOptions& list = {});
AnyHamiltonian<Quad> kinetic_potential_over(ForceField<Quad> forces, const NeighborOptions& list = {});
AnyHamiltonian<double> kinetic_potential_over(ForceField<double> forces, const ConstraintSet& constraints,
                                              const NeighborOptions& list = {});
AnyHamiltonian<Quad> kinetic_potential_over(ForceField<Quad> forces, const ConstraintSet& constraints,
                                            const NeighborOptions& list = {});

/// H = T + U of forces: `kinetic_potential(Gravity{}, UniformField{})`.
template <class Real = double, class... Fs> AnyHamiltonian<Real> kinetic_potential(Fs... forces) {
  return kinetic_potential_over(field_of<Real>(std::move(forces)...));
}

/// The same with a drag, or in a bath.
AnyHamiltonian<double> damped(AnyHamiltonian<double> hamiltonian, const LinearDrag& drag);
AnyHamiltonian<Quad> damped(AnyHamiltonian<Quad> hamiltonian, const LinearDrag& drag);
AnyHamiltonian<double> in_bath(ForceField<double> forces, const LangevinOptions& options);
AnyHamiltonian<double> in_bath(ForceField<double> forces, const ConstraintSet& constraints,
                               const LangevinOptions& options);

/// The splitting of Wisdom and Holman, under further forces too.
AnyHamiltonian<double> wisdom_holman_over(const WisdomHolmanOptions& options, ForceField<double> forces);
AnyHamiltonian<Quad> wisdom_holman_over(const WisdomHolmanOptions& options, ForceField<Quad> forces);
template <class Real = double, class... Fs>
AnyHamiltonian<Real> wisdom_holman(const WisdomHolmanOptions& options, Fs... forces) {
  return wisdom_holman_over(options, field_of<Real>(std::move(forces)...));
}

/// A classical method over a force, or a field of them.
Classical<double> classical_over(ForceField<double> forces, const MethodChoice& choice);
Classical<Quad> classical_over(ForceField<Quad> forces, const MethodChoice& choice);
template <class F> Classical<double> classical_over(F force, const MethodChoice& choice) {
  return classical_over(field_of(std::move(force)), choice);
}

/// The settled particles after `steps` steps of `dt` of an integrator, without the machinery of a simulation.
template <class I>
ParticleSystem<typename I::real> run(I& integrator, ParticleSystem<typename I::real> s, double dt, std::int64_t steps,
                                     double start = 0) {
  s.clock() = Clock<typename I::real>::fixed(start, dt);
  integrator.bind(s);
  auto settled = s;
  integrator.advance(s, {.steps = steps});
  integrator.settle(s, settled, {}, std::nullopt, true);
  return settled;
}

/// The same with a scheme over a Hamiltonian.
template <class H>
ParticleSystem<typename H::real> run(const H& hamiltonian, const Scheme& scheme,
                                     const ParticleSystem<typename H::real>& s, double dt, std::int64_t steps,
                                     CompositionOptions options = {}) {
  Composition<H> integrator(hamiltonian, scheme, options);
  return run(integrator, s, dt, steps);
}

extern template ParticleSystem<double> run(Classical<double>&, ParticleSystem<double>, double, std::int64_t, double);
extern template ParticleSystem<Quad> run(Classical<Quad>&, ParticleSystem<Quad>, double, std::int64_t, double);
extern template ParticleSystem<double> run(const AnyHamiltonian<double>&, const Scheme&, const ParticleSystem<double>&,
                                           double, std::int64_t, CompositionOptions);
extern template ParticleSystem<Quad> run(const AnyHamiltonian<Quad>&, const Scheme&, const ParticleSystem<Quad>&,
                                         double, std::int64_t, CompositionOptions);

}  // namespace noether::test
