#pragma once
/// What sums over a periodic lattice of charges share: the split of 1/r, the near part, and what is not of pairs.
///
///     1/r = erfc(alpha r)/r + erf(alpha r)/r
///
/// The first part ends at a cutoff; the second, smooth one is summed over waves, for all pairs and of each charge with
/// itself. Out of it are taken each charge with itself, and what the topology excludes or scales.

#include "engine/charge.hpp"
#include "engine/sums.hpp"
#include "forces/pair_force.hpp"
#include "numbers/exact_sum.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace noether::detail {

/// erfc(x) and exp(-x^2).
template <class Real> struct ErfcTerms { Real erfc, bell; };

/// Of x >= 0; doubles without a branch or a call, so that loops go in lanes: 4 ulp up to x = 7, and nothing to speak of
/// (5e-23) beyond.
template <class Real> ErfcTerms<Real> erfc_terms(const Real& x) {
  using std::erfc, std::exp;
  return {erfc(x), exp(-x * x)};
}
template <> inline ErfcTerms<double> erfc_terms(const double& x) {
  // (1 + 2 x) exp(x^2) erfc(x) is a polynomial of (x - 3)/(x + 3): that through its values at 21 points of Chebyshev.
  const double inside = x < 7 ? x : 7, two = 1 + 2 * inside, sum = inside + 3, inverse = 1 / (two * sum);
  const double s = (inside - 3) * two * inverse;
  double p = -2.4823595177919336e-09;
  p = p * s - 5.984498247609908e-08;
  p = p * s - 3.4608184976620009e-07;
  p = p * s - 7.0997950099581232e-07;
  p = p * s + 4.0227387703359258e-07;
  p = p * s + 3.5442656023771626e-06;
  p = p * s - 7.1123871465716882e-07;
  p = p * s - 2.0112816153526791e-05;
  p = p * s + 4.9407596160214945e-06;
  p = p * s + 0.00012509926409964121;
  p = p * s - 0.00010515852434235054;
  p = p * s - 0.00077983203876808233;
  p = p * s + 0.001888690272324194;
  p = p * s + 0.0025293917898548688;
  p = p * s - 0.023770514916003842;
  p = p * s + 0.068308027345183375;
  p = p * s - 0.1192736634153337;
  p = p * s + 0.12964515870273813;
  p = p * s - 0.047562294353450822;
  p = p * s - 0.13562110612458106;
  p = p * s + 1.2530080582697296;
  const double bell = pair_exp(-x * x);
  return {bell * (p * (sum * inverse)), bell};
}

/// The smooth part of 1/r and of its force over r, also at r = 0.
template <class Real> PairTerms<Real> smooth_terms(double alpha, const Real& r2) {
  using std::sqrt, std::atan;
  const Real root_pi = Real(2) * sqrt(atan(Real(1)));
  const Real x2 = Real(alpha) * Real(alpha) * r2, slope = Real(2 * alpha) / root_pi;
  if (x2 < Real(0.5)) {  // erf(x)/x = 2/sqrt(pi) exp(-x^2) (1 + z/3 (1 + z/5 (1 + ...))), z = 2 x^2
    using std::exp;
    const Real z = x2 + x2, bell = exp(-x2);
    Real tail(1);
    for (int n = std::is_same_v<Real, double> ? 16 : 30; n >= 1; --n) tail = Real(1) + z * tail / Real(2 * n + 3);
    return {slope * bell * (Real(1) + z * tail / Real(3)),
            slope * bell * tail * Real(alpha) * Real(alpha) * Real(2) / Real(3)};
  }
  const Real r = sqrt(r2);
  const ErfcTerms<Real> terms = erfc_terms<Real>(Real(alpha) * r);
  const Real energy = (Real(1) - terms.erfc) / r;
  return {energy, (energy - slope * terms.bell) / r2};
}

/// The near part of a split 1/r: 1/r and the polynomials of least degree that are nowhere further from -erf(alpha r)/r,
/// and from its force, than parts of the values these have at r = 0, which are their largest. Kept until this thread
/// asks for another one.
/// @param error  that part; rounding is a few times 1e-16 of it
/// @return one without terms if there would be too many
const ChargeSeries& screened_series(double alpha, double range, double error);

/// The near part, between pairs up to a cutoff.
struct ScreenedCharges {
  double alpha = 0;                               ///< [1/length]
  double radius = 0;                              ///< [length]
  double error = 0;                               ///< of forces in lanes, see `screened_series`
  PairPrecision precision = PairPrecision::full;  ///< of forces; energies are those of doubles

  static constexpr auto describe() {
    return part<ScreenedCharges>("electrostatic", "the near part of a sum over a lattice of charges",
                                 formula("U = C q_i q_j erfc(alpha r) / r, r < cutoff"));
  }
  double range() const { return radius; }
  double scale(double product) const { return 100 * product / (radius * radius); }  // at a tenth of the radius
  const ChargeSeries& series() const { return screened_series(alpha, radius, error); }
  template <class Real> PairTerms<Real> operator()(const Real& r2, const Real& product) const {
    using std::sqrt, std::atan;
    const Real r = sqrt(r2), inverse = Real(1) / r;
    const ErfcTerms<Real> terms = erfc_terms<Real>(Real(alpha) * r);
    const Real energy = product * terms.erfc * inverse;
    return {energy, (energy + product * (bell_slope<Real>() * terms.bell)) * (inverse * inverse)};
  }

 private:
  /// 2 alpha / sqrt(pi).
  template <class Real> Real bell_slope() const {
    if constexpr (std::is_same_v<Real, double>) {
      return alpha * 1.1283791670955126;  // a constant, so that loops have no call
    } else {
      using std::sqrt, std::atan;
      return Real(alpha) / sqrt(atan(Real(1)));
    }
  }
};

