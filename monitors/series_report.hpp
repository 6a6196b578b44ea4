#pragma once
/// What most monitors report: the figures of one series.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <string>

namespace noether {

/// First, last, largest and root mean square value, and the slope with its error; nothing without samples.
/// @param slope_unit  such as "1/day"; "1" in reduced units
MonitorReport report_of(const SeriesStatistics& series, const std::string& slope_unit);

}  // namespace noether
