#pragma once
/// `noether advise`: the cheapest method and step that hold an error, and what the full run will cost.

#include "study/compare.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace noether {

enum class Metric : std::uint8_t { position, energy };

struct AdviseOptions {
  double error = 0;  ///< largest relative error over the whole run
  Metric metric = Metric::position;
  std::vector<std::string> methods = {};  ///< as in a comparison
  double row_budget = 2;                  ///< seconds of wall time for one trial run
  TruthOptions truth = {.budget = 30};
  std::function<void(const std::string&)> progress = {};
};

/// How the error of one candidate grows along the run: error ~ t^exponent.
struct Growth {
  double exponent = 0;
  std::string assumption = {};  ///< in words
};

/// What an candidate would need to hold the error.
struct Proposal {
  Candidate who = {};
  Setting setting = {};
  double predicted_error = 0;
  double predicted_wall_s = 0;
  double predicted_evaluations = 0;
  Growth growth = {};
  std::vector<std::string> sets = {};  ///< "integrator.method=..." lines for `--set`
};

struct Advice {
  std::vector<Proposal> proposals = {};    ///< the cheapest first
  std::vector<std::string> sets = {};      ///< those of the cheapest one
  std::vector<std::string> left_out = {};  ///< methods that hold the error and that no lines can set, and why
  std::string reason = {};                 ///< why there is no proposal
  double end = 0, trial_end = 0;           ///< of the full run and of the trials [time]
  Comparison trials = {};
};

/// Compares methods on the scene, or its first part, fits error and cost against step, and carries both to its end.
///
/// Energy errors of symplectic methods with fixed steps are taken to stay bounded, those of others to grow at least
/// linearly; position errors grow by the exponent that was measured, at least linearly.
/// @throws Error  for an error that is none, a scene without an end, a metric that the scene cannot be measured by
Advice advise(const Scene& scene, const AdviseOptions& options);

/// The advice as one line of JSON, and for people.
std::string to_json(const Advice& advice, const Scene& scene);
std::string to_text(const Advice& advice, const Scene& scene);

}  // namespace noether
