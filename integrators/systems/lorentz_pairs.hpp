#pragma once
/// Charges in each other's instantaneous fields, Coulomb's and that of Biot and Savart.

#include "engine/description.hpp"
#include "engine/momentum_shares.hpp"
#include "engine/sums.hpp"
#include "integrators/systems/charges_in_space.hpp"
#include "integrators/variational/lagrangian_system.hpp"

#include <string>
#include <vector>

namespace noether {

/// Any number of charges under Lorentz's force, each in the fields that the others have at the same time.
///
///     m_i v_i' = e_i (E + v_i x B),   E = sum_j k e_j n / r^2,   B = sum_j k e_j v_j x n / (c^2 r^2)
///
/// B does no work, so the energy sum m v^2/2 + sum k e e'/r is kept. Action is not reaction: neither the momentum of
/// the charges nor their angular momentum is kept. What is missing went into the field, whose momentum the monitor
/// `field_momentum` tells; the fields that induction would add, which `darwin` has, bring it back. Coordinates are x,
/// y, z of one charge after the other, and their momenta m v.
/// @source Jackson1999
struct LorentzPairs {
  std::vector<double> masses = {1, 1};    ///< [mass]
  std::vector<double> charges = {1, -1};  ///< e_i, in units for which k is the factor of Coulomb's law
  std::vector<double> positions = {0.5, 0, 0, -0.5, 0, 0};       ///< shape (n, 3) [length]
  std::vector<double> velocities = {0, 0.6, 0.2, 0.2, -0.6, 0};  ///< shape (n, 3) [length/time]
  double k = 1;                                                  ///< of Coulomb's law [energy length]
  double c = 5;                                                  ///< [length/time]
  static constexpr bool workless = true;

  static constexpr auto describe() {
    return part<LorentzPairs>(
        "lorentz_pairs",
        "charges under Lorentz's force in each other's fields, without retardation; the field takes momentum from them",
        formula("m v' = e (E + v x B), E = sum k e' n/r^2, B = sum k e' v' x n/(c^2 r^2)"), source("Jackson1999"),
        quantities("x, y, z of each charge [length], its momenta m v [mass length/time]"),
        field<&LorentzPairs::masses>("masses", "mass", "of the charges"),
        field<&LorentzPairs::charges>("charges", "1", "e of each"),
        field<&LorentzPairs::positions>("positions", "length", "at the start, x, y, z of one after the other"),
        field<&LorentzPairs::velocities>("velocities", "length/time", "at the start, likewise; slower than c"),
        field<&LorentzPairs::k>("k", "energy length", "factor of Coulomb's law"),
        field<&LorentzPairs::c>("c", "length/time", "speed of light"));
  }
  /// @throws Error  as `check_charges` and `check_speeds`
  void check() const {
    check_charges(lists());
    check_speeds(lists());
  }

  Index size() const { return 3 * std::ssize(masses); }
  /// Positions and m v.
  std::vector<double> start() const;
  std::vector<std::string> names() const { return names_of_charges(masses.size()); }
  /// Those of Coulomb's forces; those of Biot and Savart change their momenta.
  std::vector<Symmetry> symmetries() const { return symmetries_of_charges(); }
  MomentumSharing momentum_sharing() const;

  /// Of Coulomb's forces.
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::sqrt;
    return sum_over<Real>(std::ssize(masses), [&](Index i) {
      const Vec3<Real> x = of_charge(q, i), w = of_charge(v, i);
      const Real of_pairs = sum_over<Real>(
          i, [&](Index j) { return coupling<Real>(i, j) / sqrt(norm2(Vec3<Real>(x - of_charge(q, j)))); });
      return Real(masses[static_cast<std::size_t>(i)]) * norm2(w) / Real(2) - of_pairs;
    });
  }
  /// e v x B.
  template <class Real>
  void force(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v, Vector<Real>& f) const {
    const Real slow = Real(1) / (Real(c) * Real(c));
    for (Index i = 0; i < std::ssize(masses); ++i) {
      for (Index j = 0; j < std::ssize(masses); ++j) {
        if (j == i) continue;
        const PairPlace<Real> at = place_of_pair(Vec3<Real>(of_charge(q, i) - of_charge(q, j)));
        const Real strength = slow * coupling<Real>(i, j) / (at.distance * at.distance);
        const Vec3<Real> along = cross(of_charge(v, j), at.direction), push = cross(of_charge(v, i), along);
        for (int d = 0; d < 3; ++d) f[3 * i + d] = f[3 * i + d] + strength * push[d];
      }
    }
  }

 private:
  ChargeLists lists() const { return {masses, charges, positions, velocities, k, c}; }
  template <class Real> Real coupling(Index i, Index j) const {
    return Real(k * charges[static_cast<std::size_t>(i)] * charges[static_cast<std::size_t>(j)]);
  }
};

extern template class LagrangianMotion<LorentzPairs, double>;
extern template class LagrangianMotion<LorentzPairs, Quad>;

}  // namespace noether
