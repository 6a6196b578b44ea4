#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/newton_stage_simd.hpp"

#include <utility>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// A shape of centers that compilers know.
template <int code> struct Shape {
  static constexpr TreeShape shape = TreeShape::of(code);
  static constexpr int leaves = shape.leaves, own = shape.leaves + shape.inner;
  static constexpr bool linked = shape.inner > 0, out = shape.out, next = shape.next, exists = shape.exists();
  static constexpr int size = own * (own + 1) / 2;  ///< entries of the block of own constraints
};
/// Where entry (t, u) of a symmetric block stands: its lower triangle, row by row.
constexpr int entry_of(int t, int u) { return t > u ? t * (t + 1) / 2 + u : u * (u + 1) / 2 + t; }

/// Row t of such a block times a vector.
template <int P, int own>
HWY_INLINE Pack<P> product_with_row(const Pack<P>* block, int t, const Pack<P> (&vector)[own]) {
  Pack<P> sum = block[entry_of(t, 0)] * vector[0];
  for (int u = 1; u < own; ++u) sum = add_product(block[entry_of(t, u)], vector[u], sum);
  return sum;
}

/// What goes from a center to the next in registers.
template <int P> struct Link {
  Vectors<P> u, f;  ///< the pull; lambda r of the outgoing constraint
  Pack<P> carry;    ///< forward: what elimination of the center adds up for the outgoing constraint
  Pack<P> z;        ///< backward: the step of the last inner constraint
};

/// Visits the centers of one shape that follow each other: a loop of its own keeps the link in registers.
template <int P, int way, class Shape, class Visit>
HWY_INLINE int visit_run(const TreeCenter* centers, int at, int end, Link<P>& link, Visit& visit) {
  const int shape = centers[at].shape;
  Link<P> own = link;
  do {
    visit.template center<Shape>(centers[at], own);
    at += way;
  } while (at != end && centers[at].shape == shape);
  link = own;
  return at;
}
template <int code, int P, int way, class Visit>
HWY_INLINE bool visit_if(const TreeCenter* centers, int& at, int end, Link<P>& link, Visit& visit) {
  if constexpr (Shape<code>::exists) {
    if (centers[at].shape == code) {
      at = visit_run<P, way, Shape<code>>(centers, at, end, link, visit);
      return true;
    }
  }
  return false;
}
/// Calls `visit.center<Shape>(center, link)` for centers from `at` on.
template <int P, int way, class Visit, int... code>
HWY_INLINE void visit_all(const TreeCenter* centers, int at, int end, Visit& visit,
                          std::integer_sequence<int, code...>) {
  const Vectors<P> none{same<P>(0), same<P>(0), same<P>(0)};
  Link<P> link{none, none, same<P>(0), same<P>(0)};
  while (at != end && (visit_if<code, P, way>(centers, at, end, link, visit) || ...)) {
  }
}
template <int P, class Visit> HWY_INLINE void visit_inward(const MoleculePack& pack, Visit& visit) {
  visit_all<P, 1>(pack.tree, 0, pack.kind->centers, visit, std::make_integer_sequence<int, TreeShape::codes>());
}
template <int P, class Visit> HWY_INLINE void visit_outward(const MoleculePack& pack, Visit& visit) {
  visit_all<P, -1>(pack.tree, pack.kind->centers - 1, -1, visit, std::make_integer_sequence<int, TreeShape::codes>());
}

