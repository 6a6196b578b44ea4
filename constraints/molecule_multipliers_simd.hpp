#pragma once
/// What multipliers of a molecule's constraints do to it, in lanes; for `*_simd.cpp` alone.

#include "constraints/molecule_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

/// Elements of G M^-1 G^T for constraints that share an atom, by the bonds at the start, in place of factors.
template <int P> HWY_INLINE void find_couplings(const MoleculePack& pack, const Slots<P>& s) {
  const EliminationLists p = *pack.kind;
  for (int k = 0; k < p.constraints; ++k) {
    const Vectors<P> r = load_vectors<P>(s.r + 3 * k * P);
    for (int e = p.row[k]; e < p.row[k + 1]; ++e)
      store(same<P>(p.coupling[e]) * dot(r, load_vectors<P>(s.r + 3 * p.column[e] * P)), s.factors + e * P);
  }
}

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

/// M^-1 G^T lambda into the columns, one axis after the other.
template <int P, class MakeRow>
HWY_INLINE void put(const MoleculePack& pack, const Slots<P>& s, const MakeRow& make_row) {
  const EliminationLists p = *pack.kind;
  double* const moved = s.more;  // shape (3, atoms)
  const auto move = [&](int atom, const Pack<P>& by, const Vectors<P>& v) HWY_ATTR {
    store(by * v.x, moved + atom * P);
    store(by * v.y, moved + (p.atoms + atom) * P);
    store(by * v.z, moved + (2 * p.atoms + atom) * P);
  };
  for (int at = 0; at < p.centers; ++at) {
    const EliminationCenter& c = p.center[at];
    move(c.atom, same<P>(c.inverse_mass), pull<P>(p, c, s));
    for (int k = c.first; k < c.leaves_end; ++k) {
      move(p.i[k], same<P>(p.inverse_mass_i[k]) * load<P>(s.lambda + k * P), load_vectors<P>(s.r + 3 * k * P));
    }
  }
  for (int axis = 0; axis < 3; ++axis) store_atoms<P>(pack, moved + axis * p.atoms * P, make_row(axis));
}
/// Multipliers of lanes that are no molecule of their own, or not solved, become 0.
template <int P> HWY_INLINE void leave_out_of(const Flags<P>& lanes, int constraints, double* lambda) {
  for (int k = 0; k < constraints; ++k) store(none_where(lanes, load<P>(lambda + k * P)), lambda + k * P);
}
template <int P> HWY_INLINE void leave_out(const MoleculePack& pack, const Flags<P>& lanes, const Slots<P>& s) {
  leave_out_of<P>(lanes, pack.kind->constraints, s.lambda);
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
