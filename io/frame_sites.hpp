#pragma once
/// Frames of rigid bodies as frames of their sites: the atoms of molecules, the points of asteroids.

#include "engine/sites.hpp"
#include "io/frames.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

class TrajectoryReader;

/// Sites in the order of the particles, points between them as they are, each with the velocity of its place:
/// v + Omega x arm.
class FrameSites {
 public:
  /// @throws FileError  if the file cannot be read as particles
  FrameSites(const TrajectoryReader& reader, const std::filesystem::path& file);

  /// Whether some body has several sites, so that they show more than its centre does.
  /// @throws FileError  where they stood in the file and are lost
  static bool are_in(const TrajectoryReader& reader);

  /// What all frames share. Sites have their names, those of bodies of one site and points the particle's, and all the
  /// orientation and spin of their body.
  const Frames& shared() const { return shared_; }
  /// Where the sites are in a frame of the bodies.
  Frame frame(const Frame& of_bodies);

 private:
  ParticleSystem<double> bodies_;
  std::vector<Index> order_, all_;  ///< the row of each particle, and their indices
  Sites<double> sites_;
  Frames shared_;
};

}  // namespace noether::io
