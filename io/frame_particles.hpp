#pragma once
/// Particles from a frame of run.h5, as a new run starts from them: to the bit.

#include "engine/particle_system.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

struct FrameOptions {
  std::optional<std::int64_t> frame = {};  ///< from 0; -1, as nothing, is the last
  const UnitSystem* units = nullptr;       ///< those of the new run; another file is refused. Null: those of the file
  /// Those that the new run declares: columns of the file with other names or widths are left out, but for the charge.
  /// Nothing: all columns of the file.
  std::optional<std::vector<ColumnInfo>> columns = {};
};

/// One frame, and what it was in its run.
struct FrameParticles {
  ParticleSystem<double> particles;
  std::int64_t frame = 0, step = 0;
  double time = 0;                    ///< [time]
  std::string sha256;                 ///< of the frame and of what its particles have once, 64 hexadecimal digits
  std::string scene_toml;             ///< of its run
  std::vector<std::string> left_out;  ///< columns of the file that the new run does not declare
  bool lost_bodies = false;           ///< there are rigid bodies, but the file does not say what they are made of
  bool knows_types = true;            ///< false: the file is from before types and bonds stood in such files
};

/// Whether a file begins as HDF5 files do, or has their ending: .h5 or .hdf5.
bool is_hdf5(const std::filesystem::path& file);

/// Reads a frame: positions, velocities, masses, ids and names, the box with its images, types, molecules, bonds and
/// charges, and columns that parts declare. Particles stand in the order in which their run had them.
/// @throws FileError  if it is no trajectory of noether, has no frames, or is not what was written; Error with the key
///   "frame" or "units" for what it does not have
/// @cost O(n), twice
FrameParticles read_frame_particles(const std::filesystem::path& file, const FrameOptions& options = {});

}  // namespace noether::io
