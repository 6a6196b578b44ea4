#include "integrators/methods/stage_system.hpp"

#include "integrators/methods/krylov.hpp"

#include <cmath>

namespace noether {

namespace {

/// Unknowns up to which a field without a `sparsity` has a dense system by default.
constexpr Index most_dense_rows = 1000;
/// Directions of a cycle of GMRES: shifts of several stages are complex, and eigenvalues of the system lie on all sides
/// of 0, where short cycles make no way.
constexpr Index cycle = 150;

}  // namespace

template <class Real>
StageSystem<Real>::StageSystem(const VectorField<Real>& f, int stages, const StageMatrix<Real>& a,
                               const StageMatrix<Real>& twice, std::optional<JacobianForm> form, Rates rates)
    : stages_(stages), a_(a), twice_(twice), jacobians_(1) {
  const FieldClaims claims = f.claims();
  second_order_ = claims.second_order && rates == Rates::accelerations;
  velocity_dependent_ = claims.velocity_dependent;
  n_ = second_order_ ? f.size() / 2 : f.size();
  const bool known = !second_order_ && !f.sparsity().empty();
  if (!form && !known && rows() > most_dense_rows) form = JacobianForm::matrix_free;
  jacobians_[0].bind(f, {.form = form});
  direction_.setZero(f.size());
}

template <class Real> void StageSystem<Real>::evaluate(VectorField<Real>& f, const Real& t, const Vector<Real>& y) {
  shared_ = true;
  jacobians_[0].evaluate(f, t, y);
}

template <class Real>
void StageSystem<Real>::evaluate_at(VectorField<Real>& f, int stage, const Real& t, const Vector<Real>& y) {
  shared_ = false;
  if (jacobians_.size() == 1) jacobians_.resize(static_cast<std::size_t>(stages_), jacobians_[0]);
  jacobians_[static_cast<std::size_t>(stage)].evaluate(f, t, y);
}

/// What variable i of stage `to` takes from variable j of stage `from`, of a dense J.
template <class Real> Real StageSystem<Real>::element(int to, int from, Index i, Index j) const {
  const auto into = static_cast<std::size_t>(to), out_of = static_cast<std::size_t>(from);
  const Jacobian<Real>& J = at(to);
  const Real once = h_ * a_[out_of][into];
  const Real one = Real(to == from && i == j ? 1 : 0);
  if (!second_order_) return one - once * J(i, j);
  const Real twice = h_ * h_ * twice_[out_of][into] * J(n_ + i, j);
  return one - (velocity_dependent_ ? twice + once * J(n_ + i, n_ + j) : twice);
}

template <class Real> bool StageSystem<Real>::factorize_dense() {
  Matrix<Real> matrix(rows(), rows());
  for (int from = 0; from < stages_; ++from) {
    for (Index j = 0; j < n_; ++j) {
      for (int to = 0; to < stages_; ++to) {
        for (Index i = 0; i < n_; ++i) matrix(to * n_ + i, from * n_ + j) = element(to, from, i, j);
      }
    }
  }
  return factors_.compute(matrix);
}

template <class Real> bool StageSystem<Real>::factorize_sparse() {
  std::vector<Eigen::Triplet<Real>> elements;
  for (int from = 0; from < stages_; ++from) {
    for (int to = 0; to < stages_; ++to) {
      const auto into = static_cast<std::size_t>(to), out_of = static_cast<std::size_t>(from);
      const Real weight = second_order_ ? h_ * h_ * twice_[out_of][into] : h_ * a_[out_of][into];
      const Eigen::SparseMatrix<Real>& J = at(to).elements();
      for (Index j = 0; j < n_; ++j) {
        for (typename Eigen::SparseMatrix<Real>::InnerIterator value(J, j); value; ++value) {
          const Real one(to == from && value.row() == j ? 1 : 0);
          elements.emplace_back(to * n_ + value.row(), from * n_ + j, one - weight * value.value());
        }
      }
    }
  }
  Eigen::SparseMatrix<Real> matrix(rows(), rows());
  matrix.setFromTriplets(elements.begin(), elements.end());
  if (!have_same_pattern(matrix, sparse_matrix_)) sparse_factors_.forget();
  sparse_matrix_ = std::move(matrix);
  return sparse_factors_.compute(sparse_matrix_);
}

template <class Real> bool StageSystem<Real>::factorize(double h) {
  h_ = Real(h);
  if (matrix_free()) return true;
  return sparse() ? factorize_sparse() : factorize_dense();
}

/// out = the matrix of the system times x.
template <class Real> void StageSystem<Real>::multiply(VectorField<Real>& f, const Vector<Real>& x, Vector<Real>& out) {
  out = x;
  for (int to = 0; to < stages_; ++to) {
    const auto into = static_cast<std::size_t>(to);
    direction_.setZero();
    for (int from = 0; from < stages_; ++from) {
      const auto out_of = static_cast<std::size_t>(from);
      const auto part = x.segment(from * n_, n_);
      if (second_order_) direction_.head(n_) += h_ * h_ * twice_[out_of][into] * part;
      if (!second_order_ || velocity_dependent_) direction_.tail(n_) += h_ * a_[out_of][into] * part;
    }
    jacobians_[shared_ ? 0 : into].multiply(f, direction_, product_);
    out.segment(to * n_, n_) -= product_.tail(n_);
  }
}

template <class Real> bool StageSystem<Real>::solve(VectorField<Real>& f, Vector<Real>& x) {
  bool found = true;
  if (matrix_free()) {
    const LinearMap<Real> map = [&](const Vector<Real>& v, Vector<Real>& out) { multiply(f, v, out); };
    found = solve_by_krylov(map, x, {.residual = 1e-8, .product = Jacobian<Real>::product_error(f), .cycle = cycle},
                            solution_);
  } else if (sparse()) {
    sparse_factors_.solve(x, solution_);
  } else {
    factors_.solve(x, solution_);
  }
  x.swap(solution_);
  return found;
}

template class StageSystem<double>;
template class StageSystem<Quad>;

}  // namespace noether
