#pragma once
/// The solution itself, of a single body or an oscillator of first order: exact and by methods, steps and dampings to
/// choose from.

#include "study/compare.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether {

/// One precomputed run of the display.
struct DisplayedRun {
  std::size_t method = 0, step = 0, damping = 0;  ///< positions in the lists of `Solution`
  std::string outcome = {};
  bool refused = false;                   ///< the method takes no such damping; `outcome` says why
  std::vector<double> t = {}, q = {};     ///< [time], [length]
  std::vector<double> energy_error = {};  ///< relative, signed; empty where there is none
};

/// The exact motion with one damping.
struct ExactMotion {
  std::vector<double> t = {}, q = {};
};

/// What the sliders of a report choose from.
struct Solution {
  std::vector<std::string> methods = {};
  std::vector<double> steps = {};     ///< [time]
  std::vector<double> dampings = {};  ///< [1/time]; one, 0, where nothing says that the motion is an oscillator's
  std::size_t own_damping = 0;        ///< that of the scene, a position in `dampings`
  double omega = 0;                   ///< of the motion, rms acceleration over rms displacement, square root [1/time]
  char coordinate = 'x';
  std::vector<ExactMotion> exact = {};  ///< by damping
  std::vector<DisplayedRun> runs = {};
};

/// The display of a scene with one body, or with a system of two variables x' = v, v' = a(t, x, v); empty where it has
/// more, or no truth.
/// @cost about 300 short runs
std::optional<Solution> solution_of(const Scene& scene, const Comparison& comparison);

}  // namespace noether
