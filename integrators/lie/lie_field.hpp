#pragma once
/// Fields on Lie groups: y is moved by exponentials, not along straight lines.

#include "integrators/vector_field.hpp"

namespace noether {

/// How far a start may be beside its group: |Y^T Y - 1| of matrices, |q|^2 - 1 of quaternions.
inline constexpr double farthest_from_group = 1e-9;

/// y' = A(t, y) y, where A is an element of a Lie algebra and y stands where its group acts: orientations of bodies,
/// places and orientations together, matrices of rotations; spins and speeds beside them move along straight lines.
///
/// With y(t + h) = exp(u) y(t), the element u is the solution of an equation on the algebra, where y can be left by no
/// rounding error of a step:
///
///     u' = A - [u, A]/2 + [u, [u, A]]/12 - ...,   u(t) = 0
///
/// As a vector field, in the numbers of y, it serves every method for y' = f that its system allows.
/// @source IserlesMuntheKaasNorsettZanna2000
template <class Real> class LieField : public VectorField<Real> {
 public:
  LieField<Real>* on_group() final { return this; }
  /// Refuses a state beside the group, where methods on it would not stay: it is asked by them alone.
  /// @throws Error
  virtual void check_start(const ParticleSystem<Real>& /*s*/) const {}

  /// Length of an element of the algebra.
  virtual Index algebra() const = 0;
  /// a = A(t, y), shape (algebra), counted.
  void velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) {
    ++this->evaluations().force;
    find_velocity(t, y, a);
  }
  /// out = exp(u) y; `out` is not y.
  virtual void act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) = 0;
  /// out = [u, v]; `out` is neither of them.
  virtual void bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) = 0;
  /// Whether A does not depend on y.
  virtual bool linear() const { return false; }
  /// What errors of each number of an element are measured by in a step of `h` from y to y1, shape (algebra); those of
  /// places and velocities of particles, the first six of each, have `scales`.
  virtual void sizes(const Vector<Real>& y, const Vector<Real>& y1, double h, Vector<double>& out) const = 0;

 protected:
  virtual void find_velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) = 0;
};

}  // namespace noether
