#include "forces/lennard_jones_simd.hpp"

#include "forces/lennard_jones_lanes_simd.hpp"
#include "forces/pair_lanes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

HWY_INLINE std::int64_t type_at(const double* record) {
  std::int64_t type = 0;
  __builtin_memcpy(&type, record + 3, sizeof type);
  return type;
}

template <LennardJonesStyle style, bool sums, class Sum>
HWY_INLINE void add(const Parameters<Lanes>& p, const Distances& pair, Vector inverse2, LaneSums<sums, Sum>& all) {
  const auto terms = terms_of<style, sums>(pair.r2, inverse2, p);
  all.add(hn::Lt(pair.r2, p.range2), terms.energy, terms.force, pair.dx, pair.dy, pair.dz);
}

/// Forces of one register of particles and their neighbors. Three rows are under way at a time, one each being loaded,
/// divided and summed: each waits for what it needs while the others compute.
template <LennardJonesStyle style, bool many_types, bool sums, class Sum>
HWY_INLINE void sum_lanes(const PairField& field, const PairGroup& group, std::ptrdiff_t first, PairSums& out) {
  const Lanes d;
  LaneSums<sums, Sum> all(field.force_unit, field.energy_unit);
  const Points own = load_points(field.records, group.records + first);
  const LennardJonesRow* rows[lanes];
  for (std::ptrdiff_t k = 0; k < lanes && many_types; ++k) {
    rows[k] = field.rows + type_at(field.records + group.records[first + k]) * field.types;
  }
  const Parameters<Lanes> one_row(field.rows[0]);
  const Vector one = hn::Set(d, 1.0);
  Vector nearest = hn::Set(d, 1e300);  // of many types less the distance at which a pair is close
  const std::int32_t *entries = group.entries + first, *last = entries + 8 * (group.rows - 1);
  const auto next = [&](const std::int32_t* from) { return from < last ? from + 8 : last; };
  const std::int32_t* ahead = next(entries);
  Distances divided = distances(own, load_points(field.records, entries));
  Vector inverse2 = hn::Div(one, divided.r2);
  Distances loaded = distances(own, load_points(field.records, ahead));
  for (std::ptrdiff_t row = 0; row < group.rows; ++row, entries += 8) {
    const Distances pair = divided;
    const Vector pair_inverse2 = inverse2;
    divided = loaded;
    inverse2 = hn::Div(one, divided.r2);
    __builtin_prefetch(entries + 8 * rows_asked_ahead);
    ahead = next(ahead);
    loaded = distances(own, load_points(field.records, ahead));
    if constexpr (many_types) {
      const Parameters<Lanes> p([&](std::ptrdiff_t k) -> const auto& {
        return rows[k][type_at(field.records + entries[k])];
      });
      nearest = lesser(nearest, hn::Sub(pair.r2, p.close2));
      add<style>(p, pair, pair_inverse2, all);
    } else {
      nearest = lesser(nearest, pair.r2);
      add<style>(one_row, pair, pair_inverse2, all);
    }
  }
  all.store(group.rows, first, out);
  const auto close = hn::Lt(nearest, many_types ? hn::Zero(d) : one_row.close2);
  out.close = out.close || !hn::AllFalse(d, close);
}

template <LennardJonesStyle style, bool many_types, bool sums, class Sum>
void sum_pairs(const PairField& field, const PairGroup& group, PairSums& out) {
  out.close = false;
  if (group.rows == 0) {
    __builtin_memset(&out, 0, sizeof out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < 8; first += lanes) {
    sum_lanes<style, many_types, sums, Sum>(field, group, first, out);
  }
}

template <LennardJonesStyle style, class Sum> constexpr void fill(SumPairs (&table)[2][2]) {
  table[0][0] = sum_pairs<style, false, false, Sum>;
  table[0][1] = sum_pairs<style, false, true, Sum>;
  table[1][0] = sum_pairs<style, true, false, Sum>;
  table[1][1] = sum_pairs<style, true, true, Sum>;
}

constexpr LennardJonesKernels all_kernels() {
  using enum LennardJonesStyle;
  LennardJonesKernels kernels{};
  kernels.lanes = static_cast<int>(lanes);
  fill<shifted, QuickSum>(kernels.quick[0]);
  fill<shifted_force, QuickSum>(kernels.quick[1]);
  fill<switch_c2, QuickSum>(kernels.quick[2]);
  fill<switch_c4, QuickSum>(kernels.quick[3]);
  fill<shifted, CarefulSum>(kernels.careful[0]);
  fill<shifted_force, CarefulSum>(kernels.careful[1]);
  fill<switch_c2, CarefulSum>(kernels.careful[2]);
  fill<switch_c4, CarefulSum>(kernels.careful[3]);
  return kernels;
}

}  // namespace

extern const LennardJonesKernels lennard_jones_kernels;
constinit const LennardJonesKernels lennard_jones_kernels = all_kernels();

}  // namespace noether::NOETHER_SIMD_LEVEL
