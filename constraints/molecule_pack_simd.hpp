#pragma once
/// Numbers of 8 or 16 molecules side by side, and their way from and to the columns of particles; for `*_simd.cpp`
/// alone.

#include "constraints/molecule_row.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Register = hn::Vec<Tag>;
constexpr int width = static_cast<int>(hn::MaxLanes(Tag()));

/// One number of each of P molecules.
template <int P> struct Pack {
  static constexpr int registers = P / width;
  Register r[registers];
};
template <int P> struct Flags { hn::Mask<Tag> r[Pack<P>::registers]; };

template <int P, class F> HWY_INLINE Pack<P> each(const F& f) {
  Pack<P> made;
  for (int q = 0; q < Pack<P>::registers; ++q) made.r[q] = f(q);
  return made;
}
template <int P> HWY_INLINE Pack<P> load(const double* from) {
  return each<P>([&](int q) HWY_ATTR { return hn::Load(Tag(), from + q * width); });
}
template <int P> HWY_INLINE void store(const Pack<P>& a, double* to) {
  for (int q = 0; q < Pack<P>::registers; ++q) hn::Store(a.r[q], Tag(), to + q * width);
}
template <int P> HWY_INLINE Pack<P> same(double x) {
  return each<P>([&](int) HWY_ATTR { return hn::Set(Tag(), x); });
}
template <int P> HWY_INLINE Pack<P> operator+(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::Add(a.r[q], b.r[q]); });
}
template <int P> HWY_INLINE Pack<P> operator-(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::Sub(a.r[q], b.r[q]); });
}
template <int P> HWY_INLINE Pack<P> operator*(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::Mul(a.r[q], b.r[q]); });
}
template <int P> HWY_INLINE Pack<P> operator/(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::Div(a.r[q], b.r[q]); });
}
template <int P> HWY_INLINE Pack<P> absolute(const Pack<P>& a) {
  return each<P>([&](int q) HWY_ATTR { return hn::Abs(a.r[q]); });
}
template <int P> HWY_INLINE Pack<P> root(const Pack<P>& a) {
  return each<P>([&](int q) HWY_ATTR { return hn::Sqrt(a.r[q]); });
}
/// The larger one; not a number if one of them is not.
template <int P> HWY_INLINE Pack<P> larger(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR {
    return hn::Add(hn::Max(a.r[q], b.r[q]), hn::Sub(hn::Add(a.r[q], b.r[q]), hn::Add(a.r[q], b.r[q])));
  });
}
/// The larger one of two numbers: quicker, but b if one is not a number.
template <int P> HWY_INLINE Pack<P> larger_number(const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::Max(a.r[q], b.r[q]); });
}
/// c + a b
template <int P> HWY_INLINE Pack<P> add_product(const Pack<P>& a, const Pack<P>& b, const Pack<P>& c) {
  return each<P>([&](int q) HWY_ATTR { return hn::MulAdd(a.r[q], b.r[q], c.r[q]); });
}
/// c - a b
template <int P> HWY_INLINE Pack<P> take_product(const Pack<P>& a, const Pack<P>& b, const Pack<P>& c) {
  return each<P>([&](int q) HWY_ATTR { return hn::NegMulAdd(a.r[q], b.r[q], c.r[q]); });
}

