#pragma once
/// `noether stability --suite`: stiff and extreme scenes with their verdicts, run and judged.

#include "study/stability.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// One run of one verdict.
struct SuiteRow {
  std::string scene = {}, title = {}, method = {}, why = {};
  std::vector<std::string> sets = {};        ///< changes of the scene, "key=value"
  std::string expected = {};                 ///< bounded, unbounded or solver, and bounds of errors
  std::string found = {};                    ///< the same, or unsettled
  std::optional<double> h_omega = {};        ///< of fixed steps, at the start
  std::optional<double> energy_error = {};   ///< largest relative error over the run
  std::optional<double> sharing_error = {};  ///< see `Suite`
  bool accurate = true;                      ///< no error is beyond a bound of the verdict
  bool agrees = false;
  std::string message = {};  ///< how the run ended, or why it could not begin
  std::int64_t steps = 0;
  double seconds = 0;
};

struct SuiteOptions {
  bool nightly = false;    ///< the verdicts of long runs too
  double row_budget = 60;  ///< seconds of wall time for one run; ten times as much for long ones
  TellShare progress = {};
};

/// A finished suite.
///
/// The sharing error is for scenes whose particles trade energy: of the mean kinetic energy of each particle over the
/// second half of the run, the largest difference from that of a run by `dop853` with rtol = 1e-10, over the sum of
/// all.
struct Suite {
  std::vector<SuiteRow> rows = {};

  std::size_t agreeing() const;
};

/// The folder of scenes that noether brings: `study/suite` of the source tree that the program was built in, or
/// `share/noether/suite` beside an installed one, or in an installed Python package.
/// @throws Error  if neither is there
std::filesystem::path suite_folder();

/// The scenes of a folder, in the order of their names. @throws FileError  if there are none
std::vector<std::filesystem::path> suite_files(const std::filesystem::path& folder);

/// Runs every verdict of the scenes. @throws Error  for a scene without verdicts, and for what cannot be read
Suite run_suite(const std::vector<std::filesystem::path>& scenes, const SuiteOptions& options = {},
                const Parts& parts = standard_parts());

/// What linear theory expects of a step on the fastest mode of a scene: bounded or unbounded; solver where the method
/// cannot solve its own step on the mode; empty where theory says nothing.
std::string expected_by_theory(const Scene& scene, const Candidate& who, double step);

/// As one line of JSON: the schema noether.stability_suite/1.
std::string to_json(const Suite& suite);
/// As a table.
std::string to_text(const Suite& suite);
/// As a page of HTML that stands alone.
std::string to_html(const Suite& suite);

}  // namespace noether
