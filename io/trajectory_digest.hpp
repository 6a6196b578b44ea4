#pragma once
/// Digests within run.h5: of every frame, of every sample, and of all that stands in it once.

#include "io/digest.hpp"
#include "io/frames.hpp"
#include "io/hdf5_file.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace noether::io {

/// Where they stand: rows of four whole numbers, one for each frame, and one for each sample of a monitor.
inline const std::string digests_path = "/noether/digests";
inline const std::string frame_digests_path = "/noether/digests/frames";
inline std::string sample_digests_path(std::string_view monitor) {
  return digests_path + "/monitors/" + std::string(monitor);
}
/// The attribute of /noether that has the digest of what stands in the file once and never changes.
inline const std::string constants_attribute = "constants_sha256";

/// Whether a file has other constants than those whose digest was written with it; false where none was.
bool constants_differ(const Hdf5File& file);

/// The attribute of /noether that has the digest of the attributes that never change.
inline const std::string headers_attribute = "attributes_sha256";

/// The attribute of /noether that has the digest of the scene. It changes with the scene, whose end may be moved.
inline const std::string scene_attribute = "scene_sha256";

/// SHA-256 of "noether-frame-1\n", int64 step, float64 time, x and v (n, 3), variables, int64 images (n, 3), edges, and
/// of each other column that moves its name and its values, and x, v and images (m, 3) of sites where the file has
/// them; row by row, as the file has them.
RowDigest frame_digest(const Frame& frame);

/// SHA-256 of "noether-sample-1\n", int64 step, float64 time, and of each quantity, in the order of their names, its
/// name and its values.
RowDigest sample_digest(std::int64_t step, double time,
                        const std::map<std::string, std::span<const double>, std::less<>>& quantities);

/// SHA-256 of "noether-constants-1\n" and of the datasets of `constant_groups()` that do not grow, of each group in the
/// order of their names: each name, and its values. 64 hexadecimal digits.
/// @throws FileError  for what HDF5 cannot read
std::string constants_digest(const Hdf5File& file);

/// SHA-256 of the attributes that a file is made with: all of /h5md, of the particles or the system, of /connectivity
/// and of /noether/topology with everything below, in the order of their paths and names, and of /noether commit, simd,
/// units and version. All of these must be there before the first frame. Texts of variable length count by their names
/// alone. 64 hexadecimal digits.
/// @param version  2; 1 of files whose scene and monitors have no digests of their own
/// @throws FileError  for what HDF5 cannot read
std::string headers_digest(const Hdf5File& file, int version = 2);

/// SHA-256 of "noether-monitor-1\n", the names of everything below the group of a monitor, and their attributes: an
/// attribute `headers_attribute` of the digests of its samples.
/// @throws FileError  for what HDF5 cannot read
std::string monitor_headers_digest(const Hdf5File& file, std::string_view monitor);

/// Writes the scene where the file does not have it yet, and its digest.
/// @throws FileError  for what HDF5 cannot write
void write_scene(const Hdf5File& file, const std::string& scene_toml);

/// Reads every link and every attribute of a file. @throws FileError  for what HDF5 cannot read
void read_headers(const Hdf5File& file);

}  // namespace noether::io
