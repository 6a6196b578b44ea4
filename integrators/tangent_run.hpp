#pragma once
/// The tangent flows of splittings and of classical methods, for monitors of chaos.

#include "engine/tangent_flow.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/scheme.hpp"
#include "integrators/varied_splitting.hpp"
#include "integrators/vector_field.hpp"
#include "integrators/wisdom_holman.hpp"

#include <memory>
#include <utility>

namespace noether {

namespace detail {

/// Forces of any type as a field of forces.
template <class Real, class F> ForceField<Real> field_of_forces(const F& forces) {
  if constexpr (std::is_same_v<F, ForceField<Real>>) {
    return forces;
  } else {
    ForceField<Real> all;
    if constexpr (requires { forces.for_each([](const auto&) {}); }) {
      forces.for_each([&](const auto& force) { all.add(force); });
    } else {
      all.add(forces);
    }
    return all;
  }
}

/// A flow of rows of points along a scheme.
template <class Real>
std::unique_ptr<TangentFlow<Real>> split_tangents(AnyHamiltonian<Real> varied, const Scheme& scheme,
                                                  const CompositionOptions& options, const ParticleSystem<Real>& s,
                                                  Index changes);

extern template std::unique_ptr<TangentFlow<double>> split_tangents(AnyHamiltonian<double>, const Scheme&,
                                                                    const CompositionOptions&,
                                                                    const ParticleSystem<double>&, Index);
extern template std::unique_ptr<TangentFlow<Quad>> split_tangents(AnyHamiltonian<Quad>, const Scheme&,
                                                                  const CompositionOptions&,
                                                                  const ParticleSystem<Quad>&, Index);

}  // namespace detail

/// Small changes of the steps of a scheme over p^2/2m and forces.
/// @throws Error  naming what has no derivative; SchemeMismatch for kernels
template <class F, class Real>
std::unique_ptr<TangentFlow<Real>> tangent_flow(const KineticPotential<F, Real>& hamiltonian, const Scheme& scheme,
                                                const ParticleSystem<Real>& s, Index changes = 1,
                                                const CompositionOptions& options = {}) {
  return detail::split_tangents<Real>(
      VariedMotion<Real>(detail::field_of_forces<Real>(hamiltonian.forces()), s, changes), scheme, options, s, changes);
}

/// The same of a Wisdom-Holman splitting.
/// @param s  the particles as the run begins: they order Jacobi coordinates
template <class Real, class F>
std::unique_ptr<TangentFlow<Real>> tangent_flow(WisdomHolman<Real, F> hamiltonian, const Scheme& scheme,
                                                const ParticleSystem<Real>& s, Index changes = 1,
                                                const CompositionOptions& options = {}) {
  ParticleSystem<Real> start = s;
  hamiltonian.bind(start);
  return detail::split_tangents<Real>(
      VariedPlanets<Real>(hamiltonian, detail::field_of_forces<Real>(hamiltonian.forces()), s, changes), scheme,
      options, s, changes);
}

/// The same of a Hamiltonian whose type is not known here.
/// @throws Error  naming one that is neither
std::unique_ptr<TangentFlow<double>> tangent_flow(const AnyHamiltonian<double>& hamiltonian, const Scheme& scheme,
                                                  const ParticleSystem<double>& s, Index changes = 1,
                                                  const CompositionOptions& options = {});

/// Small changes of the steps of a classical method over a field: its own derivative where the method is one of
/// Runge-Kutta's with steps of one length.
/// @throws Error  for a field without derivatives, for steps that the method chooses and for methods that remember
template <class Real>
std::unique_ptr<TangentFlow<Real>> tangent_flow(std::unique_ptr<VectorField<Real>> field, const MethodChoice& choice,
                                                const ParticleSystem<Real>& s, Index changes = 1);

extern template std::unique_ptr<TangentFlow<double>> tangent_flow(std::unique_ptr<VectorField<double>>,
                                                                  const MethodChoice&, const ParticleSystem<double>&,
                                                                  Index);
extern template std::unique_ptr<TangentFlow<Quad>> tangent_flow(std::unique_ptr<VectorField<Quad>>, const MethodChoice&,
                                                                const ParticleSystem<Quad>&, Index);

}  // namespace noether
