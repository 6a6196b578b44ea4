#pragma once
/// The Lennard-Jones potential in lanes of numbers, as all its kernels compute it. For `*_simd.cpp` alone.

#include "forces/lennard_jones_row.hpp"

#include <hwy/highway.h>

#include <cstddef>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// The numbers of a row in every lane: of one row for all, or of one row for each.
template <class D> struct Parameters {
  using Number = hn::TFromD<D>;
  hn::Vec<D> range2, close2, force12, force6, energy12, energy6, style0, style1;

  explicit Parameters(const LennardJonesRow& row) {
    const auto set = [](double x) HWY_ATTR { return hn::Set(D(), static_cast<Number>(x)); };
    range2 = set(row.range2);
    close2 = set(row.close2);
    force12 = set(row.force12);
    force6 = set(row.force6);
    energy12 = set(row.energy12);
    energy6 = set(row.energy6);
    style0 = set(row.style[0]);
    style1 = set(row.style[1]);
  }
  /// @param row_of  the row of a lane
  template <class RowOf>
    requires(requires(RowOf row_of) { row_of(0); })
  explicit Parameters(const RowOf& row_of) {
    constexpr std::ptrdiff_t lanes = hn::MaxLanes(D());
    alignas(64) Number column[8][lanes];
    for (std::ptrdiff_t k = 0; k < lanes; ++k) {
      const LennardJonesRow& row = row_of(k);
      const double numbers_of_row[8] = {row.range2,   row.close2,  row.force12,  row.force6,
                                        row.energy12, row.energy6, row.style[0], row.style[1]};
      for (int c = 0; c < 8; ++c) column[c][k] = static_cast<Number>(numbers_of_row[c]);
    }
    const D d;
    range2 = hn::Load(d, column[0]);
    close2 = hn::Load(d, column[1]);
    force12 = hn::Load(d, column[2]);
    force6 = hn::Load(d, column[3]);
    energy12 = hn::Load(d, column[4]);
    energy6 = hn::Load(d, column[5]);
    style0 = hn::Load(d, column[6]);
    style1 = hn::Load(d, column[7]);
  }
};

/// Energy and F/r of a pair.
template <class D> struct Terms { hn::Vec<D> energy, force; };

/// S and dS/dt of a switch that falls from 1 at t = 0 to 0 at t = 1.
template <LennardJonesStyle style, class D>
HWY_INLINE void switch_off(D d, hn::Vec<D> t, hn::Vec<D>& s, hn::Vec<D>& slope) {
  const auto number = [&](double x) HWY_ATTR { return hn::Set(d, static_cast<hn::TFromD<D>>(x)); };
  const auto t2 = hn::Mul(t, t), u = hn::Sub(number(1), t);
  if constexpr (style == LennardJonesStyle::switch_c2) {
    // 1 - t^3 (10 - 15 t + 6 t^2)
    s = hn::NegMulAdd(hn::Mul(t2, t), hn::MulAdd(t, hn::MulAdd(t, number(6), number(-15)), number(10)), number(1));
    slope = hn::Mul(number(-30), hn::Mul(t2, hn::Mul(u, u)));
  } else {
    // 1 - t^5 (126 - 420 t + 540 t^2 - 315 t^3 + 70 t^4)
    auto p = hn::MulAdd(t, number(70), number(-315));
    p = hn::MulAdd(t, p, number(540));
    p = hn::MulAdd(t, p, number(-420));
    p = hn::MulAdd(t, p, number(126));
    const auto t4 = hn::Mul(t2, t2), u2 = hn::Mul(u, u);
    s = hn::NegMulAdd(hn::Mul(t4, t), p, number(1));
    slope = hn::Mul(number(-630), hn::Mul(t4, hn::Mul(u2, u2)));
  }
}

/// @param inverse2  1 / r^2, or a multiple of it that the row counts in
template <LennardJonesStyle style, bool sums, class D>
HWY_INLINE Terms<D> terms_of(hn::Vec<D> r2, hn::Vec<D> inverse2, const Parameters<D>& p) {
  const D d;
  const auto inverse6 = hn::Mul(hn::Mul(inverse2, inverse2), inverse2);
  const auto bare = hn::Mul(inverse6, hn::MulSub(inverse6, p.force12, p.force6));  // F r
  constexpr bool switched = style == LennardJonesStyle::switch_c2 || style == LennardJonesStyle::switch_c4;
  hn::Vec<D> energy = hn::Zero(d);
  if constexpr (sums || switched) energy = hn::Mul(inverse6, hn::MulSub(inverse6, p.energy12, p.energy6));
  if constexpr (style == LennardJonesStyle::shifted) {
    return {hn::Sub(energy, p.style0), hn::Mul(inverse2, bare)};
  } else if constexpr (style == LennardJonesStyle::shifted_force) {
    const auto inverse = hn::Sqrt(inverse2);
    if constexpr (sums) energy = hn::MulAdd(p.style1, hn::Mul(r2, inverse), hn::Sub(energy, p.style0));
    return {energy, hn::NegMulAdd(p.style1, inverse, hn::Mul(inverse2, bare))};
  } else {
    const auto t = hn::ZeroIfNegative(hn::Mul(hn::Sub(r2, p.style0), p.style1));
    hn::Vec<D> s, slope;
    switch_off<style>(d, t, s, slope);
    // -dU/dr / r = S F/r - 2 U dS/dt / (cutoff^2 - style0)
    const auto along = hn::Mul(hn::Mul(energy, slope), hn::Add(p.style1, p.style1));
    return {hn::Mul(energy, s), hn::MulSub(s, hn::Mul(inverse2, bare), along)};
  }
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
