#include "cli/commands.hpp"

#include "io/inspect.hpp"
#include "io/repair.hpp"
#include "numbers/error.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "scene/output_folder.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

namespace {

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json json_of(const io::FileInfo& info) {
  std::vector<Json> monitors;
  for (const io::MonitorSummary& one : info.monitors) {
    monitors.push_back(Json::object(
        {{"name", one.name}, {"quantities", Json::list_of(one.quantities)}, {"samples", std::int64_t{one.samples}}}));
  }
  return Json::object({{"schema", "noether.info/1"},
                       {"kind", info.kind},
                       {"complete", info.complete},
                       {"last_step", info.last_step},
                       {"last_time", info.last_time},
                       {"time_unit", info.time_unit},
                       {"particles", std::int64_t{info.particles}},
                       {"variables", std::int64_t{info.variables}},
                       {"frames", std::int64_t{info.frames}},
                       {"digest", text_or_null(info.digest)},
                       {"outcome", text_or_null(info.outcome)},
                       {"version", info.version},
                       {"commit", info.commit},
                       {"simd", info.simd},
                       {"units", text_or_null(info.units)},
                       {"monitors", Json::list(monitors)}});
}

void print_text(const std::string& file, const io::FileInfo& info) {
  const bool checkpoint = info.kind == "checkpoint";
  std::string state = info.complete ? "complete" : "not complete";
  if (checkpoint) state = info.outcome.empty() ? "of an unfinished run" : "of a run that is " + info.outcome;
  fmt::print("{}: {}, {}\n", file, info.kind, state);
  const bool of_system = info.variables > 0;
  fmt::print("  {} {}, step {}, time {:.9g}{}\n", of_system ? info.variables : info.particles,
             of_system ? "variables" : "particles", info.last_step, info.last_time,
             info.time_unit.empty() || info.time_unit == "1" ? "" : " " + info.time_unit);
  if (!checkpoint) fmt::print("  {} frames\n", info.frames);
  for (const io::MonitorSummary& one : info.monitors) {
    fmt::print("  {}: {} samples of {}\n", one.name, one.samples, fmt::join(one.quantities, ", "));
  }
  fmt::print("  written by noether {} ({}), simd {}\n", info.version, info.commit, info.simd);
  if (!info.digest.empty()) fmt::print("  {}\n", info.digest);
}

/// Mends a file in a folder that nobody else writes to.
io::Repair repair_alone(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw FileError("there is no such file", {.file = file.string()});
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::optional<OutputFolder> locked;
  try {
    locked.emplace(folder);
  } catch (const SceneError&) {
    throw SceneError("a run is writing here; wait for it, then repair", {.file = folder.string()});
  }
  return io::repair(file);
}

/// @param asked  whether a repair was asked for
int report_verified(const std::string& file, const io::Repair& found, bool asked, bool json) {
  const io::FileInfo& info = found.info;
  const bool ok = info.damaged.empty();
  if (json) {
    fmt::print("{}\n", Json::object({{"schema", "noether.verify/1"},
                                     {"ok", ok},
                                     {"complete", info.complete},
                                     {"damaged", Json::list_of(info.damaged)},
                                     {"repaired", Json::list_of(found.repaired)},
                                     {"last_step", info.last_step},
                                     {"digest", text_or_null(info.digest)}})
                           .text());
    return ok ? 0 : 3;
  }
  for (const std::string& line : found.repaired) fmt::print("{}: repaired: {}\n", file, escaped(line));
  if (ok)
    fmt::print("{}: sound{}, last step {}\n", file, info.complete ? " and complete" : ", not complete", info.last_step);
  for (const std::string& line : info.damaged) {
    const bool cut = !asked && line.starts_with("cut short: ");
    const std::string way =
        cut ? fmt::format("; 'noether verify --repair {}' mends it if no more than frames is missing", file) : "";
    fmt::print(stderr, "{}\n", escaped(file + ": " + line + way));
  }
  return ok ? 0 : 3;
}

struct FileArguments {
  std::string file, out;
  bool json = false, repair = false, unwrapped = false, bodies = false;
  std::optional<std::int64_t> frame;
};

CLI::App* file_command(CLI::App& app, const std::string& name, const std::string& help, const std::string& kinds,
                       const std::shared_ptr<FileArguments>& given) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("file", given->file, kinds)
      ->required()
      ->check([](const std::string& file) { return std::string(file.empty() ? "the name of the file is empty" : ""); })
      ->type_name("FILE");
  return command;
}

}  // namespace

void add_info_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<FileArguments>();
  CLI::App* command = file_command(app, "info", "what is in a file, and its digest", "run.h5 or a checkpoint", given);
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &exit_code] {
    const io::FileInfo info = io::info(given->file);
    if (given->json) {
      fmt::print("{}\n", json_of(info).text());
    } else {
      print_text(given->file, info);
    }
    exit_code = 0;
  });
}

void add_verify_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<FileArguments>();
  CLI::App* command = file_command(app, "verify", "read everything in a file and say whether it is sound",
                                   "run.h5 or a checkpoint", given);
  command->add_flag("--json", given->json, "as one line of JSON");
  command->add_flag("--repair", given->repair, "cut run.h5 back to the last frame that is whole; nothing else is lost");
  command->callback([given, &exit_code] {
    const io::Repair found = given->repair ? repair_alone(given->file) : io::Repair{io::verify(given->file), {}};
    exit_code = report_verified(given->file, found, given->repair, given->json);
  });
}

void add_convert_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<FileArguments>();
  CLI::App* command = file_command(app, "convert", "rewrite a trajectory as extended XYZ or CSV, or a frame as bodies",
                                   "run.h5", given);
  command->add_option("out", given->out, "FILE.xyz or FILE.csv; of bodies FILE.h5 or FILE.csv")
      ->required()
      ->type_name("OUT");
  command->add_flag("--unwrapped", given->unwrapped, "positions as if a periodic box had never taken them in");
  CLI::Option* bodies = command->add_flag("--bodies", given->bodies, "one frame, for bodies = \"OUT\" of a new scene");
  command->add_option("--frame", given->frame, "which frame, from 0; default: the last, -1")
      ->needs(bodies)
      ->type_name("N");
  command->add_flag("--json", given->json, "report as one line of JSON");
  command->callback([given, &exit_code] {
    const Index frames = io::convert(given->file, given->out,
                                     {.unwrapped = given->unwrapped, .bodies = given->bodies, .frame = given->frame});
    if (given->json) {
      fmt::print("{}\n",
                 Json::object({{"schema", "noether.convert/1"}, {"frames", std::int64_t{frames}}, {"file", given->out}})
                     .text());
    }
    exit_code = 0;
  });
}

}  // namespace noether
