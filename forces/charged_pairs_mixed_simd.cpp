#include "forces/charged_pairs_mixed_simd.hpp"

#include "forces/lennard_jones_lanes_simd.hpp"
#include "forces/minimum_simd.hpp"
#include "forces/mixed_lanes_simd.hpp"

#include <type_traits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

HWY_INLINE Vector number(double x) { return hn::Set(Lanes(), static_cast<float>(x)); }

enum class Series : std::uint8_t { two_terms, switched, any };

/// 1 / r of a pair, to about 14 bits where the processor has a seed of a root, and what that leaves to be done: r^2 /
/// r^2 of the seed, near 1.
struct Inverse {
  Vector seed, seed2, part;

  explicit HWY_INLINE Inverse(Vector r2) {
#if HWY_TARGET <= HWY_AVX3
    seed = Vector{_mm512_rsqrt14_ps(r2.raw)};
    seed2 = hn::Mul(seed, seed);
    part = hn::Mul(r2, seed2);
#else
    seed = hn::Div(number(1), hn::Sqrt(r2));
    seed2 = hn::Mul(seed, seed);
    part = number(1);
#endif
  }
  /// 1 / r: of part^(-1/2) = (1 - h)^(-1/2) two terms, of which the next would be below 6e-9.
  HWY_INLINE Vector once() const {
#if HWY_TARGET <= HWY_AVX3
    return hn::Mul(seed, hn::NegMulAdd(part, number(0.5), number(1.5)));
#else
    return seed;
#endif
  }
};

HWY_INLINE Vector in_lanes(float x) { return hn::Set(Lanes(), x); }
HWY_INLINE Vector in_lanes(Vector x) { return x; }

/// The product of two charges, in all lanes the same or in each its own, and what the terms of a pair take of it.
template <class Number> struct Product {
  Number bare, answer;  ///< times the first coefficient of a series
  Number threehalves, fivehalves;

  /// The product by r^3, plus `rest`: of part^(-3/2) two terms, of which the next would be below 2.8e-8.
  HWY_INLINE Vector by_cube(const Inverse& inverse, Vector rest) const {
    const Vector cube = hn::Mul(inverse.seed2, inverse.seed);
#if HWY_TARGET <= HWY_AVX3
    return hn::MulAdd(cube, hn::NegMulAdd(inverse.part, in_lanes(threehalves), in_lanes(fivehalves)), rest);
#else
    return hn::MulAdd(cube, in_lanes(bare), rest);
#endif
  }
};

HWY_INLINE Product<float> product_of(float a, float b, float coefficient) {
  const float bare = a * b;
  return {bare, bare * coefficient, bare * 1.5F, bare * 2.5F};
}
HWY_INLINE Product<Vector> product_of(Vector a, Vector b, Vector coefficient) {
  const Vector bare = hn::Mul(a, b);
  return {bare, hn::Mul(bare, coefficient), hn::Mul(bare, number(1.5)), hn::Mul(bare, number(2.5))};
}

/// -U'(r) / r of n pairs, side by side.
template <Series kind, class Number, std::ptrdiff_t n>
HWY_INLINE void strengths(const ChargeSeries& series, const Product<Number> (&products)[n], const Vector (&r2)[n],
                          Vector (&strength)[n]) {
  const Lanes d;
  if constexpr (kind == Series::any) {
    Vector t[n];
    for (std::ptrdiff_t k = 0; k < n; ++k) t[k] = hn::MulAdd(r2[k], number(series.scale), number(series.offset));
    for (Vector& one : strength) one = number(series.force[series.force_terms - 1]);
    for (int term = series.force_terms - 2; term >= 0; --term) {
      const Vector one = number(series.force[term]);
      for (std::ptrdiff_t k = 0; k < n; ++k) strength[k] = hn::MulAdd(strength[k], t[k], one);
    }
    for (std::ptrdiff_t k = 0; k < n; ++k)
      strength[k] = products[k].by_cube(Inverse(r2[k]), hn::Mul(in_lanes(products[k].bare), strength[k]));
  } else {
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const Inverse inverse(r2[k]);
      strength[k] = products[k].by_cube(inverse, in_lanes(products[k].answer));
      if constexpr (kind == Series::switched) {
        const Vector energy =
            hn::Mul(in_lanes(products[k].bare),
                    hn::Add(inverse.once(), hn::MulAdd(number(series.energy[1]), r2[k], number(series.energy[0]))));
        const Vector by = number(series.switch_inverse);
        const Vector part = hn::ZeroIfNegative(hn::Mul(hn::Sub(r2[k], number(series.switch_from2)), by));
        Vector s, slope;
        switch_off<LennardJonesStyle::switch_c4>(d, part, s, slope);
        strength[k] = hn::MulSub(s, strength[k], hn::Mul(hn::Mul(energy, slope), hn::Add(by, by)));
      }
    }
  }
}

