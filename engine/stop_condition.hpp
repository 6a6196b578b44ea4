#pragma once
/// Conditions that end a run: escape and collision.

#include "engine/motion.hpp"
#include "engine/snapshot.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// A condition on distances that ends a run.
struct StopRule {
  enum class Kind : std::uint8_t {
    escape,     ///< a particle is farther than `distance` from the centre of mass
    collision,  ///< two particles, one of them massive, are nearer than `distance`
  };
  Kind kind = Kind::escape;
  double distance = 0;  ///< [length]
};

/// Stops when a particle is farther than `distance` [length] from the centre of mass.
inline StopRule farther_than(double distance) { return {StopRule::Kind::escape, distance}; }
/// Stops when two particles come nearer than `distance` [length].
inline StopRule closer_than(double distance) { return {StopRule::Kind::collision, distance}; }

/// What a condition found.
struct StopReason {
  Index particle = -1;
  double time = 0;  ///< since when, by the interpolated motion [time]
  std::string message;
};

/// One rule at work. Between two looks the motion is the quintic Hermite polynomial of the two settled states, so an
/// approach is found even if it was over at the second look. Where the looks are too far apart for that, the pericenter
/// of a pair that attracts each other tells (engine/kepler_passage.hpp); where it does not either, the pair is counted.
/// Of several events between two looks the first is told, with its least distance and the time since when the distance
/// was passed; the state stays at the last whole step.
template <class Real> class StopCheck {
 public:
  explicit StopCheck(const StopRule& rule);

  /// @cost one force evaluation, shared with the other looks of the step; escape O(n), collision O(n m), m massive
  std::optional<StopReason> look(const Snapshot<Real>& snapshot);

  /// The particles have been changed by hand: no motion leads from the last look to the next one.
  void forget() {
    x_.clear();
    v_.clear();
    a_.clear();
  }

  /// How often a pair may have met between two looks that were too far apart to tell.
  std::int64_t unresolved() const { return unresolved_; }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  struct Event {
    Index particle, other;  ///< other: -1 for an escape
    Real distance2;
    Real at;  ///< part of the time between the looks
  };
  std::optional<Event> escape(const Snapshot<Real>& now);
  std::optional<Event> collision(const Snapshot<Real>& now);
  Motion<Real> last_motion(Index i) const;
  void remember(const Snapshot<Real>& snapshot);

  StopRule rule_;
  double last_time_ = 0;
  std::vector<Vec3<Real>> x_, v_, a_;  ///< at the last look
  std::int64_t unresolved_ = 0;
  bool moved_ = false;  ///< whether a motion leads from the last look to this one
};

extern template class StopCheck<double>;
extern template class StopCheck<Quad>;

}  // namespace noether