/// Inverts a symmetric block by cofactors. @return its determinant
template <int P> HWY_INLINE Pack<P> invert(Pack<P> (&b)[1]) {
  const Pack<P> determinant = b[0];
  b[0] = same<P>(1) / determinant;
  return determinant;
}
template <int P> HWY_INLINE Pack<P> invert(Pack<P> (&b)[3]) {
  const Pack<P> determinant = take_product(b[1], b[1], b[0] * b[2]), f = same<P>(1) / determinant, b0 = b[0];
  b[0] = b[2] * f, b[1] = same<P>(0) - b[1] * f, b[2] = b0 * f;
  return determinant;
}
template <int P> HWY_INLINE Pack<P> invert(Pack<P> (&b)[6]) {
  const Pack<P> c0 = take_product(b[4], b[4], b[2] * b[5]), c1 = take_product(b[1], b[5], b[3] * b[4]);
  const Pack<P> c3 = take_product(b[3], b[2], b[1] * b[4]);
  const Pack<P> determinant = add_product(b[0], c0, add_product(b[1], c1, b[3] * c3)), f = same<P>(1) / determinant;
  const Pack<P> c2 = take_product(b[3], b[3], b[0] * b[5]), c4 = take_product(b[0], b[4], b[1] * b[3]);
  const Pack<P> c5 = take_product(b[1], b[1], b[0] * b[2]);
  b[0] = c0 * f, b[1] = c1 * f, b[2] = c2 * f, b[3] = c3 * f, b[4] = c4 * f, b[5] = c5 * f;
  return determinant;
}
/// That of three of them, and the last row beside it.
template <int P> HWY_INLINE Pack<P> invert(Pack<P> (&b)[10]) {
  Pack<P> a[6] = {b[0], b[1], b[2], b[3], b[4], b[5]};
  const Pack<P> of_three = invert<P>(a);
  const Pack<P> q0 = add_product(a[0], b[6], add_product(a[1], b[7], a[3] * b[8]));
  const Pack<P> q1 = add_product(a[1], b[6], add_product(a[2], b[7], a[4] * b[8]));
  const Pack<P> q2 = add_product(a[3], b[6], add_product(a[4], b[7], a[5] * b[8]));
  const Pack<P> last = take_product(b[6], q0, take_product(b[7], q1, take_product(b[8], q2, b[9])));
  const Pack<P> f = same<P>(1) / last, f0 = f * q0, f1 = f * q1, f2 = f * q2;
  b[0] = add_product(f0, q0, a[0]), b[1] = add_product(f1, q0, a[1]), b[2] = add_product(f1, q1, a[2]);
  b[3] = add_product(f2, q0, a[3]), b[4] = add_product(f2, q1, a[4]), b[5] = add_product(f2, q2, a[5]);
  b[6] = same<P>(0) - f0, b[7] = same<P>(0) - f1, b[8] = same<P>(0) - f2, b[9] = f;
  return of_three * last;
}

/// What visits read and write: factors stand where others have theirs and their diagonal.
template <int P> struct TreeSlots {
  double *r, *s, *lambda, *y, *u, *factors;
  const double *inverse_mass, *lengths2;  ///< inverse masses of the other atoms of constraints

  explicit TreeSlots(const MoleculePack& pack) : inverse_mass(pack.kind->inverse_mass_i), lengths2(pack.lengths2) {
    const Slots<P> all(pack);
    r = all.r, s = all.s, lambda = all.lambda, y = all.y, u = all.u, factors = all.factors;
  }
  HWY_INLINE Vectors<P> bond(int k) const { return load_vectors<P>(r + 3 * k * P); }
  /// What a center adds up for its outgoing constraint, and how the owner, who has it as own constraint t, gets it.
  template <class S> HWY_INLINE void carry_on(const TreeCenter& c, const Pack<P>& carry, Link<P>& link) const {
    if constexpr (S::next) {
      link.carry = carry;
    } else {
      store(carry, y + c.out * P);
    }
  }
  template <class S> HWY_INLINE Pack<P> carried(int k, int t, const Link<P>& link) const {
    return t == S::own - 1 ? link.carry : load<P>(y + k * P);
  }
};

