#pragma once
/// Charges under Darwin's Lagrangian: their electrodynamics to order 1/c^2.

#include "engine/description.hpp"
#include "engine/momentum_shares.hpp"
#include "engine/sums.hpp"
#include "integrators/systems/charges_in_space.hpp"
#include "integrators/variational/lagrangian_system.hpp"

#include <string>
#include <vector>

namespace noether {

/// Any number of charges, each in the fields of the others to order 1/c^2, with masses that grow with speed.
///
///     L = sum_i (m_i v_i^2 / 2 + m_i v_i^4 / (8 c^2))
///         - sum_(i<j) (k e_i e_j / r) (1 - (v_i . v_j + (v_i . n)(v_j . n)) / (2 c^2)),   n along the pair
///
/// Energy, momentum and angular momentum are kept, those of the field counted: p_i = dL/dv_i = m v (1 + v^2/(2 c^2)) +
/// sum_j (k e e'/(2 c^2 r)) (v' + n (n . v')), whose second part is the field's. Coordinates are x, y, z of one charge
/// after the other.
/// @source Darwin1920, Jackson1999
struct Darwin {
  std::vector<double> masses = {2, 2};    ///< [mass]
  std::vector<double> charges = {1, -1};  ///< e_i, in units for which k is the factor of Coulomb's law
  std::vector<double> positions = {0.5, 0, 0, -0.5, 0, 0};   ///< shape (n, 3) [length]
  std::vector<double> velocities = {0, 0.4, 0, 0, -0.4, 0};  ///< shape (n, 3) [length/time]
  double k = 1;                                              ///< of Coulomb's law [energy length]
  double c = 5;                                              ///< [length/time]

  static constexpr auto describe() {
    return part<Darwin>(
        "darwin", "charges in each other's fields to order 1/c^2, by Darwin's Lagrangian",
        formula("L = sum (m v^2/2 + m v^4/(8 c^2)) - sum over pairs (k e e'/r) (1 - (v . v' + "
                "(v . n)(v' . n))/(2 c^2))"),
        source("Darwin1920, Jackson1999"),
        quantities("x, y, z of each charge [length], its momenta [mass length/time]"),
        field<&Darwin::masses>("masses", "mass", "of the charges"),
        field<&Darwin::charges>("charges", "1", "e of each"),
        field<&Darwin::positions>("positions", "length", "at the start, x, y, z of one after the other"),
        field<&Darwin::velocities>("velocities", "length/time", "at the start, likewise; slower than c"),
        field<&Darwin::k>("k", "energy length", "factor of Coulomb's law"),
        field<&Darwin::c>("c", "length/time", "speed of light"));
  }
  /// @throws Error  as `check_charges` and `check_speeds`
  void check() const {
    check_charges(lists());
    check_speeds(lists());
  }

  Index size() const { return 3 * std::ssize(masses); }
  /// Positions and p = dL/dv.
  std::vector<double> start() const;
  std::vector<std::string> names() const { return names_of_charges(masses.size()); }
  std::vector<Symmetry> symmetries() const { return symmetries_of_charges(); }
  /// m v (1 + v^2/(2 c^2)) of the charges, what is left of p of the field.
  MomentumSharing momentum_sharing() const;

  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    const Real slow = Real(1) / (Real(2) * Real(c) * Real(c));
    return sum_over<Real>(std::ssize(masses), [&](Index i) {
      const Vec3<Real> x = of_charge(q, i), w = of_charge(v, i);
      const Real square = norm2(w);
      const Real of_pairs = sum_over<Real>(i, [&](Index j) {
        const PairPlace<Real> at = place_of_pair(Vec3<Real>(x - of_charge(q, j)));
        const Vec3<Real> u = of_charge(v, j);
        const Real moving = dot(w, u) + Real(dot(w, at.direction)) * Real(dot(u, at.direction));
        const Real coupling(k * charges[static_cast<std::size_t>(i)] * charges[static_cast<std::size_t>(j)]);
        return coupling / at.distance * (Real(1) - slow * moving);
      });
      return Real(masses[static_cast<std::size_t>(i)]) * square * (Real(1) + slow * square / Real(2)) / Real(2) -
             of_pairs;
    });
  }

 private:
  ChargeLists lists() const { return {masses, charges, positions, velocities, k, c}; }
  /// m v (1 + v^2/(2 c^2)) of each, shape (3 n).
  Vector<double> own_momenta(const Vector<double>& v) const;
};

extern template class LagrangianMotion<Darwin, double>;
extern template class LagrangianMotion<Darwin, Quad>;

}  // namespace noether
