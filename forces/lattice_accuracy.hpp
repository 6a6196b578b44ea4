#pragma once
/// How far forces of charges in a periodic box are from what they stand for.

#include "engine/any_force.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace noether {

/// What a sum over a lattice of charges has chosen, and the error of its forces. Errors are root mean squares, divided
/// by the force between two typical charges that are as far apart as neighbors: C <q^2> (n/V)^(2/3).
struct LatticeAccuracy {
  double asked = 0;                       ///< `relative_error`
  double expected = 0;                    ///< by the estimates, for charges in no order
  double reached = 0;                     ///< against Ewald's sum in 113 bits
  Index sampled = 0;                      ///< at so many charges
  Index charged = 0;                      ///< of these
  double alpha = 0;                       ///< [1/length]
  std::optional<double> kmax = {};        ///< of a sum over waves [1/length]
  std::array<std::int64_t, 3> mesh = {};  ///< points; 0 without a mesh
  std::int64_t order = 0;                 ///< of splines; 0 without a mesh
};

/// Of a force that is a sum over a lattice of charges; empty for all others, and where nothing is charged.
///
/// All charges that have a mass are asked, of more than 192 a sample of 64 that is always the same. Truth is Ewald's
/// sum with errors of 1e-13, or a hundredth of the error asked for where that is less, with a cutoff of its own: that
/// which costs least.
/// @param s  particles, or the sites of rigid bodies
/// @cost in proportion to the particles; about a minute of processor time for 25 000
std::optional<LatticeAccuracy> lattice_accuracy(const AnyForce<double>& force, const ParticleSystem<double>& s);

namespace detail {
/// Forces on some charges by Ewald's sum in 113 bits, right to `error` in the units of SplitErrors.
std::vector<Vec3<double>> exact_lattice_forces(const ParticleSystem<double>& s, const std::vector<Index>& on,
                                               double error);
}  // namespace detail

}  // namespace noether
