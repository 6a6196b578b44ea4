#pragma once
/// df/dy of a vector field, and the linear systems that implicit methods solve with it.

#include "engine/saved_state.hpp"
#include "integrators/vector_field.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace noether {

/// The sparse factors of one matrix; a copy has none and makes its own.
template <class Real> class SparseFactors {
 public:
  SparseFactors();
  SparseFactors(const SparseFactors& /*other*/) : SparseFactors() {}
  SparseFactors& operator=(const SparseFactors& other);
  SparseFactors(SparseFactors&&) noexcept;
  SparseFactors& operator=(SparseFactors&&) noexcept;
  ~SparseFactors();

  /// @return whether the matrix is regular
  bool compute(const Eigen::SparseMatrix<Real>& matrix);
  bool ready() const { return solver_ != nullptr; }
  void solve(const Vector<Real>& right, Vector<Real>& x) const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

/// J = df/dy at one point, and the LU factors of a I - b J.
///
/// J is exact, by dual numbers, where the field has derivatives, else by central differences. Where the field says
/// which elements can be other than 0, columns that share no row are found together (Curtis, Powell and Reid), and the
/// factors are sparse. For particles, J = [0 1; A B], and systems of half the size are solved:
///
///     (a^2 I - a b B - b^2 A) v = a s + b A r,   x = (r + b v) / a        from a x - b v = r, a v - b (A x + B v) = s
///
/// @cost one derivative, or two evaluations, for each column, or for each group of columns; LU: n^3 / 3, n that of the
///       smaller system; of a tridiagonal matrix O(n)
/// @source CurtisPowellReid1974
template <class Real> class Jacobian {
 public:
  void bind(const VectorField<Real>& f);
  /// Finds J at (t, y), counted as one Jacobian.
  void evaluate(VectorField<Real>& f, const Real& t, const Vector<Real>& y);
  /// out = df/dt at (t, y); `h` is the length over which f may change [time].
  void time_derivative(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, Vector<Real>& out);

  /// Factors of a I - b J. @return whether the matrix is regular
  bool factorize(const Real& a, const Real& b);
  /// x <- (a I - b J)^-1 x
  void solve(Vector<Real>& x);

  /// For second order, J = [0 1; A B]: factors of a I - b B - c A, shape (size / 2). @return whether it is regular
  bool factorize_half(const Real& a, const Real& b, const Real& c);
  /// x <- (a I - b B - c A)^-1 x, shape (size / 2)
  void solve_half(Vector<Real>& x);

  bool sparse() const { return sparse_; }
  /// Element of J.
  Real operator()(Index i, Index j) const {
    if (sparse_) return entries_.coeff(i, j);
    return J_(i, j);
  }

  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  void bind_sparse();
  void store(std::size_t group, const Vector<Real>& column);
  double increment(const Vector<Real>& y, Index j) const;
  void differences(VectorField<Real>& f, const Real& t, const Vector<Real>& y, std::size_t group);
  bool compute();

  Index size_ = 0;
  bool sparse_ = false, second_order_ = false, time_dependent_ = true;
  std::vector<std::vector<Index>> groups_;  ///< columns that share no row
  Sparsity pattern_;                        ///< rows of each column, the diagonal among them
  Matrix<Real> J_;
  Eigen::SparseMatrix<Real> entries_, matrix_;
  Matrix<Real> dense_;
  Eigen::PartialPivLU<Matrix<Real>> factors_;
  SparseFactors<Real> sparse_factors_;
  Real a_ = Real(0), b_ = Real(0);           ///< of the present factors
  std::array<Real, 3> weights_{};            ///< of I, J or B, and A in the matrix they are factors of
  bool factorized_ = false, ready_ = false;  ///< factors are asked for; and are there
  Vector<Real> up_, down_, direction_, half_;
};

extern template class SparseFactors<double>;
extern template class SparseFactors<Quad>;
extern template class Jacobian<double>;
extern template class Jacobian<Quad>;

}  // namespace noether
