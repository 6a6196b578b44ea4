#pragma once
/// Eight systems side by side as the methods for q'' = a(t, q, v) see them.

#include "engine/column.hpp"
#include "engine/outcome.hpp"
#include "integrators/force_lanes.hpp"
#include "integrators/kicked_changes.hpp"

#include <cstddef>
#include <optional>
#include <utility>

namespace noether {

/// Numbers of eight systems: lane k of number i stands at [8 i + k].
using LaneNumbers = AlignedVector<double>;

/// Makes one lane of so many numbers longer.
inline void scale_lane(double* numbers, std::size_t count, std::size_t lane, double factor) {
  for (double* of = numbers + lane; of < numbers + count; of += Pack::lanes) *of *= factor;
}

/// Accelerations of eight systems, whose q are all x before all y before all z, and of small changes that go along:
/// q' of a change is that of its rate, and its acceleration the change of that of the system.
class LaneField {
 public:
  static constexpr std::size_t lanes = Pack::lanes;

  /// @param like  one of the systems; all have its size and its ids
  /// @throws Error  for forces that have no lanes, or cannot act on these particles
  LaneField(ForceField<double> forces, const ParticleSystem<double>& like);

  /// How many q a system has, and so each change.
  Index part() const { return 3 * packs_.size(); }
  /// How many q there are: those of the system, and then those of each change.
  Index size() const { return (1 + static_cast<Index>(changes_)) * part(); }
  /// From now on so many changes go along.
  /// @throws Error  naming a force that has no derivative
  void carry(std::size_t changes);
  std::size_t changes() const { return changes_; }
  bool velocity_dependent() const { return velocity_dependent_; }
  void put_masses(std::size_t lane, const ParticleSystem<double>& s);
  void copy_masses(std::size_t from, std::size_t to);
  /// Keeps masses that `go_back()` returns to; that forgets failures too.
  void keep() { kept_.assign(std::as_const(packs_).masses()); }
  void go_back();
  /// a(t, q, v); every shape (size, 8).
  void accelerations(double t, const double* q, const double* v, double* a);
  /// Those of the systems alone; every shape (part, 8).
  void of_systems(double t, const double* q, const double* v, double* a);
  /// da = (dq . grad_q) a + (dv . grad_v) a at (t, q, v), of one change; every shape (part, 8).
  void of_change(double t, const double* q, const double* v, const double* dq, const double* dv, double* da);
  /// Why forces could not be computed, in one lane at least, the first time since `go_back()`.
  const std::optional<Failure>& failure() const { return failure_; }

  const ForceField<double>& forces() const { return forces_.forces(); }
  /// Particles with the masses of a lane; their state is anything.
  const ParticleSystem<double>& particles(std::size_t lane);

 private:
  void go_to(double t, const double* q, const double* v);

  detail::ForceLanes forces_;
  ParticleSystem<double> one_;
  ParticleSystem<Pack> packs_;
  ScalarColumn<Pack> kept_;  ///< masses
  VectorColumn<Pack> a_;
  std::size_t changes_ = 0;
  std::optional<detail::KickedChanges> by_forces_;
  VectorColumn<Pack> u_, w_;  ///< a change of positions and velocities
  bool velocity_dependent_;
  std::optional<Failure> failure_;
};

/// Where the systems and their changes stand among numbers laid out as q of a field, once or several times over.
class LaneParts {
 public:
  LaneParts() = default;
  explicit LaneParts(const LaneField& f)
      : size_(LaneField::lanes * static_cast<std::size_t>(f.part())), count_(1 + f.changes()) {}

  /// Makes a change of one lane longer.
  void scale_change(LaneNumbers& numbers, std::size_t lane, std::size_t change, double factor) const {
    for (std::size_t at = (1 + change) * size_; at < numbers.size(); at += count_ * size_)
      scale_lane(numbers.data() + at, size_, lane, factor);
  }

 private:
  std::size_t size_ = 0;   ///< numbers of a part
  std::size_t count_ = 1;  ///< parts
};

}  // namespace noether
