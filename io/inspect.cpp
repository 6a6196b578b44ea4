#include "io/inspect.hpp"

#include "io/checkpoint.hpp"
#include "io/digest.hpp"
#include "io/hdf5_walk.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_reader.hpp"
#include "numbers/error.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <tuple>

namespace noether::io {

namespace {

FileInfo checkpoint_info(const std::filesystem::path& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  FileInfo info;
  info.kind = "checkpoint";
  info.complete = true;
  info.last_step = checkpoint.step;
  info.last_time = checkpoint.time;
  info.digest = checkpoint.digest;
  info.simd = checkpoint.simd;
  info.outcome = checkpoint.outcome;
  info.scene_toml = checkpoint.scene_toml;
  const Hdf5File content = Hdf5File::open_to_read(file);
  info.version = content.text_attribute("/noether", "version");
  info.commit = content.text_attribute("/noether", "commit");
  const auto& particles = checkpoint.run.particles;
  if (particles.count("id") != 0) {
    info.particles = static_cast<Index>(detail::array_of<std::int64_t>(particles, "id").size());
  }
  if (particles.count("variables") != 0) {
    info.variables = static_cast<Index>(detail::array_of<double>(particles, "variables").size());
  }
  if (particles.count("units") != 0) {
    info.units = detail::element(detail::array_of<std::string>(particles, "units"), 0);
    info.time_unit = std::string(known_units(info.units, file).time);
  }
  return info;
}

std::vector<MonitorSummary> summaries(const Hdf5File& file) {
  std::vector<MonitorSummary> result;
  for (const std::string& name : file.children(monitors_path)) {
    MonitorSummary summary{name, {}, 0};
    const std::string group = monitors_path + "/" + name;
    for (const std::string& quantity : file.children(group)) {
      if (quantity != "step" && quantity != "time") summary.quantities.push_back(quantity);
    }
    if (file.has(group + "/step")) summary.samples = file.open(group + "/step").rows();
    result.push_back(std::move(summary));
  }
  return result;
}

/// Steps and times of a trajectory without frames are those of the monitor that looked last.
void take_last_sample(const Hdf5File& file, FileInfo& info) {
  for (const MonitorSummary& monitor : info.monitors) {
    if (monitor.samples == 0) continue;
    const std::string group = monitors_path + "/" + monitor.name;
    const std::int64_t step = file.open(group + "/step").read_integers().back();
    if (step < info.last_step) continue;
    info.last_step = step;
    info.last_time = file.open(group + "/time").read_reals(monitor.samples - 1, 1).at(0);
  }
}

FileInfo trajectory_info(const std::filesystem::path& path) {
  const TrajectoryReader reader(path);
  const Hdf5File& file = reader.file();
  FileInfo info;
  info.kind = "trajectory";
  info.complete = file.integer_attribute("/noether", "complete") == 1;
  info.version = file.text_attribute("/noether", "version");
  info.commit = file.text_attribute("/noether", "commit");
  info.simd = file.text_attribute("/noether", "simd");
  info.units = file.text_attribute("/noether", "units");
  if (file.has("/noether/scene")) info.scene_toml = file.read_text("/noether/scene");
  info.time_unit = reader.shared().time_unit;
  info.particles = static_cast<Index>(reader.shared().ids.size());
  info.variables = static_cast<Index>(reader.shared().variable_names.size());
  info.frames = reader.frames();
  info.monitors = summaries(file);
  if (info.frames == 0) {
    take_last_sample(file, info);
    return info;
  }
  const Frame last = reader.frame(info.frames - 1);
  info.last_step = last.step;
  info.last_time = last.time;
  info.digest = info.variables > 0 ? system_digest(last.step, last.time, last.variables)
                                   : digest(last.step, last.time, reader.shared().ids, last.positions, last.velocities,
                                            reader.shared().masses, last.images, last.columns);
  return info;
}

enum class Kind : std::uint8_t { trajectory, checkpoint };

/// What a file is. Its own checksum line is looked for first: a damaged checkpoint is not shown to HDF5.
/// @throws FileError if it is neither
Kind kind_of(const std::filesystem::path& path) {
  if (ends_like_checkpoint(path)) return Kind::checkpoint;
  try {
    const Hdf5File file = Hdf5File::open_to_read(path);
    if (file.has("/h5md")) return Kind::trajectory;
    if (file.has("/state")) return Kind::checkpoint;
  } catch (const FileError&) {
    std::error_code ignored;
    const bool named = path.filename().string().find("checkpoint") != std::string::npos;
    if (!has_hdf5() || !named || !std::filesystem::is_regular_file(path, ignored)) throw;
    return Kind::checkpoint;
  }
  throw FileError("this is an HDF5 file, but neither a trajectory nor a checkpoint of noether",
                  {.file = path.string()});
}

/// What is wrong with a series of steps and times; `who` owns it.
void check_clock(const std::string& who, const std::vector<std::int64_t>& steps, const std::vector<double>& times,
                 std::vector<std::string>& damaged) {
  for (std::size_t k = 1; k < steps.size(); ++k) {
    if (steps[k] >= steps[k - 1]) continue;
    damaged.push_back(fmt::format("{}: step {} follows step {}", who, steps[k], steps[k - 1]));
    return;
  }
  if (!std::all_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); })) {
    damaged.push_back(fmt::format("{}: a time is not finite", who));
  }
}

