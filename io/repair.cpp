#include "io/repair.hpp"

#include "io/files.hpp"
#include "io/hdf5_file.hpp"
#include "io/hdf5_walk.hpp"
#include "io/ordered_file.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_groups.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_reader.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

namespace noether::io {

namespace {

namespace fs = std::filesystem;

/// Datasets that grow together.
struct Together {
  std::string owner;                                ///< "the frames", "monitor 'energy'"
  std::vector<std::pair<std::string, Index>> rows;  ///< path of each, and how many rows it has
  Index whole = std::numeric_limits<Index>::max();  ///< rows that are whole in all of them
};
using Plan = std::vector<Together>;

/// Counts the rows of a dataset, and those before the first that is not in the file's first `size` bytes.
void count(const Hdf5File& file, const std::string& path, std::uint64_t size, Together& together) {
  const Hdf5Dataset dataset = file.open(path);
  together.rows.emplace_back(path, dataset.rows());
  together.whole = std::min(together.whole, dataset.rows_within(size));
}

/// What to cut, where only the first `size` bytes are the file's own. @throws FileError if more than rows is missing
Plan plan(const fs::path& path, std::uint64_t size) {
  const TrajectoryReader reader(path);
  const Hdf5File& file = reader.file();
  std::vector<std::string> complete;
  std::vector<std::string> groups = constant_groups();
  groups.emplace_back(vmd_structure_path);
  for (const std::string& group : groups) {
    for (const std::string& one : file.children(group)) {
      const std::string path_of_one = group + "/" + one;
      if (!file.is_group(path_of_one) && !file.open(path_of_one).grows()) complete.push_back(path_of_one);
    }
  }
  complete.emplace_back("/noether/scene");
  for (const std::string& fixed : complete) {
    const Hdf5Dataset dataset = file.open(fixed);
    if (dataset.rows_within(size) < dataset.rows())
      throw FileError(fmt::format("damaged: '{}' is missing", fixed), {.file = path.string()});
  }
  Plan all;
  if (!reader.lengths().empty()) {
    Together& frames = all.emplace_back(Together{"the frames", {}});
    for (const auto& [dataset, rows] : reader.lengths()) count(file, dataset, size, frames);
  }
  for (const std::string& name : file.children(monitors_path)) {
    Together& samples = all.emplace_back(Together{fmt::format("monitor '{}'", name), {}});
    const std::string group = monitors_path + "/" + name;
    for (const std::string& quantity : file.children(group)) count(file, group + "/" + quantity, size, samples);
    if (file.has(sample_digests_path(name))) count(file, sample_digests_path(name), size, samples);
  }
  return all;
}

/// One line for each dataset that is to become shorter.
std::vector<std::string> cuts(const Plan& plan) {
  std::vector<std::string> lines;
  for (const Together& together : plan) {
    for (const auto& [path, rows] : together.rows) {
      if (rows > together.whole)
        lines.push_back(fmt::format("'{}' cut from {} rows to {}, the number that all parts of {} have", path, rows,
                                    together.whole, together.owner));
    }
  }
  return lines;
}

/// One flush, ordered for datasets that get shorter; closed before anything can grow again.
void cut(const Hdf5File& file, const Plan& plan) {
  file.begin_cut();
  for (const Together& together : plan) {
    for (const auto& [path, rows] : together.rows) {
      Hdf5Dataset dataset = file.open(path);
      if (is_leader(path)) dataset.write_last();
      if (rows > together.whole) dataset.resize(together.whole);
    }
  }
  file.flush();
}

/// A file that has lost its end is complete no more.
void mark_incomplete(const Hdf5File& file) {
  if (file.integer_attribute("/noether", "complete") == 0) return;
  file.set_attribute("/noether", "complete", std::int64_t{0});
  file.flush();
}

void carry_out(const Plan& plan, const fs::path& file) {
  try_in_child(file, [&] {
    mark_incomplete(Hdf5File::open_to_rehearse(file));
    cut(Hdf5File::open_to_rehearse(file), plan);
  });
  mark_incomplete(Hdf5File::open_to_append(file));
  cut(Hdf5File::open_to_append(file), plan);
}

/// Datasets of different lengths become equal, in the file itself.
void repair_lengths(const fs::path& file, std::uint64_t size, Repair& result) {
  Plan found;
  try {
    found = try_first(file, [&] { return plan(file, size); });
  } catch (const FileError&) {
    if (result.info.damaged.empty()) throw;
    return;  // `damaged` says why
  }
  result.repaired = cuts(found);
  if (result.repaired.empty()) return;
  carry_out(found, file);
  result.info = verify(file);
}

void check(const std::error_code& error, const fs::path& file) {
  if (error) throw FileError(fmt::format("cannot be written: {}", error.message()), {.file = file.string()});
}

fs::path with_ending(fs::path file, const std::string& ending) { return file += ending; }

/// A file of which no more than a moment is needed.
struct Temporary {
  explicit Temporary(fs::path name) : path(std::move(name)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  const fs::path path;
};

std::string beyond_repair(std::uint64_t size, std::uint64_t expected) {
  return fmt::format(
      "cut short: only {} of {} bytes are there, and more than frames and samples is missing, so it cannot be "
      "repaired. If the checkpoint is intact, 'noether run SCENE --resume' continues the run without it",
      size, expected);
}

/// What is missing is put back as zeros, to which nothing points after the cut.
void repair_end(const fs::path& file, std::uint64_t size, std::uint64_t expected, Repair& result) {
  const fs::path kept = with_ending(file, ".damaged");
  if (fs::exists(kept)) {
    throw FileError("a copy from an earlier repair is in the way; move or remove it, then repair again",
                    {.file = kept.string()});
  }
  const Temporary copy(with_ending(file, ".repaired"));
  std::error_code error;
  fs::copy_file(file, copy.path, fs::copy_options::overwrite_existing, error);
  if (!error) fs::resize_file(copy.path, expected, error);
  check(error, copy.path);
  Plan found;
  try {
    found = try_first(copy.path, [&] { return plan(copy.path, size); });
    carry_out(found, copy.path);
  } catch (const FileError&) {
    result.info.damaged = {beyond_repair(size, expected)};
    return;
  }
  const FileInfo mended = verify(copy.path);
  if (!mended.damaged.empty()) {
    result.info.damaged = {beyond_repair(size, expected)};
    return;
  }
  sync_file(copy.path);
  rename_if_there(file, kept);
  rename_if_there(copy.path, file);
  sync_folder(file.parent_path());
  result.info = mended;
  result.repaired = cuts(found);
  result.repaired.insert(result.repaired.begin(),
                         fmt::format("the last {} of {} bytes are missing; the file before the repair is kept as '{}'",
                                     expected - size, expected, kept.filename().string()));
}

}  // namespace

Repair repair(const fs::path& file) {
  static constexpr std::uint64_t believable = 64;  // times as long as it is, a file may have been
  Repair result{verify(file), {}};
  const std::uint64_t size = fs::file_size(file), expected = expected_size(file);
  if (result.info.kind == "trajectory") {
    const Hdf5Walk walk = walk_hdf5(file);
    // HDF5 must not write to a damaged structure; and rows without data may be all rows of one whose tree is lost.
    if (walk.fault || !walk.unwritten.empty()) return result;
    repair_lengths(file, size, result);
  } else if (expected > size && expected / believable < size) {
    repair_end(file, size, expected, result);
  }
  return result;
}

}  // namespace noether::io
