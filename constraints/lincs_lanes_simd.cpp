#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/molecule_multipliers_simd.hpp"

#include <limits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// A bond whose relative violation is larger is lost.
constexpr double lost_violation = 0.01;

/// D + C = G M^-1 G^T: couplings C of constraints that share an atom in place of factors, 1 / D in place of those of
/// pivots.
template <int P> HWY_INLINE void couple(const MoleculePack& pack, const Slots<P>& s) {
  const EliminationLists p = *pack.kind;
  find_couplings<P>(pack, s);
  for (int k = 0; k < p.constraints; ++k) {
    const double whole = 1 / (p.inverse_mass_i[k] + p.inverse_mass_j[k]);
    store(same<P>(whole) * load<P>(pack.lengths2 + (p.constraints + k) * P), s.inverse + k * P);
  }
}

/// (D + C)^-1 g by its series, D^-1 (g - C D^-1 g + ...), to so many powers of C; g is in y.
/// @return slots of what it comes to
template <int P> HWY_INLINE const double* expand(const MoleculePack& pack, const Slots<P>& s, int order) {
  const EliminationLists p = *pack.kind;
  const double *const couplings = s.factors, *const inverse = s.inverse, *const g = s.y;
  double *from = s.more, *to = from + p.constraints * P;
  for (int k = 0; k < p.constraints; ++k) store(load<P>(inverse + k * P) * load<P>(g + k * P), from + k * P);
  for (int power = 0; power < order; ++power) {
    for (int k = 0; k < p.constraints; ++k) {
      Pack<P> before = load<P>(g + k * P), after = same<P>(0);
      for (int e = p.row[k]; e < p.row[k + 1]; ++e)
        before = take_product(load<P>(couplings + e * P), load<P>(from + p.column[e] * P), before);
      for (int b = p.below[k]; b < p.below[k + 1]; ++b)
        after = add_product(load<P>(couplings + p.below_entry[b] * P), load<P>(from + p.below_row[b] * P), after);
      store(load<P>(inverse + k * P) * (before - after), to + k * P);
    }
    std::swap(from, to);
  }
  return from;
}

/// Multipliers that give bonds the right projections on where they pointed.
/// @return where a bond had lost its length before
template <int P> HWY_INLINE Flags<P> project_bonds(const MoleculePack& pack, const Slots<P>& s, int order) {
  const int n = pack.kind->constraints;
  Flags<P> lost = flags_of<P>(0);
  for (int k = 0; k < n; ++k) {
    const Vectors<P> r = load_vectors<P>(s.r + 3 * k * P);
    const Pack<P> d2 = load<P>(pack.lengths2 + k * P), r2 = dot(r, r);
    lost = either(lost, exceeds(absolute(r2 - d2), same<P>(2 * lost_violation) * d2));
    // r is not quite as long as d: |r| d, but for a square of the difference.
    store(same<P>(0.5) * (d2 + r2) - dot(r, load_vectors<P>(s.s + 3 * k * P)), s.y + k * P);
  }
  const double* const found = expand<P>(pack, s, order);
  for (int k = 0; k < n; ++k) store(load<P>(found + k * P), s.lambda + k * P);
  return lost;
}

/// Adds to multipliers what bonds are too long by, since they have turned: where one is l long, its projection is to be
/// (2 d^2 - l^2)^1/2. @return where one has turned too far for that
template <int P> HWY_INLINE Flags<P> correct_lengths(const MoleculePack& pack, const Slots<P>& s, int order) {
  const int n = pack.kind->constraints;
  Flags<P> lost = flags_of<P>(0);
  with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& at) HWY_ATTR {
    const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
    const Pack<P> left = take_product(at.x, at.x, take_product(at.y, at.y, take_product(at.z, at.z, d2 + d2)));
    lost = either(lost, exceeds(same<P>(0), left));
    store(root(d2 * left) - d2, s.y + k * P);
  });
  const double* const found = expand<P>(pack, s, order);
  for (int k = 0; k < n; ++k) store(load<P>(s.lambda + k * P) + load<P>(found + k * P), s.lambda + k * P);
  return lost;
}

/// @return where a bond is lost by what the series has made of it, or points away from where it did
template <int P> HWY_INLINE Flags<P> look_again(const MoleculePack& pack, const Slots<P>& s) {
  Flags<P> lost = flags_of<P>(0);
  with_multipliers<P>(pack, s, [&](int k, const Vectors<P>& at) HWY_ATTR {
    const Pack<P> d2 = load<P>(pack.lengths2 + k * P);
    lost = either(lost, exceeds(absolute(dot(at, at) - d2), same<P>(2 * lost_violation) * d2));
    lost = either(lost, exceeds(same<P>(0), dot(at, load_vectors<P>(s.r + 3 * k * P))));
  });
  return lost;
}

/// Multipliers into the columns, but not those of some lanes. @return a bit for each of these that is a molecule
template <int P, class MakeRow>
HWY_INLINE unsigned end(const MoleculePack& pack, const Slots<P>& s, const Flags<P>& lost, const MakeRow& make_row) {
  const Flags<P> idle = idle_lanes<P>(pack);
  leave_out<P>(pack, either(lost, idle), s);
  put<P>(pack, s, make_row);
  return bits_of(but_not(lost, idle));
}

template <int P>
MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  couple<P>(pack, s);
  find_differences<P>(pack, c.x, c.edge, true, s);
  Flags<P> lost = project_bonds<P>(pack, s, task.order);
  for (int k = 0; k < task.iterations; ++k) lost = either(lost, correct_lengths<P>(pack, s, task.order));
  lost = either(lost, look_again<P>(pack, s));
  const double inverse_h = 1 / task.h;
  const unsigned open = end<P>(pack, s, lost, [&](int a) {
    return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]};
  });
  return {.open = open, .sweeps = (task.iterations + 1) * task.order};
}

template <int P>
MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const Slots<P> s(pack);
  find_bonds<P>(pack, c, s);
  couple<P>(pack, s);
  find_differences<P>(pack, c.v, c.edge, false, s);
  Flags<P> lost = flags_of<P>(0);
  for (int k = 0; k < pack.kind->constraints; ++k) {
    const Pack<P> rate = dot(load_vectors<P>(s.r + 3 * k * P), load_vectors<P>(s.s + 3 * k * P));
    lost = either(lost, exceeds(absolute(rate), same<P>(std::numeric_limits<double>::max())));
    store(same<P>(0) - rate, s.y + k * P);
  }
  const double* const found = expand<P>(pack, s, task.order);
  for (int k = 0; k < pack.kind->constraints; ++k) {
    lost = either(lost, exceeds(absolute(load<P>(found + k * P)), same<P>(std::numeric_limits<double>::max())));
    store(load<P>(found + k * P), s.lambda + k * P);
  }
  const unsigned open = end<P>(pack, s, lost, [&](int a) { return VelocityRow{c.v[a]}; });
  return {.open = open, .sweeps = task.order};
}

MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? solve_pack<16>(pack, columns, task) : solve_pack<8>(pack, columns, task);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return pack.lanes == 16 ? project_pack<16>(pack, columns, task) : project_pack<8>(pack, columns, task);
}

}  // namespace

extern const MoleculeKernels lincs_lanes;
const MoleculeKernels lincs_lanes{.solve_positions = solve_positions,
                                  .project_velocities = project_velocities,
                                  .slots = [](const EliminationLists& kind) { return 2 * kind.constraints; }};

}  // namespace noether::NOETHER_SIMD_LEVEL
