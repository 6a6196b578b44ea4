#include "study/ensemble_member.hpp"

#include "io/files.hpp"
#include "numbers/error.hpp"
#include "numbers/simd.hpp"
#include "scene/minimize.hpp"
#include "scene/set_option.hpp"
#include "scene/toml.hpp"
#include "scene/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <string_view>

namespace noether {

namespace {

constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();
using Figure = std::pair<const char*, std::optional<double> MonitorReport::*>;
constexpr Figure report_figures[] = {{"first", &MonitorReport::first}, {"last", &MonitorReport::last},
                                     {"worst", &MonitorReport::worst}, {"rms", &MonitorReport::rms},
                                     {"slope", &MonitorReport::slope}, {"slope_error", &MonitorReport::slope_error}};

constexpr auto last_kind = Outcome::Kind::inverted_element;
constexpr std::int64_t refused_outcome = static_cast<std::int64_t>(last_kind) + 1;

std::vector<std::string> outcome_names() {
  std::vector<std::string> names;
  for (std::int64_t k = 0; k < refused_outcome; ++k) names.emplace_back(name(static_cast<Outcome::Kind>(k)));
  names.emplace_back("refused");
  return names;
}

/// "sha256:<hex>" as four whole numbers.
io::RowDigest row_digest(std::string_view text) {
  text.remove_prefix(text.find(':') + 1);
  std::array<unsigned char, sizeof(io::RowDigest)> bytes{};
  for (std::size_t k = 0; k < bytes.size() && 2 * k + 1 < text.size(); ++k) {
    std::from_chars(text.data() + 2 * k, text.data() + 2 * k + 2, bytes[k], 16);
  }
  return std::bit_cast<io::RowDigest>(bytes);
}

SceneValue tree_of(const std::filesystem::path& file) { return parse_toml(io::read_bytes(file), file.string()); }

SceneValue with_sets(SceneValue root, const std::filesystem::path& file, const std::vector<std::string>& sets,
                     const Parts& parts) {
  apply_sets(root, {file.string(), sets}, parts);
  return root;
}

/// What a scene says of a change that it was given by --vary, not by --set.
std::string in_words_of_vary(const std::string& message, const std::vector<std::string>& sets,
                             const std::vector<Variation>& variations) {
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const std::string begin = "--set " + sets[k] + ": ";
    if (message.starts_with(begin))
      return fmt::format("--vary {}: {}", variations[k].text, message.substr(begin.size()));
  }
  return message;
}

std::vector<double> numbers_of(const VectorColumn<double>& column) {
  std::vector<double> numbers;
  for (Index i = 0; i < column.size(); ++i) {
    for (int k = 0; k < 3; ++k) numbers.push_back(column.component(k)[i]);
  }
  return numbers;
}

/// Monitors look, those of a scene without [[every]] too; nothing is written.
SceneFiles watched_only() {
  SceneFiles files;
  files.by_default = true;
  return files;
}

/// A monitor that rows have columns of; writers give none.
std::vector<io::EnsembleColumn> columns_of(const std::string& name, AnyMonitor<double>& monitor) {
  std::vector<io::EnsembleColumn> columns;
  if (monitor.records()) return columns;
  if (monitor.report()) {
    for (const auto& [figure, value] : report_figures) columns.push_back({.name = name + "_" + figure});
  }
  for (const Series& one : monitor.series()) {
    columns.push_back(
        {.name = name + "_" + one.name, .shape = one.shape, .dimension = one.dimension, .columns = one.columns});
  }
  return columns;
}

/// The numbers of a monitor by the names of its columns.
std::vector<std::pair<std::string, std::vector<double>>> values_of(const std::string& name,
                                                                   AnyMonitor<double>& monitor) {
  std::vector<std::pair<std::string, std::vector<double>>> values;
  if (monitor.records()) return values;
  if (const auto report = monitor.report()) {
    for (const auto& [figure, value] : report_figures) {
      values.emplace_back(name + "_" + figure, std::vector<double>{(*report.*value).value_or(no_figure)});
    }
  }
  for (Series& one : monitor.series()) values.emplace_back(name + "_" + one.name, std::move(one.values));
  return values;
}

}  // namespace

