#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/molecule_multipliers_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// How far a pack is from its constraints.
template <int P> struct Violation {
  Pack<P> worst;    ///< of each lane, relative
  Flags<P> turned;  ///< where a bond points away from where it did: a root that does not go on from a step of 0
};

/// An element of Q g.
template <int P> HWY_INLINE Pack<P> preconditioned(const PreconditionerLists& q, int k, const double* g) {
  Pack<P> even = same<P>(0), odd = same<P>(0);
  int e = q.row[k];
  for (; e + 1 < q.row[k + 1]; e += 2) {
    even = add_product(same<P>(q.value[e]), load<P>(g + q.column[e] * P), even);
    odd = add_product(same<P>(q.value[e + 1]), load<P>(g + q.column[e + 1] * P), odd);
  }
  if (e < q.row[k + 1]) even = add_product(same<P>(q.value[e]), load<P>(g + q.column[e] * P), even);
  return even + odd;
}

/// Adds z + Q (g - A z) with z = Q g to the multipliers of some lanes: Q is the inverse of the matrix of the kind,
/// about, A that of the molecule; g is in y.
template <int P> HWY_INLINE void add_multipliers(const MoleculePack& pack, const Slots<P>& s, const Flags<P>& lanes) {
  const EliminationLists p = *pack.kind;
  const PreconditionerLists q = *pack.preconditioner;
  const double* const couplings = s.factors;
  double *const z = s.more, *const rest = z + p.constraints * P;
  for (int k = 0; k < p.constraints; ++k) store(preconditioned<P>(q, k, s.y), z + k * P);
  for (int k = 0; k < p.constraints; ++k) {
    const Pack<P> whole = same<P>(p.inverse_mass_i[k] + p.inverse_mass_j[k]) * load<P>(pack.lengths2 + k * P);
    Pack<P> left = take_product(whole, load<P>(z + k * P), load<P>(s.y + k * P)), later = same<P>(0);
    for (int e = p.row[k]; e < p.row[k + 1]; ++e)
      left = take_product(load<P>(couplings + e * P), load<P>(z + p.column[e] * P), left);
    for (int b = p.below[k]; b < p.below[k + 1]; ++b)
      later = add_product(load<P>(couplings + p.below_entry[b] * P), load<P>(z + p.below_row[b] * P), later);
    store(left - later, rest + k * P);
  }
  for (int k = 0; k < p.constraints; ++k) {
    const Pack<P> step = load<P>(z + k * P) + preconditioned<P>(q, k, rest);
    store(add_where(lanes, load<P>(s.lambda + k * P), step), s.lambda + k * P);
  }
}

/// Steps in the lanes that are above the tolerance, until none is or they no longer gain anything.
/// @param look  finds the violation with the multipliers at hand, and g
/// @return what is above it
template <int P, class Look>
HWY_INLINE Flags<P> iterate(const MoleculePack& pack, const Slots<P>& s, const MoleculeTask& task,
                            MoleculeReport& report, const Look& look) {
  for (int k = 0; k < pack.kind->constraints; ++k) store(same<P>(0), s.lambda + k * P);
  const Flags<P> idle = idle_lanes<P>(pack);
  const Pack<P> tolerance = same<P>(task.tolerance);
  Violation<P> now = look();
  Flags<P> open = but_not(exceeds(now.worst, tolerance), idle), lost = flags_of<P>(0);
  const Pack<P> first = now.worst;
  while (any(open) && report.sweeps < task.iterations) {
    add_multipliers<P>(pack, s, open);
    ++report.sweeps;
    const Pack<P> before = now.worst;
    now = look();
    lost = either(lost, both(open, exceeds(now.worst, before)));
    open = but_not(both(open, exceeds(now.worst, tolerance)), lost);
  }
  const Flags<P> wrong = but_not(either(either(open, lost), now.turned), idle), out = either(wrong, idle);
  report.before = largest_but<P>(out, first), report.after = largest_but<P>(out, now.worst);
  return wrong;
}

/// Multipliers into the columns, but not those of some lanes.
template <int P, class MakeRow>
HWY_INLINE void end(const MoleculePack& pack, const Slots<P>& s, const Flags<P>& lost, const MakeRow& make_row) {
  leave_out<P>(pack, either(lost, idle_lanes<P>(pack)), s);
  put<P>(pack, s, make_row);
}

template <int P>
MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  find_couplings<P>(pack, s);
  find_differences<P>(pack, c.x, c.edge, true, s);
  MoleculeReport report;
  const Flags<P> lost = iterate<P>(pack, s, task, report, [&]() HWY_ATTR {
    Violation<P> found{same<P>(0), flags_of<P>(0)};
    with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& at) HWY_ATTR {
      const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
      const Pack<P> g = same<P>(0.5) * take_product(at.x, at.x, take_product(at.y, at.y, take_product(at.z, at.z, d2)));
      found.worst = larger(found.worst, absolute(g) * load<P>(pack.lengths2 + (pack.kind->constraints + k) * P));
      found.turned = either(found.turned, exceeds(same<P>(0), dot(at, load_vectors<P>(s.r + 3 * k * P))));
      store(g, s.y + k * P);
    });
    return found;
  });
  report.open = bits_of(lost);
  const double inverse_h = 1 / task.h;
  end<P>(pack, s, lost, [&](int a) { return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]}; });
  return report;
}

template <int P>
MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  find_couplings<P>(pack, s);
  find_differences<P>(pack, c.v, c.edge, false, s);
  const Pack<P> span = same<P>(task.h < 0 ? -task.h : task.h);
  MoleculeReport report;
  const Flags<P> lost = iterate<P>(pack, s, task, report, [&]() HWY_ATTR {
    Violation<P> found{same<P>(0), flags_of<P>(0)};
    with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& v) HWY_ATTR {
      const Pack<P> rate = dot(load_vectors<P>(s.r + 3 * k * P), v);
      const Pack<P> inverse = load<P>(pack.lengths2 + (pack.kind->constraints + k) * P);
      found.worst = larger(found.worst, absolute(rate) * (span * inverse));
      store(same<P>(0) - rate, s.y + k * P);
    });
    return found;
  });
  report.open = bits_of(lost);
  end<P>(pack, s, lost, [&](int a) { return VelocityRow{c.v[a]}; });
  return report;
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_pack<16>(pack, columns, task) : solve_pack<8>(pack, columns, task);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? project_pack<16>(pack, columns, task) : project_pack<8>(pack, columns, task);
}

}  // namespace

extern const MoleculeKernels p_shake_lanes;
const MoleculeKernels p_shake_lanes{.solve_positions = solve_positions,
                                    .project_velocities = project_velocities,
                                    .slots = [](const EliminationLists& kind) { return 2 * kind.constraints; }};

}  // namespace noether::NOETHER_SIMD_LEVEL
