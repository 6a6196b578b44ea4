#include "io/compare_runs.hpp"

#include "io/inspect.hpp"
#include "io/trajectory_groups.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_reader.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

namespace noether::io {

namespace {

/// When the rows of a group were written.
struct Moments {
  std::vector<std::int64_t> step;
  std::vector<double> time;
};

Moments moments_of_frames(const TrajectoryReader& reader) {
  const Hdf5File& file = reader.file();
  const std::string group = file.has(system_path) ? system_path : particles_path + "/position";
  Moments moments;
  if (reader.frames() == 0) return moments;
  moments.step = file.open(group + "/step").read_integers();
  moments.time = file.open(group + "/time").read_reals();
  moments.step.resize(static_cast<std::size_t>(reader.frames()));
  moments.time.resize(static_cast<std::size_t>(reader.frames()));
  return moments;
}

/// The rows by what they are matched by, in their order: steps of a method's own length may have several.
std::map<std::int64_t, std::vector<std::size_t>> rows_by(const Moments& moments, MatchBy by) {
  std::map<std::int64_t, std::vector<std::size_t>> rows;
  for (std::size_t k = 0; k < moments.step.size(); ++k) {
    const double time = moments.time[k] == 0 ? 0.0 : moments.time[k];  // 0 has two signs
    rows[by == MatchBy::step ? moments.step[k] : std::bit_cast<std::int64_t>(time)].push_back(k);
  }
  return rows;
}

/// Pairs of rows, in the order of the first file. Rows that share a step are matched one by one, if both files have it
/// equally often; else nothing tells which belong together, and they are left out.
std::vector<std::pair<std::size_t, std::size_t>> matched(const Moments& a, const Moments& b, MatchBy by) {
  const auto rows = rows_by(a, by), others = rows_by(b, by);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [key, mine] : rows) {
    const auto found = others.find(key);
    if (found == others.end() || found->second.size() != mine.size()) continue;
    for (std::size_t k = 0; k < mine.size(); ++k) pairs.emplace_back(mine[k], found->second[k]);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Numbers of one dataset at one moment, of both files, and how its numbers are called.
struct Pair {
  std::string dataset;
  std::vector<double> a, b;
  std::function<std::string(std::size_t)> name = {};
};

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// How the numbers of a dataset differ; empty where they are the same.
std::optional<RowDifference> difference_of(const Pair& pair) {
  RowDifference found;
  found.dataset = pair.dataset;
  if (pair.a.size() != pair.b.size()) {
    found.where = fmt::format("{} numbers and {}", pair.a.size(), pair.b.size());
    found.numbers = found.differing = static_cast<Index>(std::max(pair.a.size(), pair.b.size()));
    return found;
  }
  found.numbers = static_cast<Index>(pair.a.size());
  for (std::size_t k = 0; k < pair.a.size(); ++k) {
    if (same_bits(pair.a[k], pair.b[k])) continue;
    if (found.differing++ == 0) {
      found.value = pair.a[k];
      found.other_value = pair.b[k];
      if (pair.name) found.where = pair.name(k);
    }
    const double apart = std::abs(pair.a[k] - pair.b[k]);
    if (!(apart <= found.largest)) found.largest = apart;
  }
  return found.differing > 0 ? std::optional(found) : std::nullopt;
}

/// Takes one moment in. @param pairs  its datasets, in the order in which they are looked at
void add_moment(RowComparison& all, const std::vector<Pair>& pairs, const Moments& a, std::size_t i, const Moments& b,
                std::size_t j) {
  ++all.compared;
  std::optional<RowDifference> found;
  for (const Pair& pair : pairs) {
    if ((found = difference_of(pair))) break;
  }
  if (!found) {
    ++all.equal;
    return;
  }
  if (all.difference) return;
  found->step = a.step[i];
  found->other_step = b.step[j];
  found->time = a.time[i];
  found->other_time = b.time[j];
  all.difference = std::move(found);
}

/// Steps of two rows that were matched by time. Those matched by steps may have any times.
void add_steps(MatchBy by, std::int64_t a, std::int64_t b, std::vector<Pair>& pairs) {
  if (by == MatchBy::time) pairs.push_back({"step", {static_cast<double>(a)}, {static_cast<double>(b)}});
}

/// What each number of a frame's dataset is called. @param width  numbers of each particle
std::function<std::string(std::size_t)> of_particle(const Frames& shared, std::size_t width, std::string_view letters) {
  return [&shared, width, letters](std::size_t k) {
    const std::size_t particle = k / width, component = k % width;
    const std::string what =
        component < letters.size() ? std::string(1, letters[component]) : fmt::format("number {}", component);
    const std::string name = shared.names.at(particle);
    return fmt::format("{} of particle {}{}", what, shared.ids.at(particle), name.empty() ? "" : " '" + name + "'");
  };
}

std::vector<double> as_reals(const std::vector<std::int32_t>& whole) { return {whole.begin(), whole.end()}; }

std::vector<Pair> pairs_of(const Frames& shared, const Frame& a, const Frame& b) {
  std::vector<Pair> pairs;
  if (!shared.variable_names.empty()) {
    pairs.push_back({"value", a.variables, b.variables, [&](std::size_t k) { return shared.variable_names.at(k); }});
    return pairs;
  }
  pairs.push_back({"position/value", a.positions, b.positions, of_particle(shared, 3, "xyz")});
  pairs.push_back({"velocity/value", a.velocities, b.velocities, of_particle(shared, 3, "xyz")});
  pairs.push_back({"image/value", as_reals(a.images), as_reals(b.images), of_particle(shared, 3, "xyz")});
  pairs.push_back({"box/edges/value", a.edges, b.edges});
  for (const auto& [name, values] : a.columns) {
    const auto other = b.columns.find(name);
    if (other == b.columns.end()) continue;  // told of both files at once
    const std::size_t width = std::max<std::size_t>(1, values.size() / std::max<std::size_t>(1, shared.ids.size()));
    pairs.push_back({name + "/value", values, other->second, of_particle(shared, width, "")});
  }
  return pairs;
}

RowComparison compare_frames(const TrajectoryReader& a, const TrajectoryReader& b, MatchBy by) {
  RowComparison all{.name = "frames"};
  const Moments mine = moments_of_frames(a), theirs = moments_of_frames(b);
  for (const auto& [i, j] : matched(mine, theirs, by)) {
    const Frame one = a.frame(static_cast<Index>(i)), other = b.frame(static_cast<Index>(j));
    std::vector<Pair> pairs = pairs_of(a.shared(), one, other);
    add_steps(by, mine.step[i], theirs.step[j], pairs);
    add_moment(all, pairs, mine, i, theirs, j);
  }
  all.only_first = a.frames() - all.compared;
  all.only_second = b.frames() - all.compared;
  return all;
}

std::vector<double> row_of(const std::pair<std::vector<Index>, std::vector<double>>& quantity, std::size_t samples,
                           std::size_t k) {
  const std::size_t width = quantity.second.size() / std::max<std::size_t>(1, samples);
  const auto begin = quantity.second.begin() + static_cast<std::ptrdiff_t>(width * k);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

RowComparison compare_samples(const MonitorSeries& a, const MonitorSeries& b, MatchBy by) {
  RowComparison all{.name = a.name};
  const Moments mine{a.step, a.time}, theirs{b.step, b.time};
  for (const auto& [i, j] : matched(mine, theirs, by)) {
    std::vector<Pair> pairs;
    for (const auto& [name, values] : a.quantities) {
      const auto other = b.quantities.find(name);
      if (other == b.quantities.end()) continue;
      const bool several = !values.first.empty();
      pairs.push_back({name, row_of(values, a.step.size(), i), row_of(other->second, b.step.size(), j),
                       [several](std::size_t k) { return several ? fmt::format("number {}", k) : std::string(); }});
    }
    add_steps(by, mine.step[i], theirs.step[j], pairs);
    add_moment(all, pairs, mine, i, theirs, j);
  }
  all.only_first = std::ssize(a.step) - all.compared;
  all.only_second = std::ssize(b.step) - all.compared;
  return all;
}

/// What one of two lists of names has alone.
void compare_names(const std::vector<std::string>& a, const std::vector<std::string>& b, const std::string& what,
                   std::vector<std::string>& told) {
  for (const std::string& name : a) {
    if (std::find(b.begin(), b.end(), name) == b.end())
      told.push_back(fmt::format("{} '{}' is only in the first", what, name));
  }
  for (const std::string& name : b) {
    if (std::find(a.begin(), a.end(), name) == a.end())
      told.push_back(fmt::format("{} '{}' is only in the second", what, name));
  }
}

template <class Map> std::vector<std::string> names_in(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

/// Numbers and texts that do not grow, by name: of particles or a system, of their types, molecules and bonded terms.
/// Left out is in which order the particles stood in memory. @param types  false: without what tells types and bonds
/// @param bodies  false: without what rigid bodies are made of
std::map<std::string, std::vector<std::string>> constants_in(const Hdf5File& file, bool types, bool bodies) {
  std::map<std::string, std::vector<std::string>> all;
  for (const std::string& group : constant_groups()) {
    if (group == bodies_path && !bodies) continue;
    for (const std::string& name : file.children(group)) {
      if (file.is_group(group + "/" + name) || group + "/" + name == topology_path + "/order") continue;
      const bool of_types = group != system_path && (group != particles_path || name == "species" || name == "charge");
      if (of_types && !types) continue;
      const Hdf5Dataset dataset = file.open(group + "/" + name);
      if (dataset.grows()) continue;
      std::vector<std::string>& values = all[name];
      if (dataset.type() == ElementType::real) {
        for (const double value : dataset.read_reals()) values.push_back(fmt::format("{}", value));
      } else if (dataset.type() == ElementType::integer) {
        for (const std::int64_t value : dataset.read_integers()) values.push_back(fmt::format("{}", value));
      } else if (dataset.type() == ElementType::text) {
        values = dataset.read_texts();
      }
    }
  }
  return all;
}

/// Whether a file is from before types, molecules, bonds and charges stood in such files: its species are numbers of
/// names.
bool knows_no_types(const Hdf5File& file) {
  return file.has(particles_path + "/species") && !file.has(topology_path + "/type_name");
}

void compare_constants(const Hdf5File& a, const Hdf5File& b, RunComparison& result) {
  const bool types = !knows_no_types(a) && !knows_no_types(b);
  if (!types) {
    result.notes.push_back(
        fmt::format("types, molecules, bonds and charges are not compared: {} from a version that did not store them",
                    !knows_no_types(b)   ? "the first is"
                    : !knows_no_types(a) ? "the second is"
                                         : "both are"));
  }
  const auto knows_no_bodies = [](const Hdf5File& file) {
    for (const std::string_view column : {BodyOrientation::name, BodySpin::name, BodyInertia::name}) {
      if (!file.has(particles_path + "/" + std::string(column))) return false;
    }
    return !file.has(bodies_path + "/kind");
  };
  const bool bodies = !knows_no_bodies(a) && !knows_no_bodies(b);
  if (!bodies) {
    result.notes.push_back(
        "what rigid bodies are made of is not compared: a file is from a version that did not store it");
  }
  const auto mine = constants_in(a, types, bodies), theirs = constants_in(b, types, bodies);
  std::vector<std::string>& told = result.constants;
  compare_names(names_in(mine), names_in(theirs), "dataset", told);
  for (const auto& [name, values] : mine) {
    const auto found = theirs.find(name);
    if (found == theirs.end() || found->second == values) continue;
    const std::vector<std::string>& others = found->second;
    if (values.size() != others.size()) {
      told.push_back(fmt::format("'{}' has {} entries and {}", name, values.size(), others.size()));
      continue;
    }
    const auto at = std::mismatch(values.begin(), values.end(), others.begin());
    told.push_back(
        fmt::format("'{}' is {} and {} in entry {}", name, *at.first, *at.second, at.first - values.begin()));
  }
}

/// The first line in which two texts differ, of each.
std::pair<std::string, std::string> first_other_line(std::string_view a, std::string_view b) {
  const auto next = [](std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
  };
  while (!a.empty() || !b.empty()) {
    std::string one = next(a), other = next(b);
    if (one != other) return {std::move(one), std::move(other)};
  }
  return {};
}

void compare_origins(const FileInfo& a, const FileInfo& b, std::vector<std::string>& notes) {
  const auto add = [&](std::string_view what, const std::string& one, const std::string& other) {
    if (one != other) notes.push_back(fmt::format("{} '{}' and '{}'", what, one, other));
  };
  const auto [line, other_line] = first_other_line(a.scene_toml, b.scene_toml);
  add("scenes differ first in the lines", line, other_line);
  add("SIMD levels", a.simd, b.simd);
  add("versions", a.version, b.version);
  add("commits", a.commit, b.commit);
}

FileInfo info_of_trajectory(const std::filesystem::path& path) {
  FileInfo found = info(path);
  if (found.kind != "trajectory") {
    throw Error(fmt::format(
        "{} is a {}, which contains one moment only; compare two run.h5, or see its digest with `noether info`",
        path.string(), found.kind));
  }
  return found;
}

}  // namespace

Index RunComparison::compared() const {
  Index all = 0;
  for (const RowComparison& one : rows) all += one.compared;
  return all;
}

bool RunComparison::same() const {
  return compared() > 0 && constants.empty() &&
         std::none_of(rows.begin(), rows.end(), [](const RowComparison& one) { return one.difference.has_value(); });
}

RunComparison compare_runs(const std::filesystem::path& first, const std::filesystem::path& second, MatchBy by) {
  RunComparison result;
  const FileInfo mine = info_of_trajectory(first), theirs = info_of_trajectory(second);
  compare_origins(mine, theirs, result.notes);
  if (mine.units != theirs.units) {
    result.constants.push_back(
        fmt::format("units are '{}' and '{}', so nothing can be compared", mine.units, theirs.units));
    return result;
  }
  // Before the frames: both paths may name one file, of which HDF5 keeps one descriptor.
  const std::vector<MonitorSeries> monitors = read_monitors(first), others = read_monitors(second);
  const TrajectoryReader a(first), b(second);
  compare_constants(a.file(), b.file(), result);
  if (a.shared().variable_names.size() != b.shared().variable_names.size()) {
    result.constants.push_back(fmt::format("there are {} variables and {}", a.shared().variable_names.size(),
                                           b.shared().variable_names.size()));
  }
  compare_names(names_in(a.shared().columns), names_in(b.shared().columns), "column", result.constants);
  const bool alike =
      a.shared().ids == b.shared().ids && a.shared().variable_names.size() == b.shared().variable_names.size();
  if (alike) {
    result.rows.push_back(compare_frames(a, b, by));
  } else {
    result.rows.push_back({.name = "frames", .only_first = a.frames(), .only_second = b.frames()});
  }
  std::vector<std::string> names, other_names;
  for (const MonitorSeries& one : monitors) names.push_back(one.name);
  for (const MonitorSeries& one : others) other_names.push_back(one.name);
  for (const MonitorSeries& one : monitors) {
    const auto other = std::find_if(others.begin(), others.end(), [&](const auto& m) { return m.name == one.name; });
    if (other == others.end()) {
      result.rows.push_back({.name = one.name, .only_first = std::ssize(one.step)});
      continue;
    }
    compare_names(names_in(one.quantities), names_in(other->quantities), fmt::format("quantity of '{}',", one.name),
                  result.constants);
    result.rows.push_back(compare_samples(one, *other, by));
  }
  for (const MonitorSeries& one : others) {
    if (std::find(names.begin(), names.end(), one.name) == names.end())
      result.rows.push_back({.name = one.name, .only_second = std::ssize(one.step)});
  }
  return result;
}

}  // namespace noether::io
