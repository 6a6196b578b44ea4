#pragma once
/// What schemes do over the turns of rigid bodies, measured.

#include "integrators/free_rotor.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// A scheme over turns and kicks of a heavy top, or a method on its group.
struct MeasuredTurns {
  std::string method;
  std::optional<Rotor> rotor = {};  ///< none: exponentials, by a method on the group
  int claimed_order = 0;            ///< over that rotor
  double order = 0;                 ///< slope of the errors of the orientation between steps of 1/16 and 1/32
  double kicks = 0;                 ///< evaluations of the torque a step
  double error = 0;  ///< of the orientation, largest entry of its matrix, at t = 2 with about 60 kicks a time unit

  /// How the top turns: the name of the rotor, or exponential.
  std::string_view turns() const;
};

/// Every scheme that turns a top of three different moments with its weight off all axes (I = (2, 1, 2/3), m g = 1,
/// centre at (0.2, 0.3, 0.5), spin (0.6, -0.4, 0.9)), in 113 bits, by exact turns and, where it can, axis by axis; the
/// variational scheme by its own; every method on groups.
/// @cost half a minute
std::vector<MeasuredTurns> measured_turns();

/// Its part of docs/methods.md.
std::string turning_section(const std::vector<MeasuredTurns>& measured);

}  // namespace noether