/// Writes sums of the particles of a group from `first` on.
template <class Sum> HWY_INLINE void store(const Sum (&force)[3], std::ptrdiff_t first, PairSums& out) {
  for (int k = 0; k < 3; ++k) force[k].store(out.force[k] + first);
  if constexpr (requires { force[0].strong; }) {
    for (std::ptrdiff_t k = 0; k < lanes_of_group; ++k)
      out.strong[first + k] = force[0].strong[k] || force[1].strong[k] || force[2].strong[k];
  }
}

/// Of the particles of a group from `first` on where their records begin: as often as their rows go side by side.
struct OwnRecords {
  std::int32_t at[lanes];

  HWY_INLINE OwnRecords(const PairGroup& group, std::ptrdiff_t first) {
    for (std::ptrdiff_t k = 0; k < lanes; ++k) at[k] = group.records[first + k % lanes_of_group];
  }
};

constexpr std::ptrdiff_t stride = group_size * rows_at_once;

std::ptrdiff_t turns_of(const PairGroup& group) { return (group.rows + rows_at_once - 1) / rows_at_once; }

/// Forces of the particles of a group from `first` on.
template <Series kind, class Sum>
HWY_INLINE void sum_lanes(const MixedChargedField& field, const PairGroup& group, std::ptrdiff_t first, PairSums& out) {
  constexpr std::ptrdiff_t n = std::is_same_v<Sum, QuickSum> ? 3 : 1;  // turns side by side
  static_assert(n <= Sum::most);
  const Lanes d;
  const ChargeSeries& series = *field.series;
  Sum force[3];
  const OwnRecords records(group, first);
  const Points own = load_points(field.records, records.at);
  const Vector own_charge = hn::BitCast(d, own.fourth), range2 = number(series.range2),
               coefficient = number(series.force[0]);
  Vector nearest = number(1e30);
  const std::ptrdiff_t turns = turns_of(group);
  const std::int32_t* entries = group.entries + first;
  const auto add = [&]<std::ptrdiff_t many>(std::integral_constant<std::ptrdiff_t, many>) HWY_ATTR {
    Vector dx[many], dy[many], dz[many], r2[many], strength[many];
    Product<Vector> products[many];
    for (std::ptrdiff_t k = 0; k < many; ++k) {
      __builtin_prefetch(entries + k * stride + group_size * rows_asked_ahead);
      const Points other = load_points(field.records, entries + k * stride);
      const Distances pair = distances(own, other);
      dx[k] = pair.dx, dy[k] = pair.dy, dz[k] = pair.dz, r2[k] = pair.r2;
      products[k] = product_of(own_charge, hn::BitCast(d, other.fourth), coefficient);
    }
    strengths<kind>(series, products, r2, strength);
    for (std::ptrdiff_t k = 0; k < many; ++k) {
      nearest = lesser(nearest, r2[k]);
      const Vector all = hn::IfThenElseZero(hn::Lt(r2[k], range2), strength[k]);
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
  store(force, first, out);
  out.close = out.close || !hn::AllTrue(d, hn::Ge(nearest, number(field.close2)));
}

/// Forces on the sites of molecules of a group from `first` on: of each neighbor a site at a time, with the three of
/// their own.
template <Series kind, class Sum>
HWY_INLINE void sum_molecule_lanes(const MixedMoleculeField& field, const PairGroup& group, std::ptrdiff_t first,
                                   PairSums* out) {
  constexpr int sites = 3;
  constexpr std::ptrdiff_t most_turns = 10;
  static_assert(most_turns * sites * ChargedPairMixedKernels::most_of_molecules < 0x1p31);
  const Lanes d;
  const ChargeSeries& series = *field.series;
  const auto load = [&](const std::int32_t* offsets, int site) HWY_ATTR {
    return load_points(
        [&](int k) HWY_ATTR { return field.records + sites * static_cast<std::ptrdiff_t>(offsets[k]) + 4 * site; });
  };
  Product<float> products[sites][sites];
  for (int j = 0; j < sites; ++j) {
    for (int i = 0; i < sites; ++i)
      products[j][i] = product_of(field.charges[i], field.charges[j], static_cast<float>(series.force[0]));
  }
  Sum force[sites][3];
  Points own[sites];
  const OwnRecords records(group, first);
  for (int i = 0; i < sites; ++i) own[i] = load(records.at, i);
  const Vector range2 = number(series.range2);
  Vector nearest = number(1e30);
  const std::ptrdiff_t turns = turns_of(group);
  const std::int32_t* entries = group.entries + first;
  Points others[sites];  // of a turn, asked for in the one before
  for (int j = 0; j < sites; ++j) others[j] = load(entries, j);
  for (std::ptrdiff_t turn = 0; turn < turns;) {
    const std::ptrdiff_t until = turn + most_turns < turns ? turn + most_turns : turns;
    for (; turn < until; ++turn, entries += stride) {
      __builtin_prefetch(entries + group_size * rows_asked_ahead);
      const std::int32_t* const next = turn + 1 < turns ? entries + stride : entries;
#pragma GCC unroll 1
      for (int j = 0; j < sites; ++j) {
        const Points other = others[j];
        others[j] = load(next, j);
        Vector dx[sites], dy[sites], dz[sites], r2[sites], strength[sites];
        for (int i = 0; i < sites; ++i) {
          const Distances pair = distances(own[i], other);
          dx[i] = pair.dx, dy[i] = pair.dy, dz[i] = pair.dz, r2[i] = pair.r2;
        }
        strengths<kind>(series, products[j], r2, strength);
        for (int i = 0; i < sites; ++i) {
          nearest = lesser(nearest, r2[i]);
          const Vector all = hn::IfThenElseZero(hn::Lt(r2[i], range2), strength[i]);
          force[i][0].add(all, dx[i]);
          force[i][1].add(all, dy[i]);
          force[i][2].add(all, dz[i]);
        }
      }
    }
    for (auto& site : force) {
      for (Sum& one : site) one.widen();
    }
  }
  for (int i = 0; i < sites; ++i) store(force[i], first, out[i]);
  out->close = out->close || !hn::AllTrue(d, hn::Ge(nearest, number(field.close2)));
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

template <Series kind, class Sum>
void sum_molecules(const MixedMoleculeField& field, const PairGroup& group, PairSums* out) {
  out->close = false;
  if (group.rows == 0) {
    __builtin_memset(out, 0, 3 * sizeof *out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < group_size; first += lanes_of_group)
    sum_molecule_lanes<kind, Sum>(field, group, first, out);
}

template <class Sum> constexpr void fill(SumMixedCharges (&pairs)[3], SumMixedMolecules (&molecules)[3]) {
  pairs[0] = sum_pairs<Series::two_terms, Sum>;
  pairs[1] = sum_pairs<Series::switched, Sum>;
  pairs[2] = sum_pairs<Series::any, Sum>;
  molecules[0] = sum_molecules<Series::two_terms, Sum>;
  molecules[1] = sum_molecules<Series::switched, Sum>;
  molecules[2] = sum_molecules<Series::any, Sum>;
}

constexpr ChargedPairMixedKernels all_kernels() {
  ChargedPairMixedKernels kernels{};
  fill<QuickSum>(kernels.quick, kernels.quick_molecules);
  fill<CarefulSum>(kernels.careful, kernels.careful_molecules);
  return kernels;
}

}  // namespace

extern const ChargedPairMixedKernels charged_pair_mixed_kernels;
constinit const ChargedPairMixedKernels charged_pair_mixed_kernels = all_kernels();

}  // namespace noether::NOETHER_SIMD_LEVEL
