#pragma once
/// Tableaus of the diagonally implicit Runge-Kutta methods; the last stage of each is the end of the step.

#include "integrators/methods/tableau.hpp"

namespace noether::tableaus {

const Tableau& backward_euler();

/// Its first stage is explicit.
const Tableau& trapezoidal();

/// g = 1 - 1 / sqrt(2). @source Alexander1977
const Tableau& sdirk_2();

/// g is the root of x^3 - 3 x^2 + 3 x / 2 - 1/6 that makes it L-stable. @source Alexander1977
const Tableau& sdirk_3();

/// g = 1/4, five stages. @source HairerWanner1996
const Tableau& sdirk_4();

}  // namespace noether::tableaus
