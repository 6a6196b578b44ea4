#pragma once
/// `noether compare`: what accuracy costs on a scene, method by method.

#include "numbers/progress.hpp"
#include "study/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether {

struct CompareOptions {
  std::vector<std::string> methods = {};  ///< names as `candidate` reads them; empty: `default_opponents`
  std::vector<double> steps = {};         ///< of every method with fixed steps [time]; empty: a ladder for each
  std::vector<double> tolerances = {};    ///< of every adaptive method; empty: 1e-4 ... 1e-14
  std::optional<double> until = {};       ///< by the clock [time]; default: the end, at most `longest_steps` steps on
  int repeats = 3;
  double row_budget = 10;  ///< seconds of wall time for one run
  TruthOptions truth = {};
  bool positions = true;       ///< else errors are those of the energy, and no truth is looked for where that is kept
  bool quick = false;          ///< for advice: no shadow Hamiltonian, rough times of longer runs
  bool until_at_most = false;  ///< runs may end before `until`, as they may where it is not given
  std::optional<Allowance> work =
      {};                   ///< what was spent before, and all that may be; default: `allowance_of` the scene
  TellShare progress = {};  ///< told what is being done
};

/// A comparison over a scene's own length would take hours for long runs: it looks at so many of its steps.
inline constexpr std::int64_t longest_steps = 10'000;

/// Rows of an advice on a run that is itself too short for all of them.
inline constexpr int fewest_rows = 3;

/// Runs every method with every step or tolerance.
///
/// Unless `until` is given, runs end earlier where all of them together would take more evaluations of forces than the
/// scene's own run (`allowance_of`), but not before 80 of its steps, and are looked at fewer times, so that every row
/// keeps its step; for advice, where 200 are too many, three rows over 100 steps are made of as many methods as there
/// is work for, one at least. More than `most_bodies` particles are compared at 40 moments instead of 200, and half as
/// far until runs fit their budget; where roundings would grow beyond 1e-8, as in every liquid, up to where they have
/// not; unless `until` is given. `Comparison::limits` says so.
/// There the reference is one in double precision.
/// @throws Error  for methods that are not known or cannot serve the scene, and for steps and tolerances that are none,
/// or that no method takes
Comparison compare(const Scene& scene, const CompareOptions& options = {});

/// The moments a scene is compared at. @throws Error  for a scene without an end, or one that runs backwards
Sampling sampling_of(const Scene& scene, const std::optional<double>& until);

/// The steps or tolerances an candidate is run with, from coarse to fine.
std::vector<Setting> settings_of(const Scene& scene, const Candidate& who, const Sampling& sampling,
                                 const CompareOptions& options);

}  // namespace noether
