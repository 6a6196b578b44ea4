#pragma once
/// LU factors of sparse matrices; Eigen's solver is compiled once, here.

#include "integrators/vector_field.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
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
  /// Forgets what is known of the places of elements: the next matrix may have others.
  void forget() { *this = SparseFactors(); }

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

/// Whether elements stand in the same places.
template <class Real> bool have_same_pattern(const Eigen::SparseMatrix<Real>& a, const Eigen::SparseMatrix<Real>& b) {
  const Index columns = a.outerSize(), elements = a.nonZeros();
  return b.outerSize() == columns && b.nonZeros() == elements &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + columns + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + elements, b.innerIndexPtr());
}

extern template class SparseFactors<double>;
extern template class SparseFactors<Quad>;

}  // namespace noether
