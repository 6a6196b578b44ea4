#pragma once
/// Charges under Weber's electrodynamics, by its Lagrangian.

#include "engine/description.hpp"
#include "engine/sums.hpp"
#include "integrators/systems/charges_in_space.hpp"
#include "integrators/variational/lagrangian_system.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// Any number of charges whose forces on each other depend on how fast their distances change.
///
///     L = sum_i m_i v_i^2 / 2 - sum_(i<j) (k e_i e_j / r) (1 + r'^2 / (2 c^2))
///
/// So masses depend on distances: along a pair the reduced mass mu is mu - k e_i e_j / (c^2 r), which is 0 for like
/// charges at r = k e_i e_j / (mu c^2). A run ends there by name. Energy, momentum and angular momentum are kept.
/// Coordinates are x, y, z of one charge after the other.
/// @source Assis1994
struct Weber {
  std::vector<double> masses = {2, 2};    ///< [mass]
  std::vector<double> charges = {1, -1};  ///< e_i, in units for which k is the factor of Coulomb's law
  std::vector<double> positions = {0.5, 0, 0, -0.5, 0, 0};   ///< shape (n, 3) [length]
  std::vector<double> velocities = {0, 0.4, 0, 0, -0.4, 0};  ///< shape (n, 3) [length/time]
  double k = 1;                                              ///< of Coulomb's law [energy length]
  double c = 5;                                              ///< [length/time]

  static constexpr auto describe() {
    return part<Weber>("weber", "charges under Weber's electrodynamics, by its Lagrangian",
                       formula("L = sum m v^2/2 - sum over pairs (k e e'/r) (1 + r'^2/(2 c^2))"), source("Assis1994"),
                       quantities("x, y, z of each charge [length], its momenta [mass length/time]"),
                       field<&Weber::masses>("masses", "mass", "of the charges"),
                       field<&Weber::charges>("charges", "1", "e of each"),
                       field<&Weber::positions>("positions", "length", "at the start, x, y, z of one after the other"),
                       field<&Weber::velocities>("velocities", "length/time", "at the start, likewise"),
                       field<&Weber::k>("k", "energy length", "factor of Coulomb's law"),
                       field<&Weber::c>("c", "length/time", "speed of light"));
  }
  /// @throws Error  as `check_charges`
  void check() const { check_charges(lists()); }

  Index size() const { return 3 * std::ssize(masses); }
  /// Positions and p = dL/dv.
  std::vector<double> start() const;
  std::vector<std::string> names() const { return names_of_charges(masses.size()); }
  std::vector<Symmetry> symmetries() const { return symmetries_of_charges(); }

  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    return sum_over<Real>(std::ssize(masses), [&](Index i) {
      const Vec3<Real> x = of_charge(q, i), w = of_charge(v, i);
      const Real of_pairs = sum_over<Real>(
          i, [&](Index j) { return pair(i, j, Vec3<Real>(x - of_charge(q, j)), Vec3<Real>(w - of_charge(v, j))); });
      return Real(masses[static_cast<std::size_t>(i)]) * norm2(w) / Real(2) - of_pairs;
    });
  }

  /// r'' of each pair, which the force contains; pair (i, j < i) is number i (i - 1)/2 + j.
  Index second_rates() const { return std::ssize(masses) * (std::ssize(masses) - 1) / 2; }
  /// r'' = (v^2 - r'^2 + x . a) / r.
  template <class Real>
  void find_second_rates(const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& a, Vector<Real>& w) const {
    for (Index i = 1, place = 0; i < std::ssize(masses); ++i) {
      for (Index j = 0; j < i; ++j, ++place) {
        const Vec3<Real> x = of_charge(q, i) - of_charge(q, j), u = of_charge(v, i) - of_charge(v, j),
                         b = of_charge(a, i) - of_charge(a, j);
        const PairPlace<Real> at = place_of_pair(x);
        const Real rate = dot(at.direction, u);
        w[place] = (norm2(u) - rate * rate) / at.distance + dot(at.direction, b);
      }
    }
  }
  /// Weber's force, (k e e'/r^2) (1 - r'^2/(2 c^2) + r r''/c^2) along each pair, over the masses.
  template <class Real>
  void acceleration_with(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v, const Vector<Real>& w,
                         Vector<Real>& a) const {
    const Real square(Real(c) * Real(c));
    a.setZero();
    for (Index i = 1, place = 0; i < std::ssize(masses); ++i) {
      for (Index j = 0; j < i; ++j, ++place) {
        const PairPlace<Real> at = place_of_pair(Vec3<Real>(of_charge(q, i) - of_charge(q, j)));
        const Real r = at.distance, rate = dot(at.direction, Vec3<Real>(of_charge(v, i) - of_charge(v, j)));
        const Real force = coupling<Real>(i, j) / (r * r) * (Real(1) + (r * w[place] - rate * rate / Real(2)) / square);
        a.template segment<3>(3 * i) += force * at.direction;
        a.template segment<3>(3 * j) -= force * at.direction;
      }
    }
    for (Index i = 0; i < std::ssize(masses); ++i)
      a.template segment<3>(3 * i) /= Real(masses[static_cast<std::size_t>(i)]);
  }

 private:
  ChargeLists lists() const { return {masses, charges, positions, velocities, k, c}; }
  template <class Real> Real coupling(Index i, Index j) const {
    return Real(k * charges[static_cast<std::size_t>(i)] * charges[static_cast<std::size_t>(j)]);
  }
  /// The summand of a pair, by where one is from the other, and by how fast that changes.
  template <class Real> Real pair(Index i, Index j, const Vec3<Real>& x, const Vec3<Real>& v) const {
    using std::sqrt;
    const Real square = norm2(x), along = dot(x, v), rate = Real(1) / (Real(2) * Real(c) * Real(c));
    return coupling<Real>(i, j) / sqrt(square) * (Real(1) + rate * along * along / square);
  }
};

// Its motion, compiled once: second derivatives of L are nested dual numbers.
extern template class LagrangianMotion<Weber, double>;
extern template class LagrangianMotion<Weber, Quad>;

}  // namespace noether
