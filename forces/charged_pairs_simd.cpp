#include "forces/charged_pairs_simd.hpp"

#include "forces/lennard_jones_lanes_simd.hpp"
#include "forces/pair_lanes_simd.hpp"
#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

enum class Series : std::uint8_t { two_terms, switched, any };

/// sum_k coefficients[k] t^k of several t: their chains go side by side.
template <Series kind, int n>
HWY_INLINE void polynomial(const double* coefficients, int terms, const Vector (&t)[n], Vector (&sum)[n]) {
  const Lanes d;
  if constexpr (kind == Series::any) {
    const Vector last = hn::Set(d, coefficients[terms - 1]);
    for (int k = 0; k < n; ++k) sum[k] = last;
    for (int term = terms - 2; term >= 0; --term) {
      const Vector one = hn::Set(d, coefficients[term]);
      for (int k = 0; k < n; ++k) sum[k] = hn::MulAdd(sum[k], t[k], one);
    }
  } else {
    const Vector first = hn::Set(d, coefficients[0]), second = hn::Set(d, coefficients[1]);
    for (int k = 0; k < n; ++k) sum[k] = hn::MulAdd(second, t[k], first);
  }
}

/// What n pairs do for charges of 1: each step of one waits for the step before, and those of the others fill the time.
template <Series kind, bool sums, int n>
HWY_INLINE void unit_terms(const ChargeSeries& series, const Vector (&r2)[n], Vector (&energy)[n], Vector (&force)[n]) {
  const Lanes d;
  const Vector scale = hn::Set(d, series.scale), offset = hn::Set(d, series.offset);
  Vector t[n], inverse[n];
  reciprocal_sqrt(d, r2, inverse);
  for (int k = 0; k < n; ++k) t[k] = kind == Series::any ? hn::MulAdd(r2[k], scale, offset) : r2[k];
  constexpr bool energies = sums || kind == Series::switched;
  if constexpr (energies) {
    polynomial<kind>(series.energy, series.energy_terms, t, energy);
    for (int k = 0; k < n; ++k) energy[k] = hn::Add(inverse[k], energy[k]);
  } else {
    for (int k = 0; k < n; ++k) energy[k] = hn::Zero(d);
  }
  if constexpr (kind == Series::any) {
    polynomial<kind>(series.force, series.force_terms, t, force);
  } else {
    for (int k = 0; k < n; ++k) force[k] = hn::Set(d, series.force[0]);
  }
  for (int k = 0; k < n; ++k) force[k] = hn::MulAdd(hn::Mul(inverse[k], inverse[k]), inverse[k], force[k]);
  if constexpr (kind == Series::switched) {
    for (int k = 0; k < n; ++k) {
      const Vector by = hn::Set(d, series.switch_inverse);
      const Vector part = hn::ZeroIfNegative(hn::Mul(hn::Sub(r2[k], hn::Set(d, series.switch_from2)), by));
      Vector s, slope;
      switch_off<LennardJonesStyle::switch_c4>(d, part, s, slope);
      const Vector along = hn::Mul(hn::Mul(energy[k], slope), hn::Add(by, by));
      force[k] = hn::MulSub(s, force[k], along);
      energy[k] = hn::Mul(energy[k], s);
    }
  }
}

/// Forces of one register of particles and their neighbors, some rows at a time.
template <Series kind, bool sums, class Sum>
HWY_INLINE void sum_lanes(const ChargedPairField& field, const PairGroup& group, std::ptrdiff_t first, PairSums& out) {
  constexpr int n = std::is_same_v<Sum, QuickSum> ? 4 : 1;
  const Lanes d;
  const ChargeSeries& series = *field.series;
  LaneSums<sums, Sum> all(field.force_unit, field.energy_unit);
  const Records own = load_records(field.records, group.records + first);
  const Vector range2 = hn::Set(d, series.range2);
  Vector nearest = hn::Set(d, 1e300);
  const std::int32_t* entries = group.entries + first;
  std::ptrdiff_t row = 0;
  for (; row < group.rows; row += n, entries += 8 * n) {
    Vector dx[n], dy[n], dz[n], r2[n], product[n], force[n], energy[n];
    for (int k = 0; k < n; ++k) {
      __builtin_prefetch(entries + 8 * (k + rows_asked_ahead));
      const Records other = load_records(field.records, entries + 8 * k);
      const Distances pair = distances(own.place, other.place);
      dx[k] = pair.dx, dy[k] = pair.dy, dz[k] = pair.dz, r2[k] = pair.r2;
      product[k] = hn::Mul(own.fourth, other.fourth);
    }
    unit_terms<kind, sums>(series, r2, energy, force);
    for (int k = 0; k < n; ++k) {
      nearest = lesser(nearest, r2[k]);
      all.add(hn::Lt(r2[k], range2), hn::Mul(product[k], energy[k]), hn::Mul(product[k], force[k]), dx[k], dy[k],
              dz[k]);
    }
  }
  all.store(row, first, out);
  out.close = out.close || !hn::AllTrue(d, hn::Ge(nearest, hn::Set(d, field.close2)));
}

