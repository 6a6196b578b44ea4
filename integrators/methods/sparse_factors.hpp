#pragma once
/// LU factors of sparse matrices; Eigen's solver is compiled once, here.

#include "integrators/vector_field.hpp"

#include <Eigen/SparseCore>

#include <memory>

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

extern template class SparseFactors<double>;
extern template class SparseFactors<Quad>;

}  // namespace noether
