#include "cli/plot_data.hpp"

#include "engine/orbital_elements.hpp"
#include "engine/sums.hpp"
#include "io/inspect.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"
#include "numbers/units.hpp"
#include "scene/parts.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_path_points = 20'000;
constexpr std::size_t most_samples = 2'000;
/// Frames are joined where the path turns by less than this between two of them [rad].
constexpr double smooth_turn = 0.4;
/// Inner bodies get a picture of their own where they are this much smaller than the outermost.
constexpr double scale_gap = 8;
/// Variables of a system do where they are this much smaller than the largest.
constexpr double small_gap = 100;

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

/// What one body does in all frames, relative to the primary if there is one.
struct Track {
  std::vector<PlotPoint> x, v;
  std::vector<double> time;
};

Track track_of(const io::Frames& all, std::size_t body, bool relative) {
  Track track;
  const auto in_plane = [&](const std::vector<double>& rows) {
    return PlotPoint{rows[3 * body] - (relative ? rows[0] : 0), rows[3 * body + 1] - (relative ? rows[1] : 0)};
  };
  for (const io::Frame& frame : all.frames) {
    track.x.push_back(in_plane(frame.positions));
    track.v.push_back(in_plane(frame.velocities));
    track.time.push_back(frame.time);
  }
  return track;
}

/// Whether frames are dense enough to join them: from one to the next the path turns little, and the body comes as far
/// as its velocity says (a body seen once in many periods does not).
bool is_dense(const Track& track) {
  std::size_t rough = 0;
  for (std::size_t k = 1; k < track.x.size(); ++k) {
    const double time = track.time[k] - track.time[k - 1];
    const double ax = track.v[k - 1].x * time, ay = track.v[k - 1].y * time;
    const double bx = track.x[k].x - track.x[k - 1].x, by = track.x[k].y - track.x[k - 1].y;
    const double turn = std::abs(std::atan2(ax * by - ay * bx, ax * bx + ay * by));
    if (turn > smooth_turn || std::hypot(bx, by) < 0.7 * std::hypot(ax, ay)) ++rough;
  }
  return track.x.size() > 2 && 10 * rough < track.x.size();
}

/// The path through all frames: between two of them the cubic that meets positions and velocities.
std::vector<PlotPoint> path_through(const Track& track) {
  const std::size_t frames = track.x.size(), pieces = std::clamp<std::size_t>(most_path_points / frames, 1, 12);
  std::vector<PlotPoint> points = {track.x.front()};
  for (std::size_t k = 1; k < frames; ++k) {
    const double h = track.time[k] - track.time[k - 1];
    const PlotPoint &a = track.x[k - 1], &b = track.x[k], &va = track.v[k - 1], &vb = track.v[k];
    for (std::size_t j = 1; j <= pieces; ++j) {
      const double u = static_cast<double>(j) / static_cast<double>(pieces), w = 1 - u;
      const double fa = w * w * (1 + 2 * u), fb = u * u * (1 + 2 * w), ga = h * u * w * w, gb = -h * u * u * w;
      points.push_back({fa * a.x + fb * b.x + ga * va.x + gb * vb.x, fa * a.y + fb * b.y + ga * va.y + gb * vb.y});
    }
  }
  return points;
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

/// @throws FileError if the scene gives none, and the file names no unit system
double constant_of_gravitation(const io::Frames& all, const SceneValue& scene, const std::filesystem::path& file) {
  const SceneValue* given = value_at(scene, {"hamiltonian", "G"});
  if (given != nullptr && given->get<double>() != nullptr) return *given->get<double>();
  return io::known_units(all.units, file).G;
}

/// The corners of the smallest picture that holds every path.
void fit(PlotOrbits& picture) {
  picture.low = {INFINITY, INFINITY}, picture.high = {-INFINITY, -INFINITY};
  for (const PlotOrbit& orbit : picture.orbits) {
    for (const auto* points : {&orbit.path, &orbit.samples}) {
      for (const PlotPoint& p : *points) {
        picture.low = {std::min(picture.low.x, p.x), std::min(picture.low.y, p.y)};
        picture.high = {std::max(picture.high.x, p.x), std::max(picture.high.y, p.y)};
      }
    }
  }
  if (!(picture.low.x <= picture.high.x)) picture.low = {-1, -1}, picture.high = {1, 1};
}

/// Makes the picture a square with some air; `centered` about the origin.
void make_square(PlotOrbits& picture, bool centered) {
  PlotPoint& low = picture.low;
  PlotPoint& high = picture.high;
  const PlotPoint center = centered ? PlotPoint{} : PlotPoint{(low.x + high.x) / 2, (low.y + high.y) / 2};
  double half = 1.08 * std::max({high.x - center.x, center.x - low.x, high.y - center.y, center.y - low.y});
  if (!(half > 0)) half = 1;
  low = {center.x - half, center.y - half};
  high = {center.x + half, center.y + half};
}

/// Corners about all paths, with some air above and below.
void fit_with_air(PlotOrbits& picture) {
  fit(picture);
  double air = 0.08 * (picture.high.y - picture.low.y);
  air = std::max(air, 1e-9 * std::max(std::abs(picture.low.y), std::abs(picture.high.y)));
  if (!(air > 0)) air = 1;
  picture.low.y -= air;
  picture.high.y += air;
}

/// Where every body stays on one line: x against time.
PlotOrbits against_time(const io::Frames& all, const TimeUnit& unit) {
  PlotOrbits picture;
  picture.title = "Positions";
  picture.x_label = with_unit("time", unit.name);
  picture.y_label = with_unit("x", all.length_unit);
  for (std::size_t i = 0; i < all.masses.size(); ++i) {
    Track track = track_of(all, i, false);
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      track.x[k] = {track.time[k] / unit.length, track.x[k].x};
      track.v[k] = {1 / unit.length, track.v[k].x};
    }
    PlotOrbit orbit{.name = all.names[i], .color = i};
    orbit.end = track.x.back();
    orbit.path = thinned(path_through(track), most_path_points);
    picture.orbits.push_back(std::move(orbit));
  }
  fit_with_air(picture);
  return picture;
}

