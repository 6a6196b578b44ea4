#pragma once
/// Where the stages of one step say that those of another one will be: of the next, or of one that ends inside.

#include "integrators/methods/collocation_table.hpp"

#include <array>
#include <cstddef>

namespace noether {

/// Weights w_ij of the polynomial through values at the 8 nodes c_j, at the nodes of the next step of the same length:
///
///     p(1 + c_i) = sum_j w_ij p(c_j)
inline std::array<std::array<double, 8>, 8> last_polynomial(const CollocationTable& table) {
  std::array<std::array<double, 8>, 8> weights{};
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      Quad product(1);
      for (std::size_t k = 0; k < 8; ++k) {
        if (k != j) product *= (Quad(1) + table.c[i] - table.c[k]) / (table.c[j] - table.c[k]);
      }
      weights[i][j] = static_cast<double>(product);
    }
  }
  return weights;
}

/// The same, in doubles, at the nodes of a step that begins where the one with the values does and is `length` of it:
///
///     p(length c_i) = sum_j w_ij p(c_j)
inline std::array<std::array<double, 8>, 8> inner_polynomial(const std::array<double, 8>& c, double length) {
  std::array<std::array<double, 8>, 8> weights{};
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      weights[i][j] = 1;
      for (std::size_t k = 0; k < 8; ++k) {
        if (k != j) weights[i][j] *= (length * c[i] - c[k]) / (c[j] - c[k]);
      }
    }
  }
  return weights;
}

}  // namespace noether
