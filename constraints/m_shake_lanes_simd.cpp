#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/newton_stage_simd.hpp"

#include <limits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// Newton's steps, of which a few do.
constexpr int most_steps = 20;

/// A dense matrix of a pack, row by row, in slots behind bond vectors of the moment.
template <int P> struct Dense {
  int n;
  double *now, *elements;

  Dense(const MoleculePack& pack, const Slots<P>& s)
      : n(pack.kind->constraints), now(s.more), elements(s.more + 3 * n * P) {}
  double* at(int k, int l) const { return elements + (k * n + l) * P; }
};

/// S M^-1 R^T of bond vectors S, which `now` has, and R at the start.
template <int P> HWY_INLINE void assemble(const MoleculePack& pack, const Slots<P>& s, const Dense<P>& m) {
  const EliminationLists p = *pack.kind;
  for (int e = 0; e < m.n * m.n; ++e) store(same<P>(0), m.elements + e * P);
  for (int k = 0; k < m.n; ++k) {
    const Vectors<P> now = load_vectors<P>(m.now + 3 * k * P), r = load_vectors<P>(s.r + 3 * k * P);
    store(same<P>(p.inverse_mass_i[k] + p.inverse_mass_j[k]) * dot(now, r), m.at(k, k));
    for (int e = p.row[k]; e < p.row[k + 1]; ++e) {
      const int l = p.column[e];
      const Pack<P> w = same<P>(p.coupling[e]);
      store(w * dot(now, load_vectors<P>(s.r + 3 * l * P)), m.at(k, l));
      store(w * dot(load_vectors<P>(m.now + 3 * l * P), r), m.at(l, k));
    }
  }
}

/// L U, in place, with 1 / U_kk on the diagonal: without pivoting, since the matrix is nearly symmetric and positive.
/// @return where it is singular
template <int P> HWY_INLINE Flags<P> factorize(const MoleculePack& pack, const Dense<P>& m) {
  const EliminationLists& p = *pack.kind;
  Flags<P> singular = flags_of<P>(0);
  for (int k = 0; k < m.n; ++k) {
    const Pack<P> pivot = load<P>(m.at(k, k));
    const Pack<P> whole = same<P>(p.inverse_mass_i[k] + p.inverse_mass_j[k]) * load<P>(pack.lengths2 + k * P);
    singular = either(singular, exceeds(same<P>(least_pivot) * whole, pivot));
    const Pack<P> inverse = same<P>(1) / pivot;
    store(inverse, m.at(k, k));
    for (int i = k + 1; i < m.n; ++i) {
      const Pack<P> factor = load<P>(m.at(i, k)) * inverse;
      store(factor, m.at(i, k));
      for (int j = k + 1; j < m.n; ++j)
        store(take_product(factor, load<P>(m.at(k, j)), load<P>(m.at(i, j))), m.at(i, j));
    }
  }
  return singular;
}
/// Solves for what y has, in place.
template <int P> HWY_INLINE void solve(const Dense<P>& m, double* y) {
  for (int k = 1; k < m.n; ++k) {
    Pack<P> z = load<P>(y + k * P);
    for (int l = 0; l < k; ++l) z = take_product(load<P>(m.at(k, l)), load<P>(y + l * P), z);
    store(z, y + k * P);
  }
  for (int k = m.n - 1; k >= 0; --k) {
    Pack<P> z = load<P>(y + k * P);
    for (int l = k + 1; l < m.n; ++l) z = take_product(load<P>(m.at(k, l)), load<P>(y + l * P), z);
    store(z * load<P>(m.at(k, k)), y + k * P);
  }
}
/// Adds what y has to the multipliers of some lanes.
template <int P> HWY_INLINE void add_multipliers(const Slots<P>& s, int n, const Flags<P>& lanes) {
  for (int k = 0; k < n; ++k)
    store(add_where(lanes, load<P>(s.lambda + k * P), load<P>(s.y + k * P)), s.lambda + k * P);
}

