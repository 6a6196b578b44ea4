#pragma once
/// The frames of a run, read one at a time: a picture keeps in memory what it draws, not the file.

#include "io/frames.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace noether {

/// Frames whose numbers are all finite.
struct PlotFrames {
  using Read = std::function<io::Frame(std::size_t)>;

  PlotFrames() = default;
  /// Frames in memory. Their heaviest body is the primary where it has most of the mass.
  PlotFrames(io::Frames all);  // implicit: a place for frames that are read takes those that are there
  /// Frames that `read_frame` makes when it is asked for one of them.
  PlotFrames(io::Frames what_they_share, std::vector<double> their_times, Read read_frame);

  std::size_t size() const { return times.size(); }
  bool empty() const { return times.empty(); }
  std::size_t bodies() const { return shared.masses.size(); }
  /// Reads one. @cost O(n)
  io::Frame frame(std::size_t k) const { return read(k); }
  /// Closes the file until the next frame is read: whoever tries it in a child process needs it closed.
  void close_file() const {
    if (close) close();
  }

  io::Frames shared;                        ///< what all have in common; without frames
  std::vector<double> times;                ///< [time]
  std::vector<std::size_t> numbers;         ///< in the file
  bool periodic = false;                    ///< particles in a periodic box
  std::optional<std::size_t> primary = {};  ///< the body that the others orbit
  Read read;
  std::function<void()> close = {};
};

/// What a file has of frames: those that can be drawn, and how many there are in all.
struct FramesInFile {
  PlotFrames frames;
  std::size_t all = 0;
};

/// Looks at each frame of a file once; frames with numbers that are not finite, as of a run that failed, are left out.
/// @throws FileError
FramesInFile open_frames(const std::filesystem::path& file);

/// Frames in memory: every so many-th, at most about `most`, the one that is shown among them.
struct KeptFrames {
  io::Frames frames;
  std::size_t shown = 0;  ///< its place among them
};
KeptFrames kept_frames(const PlotFrames& all, std::size_t most, std::size_t shown);

/// How many frames of bodies are kept for their paths.
std::size_t most_frames_of_paths(std::size_t bodies);

}  // namespace noether
