#pragma once
/// Potentials of bonds: from the square of the length to the energy and the force along the bond.

#include <array>
#include <cmath>

namespace noether::bond_potential {

/// A spring with a rest length.
///
///     U = k (r - length)^2 / 2
///
/// Some force fields leave out the half: their k is half of this one.
/// @throws never
/// @source Hooke1678
template <class Real> struct Harmonic {
  Real k;       ///< [energy/length^2]
  Real length;  ///< at rest [length]

  explicit Harmonic(const std::array<double, 6>& p) : k(p[0]), length(p[1]) {}

  /// -U'(r) / r; without rest length it has no kink at r = 0.
  Real force_over_r(const Real& r2) const {
    if (length == Real(0)) return -k;
    using std::sqrt;
    const Real r = sqrt(r2);
    return -k * (r - length) / r;
  }
  Real energy(const Real& r2) const {
    if (length == Real(0)) return k * r2 / Real(2);
    using std::sqrt;
    const Real stretch = sqrt(r2) - length;
    return k * stretch * stretch / Real(2);
  }
};

/// A bond that breaks.
///
///     U = depth (1 - exp(-a (r - length)))^2
///
/// @throws never
/// @source Morse1929
template <class Real> struct Morse {
  Real depth;   ///< energy to break the bond [energy]
  Real a;       ///< [1/length]; the spring at rest has k = 2 depth a^2
  Real length;  ///< at rest [length]

  explicit Morse(const std::array<double, 6>& p) : depth(p[0]), a(p[1]), length(p[2]) {}

  Real force_over_r(const Real& r2) const {
    using std::exp, std::sqrt;
    const Real r = sqrt(r2), e = exp(-a * (r - length));
    return -Real(2) * depth * a * e * (Real(1) - e) / r;
  }
  Real energy(const Real& r2) const {
    using std::exp, std::sqrt;
    const Real part = Real(1) - exp(-a * (sqrt(r2) - length));
    return depth * part * part;
  }
};

/// A spring that cannot be longer than `longest`, with the repulsion of beads.
///
///     U = - k longest^2 / 2 ln(1 - (r/longest)^2) + U_WCA(r)
///     U_WCA = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) + epsilon  below 2^(1/6) sigma, 0 above
///
/// From r = longest on there is no such bond: `holds` says so, energy and force are not to be asked for.
/// @throws never
/// @source KremerGrest1990
template <class Real> struct Fene {
  Real k;             ///< [energy/length^2]
  Real longest2;      ///< square of the longest bond [length^2]
  Real four_epsilon;  ///< [energy]
  Real sigma2;        ///< square of sigma [length^2]

  explicit Fene(const std::array<double, 6>& p)
      : k(p[0]),
        longest2(Real(p[1]) * Real(p[1])),
        four_epsilon(Real(4) * Real(p[2])),
        sigma2(Real(p[3]) * Real(p[3])) {}

  bool holds(const Real& r2) const { return r2 < longest2; }

  Real force_over_r(const Real& r2) const {
    const Real pull = k * longest2 / (r2 - longest2), inverse = Real(1) / r2, s6 = sixth_power(inverse);
    const Real push = Real(6) * four_epsilon * s6 * (Real(2) * s6 - Real(1)) * inverse;
    return pull + (s6 > Real(0.5) ? push : Real(0));  // no branch: nobody can foretell it
  }
  Real energy(const Real& r2) const {
    using std::log;
    const Real spring = -k * longest2 / Real(2) * log(Real(1) - r2 / longest2);
    const Real s6 = sixth_power(Real(1) / r2);
    if (!(s6 > Real(0.5))) return spring;
    return spring + four_epsilon * (s6 * (s6 - Real(1)) + Real(0.25));
  }

 private:
  /// (sigma/r)^6 from 1/r^2; 1/2 where the repulsion ends.
  Real sixth_power(const Real& inverse) const {
    const Real s2 = sigma2 * inverse;
    return s2 * s2 * s2;
  }
};

}  // namespace noether::bond_potential
