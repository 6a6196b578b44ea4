#pragma once
/// Linear drag: a part of its own, the letter `D` of a damped Hamiltonian (integrators/damped.hpp).

#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/signature.hpp"

#include <string_view>

namespace noether {

/// Friction proportional to velocity; its flow v -> exp(-rate h) v is exact and dissipative.
///
///     a = - rate v
struct LinearDrag {
  double rate = 0.0;  ///< [1/time]

  static constexpr auto describe() {
    return part<LinearDrag>("linear_drag", "friction proportional to velocity: the dissipative letter D",
                            formula("a = - rate v;  flow D: v -> exp(-rate h) v"),
                            letter('D', "exact flow of the drag"),
                            field<&LinearDrag::rate>("rate", "1/time").required("\"0.01/day\""));
  }
  /// Why it does not stand twice in a scene.
  static constexpr std::string_view only_once = "combine them, with the sum of the rates";

  /// @throws Error  for a negative rate
  void check() const {
    if (!(rate >= 0)) refuse_field("rate", rate, "would drive the motion instead of damping it; 0 or more is expected");
  }
};

/// Linear drag as a force, for methods that take velocity-dependent forces.
///
///     a = - rate v
struct DragForce {
  LinearDrag drag;

  std::string name() const { return "linear_drag"; }
  std::string signature() const { return detail::signature_of(drag); }
  ForceClaims claims() const {
    return {.velocity_dependent = true,
            .dissipative = true,
            .keeps_momentum = drag.rate == 0,
            .keeps_angular_momentum = drag.rate == 0,
            .periodic = true,
            .charges = false,
            .exclusions = false,
            .drag = drag.rate};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    // Not by `acceleration`, which would enter it into the virial: friction is no part of the pressure.
    for (Index i = 0; i < s.size(); ++i) out.accelerations().add(i, -Real(drag.rate) * s.velocities()[i]);
  }
};

/// What methods that do not split take instead of the letter.
inline DragForce as_force(const LinearDrag& drag) { return {drag}; }

}  // namespace noether
