#pragma once
/// Collocation methods as tables made from their nodes, in extended precision.

#include "numbers/real.hpp"

#include <string_view>
#include <vector>

namespace noether {

/// s nodes c_i in [0, 1] and the Runge-Kutta method that collocates there:
///
///     sum_j a_ij c_j^(k-1) = c_i^k / k,   sum_j b_j c_j^(k-1) = 1 / k,   k = 1, ..., s
///
/// @source HairerLubichWanner2006
struct CollocationTable {
  std::vector<Quad> c, b;
  std::vector<std::vector<Quad>> a;
  int order = 0;

  std::size_t stages() const { return c.size(); }
  /// a a and b a: what positions take from accelerations.
  std::vector<std::vector<Quad>> twice() const;
  std::vector<Quad> twice_end() const;
  /// Weights w with sum w_j F_j the coefficient of the Legendre polynomial of degree s - 1 in F.
  std::vector<Quad> last_coefficient() const;
};

/// Nodes of Gauss and Legendre, 1 to 8 of them: order 2 s, symplectic, symmetric.
const CollocationTable& gauss_table(int stages);

/// Nodes of Lobatto, both ends among them, 2 to 9 of them: weights of order 2 s - 2.
const CollocationTable& lobatto_table(int stages);

/// The eight nodes of Radau with the left end among them, those of IAS15: order 15.
const CollocationTable& radau_left_table();

/// The table of a method of the list of collocations; null for another name.
const CollocationTable* collocation_of(std::string_view name);

}  // namespace noether
