#pragma once
/// The free fall of a test body about a black hole that turns.

#include "engine/description.hpp"
#include "integrators/named_invariant.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace noether {

/// A geodesic of Kerr's metric in Boyer and Lindquist's coordinates, by proper time; lengths and times in units of the
/// mass of the hole, G = c = M = 1, energies and momenta of a unit of mass.
///
///     H = (D p_r^2 + p_theta^2 + (p_phi/sin theta + a p_t sin theta)^2 - ((r^2 + a^2) p_t + a p_phi)^2/D) / (2 S) =
///     -1/2 S = r^2 + a^2 cos^2 theta,   D = r^2 - 2 r + a^2
///
/// Kept are p_t = -E, p_phi = L, H, and Carter's constant
/// p_theta^2 + cos^2 theta (a^2 (1 - E^2) + L^2/sin^2 theta), which no symmetry tells of. It starts at t = phi = 0,
/// with E from H = -1/2.
/// @source Carter1968, Chandrasekhar1983
struct Kerr {
  double a = 0.9;                 ///< angular momentum of the hole over its mass, below 1 [1]
  double r = 10;                  ///< at the start [1]
  double theta = 1.2;             ///< at the start, from the axis [rad]
  double p_r = 0;                 ///< at the start [1]
  double p_theta = 0.8;           ///< at the start [1]
  double angular_momentum = 2.6;  ///< L along the axis [1]

  static constexpr auto describe() {
    return part<Kerr>(
        "kerr", "free fall about a black hole that turns, by proper time",
        formula("H = (D p_r^2 + p_theta^2 + (p_phi/sin theta + a p_t sin theta)^2 - ((r^2 + a^2) p_t + a p_phi)^2/D)"
                "/(2 S) = -1/2, S = r^2 + a^2 cos^2 theta, D = r^2 - 2 r + a^2"),
        source("Carter1968"), quantities("t, r, theta, phi [1], p_t, p_r, p_theta, p_phi [1]"),
        field<&Kerr::a>("a", "1", "how fast the hole turns, from -1 to 1; lengths and times are in units of its mass"),
        field<&Kerr::r>("r", "1", "radius at the start, outside the horizon"),
        field<&Kerr::theta>("theta", "1", "angle from the axis at the start, between 0 and pi"),
        field<&Kerr::p_r>("p_r", "1", "radial momentum of a unit of mass at the start"),
        field<&Kerr::p_theta>("p_theta", "1", "momentum of theta at the start"),
        field<&Kerr::angular_momentum>("angular_momentum", "1", "L of a unit of mass along the axis"));
  }
  void check() const {
    if (!(std::abs(a) < 1)) refuse_field("a", a, "leaves no horizon; a number between -1 and 1 is expected");
    const double horizon = 1 + std::sqrt(1 - a * a);
    if (!(r > horizon && std::isfinite(r))) {
      refuse_field("r", r, fmt::format("is not outside the horizon; a radius above {:.6g} is expected", horizon));
    }
    if (!(theta > 0 && theta < std::acos(-1.0))) {
      refuse_field("theta", theta, "is on the axis or beyond it; an angle between 0 and pi is expected");
    }
    for (const auto& [key, number] :
         {std::pair{"p_r", p_r}, {"p_theta", p_theta}, {"angular_momentum", angular_momentum}}) {
      if (!std::isfinite(number)) refuse_field(key, number, "is not a number");
    }
  }

  Index size() const { return 4; }
  /// H is a square polynomial of p_t, of which the future has the root below 0.
  std::vector<double> start() const {
    const double sine = std::sin(theta), cosine = std::cos(theta), D = r * r - 2 * r + a * a,
                 S = r * r + a * a * cosine * cosine, L = angular_momentum, ring = r * r + a * a;
    const double square = a * a * sine * sine - ring * ring / D, linear = a * L - ring * a * L / D,
                 constant = D * p_r * p_r + p_theta * p_theta + L * L / (sine * sine) - a * a * L * L / D + S;
    return {0, r, theta, 0, (-linear + std::sqrt(linear * linear - square * constant)) / square, p_r, p_theta, L};
  }
  std::vector<std::string> names() const { return {"t", "r", "theta", "phi", "p_t", "p_r", "p_theta", "p_phi"}; }
  /// "carter"; p_t and p_phi, whose rates are 0, every method keeps.
  std::vector<NamedInvariant> invariants() const;

  template <class Real> Real value(const Real& /*tau*/, const Vector<Real>& q, const Vector<Real>& p) const {
    using std::cos, std::sin;
    const Real square = Real(a) * Real(a), r2 = q[1] * q[1], D = r2 - Real(2) * q[1] + square;
    const Real sine = sin(q[2]), cosine = cos(q[2]), S = r2 + square * cosine * cosine;
    const Real about = p[3] / sine + Real(a) * p[0] * sine, along = (r2 + square) * p[0] + Real(a) * p[3];
    return (D * p[1] * p[1] + p[2] * p[2] + about * about - along * along / D) / (Real(2) * S);
  }
};

/// Carter's constant of a body of any mass, whose square is -2 H.
struct CarterConstant {
  Kerr hole;

  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    using std::cos, std::sin;
    const Real sine = sin(q[2]), cosine = cos(q[2]), turn = p[3] / sine;
    const Real square = -Real(2) * hole.value(Real(0), q, p) - p[0] * p[0];
    return p[2] * p[2] + cosine * cosine * (Real(hole.a * hole.a) * square + turn * turn);
  }
};

inline std::vector<NamedInvariant> Kerr::invariants() const { return {invariant("carter", CarterConstant{*this})}; }

}  // namespace noether
