/// Panels of resonances and of chaos: angles of mean motions, MEGNO, Lyapunov exponents.

#include "cli/plot_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_chaos_points = 4'000;
constexpr double degree = std::numbers::pi / 180;

/// Numbers of one place of a quantity against time.
PlotCurve chaos_curve(const io::MonitorSeries& monitor, const PlotTime& time, const std::vector<double>& values,
                      std::size_t first, std::size_t width, double unit) {
  PlotCurve curve;
  for (std::size_t k = 0; k < monitor.time.size() && first + k * width < values.size(); ++k) {
    const double value = values[first + k * width] / unit;
    if (std::isfinite(value)) curve.points.push_back({monitor.time[k] / time.length, value});
  }
  return curve;
}

const std::vector<double>* chaos_numbers(const io::MonitorSeries& monitor, const std::string& quantity) {
  const auto found = monitor.quantities.find(quantity);
  return found == monitor.quantities.end() ? nullptr : &found->second.second;
}

/// "Resonance 3 : 2 of Neptune and Pluto", as the scene has the monitor of this number; else a plain title.
std::string resonance_title(const PlotSource& source, std::size_t number) {
  const SceneValue* watches = value_at(source.scene, {"every"});
  const auto* list = watches == nullptr ? nullptr : watches->get<SceneValue::Array>();
  for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
    const SceneValue& one = (*list)[k];
    const SceneValue *type = one.find("type"), *bodies = one.find("bodies");
    const auto* name = type == nullptr ? nullptr : type->get<std::string>();
    if (name == nullptr || *name != "resonance_angle" || number-- > 0) continue;
    const auto* both = bodies == nullptr ? nullptr : bodies->get<SceneValue::Array>();
    const SceneValue *p = one.find("p"), *q = one.find("q");
    const auto* first = p == nullptr ? nullptr : p->get<std::int64_t>();
    const auto* order = q == nullptr ? nullptr : q->get<std::int64_t>();
    if (both == nullptr || both->size() != 2 || first == nullptr || order == nullptr) break;
    const auto *inner = (*both)[0].get<std::string>(), *outer = (*both)[1].get<std::string>();
    if (inner == nullptr || outer == nullptr) break;
    return fmt::format("Resonance {} : {} of {} and {}", *first + *order, *first, *inner, *outer);
  }
  return "Angle of a resonance";
}

}  // namespace

std::vector<PlotPanel> plot_resonances(const PlotSource& source) {
  std::vector<PlotPanel> panels;
  std::size_t number = 0;
  for (const io::MonitorSeries& monitor : source.monitors) {
    if (!monitor.name.starts_with("resonance_angle")) continue;
    const std::size_t at = number++;
    const std::vector<double>* values = chaos_numbers(monitor, "value");
    if (values == nullptr) continue;
    PlotPanel panel;
    panel.title = resonance_title(source, at);
    panel.x = source.time.axis;
    panel.y = {.label = "angle (deg)", .low = -180, .high = 180};
    PlotCurve curve = chaos_curve(monitor, source.time, *values, 0, 1, degree);
    if (curve.points.empty()) continue;
    // About 180 degrees the angle goes on where it would come back from the other side.
    const auto far = std::count_if(curve.points.begin(), curve.points.end(),
                                   [](const PlotPoint& point) { return std::abs(point.y) > 90; });
    if (2 * far > std::ssize(curve.points)) {
      for (PlotPoint& point : curve.points) point.y += point.y < 0 ? 360 : 0;
      panel.y.low = 0, panel.y.high = 360;
    }
    curve.separate = true;
    if (curve.points.size() > most_chaos_points) {
      std::vector<PlotPoint> some;
      const std::size_t stride = (curve.points.size() + most_chaos_points - 1) / most_chaos_points;
      for (std::size_t k = 0; k < curve.points.size(); k += stride) some.push_back(curve.points[k]);
      curve.points = std::move(some);
    }
    panel.curves.push_back(std::move(curve));
    panels.push_back(std::move(panel));
  }
  return panels;
}

std::vector<PlotPanel> plot_chaos(const PlotSource& source) {
  std::vector<PlotPanel> panels;
  for (const io::MonitorSeries& monitor : source.monitors) {
    const bool megno = monitor.name.starts_with("megno"), lyapunov = monitor.name.starts_with("lyapunov");
    const std::string quantity = megno ? "mean" : "exponent";
    const std::vector<double>* values = megno || lyapunov ? chaos_numbers(monitor, quantity) : nullptr;
    if (values == nullptr || monitor.time.empty()) continue;
    PlotPanel panel;
    panel.x = source.time.axis;
    const auto& shape = monitor.quantities.at(quantity).first;
    const std::size_t width = shape.empty() ? 1 : static_cast<std::size_t>(shape[0]);
    for (std::size_t k = 0; k < width; ++k) {
      PlotCurve curve = chaos_curve(monitor, source.time, *values, k, width, megno ? 1 : 1 / source.time.length);
      curve.points = thinned(curve.points, most_chaos_points);
      if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
    }
    if (panel.curves.empty()) continue;
    panel.title = megno ? fmt::format("MEGNO: <Y> = {:.4g}, 2 for regular motion", panel.curves[0].points.back().y)
                  : width > 1 ? "Lyapunov exponents"
                              : "Largest Lyapunov exponent";
    panel.y.label = megno ? "<Y>" : with_unit("exponent", source.time.unit == "1" ? "1" : "1/" + source.time.unit);
    fit_values(panel);
    panels.push_back(std::move(panel));
  }
  return panels;
}

}  // namespace noether
