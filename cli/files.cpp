#include "cli/commands.hpp"

#include "io/compare_runs.hpp"
#include "io/ensemble_file.hpp"
#include "io/inspect.hpp"
#include "io/near_file.hpp"
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
  fmt::print("  {}, step {}, time {:.9g}{}\n",
             of_system ? counted(info.variables, "variable") : counted(info.particles, "particle"), info.last_step,
             info.last_time, info.time_unit.empty() || info.time_unit == "1" ? "" : " " + info.time_unit);
  if (!checkpoint) fmt::print("  {}\n", counted(info.frames, "frame"));
  for (const io::MonitorSummary& one : info.monitors) {
    fmt::print("  {}: {} of {}\n", one.name, counted(one.samples, "sample"), fmt::join(one.quantities, ", "));
  }
  fmt::print("  written by noether {} ({}), simd {}\n", info.version, info.commit, info.simd);
  if (!info.digest.empty()) fmt::print("  {}\n", info.digest);
}

Json json_of(const io::EnsembleTable& table) {
  const auto outcomes = io::outcomes_of(table.definition, table.rows);
  return Json::object({{"schema", "noether.info/1"},
                       {"kind", "ensemble"},
                       {"members", table.definition.members},
                       {"rows", static_cast<std::int64_t>(table.rows.size())},
                       {"shard", table.shard.shard},
                       {"shards", table.shard.shards},
                       {"vary", Json::list_of(table.definition.variations)},
                       {"outcomes", Json::object({outcomes.begin(), outcomes.end()})},
                       {"digest", table.digest()},
                       {"simd", table.definition.simd}});
}

void print_text(const std::string& file, const io::EnsembleTable& table) {
  fmt::print("{}: {} of an ensemble of {}\n", file,
             table.shard.whole() ? "all rows" : fmt::format("shard {} of {}", table.shard.shard, table.shard.shards),
             counted(table.definition.members, "member"));
  for (const std::string& one : table.definition.variations) fmt::print("  {}\n", one);
  for (const auto& [outcome, count] : io::outcomes_of(table.definition, table.rows)) {
    fmt::print("  {} {}\n", count, outcome);
  }
  fmt::print("  simd {}\n  {}\n", table.definition.simd, table.digest());
}

/// Mends a file in a folder that nobody else writes to.
io::Repair repair_alone(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file))
    throw FileError("there is no such file" + io::near_file(file, "run.h5"), {.file = file.string()});
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::optional<OutputFolder> locked;
  try {
    locked.emplace(folder);
  } catch (const SceneError&) {
    throw SceneError("a run is writing to this file; wait for it, then repair", {.file = folder.string()});
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
        cut ? fmt::format("; 'noether verify --repair {}' repairs it if only frames or samples are missing", file) : "";
    fmt::print(stderr, "{}\n", escaped(file + ": " + line + way));
  }
  return ok ? 0 : 3;
}

Json json_of(const io::RowComparison& rows) {
  Json first;
  if (rows.difference) {
    const io::RowDifference& d = *rows.difference;
    first = Json::object({{"step", d.step},
                          {"other_step", d.other_step},
                          {"time", d.time},
                          {"other_time", d.other_time},
                          {"dataset", d.dataset},
                          {"differing", std::int64_t{d.differing}},
                          {"numbers", std::int64_t{d.numbers}},
                          {"where", text_or_null(d.where)},
                          {"value", d.value},
                          {"other_value", d.other_value},
                          {"largest", d.largest}});
  }
  return Json::object({{"name", rows.name},
                       {"compared", std::int64_t{rows.compared}},
                       {"equal", std::int64_t{rows.equal}},
                       {"only_here", std::int64_t{rows.only_first}},
                       {"only_there", std::int64_t{rows.only_second}},
                       {"first", first}});
}

std::string text_of(const io::RowDifference& d, const std::string& unit) {
  std::string when = fmt::format("step {}, time {:.17g}{}", d.step, d.time, unit);
  if (d.other_step != d.step) when += fmt::format(" (step {} there)", d.other_step);
  if (d.other_time != d.time) when += fmt::format(" (time {:.17g}{} there)", d.other_time, unit);
  return fmt::format("at {}: {}, {} of {} numbers, the first{}{}: {:.17g} and {:.17g}; largest difference {:.2g}", when,
                     d.dataset, d.differing, d.numbers, d.where.empty() ? "" : " ", d.where, d.value, d.other_value,
                     d.largest);
}

