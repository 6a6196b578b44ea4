#pragma once
/// A finished comparison of methods on a scene.

#include "study/allowance.hpp"
#include "study/measure.hpp"
#include "study/predictability.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether {

/// The order a method shows: the slope of its errors over the rows between coarse steps and rounding.
struct OrderFit {
  std::string label = {};
  bool adaptive = false;  ///< against evaluations instead of steps
  int rows = 0;           ///< how many it is fitted through
  std::optional<double> order = {}, error = {};
  std::string measured = {};  ///< "position" or "energy"
};

/// A finished comparison.
struct Comparison {
  std::string scene = {}, title = {}, time_unit = {}, hamiltonian = {}, command = {};
  std::string machine = {}, simd = {}, version = {}, commit = {}, date = {};
  int threads = 1;
  Index particles = 0;
  double end = 0;                        ///< of every run [time]
  std::optional<double> scene_end = {};  ///< of the scene itself, where it is longer
  Sampling sampling = {};
  std::string limits = {};  ///< why the runs are shorter than the scene, or what positions are worth, in words
  std::optional<Predictability> motion = {};  ///< where it was asked for
  Truth truth = {};
  std::optional<std::size_t> reference = {};  ///< the row that is the truth, where that is the finest run
  bool position_measured = false;             ///< else the energy decides
  Allowance work = {};  ///< evaluations of forces: of the scene's own run, and those taken by the comparison
  std::vector<Candidate> methods = {};
  std::vector<Row> rows = {};  ///< method by method, from coarse to fine
  std::vector<OrderFit> orders = {};

  /// The error that methods are compared by: of positions where there is a truth, else of the energy.
  std::optional<double> error_of(const Row& row) const {
    return position_measured ? row.position_error_max : row.energy_error_max;
  }
};

}  // namespace noether