/// A run that was killed while it wrote may have left rows that the dataset written last does not have yet: positions
/// of frames, steps of samples. Nothing is ever shorter than these.
void check_frames(const TrajectoryReader& reader, bool complete, std::vector<std::string>& damaged) {
  std::vector<std::int64_t> steps;
  std::vector<double> times;
  const auto lengths = reader.lengths();
  for (const auto& [path, rows] : lengths) {
    if (rows < lengths.front().second || (complete && rows != reader.frames()))
      damaged.push_back(fmt::format("'{}' has {} rows, others {}", path, rows, reader.frames()));
  }
  for (Index k = 0; k < reader.frames(); ++k) {
    const Frame frame = reader.frame(k);
    steps.push_back(frame.step);
    times.push_back(frame.time);
    const auto finite = [](const std::vector<double>& numbers) {
      return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
    };
    if (!finite(frame.positions) || !finite(frame.velocities) || !finite(frame.variables) ||
        !std::all_of(frame.columns.begin(), frame.columns.end(),
                     [&](const auto& column) { return finite(column.second); })) {
      damaged.push_back(fmt::format("frame {} at step {} is not finite", k, frame.step));
    } else if (const auto digest = reader.digest(k); digest && *digest != frame_digest(frame))
      damaged.push_back(
          fmt::format("frame {} at step {} does not have the digest that was written with it", k, frame.step));
  }
  check_clock("frames", steps, times, damaged);
}

void check_monitors(const Hdf5File& file, bool complete, std::vector<std::string>& damaged) {
  for (const std::string& name : file.children(monitors_path)) {
    const std::string group = monitors_path + "/" + name;
    const Index samples = file.open(group + "/step").rows();
    for (const std::string& quantity : file.children(group)) {
      const Hdf5Dataset dataset = file.open(group + "/" + quantity);
      if (dataset.rows() < samples || (complete && dataset.rows() != samples)) {
        damaged.push_back(fmt::format("'{}/{}' has {} rows, its steps {}", group, quantity, dataset.rows(), samples));
      }
    }
    check_clock("monitor " + name, file.open(group + "/step").read_integers(), file.open(group + "/time").read_reals(),
                damaged);
  }
}

