#pragma once
/// How long the motion of a scene can be told: how fast small differences grow.

#include "scene/scene.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace noether {

/// What rounding in double precision alone does to a position, relative.
inline constexpr double one_rounding = 2.2e-16;

/// How a small difference of the start grows along a run: as some power of time where the motion is regular,
/// exponentially where it is chaotic, as in every liquid.
struct Predictability {
  std::vector<double> times = {};   ///< from the start on [time]
  std::vector<double> growth = {};  ///< the largest difference so far, over that at the start
  std::vector<double> moment = {};  ///< the difference at the time itself, over that at the start
  bool chaotic = false;
  bool judged = true;  ///< whether it was followed to the end, or until differences had grown a thousandfold
  double rate = 0;     ///< of its logarithm, where it is chaotic: the largest Lyapunov exponent, roughly [1/time]
  /// Of its growth, so many the rate was fitted over; 0 where they were too few, and the rate is that of the last half.
  double e_foldings = 0;
  double evaluations = 0;  ///< of forces that following it took
  /// The step of the scene, where the growth was that of an unstable step and not of the motion; 0 else [time].
  double unstable_step = 0;

  /// How many times a difference has grown after a time; beyond what was followed by the rate, or as its square.
  double factor(double time) const;
  /// What rounding alone comes to.
  double rounding(double time) const { return one_rounding * factor(time); }
  /// When a difference has grown so many times [time]; infinity where the motion is regular.
  double time_of(double factor) const;
  /// In which time a difference grows tenfold [time]. @pre chaotic
  double tenfold() const;
};

/// Follows two runs that begin 1e-10 apart, relative, by the scene's own method where it has fixed steps, else by
/// dop853; until they are 1e-3 apart. Where they part by more than 2 % a step, shorter steps tell whether the motion
/// does so, or the step is unstable. Empty where they cannot be made, or nothing can be moved.
/// @param end  from the start on [time]
/// @param budget  seconds of wall time
/// @param most  evaluations of forces by both runs together, beyond which they end
/// @param tell  is told how far it is, from 0 to 1
/// @param spent  is increased by the evaluations that this takes, whether or not anything is found
/// @cost two runs of the scene, or less; where they part so fast, twice that with each halving of the step, within the
/// same budget
std::optional<Predictability> predictability(const Scene& scene, double end, double budget,
                                             double most = std::numeric_limits<double>::infinity(),
                                             const std::function<void(double)>& tell = {}, double* spent = nullptr);

}  // namespace noether
