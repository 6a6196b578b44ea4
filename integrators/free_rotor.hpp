#pragma once
/// The free turn of a rigid body: exactly, by Jacobi's elliptic functions, or axis by axis.

#include "engine/bodies.hpp"
#include "engine/description.hpp"
#include "numbers/pack.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace noether {

/// How bodies turn in the flow A.
enum class Rotor : std::uint8_t {
  exact,       ///< the exact flow of sum Pi_k^2/2 I_k
  axes,        ///< flows of its three terms in a palindrome: a symmetric map of order 2
  variational  ///< the discrete rigid body of Moser and Veselov: a symmetric map of order 2, see variational_rotor.hpp
};

/// A body's orientation after a flow, and the action of the flow, int sum Pi_k^2/2 I_k dt [energy time].
template <class Real> struct Turned {
  Quaternion<Real> orientation;
  Real action;
};

/// The exact free turn for the time `h` of a body of any moments, for any angle.
///
/// With S the angular momentum in space, which stays, and m = R^T S/L, the axis of the body about which m circles being
/// the third (that of the largest or of the smallest moment, turned so that m_3 > 0),
///
///     m(h) = (a_1 cn, a_2 sn, a_3 dn)(u_0 + lambda h),    R(h) = R(0) P(m(0))^T R_3(psi) P(m(h))
///     psi  = L h/I_3 + (I_3 - I_1) L/(I_1 I_3 lambda) int_(u_0)^(u_0 + lambda h) dw/(1 - n sn^2 w) - (the angle of
///            (m_1, m_2)),  P(m) the smallest rotation of m onto the third axis
///
/// Nothing is inverted: addition theorems of the functions and of the integral of the third kind start from m itself.
/// Bodies of two equal moments, of three, and in a line have closed forms; a body without spin does not turn. Errors
/// are some units in the last place of the angle. In lanes (numbers/pack.hpp) each body turns by itself; dual numbers
/// carry the derivatives.
/// @param spin  in space [mass length^2/time]
/// @param inertia  principal moments [mass length^2]; 0 0 0 of a point, which stays
/// @cost some 0.3 us; a quarter turn and more within `h` one integral more
/// @source CelledoniFassoSafstromZanna2008, VanZonSchofield2007, Carlson1995
template <class Real>
Turned<Real> turn_exactly(const Quaternion<Real>& q, const Vec3<Real>& spin, const Vec3<Real>& inertia, const Real& h);

/// The order of axes of a palindrome: the first two for half a step, the third for a whole one, and back.
using AxisOrder = std::array<int, 3>;

/// The turn of a body axis by axis, e.g. x y z y x: each axis k turns the body by h_k Pi_k/I_k about itself.
/// @cost five sines and cosines
/// @source DullweberLeimkuhlerMcLachlan1997, Miller2002
template <class Real>
Turned<Real> turn_by_axes(const Quaternion<Real>& q, const Vec3<Real>& spin, const Vec3<Real>& inertia, const Real& h,
                          const AxisOrder& order);

/// The same of the bodies [begin, end), `begin` a multiple of 8, with the same bits; a point stays. In packs, the
/// bodies of eight systems go in lanes where all have one `h`.
/// @param action  of each turn, shape (n), n rounded up to a multiple of 8
/// @cost of doubles in lanes some 15 ns a body where none turns by more than a right angle about an axis at a time
template <class Real>
void turn_all_by_axes(RowColumn<Real, 4>& orientation, const VectorColumn<Real>& spin,
                      const VectorColumn<Real>& inertia, const Real& h, const AxisOrder& order, Index begin, Index end,
                      ScalarColumn<Real>& action);

/// Reads "xyz", "zyx" and the other orders. @throws Error
AxisOrder axis_order(const std::string& text);

// All are compiled once, for double, Quad, Pack, Dual<double, 1> and Dual<Quad, 1>.
template <>
Turned<Pack> turn_exactly(const Quaternion<Pack>& q, const Vec3<Pack>& spin, const Vec3<Pack>& inertia, const Pack& h);
template <>
Turned<Pack> turn_by_axes(const Quaternion<Pack>& q, const Vec3<Pack>& spin, const Vec3<Pack>& inertia, const Pack& h,
                          const AxisOrder& order);

}  // namespace noether
