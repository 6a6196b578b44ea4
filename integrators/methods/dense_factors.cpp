#include "integrators/methods/dense_factors.hpp"

#include <Eigen/LU>

#include <cmath>

namespace noether {

template <class Real> struct DenseFactors<Real>::Solver { Eigen::PartialPivLU<Matrix<Real>> lu; };

template <class Real> DenseFactors<Real>::DenseFactors() = default;
template <class Real>
DenseFactors<Real>::DenseFactors(const DenseFactors& other)
    : solver_(other.solver_ ? std::make_unique<Solver>(*other.solver_) : nullptr) {}
template <class Real> DenseFactors<Real>::DenseFactors(DenseFactors&&) noexcept = default;
template <class Real> DenseFactors<Real>& DenseFactors<Real>::operator=(const DenseFactors& other) {
  return *this = DenseFactors(other);
}
template <class Real> DenseFactors<Real>& DenseFactors<Real>::operator=(DenseFactors&&) noexcept = default;
template <class Real> DenseFactors<Real>::~DenseFactors() = default;

template <class Real> void DenseFactors<Real>::resize(Index n) {
  solver_ = std::make_unique<Solver>();
  solver_->lu = Eigen::PartialPivLU<Matrix<Real>>(n);
}

template <class Real> bool DenseFactors<Real>::compute(const Matrix<Real>& matrix) {
  using std::isfinite;
  if (!solver_) solver_ = std::make_unique<Solver>();
  solver_->lu.compute(matrix);
  bool regular = true;
  for (Index i = 0; i < matrix.rows(); ++i) {
    const Real& pivot = solver_->lu.matrixLU()(i, i);
    regular = regular && isfinite(pivot) && pivot != Real(0);
  }
  return regular;
}

template <class Real> void DenseFactors<Real>::solve(const Vector<Real>& right, Vector<Real>& x) const {
  x.noalias() = solver_->lu.solve(right);
}

template class DenseFactors<double>;
template class DenseFactors<Quad>;

}  // namespace noether
