#pragma once
/// Frequencies of small oscillations: extremal eigenvalues of M^-1 U'' by products with it, and of Jacobians.

#include "integrators/vector_field.hpp"
#include "scene/scene.hpp"

#include <complex>
#include <functional>
#include <vector>

namespace noether {

/// What the linear part of the forces says of a state.
struct Spectrum {
  double fastest = 0;   ///< omega of the fastest oscillation: sqrt of the largest eigenvalue of M^-1 U'' [1/time]
  double steepest = 0;  ///< rate of the fastest motion away: sqrt of minus the least eigenvalue, if below 0 [1/time]
  std::complex<double> stiffest = 0;  ///< of a first-order system: the eigenvalue of df/dy largest in modulus [1/time]
  int products = 0;                   ///< with the Hessian, or df/dy
  bool converged = true;              ///< to 1e-9 of the largest

  /// 2 pi / fastest; 0 where nothing oscillates [time].
  double shortest_period() const;
};

/// A symmetric operator: out = A in, both of shape (n).
using Operator = std::function<void(const Vector<double>& in, Vector<double>& out)>;

/// Least and largest eigenvalue of a symmetric operator of `n` rows.
///
/// Lanczos with every vector kept orthogonal to all before; ends when both have residuals below `tolerance` of the
/// larger, or after `most` products.
/// @cost one product for each vector, and O(n k) for the k-th
/// @source Lanczos1950
struct Extremes {
  double least = 0, largest = 0;
  int products = 0;
  bool converged = false;
};
Extremes lanczos(const Operator& A, Index n, double tolerance = 1e-9, int most = 200);

/// The product of the Hessian with a displacement, mass-weighted: out = M^-1/2 U'' M^-1/2 in, by `derivative` where the
/// field has it, else by central differences. Tracers do not pull, so they stay out: their rows are 0.
/// @param f  of second order, bound; must outlive the operator
/// @param in  shape (3 n), all x before all y before all z
Operator weighted_hessian(VectorField<double>& f, double t, const Vector<double>& y, const std::vector<double>& masses);

/// The spectrum of a scene in one state. Constraints are passed over: frequencies are those of the free particles.
/// @throws Error  where forces or rates are not finite
/// @cost for up to 64 particles (400 variables of a system) a product for each coordinate, beyond that Lanczos
Spectrum spectrum_at(const Scene& scene, const ParticleSystem<double>& s);

/// The spectrum of a scene on its way: of 64 states of a run by `dop853` over the scene's own length, at most 1000 of
/// its steps, the fastest oscillation counts. A scene of rigid bodies, which `dop853` does not turn, runs by its own
/// method: forces on places change as bodies turn. Of a linear scene, or one that this cannot run, the start alone.
/// @cost one second of wall time at most, and 64 spectra
Spectrum spectrum_along(const Scene& scene);

/// The rate of the drag a = -rate v among the forces of a scene [1/time]; 0 where there is none.
double drag_of(const Scene& scene);

/// Whether accelerations (or rates) change linearly with the state: then every growth is that of a mode.
bool is_linear(const Scene& scene);

}  // namespace noether
