#include "constraints/constraint_matrix.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <algorithm>
#include <map>
#include <utility>

namespace noether {

template <class Real> struct ConstraintMatrix<Real>::Factors {
  /// Of a matrix whose upper half stands in the right order already: no copy of it is made.
  struct Symmetric : Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> {
    void factorize_in_place(const Sparse& upper) { this->template factorize_preordered<true>(upper); }
    const Real& pivot(Index k) const { return this->m_diag[k]; }
  };
  Symmetric symmetric;
  Eigen::SparseLU<Sparse, Eigen::NaturalOrdering<int>> mixed;
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
      upper_(other.upper_),
      full_(other.full_),
      upper_element_(other.upper_element_),
      full_element_(other.full_element_),
      full_transposed_(other.full_transposed_),
      diagonal_(other.diagonal_),
      rhs_(other.rhs_),
      solution_(other.solution_) {
  if (other.factors_) analyze();
}
template <class Real> ConstraintMatrix<Real>& ConstraintMatrix<Real>::operator=(const ConstraintMatrix& other) {
  return *this = ConstraintMatrix(other);
}

template <class Real> void ConstraintMatrix<Real>::analyze() {
  factors_ = std::make_unique<Factors>();
  factors_->symmetric.analyzePattern(upper_);
  has_factors_ = false;
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
  std::vector<Eigen::Triplet<Real, int>> upper, full;
  for (const auto& [at, terms] : elements) {
    const auto [column, row] = at;
    const Real element(static_cast<double>(first_term_.size() - 1));
    terms_.insert(terms_.end(), terms.begin(), terms.end());
    first_term_.push_back(terms_.size());
    upper.emplace_back(row, column, element);
    full.emplace_back(row, column, element);
    if (row != column) full.emplace_back(column, row, -element - Real(1));  // below 0: transposed
  }
  upper_ = Sparse(n, n);
  full_ = Sparse(n, n);
  upper_.setFromTriplets(upper.begin(), upper.end());
  full_.setFromTriplets(full.begin(), full.end());
  // The numbers that were put in tell where they have come to stand.
  upper_element_.resize(static_cast<std::size_t>(upper_.nonZeros()));
  for (std::size_t k = 0; k < upper_element_.size(); ++k) {
    upper_element_[k] = static_cast<std::size_t>(static_cast<double>(upper_.valuePtr()[k]));
  }
  full_element_.resize(static_cast<std::size_t>(full_.nonZeros()));
  full_transposed_.resize(full_element_.size());
  for (std::size_t k = 0; k < full_element_.size(); ++k) {
    const double mark = static_cast<double>(full_.valuePtr()[k]);
    full_transposed_[k] = mark < 0;
    full_element_[k] = static_cast<std::size_t>(mark < 0 ? -mark - 1 : mark);
  }
  diagonal_.resize(static_cast<std::size_t>(n));
  analyze();
  rhs_.resize(n);
  solution_.resize(n);
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
    upper_.valuePtr()[k] = element(upper_element_[k], g, g, false);
  for (std::size_t c = 0; c < diagonal_.size(); ++c) {  // the last element of a column of the upper half
    diagonal_[c] = upper_.valuePtr()[upper_.outerIndexPtr()[c + 1] - 1];
  }
  factors_->symmetric.factorize_in_place(upper_);
  has_factors_ = false;
  for (std::size_t e = 0; e < place_.size(); ++e) {
    const Index at = place_[e];
    if (!(factors_->symmetric.pivot(at) > least_pivot * diagonal_[static_cast<std::size_t>(at)]))
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
  solution_ = factors_->symmetric.solve(rhs_);
  put_back(b);
}

template <class Real>
bool ConstraintMatrix<Real>::factorize_mixed(const ConstraintGradients<Real>& s, const ConstraintGradients<Real>& r) {
  for (std::size_t k = 0; k < full_element_.size(); ++k) {
    full_.valuePtr()[k] = element(full_element_[k], s, r, full_transposed_[k]);
  }
  if (!std::exchange(factors_->mixed_is_analyzed, true)) factors_->mixed.analyzePattern(full_);
  factors_->mixed.factorize(full_);
  return factors_->mixed.info() == Eigen::Success;
}

template <class Real> void ConstraintMatrix<Real>::solve_mixed(Vector& b) {
  permute(b);
  solution_ = factors_->mixed.solve(rhs_);
  put_back(b);
}

template class ConstraintMatrix<double>;
template class ConstraintMatrix<Quad>;

}  // namespace noether
