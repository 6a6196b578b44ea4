#pragma once
/// Is a force the gradient of its energy? Asked by differences, in extended precision where the force allows it.

#include "engine/any_force.hpp"
#include "engine/description.hpp"

namespace noether {

/// At how many particles `gradient_error` asks.
Index particles_asked(Index particles);

/// How far the force is from minus the gradient of the energy it reports: largest difference over largest force or
/// slope; of rigid bodies also how far torques are from minus the slopes of the energy as each turns, over the largest
/// one, where that is more. Infinite if any of them is not finite.
///
/// Of up to 64 particles in Quad (error of the differences about 1e-20) if the force is a template on the number type,
/// else in double (1e-7, near a cutoff that is not smooth).
/// @cost 18 force evaluations for each of `particles_asked`, 36 for a body
double gradient_error(const AnyForce<double>& force, const ParticleSystem<double>& s);

namespace detail {
/// @throws Error  if a force is not minus the gradient of the energy it reports
void check_gradient(const AnyForce<double>& force, const ParticleSystem<double>& s);
}  // namespace detail

/// @throws Error  if a force is not minus the gradient of the energy it reports, or its `check` refuses its fields
template <class F> void check_gradient(const F& force, const ParticleSystem<double>& s) {
  check_part(force);
  detail::check_gradient(force, s);
}

}  // namespace noether
