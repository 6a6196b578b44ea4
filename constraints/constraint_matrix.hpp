#pragma once
/// The sparse matrix that couples constraints, G M^-1 G^T, and its factors.

#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <memory>
#include <vector>

namespace noether {

/// Which particles each equation ties: equation e has entries [first[e], first[e + 1]).
template <class Real> struct ConstraintLayout {
  std::vector<Index> first;
  std::vector<Index> particle;     ///< of each entry
  std::vector<Real> inverse_mass;  ///< of that particle [1/mass]

  Index equations() const { return static_cast<Index>(first.size()) - 1; }
};

/// A gradient for each entry of a layout.
template <class Real> using ConstraintGradients = std::vector<Vec3<Real>>;

/// S M^-1 R^T for gradients S and R of one layout. Its pattern never changes: equations are coupled where they share a
/// particle. They are ordered once for little fill (approximate minimum degree); a chain has none.
/// @cost O(equations) for chains and trees
/// @source AmestoyDavisDuff1996, Davis2006
template <class Real> class ConstraintMatrix {
 public:
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  ConstraintMatrix();
  /// A copy has the pattern; it has no factors yet.
  ConstraintMatrix(const ConstraintMatrix& other);
  ConstraintMatrix(ConstraintMatrix&&) noexcept;
  ConstraintMatrix& operator=(const ConstraintMatrix& other);
  ConstraintMatrix& operator=(ConstraintMatrix&&) noexcept;
  ~ConstraintMatrix();

  void lay_out(const ConstraintLayout<Real>& layout);

  /// Whether G M^-1 G^T has been factorized since anybody said that it changes.
  bool has_factors() const { return has_factors_; }
  void forget_factors() { has_factors_ = false; }

  /// Factorizes G M^-1 G^T = L D L^T.
  /// @return the equation that depends on those eliminated before it, by the size of its pivot; -1 if none does
  /// @cost no allocation up to 8192 equations
  Index factorize(const ConstraintGradients<Real>& g, const Real& least_pivot);
  /// Solves with these factors, in place.
  void solve(Vector& b);

  /// Factorizes S M^-1 R^T = L U in double: Newton's method wants a direction, and each of its steps then gains 15
  /// digits.
  /// @return whether there are factors
  /// @cost allocates
  bool factorize_mixed(const ConstraintGradients<Real>& s, const ConstraintGradients<Real>& r);
  void solve_mixed(Vector& b);

 private:
  struct Sparse;  ///< Eigen's matrices and factors
  /// One product of gradients in an element of the matrix.
  struct Term {
    std::size_t row_entry, column_entry;
    Real inverse_mass;
  };

  Real element(std::size_t k, const ConstraintGradients<Real>& rows, const ConstraintGradients<Real>& columns,
               bool transposed) const;
  void permute(const Vector& b);
  void put_back(Vector& b) const;

  std::vector<int> place_;               ///< of each equation in the order of elimination
  std::vector<std::size_t> first_term_;  ///< of each element of the upper half
  std::vector<Term> terms_;
  std::vector<std::size_t> upper_element_, full_element_;  ///< behind each stored number; lower half: the other way
  std::vector<bool> full_transposed_;
  std::vector<Real> diagonal_;
  std::unique_ptr<Sparse> sparse_;
  bool has_factors_ = false;
  Vector rhs_, solution_;
  Eigen::VectorXd mixed_rhs_, mixed_solution_;
};

}  // namespace noether