/// The variables of a system against time; of many, some at equal distances. Those that could not be seen beside the
/// largest have a picture of their own too.
std::vector<PlotOrbits> variables_against_time(const io::Frames& all, const TimeUnit& unit) {
  static constexpr std::size_t most = 8;
  PlotOrbits picture;
  picture.title = "Variables";
  picture.x_label = with_unit("time", unit.name);
  picture.y_label = "y";
  const std::size_t n = all.variable_names.size(), shown = std::min(n, most);
  double largest = 0;
  for (std::size_t k = 0; k < shown; ++k) {
    const std::size_t i = shown < 2 ? 0 : k * (n - 1) / (shown - 1);
    PlotOrbit curve{.name = all.variable_names[i], .color = k};
    std::vector<PlotPoint> points;
    for (const io::Frame& frame : all.frames) {
      points.push_back({frame.time / unit.length, frame.variables[i]});
      curve.extent = std::max(curve.extent, std::abs(frame.variables[i]));
    }
    largest = std::max(largest, curve.extent);
    curve.end = points.back();
    curve.path = thinned(points, most_path_points);
    picture.orbits.push_back(std::move(curve));
  }
  PlotOrbits small = picture;
  small.title = "Small variables";
  std::erase_if(small.orbits, [&](const PlotOrbit& o) { return o.extent == 0 || o.extent * small_gap > largest; });
  fit_with_air(picture);
  if (small.orbits.empty()) return {std::move(picture)};
  fit_with_air(small);
  return {std::move(picture), std::move(small)};
}

bool all_on_one_line(const io::Frames& all) {
  double x = 0, y = 0;
  for (const io::Frame& frame : all.frames) {
    for (std::size_t k = 0; k + 2 < frame.positions.size(); k += 3) {
      x = std::max(x, std::abs(frame.positions[k]));
      y = std::max({y, std::abs(frame.positions[k + 1]), std::abs(frame.positions[k + 2])});
    }
  }
  return x > 0 && y < 1e-9 * x;
}

/// Parts the inner bodies from the outer ones where the gap of scales is wide.
std::vector<PlotOrbits> on_scales(PlotOrbits all, const std::string& unit) {
  std::vector<double> sizes;
  for (const PlotOrbit& orbit : all.orbits) {
    if (!orbit.primary) sizes.push_back(orbit.extent);
  }
  std::sort(sizes.begin(), sizes.end());
  if (sizes.size() < 4 || sizes[1] * scale_gap > sizes.back()) return {std::move(all)};
  // The widest gap (as a ratio) between neighbors divides them.
  std::size_t first_outer = 1;
  for (std::size_t k = 2; k < sizes.size(); ++k) {
    if (sizes[k] / sizes[k - 1] > sizes[first_outer] / sizes[first_outer - 1]) first_outer = k;
  }
  PlotOrbits inner = all;
  std::erase_if(inner.orbits, [&](const PlotOrbit& o) { return !o.primary && o.extent >= sizes[first_outer]; });
  if (inner.orbits.size() < 3) return {std::move(all)};
  inner.title = "Inner orbits";
  all.title = "All orbits";
  inner.x_label = with_unit("x", unit), inner.y_label = with_unit("y", unit);
  fit(inner);
  make_square(inner, true);
  return {std::move(all), std::move(inner)};
}

