#pragma once
/// What systems of point charges in space have in common: lists of their fields, symmetries, and their field's
/// momentum.

#include "engine/momentum_shares.hpp"
#include "engine/symmetry.hpp"
#include "integrators/vector_field.hpp"

#include <string>
#include <vector>

namespace noether {

/// The fields of a system of charges, as its struct has them; coordinates are x, y, z of one charge after the other.
struct ChargeLists {
  const std::vector<double>&masses, &charges, &positions, &velocities;
  double k, c;

  std::size_t count() const { return masses.size(); }
};

/// @throws Error  for lists of different lengths, masses and speeds of light that are not above 0, and two charges at
///   one place
void check_charges(const ChargeLists& of);
/// @throws Error  for a charge that is not slower than light
void check_speeds(const ChargeLists& of);

/// "x_1" to "z_n", then "p_x_1" to "p_z_n".
std::vector<std::string> names_of_charges(std::size_t count);
/// "translation_x" to "translation_z", whose momenta are those of the whole, and "rotation_x" to "rotation_z", whose
/// momenta are the angular momentum about the origin.
std::vector<Symmetry> symmetries_of_charges();

/// Charge `i` of coordinates, or of what else stands in their order.
template <class Real> Vec3<Real> of_charge(const Vector<Real>& all, Index i) {
  return {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
}
Vec3<double> of_charge(const std::vector<double>& all, std::size_t i);

/// Where one charge of a pair is from the other.
template <class Real> struct PairPlace {
  Real distance;
  Vec3<Real> direction;
};
template <class Real> PairPlace<Real> place_of_pair(const Vec3<Real>& x) {
  using std::sqrt;
  const Real r = sqrt(norm2(x));
  return {r, Vec3<Real>(x / r)};
}

/// The momentum of the fields that a charge would have of those that move with v: e A/c in Coulomb's gauge, Darwin's
///
///     (k e e'/(2 c^2 r)) (v' + n (n . v'))
/// @param coupling  k e e'
/// @param velocity  of the other charge
template <class Real>
Vec3<Real> potential_momentum(const PairPlace<Real>& at, const Real& coupling, const Real& c,
                              const Vec3<Real>& velocity) {
  const Vec3<Real> both = velocity + Real(dot(at.direction, velocity)) * at.direction;
  return Real(coupling / (Real(2) * c * c * at.distance)) * both;
}

/// Momenta of charges that move with v and have momenta of their own, and those of their fields.
/// @param q, v  shape (3 n)
/// @param own   m v, or what a charge alone has of it; shape (3 n)
MomentumShares shares_of_charges(const ChargeLists& of, const Vector<double>& q, const Vector<double>& v,
                                 const Vector<double>& own);

}  // namespace noether