/// Samples that are not what was written.
void check_samples(const Hdf5File& file, const std::vector<MonitorSeries>& all, std::vector<std::string>& damaged) {
  for (const MonitorSeries& monitor : all) {
    const std::string path = sample_digests_path(monitor.name);
    if (!file.has(path)) continue;
    const Hdf5Dataset dataset = file.open(path);
    constexpr std::size_t size = std::tuple_size_v<RowDigest>;
    const std::size_t samples = std::min(monitor.step.size(), static_cast<std::size_t>(dataset.rows()));
    if (dataset.shape().size() != 2 || dataset.shape()[1] != Index{size}) {
      damaged.push_back(fmt::format("monitor {}: its digests are not 32 bytes each", monitor.name));
      continue;
    }
    const std::vector<std::int64_t> digests = dataset.read_integers();
    for (std::size_t k = 0; k < samples; ++k) {
      std::map<std::string, std::span<const double>, std::less<>> quantities;
      for (const auto& [name, content] : monitor.quantities) {
        const std::size_t numbers = monitor.step.empty() ? 0 : content.second.size() / monitor.step.size();
        quantities[name] = std::span(content.second).subspan(k * numbers, numbers);
      }
      const RowDigest digest = sample_digest(monitor.step[k], monitor.time[k], quantities);
      if (std::equal(digest.begin(), digest.end(), digests.begin() + static_cast<std::ptrdiff_t>(k * size))) continue;
      damaged.push_back(
          fmt::format("monitor {}: sample {} at step {} does not have the digest that was written with it",
                      monitor.name, k, monitor.step[k]));
      break;
    }
  }
}

/// Ids, names, masses, types, bonds and what else particles have once.
void check_constants(const Hdf5File& file, std::vector<std::string>& damaged) {
  if (!constants_differ(file)) return;
  damaged.emplace_back(
      "the ids, names, masses, types, bonds or parameters of the particles differ from those that were written");
}

/// What a file that has digests must have of them: without one a change would pass unseen.
void check_digests(const Hdf5File& file, std::vector<std::string>& damaged) {
  const auto expect = [&](bool there, const std::string& what) {
    if (!there) damaged.push_back("there is no digest of " + what + ", which every such file has");
  };
  expect(file.has_attribute("/noether", constants_attribute), "the constant data of the particles");
  if (!file.has_attribute("/noether", "complete"))
    damaged.emplace_back("it does not say whether it is complete, as every such file does");
  if (!file.has("/noether/scene")) damaged.emplace_back("there is no scene, which every such file has");
  if (!file.has(monitors_path)) damaged.emplace_back("there is no group of monitors, which every such file has");
  for (const std::string& path : {particles_path + "/position/value", system_path + "/value"})
    if (file.has(path) && file.open(path).rows() > 0) expect(file.has(frame_digests_path), "the frames");
  for (const std::string& name : file.children(monitors_path)) {
    // A killed writer may not have come further than to make the datasets of a monitor.
    const std::string steps = monitors_path + "/" + name + "/step";
    if (file.has(steps) && file.open(steps).rows() > 0)
      expect(file.has(sample_digests_path(name)), "the samples of monitor " + name);
  }
}

/// The scene, and units and other attributes of monitors: what may change while a run goes on.
void check_scene_and_monitors(const Hdf5File& file, std::vector<std::string>& damaged) {
  if (!file.has_attribute("/noether", scene_attribute)) {
    damaged.emplace_back("there is no digest of the scene, which every such file has");
  } else if (file.has("/noether/scene") &&
             file.text_attribute("/noether", scene_attribute) != sha256(file.read_text("/noether/scene"))) {
    damaged.emplace_back("the scene differs from the one that was written");
  }
  for (const std::string& name : file.children(monitors_path)) {
    const std::string digests = sample_digests_path(name);
    if (!file.has(digests)) continue;
    if (!file.has_attribute(digests, headers_attribute)) {
      damaged.push_back(
          fmt::format("monitor {}: there is no digest of its attributes, which every such file has", name));
    } else if (file.text_attribute(digests, headers_attribute) != monitor_headers_digest(file, name)) {
      damaged.push_back(
          fmt::format("monitor {}: its units or other attributes differ from those that were written", name));
    }
  }
}

