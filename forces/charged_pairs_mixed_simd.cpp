#include "forces/charged_pairs_mixed_simd.hpp"

#include "forces/lennard_jones_lanes_simd.hpp"
#include "forces/minimum_simd.hpp"
#include "forces/mixed_lanes_simd.hpp"

#include <type_traits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

HWY_INLINE Vector number(double x) { return hn::Set(Lanes(), static_cast<float>(x)); }

/// 1 / sqrt(x), to a few units in the last place.
HWY_INLINE Vector reciprocal_sqrt(Vector x) {
#if HWY_TARGET <= HWY_AVX3
  const Vector y{_mm512_rsqrt14_ps(x.raw)};
  const Vector h = hn::NegMulAdd(hn::Mul(x, y), y, number(1));
  return hn::MulAdd(hn::Mul(y, h), hn::MulAdd(h, number(0.375), number(0.5)), y);
#else
  return hn::Div(number(1), hn::Sqrt(x));
#endif
}

enum class Series : std::uint8_t { two_terms, switched, any };

/// Forces of the particles of a group from `first` on.
template <Series kind, class Sum>
HWY_INLINE void sum_lanes(const MixedChargedField& field, const PairGroup& group, std::ptrdiff_t first, PairSums& out) {
  constexpr std::ptrdiff_t n = std::is_same_v<Sum, QuickSum> ? 3 : 1;  // turns side by side
  constexpr std::ptrdiff_t stride = group_size * rows_at_once;
  static_assert(n <= Sum::most);
  const Lanes d;
  const ChargeSeries& series = *field.series;
  Sum force[3];
  std::int32_t own_records[lanes];
  for (std::ptrdiff_t k = 0; k < lanes; ++k) own_records[k] = group.records[first + k % lanes_of_group];
  const Points own = load_points(field.records, own_records);
  const Vector own_charge = hn::BitCast(d, own.fourth);
  const Vector length2 = number(field.length2), range2 = number(series.range2), scale = number(series.scale),
               offset = number(series.offset);
  Vector nearest = number(1e30);
  const std::ptrdiff_t turns = (group.rows + rows_at_once - 1) / rows_at_once;
  const std::int32_t* entries = group.entries + first;
  const auto add = [&]<std::ptrdiff_t many>(std::integral_constant<std::ptrdiff_t, many>) HWY_ATTR {
    Vector dx[many], dy[many], dz[many], r2[many], product[many], t[many], inverse[many], sum[many];
    for (std::ptrdiff_t k = 0; k < many; ++k) {
      __builtin_prefetch(entries + k * stride + group_size * rows_asked_ahead);
      const Points other = load_points(field.records, entries + k * stride);
      const Distances pair = distances(own, other);
      dx[k] = pair.dx, dy[k] = pair.dy, dz[k] = pair.dz;
      r2[k] = hn::Mul(pair.r2, length2);
      product[k] = hn::Mul(own_charge, hn::BitCast(d, other.fourth));
      inverse[k] = reciprocal_sqrt(r2[k]);
      t[k] = kind == Series::any ? hn::MulAdd(r2[k], scale, offset) : r2[k];
    }
    if constexpr (kind == Series::any) {
      for (Vector& one : sum) one = number(series.force[series.force_terms - 1]);
      for (int term = series.force_terms - 2; term >= 0; --term) {
        const Vector one = number(series.force[term]);
        for (std::ptrdiff_t k = 0; k < many; ++k) sum[k] = hn::MulAdd(sum[k], t[k], one);
      }
    } else {
      for (Vector& one : sum) one = number(series.force[0]);
    }
    for (std::ptrdiff_t k = 0; k < many; ++k) {
      Vector strength = hn::MulAdd(hn::Mul(inverse[k], inverse[k]), inverse[k], sum[k]);
      if constexpr (kind == Series::switched) {
        const Vector energy =
            hn::Add(inverse[k], hn::MulAdd(number(series.energy[1]), r2[k], number(series.energy[0])));
        const Vector by = number(series.switch_inverse);
        const Vector part = hn::ZeroIfNegative(hn::Mul(hn::Sub(r2[k], number(series.switch_from2)), by));
        Vector s, slope;
        switch_off<LennardJonesStyle::switch_c4>(d, part, s, slope);
        strength = hn::MulSub(s, strength, hn::Mul(hn::Mul(energy, slope), hn::Add(by, by)));
      }
      nearest = lesser(nearest, r2[k]);
      const Vector all = hn::IfThenElseZero(hn::Lt(r2[k], range2), hn::Mul(product[k], strength));
      force[0].add(all, dx[k]);
      force[1].add(all, dy[k]);
      force[2].add(all, dz[k]);
    }
    entries += many * stride;
  };
  std::ptrdiff_t turn = 0;
  while (turn < turns) {
    std::ptrdiff_t left = turns - turn < Sum::most ? turns - turn : Sum::most;
    turn += left;
    for (; left >= n; left -= n) add(std::integral_constant<std::ptrdiff_t, n>());
    for (; left > 0; --left) add(std::integral_constant<std::ptrdiff_t, 1>());
    for (Sum& one : force) one.widen();
  }
  for (int k = 0; k < 3; ++k) force[k].store(out.force[k] + first);
  if constexpr (requires { force[0].strong; }) {
    for (std::ptrdiff_t k = 0; k < lanes_of_group; ++k)
      out.strong[first + k] = force[0].strong[k] || force[1].strong[k] || force[2].strong[k];
  }
  out.close = out.close || !hn::AllTrue(d, hn::Ge(nearest, number(field.close2)));
}

template <Series kind, class Sum>
void sum_pairs(const MixedChargedField& field, const PairGroup& group, PairSums& out) {
  out.close = false;
  if (group.rows == 0) {
    __builtin_memset(&out, 0, sizeof out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < group_size; first += lanes_of_group)
    sum_lanes<kind, Sum>(field, group, first, out);
}

constexpr ChargedPairMixedKernels all_kernels() {
  return {
      {sum_pairs<Series::two_terms, QuickSum>, sum_pairs<Series::switched, QuickSum>, sum_pairs<Series::any, QuickSum>},
      {sum_pairs<Series::two_terms, CarefulSum>, sum_pairs<Series::switched, CarefulSum>,
       sum_pairs<Series::any, CarefulSum>}};
}

}  // namespace

extern const ChargedPairMixedKernels charged_pair_mixed_kernels;
constinit const ChargedPairMixedKernels charged_pair_mixed_kernels = all_kernels();

}  // namespace noether::NOETHER_SIMD_LEVEL
