#pragma once
/// Two trajectories beside each other: where they first differ.

#include "numbers/types.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What makes a frame or a sample of one file that of the other: times that are the same to the bit, or steps. A step
/// that a file has twice, as between the steps of a method that chooses them, is compared with none.
enum class MatchBy : std::uint8_t { time, step };

/// The first moment at which two files differ, and how there.
struct RowDifference {
  std::int64_t step = 0, other_step = 0;
  double time = 0, other_time = 0;   ///< [time]
  std::string dataset;               ///< below its group: "position/value", "relative_error"
  Index differing = 0, numbers = 0;  ///< of the dataset at this moment: those that differ in any bit, and all of them
  std::string where;                 ///< the first of these, in words: "y of particle 6 'Saturn'"; may be empty
  double value = 0, other_value = 0;
  double largest = 0;  ///< largest difference of the dataset at this moment
};

/// The frames, or the samples of one monitor.
struct RowComparison {
  std::string name;                              ///< "frames", or that of the monitor
  Index compared = 0, equal = 0;                 ///< moments that both have; those at which nothing differs in any bit
  Index only_first = 0, only_second = 0;         ///< moments that only one has, and that no comparison is made of
  std::optional<RowDifference> difference = {};  ///< the first
};

struct RunComparison {
  std::vector<RowComparison> rows;  ///< the frames first, then monitors in the order of their names
  /// What stands once in a file and is another thing in the other, in words: ids, masses, names, units, monitors and
  /// their quantities.
  std::vector<std::string> constants;
  std::vector<std::string> notes;  ///< what differs beside the data: the line of the scene, the SIMD level, the version

  Index compared() const;
  /// Whether something was compared, and nothing of it differs.
  bool same() const;
};

/// Compares two trajectories, which may have been written at other cadences: each moment that both have.
/// @throws Error  for a checkpoint; FileError if a file cannot be read
/// @cost two frames in memory, and all samples of the monitors
RunComparison compare_runs(const std::filesystem::path& first, const std::filesystem::path& second,
                           MatchBy by = MatchBy::time);

}  // namespace noether::io
