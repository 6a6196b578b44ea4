#pragma once
/// The writer of `run.h5`: frames in H5MD 1.1, and every monitor's samples.

#include "engine/description.hpp"
#include "engine/monitor.hpp"
#include "engine/outcome.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace noether::io {

struct TrajectoryOptions {
  bool frames = true;        ///< write positions and velocities; without, only the samples of monitors
  std::string scene_toml{};  ///< effective scene, stored as /noether/scene
};

/// Writes frames and samples to one HDF5 file: `sim.every(100, io::TrajectoryWriter{"run.h5"})`.
///
/// Particles stand in id order in every frame; a first-order system has its variables below /noether/system. The file
/// is created (an old one is replaced) at the first look. Copies share one file.
/// @cost O(n) per frame
class TrajectoryWriter {
 public:
  explicit TrajectoryWriter(std::filesystem::path file, TrajectoryOptions options = {});

  static constexpr auto describe() {
    return part<TrajectoryWriter>("trajectory", "frames and monitors' samples in an H5MD file",
                                  quantities("position[n][3] [length], velocity[n][3] [length/time], id, mass, name; "
                                             "every monitor's quantities below /noether/monitors; of a system, "
                                             "value[n] below /noether/system"),
                                  source("DeBuyl2014"));
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
  /// @throws FileError if the file is missing or shorter than that
  void load(const SavedState& saved, const std::string& prefix);

  const std::filesystem::path& file() const;

 private:
  class File;
  std::shared_ptr<File> held_;
};

}  // namespace noether::io
