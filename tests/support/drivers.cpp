#include "tests/support/drivers.hpp"

#include "constraints/constraint_solver.hpp"
#include "integrators/kinetic_potential.hpp"

#include <memory>

namespace noether::test {

namespace {

template <class Real> AnyHamiltonian<Real> kinetic(ForceField<Real> forces, const NeighborOptions& list) {
  KineticPotential<ForceField<Real>, Real> hamiltonian(std::move(forces));
  hamiltonian.set_neighbor_options(list);
  return hamiltonian;
}

template <class Real>
AnyHamiltonian<Real> held(ForceField<Real> forces, const ConstraintSet& constraints, const NeighborOptions& list) {
  KineticPotential<ForceField<Real>, Real, ConstraintSet> hamiltonian(std::move(forces), constraints);
  hamiltonian.set_neighbor_options(list);
  return hamiltonian;
}

}  // namespace

AnyHamiltonian<double> kinetic_potential_over(ForceField<double> forces, const NeighborOptions& list) {
  return kinetic(std::move(forces), list);
}
AnyHamiltonian<Quad> kinetic_potential_over(ForceField<Quad> forces, const NeighborOptions& list) {
  return kinetic(std::move(forces), list);
}
AnyHamiltonian<double> kinetic_potential_over(ForceField<double> forces, const ConstraintSet& constraints,
                                              const NeighborOptions& list) {
  return held(std::move(forces), constraints, list);
}
AnyHamiltonian<Quad> kinetic_potential_over(ForceField<Quad> forces, const ConstraintSet& constraints,
                                            const NeighborOptions& list) {
  return held(std::move(forces), constraints, list);
}

AnyHamiltonian<double> damped(AnyHamiltonian<double> hamiltonian, const LinearDrag& drag) {
  return Damped(std::move(hamiltonian), drag);
}
AnyHamiltonian<Quad> damped(AnyHamiltonian<Quad> hamiltonian, const LinearDrag& drag) {
  return Damped(std::move(hamiltonian), drag);
}
AnyHamiltonian<double> in_bath(ForceField<double> forces, const LangevinOptions& options) {
  return Langevin(kinetic_potential_over(std::move(forces)), options);
}
AnyHamiltonian<double> in_bath(ForceField<double> forces, const ConstraintSet& constraints,
                               const LangevinOptions& options) {
  return Langevin(kinetic_potential_over(std::move(forces), constraints), options);
}

AnyHamiltonian<double> wisdom_holman_over(const WisdomHolmanOptions& options, ForceField<double> forces) {
  return options.split(std::move(forces));
}
AnyHamiltonian<Quad> wisdom_holman_over(const WisdomHolmanOptions& options, ForceField<Quad> forces) {
  return options.split(std::move(forces));
}

Classical<double> classical_over(ForceField<double> forces, const MethodChoice& choice) {
  return {std::make_unique<ForceMotion<ForceField<double>, double>>(std::move(forces)), choice};
}
Classical<Quad> classical_over(ForceField<Quad> forces, const MethodChoice& choice) {
  return {std::make_unique<ForceMotion<ForceField<Quad>, Quad>>(std::move(forces)), choice};
}

template ParticleSystem<double> run(Classical<double>&, ParticleSystem<double>, double, std::int64_t, double);
template ParticleSystem<Quad> run(Classical<Quad>&, ParticleSystem<Quad>, double, std::int64_t, double);
template ParticleSystem<double> run(const AnyHamiltonian<double>&, const Scheme&, const ParticleSystem<double>&, double,
                                    std::int64_t, CompositionOptions);
template ParticleSystem<Quad> run(const AnyHamiltonian<Quad>&, const Scheme&, const ParticleSystem<Quad>&, double,
                                  std::int64_t, CompositionOptions);

}  // namespace noether::test
