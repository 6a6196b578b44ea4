#include "cli/plot_data.hpp"

#include "engine/error.hpp"
#include "engine/orbital_elements.hpp"
#include "engine/units.hpp"
#include "io/inspect.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_path_points = 20'000;
constexpr std::size_t most_samples = 2'000;
/// Frames are joined by lines where the path turns by less than this between two of them [rad].
constexpr double smooth_turn = 0.5;
/// Inner bodies get a picture of their own where they are this much smaller than the outermost.
constexpr double scale_gap = 8;

/// A time axis people read: the unit and its length in the unit of the file.
struct TimeUnit {
  std::string name;
  double length = 1;
};

TimeUnit time_unit_for(const std::string& unit, double end) {
  if (unit == "day") {
    namespace solar = units::solar;
    if (end >= 0.5 * solar::Myr) return {"Myr", solar::Myr};
    if (end >= 5 * solar::kyr) return {"kyr", solar::kyr};
    if (end >= 2 * solar::year) return {"yr", solar::year};
  }
  return {unit == "1" ? "" : unit, 1};
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "1" ? text : text + " (" + unit + ")";
}

/// The value of a dotted key of the stored scene.
const SceneValue* value_at(const SceneValue& scene, const std::vector<std::string_view>& keys) {
  const SceneValue* value = &scene;
  for (const std::string_view key : keys) {
    if (value != nullptr) value = value->find(key);
  }
  return value;
}

std::string text_at(const SceneValue& scene, const std::vector<std::string_view>& keys) {
  const SceneValue* value = value_at(scene, keys);
  if (value == nullptr) return "";
  const std::string* text = value->get<std::string>();
  return text != nullptr ? *text : to_text(*value);
}

/// Positions of one body in all frames, relative to the primary if there is one.
std::vector<PlotPoint> track(const io::Frames& all, std::size_t body, bool relative) {
  std::vector<PlotPoint> points;
  for (const io::Frame& frame : all.frames) {
    const double* x = frame.positions.data();
    const double* origin = relative ? x : nullptr;
    points.push_back({x[3 * body] - (origin ? origin[0] : 0), x[3 * body + 1] - (origin ? origin[1] : 0)});
  }
  return points;
}

/// Whether frames are so dense that straight lines between them look like the path.
bool is_smooth(const std::vector<PlotPoint>& points) {
  std::vector<double> turns;
  for (std::size_t k = 2; k < points.size(); ++k) {
    const double ax = points[k - 1].x - points[k - 2].x, ay = points[k - 1].y - points[k - 2].y;
    const double bx = points[k].x - points[k - 1].x, by = points[k].y - points[k - 1].y;
    turns.push_back(std::abs(std::atan2(ax * by - ay * bx, ax * bx + ay * by)));
  }
  if (turns.empty()) return false;
  const auto high = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() * 9 / 10);
  std::nth_element(turns.begin(), high, turns.end());
  return *high < smooth_turn;
}

std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points, std::size_t most) {
  const std::size_t stride = (points.size() + most - 1) / most;
  std::vector<PlotPoint> kept;
  for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(stride, 1)) kept.push_back(points[k]);
  return kept;
}

/// The Kepler ellipse a body follows about particle 0 at one frame; empty if it is not bound.
std::vector<PlotPoint> ellipse(const io::Frames& all, const io::Frame& frame, std::size_t body, double G) {
  const auto vector = [&](const std::vector<double>& rows) {
    return Vec3<double>(rows[3 * body] - rows[0], rows[3 * body + 1] - rows[1], rows[3 * body + 2] - rows[2]);
  };
  const double mu = G * (all.masses[0] + all.masses[body]);
  OrbitalElements<double> o = elements_from_state<double>(vector(frame.positions), vector(frame.velocities), mu);
  if (!(o.a > 0) || !(o.e < 1) || !std::isfinite(o.inc)) return {};
  std::vector<PlotPoint> points;
  constexpr int pieces = 360;
  for (int k = 0; k <= pieces; ++k) {
    // Equal steps of the eccentric anomaly: round where the orbit is.
    const double E = 2 * std::numbers::pi * k / pieces;
    o.M = E - o.e * std::sin(E);
    const Vec3<double> x = state_from_elements<double>(o, mu).first;
    points.push_back({x[0], x[1]});
  }
  return points;
}

double constant_of_gravitation(const io::Frames& all, const SceneValue& scene) {
  const SceneValue* given = value_at(scene, {"hamiltonian", "G"});
  if (given != nullptr && given->get<double>() != nullptr) return *given->get<double>();
  return unit_system(all.units).G;
}

/// Center and width of the square that holds every path.
void frame_orbits(PlotOrbits& picture, bool centered) {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (const PlotOrbit& orbit : picture.orbits) {
    for (const auto* points : {&orbit.path, &orbit.samples}) {
      for (const PlotPoint& p : *points) {
        low[0] = std::min(low[0], p.x), high[0] = std::max(high[0], p.x);
        low[1] = std::min(low[1], p.y), high[1] = std::max(high[1], p.y);
      }
    }
  }
  if (!(high[0] >= low[0])) return;
  double half = std::max(high[0] - low[0], high[1] - low[1]) / 2;
  picture.center = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
  if (centered) {
    picture.center = {};
    half = std::max({-low[0], high[0], -low[1], high[1]});
  }
  picture.half_width = half > 0 ? 1.08 * half : 1;
}