PlotOrbit orbit_of(const io::Frames& all, std::size_t body, bool relative, double G) {
  PlotOrbit orbit{.name = all.names[body], .color = relative && body > 0 ? body - 1 : body};
  const Track track = track_of(all, body, relative);
  orbit.primary = relative && body == 0;
  orbit.end = track.x.back();
  for (const PlotPoint& p : track.x) orbit.extent = std::max(orbit.extent, std::hypot(p.x, p.y));
  if (orbit.primary) return orbit;
  if (is_dense(track)) {
    orbit.path = thinned(path_through(track), most_path_points);
  } else {
    orbit.samples = thinned(track.x, most_samples);
    if (relative) orbit.path = ellipse(all, all.frames.back(), body, G);
  }
  return orbit;
}

std::vector<PlotOrbits> read_orbits(const io::Frames& all, const SceneValue& scene, const TimeUnit& unit,
                                    const std::filesystem::path& file) {
  const std::size_t n = all.masses.size();
  if (!all.frames.empty() && !all.variable_names.empty()) return variables_against_time(all, unit);
  if (all.frames.empty() || n == 0) return {};
  if (all_on_one_line(all)) return {against_time(all, unit)};
  const double others =
      sum_over<double>(static_cast<Index>(n) - 1, [&](Index i) { return all.masses[static_cast<std::size_t>(i) + 1]; });
  const bool relative = n > 1 && all.masses[0] > 10 * others;

  PlotOrbits picture;
  const std::string about = relative ? " from " + all.names[0] : "";
  picture.x_label = with_unit("x" + about, all.length_unit);
  picture.y_label = with_unit("y" + about, all.length_unit);
  const double G = constant_of_gravitation(all, scene, file);
  for (std::size_t i = 0; i < n; ++i) picture.orbits.push_back(orbit_of(all, i, relative, G));
  fit(picture);
  make_square(picture, relative);
  if (!relative) return {std::move(picture)};
  return on_scales(std::move(picture), all.length_unit);
}

/// Whether the energy is meant to change: drag, a bath, or a force that depends on time.
bool changes_energy(const SceneValue& scene, const Parts& parts) {
  if (value_at(scene, {"hamiltonian", "thermostat"}) != nullptr) return true;
  const SceneValue* forces = value_at(scene, {"hamiltonian", "force"});
  if (forces == nullptr || !forces->is_table_list()) return false;
  const auto changes = [&](const SceneValue& force) {
    const std::string type = text_at(force, {"type"});
    return std::any_of(parts.forces().begin(), parts.forces().end(), [&](const Parts::ForceKind& kind) {
      return kind.info.name == type && (kind.claims.dissipative || kind.claims.time_dependent);
    });
  };
  return std::any_of(forces->get<SceneValue::Array>()->begin(), forces->get<SceneValue::Array>()->end(), changes);
}

/// Adds the sizes of `values[first]`, `values[first + stride]`, ... to an error.
void add_curve(PlotError& error, const std::string& name, const std::vector<double>& time,
               const std::vector<double>& values, std::size_t first, std::size_t stride) {
  PlotCurve curve{name, {}};
  error.worst = 0;
  for (std::size_t k = 0; k < time.size() && first + k * stride < values.size(); ++k) {
    const double size = std::abs(values[first + k * stride]);
    if (!(size > 0) || !std::isfinite(size)) continue;
    curve.points.push_back({time[k], size});
    error.worst = std::max(error.worst, size);
  }
  error.curves.push_back(std::move(curve));
}

