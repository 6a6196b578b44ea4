#pragma once
/// `noether stability`: the largest step at which a method stays bounded on a scene, beside what linear theory says.

#include "numbers/progress.hpp"
#include "study/candidate.hpp"
#include "study/kepler_steps.hpp"
#include "study/linear_stability.hpp"
#include "study/spectrum.hpp"
#include "study/stability_trial.hpp"
#include "study/turning_steps.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// How a search goes.
struct StabilityOptions {
  std::vector<std::string> methods = {};  ///< names as `candidate` reads them; empty: `default_stability_methods`
  std::int64_t confirm_steps = 100'000;   ///< of the runs that settle a limit
  double row_budget = 20;                 ///< seconds of wall time for one method
  TellShare progress = {};
};

/// One method.
struct StabilityRow {
  Candidate who = {};
  std::optional<double> limit_step = {};  ///< first step that is not bounded [time]; none: bounded as far as searched
  std::optional<double> limit_h_omega = {};  ///< the same times omega; none where nothing oscillates
  LinearTheory theory = {};
  std::string reason = "none";                  ///< linear, resonance, solver, none, or not_settled before any limit
  int resonance = 0;                            ///< n of the n:1 resonance next to the limit; 0: none
  std::optional<double> gap_end = {};           ///< h omega from which runs are bounded again, if they are
  std::optional<double> bounded_until = {};     ///< h omega at which the budget was over before a limit was found
  std::optional<double> bounded_step = {};      ///< the same as a step, which a limit lies above [time]
  std::optional<double> recommended_step = {};  ///< [time]
  bool settled = true;                          ///< else the budget was over, and `message` tells what is known
  std::string message = {};
  std::int64_t scan_steps = 0;  ///< of each run of the scan
  std::int64_t steps = 0;       ///< in all runs together
  double seconds = 0;
};

/// A finished search.
struct Stability {
  std::string scene = {}, title = {}, time_unit = {};
  std::vector<std::string> decorators = {};  ///< around every method: then linear theory, of bare methods, says nothing
  Spectrum spectrum = {};
  Mode mode = {};
  bool linear = false;
  double growth_told = growth_threshold;  ///< in one step, where a run of a linear problem counts as unbounded
  /// When the solution itself is 100 times as large as at the start [time]: see `SolutionGrowth`.
  std::optional<double> solution_leaves = {};
  std::optional<KeplerSteps> kepler = {};    ///< where a method steps along Kepler arcs
  std::optional<TurningSteps> turning = {};  ///< where bodies turn
  std::vector<StabilityRow> rows = {};
};

/// The largest stable step of every method.
///
/// Of each, h omega goes upward by 2e-3 (from 10 on by 2 %) in runs of 300 to 1000 steps, as many as the budget
/// allows, then by 0.05 (from 10 on by 10 %) in runs of `confirm_steps`, and of linear theory's gaps and n:1 resonances
/// each is looked at whether the search meets it or not. Below the first unstable point a run of `confirm_steps` must
/// be bounded; if it is not, the search goes down, and up again in runs of that length. The limit is then found by
/// halving, to 1e-5 of omega h, and so is the end of the gap.
///
/// Where the solution itself leaves all bounds, as a body that falls or escapes, runs are judged up to when it does.
///
/// Recommended: the step of the accuracy that leapfrog has with 20 steps in the shortest period (see `LinearTheory`),
/// at most half the limit; along Kepler arcs, that of `KeplerSteps` instead; of turns axis by axis, no more than that
/// of `TurningSteps`. Of those, linear theory knows no limit: the unperturbed step is exact. Their resonances are with
/// the shortest period, n = 1 to 6.
/// @throws Error  for methods that are not known, cannot serve the scene, or have no fixed steps; for a scene at rest
/// @cost a few seconds for each method on a few bodies
Stability find_stability(const Scene& scene, const StabilityOptions& options = {});

/// Methods worth asking on a scene, its own first: those that can serve it with fixed steps.
std::vector<std::string> default_stability_methods(const Scene& scene);

/// The candidate of a name, with fixed steps. @throws Error  as `candidate`, and for methods that choose their steps
Candidate fixed_candidate(const Scene& scene, const std::string& name);

/// As one line of JSON: the schema noether.stability/1.
std::string to_json(const Stability& found);
/// As a table.
std::string to_text(const Stability& found);
/// As a page of HTML that stands alone: limits beside theory as a picture, and in figures.
std::string to_html(const Stability& found);

/// What is known of Kepler arcs, in sentences; none where no method steps along them.
std::vector<std::string> kepler_lines(const Stability& found);

/// What is known of turns, in a sentence; none where no body turns.
std::vector<std::string> turning_lines(const Stability& found);

/// That the solution itself leaves all bounds, in a sentence; none where it does not.
std::vector<std::string> growth_lines(const Stability& found);

/// Why a row has its limit, in words: "linear", "resonance 3:1", "solver, not settled", "not settled".
std::string reason_text(const StabilityRow& row);
/// The limit of a row as a step, "> 1.8" where only a bound below it is known; `none` where there is neither.
std::string limit_step_text(const StabilityRow& row, int digits, std::string_view none);

/// Whether a settled limit is off the linear one, or that of the method's solver, by more than 1 %, or only one of the
/// two is there.
bool differs_from_theory(const StabilityRow& row);

}  // namespace noether
