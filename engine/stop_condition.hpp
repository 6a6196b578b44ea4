#pragma once
/// Conditions that end a run: escape and collision.

#include "engine/snapshot.hpp"

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
  double time = 0;  ///< when it happened, by the interpolated motion [time]
  std::string message;
};

/// One rule at work. Between two looks the motion is the quintic Hermite polynomial of the two settled states, so an
/// approach is found even if it was over at the second look; its time is told, the state stays at the last whole step.
template <class Real> class StopCheck {
 public:
  explicit StopCheck(const StopRule& rule);

  /// @cost escape O(n); collision O(n m) with m massive bodies, and one force evaluation
  std::optional<StopReason> look(const Snapshot<Real>& snapshot);

  /// The particles have been changed by hand: no motion leads from the last look to the next one.
  void forget() {
    x_.clear();
    v_.clear();
    a_.clear();
  }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  std::optional<StopReason> look_for_escape(const Snapshot<Real>& snapshot);
  std::optional<StopReason> look_for_collision(const Snapshot<Real>& snapshot);
  void remember(const Snapshot<Real>& snapshot);

  StopRule rule_;
  double last_time_ = 0;
  std::vector<Vec3<Real>> x_, v_, a_;  ///< at the last look
};

extern template class StopCheck<double>;
extern template class StopCheck<Quad>;

}  // namespace noether
