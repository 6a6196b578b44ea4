#pragma once
/// Potentials between pairs that are not bonded: each a short struct for PairForce.

#include "forces/pair_force.hpp"

#include <cmath>

namespace noether {

/// Repulsion alone: Lennard-Jones up to its minimum, lifted to end there at zero.
///
///     U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) + epsilon  below 2^(1/6) sigma, 0 above
///
/// @source Weeks1971
struct Wca {
  double epsilon = 0;  ///< [energy]
  double sigma = 0;    ///< [length]

  static constexpr auto describe() {
    return part<Wca>("wca", "the repulsive half of Lennard-Jones",
                     formula("U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) + epsilon, r < 2^(1/6) sigma"),
                     source("Weeks1971"), field<&Wca::epsilon>("epsilon", "energy", "of all pairs").required("1"),
                     field<&Wca::sigma>("sigma", "length", "of all pairs").required("1"));
  }
  void check() const;
  double scale() const { return 24 * epsilon / sigma; }
  double range() const { return std::cbrt(std::sqrt(2.0)) * sigma; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real inverse2 = Real(1) / r2, s2 = Real(sigma * sigma) * inverse2, s6 = s2 * s2 * s2;
    return {Real(4 * epsilon) * (s6 * (s6 - Real(1)) + Real(0.25)),
            Real(24 * epsilon) * s6 * (Real(2) * s6 - Real(1)) * inverse2};
  }
};

/// A well with a soft core.
///
///     U = depth ((1 - exp(-a (r - length)))^2 - 1)
///
/// @source Morse1929
struct MorsePair {
  double depth = 0;   ///< of the well [energy]
  double a = 0;       ///< inverse width [1/length]
  double length = 0;  ///< where the well is deepest [length]

  static constexpr auto describe() {
    return part<MorsePair>("morse", "a well with a soft core, between pairs that are not bonded",
                           formula("U = depth ((1 - exp(-a (r - length)))^2 - 1), r < cutoff"), source("Morse1929"),
                           field<&MorsePair::depth>("depth", "energy", "of the well").required("1"),
                           field<&MorsePair::a>("a", "1/length", "inverse width of the well").required("2"),
                           field<&MorsePair::length>("length", "length", "where the well is deepest").required("1"));
  }
  void check() const;
  double scale() const { return 8 * depth * a; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    using std::sqrt;
    const Real r = sqrt(r2), e = pair_exp(Real(-a) * (r - Real(length)));
    return {Real(depth) * e * (e - Real(2)), Real(2 * depth * a) * e * (e - Real(1)) / r};
  }
};

/// Exponential repulsion and dispersion.
///
///     U = A exp(-r / rho) - C / r^6
///
/// Within its barrier the attraction wins and particles fall into each other: pairs nearer than the barrier's top end
/// the run.
/// @source Buckingham1938
struct Buckingham {
  double A = 0;    ///< [energy]
  double rho = 0;  ///< [length]
  double C = 0;    ///< [energy length^6]

  static constexpr auto describe() {
    return part<Buckingham>("buckingham", "exponential repulsion and dispersion",
                            formula("U = A exp(-r/rho) - C / r^6, r < cutoff"), source("Buckingham1938"),
                            field<&Buckingham::A>("A", "energy", "of the repulsion").required("1000"),
                            field<&Buckingham::rho>("rho", "length", "of the repulsion").required("0.3"),
                            field<&Buckingham::C>("C", "energy*length^6", "of the dispersion").required("1"));
  }
  /// @throws Error  for a potential without a barrier, which attracts at every distance
  void check() const;
  double scale() const { return A / rho * std::exp(-5.0); }  // at five rho: nearer than pairs touch
  /// Top of the barrier; 0 without dispersion [length].
  double nearest() const;
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    using std::sqrt;
    const Real r = sqrt(r2), inverse2 = Real(1) / r2, inverse6 = inverse2 * inverse2 * inverse2;
    const Real repulsion = Real(A) * pair_exp(-r / Real(rho));
    return {repulsion - Real(C) * inverse6, repulsion / (Real(rho) * r) - Real(6 * C) * inverse6 * inverse2};
  }
};

using WcaForce = PairForce<Wca>;
using MorseForce = PairForce<MorsePair>;
using BuckinghamForce = PairForce<Buckingham>;

}  // namespace noether
