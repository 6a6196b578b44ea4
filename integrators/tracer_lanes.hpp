#pragma once
/// The tracers of a Wisdom-Holman splitting side by side in lanes.

#include "engine/particle_system.hpp"
#include "engine/saved_state.hpp"
#include "integrators/encounters.hpp"
#include "integrators/planet_path.hpp"
#include "integrators/wisdom_holman_lanes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Tracers follow the path of the planets over several steps, 64 at a time, so that those stay in the cache. Their bits
/// do not depend on how many steps that are, on which tracers are side by side, or on threads.
///
/// A row of eight tracers is of one level: they go round the center of the same innermost bodies. Like planets, each
/// has a prediction of the universal variable of its next arc, which is state.
class TracerLanes {
 public:
  /// @param tracers  their particles
  /// @param levels   by tracer, how many planets are inside its orbit
  void bind(const PlanetSystem& system, const std::vector<std::int64_t>& tracers, const std::vector<int>& levels);
  bool empty() const { return level_.empty(); }

  /// An arc that was not found.
  struct Lost {
    std::int64_t step = 0;  ///< of the run
    Index particle = 0;
  };
  /// Moves tracers in working coordinates along a path. Predictions are kept by `keep_predictions` alone.
  /// @param watch  where encounters that are nearer than `watch_from` said are noted
  std::optional<Lost> follow(ParticleSystem<double>& s, const PlanetPath& path, EncounterWatch& watch);
  void keep_predictions() { s_.swap(next_s_); }

  /// Takes over from which distances on encounters are news.
  void watch_from(const EncounterWatch& watch);

  /// Steps of a path that tracers should follow at once, where a step has so many numbers (at least 1).
  static std::int64_t steps_at_once(std::size_t numbers) {
    constexpr std::size_t most = 64, room = 6144;  // of 8 bytes
    return static_cast<std::int64_t>(std::clamp<std::size_t>(room / numbers, 1, most));
  }

  /// @param predicted  whether there are predictions to save
  void save(SavedState& saved, const std::string& prefix, bool predicted) const;
  /// @param last  the length of the arcs that the saved predictions are for
  /// @return whether there are predictions
  /// @throws Error  if they are not of these tracers
  bool load(const SavedState& saved, const std::string& prefix, double last);

 private:
  static constexpr std::size_t lanes = 8, rows_of_block = 8;

  struct Columns {
    double *x[3], *v[3], *x_low[3], *v_low[3];
    bool compensated;
  };
  static Columns columns_of(ParticleSystem<double>& s);
  void load_row(const Columns& from, std::size_t row, ArcRow& to) const;
  void store_row(const ArcRow& from, std::size_t row, const Columns& to);
  /// From the star, where a row has a place too many.
  double distance_of_none(std::size_t slot) const { return far_ * static_cast<double>(slot % lanes + 2); }

  std::vector<std::int64_t> particle_;     ///< eight of each row; -1: none
  std::vector<int> level_;                 ///< by row
  std::vector<double> mu_;                 ///< by level
  std::vector<std::int64_t> planets_;      ///< their particles
  std::vector<double> attraction_, near_;  ///< by planet: G m; see TracerTask
  std::vector<double> s_, next_s_;         ///< predictions, as `particle_`
  double star_mu_ = 0, relativity_ = 0, far_ = 1;
  bool jacobi_ = true;
};

}  // namespace noether
