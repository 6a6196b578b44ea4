#pragma once
/// Charges in a periodic box, all images of all of them: Ewald's sum.

#include "engine/any_force.hpp"
#include "forces/coulomb.hpp"
#include "forces/ewald_split.hpp"
#include "forces/known_charges.hpp"
#include "forces/lattice_waves.hpp"
#include "numbers/cost_book.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// Charges and all their images, by Ewald's sum; beyond it a conductor.
///
///     U = sum_{i<j, r < cutoff} C q_i q_j erfc(alpha r)/r + (2 pi C / V) sum_{0 < |k| < kmax} exp(-k^2/4 alpha^2)/k^2
///         |sum_i q_i exp(i k.x_i)|^2 - C alpha/sqrt(pi) sum q_i^2 - pi C/(2 V alpha^2) (sum q_i)^2
///
/// Excluded pairs and scaled ones are those of nearest images. The waves may kick by a letter of their own
/// (`wave_kick`), with what is taken out of them: without that they would change as fast as the bonds of excluded
/// pairs. Unless they are given, alpha and kmax follow from the cutoff and the error asked for (`SplitErrors`), and
/// from how many charges there are in the box. Of doubles the sums over particles are counted in whole units: bits
/// depend on no thread, and on no order of particles.
/// @cost O(n^(3/2)) if the cutoff grows with the box; a sum over all waves for each particle
/// @source Ewald1921, KolafaPerram1992
struct Ewald {
  double cutoff = 0;                          ///< of the near part [length]
  double relative_error = 1e-5;               ///< asked of forces
  std::optional<double> alpha = {};           ///< [1/length]
  std::optional<double> kmax = {};            ///< [1/length]
  std::optional<std::string> wave_kick = {};  ///< letter of the kicks by the waves; empty: that of the near part

  static constexpr auto describe() {
    return part<Ewald>(
        "ewald", "charges and all their images in a periodic box, by Ewald's sum over waves",
        formula(
            "U = sum_{i<j} C q_i q_j erfc(alpha r)/r + 2 pi C/V sum_{k} exp(-k^2/4 alpha^2)/k^2 |sum q exp(i k.x)|^2 "
            "- C alpha/sqrt(pi) sum q^2 - pi C/(2 V alpha^2) (sum q)^2; without what is excluded"),
        source("Ewald1921, KolafaPerram1992"),
        field<&Ewald::cutoff>("cutoff", "length", "where the near part of the pairs ends").required("\"0.9 nm\""),
        field<&Ewald::relative_error>("relative_error", "1",
                                      "root mean square error of forces, of that between two typical charges as far "
                                      "apart as neighbors: C <q^2> (n/V)^(2/3)"),
        field<&Ewald::alpha>("alpha", "1/length", "where 1/r is split; default: from cutoff and relative_error"),
        field<&Ewald::kmax>("kmax", "1/length", "largest wave number; default: from alpha and relative_error"),
        field<&Ewald::wave_kick>("wave_kick", "1",
                                 "letter of the kicks by the waves, for multiple time steps; default: that of the near "
                                 "part"));
  }
  static constexpr std::string_view only_once = detail::charges_once;
  ForceClaims claims() const {
    return {.keeps_angular_momentum = false,
            .periodic = true,
            .charges = true,
            .exclusions = true,
            .kicks = detail::kicks_of_split(wave_kick),
            .range = cutoff};
  }
  /// @throws Error  for a cutoff, an error, an alpha or a wave number that are none
  void check() const;
  /// @throws Error  also without a box or charges, and for more waves than anybody waits for
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    check();
    detail::check_lattice(s.box().is_periodic(), s.template has<Charge>(), describe().name);
    check_waves(s.box(), detail::charge_sums(s).charged);
  }

  template <class Real>
    requires(!std::is_same_v<Real, Pack>)
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const auto& known = detail::KnownCharges<Real>::of(out.workspace(), s);
    const detail::ChargeSums<Real>& sums = known.sums;
    if (sums.charged == 0) return;
    const Ewald chosen = chosen_for(s.box(), sums.charged);
    const detail::SplitParts wanted = detail::wanted_parts(out, wave_kick);
    const detail::ScreenedCharges near{*chosen.alpha, cutoff};
    if (wanted.near) PairForce<detail::ScreenedCharges>{near}.add_to(out, s);
    if (!wanted.waves) return;
    const Spent spent("force", "ewald waves");
    detail::add_self_energy(out, s, sums, near.alpha);
    detail::add_smooth_pairs(out, s, near);
    chosen.add_waves(out, s, known.strongest);
  }

  /// The same with alpha and kmax as it takes them for so many charges in a box.
  Ewald chosen_for(const Box& box, Index charged) const;
  /// For truth in 113 bits: the same, or where alpha and kmax are not given, one that is right to 1e-13.
  Ewald reference() const;

 private:
  void check_waves(const Box& box, Index charged) const;
  template <class Real> void add_waves(ForceSink<Real>& out, const ParticleSystem<Real>& s, double strongest) const;
};

namespace detail {

/// Fills tables of cosines and sines for waves up to `most` along each axis.
template <class Real>
void fill_wave_tables(WaveTables<Real>& tables, const ParticleSystem<Real>& s, const std::array<int, 3>& most) {
  using std::sin, std::cos, std::atan;
  const Real turn = Real(8) * atan(Real(1));
  tables.n = s.size();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto size = static_cast<std::size_t>((most[k] + 1) * tables.n);
    tables.cosine[k].resize(size);
    tables.sine[k].resize(size);
  }
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const Real* x = s.positions().component(k);
      for (int m = 0; m <= most[axis]; ++m) {
        for (Index i = begin; i < end; ++i) {
          const Real turns = Real(m) * (x[i] / Real(s.box().edges()[k]));
          const Real angle = turn * (turns - nearest_whole(turns));
          const auto at = static_cast<std::size_t>(m * tables.n + i);
          tables.cosine[axis][at] = cos(angle);
          tables.sine[axis][at] = sin(angle);
        }
      }
    }
  });
}

