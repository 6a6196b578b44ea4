#pragma once
/// What stands in a file: summaries, checks, conversions, and series for plots.

#include "io/frames.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether::io {

/// The samples of one monitor.
struct MonitorSeries {
  std::string name;
  std::vector<std::int64_t> step;
  std::vector<double> time;  ///< [time]
  /// By name: shape of one sample (empty for a number), and all values, sample by sample.
  std::map<std::string, std::pair<std::vector<Index>, std::vector<double>>> quantities;
  std::map<std::string, std::string> units;  ///< by quantity, and of "time"; "1" for plain numbers
  std::optional<double> scale;               ///< what relative errors are relative to
  std::vector<std::int64_t> orders;          ///< of a quantity that is known to several orders; else empty
};

/// How much of one monitor a file holds.
struct MonitorSummary {
  std::string name;
  std::vector<std::string> quantities;
  Index samples = 0;
};

struct FileInfo {
  std::string kind;       ///< "trajectory" or "checkpoint"; empty if the file cannot be opened
  bool complete = false;  ///< trajectory: the run ended as asked; checkpoint: written to the end
  std::int64_t last_step = 0;
  double last_time = 0;  ///< [time]
  std::string time_unit;
  Index particles = 0, variables = 0, frames = 0;  ///< of a first-order system: variables and no particles
  std::string digest;  ///< trajectory: of the last frame, from its data; checkpoint: as stored; may be empty
  std::string version, commit, simd, units;
  std::string outcome;  ///< checkpoint: how the run ended; empty while it is unfinished
  std::string scene_toml;
  std::vector<MonitorSummary> monitors;
  std::vector<std::string> damaged;  ///< what `verify` found wrong, one line each
};

/// A summary of a trajectory or a checkpoint.
/// @throws FileError if it is neither, or damaged
FileInfo info(const std::filesystem::path& file);

/// Reads everything: the structure of the file is sound, lengths agree, steps and times grow, numbers are finite,
/// hashes fit. Where the structure of a trajectory is damaged, nothing else is looked at.
///
/// What is wrong is listed in `damaged`, also where the file cannot be opened as HDF5 at all.
/// @throws FileError if there is no such file
FileInfo verify(const std::filesystem::path& file);

struct ConvertOptions {
  bool unwrapped = false;  ///< positions as if never wrapped: x + image edges, of particles in a periodic box
  bool bodies = false;     ///< one frame, as bodies that a scene starts from
  std::optional<std::int64_t> frame = {};  ///< which one, from 0; -1, as nothing, is the last. Of bodies alone
};

/// Rewrites a trajectory as extended XYZ (`.xyz`) or CSV (`.csv`: step, time, id, name, x ... vz, 17 digits; of a
/// first-order system, which has no XYZ: step, time, and a column for each variable).
///
/// Species of XYZ are the types of the particles, "1", a label or the element, and where they have none their names (of
/// "O_17" what stands before the number). XYZ of a molecular run is as ASE reads it: positions in angstrom, masses in
/// u, momenta in sqrt(eV u), charges in e, Lattice and pbc of a periodic box, positions in it. Other runs keep their
/// own units, which the comment of each frame tells.
///
/// Bodies go into a trajectory of one frame (`.h5`), with all that particles have, or into a table (`.csv`) where that
/// has room for it: there are no types, bonds, rigid bodies or box. Both are read back to the bit.
/// @return the number of frames
/// @throws Error for another extension, or images, a frame or room that are not there; FileError if a file cannot be
///   read or written
Index convert(const std::filesystem::path& file, const std::filesystem::path& out, const ConvertOptions& options = {});

/// Which samples of monitors a reader of a file keeps in memory.
struct MonitorChoice {
  /// Whether a quantity of a monitor is read; nothing: all are. Monitors without such a quantity are left out.
  std::function<bool(const std::string& monitor, const std::string& quantity)> wanted = {};
  /// Where a quantity of several numbers has more than these in all, samples at equal distances are kept, back
  /// from the last, and the first; 0: all are.
  std::size_t most_numbers = 0;
  /// Whether the last sample of a monitor alone is read, as of a mean over the run; nothing: of none.
  std::function<bool(const std::string& monitor)> last_alone = {};
};

/// The samples of monitors, in the order of their names.
/// @throws FileError
std::vector<MonitorSeries> read_monitors(const std::filesystem::path& file, const MonitorChoice& choice = {});

/// All frames, in memory.
/// @throws FileError
Frames read_frames(const std::filesystem::path& file);

}  // namespace noether::io
