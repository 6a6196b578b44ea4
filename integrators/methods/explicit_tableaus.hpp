#pragma once
/// Tableaus of the explicit Runge-Kutta methods.

#include "integrators/methods/tableau.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace noether::tableaus {

const Tableau& euler();
const Tableau& heun();
const Tableau& rk4();
const Tableau& dormand_prince_5();
const Tableau& cash_karp_5();
/// DOP853: twelve stages and the evaluation at the new point; `e` is the estimate of order 5.
const Tableau& dop853();

/// b minus the weights of order 3 of DOP853: its second error estimate.
const std::vector<Quad>& dop853_third_order_error();

/// Dense output of Dormand and Prince's 5(4), order 4: weights of the term of degree 4 beyond the cubic.
const std::vector<Quad>& dormand_prince_5_dense();

/// Dense output of DOP853, order 7: three more stages (rows 14 to 16 of a), and weights d4 to d7.
struct Dop853Dense {
  std::vector<std::vector<Quad>> a;
  std::vector<Quad> c;
  std::vector<std::vector<Quad>> d;
};
const Dop853Dense& dop853_dense();

/// A table with what belongs to it: what a method made of it needs to know.
struct NamedTableau {
  std::string_view name;
  const Tableau& (*table)() = nullptr;
  const std::vector<Quad>& (*dense)() = nullptr;         ///< weights of the term of degree 4 beyond the cubic; or null
  const std::vector<Quad>& (*second_error)() = nullptr;  ///< weights of a second error estimate; or null

  /// Of its error estimates, plus one, and by how much a step may grow at once.
  int control_order() const { return second_error != nullptr ? table().order : table().embedded_order + 1; }
  double most_growth() const { return second_error != nullptr ? 6 : 10; }
};

/// Every explicit table, once.
std::span<const NamedTableau> all_explicit();

}  // namespace noether::tableaus
