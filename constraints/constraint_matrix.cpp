#include "constraints/constraint_matrix.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <algorithm>
#include <map>
#include <utility>

namespace noether {

template <class Real> struct ConstraintMatrix<Real>::Sparse {
  using Matrix = Eigen::SparseMatrix<Real>;
  /// Of a matrix whose upper half stands in the right order already: no copy of it is made.
  struct Symmetric : Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> {
    void factorize_in_place(const Matrix& half) { this->template factorize_preordered<true>(half); }
    const Real& pivot(Index k) const { return this->m_diag[k]; }
  };

  Sparse(Matrix upper_half, Eigen::SparseMatrix<double> both_halves)
      : upper(std::move(upper_half)), full(std::move(both_halves)) {
    symmetric.analyzePattern(upper);
  }

  Matrix upper;
  Eigen::SparseMatrix<double> full;
  Symmetric symmetric;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>> mixed;
  bool mixed_is_analyzed = false;
};

template <class Real> ConstraintMatrix<Real>::ConstraintMatrix() = default;
template <class Real> ConstraintMatrix<Real>::ConstraintMatrix(ConstraintMatrix&&) noexcept = default;
template <class Real> ConstraintMatrix<Real>& ConstraintMatrix<Real>::operator=(ConstraintMatrix&&) noexcept = default;
template <class Real> ConstraintMatrix<Real>::~ConstraintMatrix() = default;
template <class Real>
ConstraintMatrix<Real>::ConstraintMatrix(const ConstraintMatrix& other)
    : place_(other.place_),
      first_term_(other.first_term_),
      terms_(other.terms_),
      upper_element_(other.upper_element_),
      full_element_(other.full_element_),
      full_transposed_(other.full_transposed_),
      diagonal_(other.diagonal_),
      rhs_(other.rhs_),
      solution_(other.solution_),
      mixed_rhs_(other.mixed_rhs_),
      mixed_solution_(other.mixed_solution_) {
  if (other.sparse_) sparse_ = std::make_unique<Sparse>(other.sparse_->upper, other.sparse_->full);
}
template <class Real> ConstraintMatrix<Real>& ConstraintMatrix<Real>::operator=(const ConstraintMatrix& other) {
  return *this = ConstraintMatrix(other);
}

template <class Real> void ConstraintMatrix<Real>::lay_out(const ConstraintLayout<Real>& layout) {
  const Index n = layout.equations();
  // Who ties a particle: entries of the same particle couple their equations.
  std::map<Index, std::vector<std::pair<Index, std::size_t>>> ties;
  for (Index e = 0; e < n; ++e) {
    for (Index a = layout.first[static_cast<std::size_t>(e)]; a < layout.first[static_cast<std::size_t>(e) + 1]; ++a) {
      ties[layout.particle[static_cast<std::size_t>(a)]].emplace_back(e, static_cast<std::size_t>(a));
    }
  }
  std::vector<Eigen::Triplet<char, int>> coupled;
  for (const auto& [particle, tied] : ties) {
    for (const auto& one : tied) {
      for (const auto& other : tied)
        coupled.emplace_back(static_cast<int>(one.first), static_cast<int>(other.first), char(1));
    }
  }
  Eigen::SparseMatrix<char> pattern(n, n);
  pattern.setFromTriplets(coupled.begin(), coupled.end(), [](char, char) { return char(1); });
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  place_.resize(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) place_[static_cast<std::size_t>(order.indices()[k])] = static_cast<int>(k);

  // Terms of each element of the upper half, in the order of particles.
  std::map<std::pair<int, int>, std::vector<Term>> elements;  // by column, then row
  for (const auto& [particle, tied] : ties) {
    for (const auto& [one, a] : tied) {
      for (const auto& [other, b] : tied) {
        const int row = place_[static_cast<std::size_t>(one)], column = place_[static_cast<std::size_t>(other)];
        if (row <= column) elements[{column, row}].push_back({a, b, layout.inverse_mass[a]});
      }
    }
  }
  terms_.clear();
  first_term_.assign(1, 0);
  upper_element_.clear();
  std::vector<Eigen::Triplet<Real, int>> upper;
  std::vector<Eigen::Triplet<double, int>> full;
  for (const auto& [at, terms] : elements) {
    const auto [column, row] = at;
    const auto element = static_cast<double>(first_term_.size() - 1);
    terms_.insert(terms_.end(), terms.begin(), terms.end());
    first_term_.push_back(terms_.size());
    upper.emplace_back(row, column, Real(element));
    full.emplace_back(row, column, element);
    if (row != column) full.emplace_back(column, row, -element - 1);  // below 0: transposed
  }
  typename Sparse::Matrix upper_half(n, n);
  Eigen::SparseMatrix<double> both_halves(n, n);
  upper_half.setFromTriplets(upper.begin(), upper.end());
  both_halves.setFromTriplets(full.begin(), full.end());
  // The numbers that were put in tell where they have come to stand.
  upper_element_.resize(static_cast<std::size_t>(upper_half.nonZeros()));
  for (std::size_t k = 0; k < upper_element_.size(); ++k) {
    upper_element_[k] = static_cast<std::size_t>(static_cast<double>(upper_half.valuePtr()[k]));
  }
  full_element_.resize(static_cast<std::size_t>(both_halves.nonZeros()));
  full_transposed_.resize(full_element_.size());
  for (std::size_t k = 0; k < full_element_.size(); ++k) {
    const double mark = both_halves.valuePtr()[k];
    full_transposed_[k] = mark < 0;
    full_element_[k] = static_cast<std::size_t>(mark < 0 ? -mark - 1 : mark);
  }
  diagonal_.resize(static_cast<std::size_t>(n));
  sparse_ = std::make_unique<Sparse>(std::move(upper_half), std::move(both_halves));
  has_factors_ = false;
  rhs_.resize(n);
  solution_.resize(n);
  mixed_rhs_.resize(n);
  mixed_solution_.resize(n);
}

template <class Real>
Real ConstraintMatrix<Real>::element(std::size_t k, const ConstraintGradients<Real>& rows,
                                     const ConstraintGradients<Real>& columns, bool transposed) const {
  Real sum(0);
  for (std::size_t t = first_term_[k]; t < first_term_[k + 1]; ++t) {
    const Term& term = terms_[t];
    sum += term.inverse_mass * (transposed ? dot(rows[term.column_entry], columns[term.row_entry])
                                           : dot(rows[term.row_entry], columns[term.column_entry]));
  }
  return sum;
}

template <class Real>
Index ConstraintMatrix<Real>::factorize(const ConstraintGradients<Real>& g, const Real& least_pivot) {
  for (std::size_t k = 0; k < upper_element_.size(); ++k)
    sparse_->upper.valuePtr()[k] = element(upper_element_[k], g, g, false);
  for (std::size_t c = 0; c < diagonal_.size(); ++c) {  // the last element of a column of the upper half
    diagonal_[c] = sparse_->upper.valuePtr()[sparse_->upper.outerIndexPtr()[c + 1] - 1];
  }
  sparse_->symmetric.factorize_in_place(sparse_->upper);
  has_factors_ = false;
  for (std::size_t e = 0; e < place_.size(); ++e) {
    const Index at = place_[e];
    if (!(sparse_->symmetric.pivot(at) > least_pivot * diagonal_[static_cast<std::size_t>(at)]))
      return static_cast<Index>(e);
  }
  has_factors_ = true;
  return -1;
}

template <class Real> void ConstraintMatrix<Real>::permute(const Vector& b) {
  for (std::size_t e = 0; e < place_.size(); ++e) rhs_[place_[e]] = b[static_cast<Index>(e)];
}
template <class Real> void ConstraintMatrix<Real>::put_back(Vector& b) const {
  for (std::size_t e = 0; e < place_.size(); ++e) b[static_cast<Index>(e)] = solution_[place_[e]];
}

template <class Real> void ConstraintMatrix<Real>::solve(Vector& b) {
  permute(b);
  solution_ = sparse_->symmetric.solve(rhs_);
  put_back(b);
}

template <class Real>
bool ConstraintMatrix<Real>::factorize_mixed(const ConstraintGradients<Real>& s, const ConstraintGradients<Real>& r) {
  for (std::size_t k = 0; k < full_element_.size(); ++k) {
    sparse_->full.valuePtr()[k] = static_cast<double>(element(full_element_[k], s, r, full_transposed_[k]));
  }
  if (!std::exchange(sparse_->mixed_is_analyzed, true)) sparse_->mixed.analyzePattern(sparse_->full);
  sparse_->mixed.factorize(sparse_->full);
  return sparse_->mixed.info() == Eigen::Success;
}

template <class Real> void ConstraintMatrix<Real>::solve_mixed(Vector& b) {
  permute(b);
  for (Index k = 0; k < rhs_.size(); ++k) mixed_rhs_[k] = static_cast<double>(rhs_[k]);
  mixed_solution_ = sparse_->mixed.solve(mixed_rhs_);
  for (Index k = 0; k < rhs_.size(); ++k) solution_[k] = Real(mixed_solution_[k]);
  put_back(b);
}

template class ConstraintMatrix<double>;
template class ConstraintMatrix<Quad>;

}  // namespace noether
