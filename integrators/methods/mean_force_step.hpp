#pragma once
/// A step of particles under one mean force from its beginning to its end.

#include "integrators/method.hpp"
#include "integrators/methods/continued_root.hpp"

#include <functional>

namespace noether {

/// Accelerations between the positions of two states y = (q, v), the same for both directions; shape (size / 2).
template <class Real>
using MeanForce = std::function<void(const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a)>;

/// Solves for u, half of what the velocities change by:
///
///     u = (h/2) a(q, q1),   q1 = q + h (v + u),   v1 = v + 2 u
///
/// The kinetic energy changes by the work m a . (q1 - q), so the whole energy is kept if that is what the potential
/// loses; momentum and angular momentum are if a has neither a sum nor a torque about the middle (q + q1)/2. Symmetric
/// and of order 2 if a is.
/// @source Gonzalez1996
template <class Real> class MeanForceStep {
 public:
  /// @throws SchemeMismatch  see `ContinuedRoot`
  void bind(const VectorField<Real>& f, std::optional<JacobianForm> form);
  /// y becomes the state a step of h later. @return nothing, or why there is none
  std::optional<Failure> make(const MeanForce<Real>& force, Vector<Real>& y, double h, Evaluations& count);

 private:
  ContinuedRoot<Real> root_;
  Vector<Real> u_, end_;
};

extern template class MeanForceStep<double>;
extern template class MeanForceStep<Quad>;

}  // namespace noether
