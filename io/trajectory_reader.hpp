#pragma once
/// Reads the frames of a trajectory one by one.

#include "io/digest.hpp"
#include "io/frames.hpp"
#include "io/hdf5_file.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether::io {

class TrajectoryReader {
 public:
  /// @throws FileError if the file is no trajectory of noether
  explicit TrajectoryReader(const std::filesystem::path& path);

  /// Frames that every dataset has.
  Index frames() const { return frames_; }
  Frame frame(Index k) const;
  /// What all frames share; without frames.
  const Frames& shared() const { return shared_; }
  /// The digest that stands beside a frame; none in a file from before there were any.
  std::optional<RowDigest> digest(Index k) const;
  /// Rows of each dataset of the frames.
  std::vector<std::pair<std::string, Index>> lengths() const;
  /// How many sites of bodies stand in each frame; 0 where the file has none.
  Index sites() const { return site_count_; }
  const Hdf5File& file() const { return file_; }

 private:
  void open_particles(const std::filesystem::path& path);
  void open_system(const std::filesystem::path& path);

  void open_columns(const std::filesystem::path& path);
  void open_sites(const std::filesystem::path& path);

  Hdf5File file_;
  Hdf5Dataset position_, velocity_, variables_, image_, edges_;
  std::optional<Hdf5Dataset> digests_;
  std::map<std::string, Hdf5Dataset> columns_;  ///< others that move, by name
  std::map<std::string, Hdf5Dataset> sites_;    ///< position, velocity and image of sites, by path
  std::vector<std::int64_t> steps_;
  std::vector<double> times_;
  Frames shared_;
  Index frames_ = 0, site_count_ = 0;
  bool periodic_ = false;
  bool of_system_ = false;  ///< variables instead of particles
};

}  // namespace noether::io
