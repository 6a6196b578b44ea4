#include "integrators/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace noether {

std::optional<std::vector<std::complex<double>>> eigenvalues_of(const Matrix<double>& matrix) {
  const Eigen::EigenSolver<Matrix<double>> solver(matrix, false);
  if (solver.info() != Eigen::Success) return {};
  const auto& values = solver.eigenvalues();
  return std::vector<std::complex<double>>(values.data(), values.data() + values.size());
}

}  // namespace noether
