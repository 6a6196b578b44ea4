#pragma once
/// One mode of a linear problem, on which linear theory looks at methods.

#include "scene/scene.hpp"
#include "study/spectrum.hpp"

#include <complex>
#include <optional>

namespace noether {

/// Growth of an amplitude in one step from which a method counts as unstable, in theory and where it is measured on a
/// linear problem. Symplectic methods have no growth below their limits; Runge-Kutta and multistep methods may grow by
/// less from their first step on (Cash and Karp's by 1e-9 at h omega = 0.139), and limits are of a threshold.
inline constexpr double growth_threshold = 1e-9;

/// One mode of a linear problem: q'' = - omega^2 q - rate q', or y' = lambda y.
struct Mode {
  double omega = 0;                                 ///< of particles; 0: `lambda` counts [1/time]
  double rate = 0;                                  ///< of linear drag [1/time]
  std::optional<std::complex<double>> lambda = {};  ///< of a first-order system [1/time]

  /// What steps are multiplied with: omega, or |lambda| [1/time].
  double scale() const { return lambda ? std::abs(*lambda) : omega; }
};

/// The mode that bounds the steps of a scene: its fastest oscillation, or its stiffest rate.
Mode mode_of(const Scene& scene, const Spectrum& spectrum);

/// Steps z of a search: upward by `z_step`, from 10 on by 2 %.
inline constexpr double z_step = 2e-3;
double next_z(double z);
inline constexpr double largest_z = 200;

}  // namespace noether
