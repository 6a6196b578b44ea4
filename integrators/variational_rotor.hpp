#pragma once
/// The free turn of a rigid body by a discrete action: the body of Moser and Veselov.

#include "engine/bodies.hpp"
#include "engine/outcome.hpp"
#include "integrators/free_rotor.hpp"

#include <optional>

namespace noether {

/// The turn of a body by which the discrete action
///
///     T(F) = tr((1 - F) J_d)/h,   J_d = tr(I)/2 - I,   F = R(0)^T R(h)
///
/// is stationary along a way of many turns, with S fixed in space: h hat(Pi) = F J_d - J_d F^T. With the quaternion
/// (w, z) of F this is
///
///     w I z + z x I z = h Pi/2,   w = sqrt(1 - |z|^2),   T = 2 z^T I z/h
///
/// Newton's method solves it for z, from the turn of 0 on. About a principal axis a body turns by arcsin(h omega) a
/// step: it lags behind, and from h omega = 1 on there is no turn.
/// @param spin  in space [mass length^2/time]
/// @param inertia  principal moments [mass length^2]; 0 0 0 of a point, which stays
/// @return empty where there is no solution that begins with the turn of 0
/// @cost some four steps of Newton's method on three unknowns
/// @source MoserVeselov1991, LeeLeokMcClamroch2005
template <class Real>
std::optional<Turned<Real>> turn_variationally(const Quaternion<Real>& q, const Vec3<Real>& spin,
                                               const Vec3<Real>& inertia, const Real& h);

/// The same of all bodies of a system.
/// @param action  of each turn, shape (n) or more
/// @return that of the first body that has no solution, which stays
template <class Real>
std::optional<Failure> turn_all_variationally(ParticleSystem<Real>& s, const Real& h, ScalarColumn<Real>& action);

extern template std::optional<Turned<double>> turn_variationally(const Quaternion<double>&, const Vec3<double>&,
                                                                 const Vec3<double>&, const double&);
extern template std::optional<Turned<Quad>> turn_variationally(const Quaternion<Quad>&, const Vec3<Quad>&,
                                                               const Vec3<Quad>&, const Quad&);
extern template std::optional<Failure> turn_all_variationally(ParticleSystem<double>&, const double&,
                                                              ScalarColumn<double>&);
extern template std::optional<Failure> turn_all_variationally(ParticleSystem<Quad>&, const Quad&, ScalarColumn<Quad>&);

}  // namespace noether
