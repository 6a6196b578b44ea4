#pragma once
/// `noether advise`: the cheapest method and step that hold an error, and what the full run will cost.

#include "numbers/progress.hpp"
#include "study/compare.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

enum class Metric : std::uint8_t { position, energy };

struct AdviseOptions {
  double error = 0;  ///< largest relative error over the whole run
  /// Default: of positions, where they can be held so well over the whole run; else, as in a liquid, of the energy.
  std::optional<Metric> metric = {};
  std::vector<std::string> methods = {};  ///< as in a comparison
  double row_budget = 2;                  ///< seconds of wall time for one trial run
  TruthOptions truth = {.budget = 30};
  TellShare progress = {};
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
  double order = 0;                    ///< by which the error falls with the step, or with the tolerance
};

struct Advice {
  std::vector<Proposal> proposals = {};    ///< the cheapest first
  std::vector<std::string> sets = {};      ///< those of the cheapest one
  std::vector<std::string> left_out = {};  ///< methods that hold the error and that no lines can set, and why
  std::string reason = {};                 ///< why there is no proposal
  Metric metric = Metric::position;
  std::optional<double> trials_until = {};  ///< when the trials end, by the clock [time]; default: as comparisons do
  std::string metric_reason = {};           ///< why this metric was taken, where nobody chose one
  std::optional<Proposal> best = {};        ///< without a proposal: the run with the smallest error that was measured
  double best_error = 0;                    ///< its error over the trial
  std::optional<Proposal> would_hold = {};  ///< without a proposal: beyond what was tried, by the measured order
  std::vector<std::string> hints = {};      ///< what else there is to know, or to be done, in sentences
  double end = 0, trial_end = 0;            ///< of the full run and of the trials [time]
  Comparison trials = {};
};

/// Compares methods on the scene, or its first part, fits error and cost against step, and carries both to its end.
///
/// Energy errors of symplectic methods with fixed steps are taken to stay bounded, those of others to grow at least
/// linearly; position errors grow by the exponent that was measured, at least linearly, and where the motion is chaotic
/// as small differences do.
/// @throws Error  for an error that is none, a scene without an end, a metric that the scene cannot be measured by
Advice advise(const Scene& scene, const AdviseOptions& options);

/// The advice as one line of JSON, and for people.
std::string to_json(const Advice& advice, const Scene& scene);
std::string to_text(const Advice& advice, const Scene& scene);

}  // namespace noether
