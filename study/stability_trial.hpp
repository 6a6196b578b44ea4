#pragma once
/// One run of many steps, and whether it stayed bounded.

#include "engine/simulation.hpp"
#include "study/amplitude.hpp"
#include "study/candidate.hpp"
#include "study/mode.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace noether {

/// How one run of many steps ended.
enum class Bounded : std::uint8_t {
  bounded,
  unbounded,
  solver,    ///< an implicit step or a constraint could not be solved
  unsettled  ///< the time was over before
};
std::string_view name(Bounded verdict);

/// What a run of many steps at one step length showed.
struct Trial {
  Bounded verdict = Bounded::bounded;
  std::int64_t steps = 0;  ///< made
  double largest = 1;      ///< amplitude over that of the start
  double growth = 0;       ///< of the amplitude in one step, by least squares through the largest of 20 blocks
  double growth_error = 0;
  std::string message = {};  ///< how it failed, in words

  bool stable() const { return verdict == Bounded::bounded; }
};

/// Where amplitudes are lost.
struct Bounds {
  double frequency = 1;  ///< weighs positions against velocities [1/time]
  bool linear = false;   ///< then growth by `growth_threshold` a step counts too, but for symplectic methods
  double most = 1e3;     ///< times the amplitude of the start
  /// Runs of fixed steps are judged up to here, where the solution itself begins to leave all bounds [time].
  double until = std::numeric_limits<double>::infinity();
};

/// How far a run goes: so many steps, or, where the method chooses them, so long [time].
struct RunLength {
  static constexpr int looks = 1000;  ///< at which the state is measured, evenly

  std::int64_t steps = 0;
  double until = 0;

  std::int64_t between_looks() const { return std::max<std::int64_t>(1, steps / looks); }
};

/// Follows a run to its end, or until its amplitude has left all bounds: see `try_step`.
/// @param look  called at every look
Trial follow(Simulation<double>& sim, const RunLength& length, const Amplitude& amplitude, const Bounds& bounds,
             double budget, const std::function<void(Simulation<double>&)>& look = {});

/// The growth in one step that a run of so many steps on a linear problem can tell: 0.01 % of the energy over the run,
/// and no less than `growth_threshold`.
inline double told_growth(std::int64_t steps) { return std::max(growth_threshold, 5e-5 / static_cast<double>(steps)); }

/// Runs a scene by a method for so many steps, or until its amplitude has left all bounds.
///
/// With A as `Amplitude` tells it, a run is unbounded when it leaves the finite numbers, when A passes `most` times
/// what it was, or, on a linear problem, when A surely (by three standard errors) grows by more than `growth_threshold`
/// a step, and by more than `told_growth`.
/// @param budget  seconds of wall time
Trial try_step(const Scene& scene, const Candidate& who, double step, std::int64_t steps, const Bounds& bounds,
               double budget);

}  // namespace noether
