#pragma once
/// The signs of the eigenvalues of symmetric matrices.

#include "integrators/vector_field.hpp"

#include <optional>

namespace noether {

/// How many eigenvalues of a symmetric matrix are below 0, by Sylvester's law of inertia: as many as of the blocks of
/// one or two rows that symmetric elimination with complete pivoting leaves.
/// @param work  of the same shape; what is in it does not matter
/// @return nothing for a matrix that is not finite
/// @cost n^3 / 2; no allocation for a size that `work` has met before
/// @source BunchParlett1971
template <class Real> std::optional<Index> negative_eigenvalues(const Matrix<Real>& matrix, Matrix<Real>& work);

extern template std::optional<Index> negative_eigenvalues(const Matrix<double>& matrix, Matrix<double>& work);
extern template std::optional<Index> negative_eigenvalues(const Matrix<Quad>& matrix, Matrix<Quad>& work);

}  // namespace noether
