#pragma once
/// What linear theory says of a method: its step on one mode as a matrix, where that grows, and where it resonates.

#include "study/candidate.hpp"
#include "study/mode.hpp"

#include <Eigen/Core>

#include <functional>
#include <map>
#include <optional>

namespace noether {

/// One step of a method on a mode, as a real matrix of shape (2, 2), by z = h omega (or h |lambda|).
///
/// Of a scheme, the product of its letters' matrices, in multiple time steps by what each kick has of the mode
/// (`kick_shares`); of a classical method, its own step from two unit vectors. A
/// multistep method remembers more than a state: it has no such matrix.
using StepMatrix = std::function<Eigen::Matrix2d(double z)>;
/// @return empty for a multistep method, for kicks of several letters of which the mode is not one of each, for a
/// splitting into Kepler arcs, which is exact on no such mode, and for a
///         method over a Lagrangian at a real rate that is none of damping
std::optional<StepMatrix> step_matrix(const Scene& scene, const Candidate& who, const Mode& mode);

/// Largest modulus of an eigenvalue of a step, less 1: the growth in one step. Growth below 1e-6 is told from rounding
/// only where eigenvalues are complex, as those of all methods are that are not symplectic.
double growth_of(const Eigen::Matrix2d& step);

/// What linear theory says.
struct LinearTheory {
  bool known = false;             ///< else nothing is said: no matrix, and no polynomial
  std::optional<double> limit;    ///< first z at which the growth is above the threshold; none: stable at any step
  std::optional<double> gap_end;  ///< where it is stable again, if it is
  double accurate = 0;            ///< largest z whose mode is as accurate as leapfrog's 20 steps a period; 0: unknown
  std::optional<double> solver;   ///< z from which on the method's own solver finds no step on the mode
  /// By n = 3, 4, 5, 6, along Kepler arcs from 1 on: the z at which the phase of a step is 2 pi / n, if stable.
  std::map<int, double> resonances;

  /// The n of the resonance next to z, within a tenth of it; 0 if none is.
  int resonance_at(double z) const;
};

/// Searches z upward by 2e-3, from 10 on by 2 %, up to 200; between, extremes of trace and determinant are sought, so
/// that gaps narrower than that are found too. Of a multistep method, where the roots of its characteristic polynomial
/// leave the unit circle (study/multistep_roots.hpp).
///
/// `accurate`: the largest z up to which |log(mu) / (lambda h) - 1| is below (pi/10)^2/24, the error of leapfrog with
/// 20 steps a period, where mu is the eigenvalue of the step.
/// @source HairerLubichWanner2006, MandziukSchlick1995
LinearTheory linear_theory(const Scene& scene, const Candidate& who, const Mode& mode);

/// Whether a method with a memory of its own, of which there is no matrix, finds no first step on a mode, at h omega =
/// z: the copies of Tao's method come apart at once.
bool first_step_fails(const Scene& scene, const Candidate& who, const Mode& mode, double z);

}  // namespace noether
