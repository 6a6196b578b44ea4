#include "cli/commands.hpp"

#include "cli/comma_lists.hpp"
#include "cli/shell_text.hpp"
#include "numbers/error.hpp"
#include "numbers/progress.hpp"
#include "scene/minimize.hpp"
#include "scene/output_folder.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "study/compare_files.hpp"
#include "study/report.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

namespace {

struct CompareArguments {
  std::string scene, out;
  std::optional<std::string> methods, steps, tolerances, until;
  std::vector<std::string> sets;
  double repeat = 3, budget = 10, truth_budget = 120;
  bool quiet = false, json = false;
};

/// The command as it can be typed again.
std::string command_line(const CompareArguments& given) {
  std::string line = "noether compare " + shell_quoted(given.scene);
  const auto add = [&](const char* option, const std::string& value) {
    line += fmt::format(" {} {}", option, shell_quoted(value));
  };
  if (given.methods) add("--methods", *given.methods);
  if (given.steps) add("--steps", *given.steps);
  if (given.tolerances) add("--tolerances", *given.tolerances);
  if (given.until) add("--until", *given.until);
  for (const std::string& set : given.sets) add("--set", set);
  return line + fmt::format(" --repeat {:.0f} --budget {:g} --truth-budget {:g}", given.repeat, given.budget,
                            given.truth_budget);
}

std::filesystem::path folder_of(const CompareArguments& given) {
  if (!given.out.empty()) return given.out;
  return default_output_folder(given.scene);
}

void compare_scene(const CompareArguments& given, const Parts& parts) {
  Scene scene = load_scene(given.scene, parts, given.sets);
  begin_at_minimum(scene);
  if (!given.quiet) tell_notes_and_warnings(scene);
  CompareOptions options;
  if (given.methods) options.methods = texts_in(*given.methods, "--methods");
  if (given.steps) options.steps = times_in(*given.steps, "--steps", *scene.units);
  if (given.tolerances) options.tolerances = numbers_in(*given.tolerances, "--tolerances");
  if (given.until) options.until = times_in(*given.until, "--until", *scene.units).front();
  options.repeats = static_cast<int>(given.repeat);
  options.row_budget = given.budget;
  options.truth.budget = given.truth_budget;
  TerminalLine line(!given.quiet && !given.json);
  options.progress = line.teller();
  Comparison comparison = compare(scene, options);
  comparison.command = command_line(given);
  const std::string report = report_html(comparison, solution_of(scene, comparison));
  line.clear();
  const CompareFiles files = write_files(comparison, folder_of(given), report);
  if (given.json) {
    fmt::print("{}\n", to_json(comparison, files));
  } else if (!given.quiet) {
    fmt::print("{}wrote {}\nwrote {}\nwrote {}\n", to_text(comparison), files.csv.string(), files.json.string(),
               files.report.string());
  }
}

}  // namespace

void add_compare_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "error against run time, method by method");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command->add_option("--methods", given->methods, "methods to compare; default: those suited to this scene")
      ->type_name("A,B,...");
  command->add_option("--steps", given->steps, "steps of methods with fixed steps, such as \"50 day,100 day\"")
      ->type_name("H,...");
  command->add_option("--tolerances", given->tolerances, "relative tolerances of adaptive methods")->type_name("E,...");
  command
      ->add_option("--until", given->until,
                   "time at which each run ends; default: the scene's end, or 10000 of its steps")
      ->type_name("T");
  command->add_option("--repeat", given->repeat, "timed runs of each row; their median is reported")
      ->check(wrong_count)
      ->type_name("K");
  command
      ->add_option("--budget", given->budget,
                   "seconds of wall time for one run; a run that is not finished then is reported as such")
      ->check(wrong_seconds)
      ->type_name("SECONDS");
  command->add_option("--truth-budget", given->truth_budget, "seconds of wall time for the reference")
      ->check(wrong_seconds)
      ->type_name("SECONDS");
  command->add_option("--out", given->out, "output folder; default: SCENE.out here, or NAME.out for NAME/scene.toml")
      ->check(wrong_folder)
      ->type_name("DIR");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  CLI::Option* quiet = command->add_flag("--quiet", given->quiet, "print nothing");
  command->add_flag("--json", given->json, "report as one line of JSON")->excludes(quiet);
  command->callback([given, &parts, &exit_code] {
    compare_scene(*given, parts);
    exit_code = 0;  // a row that has failed is a result
  });
}

}  // namespace noether