/// Eliminates the own constraints of centers, each time as one block B: stores 1 / B and h = B^-1 b, with the column b
/// of the outgoing constraint. It takes as many numbers and operations as L D L^T does, but nothing within a block
/// waits for anything; what goes from center to center is one sum.
template <int P> struct Factorizing {
  const TreeSlots<P> slots;
  Flags<P> singular = flags_of<P>(0);

  template <class S> HWY_INLINE void center(const TreeCenter& c, Link<P>& link) {
    Vectors<P> r[S::own];
    for (int t = 0; t < S::own; ++t) r[t] = slots.bond(c.first + t);
    Pack<P> block[S::size], whole = same<P>(1);
    const Pack<P> w = same<P>(2 * c.inverse_mass);
    for (int t = 0; t < S::own; ++t) {
      const int k = c.first + t;
      for (int u = 0; u < t; ++u) block[entry_of(t, u)] = w * dot(r[t], r[u]);
      const Pack<P> diagonal = same<P>(2 * (slots.inverse_mass[k] + c.inverse_mass)) * load<P>(slots.lengths2 + k * P);
      block[entry_of(t, t)] = t < S::leaves ? diagonal : diagonal - slots.template carried<S>(k, t, link);
      whole = t == 0 ? diagonal : whole * diagonal;
    }
    // The determinant is the product of the pivots, none of which is above its diagonal element.
    singular = either(singular, exceeds(same<P>(least_pivot) * whole, invert<P>(block)));
    double* const at = slots.factors + c.entry * P;
    for (int e = 0; e < S::size; ++e) store(block[e], at + e * P);
    if constexpr (S::out) {
      const Vectors<P> r_out = slots.bond(c.out);
      const Pack<P> minus = same<P>(-2 * c.inverse_mass);
      Pack<P> column[S::own], carry = same<P>(0);
      for (int t = 0; t < S::own; ++t) column[t] = minus * dot(r_out, r[t]);
      for (int t = 0; t < S::own; ++t) {
        const Pack<P> h = product_with_row(block, t, column);
        store(h, at + (S::size + t) * P);
        carry = t == 0 ? h * column[t] : add_product(h, column[t], carry);
      }
      slots.template carry_on<S>(c, carry, link);
    }
  }
};

/// The first half of a chord step, from centers to those behind them.
template <int P, bool moved, class Value> struct Forward {
  const TreeSlots<P> slots;
  Value& value;
  Pack<P> last = same<P>(0);  ///< what is no number if an element of the right side is none

  template <class S> HWY_INLINE void center(const TreeCenter& c, Link<P>& link) {
    Vectors<P> s[S::own];
    for (int t = 0; t < S::own; ++t) s[t] = load_vectors<P>(slots.s + 3 * (c.first + t) * P);
    if constexpr (moved) move<S>(c, link, s);
    const double* const h = slots.factors + (c.entry + S::size) * P;
    Pack<P> carry = same<P>(0);
    for (int t = 0; t < S::own; ++t) {
      const int k = c.first + t;
      Pack<P> g = value(k, s[t]);
      if (t >= S::leaves) g = g - slots.template carried<S>(k, t, link);
      store(g, slots.y + k * P);
      if constexpr (S::out) {
        carry = t == 0 ? load<P>(h) * g : add_product(load<P>(h + t * P), g, carry);
      } else {
        last = last + g;
      }
    }
    if constexpr (S::out) slots.template carry_on<S>(c, carry, link);
  }

 private:
  /// What multipliers have made of the vectors of the own constraints.
  template <class S> HWY_INLINE void move(const TreeCenter& c, Link<P>& link, Vectors<P> (&s)[S::own]) {
    Vectors<P> u{same<P>(0), same<P>(0), same<P>(0)}, out = u;
    if constexpr (S::out) u = out = load<P>(slots.lambda + c.out * P) * slots.bond(c.out);
    for (int t = 0; t < S::own; ++t) {
      const int k = c.first + t;
      const Pack<P> w = same<P>(slots.inverse_mass[k]);
      if (S::linked && t == S::own - 1) {
        u = u - link.f;
        s[t] = add_product(w, link.u, s[t]);
        continue;
      }
      const Pack<P> lambda = load<P>(slots.lambda + k * P);
      const Vectors<P> r = slots.bond(k);
      u = take_product(lambda, r, u);
      s[t] = t < S::leaves ? add_product(w * lambda, r, s[t])
                           : add_product(w, load_vectors<P>(slots.u + 3 * c.before[t - S::leaves] * P), s[t]);
    }
    if constexpr (S::out && !S::next) store(u, slots.u + 3 * c.number * P);
    link.u = u, link.f = out;
    for (int t = 0; t < S::own; ++t) s[t] = take_product(same<P>(c.inverse_mass), u, s[t]);
  }
};

