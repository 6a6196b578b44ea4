#pragma once
/// How secant forces change with the second of the two states that they lie between.

#include "engine/column.hpp"
#include "numbers/types.hpp"

#include <Eigen/SparseCore>

#include <utility>
#include <vector>

namespace noether {

/// The matrix da/dx of secant accelerations a with respect to the places x of the second state: a sparse matrix of
/// blocks of 3 x 3 numbers, one for each two particles that feel each other, added up in the order in which forces name
/// them.
///
///     do {
///       tangent.begin(s.masses());
///       ...                         // forces add their blocks
///     } while (!tangent.end());     // once more where blocks had no place yet
///
/// Which blocks there are follows from this one sum, so that no history changes the bits of factors.
/// @cost 72 bytes and a search among the neighbors of a particle for each block; of a new pattern a sort
template <class Real> class SecantTangent {
 public:
  /// Begins a sum. @param masses  [mass]
  void begin(const ScalarColumn<Real>& masses);
  /// Ends it. @return false where blocks had no place, or more had one than were named: the sum has to be made anew
  bool end();

  /// Adds to the derivative of the acceleration of particle i with respect to x_j [1/time^2].
  void acceleration(Index i, Index j, const Mat3<Real>& derivative);
  /// Adds what the force on particle i changes by with x_j [mass/time^2]; tracers feel no forces.
  void force(Index i, Index j, const Mat3<Real>& derivative);
  /// Adds the derivative with respect to x_i of a force on particle i by particle j, which has Newton's third law and
  /// sees differences of places only [mass/time^2].
  void pair(Index i, Index j, const Mat3<Real>& derivative);

  /// Shape (3 n, 3 n), all x before all y before all z; blocks on the diagonal are there for each particle.
  const Eigen::SparseMatrix<Real>& matrix() const { return matrix_; }

 private:
  using Place = std::pair<int, int>;  ///< column and row of a block

  void make_pattern(std::vector<Place> blocks);

  Index n_ = 0;
  std::vector<Real> by_mass_;      ///< 1 / m; 0 for tracers
  std::vector<int> first_, rows_;  ///< rows of the blocks of column j from first_[j] to first_[j + 1], in order
  std::vector<char> named_;
  std::vector<Place> missing_;
  Eigen::SparseMatrix<Real> matrix_;
};

extern template class SecantTangent<double>;
extern template class SecantTangent<Quad>;

}  // namespace noether
