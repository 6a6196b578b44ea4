#include "cli/commands.hpp"

#include "cli/comma_lists.hpp"
#include "io/files.hpp"
#include "numbers/error.hpp"
#include "numbers/progress.hpp"
#include "scene/minimize.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "study/stability.hpp"
#include "study/suite.hpp"

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

struct StabilityArguments {
  std::string scene;
  std::optional<std::string> methods, out;
  std::vector<std::string> sets;
  double steps = 100'000;
  std::optional<double> budget;
  bool suite = false, nightly = false, json = false;
};

/// Writes a result into a folder that is there, for machines and for people. @return what was written, a line each
std::string write_report(const std::filesystem::path& folder, const char* json_name, const std::string& json,
                         const std::string& html) {
  io::write_and_sync(folder / json_name, json + "\n");
  io::write_and_sync(folder / "report.html", html);
  return fmt::format("wrote {}\nwrote {}\n", (folder / json_name).string(), (folder / "report.html").string());
}

void search_scene(const StabilityArguments& given, const Parts& parts) {
  Scene scene = load_scene(given.scene, parts, given.sets);
  begin_at_minimum(scene);
  tell_notes_and_warnings(scene);
  TerminalLine line(!given.json);
  StabilityOptions options;
  if (given.methods) options.methods = texts_in(*given.methods, "--methods");
  options.confirm_steps = static_cast<std::int64_t>(given.steps);
  if (given.budget) options.row_budget = *given.budget;
  options.progress = line.teller();
  if (given.out) io::make_folder(*given.out);
  const Stability found = find_stability(scene, options);
  line.clear();
  std::string written;
  if (given.out) written = write_report(*given.out, "stability.json", to_json(found), to_html(found));
  fmt::print("{}", given.json ? to_json(found) + "\n" : to_text(found) + written);
}

/// The verdicts of one scene, or of all that noether brings, into a report.
void run_verdicts(const StabilityArguments& given, const Parts& parts) {
  if (given.methods || !given.sets.empty()) {
    throw Error("--suite runs the methods and changes of its verdicts; leave --methods and --set out");
  }
  std::vector<std::filesystem::path> files = {given.scene};
  if (given.scene.empty()) files = suite_files(suite_folder());
  if (std::filesystem::is_directory(given.scene)) files = suite_files(given.scene);
  TerminalLine line(!given.json);
  SuiteOptions options;
  options.nightly = given.nightly;
  if (given.budget) options.row_budget = *given.budget;
  options.progress = line.teller();
  const std::filesystem::path folder = given.out.value_or("stability.out");
  io::make_folder(folder);
  const Suite suite = run_suite(files, options, parts);
  line.clear();
  const std::string written = write_report(folder, "suite.json", to_json(suite), to_html(suite));
  fmt::print("{}", given.json ? to_json(suite) + "\n" : to_text(suite) + written);
}

void answer(const StabilityArguments& given, const Parts& parts) {
  if (given.suite) return run_verdicts(given, parts);
  if (given.nightly) throw Error("--nightly belongs to --suite; give both, or leave it out");
  if (given.scene.empty()) throw Error("no scene is given; give one, or --suite for the scenes that come with noether");
  search_scene(given, parts);
}

}  // namespace

void add_stability_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<StabilityArguments>();
  CLI::App* command = app.add_subcommand("stability", "the largest stable step, method by method, against theory");
  command->add_option("scene", given->scene, "scene file")->type_name("SCENE");
  command->add_option("--methods", given->methods, "methods to test; default: those suited to this scene")
      ->type_name("A,B,...");
  command->add_option("--steps", given->steps, "steps of the runs that settle a limit; default: 100000")
      ->check(wrong_count)
      ->type_name("N");
  command
      ->add_option("--budget", given->budget, "seconds of wall time for one method; what is not settled then is marked")
      ->check(wrong_seconds)
      ->type_name("SECONDS");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--suite", given->suite,
                    "run the verdicts of the scene, or of the stiff and extreme scenes that come with noether");
  command->add_flag("--nightly", given->nightly, "with --suite: the long runs too");
  command
      ->add_option("--out", given->out,
                   "folder of a report in HTML and JSON; default: none, with --suite stability.out")
      ->check(wrong_folder)
      ->type_name("DIR");
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &parts, &exit_code] {
    answer(*given, parts);
    exit_code = 0;  // a row that could not be settled is a result
  });
}

}  // namespace noether
