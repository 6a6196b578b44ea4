#pragma once
/// Eight runs at once, one to a lane.

#include "engine/outcome.hpp"
#include "engine/particle_system.hpp"
#include "integrators/lane_change.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace noether {

/// Eight systems of one make, members of an ensemble, that are stepped side by side, whatever steps them.
///
/// What becomes of a lane depends on what was put into it, and on nothing else.
class LaneRun {
 public:
  static constexpr std::size_t lanes = 8;

  virtual ~LaneRun() = default;
  virtual std::int64_t step() const = 0;

  /// Puts inertial particles into a lane, before the first step.
  virtual void put(std::size_t lane, const ParticleSystem<double>& s) = 0;
  /// A lane becomes a copy of another one.
  virtual void copy_lane(std::size_t from, std::size_t to) = 0;

  /// From now on small changes of each system go along.
  /// @throws Error  naming what has no derivative
  virtual void carry(std::size_t changes) = 0;
  /// From here a change goes along with the system of a lane, one of those that are carried.
  virtual void follow(std::size_t lane, std::size_t change, std::shared_ptr<LaneChange> by) = 0;
  /// Nobody looks at the changes of a lane any more.
  virtual void forget(std::size_t lane) = 0;

  /// Makes steps, up to one that fails in a lane. @return whether none has failed
  virtual bool advance(std::int64_t steps) = 0;
  /// Why a step could not be done since `go_back()`, in one lane at least; the first time tells.
  virtual const std::optional<Failure>& failure() const = 0;
  /// Completes a copy, which `take` tells of.
  virtual void settle() = 0;
  /// Gives particles the settled state of a lane, in inertial coordinates, and its clock.
  virtual void take(std::size_t lane, ParticleSystem<double>& s) const = 0;
  /// Keeps a state that `go_back()` returns to.
  virtual void keep() = 0;
  virtual void go_back() = 0;
};

}  // namespace noether
