#include "cli/commands.hpp"

#include "cli/comma_lists.hpp"
#include "numbers/error.hpp"
#include "numbers/progress.hpp"
#include "numbers/suggest.hpp"
#include "scene/minimize.hpp"
#include "scene/reader.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "study/advise.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

namespace {

struct AdviseArguments {
  std::string scene, error, metric;
  std::optional<std::string> methods, until;
  std::vector<std::string> sets;
  double budget = 2;
  bool json = false;
};

void advise_scene(const AdviseArguments& given, const Parts& parts) {
  AdviseOptions options;
  options.error = numbers_in(given.error, "--error").front();
  if (given.metric == "energy") options.metric = Metric::energy;
  if (given.metric == "position") options.metric = Metric::position;
  if (given.methods) options.methods = texts_in(*given.methods, "--methods");
  options.row_budget = given.budget;
  std::vector<std::string> sets = given.sets;
  if (given.until) sets.push_back(std::string(until_option) + *given.until);
  Scene scene = load_scene(given.scene, parts, sets);
  begin_at_minimum(scene);
  tell_notes_and_warnings(scene);
  TerminalLine line(!given.json);
  options.progress = line.teller();
  const Advice advice = advise(scene, options);
  line.clear();
  if (given.json) {
    fmt::print("{}\n", to_json(advice, scene));
  } else {
    fmt::print("{}", to_text(advice, scene));
  }
}

}  // namespace

void add_advise_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<AdviseArguments>();
  CLI::App* command = app.add_subcommand("advise", "the cheapest method and step that hold an error");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command->add_option("--error", given->error, "largest relative error over the whole run, such as 1e-9")
      ->required()
      ->check([](const std::string& text) {
        return std::string(text.find(',') == std::string::npos ? "" : "'" + text + "' is not a number; give one error");
      })
      ->type_name("E");
  command
      ->add_option("--metric", given->metric,
                   "position or energy; default: position where it can be held over the run, else energy")
      ->check([](const std::string& text) {
        if (text == "position" || text == "energy") return std::string();
        return fmt::format("unknown metric '{}'{}", text, did_you_mean(text, {"position", "energy"}));
      })
      ->type_name("METRIC");
  command->add_option("--methods", given->methods, "methods to choose from; default: those suited to this scene")
      ->type_name("A,B,...");
  command->add_option("--until", given->until, "end of the run that is to hold the error; default: the scene's end")
      ->check([](const std::string& time) {
        return std::string(time.empty() ? "the time is empty; give one, such as \"1 Myr\"" : "");
      })
      ->type_name("T");
  command->add_option("--budget", given->budget, "seconds of wall time for one trial run")
      ->check(wrong_seconds)
      ->type_name("SECONDS");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &parts, &exit_code] {
    advise_scene(*given, parts);
    exit_code = 0;
  });
}

}  // namespace noether
