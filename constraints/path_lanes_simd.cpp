#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/newton_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Directions of a walk along a path from one of its ends to the middle.
constexpr int up = 1, down = -1;
/// The atoms behind bond k of such a walk, and in front of it.
template <int way> constexpr int near_atom(int k) { return way == up ? k : k + 1; }
template <int way> constexpr int far_atom(int k) { return way == up ? k + 1 : k; }

/// Molecules whose bonds form one path: bond k leads from atom k to atom k + 1.
///
/// Bonds are eliminated from both ends to the middle, so that two recurrences run side by side, and what goes from bond
/// to bond stays in registers. A bond holds its atoms by f = lambda r; that moves atom a by w e, e = f_(a-1) - f_a.
template <int P> class PathBonds {
 public:
  explicit PathBonds(const MoleculePack& pack)
      : pack_(pack), atom_(pack.path->atom), w_(pack.path->inverse_mass), n_(pack.path->bonds) {
    double* next = pack.scratch;
    const auto take = [&](int slots) {
      double* const mine = next;
      next += slots * P;
      return mine;
    };
    r_ = take(3 * n_), s_ = take(3 * n_), lambda_ = take(n_), y_ = take(n_), inverse_ = take(n_);
    factor_ = take(n_ + 1), one_ = take(n_ + 1);
  }

  const double* vectors() const { return r_; }
  HWY_INLINE Flags<P> idle() const { return idle_lanes<P>(pack_); }
  HWY_INLINE Pack<P> of_molecule(const Pack<P>& worst) const { return worst; }
  HWY_INLINE void leave_out(const Flags<P>& lanes) const { leave_out_of<P>(lanes, n_, lambda_); }

  HWY_INLINE void find(const MoleculeColumns& c) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double edge = c.edge[axis];
      with_differences(c.start[axis], [&](int k, const Pack<P>& d) HWY_ATTR {
        store(edge > 0 ? nearest<P>(d, edge) : d, r_ + (3 * k + axis) * P);
      });
    }
  }
  HWY_INLINE void find_differences(double* const (&column)[3], const double (&edge)[3], bool moved) const {
    for (int axis = 0; axis < 3; ++axis) {
      const bool from_r = moved && edge[axis] > 0;
      with_differences(column[axis], [&](int k, const Pack<P>& d) HWY_ATTR {
        const int at = (3 * k + axis) * P;
        store(from_r ? load<P>(r_ + at) + d : d, s_ + at);
      });
    }
  }

  HWY_INLINE Flags<P> factorize() const {
    Pivot left = no_pivot(), right = no_pivot();
    const int rights = (n_ - 1) / 2, middle = n_ / 2;
    Flags<P> singular = flags_of<P>(0);
    for (int q = 0; q < rights; ++q) {
      eliminate<down>(right, n_ - 1 - q, singular);
      eliminate<up>(left, q, singular);
    }
    if (rights < middle) eliminate<up>(left, rights, singular);
    const Vectors<P> r = load_vectors<P>(r_ + 3 * middle * P);
    pivot(middle, taken<up>(left, middle, r) + taken<down>(right, middle, r), singular);
    return singular;
  }

  template <bool moved, class Value> HWY_INLINE Pack<P> sweep(Value& value) const {
    Front left = front<moved, up>(0), right = front<moved, down>(n_ - 1);
    const int rights = (n_ - 1) / 2, middle = n_ / 2;
    for (int q = 0; q < rights; ++q) {
      advance<down, moved>(right, n_ - 1 - q, value);
      advance<up, moved>(left, q, value);
    }
    if (rights < middle) advance<up, moved>(left, rights, value);
    Vectors<P> s = load_vectors<P>(s_ + 3 * middle * P);
    if constexpr (moved)
      s = add_product(same<P>(w_[middle + 1]), right.e, take_product(same<P>(w_[middle]), left.e, s));
    const Pack<P> from_left = take_product(load<P>(factor_ + middle * P), left.y, value(middle, s));
    const Pack<P> y = take_product(load<P>(factor_ + (middle + 1) * P), right.y, from_left);
    store(y, y_ + middle * P);
    return y;
  }

  template <bool first> HWY_INLINE void step(const Flags<P>& lanes) const {
    const int rights = (n_ - 1) / 2, middle = n_ / 2;
    Pack<P> left = load<P>(inverse_ + middle * P) * load<P>(y_ + middle * P), right = left;
    add_step<P, first>(lanes, left, lambda_ + middle * P);
    for (int q = 1; q <= rights; ++q) {
      retreat<down, first>(right, middle + q, lanes);
      retreat<up, first>(left, middle - q, lanes);
    }
    if (rights < middle) retreat<up, first>(left, 0, lanes);
  }

  template <class MakeRow> HWY_INLINE void put(const MakeRow& make_row) const {
    for (int axis = 0; axis < 3; ++axis) {
      Pack<P> behind = same<P>(0);
      for (int a = 0; a <= n_; ++a) {
        const Pack<P> ahead = a < n_ ? load<P>(lambda_ + a * P) * load<P>(r_ + (3 * a + axis) * P) : same<P>(0);
        store(same<P>(w_[a]) * (behind - ahead), one_ + atom_[a] * P);
        behind = ahead;
      }
      store_atoms<P>(pack_, one_, make_row(axis));
    }
  }

 private:
  /// Of the bond that was eliminated last: 1 / D.
  struct Pivot {
    Vectors<P> r;
    Pack<P> inverse;
  };
  /// Where a walk stands: the force of the next bond, e of the atom in between, y of the last bond.
  struct Front {
    Vectors<P> f, e;
    Pack<P> y;
  };

  static HWY_INLINE Vectors<P> none() { return {same<P>(0), same<P>(0), same<P>(0)}; }
  static HWY_INLINE Pivot no_pivot() { return {none(), same<P>(0)}; }
  HWY_INLINE Vectors<P> force(int k) const { return load<P>(lambda_ + k * P) * load_vectors<P>(r_ + 3 * k * P); }

  /// Calls `use(k, d)` with the difference of the atoms of each bond in a column.
  template <class Use> HWY_INLINE void with_differences(const double* column, const Use& use) const {
    load_atoms<P>(pack_, column, one_);
    Pack<P> behind = load<P>(one_ + atom_[0] * P);
    for (int k = 0; k < n_; ++k) {
      const Pack<P> ahead = load<P>(one_ + atom_[k + 1] * P);
      use(k, ahead - behind);
      behind = ahead;
    }
  }

  /// What elimination of the bond behind takes from the diagonal element of bond k.
  template <int way> HWY_INLINE Pack<P> taken(const Pivot& behind, int k, const Vectors<P>& r) const {
    const int atom = near_atom<way>(k);
    const Pack<P> coupling = same<P>(-2 * w_[atom]) * dot(r, behind.r), factor = coupling * behind.inverse;
    store(factor, factor_ + atom * P);
    return coupling * factor;
  }
  HWY_INLINE Pack<P> pivot(int k, const Pack<P>& taken, Flags<P>& singular) const {
    const Pack<P> whole = same<P>(2 * (w_[k] + w_[k + 1])) * load<P>(pack_.lengths2 + k * P), left = whole - taken;
    singular = either(singular, exceeds(same<P>(least_pivot) * whole, left));
    const Pack<P> inverse = same<P>(1) / left;
    store(inverse, inverse_ + k * P);
    return inverse;
  }
  template <int way> HWY_INLINE void eliminate(Pivot& behind, int k, Flags<P>& singular) const {
    const Vectors<P> r = load_vectors<P>(r_ + 3 * k * P);
    behind = {r, pivot(k, taken<way>(behind, k, r), singular)};
  }

  template <bool moved, int way> HWY_INLINE Front front(int k) const {
    if constexpr (!moved) return {none(), none(), same<P>(0)};
    const Vectors<P> f = force(k);
    return {f, way == up ? none() - f : f, same<P>(0)};
  }
  template <int way, bool moved, class Value> HWY_INLINE void advance(Front& front, int k, Value& value) const {
    Vectors<P> s = load_vectors<P>(s_ + 3 * k * P);
    if constexpr (moved) {
      const Pack<P> near = same<P>(w_[near_atom<way>(k)]), far = same<P>(w_[far_atom<way>(k)]);
      const Vectors<P> f = force(k + way), e = way == up ? front.f - f : f - front.f;
      s = way == up ? add_product(far, e, take_product(near, front.e, s))
                    : take_product(far, e, add_product(near, front.e, s));
      front.f = f, front.e = e;
    }
    front.y = take_product(load<P>(factor_ + near_atom<way>(k) * P), front.y, value(k, s));
    store(front.y, y_ + k * P);
  }
  /// Back towards the end: from the multiplier of the bond in front to that of bond k.
  template <int way, bool first> HWY_INLINE void retreat(Pack<P>& z, int k, const Flags<P>& lanes) const {
    const Pack<P> own = load<P>(inverse_ + k * P) * load<P>(y_ + k * P);
    z = take_product(load<P>(factor_ + far_atom<way>(k) * P), z, own);
    add_step<P, first>(lanes, z, lambda_ + k * P);
  }

  const MoleculePack& pack_;
  const int* atom_;
  const double* w_;
  int n_;
  double *r_, *s_, *lambda_, *y_, *inverse_, *factor_, *one_;
};

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_by_chords<16>(PathBonds<16>(pack), pack, columns, task.h)
                          : solve_by_chords<8>(PathBonds<8>(pack), pack, columns, task.h);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return pack.lanes == 16 ? project_by_factors<16>(PathBonds<16>(pack), columns)
                          : project_by_factors<8>(PathBonds<8>(pack), columns);
}

}  // namespace

extern const MoleculeKernels path_lanes;
const MoleculeKernels path_lanes{
    .solve_positions = solve_positions, .project_velocities = project_velocities, .most_of_sixteen = 4};

}  // namespace noether::NOETHER_SIMD_LEVEL