/// Bonds and violations with the multipliers at hand, into `now` and y. @return the worst of each lane
template <int P> HWY_INLINE Pack<P> look(const MoleculePack& pack, const Slots<P>& s, const Dense<P>& m) {
  Pack<P> worst = same<P>(0);
  with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& at) HWY_ATTR {
    const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
    const Pack<P> g = same<P>(0.5) * take_product(at.x, at.x, take_product(at.y, at.y, take_product(at.z, at.z, d2)));
    worst = larger(worst, absolute(g) * load<P>(pack.lengths2 + (m.n + k) * P));
    store(at, m.now + 3 * k * P);
    store(g, s.y + k * P);
  });
  return worst;
}
/// Where a bond points away from where it did: a root that does not go on from a step of 0.
template <int P> HWY_INLINE Flags<P> turned_over(const Slots<P>& s, const Dense<P>& m) {
  Flags<P> turned = flags_of<P>(0);
  for (int k = 0; k < m.n; ++k) {
    const Pack<P> along = dot(load_vectors<P>(m.now + 3 * k * P), load_vectors<P>(s.r + 3 * k * P));
    turned = either(turned, exceeds(same<P>(0), along));
  }
  return turned;
}

template <int P> MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, double h) {
  const Slots<P> s(pack);
  const Dense<P> m(pack, s);
  find_bonds<P>(pack, c, s);
  find_differences<P>(pack, c.x, c.edge, true, s);
  for (int k = 0; k < m.n; ++k) store(same<P>(0), s.lambda + k * P);
  MoleculeReport report;
  const Flags<P> idle = idle_lanes<P>(pack);
  Pack<P> worst = look<P>(pack, s, m);
  const Pack<P> first = worst;
  Flags<P> hard = but_not(exceeds(worst, same<P>(hard_start)), idle);
  Flags<P> open = but_not(exceeds(worst, same<P>(settled)), either(hard, idle));
  while (any(open) && report.sweeps < most_steps) {
    assemble<P>(pack, s, m);
    const Flags<P> singular = both(open, factorize<P>(pack, m));
    hard = either(hard, singular);
    open = but_not(open, singular);
    solve<P>(m, s.y);
    add_multipliers<P>(s, m.n, open);
    ++report.sweeps;
    const Pack<P> before = worst;
    worst = look<P>(pack, s, m);
    const Flags<P> slow = both(open, exceeds(worst, same<P>(slow_sweep) * before));
    open = both(open, exceeds(worst, same<P>(settled)));
    const Flags<P> lost = both(slow, exceeds(worst, same<P>(64 * settled)));  // else it is rounding itself
    hard = either(hard, lost);
    open = but_not(open, either(slow, lost));
  }
  hard = but_not(either(either(hard, open), turned_over<P>(s, m)), idle);
  report.open = bits_of(hard);
  const Flags<P> out = either(hard, idle);
  report.before = largest_but<P>(out, first), report.after = largest_but<P>(out, worst);
  leave_out<P>(pack, out, s);
  const double inverse_h = 1 / h;
  put<P>(pack, s, [&](int a) { return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]}; });
  return report;
}

template <int P> MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c) {
  const Slots<P> s(pack);
  const Dense<P> m(pack, s);
  find_bonds<P>(pack, c, s);
  find_differences<P>(pack, c.v, c.edge, false, s);
  for (int k = 0; k < m.n; ++k) {
    store(load_vectors<P>(s.r + 3 * k * P), m.now + 3 * k * P);
    store(same<P>(0), s.lambda + k * P);
  }
  assemble<P>(pack, s, m);
  Flags<P> lost = factorize<P>(pack, m);
  const Flags<P> idle = idle_lanes<P>(pack);
  for (int pass = 0; pass < 2; ++pass) {  // the second takes away what rounding has left of the first
    with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& v) HWY_ATTR {
      const Pack<P> rate = dot(load_vectors<P>(s.r + 3 * k * P), v);
      lost = either(lost, exceeds(absolute(rate), same<P>(std::numeric_limits<double>::max())));
      store(same<P>(0) - rate, s.y + k * P);
    });
    solve<P>(m, s.y);
    add_multipliers<P>(s, m.n, flags_of<P>(~0U));
  }
  leave_out<P>(pack, either(lost, idle), s);
  put<P>(pack, s, [&](int a) { return VelocityRow{c.v[a]}; });
  return {.open = bits_of(but_not(lost, idle))};
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_pack<16>(pack, columns, task.h) : solve_pack<8>(pack, columns, task.h);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return pack.lanes == 16 ? project_pack<16>(pack, columns) : project_pack<8>(pack, columns);
}

}  // namespace

extern const MoleculeKernels m_shake_lanes;
const MoleculeKernels m_shake_lanes{
    .solve_positions = solve_positions,
    .project_velocities = project_velocities,
    .slots = [](const EliminationLists& kind) { return (3 + kind.constraints) * kind.constraints; },
    .most_of_sixteen = 8,
    .most_constraints = 64};

}  // namespace noether::NOETHER_SIMD_LEVEL
