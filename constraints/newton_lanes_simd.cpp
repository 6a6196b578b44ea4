#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/molecule_multipliers_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// | |s|^2 - d^2 | / 2 d^2 where it is rounding of local vectors.
constexpr double settled = 4e-15;
/// A molecule that free motion violates by more, or whose violation a sweep makes less than so many times smaller, is
/// left to those who can follow a solution.
constexpr double hard_start = 0.25, slow_sweep = 0.5;
/// A pivot this small beside its diagonal element: the constraint depends on others.
constexpr double least_pivot = 1000 * 0x1p-52;
constexpr int most_sweeps = 40;

/// L D L^T of G M^-1 G^T, entry by entry. @return where it is singular
template <int P> HWY_INLINE Flags<P> factorize_bonds(const MoleculePack& pack, const Slots<P>& s) {
  const EliminationLists p = *pack.kind;
  double *const factors = s.factors, *const inverse = s.inverse;
  Flags<P> singular = flags_of<P>(0);
  for (int k = 0; k < p.constraints; ++k) {
    const Vectors<P> r = load_vectors<P>(s.r + 3 * k * P);
    const Pack<P> whole = same<P>(p.inverse_mass_i[k] + p.inverse_mass_j[k]) * load<P>(pack.lengths2 + k * P);
    Pack<P> diagonal = whole;
    const int begin = p.row[k];
    for (int e = begin; e < p.row[k + 1]; ++e) {
      const int l = p.column[e];
      Pack<P> element = same<P>(p.coupling[e]) * dot(r, load_vectors<P>(s.r + 3 * l * P));
      for (int m = p.product[e]; m < p.product[e + 1]; ++m) {
        element =
            take_product(load<P>(s.row + p.product_left[m] * P), load<P>(factors + p.product_right[m] * P), element);
      }
      store(element, s.row + (e - begin) * P);
      const Pack<P> factor = element * load<P>(inverse + l * P);
      store(factor, factors + e * P);
      diagonal = take_product(element, factor, diagonal);
    }
    singular = either(singular, exceeds(same<P>(least_pivot) * whole, diagonal));
    store(same<P>(1) / diagonal, inverse + k * P);
  }
  return singular;
}

/// y_k = g_k - sum L_kl y_l
template <int P> HWY_INLINE void forward(const MoleculePack& pack, const Slots<P>& s, int k, Pack<P> g) {
  const EliminationLists& p = *pack.kind;
  for (int e = p.row[k]; e < p.row[k + 1]; ++e)
    g = take_product(load<P>(s.factors + e * P), load<P>(s.y + p.column[e] * P), g);
  store(g, s.y + k * P);
}
/// z = D^-1 y - L^T z, in place; `then(k, z_k)`.
template <int P, class Then> HWY_INLINE void backward(const MoleculePack& pack, const Slots<P>& s, const Then& then) {
  const EliminationLists p = *pack.kind;
  const double *const factors = s.factors, *const inverse = s.inverse;
  for (int k = p.constraints - 1; k >= 0; --k) {
    Pack<P> z = load<P>(inverse + k * P) * load<P>(s.y + k * P);
    for (int b = p.below[k]; b < p.below[k + 1]; ++b)
      z = take_product(load<P>(factors + p.below_entry[b] * P), load<P>(s.y + p.below_row[b] * P), z);
    store(z, s.y + k * P);
    then(k, z);
  }
}

/// Violations with the multipliers at hand, and the first half of the next chord step. @return the worst of each lane
template <int P> HWY_INLINE Pack<P> sweep(const MoleculePack& pack, const Slots<P>& s, bool first) {
  Pack<P> worst = same<P>(0);
  const auto look = [&](int k, const Vectors<P>& at) HWY_ATTR {
    const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
    const Pack<P> g = same<P>(0.5) * take_product(at.x, at.x, take_product(at.y, at.y, take_product(at.z, at.z, d2)));
    worst = larger(worst, absolute(g) * load<P>(pack.lengths2 + (pack.kind->constraints + k) * P));
    forward<P>(pack, s, k, g);
  };
  if (first) {
    for (int k = 0; k < pack.kind->constraints; ++k) look(k, load_vectors<P>(s.s + 3 * k * P));
  } else {
    with_multipliers<P>(pack, s, look);
  }
  return worst;
}

template <int P> MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, double h) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  const Flags<P> singular = factorize_bonds<P>(pack, s);
  find_differences<P>(pack, c.x, c.edge, true, s);
  MoleculeReport report;
  const Flags<P> idle = idle_lanes<P>(pack);
  Pack<P> worst = sweep<P>(pack, s, true);
  Flags<P> hard = but_not(either(singular, exceeds(worst, same<P>(hard_start))), idle);
  for (int k = 0; k < pack.kind->constraints; ++k) store(same<P>(0), s.lambda + k * P);
  Flags<P> open = but_not(exceeds(worst, same<P>(settled)), either(hard, idle));
  while (any(open) && report.sweeps < most_sweeps) {
    backward<P>(pack, s, [&](int k, const Pack<P>& z) HWY_ATTR {
      store(add_where(open, load<P>(s.lambda + k * P), z), s.lambda + k * P);
    });
    ++report.sweeps;
    const Pack<P> before = worst;
    worst = sweep<P>(pack, s, false);
    const Flags<P> slow = both(open, exceeds(worst, same<P>(slow_sweep) * before));
    open = both(open, exceeds(worst, same<P>(settled)));
    const Flags<P> lost = both(slow, exceeds(worst, same<P>(64 * settled)));  // else it is rounding itself
    hard = either(hard, lost);
    open = but_not(open, either(slow, lost));
  }
  hard = either(hard, open);
  report.open = bits_of(hard);
  const Flags<P> out = either(hard, idle);
  if (any(out)) leave_out<P>(pack, out, s);
  const double inverse_h = 1 / h;
  put<P>(pack, s, [&](int a) { return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]}; });
  return report;
}

template <int P> MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  const Flags<P> singular = factorize_bonds<P>(pack, s), idle = idle_lanes<P>(pack);
  find_differences<P>(pack, c.v, c.edge, false, s);
  for (int k = 0; k < pack.kind->constraints; ++k) {
    forward<P>(pack, s, k, same<P>(0) - dot(load_vectors<P>(s.r + 3 * k * P), load_vectors<P>(s.s + 3 * k * P)));
  }
  backward<P>(pack, s, [&](int k, const Pack<P>& z) HWY_ATTR { store(z, s.lambda + k * P); });
  // The second time takes away what rounding has left of the first.
  with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& v) HWY_ATTR {
    forward<P>(pack, s, k, same<P>(0) - dot(load_vectors<P>(s.r + 3 * k * P), v));
  });
  backward<P>(pack, s,
              [&](int k, const Pack<P>& z) HWY_ATTR { store(load<P>(s.lambda + k * P) + z, s.lambda + k * P); });
  leave_out<P>(pack, either(singular, idle), s);
  put<P>(pack, s, [&](int a) { return VelocityRow{c.v[a]}; });
  return {bits_of(but_not(singular, idle)), 0};
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_pack<16>(pack, columns, task.h) : solve_pack<8>(pack, columns, task.h);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return pack.lanes == 16 ? project_pack<16>(pack, columns) : project_pack<8>(pack, columns);
}

}  // namespace

extern const MoleculeKernels newton_lanes;
const MoleculeKernels newton_lanes{.solve_positions = solve_positions, .project_velocities = project_velocities};

}  // namespace noether::NOETHER_SIMD_LEVEL
