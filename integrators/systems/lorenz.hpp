#pragma once
/// The system of Lorenz.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <string>
#include <vector>

namespace noether {

/// Convection in three variables: chaotic, and not stiff.
///
///     x' = sigma (y - x),   y' = x (rho - z) - y,   z' = x y - beta z
/// @source Lorenz1963
struct Lorenz {
  double sigma = 10;      ///< [1/time]
  double rho = 28;        ///< [1]
  double beta = 8.0 / 3;  ///< [1/time]

  static constexpr auto describe() {
    return part<Lorenz>("lorenz", "convection in three variables: chaotic, and not stiff",
                        formula("x' = sigma (y - x),  y' = x (rho - z) - y,  z' = x y - beta z"), source("Lorenz1963"),
                        quantities("x, y, z [1]"), field<&Lorenz::sigma>("sigma", "1/time", "Prandtl's number"),
                        field<&Lorenz::rho>("rho", "1", "Rayleigh's number, relative to where convection begins"),
                        field<&Lorenz::beta>("beta", "1/time", "shape of the cells"));
  }

  Index size() const { return 3; }
  std::vector<double> start() const { return {1, 1, 1}; }
  std::vector<std::string> names() const { return {"x", "y", "z"}; }

  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    dy[0] = Real(sigma) * (y[1] - y[0]);
    dy[1] = y[0] * (Real(rho) - y[2]) - y[1];
    dy[2] = y[0] * y[1] - Real(beta) * y[2];
  }
};

}  // namespace noether
