#pragma once
/// Small changes of eight systems in lanes that are kicked by forces.

#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/varied_splitting.hpp"

#include <cstddef>
#include <vector>

namespace noether::detail {

/// Forces along a direction in each of eight systems, by dual numbers, one system after the other.
class LaneSlopes {
 public:
  /// @param velocities  whether forces may depend on them, and `sum` is given changes of them
  /// @throws Error  naming a force that has no derivative
  LaneSlopes(const ForceField<double>& forces, const ParticleSystem<double>& like, bool velocities = false);
  bool any() const { return slopes_.any(); }
  /// @param u  changes of positions @param letter  of the kick; 0: of all forces @param w  changes of velocities
  /// @return their sums, not added to anything
  const VectorColumn<Pack>& sum(char letter, const ParticleSystem<Pack>& s, const VectorColumn<Pack>& u,
                                const VectorColumn<Pack>* w = nullptr);

 private:
  ForceSlopes<double> slopes_;
  VectorColumn<double> x_, u_, v_, w_;
  VectorColumn<Pack> a_;
};

/// How kicks by forces go on to changes: gravity in closed form in all lanes, other forces by `LaneSlopes`.
class KickedChanges {
 public:
  /// @param velocities, @throws  as `LaneSlopes`
  KickedChanges(const ForceField<double>& forces, const ParticleSystem<double>& like, bool velocities = false);
  /// What changes of positions, and of velocities if they are given, do to the accelerations of the kicks of a letter.
  void sum(char letter, const ParticleSystem<Pack>& s, const VectorColumn<Pack>& u, VectorColumn<Pack>& a,
           const VectorColumn<Pack>* w = nullptr);

 private:
  struct Attraction {
    double G, softening;
    std::string kicks;
  };
  static ForceField<double> others_of(const ForceField<double>& forces);

  std::vector<Attraction> gravity_;
  LaneSlopes others_;
};

}  // namespace noether::detail
