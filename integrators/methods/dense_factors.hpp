#pragma once
/// LU factors of full matrices; Eigen's solver is compiled once, here.

#include "integrators/vector_field.hpp"

#include <memory>

namespace noether {

/// The factors of one matrix, with pivots by rows.
/// @cost n^3 / 3; no allocation for a size that has been met before
template <class Real> class DenseFactors {
 public:
  DenseFactors();
  DenseFactors(const DenseFactors& other);
  DenseFactors(DenseFactors&&) noexcept;
  DenseFactors& operator=(const DenseFactors& other);
  DenseFactors& operator=(DenseFactors&&) noexcept;
  ~DenseFactors();

  /// Makes room for a matrix of this size.
  void resize(Index n);
  /// @return whether the matrix is regular
  bool compute(const Matrix<Real>& matrix);
  /// x = M^-1 right; x may not be `right`.
  void solve(const Vector<Real>& right, Vector<Real>& x) const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

extern template class DenseFactors<double>;
extern template class DenseFactors<Quad>;

}  // namespace noether
