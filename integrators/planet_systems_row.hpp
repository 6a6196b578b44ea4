#pragma once
/// Planets of eight systems side by side: what the kernels of `planet_systems_simd.cpp` work on.

#include "integrators/planet_row.hpp"

#include <cstddef>

namespace noether {

/// One planet of each of eight systems, in Jacobi coordinates.
struct alignas(64) SystemRow : ArcRow {
  double y[3][8];       ///< relative to the star, as the last kick met it
  double pull[3][8];    ///< accelerations of the last kick, inertial
  double attracts[8];   ///< G m_k
  double share[8];      ///< m_k/M_k, with M_k the mass of the star and the planets up to this one
  double of_star[8];    ///< m_k/m_0
  double beside[3][8];  ///< accelerations by other forces, where there are some
};

/// A small change of a planet of each system, that of its row.
struct alignas(64) ChangeRow {
  double x[3][8], v[3][8];          ///< in Jacobi coordinates
  double y[3][8];                   ///< relative to the star, as the last kick met it
  double pull[3][8], beside[3][8];  ///< of accelerations, as the planet has them
  double ahead[3][8];               ///< v after a kick that is only looked at
};
/// The same of the centres of mass.
struct alignas(64) ChangeCenter {
  double x[3][8], v[3][8];
  double star[3][8];  ///< of the acceleration of the star by other forces
  double pull[3][8];  ///< of the acceleration of the star
  double kick[3][8];  ///< what a kick adds to v
};

/// What becomes of a small change of the start of an arc by (dx, dv), in place.
/// @param start  x and v @param s  universal variable of the arc
using ExactTurn = void (*)(const double* start, double mu, double h, double s, double* change);

/// Small changes that go along with eight systems.
struct SystemChanges {
  ChangeRow* row;        ///< shape (count, planets)
  ChangeCenter* center;  ///< shape (count)
  std::ptrdiff_t count;
  ExactTurn turn;
};

/// All planets of eight systems, the innermost first.
struct SystemRows {
  SystemRow* row;
  std::ptrdiff_t count;
  const double* star;        ///< G m_0, one for each system
  const double* relativity;  ///< 6 (G m_0/c)^2, one for each system; null without general relativity
  const double* beside;      ///< accelerations of the star by other forces, shape (3, 8); null without them
  double* pull;              ///< accelerations of the stars, shape (3, 8)
  double* center;            ///< what a kick adds to the velocities of the centres of mass, shape (3, 8)
  bool compensated;          ///< whether what rounding takes is kept
  ExactArc exact;
  SystemChanges changes;
};

}  // namespace noether
