#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/molecule_stage_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// What sweeps have done to the atoms so far: vectors in slots of 3 P numbers, in place of factors.
template <int P> HWY_INLINE double* corrections(const MoleculePack& pack, const Slots<P>& s) {
  for (int k = 0; k < 3 * pack.kind->atoms; ++k) store(same<P>(0), s.more + k * P);
  return s.more;
}

/// One constraint after the other, in the order of the set, each in the lanes where `step` says how far; adds step r /
/// m to its atoms.
/// @param worst  receives the largest violation; one that is not a number may be lost
/// @return where a violation is above the tolerance, or is not a number
template <int P, class Step>
HWY_INLINE Flags<P> sweep(const MoleculePack& pack, const Slots<P>& s, double* moved, double tolerance,
                          const Step& step, Pack<P>& worst) {
  const EliminationLists p = *pack.kind;
  Flags<P> over = flags_of<P>(0);
  worst = same<P>(0);
  for (int next = 0; next < p.constraints; ++next) {
    const int k = p.given[next];
    double *const i = moved + 3 * p.i[k] * P, *const j = moved + 3 * p.j[k] * P;
    const Vectors<P> r = load_vectors<P>(s.r + 3 * k * P), before_i = load_vectors<P>(i), before_j = load_vectors<P>(j);
    const Vectors<P> at = load_vectors<P>(s.s + 3 * k * P) + (before_i - before_j);
    Pack<P> violation;
    const Pack<P> whole = step(k, r, at, violation);
    const Flags<P> wrong = exceeds(violation, same<P>(tolerance));
    over = either(over, wrong);
    worst = larger_number(violation, worst);
    const Pack<P> part = only_where(wrong, whole);
    store(add_product(same<P>(p.inverse_mass_i[k]) * part, r, before_i), i);
    store(take_product(same<P>(p.inverse_mass_j[k]) * part, r, before_j), j);
  }
  return over;
}

/// Sweeps until no violation is above the tolerance; lanes that are done wait. @return those that are not
template <int P, class Step>
HWY_INLINE Flags<P> sweep_all(const MoleculePack& pack, const Slots<P>& s, double* moved, const MoleculeTask& task,
                              MoleculeReport& report, const Step& step) {
  const Flags<P> idle = idle_lanes<P>(pack);
  Pack<P> worst, first = same<P>(0);
  while (true) {
    const Flags<P> open = sweep<P>(pack, s, moved, task.tolerance, step, worst);
    const bool ends = !any(open) || report.sweeps == task.iterations;
    if (report.sweeps == 0) first = worst;
    if (ends) {
      const Flags<P> out = either(idle, open);
      report.before = largest_but<P>(out, first), report.after = largest_but<P>(out, worst);
      return open;
    }
    ++report.sweeps;
  }
}

/// Corrections into the columns, one axis after the other, but not those of some lanes.
template <int P, class MakeRow>
HWY_INLINE void put(const MoleculePack& pack, const Slots<P>& s, const double* moved, const Flags<P>& out,
                    const MakeRow& make_row) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int a = 0; a < pack.kind->atoms; ++a)
      store(none_where(out, load<P>(moved + (3 * a + axis) * P)), s.one + a * P);
    store_atoms<P>(pack, s.one, make_row(axis));
  }
}

/// Where a bond points away from where it did: a root that does not go on from a step of 0.
template <int P> HWY_INLINE Flags<P> turned_over(const MoleculePack& pack, const Slots<P>& s, const double* moved) {
  const EliminationLists p = *pack.kind;
  Flags<P> turned = flags_of<P>(0);
  for (int k = 0; k < p.constraints; ++k) {
    const Vectors<P> by = load_vectors<P>(moved + 3 * p.i[k] * P) - load_vectors<P>(moved + 3 * p.j[k] * P);
    const Vectors<P> at = load_vectors<P>(s.s + 3 * k * P) + by;
    turned = either(turned, exceeds(same<P>(0), dot(at, load_vectors<P>(s.r + 3 * k * P))));
  }
  return turned;
}

template <int P>
MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  find_differences<P>(pack, c.x, c.edge, true, s);
  double* const moved = corrections<P>(pack, s);
  const int n = pack.kind->constraints;
  MoleculeReport report;
  Flags<P> open = sweep_all<P>(
      pack, s, moved, task, report, [&](int k, const Vectors<P>& r, const Vectors<P>& at, Pack<P>& violation) HWY_ATTR {
        const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
        const Pack<P> g =
            same<P>(0.5) * take_product(at.x, at.x, take_product(at.y, at.y, take_product(at.z, at.z, d2)));
        violation = absolute(g) * load<P>(pack.lengths2 + (n + k) * P);
        return g / (same<P>(pack.kind->inverse_mass_i[k] + pack.kind->inverse_mass_j[k]) * dot(at, r));
      });
  open = either(open, turned_over<P>(pack, s, moved));
  const Flags<P> idle = idle_lanes<P>(pack);
  report.open = bits_of(but_not(open, idle));
  const double inverse_h = 1 / task.h;
  put<P>(pack, s, moved, either(open, idle), [&](int a) { return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]}; });
  return report;
}

template <int P>
MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  find_differences<P>(pack, c.v, c.edge, false, s);
  double* const moved = corrections<P>(pack, s);
  const int n = pack.kind->constraints;
  MoleculeReport report;
  const Flags<P> open = sweep_all<P>(
      pack, s, moved, task, report, [&](int k, const Vectors<P>& r, const Vectors<P>& v, Pack<P>& violation) HWY_ATTR {
        const Pack<P> rate = dot(r, v), inverse = load<P>(pack.lengths2 + (n + k) * P);
        violation = absolute(rate) * (same<P>(task.h < 0 ? -task.h : task.h) * inverse);
        return (same<P>(0) - rate) / (same<P>(pack.kind->inverse_mass_i[k] + pack.kind->inverse_mass_j[k]) * dot(r, r));
      });
  const Flags<P> idle = idle_lanes<P>(pack);
  report.open = bits_of(but_not(open, idle));
  put<P>(pack, s, moved, either(open, idle), [&](int a) { return VelocityRow{c.v[a]}; });
  return report;
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_pack<16>(pack, columns, task) : solve_pack<8>(pack, columns, task);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? project_pack<16>(pack, columns, task) : project_pack<8>(pack, columns, task);
}

}  // namespace

extern const MoleculeKernels sweep_lanes;
const MoleculeKernels sweep_lanes{.solve_positions = solve_positions, .project_velocities = project_velocities};

}  // namespace noether::NOETHER_SIMD_LEVEL
