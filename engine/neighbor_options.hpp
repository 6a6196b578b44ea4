#pragma once
/// How neighbors are found, and what that took.

#include "engine/description.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace noether {

/// How a list of neighbors is kept. None of it changes a bit of what is computed, but `renewal`.
struct NeighborOptions {
  double skin = 0;      ///< pairs this much further apart than the range are listed too [length]; 0: chosen by cost
  Index renewal = 0;    ///< updates between two searches, whatever moved: pairs may be missed; 0: when somebody moved
  bool verify = false;  ///< compare with all pairs at every update, at a cost of O(n^2)

  static constexpr auto describe() {
    return part<NeighborOptions>(
        "neighbors", "how neighbors of pair forces are found",
        field<&NeighborOptions::skin>("skin", "length",
                                      "distance beyond the range that is still listed; 0: chosen for the lowest cost"),
        field<&NeighborOptions::renewal>(
            "renewal", "1", "steps between searches, even if pairs are missed; 0: whenever needed, so none is missed"),
        field<&NeighborOptions::verify>("verify", "1", "compare the list with all pairs at every step; slow"));
  }
  /// @throws Error  for what is negative, and for a comparison of lists that may miss pairs
  void check() const {
    if (!(skin >= 0 && skin < 1e100)) refuse_field("skin", skin, "is not a valid width; 0 or more is expected");
    if (renewal < 0)
      refuse_field("renewal", static_cast<double>(renewal), "is not a valid number of steps; 0 or more is expected");
    if (verify && renewal > 1) {
      refuse_field(
          "verify", "true",
          fmt::format("ends the run where a pair is missing, but renewal = {} may miss some; take one of them out",
                      renewal));
    }
  }
};

/// What a list has done so far.
struct NeighborStatistics {
  std::int64_t updates = 0, searches = 0;
  std::int64_t sorts = 0;     ///< searches that sorted particles into cells anew
  double pairs = 0;           ///< listed for each particle, by the last search
  double skin = 0;            ///< of the last search [length]
  double search_seconds = 0;  ///< in all searches
  double sort_seconds = 0;    ///< of these, in sorting particles and laying out their records
  std::size_t bytes = 0;      ///< of the list, its records and the search's own, after the last one
};

}  // namespace noether
