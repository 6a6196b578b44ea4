#pragma once
/// Multistep methods on the oscillator: the roots of their characteristic polynomials.

#include "integrators/methods/adams.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <complex>
#include <functional>
#include <vector>

namespace noether::test {

using Complex = std::complex<double>;

/// Moduli of the roots of c_0 x^n + c_1 x^(n-1) + ... + c_n, the largest first.
inline std::vector<double> moduli_of_roots(const std::vector<Complex>& c) {
  const Index n = static_cast<Index>(c.size()) - 1;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(n, n);
  for (Index j = 0; j < n; ++j) companion(0, j) = -c[static_cast<std::size_t>(j) + 1] / c[0];
  for (Index j = 1; j < n; ++j) companion(j, j - 1) = 1;
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(companion, false);
  std::vector<double> moduli;
  for (Index j = 0; j < n; ++j) moduli.push_back(std::abs(solver.eigenvalues()[j]));
  std::sort(moduli.rbegin(), moduli.rend());
  return moduli;
}

/// Roots of an Adams method on y' = i z y, h = 1, from the weights it computes with.
inline std::vector<double> adams_moduli(AdamsKind kind, const std::vector<double>& explicit_weights,
                                        const std::vector<double>& implicit_weights, double z) {
  const Complex lambda(0, z);
  std::vector<Complex> c(std::max<std::size_t>(explicit_weights.size() + 1, implicit_weights.size()), Complex(0));
  c[0] += 1;
  c[1] -= 1;
  if (kind != AdamsKind::bashforth) {
    for (std::size_t j = 1; j < implicit_weights.size(); ++j) c[j] -= lambda * implicit_weights[j];
  }
  if (kind == AdamsKind::moulton) c[0] -= lambda * implicit_weights[0];
  if (kind == AdamsKind::bashforth) {
    for (std::size_t j = 0; j < explicit_weights.size(); ++j) c[j + 1] -= lambda * explicit_weights[j];
  }
  if (kind == AdamsKind::pece) {
    c[1] -= lambda * implicit_weights[0];
    for (std::size_t j = 0; j < explicit_weights.size(); ++j) {
      c[j + 1] -= lambda * lambda * implicit_weights[0] * explicit_weights[j];
    }
  }
  return moduli_of_roots(c);
}

/// The first z from which on, upward in steps of 5e-4 and then by halving, the growth a step is above `threshold`.
inline double first_unstable(const std::function<double(double)>& growth, double threshold, double most) {
  const double step = 5e-4;
  for (double z = step; z < most; z += step) {
    if (!(growth(z) > threshold)) continue;
    double stable = z - step, unstable = z;
    for (int n = 0; n < 40; ++n) {
      const double middle = (stable + unstable) / 2;
      (middle > 0 && growth(middle) > threshold ? unstable : stable) = middle;
    }
    return unstable;
  }
  return most;
}

}  // namespace noether::test
