#pragma once
/// Eigenvalues of real matrices; Eigen's solver is compiled once, here.

#include "integrators/vector_field.hpp"

#include <complex>
#include <optional>
#include <vector>

namespace noether {

/// All eigenvalues of a square matrix; nothing if its iteration did not end.
/// @cost some 10 n^3
std::optional<std::vector<std::complex<double>>> eigenvalues_of(const Matrix<double>& matrix);

}  // namespace noether
