#include "constraints/preconditioner.hpp"

#include "numbers/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

namespace noether {

namespace {

/// Elements below this part of the geometric mean of their diagonal elements are left out.
constexpr double least_element = 1e-3;
/// Of a tetrahedral angle.
constexpr double tetrahedral = -1.0 / 3;

/// What is known of the angles in a molecule.
class Angles {
 public:
  Angles(const EliminationLists& kind, std::span<const double> lengths) : kind_(kind), lengths_(lengths) {
    bonds_.assign(static_cast<std::size_t>(kind.atoms), 0);
    for (int k = 0; k < kind.constraints; ++k) {
      between_[sorted(kind.i[k], kind.j[k])] = k;
      for (const int atom : {kind.i[k], kind.j[k]}) ++bonds_[static_cast<std::size_t>(atom)];
    }
  }
  /// The cosine of the angle between two constraints at the atom that they share.
  double cosine(int k, int l) const {
    const int shared = kind_.i[k] == kind_.i[l] || kind_.i[k] == kind_.j[l] ? kind_.i[k] : kind_.j[k];
    const auto other = [&](int c) { return kind_.i[c] == shared ? kind_.j[c] : kind_.i[c]; };
    const auto opposite = between_.find(sorted(other(k), other(l)));
    // So many bonds of one atom cannot all be further apart.
    if (opposite == between_.end()) return std::max(tetrahedral, -1.0 / (bonds_[static_cast<std::size_t>(shared)] - 1));
    const double c = length(opposite->second), d = length(k), e = length(l);
    return (d * d + e * e - c * c) / (2 * d * e);
  }
  double length(int k) const { return lengths_[static_cast<std::size_t>(k)]; }

 private:
  static std::pair<int, int> sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  const EliminationLists& kind_;
  std::span<const double> lengths_;
  std::map<std::pair<int, int>, int> between_;  ///< the constraint of two atoms
  std::vector<int> bonds_;                      ///< of each atom
};

/// G M^-1 G^T with these angles.
Eigen::MatrixXd matrix_of(const EliminationLists& kind, const Angles& angles) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kind.constraints, kind.constraints);
  for (int k = 0; k < kind.constraints; ++k) {
    const double d = angles.length(k);
    a(k, k) = (kind.inverse_mass_i[k] + kind.inverse_mass_j[k]) * d * d;
    for (int e = kind.row[k]; e < kind.row[k + 1]; ++e) {
      const int l = kind.column[e];
      if (kind.coupling[e] != 0) a(k, l) = std::abs(kind.coupling[e]) * d * angles.length(l) * angles.cosine(k, l);
      a(l, k) = a(k, l);
    }
  }
  return a;
}

/// The inverse of a symmetric matrix by elimination in order: its bits depend on no cache, as those of blocks do.
/// @return none where it is not positive definite
std::optional<Eigen::MatrixXd> inverse_of(Eigen::MatrixXd a) {
  const Index n = a.rows();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n, n);
  for (Index k = 0; k < n; ++k) {
    if (!(a(k, k) > 0)) return {};
    const double pivot = 1 / a(k, k);
    for (Index j = 0; j < n; ++j) a(k, j) *= pivot, inverse(k, j) *= pivot;
    for (Index i = 0; i < n; ++i) {
      const double factor = a(i, k);
      if (i == k || factor == 0) continue;
      for (Index j = 0; j < n; ++j) a(i, j) -= factor * a(k, j), inverse(i, j) -= factor * inverse(k, j);
    }
  }
  return inverse;
}

}  // namespace

double Preconditioner::near(double length) {
  int exponent = 0;
  const double mantissa = std::frexp(length, &exponent);  // 1/2 to 1
  return std::ldexp(std::round(mantissa * 128), exponent - 7);
}

Preconditioner::Preconditioner(const EliminationLists& kind, std::span<const double> lengths) {
  Eigen::MatrixXd a = matrix_of(kind, Angles(kind, lengths));
  std::optional<Eigen::MatrixXd> found = inverse_of(a);
  while (!found) {  // angles that no molecule has
    const Eigen::VectorXd diagonal = a.diagonal();
    a *= 0.75;
    a.diagonal() = diagonal;
    found = inverse_of(a);
  }
  const Eigen::MatrixXd& inverse = *found;
  row_.push_back(0);
  for (int k = 0; k < kind.constraints; ++k) {
    for (int l = 0; l < kind.constraints; ++l) {
      if (std::abs(inverse(k, l)) <= least_element * std::sqrt(inverse(k, k) * inverse(l, l))) continue;
      column_.push_back(l);
      value_.push_back(inverse(k, l));
    }
    row_.push_back(static_cast<int>(column_.size()));
  }
}

}  // namespace noether