/// Two runs beside each other, after both have been found sound.
int report_compared(const std::string& file, const std::string& other, const io::RunComparison& found,
                    const io::FileInfo& info, bool json) {
  const bool same = found.same();
  if (json) {
    std::vector<Json> rows;
    for (const io::RowComparison& one : found.rows) rows.push_back(json_of(one));
    fmt::print("{}\n", Json::object({{"schema", "noether.verify/1"},
                                     {"ok", same},
                                     {"complete", info.complete},
                                     {"damaged", Json::list({})},
                                     {"repaired", Json::list({})},
                                     {"last_step", info.last_step},
                                     {"digest", text_or_null(info.digest)},
                                     {"against", other},
                                     {"constants", Json::list_of(found.constants)},
                                     {"notes", Json::list_of(found.notes)},
                                     {"rows", Json::list(rows)}})
                           .text());
    return same ? 0 : 3;
  }
  const std::string unit = info.time_unit.empty() || info.time_unit == "1" ? "" : " " + info.time_unit;
  const std::string verdict = same                   ? "identical bit for bit wherever both have data"
                              : found.compared() > 0 ? "they differ"
                                                     : "the two have nothing in common to compare";
  fmt::print("{} and {}: {}\n", file, other, verdict);
  for (const io::RowComparison& one : found.rows) {
    fmt::print("  {}: {} compared, {} of them equal", one.name, one.compared, one.equal);
    if (one.only_first > 0) fmt::print("; {} only in the first", one.only_first);
    if (one.only_second > 0) fmt::print("; {} only in the second", one.only_second);
    fmt::print("\n");
  }
  for (const std::string& note : found.notes) fmt::print("  {}\n", escaped(note));
  for (const std::string& line : found.constants) fmt::print(stderr, "{}\n", escaped(file + ": " + line));
  for (const io::RowComparison& one : found.rows) {
    if (!one.difference) continue;
    fmt::print(stderr, "{}\n",
               escaped(fmt::format("{}: {} differ first from {} {}", file,
                                   one.name == "frames" ? "frames" : "samples of '" + one.name + "'", other,
                                   text_of(*one.difference, unit))));
  }
  return same ? 0 : 3;
}

struct FileArguments {
  std::string file, out, against, by = "time";
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
  CLI::App* command = file_command(app, "info", "what is in a file, and its digest",
                                   "run.h5, a checkpoint or the table of an ensemble", given);
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &exit_code] {
    exit_code = 0;
    if (io::holds_ensemble(given->file)) {
      const io::EnsembleTable table = io::read_ensemble(given->file);
      return given->json ? fmt::print("{}\n", json_of(table).text()) : print_text(given->file, table);
    }
    const io::FileInfo info = io::info(given->file);
    if (given->json) {
      fmt::print("{}\n", json_of(info).text());
    } else {
      print_text(given->file, info);
    }
  });
}

void add_verify_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<FileArguments>();
  CLI::App* command = file_command(app, "verify", "read everything in a file and say whether it is sound",
                                   "run.h5 or a checkpoint", given);
  command->add_flag("--json", given->json, "as one line of JSON");
  command->add_flag("--repair", given->repair, "cut run.h5 back to the last frame that is whole; nothing else is lost");
  CLI::Option* against = command->add_option("--against", given->against,
                                             "another run.h5: say where the two first differ, frame by frame and "
                                             "sample by sample, at the times that both have");
  against->type_name("FILE")->check(
      [](const std::string& file) { return std::string(file.empty() ? "the name of the file is empty" : ""); });
  command->add_option("--by", given->by, "what --against matches frames by: time, or step for runs from other starts")
      ->check(CLI::IsMember({"time", "step"}))
      ->needs(against);
  command->callback([given, &exit_code] {
    const io::Repair found = given->repair ? repair_alone(given->file) : io::Repair{io::verify(given->file), {}};
    if (given->against.empty() || !found.info.damaged.empty()) {
      exit_code = report_verified(given->file, found, given->repair, given->json);
      return;
    }
    const io::Repair other{io::verify(given->against), {}};
    if (!other.info.damaged.empty()) {
      exit_code = report_verified(given->against, other, false, given->json);
      return;
    }
    const auto by = given->by == "step" ? io::MatchBy::step : io::MatchBy::time;
    exit_code = report_compared(given->file, given->against, io::compare_runs(given->file, given->against, by),
                                found.info, given->json);
  });
}

void add_convert_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<FileArguments>();
  CLI::App* command = file_command(
      app, "convert", "rewrite a trajectory as extended XYZ, CSV or VTK, or a frame as bodies", "run.h5", given);
  command->add_option("out", given->out, "FILE.xyz, FILE.csv or FILE.vtu; of bodies FILE.h5 or FILE.csv")
      ->required()
      ->type_name("OUT");
  command->add_flag("--unwrapped", given->unwrapped,
                    "unwrapped positions, as if the periodic box had never wrapped them");
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
