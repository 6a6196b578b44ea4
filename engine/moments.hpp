#pragma once
/// Momenta and moments of all particles: sums of vectors that come out the same in any order.

#include "engine/particle_system.hpp"
#include "engine/wide_sums_row.hpp"

namespace noether {

/// Sum of m_i times the rows of a column of shape (n, 3).
/// @cost O(n), the columns read twice
WideSums weighted_sum(const ParticleSystem<double>& s, const VectorColumn<double>& of);
Vec3<Quad> weighted_sum(const ParticleSystem<Quad>& s, const VectorColumn<Quad>& of);

/// Sum of m_i x_i along paths that were never wrapped into a box [mass length].
WideSums weighted_positions(const ParticleSystem<double>& s);
Vec3<Quad> weighted_positions(const ParticleSystem<Quad>& s);

/// Sum of x_i cross m_i v_i [mass length^2/time].
WideSums angular_momentum(const ParticleSystem<double>& s);
Vec3<Quad> angular_momentum(const ParticleSystem<Quad>& s);

/// Such sums as vectors of the run's own numbers.
inline Vec3<double> rounded(const WideSums& sums) {
  return {sums.high[0] + sums.low[0], sums.high[1] + sums.low[1], sums.high[2] + sums.low[2]};
}
inline Vec3<Quad> rounded(const Vec3<Quad>& sums) { return sums; }

}  // namespace noether
