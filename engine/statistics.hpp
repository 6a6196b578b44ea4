#pragma once
/// Running figures of a series: worst, rms, slope with its error, in bounded memory.

#include "engine/description.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace noether {

/// Figures of a series y(t) that is never stored.
///
/// The slope is a least-squares line through block means. Blocks are of equal numbers of samples; when 64 are full,
/// neighbours are joined and blocks become twice as long, so there are 32 to 64 of them from 32 samples on. Its error
/// comes from the scatter of at least 20 block means about the line.
class SeriesStatistics {
 public:
  void add(double time, double value);

  std::int64_t samples() const { return samples_; }
  double first() const { return first_; }
  double last() const { return last_; }
  /// Largest absolute value.
  double worst() const { return worst_; }
  /// Root of the mean square.
  double rms() const { return samples_ > 0 ? std::sqrt(squares_ / static_cast<double>(samples_)) : 0; }
  /// Mean of all values; 0 without any.
  double mean() const;
  /// Standard error of the mean: from the scatter of the block means and their correlations, up to the first lag at
  /// which one is not positive (simpler than Geyer, who adds them in pairs); empty below 20 blocks. Too small for
  /// values that stay alike for a tenth of the series.
  /// @source Geyer1992
  std::optional<double> mean_error() const;

  struct Line {
    double slope, error;
  };
  /// Least squares through the block means; empty below 20 of them.
  std::optional<Line> line() const;
  /// Least squares through the block means; empty below two of them.
  std::optional<double> slope() const;

  static constexpr auto describe() {
    return part<SeriesStatistics>(
        "series_statistics", "running figures of a series", state<&SeriesStatistics::samples_>("samples"),
        state<&SeriesStatistics::first_>("first"), state<&SeriesStatistics::last_>("last"),
        state<&SeriesStatistics::worst_>("worst"), state<&SeriesStatistics::squares_>("squares"),
        state<&SeriesStatistics::block_>("block"), state<&SeriesStatistics::times_>("times"),
        state<&SeriesStatistics::means_>("means"), state<&SeriesStatistics::open_>("open"),
        state<&SeriesStatistics::open_time_>("open_time"), state<&SeriesStatistics::open_sum_>("open_sum"));
  }
  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  std::int64_t samples_ = 0;
  double first_ = 0, last_ = 0, worst_ = 0, squares_ = 0;
  std::int64_t block_ = 1;             ///< samples in a block
  std::vector<double> times_, means_;  ///< of the full blocks
  std::int64_t open_ = 0;              ///< samples in the block being filled
  double open_time_ = 0, open_sum_ = 0;
};

}  // namespace noether
