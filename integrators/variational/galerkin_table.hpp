#pragma once
/// Paths of polynomials and the quadrature of their action, as tables made in extended precision.

#include "numbers/real.hpp"

#include <vector>

namespace noether {

/// A path of degree s through s + 1 points, d_0 = 0 and d_s = 1 among them, and a quadrature with r nodes:
///
///     q(c) = sum_k l_k(c) Q_k,   S = h sum_i b_i L(t + c_i h, q(c_i), q'(c_i) / h)
///
/// @source MarsdenWest2001, HairerLubichWanner2006
struct GalerkinTable {
  std::vector<Quad> points;                     ///< d_k, shape (s + 1)
  std::vector<Quad> c, b;                       ///< of the quadrature, shape (r)
  std::vector<std::vector<Quad>> value, slope;  ///< l_k(c_i) and l_k'(c_i), shape (r, s + 1)
  /// The inverse of K_jk = sum_i b_i l_j'(c_i) l_k'(c_i), j < s, k > 0: what the kinetic energy alone makes of the
  /// points; shape (s, s), its rows by k and its columns by j.
  std::vector<std::vector<Quad>> inverse;
  int order = 0;

  int degree() const { return static_cast<int>(points.size()) - 1; }
  int nodes() const { return static_cast<int>(c.size()); }
};

/// Degree s and s nodes of Gauss, 1 to 8: order 2 s.
GalerkinTable galerkin_gauss_table(int nodes);
/// Degree s - 1 and s nodes of Lobatto, 2 to 9: order 2 s - 2.
GalerkinTable galerkin_lobatto_table(int nodes);

/// l_k(x) for points d, all k.
std::vector<Quad> lagrange_values(const std::vector<Quad>& d, Quad x);

}  // namespace noether
