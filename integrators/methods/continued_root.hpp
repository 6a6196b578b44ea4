#pragma once
/// The root of an implicit step that continues the motion: the one that goes out from no step at all.

#include "integrators/method.hpp"
#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/newton.hpp"

#include <optional>

namespace noether {

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
};

/// Solves x = g(1, x) by Newton's iteration to rounding, for the root that continues x of the beginning, g(0, x) = x.
///
/// An energy that is to be met exactly has more roots than one, and Newton's iteration may come to any of them. A root
/// is taken if the updates on the way to it shrink to a quarter or less, the first of them too: by Kantorovich's
/// theorem it is then the only one near the guess. Else the root is followed from a step of no length: half the step,
/// and so on, each root the guess of the next one, in parts as short as that condition wants them. Where parts become
/// shorter than 2^-12 of the step the root ends in a fold, and the step has a named outcome.
///
/// I - dg/dx is found by differences of g in every direction, or, matrix-free, in those that a Krylov method asks for.
/// @cost dense: 2 n evaluations of g and n^3 / 3 for a matrix, three to six evaluations with it; matrix-free: some
///       5 sqrt(condition) evaluations for each of four updates
/// @source OrtegaRheinboldt1970, AllgowerGeorg1990
template <class Real> class ContinuedRoot {
 public:
  /// @param form  default: dense up to 300 unknowns, matrix-free beyond
  /// @throws SchemeMismatch  for a sparse one: zeros of the tangent are not declared
  void bind(Index unknowns, std::optional<JacobianForm> form);
  /// x, the guess for no step at all, becomes the root. @param h  of the step, for messages [time]
  /// @return nothing, or why there is none
  std::optional<Failure> solve(StepEquations<Real>& equations, Vector<Real>& x, double h, Evaluations& count);

 private:
  enum class Found { yes, no, unsolved };
  Found contract(StepEquations<Real>& equations, const Real& part, Vector<Real>& x, Evaluations& count);
  bool renew(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x);
  bool correct(StepEquations<Real>& equations, const Real& part, const Vector<Real>& x);
  std::optional<Failure> follow(StepEquations<Real>& equations, Vector<Real>& x, double h, Evaluations& count);

  bool matrix_free_ = false;
  bool stiff_ = false;  ///< the matrix is far from the identity
  DenseFactors<Real> factors_;
  Matrix<Real> matrix_;
  Vector<Real> value_, residual_, update_, moved_, moved_value_, trial_, root_, before_;
};

extern template class ContinuedRoot<double>;
extern template class ContinuedRoot<Quad>;

}  // namespace noether
