#pragma once
/// What the errors of particles are measured by: distances and speeds relative to who attracts them most.

#include "engine/force_sink.hpp"
#include "numbers/types.hpp"

#include <limits>
#include <string>
#include <vector>

namespace noether {

class NeighborList;

/// How particles feel each other, as far as errors are concerned.
struct Coupling {
  bool gravity = false;  ///< all attract all
  double G = 0;          ///< [length^3/mass/time^2]
  double softening = 0;  ///< [length]
  double range = 0;      ///< of pair forces [length]; 0: there are none
  bool bonded = false;   ///< along the bonds of the topology

  bool any() const { return gravity || range > 0 || bonded; }

  /// As forces say it, over particles of a unit system with constant `G`.
  static Coupling of(const ForceClaims& claims, double G) {
    return {.gravity = claims.kepler,
            .G = claims.G.value_or(G),
            .softening = claims.softening,
            .range = claims.range,
            .bonded = claims.bonded};
  }
};

/// Lengths and speeds by particle, found once at the beginning of a step.
///
/// Of a particle counts the neighbor with the largest (m_i + m_j) / r^3, the one that it would fall into first: a moon
/// has its planet, although the Sun pulls harder. Lengths are the distance to that neighbor; speeds the relative one,
/// or under gravity that of a circle at this distance if it is larger. So errors of a pair are those of its orbit,
/// wherever it stands and in whatever units. A particle without neighbor has the length and the speed 0: its own
/// coordinates count.
struct ParticleScales {
  std::vector<double> length, speed;  ///< shape (n) [length], [length/time]; empty: y holds no particles
  std::vector<Index> neighbor;        ///< shape (n); meaningless where the length is 0
  /// What part of the tolerance a particle may use, shape (n): r / a on the orbit of semi-major axis a about its
  /// neighbor where that is below 1, but no less than `least_part`. What is lost at the pericenter of a long orbit is
  /// lost of the small difference that its energy is. 1 without gravity.
  std::vector<double> part;
  double size = 0, fastest = 0;  ///< largest |x|, |v| of all
  bool gravity = false;
  /// Two particles that fall towards each other where doubles cannot tell: rounding of their positions, far from the
  /// origin, is a tenth of the energy of their orbit.
  struct Lost {
    Index particle = -1, neighbor = -1;  ///< -1: there are none
    std::string name, neighbor_name;
    double distance = 0;  ///< [length]
  };
  /// What differs between the two ways that time can go.
  struct Ahead {
    /// How far a step may go: half the time until a particle is nearest to a massive one that will deflect it, and what
    /// it takes to pass by. A long way without forces must not end in a step over a short encounter [time].
    double longest = std::numeric_limits<double>::infinity();
    Lost lost = {};
  };
  Ahead forward, backward;
  const Ahead& ahead(double h) const { return h < 0 ? backward : forward; }

  /// Of `measure`, kept from step to step so that it allocates nothing: r / a about the neighbor, how fast that comes
  /// nearer [length^2/time], the bounds that each particle sets to a step either way, and who has mass.
  struct Work {
    std::vector<double> strength, binding, along, forward, backward;
    std::vector<Index> massive;
  } work = {};

  static constexpr double least_part = 1e-6;
  Index particles() const { return static_cast<Index>(length.size()); }
};

/// Measures particles.
/// @param s     wrapped into their box
/// @param list  looks for neighbors in range; null: all pairs are looked at
/// @param rtol  deflections by less than this are none
/// @cost O(n m) under gravity, m massive bodies, some 25 ns for each pair; else O(n) with a list, O(n^2) without one
template <class Real>
void measure(const ParticleSystem<Real>& s, const Coupling& coupling, NeighborList* list, double rtol,
             ParticleScales& out);
extern template void measure(const ParticleSystem<double>&, const Coupling&, NeighborList*, double, ParticleScales&);
extern template void measure(const ParticleSystem<Quad>&, const Coupling&, NeighborList*, double, ParticleScales&);

}  // namespace noether
