#pragma once
/// Eight systems side by side as the methods for q'' = a(t, q, v) see them.

#include "engine/column.hpp"
#include "engine/outcome.hpp"
#include "integrators/force_lanes.hpp"

#include <cstddef>
#include <optional>
#include <utility>

namespace noether {

/// Numbers of eight systems: lane k of number i stands at [8 i + k].
using LaneNumbers = AlignedVector<double>;

/// Accelerations of eight systems, whose q are all x before all y before all z.
class LaneField {
 public:
  static constexpr std::size_t lanes = Pack::lanes;

  /// @param like  one of the systems; all have its size and its ids
  /// @throws Error  for forces that have no lanes, or cannot act on these particles
  LaneField(ForceField<double> forces, const ParticleSystem<double>& like);

  /// How many q a system has.
  Index size() const { return 3 * packs_.size(); }
  bool velocity_dependent() const { return velocity_dependent_; }
  void put_masses(std::size_t lane, const ParticleSystem<double>& s);
  void copy_masses(std::size_t from, std::size_t to);
  /// Keeps masses that `go_back()` returns to; that forgets failures too.
  void keep() { kept_.assign(std::as_const(packs_).masses()); }
  void go_back();
  /// a(t, q, v); every shape (size, 8).
  void accelerations(double t, const double* q, const double* v, double* a);
  /// Why forces could not be computed, in one lane at least, the first time since `go_back()`.
  const std::optional<Failure>& failure() const { return failure_; }

  const ForceField<double>& forces() const { return forces_.forces(); }
  /// Particles with the masses of a lane; their state is anything.
  const ParticleSystem<double>& particles(std::size_t lane);

 private:
  detail::ForceLanes forces_;
  ParticleSystem<double> one_;
  ParticleSystem<Pack> packs_;
  ScalarColumn<Pack> kept_;  ///< masses
  VectorColumn<Pack> a_;
  bool velocity_dependent_;
  std::optional<Failure> failure_;
};

}  // namespace noether
