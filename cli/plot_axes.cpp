#include "cli/plot_axes.hpp"

#include "cli/run_caption.hpp"
#include "numbers/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

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

/// Numbers of an axis differ little where its length is less than this beside their size.
constexpr double little = 1e-2;
/// So many characters of a mark have room beside the others.
constexpr std::size_t longest_mark = 8;

/// The power of ten that numbers leave to the name of their axis: 0 from 0.001 to 99 999, as they are read anyway.
/// Numbers of one size that differ little have it for no use: 2451545 and 2451546 are told apart, 2.451545 and 2.451546
/// times 10^6 are not read more easily.
int power_of(double largest, double span) {
  static constexpr double longest = 1e12;
  if (largest >= 1e5 && largest < longest && span < little * largest) return 0;
  if (largest >= 1e-3 && largest < 1e5) return 0;
  return static_cast<int>(std::floor(std::log10(largest) + 1e-9));
}

/// The marks at multiples of `step`, as numbers beside the offset in units of the power of ten.
void write_marks(PlotMarks& result, double low, double high, double step) {
  result.marks.clear();
  const double unit = std::pow(10.0, result.power);
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)), 0, 15);
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<std::int64_t>(std::floor(high / step + 1e-9));
  for (std::int64_t k = first; k <= last; ++k) {
    const double at = static_cast<double>(k) * step;
    std::string text = fmt::format("{:.{}f}", (at - result.offset) / unit, decimals);
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
    result.marks.emplace_back(at, k == 0 ? "0" : text);
  }
}

}  // namespace

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "1" ? text : text + " (" + unit + ")";
}

PlotLength readable_length(const std::string& unit, double size) {
  static constexpr double planetary = 0.01;
  if (unit == "au" && size > 0 && size < planetary) return {"km", units::solar::km};
  return {unit, 1};
}

PlotMarks marks_of(double low, double high, double most, std::optional<int> power) {
  const double span = high - low, raw = span / most, largest = std::max(std::abs(low), std::abs(high));
  if (!(raw > 0) || !std::isfinite(raw) || !(raw > 1e-13 * largest)) return {};
  const double decade = std::pow(10.0, std::floor(std::log10(raw))), digit = raw / decade;
  const double step = decade * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
  PlotMarks result{.marks = {}, .power = power.value_or(power_of(largest, span))};
  write_marks(result, low, high, step);
  const bool is_long = std::any_of(result.marks.begin(), result.marks.end(),
                                   [](const auto& mark) { return mark.second.size() > longest_mark; });
  if (!is_long || !(span < little * largest)) return result;
  const double round = std::pow(10.0, std::ceil(std::log10(span)));
  result.offset = std::floor(low / round) * round;
  result.power = power.value_or(power_of(high - result.offset, span));
  write_marks(result, low, high, step);
  return result;
}

PlotMarks decade_marks_of(double low, double high) {
  PlotMarks result{.marks = {}, .power = power_of(high, high - low)};
  const double unit = std::pow(10.0, result.power);
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10) {
    for (const double mark : {power, 2 * power, 5 * power}) {
      if (mark >= low && mark <= high) result.marks.emplace_back(mark, fmt::format("{:.6g}", mark / unit));
    }
  }
  return result;
}

std::string with_power(const std::string& label, int power) {
  if (power == 0) return label;
  static constexpr std::array<const char*, 10> figures = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                          "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = power < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(power))) text += figures[static_cast<std::size_t>(digit - '0')];
  if (label.empty()) return "in " + text;
  if (label.back() != ')') return label + " (" + text + ")";
  std::string result = label;
  return result.insert(result.rfind('(') + 1, text + " ");
}

std::string axis_name(const std::string& label, const PlotMarks& marks) {
  std::string name = label;
  if (marks.offset != 0) {
    const std::string taken_off = fmt::format(" {} {:.15g}", marks.offset > 0 ? "-" : "+", std::abs(marks.offset));
    const bool has_unit = !name.empty() && name.back() == ')';
    name.insert(has_unit ? name.rfind(" (") : name.size(), taken_off);
  }
  return with_power(name, marks.power);
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
  const ReadableTime readable = readable_time(unit, shown_time(begin, end));
  PlotTime time{.unit = readable.unit, .length = readable.length, .axis = {}};
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

std::string told_time(const PlotTime& time, double t) {
  const double shown = t / time.length, span = time.axis.high - time.axis.low;
  const double more = shown != 0 && span > 0 ? std::floor(std::log10(std::abs(shown) / span)) : 0;
  const int digits = std::isfinite(more) ? std::clamp(4 + static_cast<int>(more), 4, 15) : 4;
  return fmt::format("{:.{}g}{}{}", shown, digits, time.unit.empty() ? "" : " ", time.unit);
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
