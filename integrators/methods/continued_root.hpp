#pragma once
/// The root of an implicit step that continues the motion: the one that goes out from no step at all.

#include "integrators/method.hpp"
#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/methods/sparse_factors.hpp"

#include <optional>

namespace noether {

/// A matrix as a number times a sparse one.
template <class Real> struct ScaledMatrix {
  Real factor;
  const Eigen::SparseMatrix<Real>* matrix;  ///< with elements on the diagonal
};

/// The equations x = g(part, x) of a part of a step, 0 to 1 of its length.
template <class Real> class StepEquations {
 public:
  virtual ~StepEquations() = default;
  /// out = g(part, x); no numbers where it cannot be known.
  virtual void map(const Real& part, const Vector<Real>& x, Vector<Real>& out) = 0;
  /// How long an update is that led to x.
  virtual UpdateSize size_of(const Real& part, const Vector<Real>& update, const Vector<Real>& x) = 0;
  /// By how much components of x may change before g changes altogether.
  virtual Real reach(const Real& part, const Vector<Real>& x) const = 0;
  /// dg/dx at x, where its elements are known; it serves until it is asked for again.
  virtual ScaledMatrix<Real> tangent(const Real& /*part*/, const Vector<Real>& /*x*/) {
    throw LogicError("a tangent was requested from equations that have none");
  }
};

/// Solves x = g(1, x) by Newton's iteration to rounding, for the root that continues x of the beginning, g(0, x) = x.
///
/// An energy that is to be met exactly has more roots than one, and Newton's iteration may come to any of them. A root
/// is taken if the updates on the way to it shrink to a quarter or less, the first of them too: by Kantorovich's
/// theorem it is then the only one near the guess. Else the root is followed from a step of no length: half the step,
/// and so on, each root the guess of the next one, in parts as short as that condition wants them. Where parts become
/// shorter than 2^-12 of the step the root ends in a fold, and the step has a named outcome.
///
/// Sweeps x <- g(x) are tried first where there are many unknowns; steps that are not stiff need no more. I - dg/dx is
/// made of the tangent of the equations; without one it is found by differences of g in every direction, or,
/// matrix-free, in those that a Krylov method asks for. Its factors are sparse or dense.
/// @cost sweeps: 5 to 16 evaluations of g; else three to six matrices for a stiff step. Dense: n^3 / 3 for a matrix,
///       without a tangent 2 n evaluations beside; sparse: O(n) for chains, some n^2 for blocks; matrix-free: some
///       5 sqrt(condition) evaluations for each of four updates
/// @source OrtegaRheinboldt1970, AllgowerGeorg1990
template <class Real> class ContinuedRoot {
 public:
  /// @param form  default: sparse if the tangent is and there are more than 100 and at most 1500 unknowns; else dense
  /// up
  ///   to 300 unknowns, matrix-free beyond
  /// @throws SchemeMismatch  for a sparse one without a tangent
  void bind(Index unknowns, std::optional<JacobianForm> form, TangentPattern tangent = TangentPattern::none);
  /// x, the guess for no step at all, becomes the root. @param h  of the step, for messages [time]
  /// @return nothing, or why there is none
  std::optional<Failure> solve(StepEquations<Real>& equations, Vector<Real>& x, double h, Evaluations& count);
  /// Whether sweeps found the last root, as they do in steps that are not stiff.
  bool swept() const { return swept_; }

 private:
  enum class Found { yes, no, unsolved };
  bool sweep(StepEquations<Real>& equations, Vector<Real>& x);
  Found contract(StepEquations<Real>& equations, const Real& part, Vector<Real>& x, Evaluations& count);
  bool renew(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x);
  bool renew_dense(const ScaledMatrix<Real>& tangent);
  bool renew_sparse(const ScaledMatrix<Real>& tangent);
  bool renew_by_differences(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x);
  bool correct(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x);
  std::optional<Failure> follow(StepEquations<Real>& equations, Vector<Real>& x, double h, Evaluations& count);

  JacobianForm form_ = JacobianForm::dense;
  bool has_tangent_ = false;
  bool stiff_ = false;  ///< the matrix is far from the identity
  bool swept_ = false;
  DenseFactors<Real> factors_;
  Matrix<Real> matrix_;
  SparseFactors<Real> sparse_factors_;
  Eigen::SparseMatrix<Real> sparse_matrix_;
  Vector<Real> value_, residual_, update_, moved_, moved_value_, trial_, root_, before_;
};

extern template class ContinuedRoot<double>;
extern template class ContinuedRoot<Quad>;

}  // namespace noether
