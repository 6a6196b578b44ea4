#include "integrators/methods/inertia.hpp"

#include <utility>

namespace noether {

namespace {

template <class Real> Real size_of_element(const Real& x) { return x < Real(0) ? -x : x; }

/// Where the largest element on the diagonal is, and the largest beside it, from row k on.
struct Pivots {
  Index on = 0, row = 0, column = 0;
};
template <class Real> Pivots find_pivots(const Matrix<Real>& m, Index k) {
  Pivots found{k, k, k};
  Real on(0), beside(0);
  for (Index i = k; i < m.rows(); ++i) {
    if (size_of_element(m(i, i)) > on) {
      on = size_of_element(m(i, i));
      found.on = i;
    }
    for (Index j = k; j < i; ++j) {
      if (!(size_of_element(m(i, j)) > beside)) continue;
      beside = size_of_element(m(i, j));
      found.row = i;
      found.column = j;
    }
  }
  const Real enough(0.6403882032022076);  // (1 + sqrt 17)/8
  if (!(on < enough * beside)) found.row = found.column = found.on;
  return found;
}

template <class Real> void exchange(Matrix<Real>& m, Index a, Index b) {
  if (a == b) return;
  m.row(a).swap(m.row(b));
  m.col(a).swap(m.col(b));
}

}  // namespace

template <class Real> std::optional<Index> negative_eigenvalues(const Matrix<Real>& matrix, Matrix<Real>& work) {
  if (!matrix.allFinite()) return {};
  work = matrix;
  const Index n = work.rows();
  Index negative = 0;
  for (Index k = 0; k < n;) {
    const Pivots pivots = find_pivots(work, k);
    exchange(work, k, pivots.column);
    if (pivots.row == pivots.column) {
      const Real pivot = work(k, k);
      if (pivot == Real(0)) return negative;
      if (pivot < Real(0)) ++negative;
      for (Index i = k + 1; i < n; ++i) {
        const Real factor = work(i, k) / pivot;
        for (Index j = k + 1; j < n; ++j) work(i, j) -= factor * work(k, j);
      }
      ++k;
      continue;
    }
    // Beside an element larger than all on the diagonal the determinant of two rows is below 0: one eigenvalue is.
    exchange(work, k + 1, pivots.row);
    ++negative;
    const Real a = work(k, k), b = work(k + 1, k), c = work(k + 1, k + 1), determinant = a * c - b * b;
    for (Index i = k + 2; i < n; ++i) {
      const Real first = (c * work(i, k) - b * work(i, k + 1)) / determinant,
                 second = (a * work(i, k + 1) - b * work(i, k)) / determinant;
      for (Index j = k + 2; j < n; ++j) work(i, j) -= first * work(k, j) + second * work(k + 1, j);
    }
    k += 2;
  }
  return negative;
}

template std::optional<Index> negative_eigenvalues(const Matrix<double>& matrix, Matrix<double>& work);
template std::optional<Index> negative_eigenvalues(const Matrix<Quad>& matrix, Matrix<Quad>& work);

}  // namespace noether