/// A wave's k, and A = 4 pi C / V exp(-k^2 / 4 alpha^2) / k^2.
template <class Real> struct WaveWeight {
  Vec3<Real> k;
  Real k2, A;

  WaveWeight(const Wave& wave, const Vec3<double>& edges, double alpha, double constant) {
    using std::atan, std::exp;
    const Real pi = Real(4) * atan(Real(1));
    const Real volume = Real(edges[0]) * Real(edges[1]) * Real(edges[2]);
    for (int axis = 0; axis < 3; ++axis)
      k[axis] = Real(2) * pi * Real(wave[static_cast<std::size_t>(axis)]) / Real(edges[axis]);
    k2 = norm2(k);
    A = Real(4) * pi * Real(constant) / volume * exp(-k2 / (Real(4) * Real(alpha) * Real(alpha))) / k2;
  }
};

/// The waves of a box, and what an evaluation computes of them.
template <class Real> struct WaveMemory {
  double kmax = 0;
  Vec3<double> edges = Vec3<double>::Zero();
  std::vector<Wave> waves;
  std::array<int, 3> most{};
  WaveTables<Real> tables;
  std::vector<ActingWave<Real>> acting;
  std::vector<Real> energies;

  /// @cost allocates where the box, kmax or the number of particles is another one
  void prepare(const ParticleSystem<Real>& s, double wave_number) {
    if (wave_number != kmax || s.box().edges() != edges) {
      kmax = wave_number;
      edges = s.box().edges();
      waves = waves_up_to(kmax, edges);
      acting.resize(waves.size());
      energies.resize(waves.size());
      most = {};
      for (const Wave& wave : waves) {
        for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], std::abs(wave[k]));
      }
    }
    fill_wave_tables(tables, s, most);
  }
};

}  // namespace detail

template <class Real>
void Ewald::add_waves(ForceSink<Real>& out, const ParticleSystem<Real>& s, double strongest) const {
  const Vec3<double>& edges = s.box().edges();
  auto& own = out.workspace().template get<detail::WaveMemory<Real>>();
  own.prepare(s, *kmax);
  const std::vector<detail::Wave>& waves = own.waves;
  const detail::WaveTables<Real>& tables = own.tables;
  const detail::WaveLoops<Real> loops = detail::wave_loops<Real>();
  const Real* q = s.template column<Charge>().data();
  double unit = 1;  // of sums of doubles: n of the strongest charge are less than 2^61 units
  if constexpr (std::is_same_v<Real, double>) {
    unit = std::ldexp(1.0, std::ilogb(strongest * static_cast<double>(s.size())) + 2 - 61);
  }
  std::vector<detail::ActingWave<Real>>& acting = own.acting;
  std::vector<Real>& energies = own.energies;
  for_blocks(static_cast<Index>(waves.size()), [&](Index begin, Index end) {
    for (auto w = static_cast<std::size_t>(begin); w < static_cast<std::size_t>(end); ++w) {
      detail::Counted<Real> sum[2];
      loops.add_up(detail::WaveFactors<Real>(tables, waves[w]), q, s.size(), 1 / unit, sum);
      const detail::WaveWeight<Real> weight(waves[w], edges, *alpha, s.units().coulomb_constant);
      const Real re = Real(unit) * Real(sum[0]), im = Real(unit) * Real(sum[1]);
      acting[w] = {Real(2) * weight.A * re, Real(2) * weight.A * im, {weight.k[0], weight.k[1], weight.k[2]}};
      energies[w] = weight.A * (re * re + im * im);
    }
  });
  for_blocks(s.size(), [&](Index begin, Index end) {
    Real felt[3][block_size];
    for (auto& one : felt) std::fill(one, one + block_size, Real(0));
    Real* const fields[3] = {felt[0], felt[1], felt[2]};
    for (std::size_t w = 0; w < waves.size(); ++w)
      loops.add_fields(detail::WaveFactors<Real>(tables, waves[w]), acting[w], begin, end, fields);
    for (Index i = begin; i < end; ++i) {
      if (s.masses()[i] == Real(0)) continue;
      const Index k = i - begin;
      out.accelerations().add(i, q[i] / s.masses()[i] * Vec3<Real>(felt[0][k], felt[1][k], felt[2][k]));
    }
  });
  if (!out.wants_energy() && !out.wants_virial()) return;
  WideSum<Real> energy;
  WideTensor<Real> virial;
  for (std::size_t w = 0; w < waves.size(); ++w) {
    const detail::WaveWeight<Real> weight(waves[w], edges, *alpha, s.units().coulomb_constant);
    energy += energies[w];
    const Real by = Real(2) * (Real(1) / weight.k2 + Real(1) / (Real(4) * Real(*alpha) * Real(*alpha)));
    virial += Mat3<Real>(energies[w] * (Mat3<Real>::Identity() - by * weight.k * weight.k.transpose()));
  }
  out.energy(energy);
  out.virial(virial);
}

namespace detail {  // compiled once, in ewald.cpp

extern template struct ForceModel<Ewald, double>;
extern template struct ForceModel<Ewald, Quad>;

}  // namespace detail

}  // namespace noether