/// Attributes that never change are those that were written. A file of an earlier version has fewer digests, or none.
void check_headers(const Hdf5File& file, std::vector<std::string>& damaged) {
  const bool digests = file.has(digests_path) || file.has_attribute("/noether", constants_attribute);
  if (!file.has_attribute("/noether", headers_attribute)) {
    if (digests) damaged.emplace_back("there is no digest of its attributes, which every such file has");
    return;
  }
  check_digests(file, damaged);
  const std::string written = file.text_attribute("/noether", headers_attribute);
  if (written == headers_digest(file)) return check_scene_and_monitors(file, damaged);
  if (written != headers_digest(file, 1))
    damaged.emplace_back("the units or other attributes of the particles differ from those that were written");
}

Index numbers_in(const std::vector<Index>& shape) {
  return std::accumulate(shape.begin(), shape.end(), Index{1}, std::multiplies<>());
}

/// Every `stride`-th of the first `samples` rows back from the last, and the first, from which changes are counted.
std::vector<std::size_t> kept_numbers(std::size_t samples, std::size_t stride) {
  std::vector<std::size_t> kept;
  if (samples > 0 && (samples - 1) % stride != 0) kept.push_back(0);
  for (std::size_t k = samples == 0 ? 0 : (samples - 1) % stride; k < samples; k += stride) kept.push_back(k);
  return kept;
}

template <class Value>
std::vector<Value> kept_rows(const std::vector<Value>& all, const std::vector<std::size_t>& numbers) {
  std::vector<Value> kept;
  for (const std::size_t k : numbers) kept.push_back(all[k]);
  return kept;
}

/// The same of a dataset of rows of so many `columns`: read in blocks, so that it is never in memory as a whole.
std::vector<double> kept_rows(const Hdf5Dataset& dataset, const std::vector<std::size_t>& numbers,
                              std::size_t columns) {
  static constexpr std::size_t most_read = 1U << 18U;
  const std::size_t block = std::max<std::size_t>(1, most_read / std::max<std::size_t>(columns, 1));
  std::vector<double> kept;
  kept.reserve(numbers.size() * columns);
  for (std::size_t from = 0, to = 0; from < numbers.size(); from = to) {
    const std::size_t first = numbers[from];
    while (to < numbers.size() && numbers[to] < first + block) ++to;
    const auto rows = static_cast<Index>(numbers[to - 1] - first + 1);
    const std::vector<double> read = dataset.read_reals(static_cast<Index>(first), rows);
    for (std::size_t k = from; k < to; ++k) {
      const auto row = read.begin() + static_cast<std::ptrdiff_t>((numbers[k] - first) * columns);
      kept.insert(kept.end(), row, row + static_cast<std::ptrdiff_t>(columns));
    }
  }
  return kept;
}

/// The samples of one monitor; nothing where none of its quantities is wanted.
std::optional<MonitorSeries> untried_monitor(const Hdf5File& file, const std::string& name,
                                             const MonitorChoice& choice) {
  const std::string group = monitors_path + "/" + name;
  MonitorSeries series;
  series.name = name;
  const Hdf5Dataset steps = file.open(group + "/step"), times = file.open(group + "/time");
  // A killed writer may have been a row ahead in some of the datasets.
  std::size_t samples = static_cast<std::size_t>(std::min(steps.rows(), times.rows())), stride = 1;
  std::map<std::string, Hdf5Dataset> datasets;
  for (const std::string& quantity : file.children(group)) {
    if (quantity == "step") continue;
    series.units[quantity] = file.text_attribute(group + "/" + quantity, "noether_unit");
    if (quantity == "time" || (choice.wanted && !choice.wanted(name, quantity))) continue;
    const Hdf5Dataset& dataset = datasets[quantity] = file.open(group + "/" + quantity);
    std::vector<Index> shape = dataset.growing_shape();
    samples = std::min(samples, static_cast<std::size_t>(shape[0]));
    shape.erase(shape.begin());
    series.quantities[quantity].first = std::move(shape);
  }
  if (datasets.empty() && choice.wanted) return {};
  for (const auto& [quantity, content] : series.quantities) {
    if (choice.most_numbers == 0 || content.first.empty()) continue;
    const std::size_t count = samples * static_cast<std::size_t>(numbers_in(content.first));
    stride = std::max(stride, (count + choice.most_numbers - 1) / choice.most_numbers);
  }
  stride = std::clamp<std::size_t>(stride, 1, std::max<std::size_t>(samples, 1));
  std::vector<std::size_t> numbers = kept_numbers(samples, stride);
  if (choice.last_alone && choice.last_alone(name) && samples > 0) numbers = {samples - 1};
  for (auto& [quantity, content] : series.quantities) {
    content.second = kept_rows(datasets.at(quantity), numbers, static_cast<std::size_t>(numbers_in(content.first)));
  }
  series.step = kept_rows(steps.read_integers(), numbers);
  series.time = kept_rows(times.read_reals(), numbers);
  if (file.has_attribute(group, "scale")) series.scale = file.real_attribute(group, "scale");
  if (series.quantities.count("value") != 0) series.orders = file.integers_attribute(group + "/value", "orders");
  return series;
}

