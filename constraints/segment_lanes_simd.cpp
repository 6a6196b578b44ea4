#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/newton_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// The column of a separator is cut off where it is so small beside the diagonal.
constexpr double least_spike = 1e-30;

/// What each lane gets from the one to its left, and to its right; 0 where there is none.
template <int P> HWY_INLINE Pack<P> from_left(const Pack<P>& a) {
  alignas(64) double lanes[P], moved[P];
  store(a, lanes);
  for (int l = 0; l < P; ++l) moved[l] = l > 0 ? lanes[l - 1] : 0;
  return load<P>(moved);
}
template <int P> HWY_INLINE Pack<P> from_right(const Pack<P>& a) {
  alignas(64) double lanes[P], moved[P];
  store(a, lanes);
  for (int l = 0; l < P; ++l) moved[l] = l + 1 < P ? lanes[l + 1] : 0;
  return load<P>(moved);
}
template <int P> HWY_INLINE Vectors<P> from_left(const Vectors<P>& a) {
  return {from_left<P>(a.x), from_left<P>(a.y), from_left<P>(a.z)};
}
template <int P> HWY_INLINE Vectors<P> from_right(const Vectors<P>& a) {
  return {from_right<P>(a.x), from_right<P>(a.y), from_right<P>(a.z)};
}

