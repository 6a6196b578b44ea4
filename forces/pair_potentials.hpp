#pragma once
/// Potentials between pairs that are not bonded: each a short struct for PairForce.

#include "engine/any_force.hpp"
#include "forces/pair_force.hpp"

#include <cmath>
#include <limits>
#include <optional>

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
                     source("Weeks1971"),
                     field<&Wca::epsilon>("epsilon", "energy", "depth for all pairs").required("1"),
                     field<&Wca::sigma>("sigma", "length", "length for all pairs").required("1"));
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
                           field<&MorsePair::depth>("depth", "energy", "depth of the well").required("1"),
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
                            field<&Buckingham::A>("A", "energy", "strength of the repulsion").required("1000"),
                            field<&Buckingham::rho>("rho", "length", "range of the repulsion").required("0.3"),
                            field<&Buckingham::C>("C", "energy*length^6", "strength of the dispersion").required("1"));
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

/// Lennard-Jones of one kind of pair, to be fused with others (forces/fused_pair.hpp): alone, LennardJonesForce is
/// quicker and knows types.
///
///     U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6)
///
/// @source LennardJones1931
struct LennardJonesPair {
  double epsilon = 0;  ///< [energy]
  double sigma = 0;    ///< [length]

  void check() const;
  double scale() const { return 24 * epsilon / sigma; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real inverse2 = Real(1) / r2, s2 = Real(sigma * sigma) * inverse2, s6 = s2 * s2 * s2;
    return {Real(4 * epsilon) * s6 * (s6 - Real(1)), Real(24 * epsilon) * s6 * (Real(2) * s6 - Real(1)) * inverse2};
  }
};

/// Charges in a cavity within a dielectric, which answers to them.
///
///     U = C q_i q_j (1/r + k r^2 - 1/radius - k radius^2)  for r < radius, 0 above
///     k radius^3 = (dielectric - 1) / (2 dielectric + 1)
///
/// C is the factor of Coulomb's law in the units of the particles. Within a conductor forces are continuous at the
/// radius; else they jump there. With a switch, that of Cutoff::switch_c4, four derivatives of the energy are
/// continuous: without one each pair that crosses the radius takes a little of the energy, and liquids cool. Excluded
/// pairs feel neither their charges nor what the dielectric answers; scaled pairs both, scaled. With `answers_excluded`
/// the dielectric answers to all charges, as in GROMACS: excluded pairs nearer than the radius have
/// C q_i q_j (k r^2 - 1/radius - k radius^2), of scaled pairs only 1/r is scaled, and each charge has half of that of a
/// pair at no distance, a constant.
/// @source Tironi1995
struct ReactionField {
  double radius = 0;                      ///< of the cavity [length]
  std::optional<double> dielectric = {};  ///< relative permittivity outside; default: a conductor, where it is infinite
  std::optional<double> switched_from = {};  ///< where a switch begins [length]; default: there is none
  bool answers_excluded = false;             ///< the dielectric answers to excluded pairs and to each charge itself too
  PairPrecision precision = PairPrecision::full;  ///< of forces; energies are those of doubles

  static constexpr auto describe() {
    return part<ReactionField>(
        "reaction_field", "charges in a cavity within a dielectric",
        formula("U = C q_i q_j (1/r + k r^2 - 1/cutoff - k cutoff^2), k cutoff^3 = (dielectric - 1) / (2 dielectric + "
                "1), r < cutoff; from switch_from on times the polynomial of switch_c4"),
        source("Tironi1995"), field<&ReactionField::radius>("cutoff", "length", "radius of the cavity").required("1"),
        field<&ReactionField::dielectric>("dielectric", "1", "relative permittivity outside; default: a conductor"),
        field<&ReactionField::switched_from>("switch_from", "length",
                                             "where a switch as that of switch_c4 begins; default: there is none"),
        field<&ReactionField::answers_excluded>(
            "answers_excluded", "1",
            "the dielectric answers to excluded pairs and each charge itself too, as in GROMACS"),
        field<&ReactionField::precision>("precision", "1", "mixed: forces of pairs in single precision"));
  }
  void check() const;
  double range() const { return radius; }
  double scale(double product) const { return 100 * product / (radius * radius); }  // at a tenth of the radius
  ChargeSeries series() const {
    const double k = answer(), range2 = radius * radius,
                 from2 = switched_from.value_or(radius) * switched_from.value_or(radius);
    ChargeSeries series{.range2 = range2, .energy_terms = 2, .force_terms = 1};
    series.energy[0] = -1 / radius - k * range2;
    series.energy[1] = k;
    series.force[0] = -2 * k;
    if (range2 > from2) series.switch_from2 = from2, series.switch_inverse = 1 / (range2 - from2);
    return series;
  }
  template <class Real> PairTerms<Real> operator()(const Real& r2, const Real& product) const {
    using std::sqrt;
    const double k = answer(), last = 1 / radius + k * radius * radius;
    const Real inverse = Real(1) / sqrt(r2);
    return off({product * (inverse + Real(k) * r2 - Real(last)), product * (inverse * inverse * inverse - Real(2 * k))},
               r2);
  }
  /// The same without the charges' own 1/r.
  template <class Real> PairTerms<Real> answer_terms(const Real& r2, const Real& product) const {
    const double k = answer(), last = 1 / radius + k * radius * radius;
    return off({product * (Real(k) * r2 - Real(last)), -product * Real(2 * k)}, r2);
  }

 private:
  template <class Real> [[gnu::always_inline]] PairTerms<Real> off(const PairTerms<Real>& bare, const Real& r2) const {
    // Without a switch one that begins at the end: a branch would keep loops from going in lanes.
    const double range2 = radius * radius, from = switched_from.value_or(radius), from2 = from * from;
    const double width = range2 - from2;
    return detail::switched(bare, Cutoff::switch_c4, from2, width > 0 ? 1 / width : 0, r2);
  }
  /// k [1/length^3].
  double answer() const {
    const double inverse = 1 / dielectric.value_or(std::numeric_limits<double>::infinity());
    return (1 - inverse) / (2 + inverse) / (radius * radius * radius);
  }
};

using WcaForce = PairForce<Wca>;
using MorseForce = PairForce<MorsePair>;
using BuckinghamForce = PairForce<Buckingham>;
using ReactionFieldForce = PairForce<ReactionField>;

namespace detail {  // compiled once, in pair_potentials.cpp

extern template struct ForceModel<WcaForce, double>;
extern template struct ForceModel<WcaForce, Quad>;
extern template struct ForceModel<MorseForce, double>;
extern template struct ForceModel<MorseForce, Quad>;
extern template struct ForceModel<BuckinghamForce, double>;
extern template struct ForceModel<BuckinghamForce, Quad>;
extern template struct ForceModel<ReactionFieldForce, double>;
extern template struct ForceModel<ReactionFieldForce, Quad>;

}  // namespace detail

}  // namespace noether
