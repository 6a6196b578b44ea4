#pragma once
/// Forces on eight systems side by side.

#include "engine/outcome.hpp"
#include "engine/workspace.hpp"
#include "forces/sum.hpp"
#include "numbers/pack.hpp"

#include <cstddef>
#include <optional>

namespace noether::detail {

/// Accelerations in all lanes at once; where branches of a force differ, in one lane after the other, each time with
/// that lane in all eight: the same code has the same bits.
class ForceLanes {
 public:
  /// @param like  one of the systems; all have its size and its ids
  /// @throws Error  for forces that have no lanes, or cannot act on these particles
  ForceLanes(ForceField<double> forces, const ParticleSystem<double>& like);

  const ForceField<double>& forces() const { return forces_; }
  /// The accelerations by forces of one kick. @param letter  of the kick; 0: of all forces
  /// @return why a force could not be computed, in one lane at least
  std::optional<Failure> sum(char letter, const ParticleSystem<Pack>& s, VectorColumn<Pack>& a);

 private:
  std::optional<Failure> evaluate(char letter, const ParticleSystem<Pack>& s, VectorColumn<Pack>& a);

  ForceField<double> forces_;
  bool sets_;  ///< the one force sets accelerations, which nobody has to clear
  ParticleSystem<Pack> one_;
  VectorColumn<Pack> one_a_;
  Workspace workspace_;
  int careful_ = 0;  ///< evaluations to come that go lane by lane
};

}  // namespace noether::detail