/// Forces on the sites of one register of molecules: of each neighbor a site at a time, with the three of their own.
template <Series kind, bool sums, class Sum>
HWY_INLINE void sum_molecule_lanes(const ChargedMoleculeField& field, const PairGroup& group, std::ptrdiff_t first,
                                   PairSums* out) {
  constexpr int sites = 3;
  const Lanes d;
  const auto load = [&](const std::int32_t* offsets, int site) HWY_ATTR {
    return load_records([&](int k) HWY_ATTR {
             return field.records + sites * static_cast<std::ptrdiff_t>(offsets[k]) + 4 * site;
           })
        .place;
  };
  const LaneSums<sums, Sum> nothing(field.force_unit, field.energy_unit);
  LaneSums<sums, Sum> all[sites] = {nothing, nothing, nothing};
  Points own[sites];
  for (int i = 0; i < sites; ++i) own[i] = load(group.records + first, i);
  const Vector range2 = hn::Set(d, field.series->range2);
  Vector nearest = hn::Set(d, 1e300);
  const std::int32_t* entries = group.entries + first;
  for (std::ptrdiff_t row = 0; row < group.rows; ++row, entries += 8) {
    __builtin_prefetch(entries + 8 * rows_asked_ahead);
#pragma GCC unroll 1
    for (int j = 0; j < sites; ++j) {
      const Points other = load(entries, j);
      Vector dx[sites], dy[sites], dz[sites], r2[sites], force[sites], energy[sites];
      for (int i = 0; i < sites; ++i) {
        const Distances pair = distances(own[i], other);
        dx[i] = pair.dx, dy[i] = pair.dy, dz[i] = pair.dz, r2[i] = pair.r2;
      }
      unit_terms<kind, sums>(*field.series, r2, energy, force);
      for (int i = 0; i < sites; ++i) {
        const Vector product = hn::Set(d, field.products[i][j]);
        nearest = lesser(nearest, r2[i]);
        all[i].add(hn::Lt(r2[i], range2), hn::Mul(product, energy[i]), hn::Mul(product, force[i]), dx[i], dy[i], dz[i]);
      }
    }
  }
  for (int i = 0; i < sites; ++i) all[i].store(sites * group.rows, first, out[i]);
  out->close = out->close || !hn::AllTrue(d, hn::Ge(nearest, hn::Set(d, field.close2)));
}

template <Series kind, bool sums, class Sum>
void sum_molecules(const ChargedMoleculeField& field, const PairGroup& group, PairSums* out) {
  out->close = false;
  if (group.rows == 0) {
    __builtin_memset(out, 0, 3 * sizeof *out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < 8; first += lanes)
    sum_molecule_lanes<kind, sums, Sum>(field, group, first, out);
}

template <Series kind, bool sums, class Sum>
void sum_pairs(const ChargedPairField& field, const PairGroup& group, PairSums& out) {
  out.close = false;
  if (group.rows == 0) {
    __builtin_memset(&out, 0, sizeof out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < 8; first += lanes) sum_lanes<kind, sums, Sum>(field, group, first, out);
}

template <class Sum> constexpr void fill(SumChargedPairs (&table)[3][2]) {
  table[0][0] = sum_pairs<Series::two_terms, false, Sum>;
  table[0][1] = sum_pairs<Series::two_terms, true, Sum>;
  table[1][0] = sum_pairs<Series::switched, false, Sum>;
  table[1][1] = sum_pairs<Series::switched, true, Sum>;
  table[2][0] = sum_pairs<Series::any, false, Sum>;
  table[2][1] = sum_pairs<Series::any, true, Sum>;
}

template <class Sum> constexpr void fill(SumChargedMolecules (&table)[3][2]) {
  table[0][0] = sum_molecules<Series::two_terms, false, Sum>;
  table[0][1] = sum_molecules<Series::two_terms, true, Sum>;
  table[1][0] = sum_molecules<Series::switched, false, Sum>;
  table[1][1] = sum_molecules<Series::switched, true, Sum>;
  table[2][0] = sum_molecules<Series::any, false, Sum>;
  table[2][1] = sum_molecules<Series::any, true, Sum>;
}

constexpr ChargedPairKernels all_kernels() {
  ChargedPairKernels kernels{};
  fill<QuickSum>(kernels.quick_molecules);
  fill<CarefulSum>(kernels.careful_molecules);
  fill<QuickSum>(kernels.quick);
  fill<CarefulSum>(kernels.careful);
  return kernels;
}

}  // namespace

extern const ChargedPairKernels charged_pair_kernels;
constinit const ChargedPairKernels charged_pair_kernels = all_kernels();

}  // namespace noether::NOETHER_SIMD_LEVEL
