#pragma once
/// The free fall of a test body about a black hole that does not turn.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// A geodesic of Schwarzschild's metric in the plane, by proper time; lengths and times in units of the mass M of the
/// hole, G = c = 1, energies and momenta of a unit of mass.
///
///     H = (- p_t^2 / (1 - 2 M/r) + (1 - 2 M/r) p_r^2 + p_phi^2 / r^2)/2 = -1/2
///
/// p_t = -E and p_phi = L are kept. It starts at t = phi = 0, with E from H = -1/2.
/// @source Chandrasekhar1983
struct Schwarzschild {
  double mass = 1;                ///< M [length]
  double r = 12;                  ///< at the start [length]
  double p_r = 0;                 ///< at the start [1]
  double angular_momentum = 3.9;  ///< L [length]

  static constexpr auto describe() {
    return part<Schwarzschild>(
        "schwarzschild", "free fall about a black hole that does not turn, by proper time",
        formula("H = (-p_t^2/(1 - 2 M/r) + (1 - 2 M/r) p_r^2 + p_phi^2/r^2)/2 = -1/2"), source("Chandrasekhar1983"),
        quantities("t, r, phi [1], p_t, p_r, p_phi [1]"),
        field<&Schwarzschild::mass>("mass", "1", "M, half of the radius of the horizon; units are those of it"),
        field<&Schwarzschild::r>("r", "1", "radius at the start, outside the horizon"),
        field<&Schwarzschild::p_r>("p_r", "1", "radial momentum of a unit of mass at the start"),
        field<&Schwarzschild::angular_momentum>("angular_momentum", "1", "L of a unit of mass"));
  }
  void check() const {
    if (!(mass > 0 && std::isfinite(mass))) refuse_field("mass", mass, "is not a valid mass; one above 0 is expected");
    if (!(r > 2 * mass && std::isfinite(r))) {
      refuse_field("r", r, fmt::format("is not outside the horizon; a radius above {} is expected", 2 * mass));
    }
    if (!std::isfinite(p_r)) refuse_field("p_r", p_r, "is not a number");
    if (!std::isfinite(angular_momentum)) refuse_field("angular_momentum", angular_momentum, "is not a number");
  }

  Index size() const { return 3; }
  std::vector<double> start() const {
    const double f = 1 - 2 * mass / r, l = angular_momentum / r;
    return {0, r, 0, -std::sqrt(f * (1 + f * p_r * p_r + l * l)), p_r, angular_momentum};
  }
  std::vector<std::string> names() const { return {"t", "r", "phi", "p_t", "p_r", "p_phi"}; }

  template <class Real> Real value(const Real& /*tau*/, const Vector<Real>& q, const Vector<Real>& p) const {
    const Real f = Real(1) - Real(2 * mass) / q[1];
    return (f * p[1] * p[1] - p[0] * p[0] / f + p[2] * p[2] / (q[1] * q[1])) / Real(2);
  }
};

}  // namespace noether
