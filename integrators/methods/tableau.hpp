#pragma once
/// Butcher tableaus of Runge-Kutta methods, as data.

#include "numbers/real.hpp"

#include <string_view>
#include <vector>

namespace noether {

/// y1 = y0 + h sum b_i k_i,  k_i = f(t + c_i h, y0 + h sum a_ij k_j); embedded weights in `e` give the error estimate.
///
/// a is given by rows, shape (s, s) or, for explicit methods, below the diagonal; c as row sums of a unless given.
struct Tableau {
  std::vector<std::vector<Quad>> a;
  std::vector<Quad> b, c;
  std::vector<Quad> e = {};  ///< b minus the embedded weights
  int order = 0, embedded_order = 0;
  bool first_same_as_last = false;  ///< k_s of a step is k_1 of the next

  std::size_t stages() const { return b.size(); }
};

/// A row of coefficients as printed: decimals or fractions, parted by blanks. @throws std::invalid_argument
std::vector<Quad> coefficients(std::string_view text);

/// Rows of coefficients, one text each.
std::vector<std::vector<Quad>> rows(std::initializer_list<std::string_view> texts);

/// Row sums of a: the nodes c.
std::vector<Quad> row_sums(const std::vector<std::vector<Quad>>& a);

/// The coefficients of a list in the working type.
template <class Real> std::vector<Real> as_real(const std::vector<Quad>& list) {
  std::vector<Real> result;
  for (const Quad& x : list) result.push_back(static_cast<Real>(x));
  return result;
}
template <class Real> std::vector<std::vector<Real>> as_real(const std::vector<std::vector<Quad>>& list) {
  std::vector<std::vector<Real>> result;
  for (const auto& row : list) result.push_back(as_real<Real>(row));
  return result;
}

}  // namespace noether