/// The relative error of a monitor; of constraints the largest violation; of a shadow Hamiltonian the change of each
/// order since the start.
std::optional<PlotError> read_error(const io::MonitorSeries& monitor, double time_length) {
  std::vector<double> time = monitor.time;
  for (double& t : time) t /= time_length;
  PlotError error;
  const bool residual = monitor.name == "constraint_residual";
  const auto single = monitor.quantities.find(residual ? "worst" : "relative_error");
  if (single != monitor.quantities.end()) {
    add_curve(error, "", time, single->second.second, 0, 1);
    return error;
  }
  const auto found = monitor.quantities.find("value");
  if (monitor.name != "shadow_hamiltonian" || found == monitor.quantities.end() || found->second.first.size() != 1) {
    return {};
  }
  const auto orders = static_cast<std::size_t>(found->second.first[0]);
  std::vector<double> change = found->second.second;
  for (std::size_t k = change.size(); k-- > 0;)
    change[k] = (change[k] - change[k % orders]) / monitor.scale.value_or(1);
  for (std::size_t k = 0; k < orders; ++k) {
    const bool known = k < monitor.orders.size();
    add_curve(error, known ? fmt::format("order {}", monitor.orders[k]) : "", time, change, k, orders);
  }
  return error;
}

/// "wisdom_holman, aba_10_6_4, step 100 day".
std::string method_line(const SceneValue& scene) {
  std::string line;
  const std::string step = text_at(scene, {"integrator", "step"});
  for (const std::string& part : {text_at(scene, {"hamiltonian", "type"}), text_at(scene, {"system", "type"}),
                                  text_at(scene, {"integrator", "method"}), step.empty() ? step : "step " + step}) {
    if (!part.empty()) line += (line.empty() ? "" : ", ") + part;
  }
  return line;
}

/// The scene that a file was made from. @throws FileError if it is damaged
SceneValue stored_scene(const std::string& toml, const std::filesystem::path& file) {
  try {
    return parse_toml(toml, "stored");
  } catch (const Error& error) {
    throw FileError(fmt::format("damaged: its scene cannot be read: {}", error.message()), {.file = file.string()});
  }
}

/// The least and the largest time at which something was seen.
std::pair<double, double> span_of(const io::Frames& frames, const std::vector<io::MonitorSeries>& monitors) {
  double low = INFINITY, high = -INFINITY;
  const auto take = [&](double time) { low = std::min(low, time), high = std::max(high, time); };
  for (const io::Frame& frame : frames.frames) take(frame.time);
  for (const io::MonitorSeries& monitor : monitors) {
    for (const double time : monitor.time) take(time);
  }
  return low <= high ? std::pair(low, high) : std::pair(0.0, 0.0);
}

}  // namespace

PlotData read_plot_data(const std::filesystem::path& file, const Parts& parts) {
  const io::FileInfo about = io::info(file);
  if (about.kind != "trajectory") {
    throw Error(fmt::format("{} is a {}, which contains one moment only; plot the run.h5 beside it", file.string(),
                            about.kind));
  }
  const SceneValue scene = stored_scene(about.scene_toml, file);
  const io::Frames frames = io::read_frames(file);
  const std::vector<io::MonitorSeries> monitors = io::read_monitors(file);

  PlotData data;
  const auto [begin, end] = span_of(frames, monitors);
  const double longest = std::max(std::abs(begin), std::abs(end));
  const TimeUnit unit = time_unit_for(frames.time_unit.empty() ? about.time_unit : frames.time_unit, longest);
  data.title = text_at(scene, {"title"});
  if (data.title.empty()) data.title = file.filename().string();
  data.subtitle = method_line(scene);
  data.time_label = with_unit("time", unit.name);
  data.begin = begin / unit.length;
  data.end = end / unit.length;
  data.orbits = read_orbits(frames, scene, unit, file);
  for (const auto& [name, title] :
       {std::pair{"energy", "Energy"}, std::pair{"shadow_hamiltonian", "Shadow Hamiltonian"},
        std::pair{"momentum", "Momentum"}, std::pair{"angular_momentum", "Angular momentum"},
        std::pair{"constraint_residual", "Constraints"}}) {
    const auto found =
        std::find_if(monitors.begin(), monitors.end(), [wanted = name](const auto& m) { return m.name == wanted; });
    if (found == monitors.end()) continue;
    auto error = read_error(*found, unit.length);
    if (!error) continue;
    error->title = title;
    const bool changes = name == std::string_view("energy") && changes_energy(scene, parts);
    error->label = changes || error->curves.size() > 1               ? "relative change"
                   : name == std::string_view("constraint_residual") ? "violation"
                                                                     : "relative error";
    data.errors.push_back(std::move(*error));
  }
  if (data.orbits.empty() && data.errors.empty()) {
    const char* monitors_too =
        value_at(scene, {"system"}) != nullptr ? "" : " or a monitor of energy, momenta or constraints";
    throw Error(
        fmt::format("{} has nothing to draw; it needs frames (a trajectory writer){}", file.string(), monitors_too));
  }
  return data;
}

}  // namespace noether