/// One long path as P segments side by side: lane l has its bonds l (m + 1) + k, k = 0 .. m; bond m, the separator, is
/// between it and lane l + 1. What the last lane has behind the end of the path are bonds from its last atom to itself.
///
/// Segments are eliminated in lanes, with the column of the separator on their left as fill, the spike; they leave a
/// tridiagonal system of the P - 1 separators. As in PathBonds, f = lambda r holds atoms, and w e moves them.
template <int P> class SegmentBonds {
 public:
  explicit SegmentBonds(const MoleculePack& pack)
      : pack_(pack),
        w_(pack.segments->inverse_mass),
        m_(pack.kind->constraints - 1),
        tail_(pack.segments->bonds - (P - 1) * (m_ + 1)),
        real_(flags_of<P>((1U << (P - 1)) - 1)) {
    double* next = pack.scratch;
    const auto take = [&](int slots) {
      double* const mine = next;
      next += slots * P;
      return mine;
    };
    const int n = m_ + 1;
    r_ = take(3 * n), s_ = take(3 * n), lambda_ = take(n), y_ = take(n), inverse_ = take(n), factor_ = take(n);
    spike_ = take(n), one_ = take(n + 1), reduced_inverse_ = take(1), reduced_factor_ = take(1);
  }

  const double* vectors() const { return r_; }
  HWY_INLINE Flags<P> idle() const { return flags_of<P>(0); }
  Pack<P> of_molecule(const Pack<P>& worst) const {
    alignas(64) double lanes[P];
    store(worst, lanes);
    double most = lanes[0];
    for (int l = 1; l < P && most == most; ++l) {
      if (!(lanes[l] <= most)) most = lanes[l];
    }
    return same<P>(most);
  }
  HWY_INLINE void leave_out(const Flags<P>& lanes) const { leave_out_of<P>(lanes, m_ + 1, lambda_); }

  void find(const MoleculeColumns& c) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double edge = c.edge[axis];
      with_differences(c.start[axis], [&](int k, const Pack<P>& d) HWY_ATTR {
        store(edge > 0 ? nearest<P>(d, edge) : d, r_ + (3 * k + axis) * P);
      });
    }
  }
  void find_differences(double* const (&column)[3], const double (&edge)[3], bool moved) const {
    for (int axis = 0; axis < 3; ++axis) {
      const bool from_r = moved && edge[axis] > 0;
      with_differences(column[axis], [&](int k, const Pack<P>& d) HWY_ATTR {
        const int at = (3 * k + axis) * P;
        store(from_r ? load<P>(r_ + at) + d : d, s_ + at);
      });
    }
  }

  Flags<P> factorize() {
    Flags<P> singular = flags_of<P>(0);
    Pivot behind{none(), same<P>(0)};
    Pack<P> whole = eliminate(behind, 0, singular);
    Pack<P> e = (same<P>(-2) * load<P>(w_)) * dot(behind.r, from_left<P>(bond(m_)));
    Pack<P> h = e * behind.inverse, taken = e * h;
    store(h, spike_);
    spike_end_ = 1;
    for (bool alive = true; alive && spike_end_ < m_; ++spike_end_) {
      whole = eliminate(behind, spike_end_, singular);
      e = same<P>(0) - load<P>(factor_ + spike_end_ * P) * e;
      const Flags<P> high = exceeds(absolute(e), same<P>(least_spike) * whole);
      e = only_where(high, e);
      h = e * behind.inverse;
      store(h, spike_ + spike_end_ * P);
      taken = add_product(e, h, taken);
      alive = any(high);
    }
    if (spike_end_ < m_) h = same<P>(0);
    for (int k = spike_end_; k < m_; ++k) eliminate(behind, k, singular);
    const Pack<P> coupling = couple(behind, m_, bond(m_));
    const Pack<P> own = coupling * load<P>(factor_ + m_ * P);
    const bool dependent = reduce(own, taken, same<P>(0) - coupling * h);
    return flags_of<P>(dependent || any(singular) ? (1U << P) - 1 : 0);
  }

  template <bool moved, class Value> HWY_INLINE Pack<P> sweep(Value& value) const {
    Front front{none(), none(), same<P>(0)};
    Vectors<P> end = none();  // the force that the last atom of a segment feels from the next one
    if constexpr (moved) {
      front.f = force(0);
      front.e = from_left<P>(force(m_)) - front.f;
      end = from_right<P>(front.f);
    }
    Pack<P> sum = same<P>(0);
    for (int k = 0; k < spike_end_; ++k) {
      advance<moved>(front, k, force_behind<moved>(k), value);
      sum = add_product(load<P>(spike_ + k * P), front.y, sum);
    }
    for (int k = spike_end_; k < m_; ++k) advance<moved>(front, k, force_behind<moved>(k), value);
    advance<moved>(front, m_, end, value);
    solve_separators(front.y, sum);
    return front.y;
  }

  template <bool first> HWY_INLINE void step(const Flags<P>& lanes) const {
    Pack<P> z = load<P>(y_ + m_ * P);
    const Pack<P> left = from_left<P>(z);
    add_step<P, first>(lanes, z, lambda_ + m_ * P);
    const auto retreat = [&](int k, const Pack<P>& known) HWY_ATTR {
      z = take_product(load<P>(factor_ + (k + 1) * P), z, known);
      add_step<P, first>(lanes, z, lambda_ + k * P);
    };
    for (int k = m_ - 1; k >= spike_end_; --k) retreat(k, load<P>(inverse_ + k * P) * load<P>(y_ + k * P));
    for (int k = spike_end_ - 1; k >= 0; --k) {
      const Pack<P> own = load<P>(inverse_ + k * P) * load<P>(y_ + k * P);
      retreat(k, take_product(load<P>(spike_ + k * P), left, own));
    }
  }

  template <class MakeRow> HWY_INLINE void put(const MakeRow& make_row) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto force_of = [&](int k) HWY_ATTR { return load<P>(lambda_ + k * P) * load<P>(r_ + (3 * k + axis) * P); };
      Pack<P> behind = from_left<P>(force_of(m_));
      for (int k = 0; k <= m_; ++k) {
        const Pack<P> ahead = force_of(k);
        store(load<P>(w_ + k * P) * (behind - ahead), one_ + k * P);
        behind = ahead;
      }
      store_path(make_row(axis));
    }
  }

 private:
  /// Of the bond that was eliminated last: 1 / D.
  struct Pivot {
    Vectors<P> r;
    Pack<P> inverse;
  };
  /// The force of the next bond, e of the atom in between, y of the last bond.
  struct Front {
    Vectors<P> f, e;
    Pack<P> y;
  };

  static HWY_INLINE Vectors<P> none() { return {same<P>(0), same<P>(0), same<P>(0)}; }
  HWY_INLINE Vectors<P> bond(int k) const { return load_vectors<P>(r_ + 3 * k * P); }
  HWY_INLINE Vectors<P> force(int k) const { return load<P>(lambda_ + k * P) * bond(k); }
  template <bool moved> HWY_INLINE Vectors<P> force_behind(int k) const {
    if constexpr (moved) return force(k + 1);
    return none();
  }

  /// Atoms that the last lane has too are rows of four; it has `tail_` + 1, the end of the path several times.
  int rows() const { return pack_.side_by_side ? (tail_ + 1) / 4 * 4 : 0; }
  template <class Use> HWY_INLINE void with_differences(const double* column, const Use& use) const {
    const int rows = this->rows();
    for (int lane = 0; lane < P; lane += 8) {
      for (int a = 0; a < rows; a += 4) rows_to_slots<P>(column + a, pack_.atoms + lane, one_ + a * P + lane);
    }
    for (int at = rows * P; at < (m_ + 2) * P; ++at) one_[at] = column[pack_.atoms[at]];
    Pack<P> behind = load<P>(one_);
    for (int k = 0; k <= m_; ++k) {
      const Pack<P> ahead = load<P>(one_ + (k + 1) * P);
      use(k, ahead - behind);
      behind = ahead;
    }
  }
  /// The first atom of a segment is the last one of that before, which leaves it out.
  template <class Row> HWY_INLINE void store_path(const Row& row) const {
    const int rows = this->rows();
    for (int lane = 0; lane < P; lane += 8) {
      for (int a = 0; a < rows; a += 4) slots_to_rows<P>(one_ + a * P + lane, pack_.atoms + a * P + lane, row);
    }
    const hn::CappedTag<double, 1> one;
    for (int at = rows * P; at < (m_ + 1) * P; ++at) row(one, pack_.atoms[at], hn::Set(one, one_[at]));
  }

  /// The element of the matrix beside the diagonal, between bond k and the one behind, whose factor is stored.
  HWY_INLINE Pack<P> couple(const Pivot& behind, int k, const Vectors<P>& r) const {
    const Pack<P> coupling = (same<P>(-2) * load<P>(w_ + k * P)) * dot(r, behind.r);
    store(coupling * behind.inverse, factor_ + k * P);
    return coupling;
  }
  HWY_INLINE Pack<P> diagonal(int k) const {
    const Pack<P> w = load<P>(w_ + k * P) + load<P>(w_ + (k + 1) * P);
    return (same<P>(2) * w) * load<P>(pack_.lengths2 + k * P);
  }
  /// @return the diagonal element
  HWY_INLINE Pack<P> eliminate(Pivot& behind, int k, Flags<P>& singular) const {
    const Vectors<P> r = bond(k);
    const Pack<P> coupling = couple(behind, k, r), whole = diagonal(k);
    const Pack<P> left = take_product(coupling, load<P>(factor_ + k * P), whole);
    singular = either(singular, exceeds(same<P>(least_pivot) * whole, left));
    behind = {r, same<P>(1) / left};
    store(behind.inverse, inverse_ + k * P);
    return whole;
  }
  /// Factors of the matrix of separators: of their diagonal elements segments on their left have taken `own`, those on
  /// their right `taken` (of these lanes); `across` couples separators on both sides of a segment.
  /// @return whether it is singular
  bool reduce(const Pack<P>& own, const Pack<P>& taken, const Pack<P>& across) const {
    alignas(64) double whole[P], of_own[P], of_next[P], beside[P];
    store(diagonal(m_), whole), store(own, of_own), store(taken, of_next), store(across, beside);
    bool singular = false;
    for (int l = 0; l + 1 < P; ++l) {
      double left = whole[l] - of_own[l] - of_next[l + 1];
      reduced_factor_[l] = l > 0 ? beside[l] * reduced_inverse_[l - 1] : 0;
      if (l > 0) left -= beside[l] * reduced_factor_[l];
      singular = singular || !(left >= least_pivot * whole[l]);
      reduced_inverse_[l] = 1 / left;
    }
    return singular;
  }
  /// Puts steps of separators where their y would be.
  void solve_separators(const Pack<P>& y, const Pack<P>& sum) const {
    alignas(64) double z[P], of_next[P];
    store(y, z), store(sum, of_next);
    for (int l = 0; l + 1 < P; ++l) z[l] -= of_next[l + 1] + (l > 0 ? reduced_factor_[l] * z[l - 1] : 0);
    z[P - 1] = 0;
    for (int l = P - 2; l >= 0; --l)
      z[l] = z[l] * reduced_inverse_[l] - (l + 2 < P ? reduced_factor_[l + 1] * z[l + 1] : 0);
    store(load<P>(z), y_ + m_ * P);
  }

  template <bool moved, class Value>
  HWY_INLINE void advance(Front& front, int k, const Vectors<P>& next, Value& value) const {
    Vectors<P> s = load_vectors<P>(s_ + 3 * k * P);
    if constexpr (moved) {
      const Vectors<P> e = front.f - next;
      s = add_product(load<P>(w_ + (k + 1) * P), e, take_product(load<P>(w_ + k * P), front.e, s));
      front.f = next, front.e = e;
    }
    Pack<P> g = value(k, s);
    if (k >= tail_) g = only_where(real_, g);
    front.y = take_product(load<P>(factor_ + k * P), front.y, g);
    store(front.y, y_ + k * P);
  }

  const MoleculePack& pack_;
  const double* w_;  ///< of the atoms of each lane
  int m_, tail_;     ///< of the last lane: bonds of the path
  int spike_end_ = 0;
  Flags<P> real_;  ///< lanes without bonds behind the end
  double *r_, *s_, *lambda_, *y_, *inverse_, *factor_, *spike_, *one_;
  double *reduced_inverse_, *reduced_factor_;
};

/// Lanes of one molecule.
MoleculeReport together(MoleculeReport report) {
  report.open = report.open != 0 ? 1U : 0U;
  return report;
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return together(solve_by_chords<16>(SegmentBonds<16>(pack), pack, columns, task.h));
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return together(project_by_factors<16>(SegmentBonds<16>(pack), columns));
}

}  // namespace

extern const MoleculeKernels segment_lanes;
const MoleculeKernels segment_lanes{
    .solve_positions = solve_positions, .project_velocities = project_velocities, .most_of_sixteen = 0};

}  // namespace noether::NOETHER_SIMD_LEVEL
