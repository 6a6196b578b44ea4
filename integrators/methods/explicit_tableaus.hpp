#pragma once
/// Tableaus of the explicit Runge-Kutta methods.

#include "integrators/methods/tableau.hpp"

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

}  // namespace noether::tableaus
