#include "cli/commands.hpp"

#include "cli/shell_text.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"
#include "numbers/text.hpp"
#include "scene/run.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace noether {

namespace {

struct RunArguments {
  std::string scene, out;
  std::optional<std::string> simd, until;
  std::vector<std::string> sets;
  int threads = 0;
  bool resume = false, fresh = false, cost = false, quiet = false, json = false;
};

/// `--until T` goes where `--set integrator.until=T` would.
std::string as_set(const std::string& until) { return std::string(until_option) + until; }

/// What is wrong with a number of threads; "" if nothing.
std::string wrong_threads(const std::string& text) {
  int threads = 0;
  const char* end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, threads);
  if (error == std::errc() && read == end && threads >= 1 && threads <= 65536) return "";
  return fmt::format("'{}' is not a valid number of threads; give one from 1 to 65536", text);
}

/// How this program was called: by the launcher of a checkout, whose path is given from here where that is shorter.
std::string called_program() {
  const char* launcher = std::getenv("NOETHER_LAUNCHER");
  if (launcher == nullptr || *launcher == '\0') return program_invocation_name;
  std::error_code error;
  const std::filesystem::path from_here = std::filesystem::proximate(launcher, error);
  if (error || from_here.empty()) return launcher;
  const std::string near = from_here.has_parent_path() ? from_here.string() : "./" + from_here.string();
  return near.size() < std::strlen(launcher) ? near : launcher;
}

/// The command that goes on with an interrupted run, as it can be typed.
std::string resume_command(const RunArguments& given) {
  std::string line = fmt::format("{} run {}", shell_quoted(called_program()), shell_quoted(given.scene));
  const auto add = [&](const char* option, const std::string& value) {
    line += fmt::format(" {} {}", option, shell_quoted(value));
  };
  if (!given.out.empty()) add("--out", given.out);
  if (given.threads != 0) add("--threads", std::to_string(given.threads));
  if (given.simd) add("--simd", *given.simd);
  if (given.until) add("--until", *given.until);
  for (const std::string& set : given.sets) add("--set", set);
  if (given.cost) line += " --cost";
  return line + " --resume";
}

int run_scene(const RunArguments& given, const Parts& parts) {
  if (given.threads != 0) set_thread_count(given.threads);
  std::vector<std::string> sets = given.sets;
  if (given.until) sets.push_back(as_set(*given.until));
  SceneRun start = load_run(given.scene, parts, sets);
  RunOptions options;
  options.notes = !given.quiet;
  options.out = given.out;
  options.existing = given.resume ? Existing::resume : given.fresh ? Existing::fresh : Existing::keep;
  if (given.simd) options.simd = simd_level_named(*given.simd);
  options.progress = !given.quiet && !given.json;
  options.cost = given.cost;
  const RunReport report = run(std::move(start), options);
  const bool failed = report.exit_code() == 1;
  if (failed) fmt::print(stderr, "{}\n", escaped(to_text(report.outcome)));
  if (given.json) {
    fmt::print("{}\n", to_json(report));
  } else if (!given.quiet) {
    // What has gone wrong is told once: on stderr.
    fmt::print("{}\n{}", headline_of(report, !failed), details_of(report));
  }
  const bool interrupted = report.outcome.kind == Outcome::Kind::interrupted && !report.checkpoint.empty();
  if (interrupted && !given.json && !given.quiet) {
    std::fflush(stdout);
    fmt::print(stderr, "to continue: {}\n", escaped(resume_command(given)));
  }
  return report.exit_code();
}

}  // namespace

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads to use; the bits do not depend on it")
      ->check(wrong_threads)
      ->type_name("N");
}

void add_run_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "integrate a scene");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command->add_option("--out", given->out, "output folder; default: SCENE.out here, or NAME.out for NAME/scene.toml")
      ->check(
          [](const std::string& name) { return std::string(name.empty() ? "the name of the folder is empty" : ""); })
      ->type_name("DIR");
  add_threads_option(*command, given->threads);
  command
      ->add_option("--simd", given->simd, "SIMD level: base, avx2 or avx512; default: the highest this processor has")
      ->type_name("LEVEL");
  command->add_option("--until", given->until, "end of the run, such as \"1 Myr\"")
      ->check([](const std::string& time) {
        return std::string(time.empty() ? "the time is empty; give one, such as \"1 Myr\"" : "");
      })
      ->type_name("T");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  CLI::Option* resume = command->add_flag("--resume", given->resume, "continue from the newest checkpoint");
  command->add_flag("--fresh", given->fresh, "discard an unfinished run in the output folder")->excludes(resume);
  command->add_flag("--cost", given->cost, "tell the seconds that each force and every other part has taken");
  CLI::Option* quiet = command->add_flag("--quiet", given->quiet, "print nothing");
  command->add_flag("--json", given->json, "report as one line of JSON")->excludes(quiet);
  command->callback([given, &parts, &exit_code] { exit_code = run_scene(*given, parts); });
}

}  // namespace noether
