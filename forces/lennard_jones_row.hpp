#pragma once
/// The numbers of Lennard-Jones pairs, as the kernels in lanes and the templates read them.

#include <cstdint>

namespace noether {

/// How a pair of types acts: one row of a table.
struct LennardJonesRow {
  double range2 = 0;                 ///< square of the cutoff [length^2]
  double close2 = 0;                 ///< nearer pairs may be too strong for the grid of the sums [length^2]
  double force12 = 0, force6 = 0;    ///< F/r = (force12 / r^6 - force6) / r^8
  double energy12 = 0, energy6 = 0;  ///< U = (energy12 / r^6 - energy6) / r^6
  double style[2] = {0, 0};          ///< see LennardJonesStyle

  bool operator==(const LennardJonesRow&) const = default;
};

/// What the end of the range does, and the numbers of a row that it needs.
enum class LennardJonesStyle : std::uint8_t {
  shifted,        ///< energy less style[0]; plain where that is 0
  shifted_force,  ///< energy less style[0], less the force style[1] times r; style[0] takes both
  switch_c2,      ///< from r^2 = style[0] on times a polynomial in (r^2 - style[0]) style[1], twice differentiable
  switch_c4,      ///< the same, four times differentiable
};

}  // namespace noether