/// Where a <= b does not hold.
template <int P> HWY_INLINE Flags<P> exceeds(const Pack<P>& a, const Pack<P>& b) {
  Flags<P> made;
  for (int q = 0; q < Pack<P>::registers; ++q) made.r[q] = hn::Not(hn::Le(a.r[q], b.r[q]));
  return made;
}
template <int P> HWY_INLINE Flags<P> both(const Flags<P>& a, const Flags<P>& b) {
  Flags<P> made;
  for (int q = 0; q < Pack<P>::registers; ++q) made.r[q] = hn::And(a.r[q], b.r[q]);
  return made;
}
template <int P> HWY_INLINE Flags<P> either(const Flags<P>& a, const Flags<P>& b) {
  Flags<P> made;
  for (int q = 0; q < Pack<P>::registers; ++q) made.r[q] = hn::Or(a.r[q], b.r[q]);
  return made;
}
template <int P> HWY_INLINE Flags<P> but_not(const Flags<P>& a, const Flags<P>& b) {
  Flags<P> made;
  for (int q = 0; q < Pack<P>::registers; ++q) made.r[q] = hn::AndNot(b.r[q], a.r[q]);
  return made;
}
template <int P> HWY_INLINE bool any(const Flags<P>& a) {
  auto all = a.r[0];
  for (int q = 1; q < Pack<P>::registers; ++q) all = hn::Or(all, a.r[q]);
  return !hn::AllFalse(Tag(), all);
}
template <int P> HWY_INLINE unsigned bits_of(const Flags<P>& a) {
  unsigned bits = 0;
  for (int q = 0; q < Pack<P>::registers; ++q) {
    std::uint8_t own[8] = {};
    hn::StoreMaskBits(Tag(), a.r[q], own);
    bits |= (own[0] & ((1U << width) - 1)) << (q * width);
  }
  return bits;
}
/// a + b in flagged lanes, a in others.
template <int P> HWY_INLINE Pack<P> add_where(const Flags<P>& flags, const Pack<P>& a, const Pack<P>& b) {
  return each<P>([&](int q) HWY_ATTR { return hn::IfThenElse(flags.r[q], hn::Add(a.r[q], b.r[q]), a.r[q]); });
}
/// 0 in other lanes.
template <int P> HWY_INLINE Pack<P> only_where(const Flags<P>& flags, const Pack<P>& a) {
  return each<P>([&](int q) HWY_ATTR { return hn::IfThenElseZero(flags.r[q], a.r[q]); });
}
/// 0 in flagged lanes.
template <int P> HWY_INLINE Pack<P> none_where(const Flags<P>& flags, const Pack<P>& a) {
  return each<P>([&](int q) HWY_ATTR { return hn::IfThenZeroElse(flags.r[q], a.r[q]); });
}
template <int P> HWY_INLINE Flags<P> flags_of(unsigned bits) {
  alignas(64) double marks[P];
  for (int l = 0; l < P; ++l) marks[l] = (bits >> l & 1U) != 0 ? 1 : 0;
  return exceeds(load<P>(marks), same<P>(0.5));
}