EnsembleScene::EnsembleScene(const std::filesystem::path& file, const EnsemblePlan& plan,
                             const std::vector<std::string>& sets, bool in_lanes, const Parts& parts)
    : file_(file),
      plan_(plan),
      sets_(sets),
      parts_(parts),
      root_((static_cast<void>(load_run(file, parts, sets)), tree_of(file))),
      keys_(with_sets(root_, file, sets, parts), plan.variations()) {
  const std::vector<double> typical = plan_.typical_values();
  SceneRun first = [&] {
    try {
      return read(typical);
    } catch (const SceneError& error) {
      throw SceneError(in_words_of_vary(error.message(), keys_.sets(typical), plan_.variations()), error.location());
    }
  }();
  const Scene scene = first.scene();
  if (!scene.integrator.steps && !scene.integrator.until) {
    throw SceneError("the scene has no end; give until or steps in [integrator]",
                     {.file = scene.source.file, .key = "integrator.until"});
  }
  definition_ = {.scene_toml = scene.effective_toml,
                 .variations = {},
                 .keys = {},
                 .grid = plan_.shape(),
                 .members = plan_.members(),
                 .seed = plan_.seed(),
                 .in_lanes = in_lanes,
                 .simd = std::string(name(simd_level())),
                 .columns = {},
                 .outcomes = outcome_names()};
  for (const Variation& one : plan_.variations()) {
    definition_.variations.push_back(one.text);
    definition_.keys.push_back(one.key);
  }
  notes_ = scene.notes;
  for (const std::string& warning : warnings_of(scene)) notes_.push_back(warning);
  Simulation<double> sim = first.assemble(watched_only());
  add_columns(sim, scene);
}

void EnsembleScene::add_columns(Simulation<double>& sim, const Scene& scene) {
  std::vector<io::EnsembleColumn>& columns = definition_.columns;
  static_cast<void>(sim.run(0));  // monitors look at the start: then they know what they have to tell
  sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
    for (io::EnsembleColumn& one : columns_of(name, monitor)) columns.push_back(std::move(one));
  });
  const ParticleSystem<double>& s = scene.particles;
  if (s.size() > 0) {
    columns.push_back({.name = "position", .shape = {s.size(), 3}, .dimension = "length"});
    columns.push_back({.name = "velocity", .shape = {s.size(), 3}, .dimension = "velocity"});
  } else {
    columns.push_back({.name = "variables", .shape = {std::ssize(s.variables())}});
  }
}

SceneRun EnsembleScene::read(const std::vector<double>& values) const {
  std::vector<std::string> sets = sets_;
  for (std::string& one : keys_.sets(values)) sets.push_back(std::move(one));
  return read_run(root_, file_, parts_, sets);
}

SceneRun EnsembleScene::member(std::int64_t member) const {
  SceneRun made = read(plan_.values(member));
  if (!made.scene().minimize) return made;
  Scene scene = made.scene();
  begin_at_minimum(scene);
  Simulation<double> start = detail::assemble_start(scene);
  return {std::move(scene), std::move(start)};
}

io::EnsembleRow EnsembleScene::row(std::int64_t member) const {
  io::EnsembleRow row{.member = member, .time = no_figure, .values = plan_.values(member)};
  row.values.resize(static_cast<std::size_t>(definition_.width()), no_figure);
  return row;
}

io::EnsembleRow EnsembleScene::refused(std::int64_t member) const {
  io::EnsembleRow made = row(member);
  made.outcome = refused_outcome;
  return made;
}

void EnsembleScene::end_row(
    io::EnsembleRow& row, const Outcome& outcome, const ParticleSystem<double>& settled,
    const std::function<void(const std::function<void(const std::string&, AnyMonitor<double>&)>&)>& for_each_monitor)
    const {
  row.outcome = static_cast<std::int64_t>(outcome.kind);
  row.step = outcome.step;
  row.time = outcome.time;
  if (outcome.particle) row.particle = outcome.particle->id;
  row.digest = row_digest(io::digest(settled));
  std::vector<std::pair<std::string, std::vector<double>>> found;
  for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
    for (auto& one : values_of(name, monitor)) found.push_back(std::move(one));
  });
  found.emplace_back("position", numbers_of(settled.positions()));
  found.emplace_back("velocity", numbers_of(settled.velocities()));
  found.emplace_back("variables", settled.variables());
  std::size_t at = definition_.keys.size();
  for (const io::EnsembleColumn& column : definition_.columns) {
    const auto width = static_cast<std::size_t>(column.width());
    for (const auto& [name, values] : found) {
      if (name != column.name || values.size() != width) continue;
      std::copy(values.begin(), values.end(), row.values.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    }
    at += width;
  }
}

std::optional<io::EnsembleRow> run_alone(const EnsembleScene& ensemble, std::int64_t member,
                                         const std::atomic<bool>* stop) {
  SceneRun start = ensemble.member(member);
  const SceneIntegrator integrator = start.scene().integrator;
  Simulation<double> sim = start.assemble(watched_only());
  sim.stop_on(stop);
  const Outcome outcome = integrator.until ? sim.run_until(*integrator.until) : sim.run(*integrator.steps);
  if (outcome.kind == Outcome::Kind::interrupted) return {};
  io::EnsembleRow row = ensemble.row(member);
  ensemble.end_row(row, outcome, sim.particles(), [&](const auto& visit) { sim.for_each_monitor(visit); });
  return row;
}

}  // namespace noether
