#pragma once
/// The datasets of run.h5 while it is written.

#include "engine/monitor.hpp"
#include "io/buffered_dataset.hpp"
#include "io/trajectory_sites.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// A sample that waits for its file.
struct KeptSample {
  explicit KeptSample(const Sample& s)
      : monitor(s.monitor), step(s.step), time(s.time), series(s.series.begin(), s.series.end()), scale(s.scale) {}
  Sample sample() const { return {monitor, step, time, series, scale}; }

  std::string monitor;
  std::int64_t step;
  double time;
  std::vector<Series> series;
  std::optional<double> scale;
};

/// The datasets of one monitor, open.
struct MonitorDatasets {
  BufferedDataset<std::int64_t> step;
  BufferedDataset<double> time;
  std::vector<BufferedDataset<double>> quantities;      ///< in the order of the sample's series
  std::optional<BufferedDataset<std::int64_t>> digest;  ///< of each sample; none in a file from before there were any
  std::optional<double> scale;

  void write_out() {
    for (auto& quantity : quantities) quantity.write_out();
    if (digest) digest->write_out();
    time.write_out();
    step.write_out();
  }
};

/// The datasets of the frames, open: of particles, or of the variables of a system.
struct FrameDatasets {
  BufferedDataset<double> position, velocity, variables, edges;
  BufferedDataset<std::int64_t> step, image;
  BufferedDataset<double> time;
  std::map<std::string, BufferedDataset<double>> columns;  ///< others that move, by name
  SiteDatasets sites;
  std::optional<BufferedDataset<std::int64_t>> digest;  ///< of each frame; none in a file from before there were any

  /// The values that readers go by come last: a frame that has them has everything.
  void write_out() {
    for (auto& [name, column] : columns) column.write_out();
    sites.write_out();
    if (digest) digest->write_out();
    velocity.write_out();
    image.write_out();
    edges.write_out();
    time.write_out();
    step.write_out();
    position.write_out();
    variables.write_out();
  }
};

}  // namespace noether::io
