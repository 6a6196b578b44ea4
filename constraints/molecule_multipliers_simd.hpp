#pragma once
/// What multipliers of a molecule's constraints do to it, in lanes; for `*_simd.cpp` alone.

#include "constraints/molecule_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// u = sum of lambda r over the constraints of a center, those it is atom j of with the other sign.
template <int P> HWY_INLINE Vectors<P> pull(const EliminationLists& p, const EliminationCenter& c, const Slots<P>& s) {
  Vectors<P> u{same<P>(0), same<P>(0), same<P>(0)};
  for (int o = c.out_begin; o < c.out_end; ++o) {
    const int k = p.outgoing[o];
    u = add_product(load<P>(s.lambda + k * P), load_vectors<P>(s.r + 3 * k * P), u);
  }
  for (int k = c.first; k < c.end; ++k)
    u = take_product(load<P>(s.lambda + k * P), load_vectors<P>(s.r + 3 * k * P), u);
  return u;
}

/// Calls `use(k, vector)` with s + G M^-1 G^T lambda, constraint by constraint in the order of elimination, and leaves
/// the pulls of centers in u.
template <int P, class Use>
HWY_INLINE void with_multipliers(const MoleculePack& pack, const Slots<P>& s, const Use& use) {
  const EliminationLists p = *pack.kind;
  for (int at = 0; at < p.centers; ++at) {
    const EliminationCenter& c = p.center[at];
    const Vectors<P> u = pull<P>(p, c, s);
    store(u, s.u + 3 * at * P);
    const Pack<P> w = same<P>(c.inverse_mass);
    for (int k = c.first; k < c.end; ++k) {
      const Vectors<P> before = load_vectors<P>(s.s + 3 * k * P);
      const Pack<P> own = same<P>(p.inverse_mass_i[k]);
      if (k < c.leaves_end) {
        use(k,
            take_product(w, u, add_product(own * load<P>(s.lambda + k * P), load_vectors<P>(s.r + 3 * k * P), before)));
      } else {
        use(k, take_product(w, u, add_product(own, load_vectors<P>(s.u + 3 * p.center_of[p.i[k]] * P), before)));
      }
    }
  }
}

/// M^-1 G^T lambda into the columns, one axis after the other; u has the pulls of centers.
template <int P, class MakeRow>
HWY_INLINE void put(const MoleculePack& pack, const Slots<P>& s, const MakeRow& make_row) {
  const EliminationLists& p = *pack.kind;
  for (int axis = 0; axis < 3; ++axis) {
    for (int at = 0; at < p.centers; ++at) {
      const EliminationCenter& c = p.center[at];
      store(same<P>(c.inverse_mass) * load<P>(s.u + (3 * at + axis) * P), s.one + c.atom * P);
      for (int k = c.first; k < c.leaves_end; ++k) {
        store((same<P>(p.inverse_mass_i[k]) * load<P>(s.lambda + k * P)) * load<P>(s.r + (3 * k + axis) * P),
              s.one + p.i[k] * P);
      }
    }
    store_atoms<P>(pack, s.one, make_row(axis));
  }
}
/// The pulls of all centers into u.
template <int P> HWY_INLINE void find_pulls(const MoleculePack& pack, const Slots<P>& s) {
  const EliminationLists& p = *pack.kind;
  for (int at = 0; at < p.centers; ++at) store(pull<P>(p, p.center[at], s), s.u + 3 * at * P);
}
/// Lambda of lanes that are no molecule of their own, or not solved, becomes 0, and pulls follow.
template <int P> HWY_INLINE void leave_out(const MoleculePack& pack, const Flags<P>& lanes, const Slots<P>& s) {
  const EliminationLists& p = *pack.kind;
  for (int k = 0; k < p.constraints; ++k) store(none_where(lanes, load<P>(s.lambda + k * P)), s.lambda + k * P);
  find_pulls<P>(pack, s);
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
