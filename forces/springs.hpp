#pragma once
/// Springs with a rest length: between pairs of particles, and from a point to particles.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/tied.hpp"
#include "forces/secant.hpp"

#include <array>
#include <cmath>

namespace noether {

namespace detail {
/// Energy and force over distance of a spring; without rest length it has no kink at r = 0.
template <class Real> PairTerms<Real> spring_terms(const Real& r2, const Real& k, const Real& length) {
  using std::sqrt;
  if (length == Real(0)) return {k * r2 / Real(2), -k};
  const Real distance = sqrt(r2), stretch = distance - length;
  return {k * stretch * stretch / Real(2), -k * stretch / distance};
}

inline void check_length(double length) {
  if (!(length >= 0)) refuse_field("length", length, "is not a valid rest length; 0 or more is expected");
}
}  // namespace detail

/// Springs between pairs of particles: the bonds of a flexible molecule, links of a chain.
///
///     U = sum over pairs k (|x_i - x_j| - length)^2 / 2
///
/// Some force fields leave out the half: their k is half of this one. A bond that turns has a frequency of
/// sqrt(k/mu) along itself, with 1/mu = 1/m_i + 1/m_j. Two particles of a pair in one place have no direction: unless
/// the rest length is 0 the force is not finite there. In a periodic box the nearest image counts: springs are to stay
/// shorter than half of it.
/// @cost one square root per pair
/// @source Hooke1678
struct HarmonicBond {
  double k = 0.0;                              ///< [mass/time^2]
  double length = 0.0;                         ///< at rest [length]
  Tied<2> tied{};                              ///< pairs of particles, by their places at first; shape (bonds, 2)
  static constexpr std::size_t particles = 2;  ///< that each bond ties

  static constexpr auto describe() {
    return part<HarmonicBond>(
        "harmonic_bond", "springs between pairs of particles",
        formula("U = sum over pairs k (|x_i - x_j| - length)^2 / 2"), source("Hooke1678"),
        field<&HarmonicBond::k>("k", "mass/time^2", "stiffness of each spring").required("\"1 kg/s^2\""),
        field<&HarmonicBond::length>("length", "length", "length at rest"));
  }
  static ForceClaims claims() {
    return {.periodic = true, .charges = false, .exclusions = false, .tangent = TangentPattern::sparse};
  }

  /// @throws Error  for a negative length
  void check() const { detail::check_length(length); }
  /// @throws Error  if a tied particle is not there
  template <class Real> void check(const ParticleSystem<Real>& s) const { tied.find(s); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (const auto& [i, j] : tied) {
      const Vec3<Real> r = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
      const PairTerms<Real> spring = terms<Real>(norm2(r));
      out.pair(i, j, Vec3<Real>(spring.force * r));
      if (out.wants_energy()) out.energy(spring.energy);
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    Secants<Real> secants(out, from, to);
    for (const auto& [i, j] : tied) {
      secants.pair({.i = i, .j = j}, [&](const Real& r2) { return terms<Real>(r2); });
    }
  }

 private:
  template <class Real> PairTerms<Real> terms(const Real& r2) const {
    return detail::spring_terms(r2, Real(k), Real(length));
  }
};

/// Springs from a point that stands still to particles: the spring of an elastic pendulum, a restraint.
///
///     U = sum over tied particles k (|x_i - point| - length)^2 / 2
///
/// In a periodic box every image of the point holds what is nearest to it. Walls and restraints are no part of the
/// pressure: there is no virial.
/// @cost one square root per particle
/// @source Hooke1678
struct Tether {
  std::array<double, 3> point = {0, 0, 0};     ///< [length]
  double k = 0.0;                              ///< [mass/time^2]
  double length = 0.0;                         ///< at rest [length]
  Tied<1> tied{};                              ///< particles, by their places at first; shape (springs, 1)
  static constexpr std::size_t particles = 1;  ///< that each spring ties

  static constexpr auto describe() {
    return part<Tether>("tether", "springs from a fixed point to particles",
                        formula("U = sum over bodies k (|x_i - point| - length)^2 / 2"), source("Hooke1678"),
                        field<&Tether::point>("point", "length", "the fixed point where the springs end"),
                        field<&Tether::k>("k", "mass/time^2", "stiffness of each spring").required("\"1 kg/s^2\""),
                        field<&Tether::length>("length", "length", "length at rest"));
  }
  ForceClaims claims() const {
    return {.virial = false,
            .keeps_momentum = false,
            .keeps_angular_momentum = point == std::array<double, 3>{},
            .periodic = true,
            .charges = false,
            .exclusions = false,
            .tangent = TangentPattern::sparse};
  }

  /// @throws Error  for a negative length
  void check() const { detail::check_length(length); }
  /// @throws Error  if a tied particle is not there
  template <class Real> void check(const ParticleSystem<Real>& s) const { tied.find(s); }

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Vec3<Real> end = {Real(point[0]), Real(point[1]), Real(point[2])};
    for (const auto& [i] : tied) {
      const Vec3<Real> r = s.box().minimum_image(Vec3<Real>(s.positions()[i] - end));
      const PairTerms<Real> spring = terms<Real>(norm2(r));
      out.force(i, Vec3<Real>(spring.force * r));
      if (out.wants_energy() && s.masses()[i] != Real(0)) out.energy(spring.energy);
    }
  }
  /// Its secants between two states.
  template <class Real>
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const {
    const Vec3<Real> end = {Real(point[0]), Real(point[1]), Real(point[2])};
    Secants<Real> secants(out, from, to);
    for (const auto& [i] : tied) secants.tether(i, end, [&](const Real& r2) { return terms<Real>(r2); });
  }

 private:
  template <class Real> PairTerms<Real> terms(const Real& r2) const {
    return detail::spring_terms(r2, Real(k), Real(length));
  }
};

namespace detail {  // compiled once, in springs.cpp

extern template struct ForceModel<HarmonicBond, double>;
extern template struct ForceModel<HarmonicBond, Quad>;
extern template struct ForceModel<Tether, double>;
extern template struct ForceModel<Tether, Quad>;

}  // namespace detail

}  // namespace noether
