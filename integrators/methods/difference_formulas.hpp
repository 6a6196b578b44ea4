#pragma once
/// Coefficients of the multistep formulas that come from interpolation, generated, not stored.

#include "numbers/real.hpp"

#include <vector>

namespace noether {

/// Coefficients of backward differences of the rates, c_0 to c_(n-1), of formulas of Adams and Stoermer.
///
/// All four are powers of L = -ln(1 - x) / x = 1 + x/2 + x^2/3 + ...:
///
///     Adams-Bashforth  y_1 - y_0          = h   sum c_j D^j f_0,   c(x) = 1 / (L (1 - x))
///     Adams-Moulton    y_1 - y_0          = h   sum c_j D^j f_1,   c(x) = 1 / L
///     Stoermer         y_1 - 2 y_0 + y_-1 = h^2 sum c_j D^j f_0,   c(x) = 1 / (L^2 (1 - x))
///     Cowell           y_1 - 2 y_0 + y_-1 = h^2 sum c_j D^j f_1,   c(x) = 1 / L^2
/// @source HairerNoersettWanner1993, III.1 and III.10
namespace differences {
std::vector<Quad> adams_bashforth(int n);
std::vector<Quad> adams_moulton(int n);
std::vector<Quad> stoermer(int n);
std::vector<Quad> cowell(int n);
}  // namespace differences

/// Weights w_0, w_1, ... of the values f_0, f_-1, ... in sum c_j D^j f_0.
std::vector<Quad> ordinates(const std::vector<Quad>& c);

}  // namespace noether
