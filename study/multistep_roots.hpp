#pragma once
/// Multistep methods on one mode: the roots of their characteristic polynomials.

#include "integrators/methods/adams.hpp"
#include "study/candidate.hpp"
#include "study/mode.hpp"

#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace noether {

/// What one step multiplies the solutions of a multistep method by, on each of the mode's own directions, by z.
struct MultistepRoots {
  using Roots = std::vector<std::complex<double>>;

  std::vector<std::complex<double>> exact;  ///< lambda / scale of each direction
  std::function<Roots(std::size_t direction, double z)> roots;
  /// The z from which on fixed-point iteration does not solve a step in `adams_iterations`: each contracts by z w_0,
  /// where w_0 is the weight of the new rate.
  std::optional<double> solver;

  /// Largest modulus of a root, less 1.
  double growth(double z) const;
  /// Relative error of frequency and damping of the roots nearest to the mode's own, the worst direction's.
  double error(double z) const;
};

/// Those of a formula of Adams, and of Stoermer's in summed form, on q'' = - omega^2 q.
/// @source HairerNoersettWanner1993 III.1, III.10
MultistepRoots adams_roots(AdamsKind kind, int order, const Mode& mode);
MultistepRoots stoermer_roots(int order);

/// Those of an candidate with steps of one length.
/// @return empty for methods of one step, and where no polynomial is known: Stoermer and Cowell's with drag
/// @source HairerNoersettWanner1993 III.3, HairerWanner1996 V.1
std::optional<MultistepRoots> multistep_roots(const Scene& scene, const Candidate& who, const Mode& mode);

}  // namespace noether
