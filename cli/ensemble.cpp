#include "cli/commands.hpp"

#include "io/ensemble_file.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"
#include "numbers/progress.hpp"
#include "numbers/simd.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"
#include "scene/warnings.hpp"
#include "study/ensemble.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

namespace {

struct EnsembleArguments {
  std::string scene;
  std::vector<std::string> variations, sets;
  std::optional<std::string> members, seed, shard, simd;
  std::string out;
  int threads = 0;
  bool fresh = false, json = false;
};

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<std::int64_t> whole_number(const std::optional<std::string>& text, const char* option) {
  if (!text) return {};
  const std::optional<std::int64_t> value = whole_number(std::string_view(*text));
  if (!value) throw Error(fmt::format("{} {} is not valid; a whole number is expected", option, *text));
  return value;
}

io::EnsembleShard shard_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto shard = whole_number(std::string_view(text).substr(0, slash));
  const auto shards =
      slash == std::string::npos ? std::nullopt : whole_number(std::string_view(text).substr(slash + 1));
  if (!shard || !shards) throw Error(fmt::format("--shard {} is not valid; k/N is expected, such as 0/4", text));
  return {*shard, *shards};
}

/// The shard that mpirun, mpiexec or srun has given to this process, and who has; none outside them.
std::optional<std::pair<io::EnsembleShard, std::string>> shard_of_environment() {
  constexpr std::pair<const char*, const char*> launchers[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                                               {"PMI_RANK", "PMI_SIZE"},
                                                               {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"},
                                                               {"SLURM_PROCID", "SLURM_NTASKS"}};
  for (const auto& [rank, size] : launchers) {
    const char *const shard = std::getenv(rank), *const shards = std::getenv(size);
    if (shard == nullptr || shards == nullptr) continue;
    const auto k = whole_number(std::string_view(shard)), n = whole_number(std::string_view(shards));
    if (!k || !n)
      throw Error(fmt::format("{}={} of {}={} is not a valid rank; give --shard k/N", rank, shard, size, shards));
    return std::pair(io::EnsembleShard{*k, *n}, std::string(rank));
  }
  return {};
}

EnsemblePlan plan_of(const EnsembleArguments& given) {
  std::vector<Variation> variations;
  for (const std::string& text : given.variations) variations.push_back(Variation::parse(text));
  return {std::move(variations), whole_number(given.members, "--members"),
          whole_number(given.seed, "--seed").value_or(0)};
}

int make_ensemble(const EnsembleArguments& given, const Parts& parts) {
  if (given.threads != 0) set_thread_count(given.threads);
  if (given.simd) set_simd_level(simd_level_named(*given.simd));
  EnsembleOptions options;
  options.out = given.out;
  options.fresh = given.fresh;
  options.sets = given.sets;
  options.handle_signals = true;
  if (given.shard) {
    options.shard = shard_of(*given.shard);
  } else if (const auto found = shard_of_environment()) {
    options.shard = found->first;
    if (!options.shard.whole()) {
      fmt::print(stderr, "note: {} says that this is shard {} of {}\n", found->second, options.shard.shard,
                 options.shard.shards);
    }
  }
  const EnsemblePlan plan = plan_of(given);
  TerminalLine line(!given.json);
  options.progress = line.teller();
  const EnsembleReport report = run_ensemble(given.scene, plan, options, parts);
  line.clear();
  tell_notes(report.notes);
  fmt::print("{}", given.json ? to_json(report) + "\n" : to_text(report));
  if (!report.interrupted) return 0;
  std::fflush(stdout);
  if (!given.json) fmt::print(stderr, "to continue: give the same command again\n");
  return 130;
}

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
  bool json = false;
};

/// @throws SceneError  where a file of something else would be replaced
void check_replaced(const std::filesystem::path& out, const io::EnsembleDefinition& definition) {
  if (!std::filesystem::exists(out)) return;
  std::string why = "it is not that of an ensemble";
  if (io::holds_ensemble(out)) {
    const io::EnsembleDefinition there = io::read_ensemble(out).definition;
    if (there.digest() == definition.digest()) return;
    why = "it is of another ensemble: " + io::difference_of(there, definition);
  }
  throw SceneError(fmt::format("the file is there already, and {}; give another one with --out", why),
                   {.file = out.string()});
}

void merge(const MergeArguments& given) {
  const io::EnsembleTable table =
      io::merge_ensembles(std::vector<std::filesystem::path>(given.shards.begin(), given.shards.end()));
  check_replaced(given.out, table.definition);
  io::write_ensemble(given.out, table);
  if (given.json) {
    fmt::print("{}\n", Json::object({{"schema", "noether.merge/1"},
                                     {"file", given.out},
                                     {"shards", static_cast<std::int64_t>(given.shards.size())},
                                     {"members", table.definition.members},
                                     {"digest", table.digest()}})
                           .text());
    return;
  }
  fmt::print("{} of {}\nwrote {}\n{}\n", counted(table.definition.members, "member"),
             counted(std::ssize(given.shards), "shard"), given.out, table.digest());
}

std::string wrong_file(const std::string& name) { return name.empty() ? "the name of the file is empty" : ""; }

}  // namespace

void add_ensemble_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<EnsembleArguments>();
  CLI::App* command = app.add_subcommand("ensemble", "run a scene many times, with other values in each member");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command
      ->add_option("--vary", given->variations,
                   "a key and its values: KEY=a:b:n for n points from a to b, KEY=uniform(a,b) or KEY=normal(m,s)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUES");
  command->add_option("--members", given->members, "how often to draw, at each point of the grids")->type_name("N");
  command->add_option("--seed", given->seed, "of the draws; default: 0")->type_name("S");
  command->add_option("--out", given->out, "file of the table; default: SCENE.ensemble.h5 here")
      ->check(wrong_file)
      ->type_name("FILE");
  command
      ->add_option("--shard", given->shard,
                   "make only members k, k + N, ... (k from 0), into FILE.k-of-N; default: as mpirun or srun says")
      ->type_name("K/N");
  add_threads_option(*command, given->threads);
  command
      ->add_option("--simd", given->simd, "SIMD level: base, avx2 or avx512; default: the highest this processor has")
      ->type_name("LEVEL");
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--fresh", given->fresh, "discard what is there of this or another ensemble");
  command->add_flag("--json", given->json, "report as one line of JSON");
  command->callback([given, &parts, &exit_code] { exit_code = make_ensemble(*given, parts); });
}

void add_merge_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  const auto given = std::make_shared<MergeArguments>();
  CLI::App* command = app.add_subcommand("merge", "put the shards of an ensemble into one file");
  command->add_option("shards", given->shards, "files of all shards")->required()->type_name("SHARDS");
  command->add_option("--out", given->out, "file of the whole table")->required()->check(wrong_file)->type_name("FILE");
  command->add_flag("--json", given->json, "report as one line of JSON");
  command->callback([given, &exit_code] {
    merge(*given);
    exit_code = 0;
  });
}

}  // namespace noether
