#pragma once
/// A scene, run as the program runs it: output folder, checkpoints, resume, signals, report.

#include "numbers/cost_book.hpp"
#include "numbers/simd.hpp"
#include "scene/output_folder.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

struct RunOptions {
  std::filesystem::path out = {};  ///< empty: `default_output_folder` of the scene
  Existing existing = Existing::keep;
  bool handle_signals = true;    ///< SIGINT and SIGTERM end the run after its step
  bool progress = false;         ///< a line on stderr, if that is a terminal
  bool notes = false;            ///< what is done otherwise than written, and what is moved away, told on stderr
  bool cost = false;             ///< the report tells what each part has cost
  double checkpoint_wall = 300;  ///< seconds between checkpoints
  /// Level of the lane kernels, set for the whole process; default: that of a run gone on with, else the highest.
  std::optional<SimdLevel> simd = {};
  /// Called about ten times a second instead of showing a line; for programs and other languages.
  std::function<void(const Progress&)> tell = {};
  const std::atomic<bool>* stop = nullptr;  ///< ends the run after its step, where signals are not handled here
};

/// Everything a run has to say at its end.
struct RunReport {
  Outcome outcome;
  std::string scene, scene_sha256;  ///< as typed; hash of the effective scene
  std::string epoch;                ///< of the bodies of a Horizons table, "JD 2451545 TDB"; else empty
  std::string method, hamiltonian, time_unit, simd, digest;
  double dt = 0, start_time = 0;  ///< the step, and what the clock showed at step 0 [time]
  Index particles = 0;
  int threads = 1;
  std::optional<std::int64_t> resumed_from_step;
  std::optional<Minimized> minimized;  ///< how the start was found, where the scene asks for it
  std::string force_unit;
  std::vector<std::string> warnings;  ///< what the scene brings and nothing looks at
  std::vector<std::string> notes;     ///< what was taken otherwise than written, and what was moved away
  std::int64_t steps_made = 0;        ///< in `wall_s`
  double wall_s = 0;                  ///< from the first step to the last
  Evaluations evaluations;
  std::optional<ConstraintMethod> solver;  ///< of its constraints, where it has some
  std::vector<CostBook::Entry> cost;       ///< seconds by part, the largest first; empty unless asked for
  std::vector<std::pair<std::string, MonitorReport>> monitors;
  std::filesystem::path trajectory, checkpoint;  ///< empty if there is none

  int exit_code() const { return noether::exit_code(outcome); }
};

/// The report as one line of JSON: the schema noether.run/1.
std::string to_json(const RunReport& report);
/// The report for people, several lines: `headline_of` and `details_of`.
std::string to_text(const RunReport& report);
/// How the run ended, in a line: "completed at step 100, time 1". @param why  with what ended it
std::string headline_of(const RunReport& report, bool why = true);
/// The other lines.
std::string details_of(const RunReport& report);

/// Runs a scene to its end, or goes on with an interrupted run.
/// @throws SceneError for what cannot be done, FileError for what cannot be read or written
RunReport run(SceneRun start, const RunOptions& options);
/// The same of a scene that may have been changed since it was read: its run is put together anew.
RunReport run(const Scene& scene, const RunOptions& options);

}  // namespace noether
