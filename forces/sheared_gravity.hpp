#pragma once
/// Gravity in a cell whose images in x slide along y.

#include "engine/column.hpp"
#include "numbers/types.hpp"
#include "numbers/wide_sum.hpp"

#include <algorithm>
#include <vector>

namespace noether {

/// A cell that repeats along x and y, with images in x that have slid along y: the one beyond the edge by - `slope`
/// times its length. Places in it are (x, y + slope x, z): there it repeats along x and y as if nothing had slid.
template <class Real> struct ShearedCell {
  Real width, length, height;  ///< along x, y, and z, where only the nearest image counts
  Real slope;
};

/// Gravity between particles and the nine nearest images of each other, those in the cell among them.
///
///     a_i = sum_{j != i} sum_{9 images} G m_j d/(d^2 + softening^2)^(3/2),   d from i to the image of j
///
/// Nothing but differences of places enters, brought to their nearest image exactly: it does not matter where the cell
/// is cut. A particle feels nothing of its own images, whose pull cancels.
/// @cost 9 n m square roots with m massive particles, of doubles in lanes of rows
template <class Real> class ShearedGravity {
 public:
  Real G = Real(1), softening = Real(0);

  /// @param a  shape (n, 3), set here
  /// @return the potential energy
  Real sum(const ShearedCell<Real>& cell, const VectorColumn<Real>& places, const ScalarColumn<Real>& masses,
           VectorColumn<Real>& a, bool energy);

 private:
  void gather(const VectorColumn<Real>& places, const ScalarColumn<Real>& masses);

  std::vector<Real> x_, y_, z_, m_, row_;  ///< of the massive ones
};

extern template class ShearedGravity<double>;
extern template class ShearedGravity<Quad>;

}  // namespace noether
