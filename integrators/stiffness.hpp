#pragma once
/// How stiff a system is: what its fastest decay costs an explicit method.

#include "integrators/vector_field.hpp"

#include <complex>
#include <string>
#include <vector>

namespace noether {

/// What the eigenvalues of J = df/dy at one point say of a run of length T from there.
///
///     S = max |Re lambda| T
///
/// An explicit method has to take about S / 3 steps, whatever its tolerance. Eigenvalues belong to one point: kinetics
/// may become stiffer on their way, which `stiffness_along` sees.
/// @source HairerWanner1996
struct Stiffness {
  double ratio = 0;    ///< S [1]; NaN where the run has no end
  double fastest = 0;  ///< max |Re lambda| [1/time]
  double slowest = 0;  ///< min |Re lambda| of those other than 0; 0 where there is none [1/time]
  double growth = 0;   ///< max Re lambda, where above 0 [1/time]
  double turning = 0;  ///< max |Im lambda| [1/time]

  /// max |Re lambda| / min |Re lambda| [1]; 0 where every Re lambda is 0.
  double spread() const { return slowest > 0 ? fastest / slowest : 0; }
  /// In words: "stiff: S = 2.1e+09; an explicit method needs about 7.1e+08 steps; use rodas_5p or bdf".
  std::string verdict() const;
};

/// What given eigenvalues say of a run of length `length` [time], which may be infinite.
Stiffness stiffness_of(const std::vector<std::complex<double>>& eigenvalues, double length);

/// Largest system whose eigenvalues are worked out.
inline constexpr Index most_eigenvalues = 400;

/// Eigenvalues of the Jacobian of `f` at (t, y): its own, or by central differences.
/// @throws Error  for a system of more than `most_eigenvalues` variables, or a Jacobian that is not finite
/// @cost 2 n evaluations and O(n^3)
std::vector<std::complex<double>> eigenvalues_of(VectorField<double>& f, double t, const Vector<double>& y);

/// How stiff a run is, from eigenvalues at several places of it.
struct StiffnessAlong {
  /// Rates are means over the time that was seen, `slowest` the least; S is the integral of max |Re lambda|, taken on
  /// to the end where only a part was seen.
  Stiffness mean = {};
  double fastest = 0;  ///< largest |Re lambda| on the way [1/time]
  double at = 0;       ///< where it was [time]
  double reached = 0;  ///< the time up to which eigenvalues were looked at [time]
  int places = 0;      ///< at which they were
};

/// Follows a run from y at time `begin` over `length` [time], below 0 backward, by `rodas_5p` with rtol 1e-4 and takes
/// eigenvalues at up to 64 places, fewer of large systems. A run of too many steps, or that fails, is seen in part.
/// @throws Error  as `eigenvalues_of`
/// @cost at most some 2000 steps, for large systems O(n^3) 50 times
StiffnessAlong stiffness_along(VectorField<double>& f, const Vector<double>& start, double length, double begin = 0);

}  // namespace noether
