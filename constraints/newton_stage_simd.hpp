#pragma once
/// Newton's method with chord steps, whatever the shape of the molecules; for `*_simd.cpp` alone.
///
/// Equations are doubled, 2 G M^-1 G^T lambda = d^2 - |s|^2: bits stay the same, and it saves a factor.

#include "constraints/molecule_multipliers_simd.hpp"

#include <limits>

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

/// The right side of a position stage.
template <int P> struct Squares {
  const double *lengths2, *inverse_lengths2;
  Pack<P> worst = same<P>(0);  ///< | |s|^2 / d^2 - 1 |; one that is not a number may be lost

  explicit Squares(const MoleculePack& pack)
      : lengths2(pack.lengths2), inverse_lengths2(pack.lengths2 + pack.kind->constraints * P) {}
  HWY_INLINE Pack<P> operator()(int k, const Vectors<P>& s) {
    const Pack<P> d2 = load<P>(lengths2 + k * P);
    const Pack<P> g = take_product(s.x, s.x, take_product(s.y, s.y, take_product(s.z, s.z, d2)));
    worst = larger_number(absolute(g) * load<P>(inverse_lengths2 + k * P), worst);
    return g;
  }
  /// The worst of a sweep, with what it has carried; then begins anew.
  HWY_INLINE Pack<P> take_worst(const Pack<P>& carried) {
    const Pack<P> found = add_product(same<P>(0), carried, same<P>(0.5) * worst);
    worst = same<P>(0);
    return found;
  }
};
/// The right side of a velocity stage.
template <int P> struct Rates {
  const double* r;
  HWY_INLINE Pack<P> operator()(int k, const Vectors<P>& v) const {
    return same<P>(-2) * dot(load_vectors<P>(r + 3 * k * P), v);
  }
};

/// Takes the second half of a chord step. @param first  there are no multipliers yet
template <int P, bool first> HWY_INLINE void add_step(const Flags<P>& lanes, const Pack<P>& step, double* lambda) {
  store(first ? only_where(lanes, step) : add_where(lanes, load<P>(lambda), step), lambda);
}

/// The position stage of what knows the shape of its molecules:
///
///     bonds.find(c)                    vectors r of bonds at the start
///     bonds.find_differences(x, ...)   s, of what free motion has made of them
///     bonds.factorize()                2 G M^-1 G^T; returns where it is singular
///     bonds.idle()                     lanes that stand for nothing of their own
///     bonds.sweep<moved>(value)        the first half of a chord step: solves for the right side value(k, s), where
///     the
///                                      multipliers have moved s; returns what is no number if an element of it is none
///     bonds.step<first>(lanes)         the second half, in these lanes
///     bonds.of_molecule(worst)         the worst in all lanes of a molecule, if it stands in several
///     bonds.leave_out(lanes)           multipliers 0
///     bonds.put(make_row)              M^-1 G^T lambda into the columns
template <int P, class Bonds>
HWY_INLINE MoleculeReport solve_by_chords(Bonds bonds, const MoleculePack& pack, const MoleculeColumns& c, double h) {
  MoleculeReport report;
  bonds.find(c);
  const Flags<P> singular = bonds.factorize(), idle = bonds.idle();
  bonds.find_differences(c.x, c.edge, true);
  Squares<P> squares(pack);
  Pack<P> worst = bonds.of_molecule(squares.take_worst(bonds.template sweep<false>(squares)));
  Flags<P> hard = but_not(either(singular, exceeds(worst, same<P>(hard_start))), idle);
  Flags<P> open = but_not(exceeds(worst, same<P>(settled)), either(hard, idle));
  const Pack<P> first = worst;
  bonds.template step<true>(open);
  while (any(open)) {
    const Pack<P> before = worst;
    worst = bonds.of_molecule(squares.take_worst(bonds.template sweep<true>(squares)));
    const Flags<P> slow = both(open, exceeds(worst, same<P>(slow_sweep) * before));
    open = both(open, exceeds(worst, same<P>(settled)));
    const Flags<P> lost = both(slow, exceeds(worst, same<P>(64 * settled)));  // else it is rounding itself
    hard = either(hard, lost);
    open = but_not(open, either(slow, lost));
    if (++report.sweeps == most_sweeps) hard = either(hard, open), open = flags_of<P>(0);
    if (any(open)) bonds.template step<false>(open);
  }
  report.open = bits_of(hard);
  const Flags<P> out = either(hard, idle);
  report.before = largest_but<P>(out, first), report.after = largest_but<P>(out, worst);
  if (any(out)) bonds.leave_out(out);
  const double inverse_h = 1 / h;
  bonds.put([&](int a) { return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]}; });
  return report;
}

/// The velocity stage.
template <int P, class Bonds> HWY_INLINE MoleculeReport project_by_factors(Bonds bonds, const MoleculeColumns& c) {
  bonds.find(c);
  const Flags<P> singular = bonds.factorize(), idle = bonds.idle();
  bonds.find_differences(c.v, c.edge, false);
  Rates<P> rates{bonds.vectors()};
  // Velocities that are no numbers are left to those who name them.
  const Pack<P> carried = bonds.of_molecule(absolute(bonds.template sweep<false>(rates)));
  const Flags<P> lost = but_not(either(singular, exceeds(carried, same<P>(std::numeric_limits<double>::max()))), idle);
  const Flags<P> solved = but_not(flags_of<P>((1U << P) - 1), either(lost, idle));
  bonds.template step<true>(solved);
  bonds.template sweep<true>(rates);  // what rounding has left of the first one
  bonds.template step<false>(solved);
  bonds.put([&](int a) { return VelocityRow{c.v[a]}; });
  return {.open = bits_of(lost)};
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
