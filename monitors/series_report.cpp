#include "monitors/series_report.hpp"

namespace noether {

MonitorReport report_of(const SeriesStatistics& series, const std::string& slope_unit) {
  MonitorReport report;
  report.samples = series.samples();
  if (report.samples == 0) return report;
  report.first = series.first();
  report.last = series.last();
  report.worst = series.worst();
  report.rms = series.rms();
  report.slope = series.slope();
  if (const auto line = series.line()) report.slope_error = line->error;
  report.slope_unit = slope_unit;
  return report;
}

}  // namespace noether
