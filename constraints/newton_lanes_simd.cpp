#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/newton_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Molecules of any shape, entry by entry of the factors.
template <int P> class ListedBonds {
 public:
  explicit ListedBonds(const MoleculePack& pack) : pack_(pack), s_(pack) {}

  HWY_INLINE void find(const MoleculeColumns& c) const { find_bonds<P>(pack_, c, s_); }
  HWY_INLINE void find_differences(double* const (&column)[3], const double (&edge)[3], bool moved) const {
    noether::NOETHER_SIMD_LEVEL::find_differences<P>(pack_, column, edge, moved, s_);
  }
  const double* vectors() const { return s_.r; }
  HWY_INLINE Flags<P> idle() const { return idle_lanes<P>(pack_); }
  HWY_INLINE Pack<P> of_molecule(const Pack<P>& worst) const { return worst; }
  HWY_INLINE void leave_out(const Flags<P>& lanes) const { leave_out_of<P>(lanes, pack_.kind->constraints, s_.lambda); }
  template <class MakeRow> HWY_INLINE void put(const MakeRow& make_row) const {
    noether::NOETHER_SIMD_LEVEL::put<P>(pack_, s_, make_row);
  }

  /// L D L^T. @return where it is singular
  Flags<P> factorize() const {
    const EliminationLists p = *pack_.kind;
    double *const factors = s_.factors, *const inverse = s_.inverse;
    Flags<P> singular = flags_of<P>(0);
    for (int k = 0; k < p.constraints; ++k) {
      const Vectors<P> r = load_vectors<P>(s_.r + 3 * k * P);
      const Pack<P> whole = same<P>(2 * (p.inverse_mass_i[k] + p.inverse_mass_j[k])) * load<P>(pack_.lengths2 + k * P);
      Pack<P> diagonal = whole;
      const int begin = p.row[k];
      for (int e = begin; e < p.row[k + 1]; ++e) {
        const int l = p.column[e];
        Pack<P> element = same<P>(2 * p.coupling[e]) * dot(r, load_vectors<P>(s_.r + 3 * l * P));
        for (int m = p.product[e]; m < p.product[e + 1]; ++m) {
          element =
              take_product(load<P>(s_.row + p.product_left[m] * P), load<P>(factors + p.product_right[m] * P), element);
        }
        store(element, s_.row + (e - begin) * P);
        const Pack<P> factor = element * load<P>(inverse + l * P);
        store(factor, factors + e * P);
        diagonal = take_product(element, factor, diagonal);
      }
      singular = either(singular, exceeds(same<P>(least_pivot) * whole, diagonal));
      store(same<P>(1) / diagonal, inverse + k * P);
    }
    return singular;
  }

  template <bool moved, class Value> HWY_INLINE Pack<P> sweep(Value& value) const {
    const EliminationLists p = *pack_.kind;
    if constexpr (!moved) {
      for (int k = 0; k < p.constraints; ++k) forward(p, k, value(k, load_vectors<P>(s_.s + 3 * k * P)));
    } else {
      with_multipliers<P>(pack_, s_, [&](int k, const Vectors<P>& at) HWY_ATTR { forward(p, k, value(k, at)); });
    }
    return load<P>(s_.y + (p.constraints - 1) * P);
  }

  /// z = D^-1 y - L^T z, in place.
  template <bool first> HWY_INLINE void step(const Flags<P>& lanes) const {
    const EliminationLists p = *pack_.kind;
    const double *const factors = s_.factors, *const inverse = s_.inverse;
    for (int k = p.constraints - 1; k >= 0; --k) {
      Pack<P> z = load<P>(inverse + k * P) * load<P>(s_.y + k * P);
      for (int b = p.below[k]; b < p.below[k + 1]; ++b)
        z = take_product(load<P>(factors + p.below_entry[b] * P), load<P>(s_.y + p.below_row[b] * P), z);
      store(z, s_.y + k * P);
      add_step<P, first>(lanes, z, s_.lambda + k * P);
    }
  }

 private:
  /// y_k = g_k - sum L_kl y_l
  HWY_INLINE void forward(const EliminationLists& p, int k, Pack<P> g) const {
    for (int e = p.row[k]; e < p.row[k + 1]; ++e)
      g = take_product(load<P>(s_.factors + e * P), load<P>(s_.y + p.column[e] * P), g);
    store(g, s_.y + k * P);
  }

  const MoleculePack& pack_;
  const Slots<P> s_;
};

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_by_chords<16>(ListedBonds<16>(pack), pack, columns, task.h)
                          : solve_by_chords<8>(ListedBonds<8>(pack), pack, columns, task.h);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return pack.lanes == 16 ? project_by_factors<16>(ListedBonds<16>(pack), columns)
                          : project_by_factors<8>(ListedBonds<8>(pack), columns);
}

}  // namespace

extern const MoleculeKernels newton_lanes;
const MoleculeKernels newton_lanes{.solve_positions = solve_positions, .project_velocities = project_velocities};

}  // namespace noether::NOETHER_SIMD_LEVEL
