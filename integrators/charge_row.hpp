#pragma once
/// Charges in closed forms of fields: what the kernels in lanes work on.

#include <cstdint>

namespace noether {

/// Fields that have a closed form in +, -, *, / and square roots.
enum class LaneField : std::uint8_t { uniform, gradient, dipole, tokamak, penning };

/// One of them, with its numbers in the order of its fields.
struct LaneFieldNumbers {
  LaneField field = LaneField::uniform;
  double number[6] = {};
};

/// How kicks turn velocities, or proper velocities.
enum class LanePush : std::uint8_t { exact, cycles, relativistic_boris, vay, higuera_cary };

/// A drift or a kick of length h.
struct ChargeLetter {
  char letter = 'A';
  double h = 0;
};

}  // namespace noether
