#pragma once
/// The linear systems of Newton's iteration over all stages of a collocation step at once.

#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/stage_arithmetic.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace noether {

/// Systems for what is to be added to the rates F_i, so that they are those of their own stages:
///
///     x_i - h sum_j a_ij J_i x_j = r_i                              for y' = f, J_i = df/dy
///     x_i - h sum_j (h (a a)_ij A_i + a_ij B_i) x_j = r_i           for q'' = a, A_i = da/dq, B_i = da/dv
///
/// The second form has half the unknowns; a method whose F_i are rates of both q and v asks for the first (`Rates`).
/// J_i is that of the beginning of the step for all stages, or that of each stage. A vector holds n variables of the
/// first stage, then those of the second. What the `Jacobian` is, dense, sparse or matrix-free, the system is too; by
/// default it is sparse where the field has a `sparsity`, else dense up to 1000 unknowns, matrix-free beyond.
/// @cost LU: (s n)^3 / 3; matrix-free: s products a product
/// @source HairerWanner1996
template <class Real> class StageSystem {
 public:
  enum class Rates : std::uint8_t { accelerations, all };

  /// @param a      of the stages, [j][i]: what stage i takes from stage j
  /// @param twice  a a
  /// @param rates  of second order: what F_i are
  /// @throws SchemeMismatch  for a sparse form of a field that does not say where J can be other than 0
  StageSystem(const VectorField<Real>& f, int stages, const StageMatrix<Real>& a, const StageMatrix<Real>& twice,
              std::optional<JacobianForm> form, Rates rates = Rates::accelerations);

  /// Rows of the matrix: s n.
  Index rows() const { return stages_ * n_; }

  /// Takes J at (t, y) for that of all stages, counted as one Jacobian.
  void evaluate(VectorField<Real>& f, const Real& t, const Vector<Real>& y);
  /// Takes J at (t, y) for that of one stage, of all of which it has to be known then, counted as one Jacobian.
  void evaluate_at(VectorField<Real>& f, int stage, const Real& t, const Vector<Real>& y);

  /// Factors for a step of h. @return whether the matrix is regular
  bool factorize(double h);
  /// x <- x of the system with r = x, shape (s n). @return whether it was found; with factors it is
  bool solve(VectorField<Real>& f, Vector<Real>& x);

 private:
  bool sparse() const { return jacobians_[0].form() == JacobianForm::sparse; }
  bool matrix_free() const { return jacobians_[0].form() == JacobianForm::matrix_free; }
  const Jacobian<Real>& at(int stage) const { return jacobians_[shared_ ? 0 : static_cast<std::size_t>(stage)]; }
  Real element(int to, int from, Index i, Index j) const;
  bool factorize_dense();
  bool factorize_sparse();
  void multiply(VectorField<Real>& f, const Vector<Real>& x, Vector<Real>& out);

  int stages_;
  Index n_;
  bool second_order_, velocity_dependent_;
  StageMatrix<Real> a_, twice_;
  Real h_ = Real(0);
  bool shared_ = true;                     ///< one J serves all stages
  std::vector<Jacobian<Real>> jacobians_;  ///< of each stage
  DenseFactors<Real> factors_;
  SparseFactors<Real> sparse_factors_;
  Eigen::SparseMatrix<Real> sparse_matrix_;
  Vector<Real> direction_, product_, solution_;
};

extern template class StageSystem<double>;
extern template class StageSystem<Quad>;

}  // namespace noether