template <int P> struct Vectors { Pack<P> x, y, z; };
template <int P> HWY_INLINE Vectors<P> load_vectors(const double* from) {
  return {load<P>(from), load<P>(from + P), load<P>(from + 2 * P)};
}
template <int P> HWY_INLINE void store(const Vectors<P>& a, double* to) {
  store(a.x, to), store(a.y, to + P), store(a.z, to + 2 * P);
}
template <int P> HWY_INLINE Vectors<P> operator+(const Vectors<P>& a, const Vectors<P>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int P> HWY_INLINE Vectors<P> operator-(const Vectors<P>& a, const Vectors<P>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int P> HWY_INLINE Pack<P> dot(const Vectors<P>& a, const Vectors<P>& b) {
  return add_product(a.x, b.x, add_product(a.y, b.y, a.z * b.z));
}
template <int P> HWY_INLINE Vectors<P> operator*(const Pack<P>& a, const Vectors<P>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <int P> HWY_INLINE Vectors<P> cross(const Vectors<P>& a, const Vectors<P>& b) {
  return {take_product(a.z, b.y, a.y * b.z), take_product(a.x, b.z, a.z * b.x), take_product(a.y, b.x, a.x * b.y)};
}
template <int P> HWY_INLINE Vectors<P> add_product(const Pack<P>& a, const Vectors<P>& b, const Vectors<P>& c) {
  return {add_product(a, b.x, c.x), add_product(a, b.y, c.y), add_product(a, b.z, c.z)};
}
template <int P> HWY_INLINE Vectors<P> take_product(const Pack<P>& a, const Vectors<P>& b, const Vectors<P>& c) {
  return {take_product(a, b.x, c.x), take_product(a, b.y, c.y), take_product(a, b.z, c.z)};
}

// ---- columns -------------------------------------------------------------------------------------------------------

/// Four atoms of eight molecules: rows of four numbers, from each base on, into four slots P numbers apart.
template <int P> HWY_INLINE void rows_to_slots(const double* from, const std::int32_t* base, double* slots) {
#if HWY_TARGET <= HWY_AVX3
  const auto pair = [&](int a, int b) HWY_ATTR {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(from + base[a])), _mm256_loadu_pd(from + base[b]),
                              1);
  };
  const __m512d q0 = pair(0, 2), q1 = pair(1, 3), q2 = pair(4, 6), q3 = pair(5, 7);
  const __m512d a = _mm512_unpacklo_pd(q0, q1), b = _mm512_unpacklo_pd(q2, q3);
  const __m512d c = _mm512_unpackhi_pd(q0, q1), d = _mm512_unpackhi_pd(q2, q3);
  _mm512_store_pd(slots, _mm512_shuffle_f64x2(a, b, 0x88));
  _mm512_store_pd(slots + P, _mm512_shuffle_f64x2(c, d, 0x88));
  _mm512_store_pd(slots + 2 * P, _mm512_shuffle_f64x2(a, b, 0xdd));
  _mm512_store_pd(slots + 3 * P, _mm512_shuffle_f64x2(c, d, 0xdd));
#elif HWY_TARGET == HWY_AVX2
  const hn::FixedTag<double, 4> t;
  for (int half = 0; half < 2; ++half, base += 4, slots += 4) {
    const auto q0 = hn::LoadU(t, from + base[0]), q1 = hn::LoadU(t, from + base[1]);
    const auto q2 = hn::LoadU(t, from + base[2]), q3 = hn::LoadU(t, from + base[3]);
    const auto a = hn::InterleaveLower(t, q0, q1), b = hn::InterleaveLower(t, q2, q3);
    const auto c = hn::InterleaveUpper(t, q0, q1), d = hn::InterleaveUpper(t, q2, q3);
    hn::Store(hn::ConcatLowerLower(t, b, a), t, slots);
    hn::Store(hn::ConcatLowerLower(t, d, c), t, slots + P);
    hn::Store(hn::ConcatUpperUpper(t, b, a), t, slots + 2 * P);
    hn::Store(hn::ConcatUpperUpper(t, d, c), t, slots + 3 * P);
  }
#else
  for (int lane = 0; lane < 8; ++lane) {
    for (int k = 0; k < 4; ++k) slots[k * P + lane] = from[base[lane] + k];
  }
#endif
}

/// The way back: `row(tag, at, numbers)` with up to four numbers that go to `at` and behind it.
template <int P, class Row>
HWY_INLINE void slots_to_rows(const double* slots, const std::int32_t* base, const Row& row) {
#if HWY_TARGET <= HWY_AVX3
  const hn::FixedTag<double, 4> t;
  const __m512d a0 = _mm512_load_pd(slots), a1 = _mm512_load_pd(slots + P);
  const __m512d a2 = _mm512_load_pd(slots + 2 * P), a3 = _mm512_load_pd(slots + 3 * P);
  const __m512d even01 = _mm512_unpacklo_pd(a0, a1), odd01 = _mm512_unpackhi_pd(a0, a1);
  const __m512d even23 = _mm512_unpacklo_pd(a2, a3), odd23 = _mm512_unpackhi_pd(a2, a3);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
  const auto four = [&](__m512d even, __m512d odd, const std::int32_t* at) HWY_ATTR {
    row(t, at[0], hn::Vec<decltype(t)>{_mm512_castpd512_pd256(even)});
    row(t, at[1], hn::Vec<decltype(t)>{_mm512_castpd512_pd256(odd)});
    row(t, at[2], hn::Vec<decltype(t)>{_mm512_extractf64x4_pd(even, 1)});
    row(t, at[3], hn::Vec<decltype(t)>{_mm512_extractf64x4_pd(odd, 1)});
  };
  four(_mm512_permutex2var_pd(even01, low, even23), _mm512_permutex2var_pd(odd01, low, odd23), base);
  four(_mm512_permutex2var_pd(even01, high, even23), _mm512_permutex2var_pd(odd01, high, odd23), base + 4);
#elif HWY_TARGET == HWY_AVX2
  const hn::FixedTag<double, 4> t;
  for (int half = 0; half < 2; ++half, base += 4, slots += 4) {
    const auto a0 = hn::Load(t, slots), a1 = hn::Load(t, slots + P);
    const auto a2 = hn::Load(t, slots + 2 * P), a3 = hn::Load(t, slots + 3 * P);
    const auto even01 = hn::InterleaveLower(t, a0, a1), odd01 = hn::InterleaveUpper(t, a0, a1);
    const auto even23 = hn::InterleaveLower(t, a2, a3), odd23 = hn::InterleaveUpper(t, a2, a3);
    row(t, base[0], hn::ConcatLowerLower(t, even23, even01));
    row(t, base[1], hn::ConcatLowerLower(t, odd23, odd01));
    row(t, base[2], hn::ConcatUpperUpper(t, even23, even01));
    row(t, base[3], hn::ConcatUpperUpper(t, odd23, odd01));
  }
#else
  const hn::CappedTag<double, 1> t;
  for (int lane = 0; lane < 8; ++lane) {
    for (int k = 0; k < 4; ++k) row(t, base[lane] + k, hn::Set(t, slots[k * P + lane]));
  }
#endif
}

/// One coordinate of the atoms of a pack into slots.
template <int P> HWY_INLINE void load_atoms(const MoleculePack& pack, const double* from, double* slots) {
  const int atoms = pack.kind->atoms;
  if (pack.in_a_row && atoms == 3) {
    for (int lane = 0; lane < P; lane += width) {
      Register a, b, c;
      hn::LoadInterleaved3(Tag(), from + pack.atoms[lane], a, b, c);
      hn::Store(a, Tag(), slots + lane);
      hn::Store(b, Tag(), slots + P + lane);
      hn::Store(c, Tag(), slots + 2 * P + lane);
    }
    return;
  }
  if (!pack.side_by_side || atoms < 4) {
    for (int k = 0; k < atoms * P; ++k) slots[k] = from[pack.atoms[k]];
    return;
  }
  for (int lane = 0; lane < P; lane += 8) {
    for (int a = 0; a < atoms; a += 4) {
      const int at = a + 4 <= atoms ? a : atoms - 4;  // the last ones may be read twice
      rows_to_slots<P>(from + at, pack.atoms + lane, slots + at * P + lane);
    }
  }
}
/// What slots have of each atom, `row(tag, at, numbers)`, lane after lane: numbers of lanes that are no molecule of
/// their own must be 0, and these come after the molecule that they repeat.
template <int P, class Row> HWY_INLINE void store_atoms(const MoleculePack& pack, double* slots, const Row& row) {
  const int atoms = pack.kind->atoms;
  if (pack.in_a_row && atoms == 3) {
    for (int lane = 0; lane < P; lane += width) {
      alignas(64) double rows[3 * width];
      hn::StoreInterleaved3(hn::Load(Tag(), slots + lane), hn::Load(Tag(), slots + P + lane),
                            hn::Load(Tag(), slots + 2 * P + lane), Tag(), rows);
      for (int k = 0; k < 3; ++k) row(Tag(), pack.atoms[lane] + k * width, hn::Load(Tag(), rows + k * width));
    }
    return;
  }
  if (!pack.side_by_side || atoms < 4) {
    const hn::CappedTag<double, 1> one;
    for (int k = 0; k < atoms * P; ++k) row(one, pack.atoms[k], hn::Set(one, slots[k]));
    return;
  }
  const int rest = atoms % 4;
  for (int lane = 0; lane < P; lane += 8) {
    for (int a = 0; a + 4 <= atoms; a += 4) {
      slots_to_rows<P>(slots + a * P + lane, pack.atoms + a * P + lane, row);
    }
  }
  if (rest == 0) return;
  for (int a = atoms - 4; a < atoms - rest; ++a) store(same<P>(0), slots + a * P);  // these have had theirs
  for (int lane = 0; lane < P; lane += 8) {
    slots_to_rows<P>(slots + (atoms - 4) * P + lane, pack.atoms + (atoms - 4) * P + lane, row);
  }
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
