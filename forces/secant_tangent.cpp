#include "forces/secant_tangent.hpp"

#include "numbers/real.hpp"

#include <algorithm>

namespace noether {

template <class Real> void SecantTangent<Real>::begin(const ScalarColumn<Real>& masses) {
  const Index n = masses.size();
  by_mass_.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    by_mass_[static_cast<std::size_t>(i)] = masses[i] == Real(0) ? Real(0) : Real(1) / masses[i];
  }
  if (matrix_.cols() != 3 * n) make_pattern({});
  std::fill(named_.begin(), named_.end(), static_cast<char>(0));
  missing_.clear();
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), Real(0));
  for (Index i = 0; i < n; ++i) acceleration(i, i, Mat3<Real>(Mat3<Real>::Zero()));
}

template <class Real> bool SecantTangent<Real>::end() {
  const bool all_named = std::find(named_.begin(), named_.end(), static_cast<char>(0)) == named_.end();
  if (all_named && missing_.empty()) return true;
  std::vector<Place> blocks = std::move(missing_);
  for (std::size_t j = 0; j + 1 < first_.size(); ++j) {
    for (auto at = static_cast<std::size_t>(first_[j]); at < static_cast<std::size_t>(first_[j + 1]); ++at) {
      if (named_[at] != 0) blocks.emplace_back(static_cast<int>(j), rows_[at]);
    }
  }
  make_pattern(std::move(blocks));
  return false;
}

/// Rows of each column, and a matrix of zeros with three columns and three rows for each of them.
template <class Real> void SecantTangent<Real>::make_pattern(std::vector<Place> blocks) {
  const std::size_t n = by_mass_.size();
  for (std::size_t i = 0; i < n; ++i) blocks.emplace_back(static_cast<int>(i), static_cast<int>(i));
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  first_.assign(n + 1, 0);
  rows_.clear();
  for (const auto& [column, row] : blocks) {
    ++first_[static_cast<std::size_t>(column) + 1];
    rows_.push_back(row);
  }
  for (std::size_t j = 0; j < n; ++j) first_[j + 1] += first_[j];
  named_.assign(rows_.size(), static_cast<char>(0));
  const auto size = static_cast<Index>(n), count = static_cast<Index>(rows_.size());
  matrix_.resize(3 * size, 3 * size);
  matrix_.resizeNonZeros(9 * count);
  for (Index column = 0; column <= 3 * size; ++column) {
    const Index axis = column / std::max<Index>(size, 1), j = column - axis * size;
    matrix_.outerIndexPtr()[column] = static_cast<int>(3 * (axis * count + first_[static_cast<std::size_t>(j)]));
  }
  for (Index column = 0; column < 3 * size; ++column) {
    const auto j = static_cast<std::size_t>(column % size);
    int* row = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
    for (int axis = 0; axis < 3; ++axis) {
      for (int at = first_[j]; at < first_[j + 1]; ++at) {
        *row++ = axis * static_cast<int>(size) + rows_[static_cast<std::size_t>(at)];
      }
    }
  }
}

template <class Real> void SecantTangent<Real>::acceleration(Index i, Index j, const Mat3<Real>& derivative) {
  const auto column = static_cast<std::size_t>(j);
  const auto begin = rows_.begin() + first_[column], end = rows_.begin() + first_[column + 1];
  const auto found = std::lower_bound(begin, end, static_cast<int>(i));
  if (found == end || *found != static_cast<int>(i)) {
    missing_.emplace_back(static_cast<int>(j), static_cast<int>(i));
    return;
  }
  named_[static_cast<std::size_t>(found - rows_.begin())] = 1;
  const Index neighbors = end - begin, at = found - begin, size = static_cast<Index>(by_mass_.size());
  for (Index l = 0; l < 3; ++l) {
    Real* const value = matrix_.valuePtr() + matrix_.outerIndexPtr()[l * size + j] + at;
    for (Index k = 0; k < 3; ++k) value[k * neighbors] += derivative(k, l);
  }
}

template <class Real> void SecantTangent<Real>::force(Index i, Index j, const Mat3<Real>& derivative) {
  const Real& by_mass = by_mass_[static_cast<std::size_t>(i)];
  if (by_mass != Real(0)) acceleration(i, j, Mat3<Real>(by_mass * derivative));
}

template <class Real> void SecantTangent<Real>::pair(Index i, Index j, const Mat3<Real>& derivative) {
  const Mat3<Real> other = -derivative;
  force(i, i, derivative);
  force(i, j, other);
  force(j, i, other);
  force(j, j, derivative);
}

template class SecantTangent<double>;
template class SecantTangent<Quad>;

}  // namespace noether
