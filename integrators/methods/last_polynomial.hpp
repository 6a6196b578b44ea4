#pragma once
/// Where the stages of one step say that those of the next will be.

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

}  // namespace noether
