#include "cli/plot_axes.hpp"

#include "numbers/units.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// The least and the largest finite number of all curves above `floor`.
std::pair<double, double> span_of(const PlotPanel& panel, double floor) {
  double low = INFINITY, high = -INFINITY;
  for (const PlotCurve& curve : panel.curves) {
    for (const PlotPoint& p : curve.points) {
      if (!std::isfinite(p.y) || !(p.y > floor)) continue;
      low = std::min(low, p.y), high = std::max(high, p.y);
    }
  }
  return {low, high};
}

void whole_decades(PlotAxis& axis, double low, double high) {
  axis.logarithmic = true;
  axis.low = std::pow(10.0, std::floor(std::log10(low) + 1e-9));
  axis.high = std::pow(10.0, std::ceil(std::log10(high) - 1e-9));
  if (axis.high <= axis.low) axis.high = 10 * axis.low;
}

}  // namespace

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "1" ? text : text + " (" + unit + ")";
}

bool is_spaced_by_ratios(const std::vector<double>& times) {
  static constexpr double least_ratio = 100, crowded = 0.1;
  std::vector<double> positive;
  for (const double t : times) {
    if (t < 0 || !std::isfinite(t)) return false;
    if (t > 0) positive.push_back(t);
  }
  std::sort(positive.begin(), positive.end());
  if (positive.size() < 5 || positive.back() < least_ratio * positive.front()) return false;
  // No leap: a run that looks once at the start and then at the end of a long time is not spaced so.
  const double whole = std::log(positive.back() / positive.front());
  for (std::size_t k = 1; k < positive.size(); ++k) {
    if (std::log(positive[k] / positive[k - 1]) > 0.4 * whole) return false;
  }
  return positive[positive.size() / 2] < crowded * positive.back();
}

PlotTime time_axis(const std::string& unit, const std::vector<double>& frames, double begin, double end) {
  PlotTime time{.unit = unit == "1" ? "" : unit, .length = 1, .axis = {}};
  const double longest = std::max(std::abs(begin), std::abs(end));
  namespace solar = units::solar;
  const auto take = [&](const char* name, double length) { time.unit = name, time.length = length; };
  if (unit == "day") {
    if (longest >= 0.5 * solar::Myr) {
      take("Myr", solar::Myr);
    } else if (longest >= 5 * solar::kyr) {
      take("kyr", solar::kyr);
    } else if (longest >= 2 * solar::year) {
      take("yr", solar::year);
    }
  } else if (unit == "ps" && longest >= 2000) {
    take("ns", 1000);
  }
  time.axis = {.label = with_unit("time", time.unit), .low = begin / time.length, .high = end / time.length};
  if (is_spaced_by_ratios(frames)) {
    double first = INFINITY;
    for (const double t : frames) {
      if (t > 0) first = std::min(first, t);
    }
    time.axis.low = first / time.length;
    time.axis.logarithmic = true;
  }
  if (!(time.axis.high > time.axis.low)) time.axis.high = time.axis.low + 1;
  return time;
}

void fit_values(PlotPanel& panel) {
  const auto [low, high] = span_of(panel, panel.y.logarithmic ? 0 : -INFINITY);
  if (!(low <= high)) {
    panel.y.low = 0, panel.y.high = 1, panel.y.logarithmic = false;
    return;
  }
  if (panel.y.logarithmic) return whole_decades(panel.y, low, high);
  double air = 0.08 * (high - low);
  // Numbers that stay the same do not become noise over the whole height.
  air = std::max(air, 0.01 * std::max(std::abs(low), std::abs(high)));
  if (!(air > 0)) air = 1;
  panel.y.low = low - air, panel.y.high = high + air;
  if (low >= 0 && panel.y.low < 0) panel.y.low = 0;
}

void fit_errors(PlotPanel& panel) {
  const auto [low, high] = span_of(panel, 0);
  const bool several = panel.curves.size() > 1;
  if (!(high > 0)) {  // exactly zero all the time
    panel.y.low = 1e-17, panel.y.high = 1e-14, panel.y.logarithmic = true;
    return;
  }
  if (high < 10 * low && !several) {
    panel.y.logarithmic = false;
    panel.y.low = 0, panel.y.high = 1.15 * high;
    return;
  }
  // Rare dips of an error that changes sign would stretch the axis: few decades below the worst are enough.
  const double most = std::ceil(std::log10(high) + 0.1);
  const double bottom = std::max(std::floor(std::log10(low)), several ? -17.0 : most - 5);
  panel.y.logarithmic = true;
  panel.y.high = std::pow(10.0, several ? most + std::ceil((most - bottom) / 4) : most);  // room for the key
  panel.y.low = std::min(std::pow(10.0, bottom), panel.y.high / 100);
}

}  // namespace noether
