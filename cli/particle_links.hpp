#pragma once
/// What holds particles together in a picture: bonds of a structure, rods of a scene.

#include "io/frames.hpp"
#include "io/hdf5_file.hpp"
#include "numbers/types.hpp"
#include "numbers/units.hpp"
#include "scene/parts.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace noether {

/// A body at the end of a rod that hangs at a point.
struct Anchor {
  std::size_t body = 0;
  Vec3<double> point = Vec3<double>::Zero();  ///< [length]
};

/// Lines between particles, by their places in the picture, and from particles to fixed points.
struct ParticleLinks {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<Anchor> anchors;

  bool empty() const { return pairs.empty() && anchors.empty(); }
};

/// Bonds of the file, and what the scene's constraints say that pictures show of them (`Drawn`).
/// @param rows  particles of the file that are shown
ParticleLinks read_links(const io::Hdf5File& file, const SceneValue& scene, const Parts& parts, const UnitSystem& units,
                         const io::Frames& shared, const std::vector<std::size_t>& rows);

/// The molecule of each of `n` particles: those that pairs join have the same number, from 0.
std::vector<std::size_t> molecules_of(std::size_t n, const ParticleLinks& links);

}  // namespace noether