/// The second half, the other way.
template <int P, bool first> struct Backward {
  const TreeSlots<P> slots;
  const Flags<P> lanes;

  template <class S> HWY_INLINE void center(const TreeCenter& c, Link<P>& link) {
    const double* const at = slots.factors + c.entry * P;
    Pack<P> block[S::size], g[S::own], z[S::own];
    for (int e = 0; e < S::size; ++e) block[e] = load<P>(at + e * P);
    for (int t = 0; t < S::own; ++t) g[t] = load<P>(slots.y + (c.first + t) * P);
    for (int t = 0; t < S::own; ++t) z[t] = product_with_row(block, t, g);
    if constexpr (S::out) {
      const Pack<P> out = S::next ? link.z : load<P>(slots.y + c.out * P);
      for (int t = 0; t < S::own; ++t) z[t] = take_product(load<P>(at + (S::size + t) * P), out, z[t]);
    }
    for (int t = 0; t < S::own; ++t) {
      const int k = c.first + t;
      if (t >= S::leaves && t < S::own - 1) store(z[t], slots.y + k * P);  // the center there reads it
      add_step<P, first>(lanes, z[t], slots.lambda + k * P);
    }
    if constexpr (S::linked) link.z = z[S::own - 1];
  }
};

/// Molecules whose bonds form a tree, no atom of which has more than four.
template <int P> class TreeBonds {
 public:
  explicit TreeBonds(const MoleculePack& pack) : pack_(pack), all_(pack), slots_(pack) {}

  HWY_INLINE void find(const MoleculeColumns& c) const { find_bonds<P>(pack_, c, all_); }
  HWY_INLINE void find_differences(double* const (&column)[3], const double (&edge)[3], bool moved) const {
    noether::NOETHER_SIMD_LEVEL::find_differences<P>(pack_, column, edge, moved, all_);
  }
  const double* vectors() const { return all_.r; }
  HWY_INLINE Flags<P> idle() const { return idle_lanes<P>(pack_); }
  HWY_INLINE Pack<P> of_molecule(const Pack<P>& worst) const { return worst; }
  HWY_INLINE void leave_out(const Flags<P>& lanes) const {
    leave_out_of<P>(lanes, pack_.kind->constraints, all_.lambda);
  }
  template <class MakeRow> HWY_INLINE void put(const MakeRow& make_row) const {
    noether::NOETHER_SIMD_LEVEL::put<P>(pack_, all_, make_row);
  }

  Flags<P> factorize() const {
    Factorizing<P> visit{slots_};
    visit_inward<P>(pack_, visit);
    return visit.singular;
  }
  template <bool moved, class Value> Pack<P> sweep(Value& value) const {
    Forward<P, moved, Value> visit{slots_, value};
    visit_inward<P>(pack_, visit);
    return visit.last;
  }
  template <bool first> void step(const Flags<P>& lanes) const {
    Backward<P, first> visit{slots_, lanes};
    visit_outward<P>(pack_, visit);
  }

 private:
  const MoleculePack& pack_;
  const Slots<P> all_;
  const TreeSlots<P> slots_;
};

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return solve_by_chords<8>(TreeBonds<8>(pack), pack, columns, task.h);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return project_by_factors<8>(TreeBonds<8>(pack), columns);
}

}  // namespace

extern const MoleculeKernels tree_lanes;
const MoleculeKernels tree_lanes{
    .solve_positions = solve_positions, .project_velocities = project_velocities, .most_of_sixteen = 0};

}  // namespace noether::NOETHER_SIMD_LEVEL
