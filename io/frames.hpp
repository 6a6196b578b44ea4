#pragma once
/// The frames of a trajectory, in memory.

#include "numbers/types.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace noether::io {

/// The sites of rigid bodies at one moment, row by row.
struct SiteRows {
  std::vector<double> positions = {}, velocities = {};  ///< (m, 3) [length], [length/time]
  std::vector<std::int32_t> images = {};                ///< (m, 3); empty without a periodic box
};

/// One moment of a trajectory; particles stand in id order. Of a first-order system, variables and nothing else.
struct Frame {
  std::int64_t step = 0;
  double time = 0;                            ///< [time]
  std::vector<double> positions, velocities;  ///< (n, 3), row by row [length], [length/time]
  std::vector<double> variables = {};         ///< (n)
  std::vector<std::int32_t> images = {};  ///< (n, 3), how often each has crossed the periodic box; empty without one
  std::vector<double> edges = {};         ///< (3), of the periodic box [length]; empty without one
  /// Other columns that move, by name: (n, width), row by row.
  std::map<std::string, std::vector<double>> columns = {};
  SiteRows sites = {};  ///< where the file has them
};

/// All frames of a trajectory and what they share.
struct Frames {
  std::string units, length_unit, time_unit, velocity_unit;  ///< name of the unit system, symbols of its units
  std::vector<std::int64_t> ids;
  std::vector<std::string> names;
  std::vector<double> masses;
  std::vector<std::string> types;           ///< by name; empty where particles have none
  std::vector<double> charges;              ///< [charge]; empty where particles have none
  std::vector<std::string> variable_names;  ///< "y[0]", "y[1]", ... where the system gives none
  /// Other columns that move, by name: how many numbers a particle has, and their unit.
  std::map<std::string, std::pair<Index, std::string>> columns;
  std::vector<Frame> frames;
};

}  // namespace noether::io
