#pragma once
/// `noether compare`: what accuracy costs on a scene, method by method.

#include "study/measure.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace noether {

struct CompareOptions {
  std::vector<std::string> methods = {};  ///< names as `candidate` reads them; empty: `default_opponents`
  std::vector<double> steps = {};         ///< of every method with fixed steps [time]; empty: a ladder for each
  std::vector<double> tolerances = {};    ///< of every adaptive method; empty: 1e-4 ... 1e-14
  std::optional<double> until = {};       ///< [time]; default: the scene's end, at most `longest_steps` of its steps
  int repeats = 3;
  double row_budget = 10;  ///< seconds of wall time for one run
  TruthOptions truth = {};
  std::function<void(const std::string&)> progress = {};  ///< told what is being done
};

/// A comparison over a scene's own length would take hours for long runs: it looks at so many of its steps.
inline constexpr std::int64_t longest_steps = 10'000;

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
  Truth truth = {};
  std::optional<std::size_t> reference = {};  ///< the row that is the truth, where that is the finest run
  bool position_measured = false;             ///< else the energy decides
  std::vector<Candidate> methods = {};
  std::vector<Row> rows = {};  ///< method by method, from coarse to fine
  std::vector<OrderFit> orders = {};

  /// The error that methods are compared by: of positions where there is a truth, else of the energy.
  std::optional<double> error_of(const Row& row) const {
    return position_measured ? row.position_error_max : row.energy_error_max;
  }
};

/// Runs every method with every step or tolerance.
/// @throws Error  for methods that are not known or cannot serve the scene, and for steps and tolerances that are none,
/// or that no method takes
Comparison compare(const Scene& scene, const CompareOptions& options = {});

/// The moments a scene is compared at. @throws Error  for a scene without an end, or one that runs backwards
Sampling sampling_of(const Scene& scene, const std::optional<double>& until);

/// The steps or tolerances an candidate is run with, from coarse to fine.
std::vector<Setting> settings_of(const Scene& scene, const Candidate& who, const Sampling& sampling,
                                 const CompareOptions& options);

}  // namespace noether
