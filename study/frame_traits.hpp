#pragma once
/// What methods on groups do on Y' = A(t) Y, measured.

#include "integrators/method.hpp"

#include <string>
#include <vector>

namespace noether {

/// A method on groups over a frame that is driven round.
struct MeasuredFrames {
  std::string method, use;
  int claimed_order = 0, claimed_evaluations = 0;
  double order = 0;         ///< slope of the errors of Y between steps of 1/16 and 1/32
  int evaluations = 0;      ///< of A, counted in a step of this run
  GroupWork work = {};      ///< of a step, counted by an algebra that counts
  bool reversible = false;  ///< a step of -h undoes one of h, to rounding
  double defect = 0;        ///< |Y^T Y - 1| after some steps
  double error = 0;         ///< of Y, its largest entry, at t = 2 with about 48 evaluations a time unit

  /// The cells in which measurement and claim differ, in words.
  std::vector<std::string> differences() const;
};

/// Every method on groups with steps of one length over `turning_frame` (Y' = hat(a) Y, a = (cos 2t, sin 2t, 1/2), Y(0)
/// = 1), in 113 bits, against the closed solution: those for Y' = A(t) Y alone first.
std::vector<MeasuredFrames> measured_frames();

/// Its part of docs/methods.md.
std::string frames_section(const std::vector<MeasuredFrames>& measured);

}  // namespace noether
