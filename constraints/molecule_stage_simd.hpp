#pragma once
/// What stages of all solvers in lanes have in common; for `*_simd.cpp` alone.

#include "constraints/molecule_pack_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// Scratch of a pack, in slots of P numbers.
template <int P> struct Slots {
  double *r, *s, *lambda, *y, *u, *row, *one, *factors, *inverse, *more;

  explicit Slots(const MoleculePack& pack) {
    const EliminationLists& p = *pack.kind;
    double* next = pack.scratch;
    const auto take = [&](int slots) {
      double* const mine = next;
      next += slots * P;
      return mine;
    };
    r = take(3 * p.constraints), s = take(3 * p.constraints), lambda = take(p.constraints), y = take(p.constraints);
    u = take(3 * p.centers), row = take(p.longest_row + 1), one = take(p.atoms);
    factors = take(p.entries), inverse = take(p.constraints), more = next;
  }
};

/// The nearest image of a difference of positions in the cell, which is exact.
template <int P> HWY_INLINE Pack<P> nearest(const Pack<P>& d, double edge) {
  return each<P>([&](int q) HWY_ATTR {
    const Register e = hn::Set(Tag(), edge), half = hn::Set(Tag(), 0.5 * edge);
    const Register far = hn::IfThenElseZero(hn::Gt(hn::Abs(d.r[q]), half), hn::CopySign(e, d.r[q]));
    return hn::Sub(d.r[q], far);
  });
}

/// Bond vectors r at the start.
template <int P> HWY_INLINE void find_bonds(const MoleculePack& pack, const MoleculeColumns& c, const Slots<P>& s) {
  const EliminationLists p = *pack.kind;
  for (int axis = 0; axis < 3; ++axis) {
    load_atoms<P>(pack, c.start[axis], s.one);
    for (int k = 0; k < p.constraints; ++k) {
      const Pack<P> d = load<P>(s.one + p.i[k] * P) - load<P>(s.one + p.j[k] * P);
      store(c.edge[axis] > 0 ? nearest<P>(d, c.edge[axis]) : d, s.r + (3 * k + axis) * P);
    }
  }
}
/// Differences of a column, beside r where they are of what has moved from there.
template <int P>
HWY_INLINE void find_differences(const MoleculePack& pack, double* const (&column)[3], const double (&edge)[3],
                                 bool moved, const Slots<P>& s) {
  const EliminationLists p = *pack.kind;
  for (int axis = 0; axis < 3; ++axis) {
    load_atoms<P>(pack, column[axis], s.one);
    for (int k = 0; k < p.constraints; ++k) {
      const Pack<P> d = load<P>(s.one + p.i[k] * P) - load<P>(s.one + p.j[k] * P);
      store(moved && edge[axis] > 0 ? load<P>(s.r + (3 * k + axis) * P) + d : d, s.s + (3 * k + axis) * P);
    }
  }
}

/// x += c, in a periodic box to its grid, and v += c / h.
struct PositionRow {
  double *x, *v, inverse_h, magic;
  template <class T> HWY_INLINE void operator()(T t, std::ptrdiff_t at, hn::Vec<T> c) const {
    const auto big = hn::Set(t, magic), sum = hn::Add(hn::LoadU(t, x + at), c);
    hn::StoreU(magic > 0 ? hn::Sub(hn::Add(sum, big), big) : sum, t, x + at);
    hn::StoreU(hn::MulAdd(c, hn::Set(t, inverse_h), hn::LoadU(t, v + at)), t, v + at);
  }
};
/// v += c.
struct VelocityRow {
  double* v;
  template <class T> HWY_INLINE void operator()(T t, std::ptrdiff_t at, hn::Vec<T> c) const {
    hn::StoreU(hn::Add(hn::LoadU(t, v + at), c), t, v + at);
  }
};

/// The largest number in lanes that are not flagged; 0 if there is none.
template <int P> HWY_INLINE double largest_but(const Flags<P>& out, const Pack<P>& a) {
  alignas(64) double lanes[P];
  store(none_where(out, a), lanes);
  double most = 0;
  for (const double one : lanes) most = one > most ? one : most;
  return most;
}

template <int P> HWY_INLINE Flags<P> idle_lanes(const MoleculePack& pack) {
  return flags_of<P>(~pack.live & ((1U << P) - 1));
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
