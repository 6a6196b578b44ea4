#include "integrators/methods/sparse_factors.hpp"

#include <Eigen/SparseLU>

namespace noether {

template <class Real> struct SparseFactors<Real>::Solver {
  Eigen::SparseLU<Eigen::SparseMatrix<Real>, Eigen::COLAMDOrdering<int>> lu;
};

template <class Real> SparseFactors<Real>::SparseFactors() = default;
template <class Real> SparseFactors<Real>::SparseFactors(SparseFactors&&) noexcept = default;
template <class Real> SparseFactors<Real>& SparseFactors<Real>::operator=(SparseFactors&&) noexcept = default;
template <class Real> SparseFactors<Real>::~SparseFactors() = default;
template <class Real> SparseFactors<Real>& SparseFactors<Real>::operator=(const SparseFactors& /*other*/) {
  solver_.reset();
  return *this;
}

template <class Real> bool SparseFactors<Real>::compute(const Eigen::SparseMatrix<Real>& matrix) {
  if (!solver_) {
    solver_ = std::make_unique<Solver>();
    solver_->lu.analyzePattern(matrix);
  }
  solver_->lu.factorize(matrix);
  return solver_->lu.info() == Eigen::Success;
}

template <class Real> void SparseFactors<Real>::solve(const Vector<Real>& right, Vector<Real>& x) const {
  x = solver_->lu.solve(right);
}

template class SparseFactors<double>;
template class SparseFactors<Quad>;

}  // namespace noether
