#pragma once
/// Linear drag: a part of its own, the letter `D` of a damped Hamiltonian (integrators/damped.hpp).

#include "engine/description.hpp"

namespace noether {

/// Friction proportional to velocity; its flow v -> exp(-rate h) v is exact and dissipative.
///
///     a = - rate v
struct LinearDrag {
  double rate = 0.0;  ///< [1/time]

  static constexpr auto describe() {
    return part<LinearDrag>("linear_drag", "friction proportional to velocity: the dissipative letter D",
                            formula("a = - rate v;  flow D: v -> exp(-rate h) v"),
                            field<&LinearDrag::rate>("rate", "1/time").required("\"0.01/day\""));
  }

  /// @throws Error  for a negative rate
  void check() const {
    if (!(rate >= 0)) refuse_field("rate", rate, "drives instead of damping; 0 or more is expected");
  }
};

}  // namespace noether
