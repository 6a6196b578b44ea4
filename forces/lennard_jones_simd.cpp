#include "forces/lennard_jones_simd.hpp"

#include "forces/pair_lanes_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

HWY_INLINE std::int64_t type_at(const double* record) {
  std::int64_t type = 0;
  __builtin_memcpy(&type, record + 3, sizeof type);
  return type;
}

/// The numbers of a row in every lane: of one row for all, or of one row for each.
struct Parameters {
  Vector range2, close2, force12, force6, energy12, energy6, style0, style1;

  explicit Parameters(const LennardJonesRow& row) {
    const Lanes d;
    range2 = hn::Set(d, row.range2);
    close2 = hn::Set(d, row.close2);
    force12 = hn::Set(d, row.force12);
    force6 = hn::Set(d, row.force6);
    energy12 = hn::Set(d, row.energy12);
    energy6 = hn::Set(d, row.energy6);
    style0 = hn::Set(d, row.style[0]);
    style1 = hn::Set(d, row.style[1]);
  }
  /// @param rows  of the types of the particles in the lanes
  Parameters(const LennardJonesRow* const (&rows)[lanes], const double* records, const std::int32_t* offsets) {
    alignas(64) double column[8][lanes];
    for (std::ptrdiff_t k = 0; k < lanes; ++k) {
      const LennardJonesRow& row = rows[k][type_at(records + offsets[k])];
      const double numbers_of_row[8] = {row.range2,   row.close2,  row.force12,  row.force6,
                                        row.energy12, row.energy6, row.style[0], row.style[1]};
      for (int c = 0; c < 8; ++c) column[c][k] = numbers_of_row[c];
    }
    const Lanes d;
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
struct Terms {
  Vector energy, force;
};

/// S and dS/dt of a switch that falls from 1 at t = 0 to 0 at t = 1.
template <LennardJonesStyle style> HWY_INLINE void switch_off(Vector t, Vector& s, Vector& slope) {
  const Lanes d;
  const auto number = [&](double x) { return hn::Set(d, x); };
  const Vector t2 = hn::Mul(t, t), u = hn::Sub(number(1), t);
  if constexpr (style == LennardJonesStyle::switch_c2) {
    // 1 - t^3 (10 - 15 t + 6 t^2)
    s = hn::NegMulAdd(hn::Mul(t2, t), hn::MulAdd(t, hn::MulAdd(t, number(6), number(-15)), number(10)), number(1));
    slope = hn::Mul(number(-30), hn::Mul(t2, hn::Mul(u, u)));
  } else {
    // 1 - t^5 (126 - 420 t + 540 t^2 - 315 t^3 + 70 t^4)
    Vector p = hn::MulAdd(t, number(70), number(-315));
    p = hn::MulAdd(t, p, number(540));
    p = hn::MulAdd(t, p, number(-420));
    p = hn::MulAdd(t, p, number(126));
    const Vector t4 = hn::Mul(t2, t2), u2 = hn::Mul(u, u);
    s = hn::NegMulAdd(hn::Mul(t4, t), p, number(1));
    slope = hn::Mul(number(-630), hn::Mul(t4, hn::Mul(u2, u2)));
  }
}

/// @param inverse2  1 / r^2
template <LennardJonesStyle style, bool sums>
HWY_INLINE Terms terms_of(Vector r2, Vector inverse2, const Parameters& p) {
  const Lanes d;
  const Vector inverse6 = hn::Mul(hn::Mul(inverse2, inverse2), inverse2);
  const Vector bare = hn::Mul(inverse6, hn::MulSub(inverse6, p.force12, p.force6));  // F r
  constexpr bool switched = style == LennardJonesStyle::switch_c2 || style == LennardJonesStyle::switch_c4;
  Vector energy = hn::Zero(d);
  if constexpr (sums || switched) energy = hn::Mul(inverse6, hn::MulSub(inverse6, p.energy12, p.energy6));
  if constexpr (style == LennardJonesStyle::shifted) {
    return {hn::Sub(energy, p.style0), hn::Mul(inverse2, bare)};
  } else if constexpr (style == LennardJonesStyle::shifted_force) {
    const Vector inverse = hn::Sqrt(inverse2);
    if constexpr (sums) energy = hn::MulAdd(p.style1, hn::Mul(r2, inverse), hn::Sub(energy, p.style0));
    return {energy, hn::NegMulAdd(p.style1, inverse, hn::Mul(inverse2, bare))};
  } else {
    const Vector t = hn::ZeroIfNegative(hn::Mul(hn::Sub(r2, p.style0), p.style1));
    Vector s, slope;
    switch_off<style>(t, s, slope);
    // -dU/dr / r = S F/r - 2 U dS/dt / (cutoff^2 - style0)
    const Vector along = hn::Mul(hn::Mul(energy, slope), hn::Add(p.style1, p.style1));
    return {hn::Mul(energy, s), hn::MulSub(s, hn::Mul(inverse2, bare), along)};
  }
}

template <LennardJonesStyle style, bool sums, class Sum>
HWY_INLINE void add(const Parameters& p, const Distances& pair, Vector inverse2, LaneSums<sums, Sum>& all) {
  const Terms terms = terms_of<style, sums>(pair.r2, inverse2, p);
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
  const Parameters one_row(field.rows[0]);
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
      const Parameters p(rows, field.records, entries);
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
