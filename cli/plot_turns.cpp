/// Panels of rigid bodies: the ways of their axes, and how one of them turns.

#include "cli/plot_source.hpp"
#include "engine/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_points = 4'000, most_bodies = 12;

/// The third axis of a body in a frame; nothing for a point, whose quaternion never turns.
std::array<double, 3> third_axis(const std::vector<double>& q, std::size_t body) {
  const Quaternion<double> of(q[4 * body], q[4 * body + 1], q[4 * body + 2], q[4 * body + 3]);
  const Vec3<double> axis = rotation_matrix(of).col(2);
  return {axis[0], axis[1], axis[2]};
}

const std::vector<double>* numbers_of(const io::MonitorSeries& monitor, const char* quantity, std::size_t width) {
  const auto found = monitor.quantities.find(quantity);
  if (found == monitor.quantities.end()) return nullptr;
  const std::vector<Index>& shape = found->second.first;
  const std::size_t numbers = shape.empty() ? 1 : static_cast<std::size_t>(shape[0]);
  return numbers == width ? &found->second.second : nullptr;
}

}  // namespace

std::optional<PlotPanel> plot_axes(const PlotSource& source) {
  const std::string column(BodyOrientation::name);
  if (source.frames.size() < 2 || source.frames.shared.columns.count(column) == 0) return {};
  const std::size_t bodies = source.frames.bodies();
  if (bodies == 0 || bodies > most_bodies) return {};
  const io::Frames frames = kept_frames(source.frames, most_points, source.frames.size() - 1).frames;
  PlotPanel panel;
  panel.title = "Third axes of bodies, from above";
  panel.x = {.label = "x of the axis", .low = -1, .high = 1};
  panel.y = {.label = "y of the axis", .low = -1, .high = 1};
  double reach = 0;
  for (std::size_t body = 0; body < bodies; ++body) {
    PlotCurve curve{.name = "", .points = {}, .color = body_color(source.frames, body)};
    for (const io::Frame& frame : frames.frames) {
      const auto found = frame.columns.find(column);
      if (found == frame.columns.end() || found->second.size() < 4 * (body + 1)) continue;
      const std::array<double, 3> axis = third_axis(found->second, body);
      if (!std::isfinite(axis[0] + axis[1])) continue;
      curve.points.push_back({axis[0], axis[1]});
      reach = std::max({reach, std::abs(axis[0]), std::abs(axis[1])});
    }
    if (curve.points.size() > 1) panel.curves.push_back(std::move(curve));
  }
  if (panel.curves.empty() || !(reach > 1e-9)) return {};  // all turn about axes that stay
  panel.x.low = panel.y.low = -1.1 * reach;
  panel.x.high = panel.y.high = 1.1 * reach;
  return panel;
}

std::optional<PlotPanel> plot_spin(const PlotSource& source) {
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "spin");
  if (monitor == nullptr) return {};
  PlotPanel panel;
  panel.x = source.time.axis;
  const auto add = [&](const std::string& name, const std::vector<double>& values, std::size_t first, std::size_t width,
                       double unit) {
    PlotCurve curve{.name = name, .points = {}};
    for (std::size_t k = 0; k < monitor->time.size() && first + k * width < values.size(); ++k) {
      const double value = values[first + k * width] / unit;
      if (std::isfinite(value)) curve.points.push_back({monitor->time[k] / source.time.length, value});
    }
    if (curve.points.empty()) return;
    curve.points = thinned(curve.points, most_points);
    panel.curves.push_back(std::move(curve));
  };
  if (const std::vector<double>* angle = numbers_of(*monitor, "angle", 1))
    add("", *angle, 0, 1, std::numbers::pi / 180);
  panel.title = "Angle of the resonance of spin and orbit";
  panel.y.label = "angle (deg)";
  const std::vector<double>* rate = numbers_of(*monitor, "rate", 3);
  if (panel.curves.empty() && rate != nullptr) {
    panel.title = "Rates about the principal axes";
    panel.y.label = with_unit("rate", source.time.unit == "1" ? "1" : "1/" + source.time.unit);
    for (std::size_t k = 0; k < 3; ++k) add(fmt::format("axis {}", k + 1), *rate, k, 3, 1 / source.time.length);
  }
  if (panel.curves.empty()) return {};
  fit_values(panel);
  return panel;
}

}  // namespace noether
