#pragma once
/// df/dy of a vector field, and the linear systems that implicit methods solve with it.

#include "engine/saved_state.hpp"
#include "forces/secant_tangent.hpp"
#include "integrators/method.hpp"
#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/krylov.hpp"
#include "integrators/methods/sparse_factors.hpp"
#include "integrators/step_control.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// What a method wants of its Jacobian.
struct JacobianUse {
  /// Default: sparse where the field has a `sparsity`, or more than 300 coordinates and a sparse tangent; else dense.
  std::optional<JacobianForm> form = {};
  std::optional<Tolerance> tolerance = {};  ///< matrix-free: errors are measured by it; default: all components alike
  bool rounding = false;  ///< matrix-free: as accurate as rounding allows, where no iteration corrects what is left
};

/// J = df/dy at one point, and systems with a I - b J.
///
/// J is exact, by dual numbers, where the field has derivatives, else by central differences. Where the field says
/// which elements can be other than 0, columns that share no row are found together (Curtis, Powell and Reid), and the
/// factors are sparse. For particles, J = [0 1; A B], and systems of half the size are solved:
///
///     (a^2 I - a b B - b^2 A) v = a s + b A r,   x = (r + b v) / a        from a x - b v = r, a v - b (A x + B v) = s
///
/// Where forces know the derivatives of their secants, A may be sparse: it is twice that of the secants from a state to
/// itself, for these do not change where the two states change places.
///
/// Matrix-free, no element is found: the point is kept, and systems are solved with products J v, each of them one
/// derivative, counted as an evaluation, or two evaluations for each kind of variables.
/// @cost one derivative, or two evaluations, for each column, or for each group of columns; LU: n^3 / 3, n that of the
///       smaller system; of a tridiagonal matrix O(n). Matrix-free: memory O(n), see `solve_by_krylov`
/// @source CurtisPowellReid1974
template <class Real> class Jacobian {
 public:
  /// @throws SchemeMismatch  for a sparse form of a field that does not say where J can be other than 0
  void bind(const VectorField<Real>& f, const JacobianUse& use = {});
  /// Finds J at (t, y), counted as one Jacobian.
  void evaluate(VectorField<Real>& f, const Real& t, const Vector<Real>& y);
  /// out = df/dt at (t, y); `h` is the length over which f may change [time].
  void time_derivative(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, Vector<Real>& out);

  /// Factors of a I - b J. @return whether the matrix is regular
  bool factorize(const Real& a, const Real& b);
  /// x <- (a I - b J)^-1 x. @return whether it was found; with factors it is
  bool solve(VectorField<Real>& f, Vector<Real>& x);

  /// For second order, J = [0 1; A B]: factors of a I - b B - c A, shape (size / 2). @return whether it is regular
  bool factorize_half(const Real& a, const Real& b, const Real& c);
  /// x <- (a I - b B - c A)^-1 x, shape (size / 2). @return as `solve`
  bool solve_half(VectorField<Real>& f, Vector<Real>& x);

  /// Matrix-free: out = J v at the point that is kept; v and out may not be the same.
  void multiply(VectorField<Real>& f, const Vector<Real>& v, Vector<Real>& out);
  /// Error of such a product, relative to |J| |v|, beside rounding.
  static double product_error(const VectorField<Real>& f);

  JacobianForm form() const { return form_; }
  /// Element of J, if it is not matrix-free.
  Real operator()(Index i, Index j) const {
    if (!sparse()) return J_(i, j);
    if (!second_order_) return entries_.coeff(i, j);
    const Index n = size_ / 2;
    return i >= n && j < n ? entries_.coeff(i - n, j) : Real(i + n == j ? 1 : 0);
  }
  /// J where it is sparse, for second order A, with elements on the diagonal.
  const Eigen::SparseMatrix<Real>& elements() const { return entries_; }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  bool sparse() const { return form_ == JacobianForm::sparse; }
  bool matrix_free() const { return form_ == JacobianForm::matrix_free; }
  void bind_sparse();
  void save_pattern(SavedState& saved, const std::string& prefix) const;
  void load_pattern(const SavedState& saved, const std::string& prefix);
  bool compute_sparse();
  void bind_dense(const FieldClaims& claims);
  void store(std::size_t group, const Vector<Real>& column);
  double increment(const Vector<Real>& y, Index j) const;
  void differences(VectorField<Real>& f, const Real& t, const Vector<Real>& y, std::size_t group);
  bool compute();
  void set_scale();
  bool solve_matrix_free(VectorField<Real>& f, Vector<Real>& x);
  template <class Self> static auto kept(Self& self);

  Index size_ = 0;
  JacobianForm form_ = JacobianForm::dense;
  bool second_order_ = false, velocity_dependent_ = true, time_dependent_ = true;
  std::vector<std::vector<Index>> groups_;  ///< columns that share no row
  Sparsity pattern_;                        ///< rows of each column, the diagonal among them
  Matrix<Real> J_;
  Eigen::SparseMatrix<Real> entries_, matrix_;
  SecantTangent<Real> tangent_;
  Vector<Real> point_;   ///< matrix-free: y where J is meant
  Real time_ = Real(0);  ///< and t
  double residual_ = 0;  ///< of systems, relative to the right-hand side [1]
  std::optional<Tolerance> tolerance_;
  Vector<Real> scale_;  ///< of errors that are equally tolerable
  Matrix<Real> dense_;
  DenseFactors<Real> factors_;
  SparseFactors<Real> sparse_factors_;
  Real a_ = Real(0), b_ = Real(0);           ///< of the present factors
  std::array<Real, 3> weights_{};            ///< of I, J or B, and A in the matrix they are factors of
  bool factorized_ = false, ready_ = false;  ///< factors are asked for; and are there
  Vector<Real> up_, down_, direction_, half_, velocities_, late_, moved_, product_;
};

extern template class Jacobian<double>;
extern template class Jacobian<Quad>;

}  // namespace noether
