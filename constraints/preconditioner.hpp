#pragma once
/// The inverse of the matrix that couples the constraints of a kind of molecules, about.

#include "constraints/elimination_row.hpp"
#include "constraints/preconditioner_row.hpp"

#include <span>
#include <vector>

namespace noether {

/// The inverse of G M^-1 G^T of a molecule that nobody has looked at: from masses and lengths, with the angles that
/// three distances fix, and others of 109.5 degrees. Elements that matter little are left out.
///
/// It is a function of the kind alone, never of positions: what is solved with it does not depend on where a run began.
/// @cost O(c^3) for c constraints, once
/// @source Gonnet2007
class Preconditioner {
 public:
  Preconditioner() = default;
  /// @param kind  the molecule  @param lengths  of its constraints, in the order of elimination [length]
  Preconditioner(const EliminationLists& kind, std::span<const double> lengths);

  /// A number within 1 % of a length: molecules with the same ones share a preconditioner.
  static double near(double length);

  /// Valid as long as this is where it is.
  PreconditionerLists lists() const { return {row_.data(), column_.data(), value_.data()}; }

 private:
  std::vector<int> row_, column_;
  std::vector<double> value_;
};

}  // namespace noether
