#pragma once
/// What the runs of a comparison are measured against.

#include "integrators/vector_field.hpp"
#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// How the reference was made.
enum class TruthKind : std::uint8_t {
  quad,        ///< in extended precision, by two runs that agree
  doubles,     ///< in double precision, by two runs that agree: of liquids, and of more bodies than 113 bits can do
  finest_run,  ///< the finest of the runs compared; its error is its distance from the next
  invariants,  ///< none: only what the equations keep tells errors
};

/// States y = (x, v) at the moments of a sampling, the start among them.
struct Truth {
  TruthKind kind = TruthKind::invariants;
  std::string name = {};             ///< for the column `truth`: "dop853 in quad", "finest run", "invariants"
  std::string note = {};             ///< how it was made, or why there is no better one
  std::optional<double> error = {};  ///< largest distance between two ways to find it, relative as position errors are
  double seconds = 0;                ///< wall time it took
  double evaluations = 0;            ///< of forces that it took, with those of what stands beside it
  std::vector<Vector<Quad>> y = {}, rate = {};  ///< rate: dy/dt, for moments that differ by a rounding error
  std::vector<Quad> energy = {};                ///< total [energy]; empty where nothing tells it

  bool has_states() const { return !y.empty(); }
};

/// How far a truth is driven.
struct TruthOptions {
  double budget = 120;  ///< seconds of wall time for all settings together
  double most_evaluations = std::numeric_limits<double>::infinity();  ///< of forces, likewise
  double agreement = 2e-16;                                           ///< two runs that agree so well need no third
  std::optional<double> rtol = {};        ///< of the coarsest run of the first method; default: by the method
  std::function<void(double)> tell = {};  ///< is told which share of the budget is gone, from 0 to 1
};

}  // namespace noether