/// Parts the inner bodies from the outer ones where the gap of scales is wide.
std::vector<PlotOrbits> on_scales(PlotOrbits all, const std::string& unit) {
  std::vector<double> sizes;
  for (const PlotOrbit& orbit : all.orbits) {
    if (!orbit.primary) sizes.push_back(orbit.size);
  }
  std::sort(sizes.begin(), sizes.end());
  if (sizes.size() < 4 || sizes[1] * scale_gap > sizes.back()) return {std::move(all)};
  // The widest gap (as a ratio) between neighbors divides them.
  std::size_t first_outer = 1;
  for (std::size_t k = 2; k < sizes.size(); ++k) {
    if (sizes[k] / sizes[k - 1] > sizes[first_outer] / sizes[first_outer - 1]) first_outer = k;
  }
  PlotOrbits inner = all;
  std::erase_if(inner.orbits, [&](const PlotOrbit& o) { return !o.primary && o.size >= sizes[first_outer]; });
  if (inner.orbits.size() < 3) return {std::move(all)};
  inner.title = "Inner orbits";
  all.title = "All orbits";
  inner.x_label = with_unit("x", unit), inner.y_label = with_unit("y", unit);
  frame_orbits(inner, true);
  return {std::move(all), std::move(inner)};
}

std::vector<PlotOrbits> read_orbits(const io::Frames& all, const SceneValue& scene) {
  const std::size_t n = all.masses.size();
  if (all.frames.empty() || n == 0) return {};
  double others = 0;
  for (std::size_t i = 1; i < n; ++i) others += all.masses[i];
  const bool relative = n > 1 && all.masses[0] > 10 * others;
  const double G = constant_of_gravitation(all, scene);

  PlotOrbits picture;
  picture.title = "Orbits";
  const std::string about = relative ? " from " + all.names[0] : "";
  picture.x_label = with_unit("x" + about, all.length_unit);
  picture.y_label = with_unit("y" + about, all.length_unit);
  for (std::size_t i = 0; i < n; ++i) {
    PlotOrbit orbit{.name = all.names[i], .color = relative ? i - 1 : i};
    const std::vector<PlotPoint> points = track(all, i, relative);
    orbit.primary = relative && i == 0;
    orbit.end = points.back();
    if (orbit.primary) {
      orbit.color = 0;
    } else if (is_smooth(points)) {
      orbit.path = thinned(points, most_path_points);
    } else {
      orbit.samples = thinned(points, most_samples);
      if (relative) orbit.path = ellipse(all, all.frames.back(), i, G);
    }
    for (const PlotPoint& p : points) orbit.size = std::max(orbit.size, std::hypot(p.x, p.y));
    picture.orbits.push_back(std::move(orbit));
  }
  frame_orbits(picture, relative);
  if (!relative) return {std::move(picture)};
  return on_scales(std::move(picture), all.length_unit);
}

std::optional<PlotError> read_error(const io::MonitorSeries& monitor, double time_length) {
  const auto found = monitor.quantities.find("relative_error");
  if (found == monitor.quantities.end()) return {};
  PlotError error;
  const std::vector<double>& values = found->second.second;
  for (std::size_t k = 0; k < values.size() && k < monitor.time.size(); ++k) {
    const double size = std::abs(values[k]);
    if (!(size > 0) || !std::isfinite(size)) continue;
    error.points.push_back({monitor.time[k] / time_length, size});
    error.worst = std::max(error.worst, size);
  }
  return error;
}

/// "wisdom_holman, aba_10_6_4, step 100 day".
std::string method_line(const SceneValue& scene) {
  std::string line;
  const std::string step = text_at(scene, {"integrator", "step"});
  for (const std::string& part : {text_at(scene, {"hamiltonian", "type"}), text_at(scene, {"integrator", "method"}),
                                  step.empty() ? step : "step " + step}) {
    if (!part.empty()) line += (line.empty() ? "" : ", ") + part;
  }
  return line;
}

}  // namespace

PlotData read_plot_data(const std::filesystem::path& file) {
  const io::FileInfo about = io::info(file);
  if (about.kind != "trajectory") {
    throw Error(fmt::format("{} is a {}, which holds one moment; plot the run.h5 beside it", file.string(), about.kind));
  }
  const SceneValue scene = parse_toml(about.scene_toml, "the scene stored in " + file.string());
  const io::Frames frames = io::read_frames(file);
  const std::vector<io::MonitorSeries> monitors = io::read_monitors(file);

  PlotData data;
  double end = frames.frames.empty() ? 0 : frames.frames.back().time;
  for (const auto& monitor : monitors) {
    if (!monitor.time.empty()) end = std::max(end, monitor.time.back());
  }
  const TimeUnit unit = time_unit_for(frames.time_unit.empty() ? about.time_unit : frames.time_unit, end);
  data.title = text_at(scene, {"title"});
  if (data.title.empty()) data.title = file.filename().string();
  data.subtitle = method_line(scene);
  data.time_label = with_unit("time", unit.name);
  data.end = end / unit.length;
  data.orbits = read_orbits(frames, scene);
  for (const auto& [name, title] : {std::pair{"energy", "Energy"}, std::pair{"angular_momentum", "Angular momentum"}}) {
    const auto found = std::find_if(monitors.begin(), monitors.end(), [&](const auto& m) { return m.name == name; });
    if (found == monitors.end()) continue;
    auto error = read_error(*found, unit.length);
    if (!error) continue;
    error->title = title;
    error->label = "relative error";
    data.errors.push_back(std::move(*error));
  }
  if (data.orbits.empty() && data.errors.empty()) {
    throw Error(fmt::format("{} has nothing to draw; it needs frames (a trajectory writer) or the monitors energy or "
                            "angular_momentum",
                            file.string()));
  }
  return data;
}

}  // namespace noether
