#pragma once
/// A step of particles under one mean force from its beginning to its end.

#include "integrators/method.hpp"
#include "integrators/methods/continued_root.hpp"

namespace noether {

/// Accelerations between two states.
template <class Real> class MeanForce {
 public:
  virtual ~MeanForce() = default;
  /// Accelerations a, shape (size / 2), between the positions of y0 and y1, y = (q, v), the same for both directions.
  virtual void between(const Vector<Real>& y0, const Vector<Real>& y1, Vector<Real>& a) = 0;
  /// da/dq1, where its elements are known, with some on the diagonal; it serves until it is asked for again.
  virtual const Eigen::SparseMatrix<Real>& tangent(const Vector<Real>& /*y0*/, const Vector<Real>& /*y1*/) {
    throw LogicError("a tangent was requested from a mean force that has none");
  }
};

/// Solves for u, half of what the velocities change by:
///
///     u = (h/2) a(q, q1),   q1 = q + h (v + u),   v1 = v + 2 u
///
/// The kinetic energy changes by the work m a . (q1 - q), so the whole energy is kept if that is what the potential
/// loses; momentum and angular momentum are if a has neither a sum nor a torque about the middle (q + q1)/2. Symmetric
/// and of order 2 if a is.
///
/// The q1 that is found is rounded, by e, and where forces K q are stiff a differs by K e from what u was found with:
/// the energy would change by K e . (q1 - q) in every step. So the velocities are changed by some units of rounding,
/// until the kinetic energy has changed by the work of a between the places as they are: along what is left of v1
/// without the translation and the rotation whose momenta are kept, so that these stay (docs/theory/secants.md). Steps
/// that sweeps find are not stiff, and go without.
/// @cost as `ContinuedRoot`, and one evaluation where that has needed a matrix
/// @source Gonzalez1996
template <class Real> class MeanForceStep {
 public:
  /// @throws SchemeMismatch  see `ContinuedRoot`
  void bind(const VectorField<Real>& f, std::optional<JacobianForm> form,
            TangentPattern tangent = TangentPattern::none);
  /// y becomes the state a step of h later. @return nothing, or why there is none
  std::optional<Failure> make(MeanForce<Real>& force, Vector<Real>& y, double h, Evaluations& count);

 private:
  void balance(MeanForce<Real>& force, const Vector<Real>& y);
  void take_rigid_motion_out();

  ContinuedRoot<Real> root_;
  Index particles_ = 0;  ///< 0: the coordinates are none of particles
  bool keeps_momentum_ = false, keeps_angular_momentum_ = false;
  Vector<Real> masses_;  ///< of the coordinates
  Vector<Real> u_, end_, a_, way_;
};

extern template class MeanForceStep<double>;
extern template class MeanForceStep<Quad>;

}  // namespace noether
