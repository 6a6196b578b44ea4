#pragma once
/// The writer of `run.h5`: frames in H5MD 1.1, and every monitor's samples.

#include "engine/description.hpp"
#include "engine/monitor.hpp"
#include "engine/outcome.hpp"
#include "numbers/error.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace noether::io {

struct TrajectoryOptions {
  bool frames = true;        ///< write positions and velocities; without, only the samples of monitors
  std::string scene_toml{};  ///< effective scene, stored as /noether/scene
  bool lost = false;         ///< load() looks for no file: the one that the saved run counts on is gone
  bool sites = false;        ///< write the sites of rigid bodies too (io/trajectory_sites.hpp), in each frame

  static constexpr auto describe() {
    return part<TrajectoryOptions>(
        "trajectory", "frames and monitors' samples in an H5MD file",
        quantities("position[n][3] [length], velocity[n][3] [length/time], id, mass, name, "
                   "species, charge, bonds; "
                   "every monitor's quantities below /noether/monitors; of a system, "
                   "value[n] below /noether/system"),
        source("DeBuyl2014"),
        field<&TrajectoryOptions::sites>("sites", "1", "rigid bodies: each frame has their sites too, as atoms"));
  }
};

/// The file that a saved run counts on is missing, damaged or shorter: exit code 3.
class TrajectoryLost : public FileError {
 public:
  using FileError::FileError;
};

/// Writes frames and samples to one HDF5 file: `sim.every(100, io::TrajectoryWriter{"run.h5"})`.
///
/// Particles stand in id order in every frame; a first-order system has its variables below /noether/system. The file
/// is created (an old one is replaced) at the first look. Copies share one file. A file that goes on keeps what frames
/// it began with; one from before it said what rigid bodies are made of says so from then on.
/// @cost O(n) per frame
class TrajectoryWriter {
 public:
  explicit TrajectoryWriter(std::filesystem::path file, TrajectoryOptions options = {});

  static constexpr auto describe() {
    return part<TrajectoryWriter>("trajectory", "frames and monitors' samples in an H5MD file", source("DeBuyl2014"));
  }

  /// Makes the file, which may have to wait for its first frame. @throws FileError
  void at_start(const Snapshot<double>& now);
  /// Writes a frame. @throws FileError
  void observe(const Snapshot<double>& now);
  /// Writes a monitor's sample below /noether/monitors/NAME. @throws FileError
  void record(const Sample& sample);
  /// Hands everything to the operating system. @throws FileError
  void flush();
  /// Flushes, and marks the file complete if the run ended as asked. @throws FileError
  void finish(const Outcome& outcome);

  /// Lengths of all datasets.
  void save(SavedState& saved, const std::string& prefix) const;
  /// Opens the existing file and cuts every dataset back to its saved length.
  /// @throws TrajectoryLost if the file is missing, damaged or shorter than that; FileError if it cannot be written
  void load(const SavedState& saved, const std::string& prefix);
  /// Begins the file now, before the first look. @throws FileError
  void begin(const ParticleSystem<double>& state);

  const std::filesystem::path& file() const;

 private:
  friend struct OneFrame;
  class File;
  std::shared_ptr<File> held_;
};

/// Writes particles as a trajectory of one frame, which `bodies` of a scene takes as any other; an old file is
/// replaced.
/// @param time  [time]
/// @throws FileError
/// @cost O(n)
void write_one_frame(const std::filesystem::path& file, const ParticleSystem<double>& settled, std::int64_t step,
                     double time, const TrajectoryOptions& options = {});

}  // namespace noether::io