/// What decides on the parameters of a sum, and what of it is not of pairs.
template <class Real> struct ChargeSums {
  Real net, squares;  ///< sum of q, sum of q^2
  Index charged;      ///< how many are not 0
};
template <class Real> ChargeSums<Real> charge_sums(const ParticleSystem<Real>& s) {
  const auto& q = s.template column<Charge>();
  const auto sums = sums_over<Real, 2>(s.size(), [&](Index i) { return std::array<Real, 2>{q[i], q[i] * q[i]}; });
  Index charged = 0;
  for (Index i = 0; i < s.size(); ++i) charged += q[i] != Real(0) ? 1 : 0;
  return {sums[0], sums[1], charged};
}

/// A number without its derivatives, as a double.
template <class Real> double plain_number(const Real& x) {
  if constexpr (requires { x.slope; }) {
    return plain_number(x.value);
  } else {
    return static_cast<double>(x);
  }
}

/// How a sum is split: errors of forces are those of charges in no order, in units of the force between two typical
/// charges that are as far apart as neighbors,  F = C <q^2> / a^2,  a^3 = V / n.
///
///     near part    2 sqrt(a / cutoff) exp(-alpha^2 cutoff^2)
///     waves        alpha sqrt(8 a / k) exp(-k^2 / 4 alpha^2)        up to the wave number k
///
/// @source KolafaPerram1992
class SplitErrors {
 public:
  /// @param charged  how many charges are not 0
  SplitErrors(double volume, Index charged) : a_(std::cbrt(volume / static_cast<double>(charged))) {}
  double near(double alpha, double cutoff) const;
  double waves(double alpha, double k) const;
  /// Least alpha for which the near part has no larger error [1/length].
  double alpha_for(double error, double cutoff) const;
  /// The wave number up to which the error of waves is that [1/length].
  double wave_number_for(double error, double alpha) const;

 private:
  double a_;
};

/// Which parts of a sum are wanted, where the waves may have kicks of their own.
struct SplitParts {
  bool near, waves;
};
template <class Real> SplitParts wanted_parts(const ForceSink<Real>& out, const std::optional<std::string>& wave_kick) {
  if (out.takes_all() || !wave_kick) return {true, true};
  const bool waves = out.takes(*wave_kick);
  return {!waves, waves};
}
/// Letters of the kicks of a sum.
std::string kicks_of_split(const std::optional<std::string>& wave_kick);
/// @throws Error  for what is no letter of slow kicks
void check_wave_kick(const std::optional<std::string>& wave_kick);

/// @throws Error  for open space, or particles without charges
void check_lattice(bool periodic, bool charges, std::string_view name);
/// @throws Error  for a cutoff, an error or an alpha that are none
void check_split(double cutoff, double relative_error, const std::optional<double>& alpha);

/// Energy and virial of each charge with itself, and of a background that neutralises a net charge.
template <class Real>
void add_self_energy(ForceSink<Real>& out, const ParticleSystem<Real>& s, const ChargeSums<Real>& sums, double alpha) {
  using std::sqrt, std::atan;
  const Real c(s.units().coulomb_constant), quarter = atan(Real(1)), a(alpha);  // pi / 4
  out.energy(-c * a * sums.squares / (Real(2) * sqrt(quarter)));
  const Vec3<double>& edges = s.box().edges();
  const Real volume = Real(edges[0]) * Real(edges[1]) * Real(edges[2]);
  const Real background = -Real(2) * quarter * c * sums.net * sums.net / (volume * a * a);
  out.energy(background);
  out.virial(Mat3<Real>(background * Mat3<Real>::Identity()));
}

/// A pair of which the waves have more than the topology leaves.
template <class Real> struct SmoothPair {
  Index i, j;
  Vec3<Real> d, force;
  Real energy;
};
/// Those that the topology excludes or scales, with what is to be taken out.
template <class Real> const std::vector<SmoothPair<Real>>& smooth_pairs(const ParticleSystem<Real>& s, double alpha) {
  thread_local std::vector<SmoothPair<Real>> memory;
  std::vector<SmoothPair<Real>>& found = memory;  // this thread's, written by all
  const std::vector<Topology::Pair>& excluded = s.topology()->exclusions;
  const std::vector<Topology::ScaledPair>& scaled = s.topology()->scaled_pairs;
  const auto& q = s.template column<Charge>();
  found.resize(excluded.size() + scaled.size());
  for_blocks(static_cast<Index>(found.size()), [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const bool whole = k < excluded.size();
      const auto [i, j] = whole ? excluded[k] : scaled[k - excluded.size()].pair;
      const double taken = whole ? 1 : 1 - scaled[k - excluded.size()].factor;
      const Real product = Real(taken) * Real(s.units().coulomb_constant) * q[i] * q[j];
      const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
      const PairTerms<Real> terms = smooth_terms(alpha, Real(norm2(d)));
      found[k] = {i, j, d, Vec3<Real>((-product * terms.force) * d), -product * terms.energy};
    }
  });
  return found;
}

/// Takes out of the waves what the topology excludes or scales. Doubles are counted in whole units: the forces of the
/// smooth part have a bound, and their sums no order; up to the range of the near part they are its series, in lanes.
/// @param near  with which the split goes
template <class Real>
void add_smooth_pairs(ForceSink<Real>& out, const ParticleSystem<Real>& s, const ScreenedCharges& near) {
  if (s.topology() == nullptr) return;
  for (const SmoothPair<Real>& one : smooth_pairs(s, near.alpha)) {
    out.pair(one.i, one.j, one.force);
    out.energy(one.energy);
  }
}
template <> void add_smooth_pairs(ForceSink<double>& out, const ParticleSystem<double>& s, const ScreenedCharges& near);

}  // namespace noether::detail
