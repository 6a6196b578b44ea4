#pragma once
/// What a page shows of a run: its frames as small numbers, and what its particles are.

#include "cli/particle_links.hpp"
#include "cli/run_caption.hpp"
#include "numbers/types.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace noether {

class Parts;

/// How a body moves between two frames of the page.
enum class ViewPath : std::uint8_t {
  smooth,   ///< on the cubic that meets positions and velocities, or on a line where these are not in the page
  arcs,     ///< on the Kepler arc about the primary that leads from one frame to the next; its ellipse is its trail
  ellipse,  ///< not at all: frames are too far apart for its phase; its ellipse is its trail
  jumps     ///< not at all
};

/// Frames of the page that a reader of the file asked for; 0: not asked for.
struct ViewWish {
  std::size_t frames = 0;  ///< so many, at equal distances
  std::size_t every = 0;   ///< each so many-th
};

struct ViewFrame {
  std::int64_t step = 0;
  double time = 0;                               ///< [time]
  Vec3<double> center = Vec3<double>::Zero();    ///< what positions are relative to [length]
  Vec3<double> velocity = Vec3<double>::Zero();  ///< of that center, for the velocities [length/time]
  Vec3<double> edges = Vec3<double>::Zero();     ///< of the periodic box [length]; 0 without one
};

/// The size of the relative error of the energy, or of its change.
struct ViewEnergy {
  std::vector<double> time;  ///< [time]
  std::vector<double> size;
};

struct ViewData {
  RunCaption caption;
  std::string length_unit;
  std::size_t frames_in_file = 0, particles_in_file = 0;
  std::size_t failed_frames = 0;  ///< left out, because a number in them is not finite

  std::vector<std::string> names, types;  ///< by particle; types empty where there are none
  std::vector<double> masses;             ///< [mass]
  ParticleLinks links;                    ///< bonds, and distances that are constrained
  std::int64_t primary = -1;              ///< the body that the others orbit; -1: none
  std::vector<double> mu;       ///< G (primary + body), by particle; empty without a primary [length^3/time^2]
  std::vector<ViewPath> paths;  ///< by particle, or one for all of many
  double spacing = 0;           ///< between neighbors in a periodic box [length]

  std::vector<ViewFrame> frames;
  /// Of a periodic box: position / edge in units of 2^-16, (frames, n, 3).
  std::vector<std::uint16_t> fractions;
  /// Otherwise: relative to the center of its frame [length], (frames, n, 3).
  std::vector<float> positions;
  /// Of few bodies outside of periodic boxes: relative to that of the center [length/time], (frames, n, 3).
  std::vector<float> velocities;
  ViewEnergy energy;

  std::size_t particles() const { return masses.size(); }
  bool periodic() const { return !fractions.empty(); }
};

/// At most so many particles are shown, and of fewer than `few_bodies` velocities, names and orbits too.
inline constexpr std::size_t most_viewed_particles = 200'000, few_bodies = 300;

/// Gathers what a page shows of a trajectory file. @param parts  those that its scene may name
/// @throws FileError if it cannot be read; Error if there are no particles or no frames in it
ViewData read_view_data(const std::filesystem::path& file, const ViewWish& wish, const Parts& parts);

/// The same data with fewer frames, at equal distances.
ViewData with_frames(const ViewData& data, std::size_t frames);

/// `count` of `all` numbers from 0 on at equal distances, the first and the last among them.
std::vector<std::size_t> spread_numbers(std::size_t all, std::size_t count);

}  // namespace noether
