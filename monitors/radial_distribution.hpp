#pragma once
/// The monitor of the radial distribution function.

#include "engine/monitor.hpp"
#include "engine/sites.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Watches the radial distribution function g(r) in a periodic box, averaged over the looks,
///
///     g(r_k) = <n_k> / (N_pairs 4 pi (r_k+1^3 - r_k^3) / (3 V)),   N_pairs = N_a N_b, or N_a (N_a - 1) of one type
///
/// n_k counts the pairs (i, j), i of the first and j of the second type, whose nearest images are between r_k and
/// r_k+1 apart; an ideal gas has g = 1. The coordination number is how many j are within r_k+1 of an i on the average.
/// Bonded pairs count like all others, unless `intramolecular` is false: then pairs of one molecule are left out of n_k
/// and of N_pairs. Molecules are those that the structure names (0: none, its particle is alone), or else what bonds
/// hold together.
/// @throws Error  when attached to a run without a periodic box, with a type that is not there, a range beyond half
///   of the shortest edge, or where pairs of one molecule are to be left out and there are neither molecules nor bonds
/// Of rigid bodies the pairs are those of their sites.
/// @cost O(n m) a look, m the number of particles in range of one; O(n) memory
/// @source Allen2017
class RadialDistribution {
 public:
  std::int64_t bins = 200;
  std::optional<double> range = {};     ///< largest distance [length]; default: half of the shortest edge
  std::vector<std::string> types = {};  ///< of the two particles; empty: all pairs
  bool intramolecular = true;           ///< whether pairs of one molecule count

  RadialDistribution() = default;
  explicit RadialDistribution(std::int64_t intervals, std::optional<double> largest = {},
                              std::vector<std::string> pair = {}, bool of_one_molecule = true)
      : bins(intervals), range(largest), types(std::move(pair)), intramolecular(of_one_molecule) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<RadialDistribution>(
        "radial_distribution", "radial distribution function g(r) of a periodic box, averaged over the samples",
        formula("g(r) = <n(r)> / (N_a N_b 4 pi r^2 dr / V),  N_a (N_a - 1) pairs of one type"),
        quantities("distance[bins] [length], value[bins], coordination[bins] [1]"), source("Allen2017"),
        field<&RadialDistribution::bins>("bins", "1", "intervals of distance"),
        field<&RadialDistribution::range>("range", "length", "largest distance; default: half of the shortest edge"),
        field<&RadialDistribution::types>("types", "1", "the two types of the pairs; default: all pairs"),
        field<&RadialDistribution::intramolecular>("intramolecular", "1", "whether pairs of one molecule count"),
        state<&RadialDistribution::counts_>("counts"), state<&RadialDistribution::expected_>("expected"),
        state<&RadialDistribution::centers_>("centers"), state<&RadialDistribution::reach_>("reach"),
        state<&RadialDistribution::samples_>("samples"), state<&RadialDistribution::unit_>("unit"));
  }

  /// @throws Error  for no bins, more than 100 000 of them, a range that is no length, or other than no or two types
  void check() const;
  /// @throws Error  as the class says
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    if (has_bodies(s)) return check_in(s.box(), Sites<Real>(s).particles().topology());
    check_in(s.box(), s.topology());
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// @throws Error if parts of the saved state do not fit
  void load(const SavedState& saved, const std::string& prefix);

  /// Middle of interval `k` [length].
  double distance(std::int64_t k) const { return (static_cast<double>(k) + 0.5) * reach_ / static_cast<double>(bins); }
  /// g(r) by interval, shape (bins); NaN before the first look, or without pairs.
  std::vector<double> values() const;
  /// Pairs counted so far by interval, each from both sides, shape (bins).
  const std::vector<std::int64_t>& counts() const { return counts_; }
  /// Neighbors up to the outer end of each interval, shape (bins).
  std::vector<double> coordination() const;

 private:
  void check_in(const Box& box, const Topology* topology) const;
  void count(const Box& box, const Topology* topology, const std::array<std::vector<double>, 3>& x);

  std::vector<std::int64_t> counts_;
  double expected_ = 0;  ///< pairs by volume, summed over the looks [1/length^3]
  double centers_ = 0;   ///< particles i, summed over the looks
  double reach_ = 0;     ///< the range that is counted [length]
  std::int64_t samples_ = 0;
  std::string unit_;
};

namespace detail {  // compiled once, in radial_distribution.cpp

extern template struct MonitorModel<RadialDistribution, double>;
extern template struct MonitorModel<RadialDistribution, Quad>;

}  // namespace detail

}  // namespace noether