std::vector<MonitorSeries> untried_monitors(const std::filesystem::path& path, const MonitorChoice& choice = {}) {
  const Hdf5File file = Hdf5File::open_to_read(path);
  std::vector<MonitorSeries> result;
  for (const std::string& name : file.children(monitors_path)) {
    auto series = untried_monitor(file, name, choice);
    if (series) result.push_back(std::move(*series));
  }
  return result;
}

FileInfo untried_info(const std::filesystem::path& file) {
  return kind_of(file) == Kind::trajectory ? trajectory_info(file) : checkpoint_info(file);
}

FileInfo untried_verify(const std::filesystem::path& file) {
  FileInfo result;
  try {
    const Kind kind = kind_of(file);
    result.kind = kind == Kind::trajectory ? "trajectory" : "checkpoint";
    const Hdf5Walk walk = kind == Kind::trajectory ? walk_hdf5(file) : Hdf5Walk{};
    if (walk.fault) {
      result.damaged.push_back(to_text(*walk.fault));
      return result;
    }
    result = untried_info(file);
    if (result.complete) {
      for (const Hdf5Fault& unwritten : walk.unwritten) result.damaged.push_back(to_text(unwritten));
    }
    if (kind == Kind::checkpoint) return result;
    read_headers(Hdf5File::open_to_read(file));  // by a handle of its own: others have parts of the file in memory
    const TrajectoryReader reader(file);
    check_frames(reader, result.complete, result.damaged);
    check_monitors(reader.file(), result.complete, result.damaged);
    check_samples(reader.file(), untried_monitors(file), result.damaged);
    check_constants(reader.file(), result.damaged);
    check_headers(reader.file(), result.damaged);
  } catch (const FileError& error) {
    result.damaged.push_back(error.message());
  }
  return result;
}

Frames untried_frames(const std::filesystem::path& file) {
  const TrajectoryReader reader(file);
  Frames result = reader.shared();
  for (Index k = 0; k < reader.frames(); ++k) result.frames.push_back(reader.frame(k));
  return result;
}

}  // namespace

FileInfo info(const std::filesystem::path& file) {
  return try_first(file, [&] { return untried_info(file); });
}

FileInfo verify(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) Hdf5File::open_to_read(file);
  try {
    return try_first(file, [&] { return untried_verify(file); });
  } catch (const FileError& error) {
    FileInfo result;
    result.damaged.push_back(error.message());
    return result;
  }
}

std::vector<MonitorSeries> read_monitors(const std::filesystem::path& file, const MonitorChoice& choice) {
  return try_first(file, [&] { return untried_monitors(file, choice); });
}

Frames read_frames(const std::filesystem::path& file) {
  return try_first(file, [&] { return untried_frames(file); });
}

}  // namespace noether::io
