#pragma once
/// Sums of charges over the waves of a periodic box: loops over plain arrays, of doubles in lanes.

#include "numbers/types.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace noether::detail {

/// A wave exp(i k.x), k = 2 pi (n_x/L_x, n_y/L_y, n_z/L_z); one of k and -k.
using Wave = std::array<int, 3>;
/// Those up to a wave number, without 0, always in one order.
std::vector<Wave> waves_up_to(double wave_number, const Vec3<double>& edges);
/// How many there are, about.
double wave_count(double wave_number, double volume);

/// cos and sin of m 2 pi x_i / L along the three axes, shape (most[axis] + 1, n) each.
template <class Real> struct WaveTables {
  Index n = 0;
  std::array<std::vector<Real>, 3> cosine, sine;

  const Real* cosines(int axis, int m) const { return cosine[static_cast<std::size_t>(axis)].data() + std::abs(m) * n; }
  const Real* sines(int axis, int m) const { return sine[static_cast<std::size_t>(axis)].data() + std::abs(m) * n; }
};

/// The factors of one wave along the axes, for all particles.
template <class Real> struct WaveFactors {
  const Real *c[3], *s[3];
  Real sign[3];  ///< of the sines

  WaveFactors(const WaveTables<Real>& tables, const Wave& wave) {
    for (int k = 0; k < 3; ++k) {
      const int m = wave[static_cast<std::size_t>(k)];
      c[k] = tables.cosines(k, m);
      s[k] = tables.sines(k, m);
      sign[k] = Real(m < 0 ? -1 : 1);
    }
  }
};

template <class Real> struct WavePhase { Real c, s; };
template <class Real> [[gnu::always_inline]] inline WavePhase<Real> phase_of(const WaveFactors<Real>& f, Index i) {
  const Real c0 = f.c[0][i], s0 = f.sign[0] * f.s[0][i], c1 = f.c[1][i], s1 = f.sign[1] * f.s[1][i];
  const Real c2 = f.c[2][i], s2 = f.sign[2] * f.s[2][i];
  const Real c01 = c0 * c1 - s0 * s1, s01 = s0 * c1 + c0 * s1;
  return {c01 * c2 - s01 * s2, s01 * c2 + c01 * s2};
}

/// What sums of one number type count: doubles in whole units, so that their sums have no order.
template <class Real> using Counted = std::conditional_t<std::is_same_v<Real, double>, std::int64_t, Real>;

/// sum q exp(i k.x) of a wave, in units of 1 / per_unit.
template <class Real>
inline void add_up_wave(const WaveFactors<Real>& factors, const Real* charges, Index n, double per_unit,
                        Counted<Real>* sum) {
  const WaveFactors<Real> f = factors;
  Counted<Real> re(0), im(0);
  for (Index i = 0; i < n; ++i) {
    const WavePhase<Real> phase = phase_of(f, i);
    if constexpr (std::is_same_v<Real, double>) {
      const double q = charges[i] * per_unit;
      re += static_cast<std::int64_t>(q * phase.c);
      im += static_cast<std::int64_t>(q * phase.s);
    } else {
      re += charges[i] * phase.c;
      im += charges[i] * phase.s;
    }
  }
  sum[0] = re;
  sum[1] = im;
}

/// A wave as it acts on charges: its amplitudes, and k.
template <class Real> struct ActingWave {
  Real re, im;  ///< 2 A Re S, 2 A Im S
  Real k[3];
};

/// Adds what a wave does to the unit charges [begin, end), to sums that begin there.
template <class Real>
inline void add_wave_fields(const WaveFactors<Real>& factors, const ActingWave<Real>& acting, Index begin, Index end,
                            Real* const* fields) {
  const WaveFactors<Real> f = factors;
  const ActingWave<Real> wave = acting;
  Real *x = fields[0], *y = fields[1], *z = fields[2];
#if !defined(__clang__)
#pragma GCC ivdep
#endif
  for (Index i = begin; i < end; ++i) {
    const WavePhase<Real> phase = phase_of(f, i);
    const Real t = phase.s * wave.re - phase.c * wave.im;
    x[i - begin] += t * wave.k[0];
    y[i - begin] += t * wave.k[1];
    z[i - begin] += t * wave.k[2];
  }
}

template <class Real> struct WaveLoops {
  void (*add_up)(const WaveFactors<Real>&, const Real*, Index, double, Counted<Real>*);
  void (*add_fields)(const WaveFactors<Real>&, const ActingWave<Real>&, Index, Index, Real* const*);
};
template <class Real> WaveLoops<Real> wave_loops() { return {add_up_wave<Real>, add_wave_fields<Real>}; }
template <> WaveLoops<double> wave_loops();

}  // namespace noether::detail
