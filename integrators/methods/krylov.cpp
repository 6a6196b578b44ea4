#include "integrators/methods/krylov.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <unsupported/Eigen/IterativeSolvers>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether::detail {
template <class Real> class MatrixFree;
}

namespace Eigen::internal {
template <class Real> struct traits<noether::detail::MatrixFree<Real>> : traits<SparseMatrix<Real>> {};
}  // namespace Eigen::internal

namespace noether {

namespace detail {

/// A matrix as the solvers of Eigen see it: its size and products with it. It counts them, and keeps the largest of
/// |M v| / |v|, which bounds |M| from below.
template <class Real> class MatrixFree : public Eigen::EigenBase<MatrixFree<Real>> {
 public:
  using Scalar = Real;
  using RealScalar = Real;
  using StorageIndex = int;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  MatrixFree(const LinearMap<Real>& map, Index size) : map_(map), size_(size) {}

  Index rows() const { return size_; }
  Index cols() const { return size_; }
  template <class V> Vector<Real> operator*(const Eigen::MatrixBase<V>& v) const {
    const Vector<Real> from = v;
    Vector<Real> to(size_);
    map_(from, to);
    ++products_;
    const double length = static_cast<double>(from.norm());
    if (length > 0) norm_ = std::max(norm_, static_cast<double>(to.norm()) / length);
    return to;
  }
  Index products() const { return products_; }
  double norm() const { return norm_; }

 private:
  const LinearMap<Real>& map_;
  Index size_;
  mutable Index products_ = 0;
  mutable double norm_ = 0;
};

}  // namespace detail

template <class Real>
bool solve_by_krylov(const LinearMap<Real>& map, const Vector<Real>& b, const KrylovAccuracy& accuracy,
                     Vector<Real>& x) {
  using Matrix = detail::MatrixFree<Real>;
  constexpr Index most = 20000;
  const Index cycle = accuracy.cycle;
  const Index n = b.size();
  // Squares of what is small must not be lost.
  const Real scale = n > 0 ? b.cwiseAbs().maxCoeff() : Real(0);
  x.setZero(n);
  if (scale == Real(0)) return true;
  if (!std::isfinite(static_cast<double>(scale))) return false;
  const Matrix matrix(map, n);
  const Vector<Real> right = b / scale;
  Eigen::GMRES<Matrix, Eigen::IdentityPreconditioner> gmres(matrix);
  gmres.set_restart(std::min(cycle, n));
  Eigen::BiCGSTAB<Matrix, Eigen::IdentityPreconditioner> bicgstab(matrix);
  const double wanted = accuracy.residual * static_cast<double>(right.norm());
  const double rounding = 64 * std::max(static_cast<double>(std::numeric_limits<Real>::epsilon()), accuracy.product);
  Vector<Real> residual = right, step;
  double left = static_cast<double>(residual.norm());
  for (int pass = 0, idle = 0; idle < 2 && matrix.products() < most; ++pass) {
    if (pass % 2 == 0 || n <= cycle) {
      gmres.setMaxIterations(std::min(cycle, n)).setTolerance(Real(0.5 * wanted / left));
      step = gmres.solve(residual);
    } else {
      bicgstab.setMaxIterations((most - matrix.products()) / 2).setTolerance(Real(0.5 * wanted / left));
      step = bicgstab.solve(residual);
    }
    step += x;
    const Vector<Real> next = right - matrix * step;
    const double now = static_cast<double>(next.norm());
    idle = now < 0.5 * left ? 0 : idle + 1;
    if (now < left) {
      x = step;
      residual = next;
      left = now;
    }
    const bool lost = idle > 0 && left <= rounding * matrix.norm() * static_cast<double>(x.norm());
    if (left <= wanted || lost) {
      x *= scale;
      return true;
    }
  }
  return false;
}

template bool solve_by_krylov(const LinearMap<double>&, const Vector<double>&, const KrylovAccuracy&, Vector<double>&);
template bool solve_by_krylov(const LinearMap<Quad>&, const Vector<Quad>&, const KrylovAccuracy&, Vector<Quad>&);

}  // namespace noether
