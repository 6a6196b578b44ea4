#pragma once
/// Bodies of a Wisdom-Holman splitting side by side: what the kernels in lanes work on.

#include <cstddef>
#include <cstdint>

namespace noether {

/// Eight bodies on Kepler arcs: a number of each in a line, in working coordinates. Where there is no body, one of mass
/// 0 rests far outside, is attracted by nothing and attracts nothing.
struct alignas(64) ArcRow {
  double x[3][8], v[3][8];
  double x_low[3][8], v_low[3][8];  ///< what rounding took from x and v, where that is kept
  double r[8], r_inverse[8];        ///< |x| and 1 / |x|: functions of x
  double s[8];                      ///< universal variable of the next arc, predicted
  double arc[8];                    ///< universal variable of the last arc
  double mu[8];                     ///< of the arc [length^3/time^2]
  double moves[8];                  ///< 1; 0 where there is no body
};

/// Eight planets. Masses are in those of the star.
struct alignas(64) PlanetRow : ArcRow {
  double y[3][8];  ///< relative to the star, as the last kick met them

  // Constants.
  double share[8];        ///< Jacobi: m_k/M_k; democratic: m_k
  double rest[8];         ///< Jacobi: 1 - m_k/M_k
  double one_over_m[8];   ///< 1/m_k; 0 where there is no planet
  double one_over_M[8];   ///< Jacobi: 1/M_{k-1}; 0 where there is no planet
  double star[8];         ///< Jacobi: G m_0 m_k; 0 of the innermost, whose arc has it all
  double without_arc[8];  ///< Jacobi: mu_k; 0 of the innermost
  double relativity[8];   ///< 6 (G m_0/c)^2 m_k; 0 without general relativity
  double attracts[8];     ///< G m_0 m_k
  double mass[8];         ///< m_k; 0 where there is no planet
  double reach[8];        ///< as `PlanetPairs::near` has it: a pair is near within the square of the sum of both
  double force[3][8];     ///< of the last kick

  // Of kernels, which look at forces beside x or along a direction.
  double along[3][8];    ///< the direction, in Jacobi coordinates
  double y_along[3][8];  ///< the same relative to the star
};

/// Constants of the pairs of two rows, or of one row with itself: line n is of lane i and lane i + n in a ring,
/// so that of one row with itself line 4 has each pair twice.
struct alignas(64) PlanetPairs {
  double attraction[8][8];  ///< G m_0 m_i m_j, masses in those of the star
  double near[8][8];        ///< r_ij^2 over the squared distance from the star below which the two are to be noted
};

/// An arc by the solver for all cases: dx, dv, and the universal variable. @return whether it is found
using ExactArc = bool (*)(const double* x, const double* v, double mu, double h, double* dx, double* dv, double* s);
/// That solver in doubles (`integrators/kepler.hpp`).
bool exact_arc(const double* x, const double* v, double mu, double h, double* dx, double* dv, double* s);

/// All planets, in the order of the splitting.
struct PlanetRows {
  PlanetRow* row;
  std::ptrdiff_t rows;
  const PlanetPairs* pairs;   ///< of rows (0, 0), (0, 1), ..., (1, 1), (1, 2), ..., or of each row with itself alone
  bool of_own_alone = false;  ///< the latter: constants of other pairs are worked out where they are needed
  bool jacobi;                ///< coordinates; otherwise democratic ones
  bool compensated;           ///< whether what rounding takes is kept
  bool relativity;
  ExactArc exact;
};

/// What a drift does beside moving the planets.
struct ArcTask {
  double h;
  bool predicted;  ///< the rows hold predictions for this h
  bool predict;    ///< make one for a next drift of the same h
};
/// How it went.
struct ArcReport {
  std::ptrdiff_t second = 0;   ///< rows that a second pass was needed for
  std::ptrdiff_t exact = 0;    ///< arcs left to `ExactArc`
  std::ptrdiff_t failed = -1;  ///< the first body whose arc was not found; -1: none
};

/// One letter of a path (`PlanetPath`): arcs `A` or a kick `B`.
struct PathLetter {
  char letter;
  bool predicted;          ///< tracers hold predictions: for this arc, or to be taken along by a kick
  bool predict;            ///< arcs make one for the next
  bool noting;             ///< encounters in the kick count
  double h;                ///< [time]
  double time;             ///< of the kick
  std::int64_t step;       ///< of the run
  std::ptrdiff_t numbers;  ///< of a kick, where they begin: y of each planet, and then
                           ///< jacobi: of each level w center and acceleration of the innermost w + 1 bodies,
                           ///< democratic: the first jump and the sum of both
};

}  // namespace noether
