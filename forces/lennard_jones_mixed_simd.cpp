#include "forces/lennard_jones_mixed_simd.hpp"

#include "forces/lennard_jones_lanes_simd.hpp"
#include "forces/minimum_simd.hpp"
#include "forces/mixed_lanes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Forces of the particles of a group from `first` on.
template <LennardJonesStyle style, bool many_types, class Sum>
HWY_INLINE void sum_lanes(const MixedPairField& field, const PairGroup& group, std::ptrdiff_t first, PairSums& out) {
  const Lanes d;
  Sum force[3];
  std::int32_t own_records[lanes];
  for (std::ptrdiff_t k = 0; k < lanes; ++k) own_records[k] = group.records[first + k % lanes_of_group];
  const Points own = load_points(field.records, own_records);
  const LennardJonesRow* rows[lanes];
  for (std::ptrdiff_t k = 0; k < lanes && many_types; ++k) {
    rows[k] = field.rows + field.records[own_records[k] + 3] * field.types;
  }
  const Parameters<Lanes> one_row(field.rows[0]);
  const Vector unit = hn::Set(d, static_cast<float>(field.inverse2_unit));
  Vector nearest = hn::Set(d, 1e30F);  // of many types less the distance at which a pair is close
  const std::ptrdiff_t turns = (group.rows + rows_at_once - 1) / rows_at_once;
  constexpr std::ptrdiff_t stride = group_size * rows_at_once;
  const std::int32_t* entries = group.entries + first;
  for (std::ptrdiff_t turn = 0; turn < turns;) {
    const std::ptrdiff_t until = turn + Sum::most < turns ? turn + Sum::most : turns;
    for (; turn < until; ++turn, entries += stride) {
      __builtin_prefetch(entries + group_size * rows_asked_ahead);
      const Distances pair = distances(own, load_points(field.records, entries));
      const Vector inverse2 = hn::Div(unit, pair.r2);
      const auto sum = [&](const Parameters<Lanes>& p) HWY_ATTR {
        const Vector strength = terms_of<style, false>(pair.r2, inverse2, p).force;
        const Vector k = hn::IfThenElseZero(hn::Lt(pair.r2, p.range2), strength);
        force[0].add(k, pair.dx);
        force[1].add(k, pair.dy);
        force[2].add(k, pair.dz);
      };
      if constexpr (many_types) {
        const Parameters<Lanes> p([&](std::ptrdiff_t k) -> const auto& {
          return rows[k][field.records[entries[k] + 3]];
        });
        nearest = lesser(nearest, hn::Sub(pair.r2, p.close2));
        sum(p);
      } else {
        nearest = lesser(nearest, pair.r2);
        sum(one_row);
      }
    }
    for (Sum& one : force) one.widen();
  }
  for (int k = 0; k < 3; ++k) force[k].store(out.force[k] + first);
  if constexpr (requires { force[0].strong; }) {
    for (std::ptrdiff_t k = 0; k < lanes_of_group; ++k) {
      out.strong[first + k] = force[0].strong[k] || force[1].strong[k] || force[2].strong[k];
    }
  }
  const auto close = hn::Lt(nearest, many_types ? hn::Zero(d) : one_row.close2);
  out.close = out.close || !hn::AllFalse(d, close);
}

template <LennardJonesStyle style, bool many_types, class Sum>
void sum_pairs(const MixedPairField& field, const PairGroup& group, PairSums& out) {
  out.close = false;
  if (group.rows == 0) {
    __builtin_memset(&out, 0, sizeof out);
    return;
  }
  for (std::ptrdiff_t first = 0; first < group_size; first += lanes_of_group) {
    sum_lanes<style, many_types, Sum>(field, group, first, out);
  }
}

template <LennardJonesStyle style> constexpr void fill(LennardJonesMixedKernels& kernels, std::size_t place) {
  kernels.quick[place][0] = sum_pairs<style, false, QuickSum>;
  kernels.quick[place][1] = sum_pairs<style, true, QuickSum>;
  kernels.careful[place][0] = sum_pairs<style, false, CarefulSum>;
  kernels.careful[place][1] = sum_pairs<style, true, CarefulSum>;
}

constexpr LennardJonesMixedKernels all_kernels() {
  using enum LennardJonesStyle;
  LennardJonesMixedKernels kernels{};
  fill<shifted>(kernels, 0);
  fill<shifted_force>(kernels, 1);
  fill<switch_c2>(kernels, 2);
  fill<switch_c4>(kernels, 3);
  return kernels;
}

}  // namespace

extern const LennardJonesMixedKernels lennard_jones_mixed_kernels;
constinit const LennardJonesMixedKernels lennard_jones_mixed_kernels = all_kernels();

}  // namespace noether::NOETHER_SIMD_LEVEL
