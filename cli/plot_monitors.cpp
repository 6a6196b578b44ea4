/// Panels of what monitors have seen: errors, elements, temperature, pressure, dihedral angles.

#include "cli/plot_source.hpp"
#include "engine/orbital_elements.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_panel_samples = 4'000;
/// Of more bodies the heaviest are drawn.
constexpr std::size_t most_element_bodies = 60;
constexpr double one_degree = std::numbers::pi / 180;

/// Adds the sizes of `values[first]`, `values[first + stride]`, ... to a panel; zeros are left out.
/// @return the largest
double add_sizes(PlotPanel& panel, const std::string& name, const std::vector<double>& time,
                 const std::vector<double>& values, std::size_t first, std::size_t stride) {
  PlotCurve curve{.name = name, .points = {}, .separate = true};
  double worst = 0;
  for (std::size_t k = 0; k < time.size() && first + k * stride < values.size(); ++k) {
    const double size = std::abs(values[first + k * stride]);
    if (!(size > 0) || !std::isfinite(size)) continue;
    curve.points.push_back({time[k], size});
    worst = std::max(worst, size);
  }
  panel.curves.push_back(std::move(curve));
  return worst;
}

std::vector<double> scaled_times(const io::MonitorSeries& monitor, const PlotTime& time) {
  std::vector<double> times = monitor.time;
  for (double& t : times) t /= time.length;
  return times;
}

/// A number with so many digits that count: plain from 0.01 to 1000, with a power of ten elsewhere.
std::string told_number(double value, int digits) {
  const double size = std::abs(value);
  if (!(size >= 0.01) || size >= 1000) return fmt::format("{:.{}e}", value, digits - 1);
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  const double power = std::pow(10.0, -decimals);
  return decimals >= 0 ? fmt::format("{:.{}f}", value, decimals)
                       : fmt::format("{:.0f}", std::round(value / power) * power);
}

/// "299.7 +- 0.4": a mean with as many digits as its error, which ten blocks tell; of few numbers the mean alone.
std::string told_mean(const std::vector<double>& values, std::size_t first) {
  constexpr std::size_t blocks = 10;
  const auto mean_of = [&](std::size_t from, std::size_t count) {
    const auto value = [&](Index k) { return values[from + static_cast<std::size_t>(k)]; };
    return sum_over<double>(static_cast<Index>(count), value) / static_cast<double>(count);
  };
  const std::size_t count = values.size() - first, length = count / blocks;
  const double mean = mean_of(first, count);
  if (length < 2) return fmt::format("{:.4g}", mean);
  const std::size_t start = values.size() - blocks * length;
  const double middle = mean_of(start, blocks * length);
  const double squares = sum_over<double>(static_cast<Index>(blocks), [&](Index b) {
    const double off = mean_of(start + static_cast<std::size_t>(b) * length, length) - middle;
    return off * off;
  });
  const double error = std::sqrt(squares / (blocks * (blocks - 1)));
  if (!(error > 1e-12 * std::abs(mean))) return fmt::format("{:.4g}", mean);
  const double digits = mean == 0 ? 1 : std::floor(std::log10(std::abs(mean))) - std::floor(std::log10(error)) + 1;
  const int shown = std::clamp(static_cast<int>(digits), 1, 12);
  const bool plain = std::abs(mean) >= 1000 && std::abs(mean) < 1e6;
  const std::string text =
      plain ? fmt::format("{:.{}f}", mean, std::max(0, -static_cast<int>(std::floor(std::log10(error)))))
            : told_number(mean, shown);
  return fmt::format("{} +- {:.1g}", text, error);
}

/// What an error panel says above its curves.
std::string error_title(const std::string& title, const std::string& label, double worst, const PlotPanel& panel) {
  const std::string told = worst > 0 ? "worst " + told_number(worst, 2) : "exactly zero";
  const bool several = panel.curves.size() > 1;
  return title + ": " + label + ", " + told + (several ? " of " + panel.curves.back().name : "");
}

/// The relative error of a monitor; of constraints the largest violation; of a shadow Hamiltonian the change of each
/// order since the start.
std::optional<PlotPanel> error_panel(const io::MonitorSeries& monitor, const PlotTime& time, const std::string& title,
                                     bool changes) {
  PlotPanel panel;
  panel.x = time.axis;
  const std::vector<double> times = scaled_times(monitor, time);
  const bool residual = monitor.name == "constraint_residual";
  const auto single = monitor.quantities.find(residual ? "worst" : "relative_error");
  if (single != monitor.quantities.end()) {
    const double worst = add_sizes(panel, "", times, single->second.second, 0, 1);
    panel.title = error_title(title,
                              changes    ? "relative change"
                              : residual ? "violation"
                                         : "relative error",
                              worst, panel);
    fit_errors(panel);
    if (!panel.y.logarithmic) panel.y.label = changes ? "change" : residual ? "violation" : "error";
    return panel;
  }
  const auto found = monitor.quantities.find("value");
  if (monitor.name != "shadow_hamiltonian" || found == monitor.quantities.end() || found->second.first.size() != 1) {
    return {};
  }
  const auto orders = static_cast<std::size_t>(found->second.first[0]);
  std::vector<double> change = found->second.second;
  for (std::size_t k = change.size(); k-- > 0;) {
    change[k] = (change[k] - change[k % orders]) / monitor.scale.value_or(1);
  }
  double worst = 0;
  for (std::size_t k = 0; k < orders; ++k) {
    const bool known = k < monitor.orders.size();
    worst = add_sizes(panel, known ? fmt::format("order {}", monitor.orders[k]) : "", times, change, k, orders);
  }
  panel.title = error_title(title, orders > 1 ? "relative change" : "relative error", worst, panel);
  fit_errors(panel);
  return panel;
}

/// Numbers of a monitor against time, as they are.
std::optional<PlotPanel> value_panel(const PlotSource& source, std::string_view name, const std::string& title,
                                     const std::string& unit, double scale) {
  const io::MonitorSeries* monitor = find_monitor(source.monitors, name);
  if (monitor == nullptr) return {};
  const auto found = monitor->quantities.find("value");
  if (found == monitor->quantities.end() || !found->second.first.empty()) return {};
  const std::vector<double> times = scaled_times(*monitor, source.time);
  PlotPanel panel;
  panel.x = source.time.axis;
  PlotCurve curve;
  std::vector<double> values;
  for (std::size_t k = 0; k < times.size() && k < found->second.second.size(); ++k) {
    const double value = found->second.second[k] * scale;
    if (!std::isfinite(value)) continue;
    curve.points.push_back({times[k], value});
    values.push_back(value);
  }
  if (values.empty()) return {};
  // The second half has forgotten the start.
  const std::size_t half = values.size() / 2;
  panel.title =
      fmt::format("{}: mean {}{} in the second half", title, told_mean(values, half), unit == "1" ? "" : " " + unit);
  panel.y.label = with_unit(title, unit);
  panel.curves = {std::move(curve)};
  panel.curves[0].points = thinned(panel.curves[0].points, most_panel_samples);
  fit_values(panel);
  return panel;
}

/// What a list of numbers was at the last look; nothing where there is no such list.
std::vector<double> last_row(const io::MonitorSeries& monitor, const char* quantity) {
  const auto found = monitor.quantities.find(quantity);
  if (found == monitor.quantities.end() || found->second.first.size() != 1) return {};
  const auto row = static_cast<std::size_t>(found->second.first[0]);
  const std::vector<double>& values = found->second.second;
  if (row == 0 || values.size() < row) return {};
  return {values.end() - static_cast<std::ptrdiff_t>(row), values.end()};
}

/// a, e, inc of all bodies at one moment, shape (n, 3), NaN where there is no orbit.
using ElementRows = std::vector<std::array<double, 3>>;

struct ElementSeries {
  std::vector<double> time;
  std::vector<ElementRows> rows;
};

ElementSeries elements_of_monitor(const io::MonitorSeries& monitor) {
  ElementSeries series;
  const auto found = monitor.quantities.find("value");
  if (found == monitor.quantities.end() || found->second.first.size() != 2 || found->second.first[1] < 3) return series;
  const auto bodies = static_cast<std::size_t>(found->second.first[0]);
  const auto columns = static_cast<std::size_t>(found->second.first[1]);
  const std::vector<double>& values = found->second.second;
  for (std::size_t k = 0; k < monitor.time.size() && (k + 1) * bodies * columns <= values.size(); ++k) {
    ElementRows rows(bodies);
    for (std::size_t i = 0; i < bodies; ++i) {
      for (std::size_t c = 0; c < 3; ++c) rows[i][c] = values[(k * bodies + i) * columns + c];
    }
    series.time.push_back(monitor.time[k]);
    series.rows.push_back(std::move(rows));
  }
  return series;
}

ElementSeries elements_of_frames(const PlotFrames& all, std::size_t primary, double G) {
  ElementSeries series;
  const io::Frames frames = kept_frames(all, most_panel_samples, all.size() - 1).frames;
  for (const io::Frame& frame : frames.frames) {
    ElementRows rows(frames.masses.size(), {NAN, NAN, NAN});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto relative = [&](const std::vector<double>& x) {
        return Vec3<double>(x[3 * i] - x[3 * primary], x[3 * i + 1] - x[3 * primary + 1],
                            x[3 * i + 2] - x[3 * primary + 2]);
      };
      const double mu = G * (frames.masses[primary] + frames.masses[i]);
      const Vec3<double> x = relative(frame.positions);
      if (!(x.norm() > 0)) continue;  // the primary too
      const auto o = elements_from_state<double>(x, relative(frame.velocities), mu);
      rows[i] = {o.a, o.e, o.inc};
    }
    series.time.push_back(frame.time);
    series.rows.push_back(std::move(rows));
  }
  return series;
}

/// The bodies that are drawn: all, or the heaviest.
std::vector<std::size_t> drawn_bodies(const io::Frames& frames, std::size_t count) {
  std::vector<std::size_t> bodies(count);
  for (std::size_t i = 0; i < count; ++i) bodies[i] = i;
  if (count <= most_element_bodies || frames.masses.size() != count) return bodies;
  std::stable_sort(bodies.begin(), bodies.end(),
                   [&](std::size_t a, std::size_t b) { return frames.masses[a] > frames.masses[b]; });
  bodies.resize(most_element_bodies);
  return bodies;
}

PlotPanel element_panel(const PlotSource& source, const ElementSeries& series, std::size_t column) {
  static constexpr std::array<const char*, 3> titles = {"Semi-major axis", "Eccentricity", "Inclination"};
  PlotPanel panel;
  panel.title = titles[column];
  panel.x = source.time.axis;
  const PlotLength length = source.length.value_or(PlotLength{source.frames.shared.length_unit, 1});
  panel.y.label = column == 0 ? with_unit("a", length.unit) : column == 1 ? std::string("e") : std::string("inc (deg)");
  double low = INFINITY, high = 0;
  for (const std::size_t i : drawn_bodies(source.frames.shared, series.rows.front().size())) {
    PlotCurve curve{.name = "", .points = {}, .color = body_color(source.frames, i)};
    for (std::size_t k = 0; k < series.time.size(); ++k) {
      const double value = series.rows[k][i][column] / (column == 0 ? length.length : column == 2 ? one_degree : 1);
      if (!std::isfinite(value)) continue;
      curve.points.push_back({series.time[k] / source.time.length, value});
      low = std::min(low, value), high = std::max(high, value);
    }
    curve.points = thinned(curve.points, most_panel_samples);
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  panel.y.logarithmic = column == 0 && low > 0 && high > 6 * low;
  fit_values(panel);
  if (column == 0 && panel.y.logarithmic) panel.y.low = low / 1.4, panel.y.high = high * 1.4;
  return panel;
}

}  // namespace

std::vector<PlotPanel> plot_errors(const std::vector<io::MonitorSeries>& monitors, const PlotTime& time,
                                   bool changes_energy) {
  std::vector<PlotPanel> panels;
  for (const auto& [name, title] :
       {std::pair{"energy", "Energy"}, std::pair{"shadow_hamiltonian", "Shadow Hamiltonian"},
        std::pair{"momentum", "Momentum"}, std::pair{"angular_momentum", "Angular momentum"},
        std::pair{"constraint_residual", "Constraints"}}) {
    const io::MonitorSeries* monitor = find_monitor(monitors, name);
    if (monitor == nullptr || monitor->time.empty()) continue;
    auto panel = error_panel(*monitor, time, title, changes_energy && name == std::string_view("energy"));
    if (panel) panels.push_back(std::move(*panel));
  }
  return panels;
}

std::vector<PlotPanel> plot_elements(const PlotSource& source) {
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "elements");
  ElementSeries series;
  if (monitor != nullptr) series = elements_of_monitor(*monitor);
  if (series.time.size() < 2 && source.G && source.frames.primary && !source.frames.empty()) {
    series = elements_of_frames(source.frames, *source.frames.primary, *source.G);
  }
  if (series.time.size() < 2) return {};
  std::vector<PlotPanel> panels;
  for (std::size_t column = 0; column < 3; ++column) {
    PlotPanel panel = element_panel(source, series, column);
    bool flat = column == 2;  // orbits in the plane of x and y have no inclination to show
    for (const PlotCurve& curve : panel.curves) {
      for (const PlotPoint& p : curve.points) flat = flat && p.y < 1e-9;
    }
    if (!flat && !panel.curves.empty()) panels.push_back(std::move(panel));
  }
  return panels;
}

std::optional<PlotPanel> plot_temperature(const PlotSource& source) {
  auto panel = value_panel(source, "temperature", "Temperature", source.temperature_unit, 1);
  if (panel || !source.k_B || source.frames.size() < 2) return panel;
  // Constraints take away degrees of freedom, and the frames do not tell how many.
  if (value_at(source.scene, {"hamiltonian", "constraint"}) != nullptr) return {};
  const PlotFrames& frames = source.frames;
  Index massive = 0;
  for (const double m : frames.shared.masses) massive += m > 0 ? 1 : 0;
  if (massive < 2) return {};
  const auto n = static_cast<Index>(frames.bodies());
  const auto mass = [&](Index i) { return frames.shared.masses[static_cast<std::size_t>(i)]; };
  const double total = sum_over<double>(n, mass);
  io::MonitorSeries made{
      .name = "temperature", .step = {}, .time = {}, .quantities = {}, .units = {}, .scale = {}, .orders = {}};
  std::vector<double>& values = made.quantities["value"].second;
  for (std::size_t at = 0; at < frames.size(); ++at) {
    const io::Frame frame = frames.frame(at);
    std::array<double, 3> squares{};  // twice the kinetic energy along each axis
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = [&](Index i) { return frame.velocities[3 * static_cast<std::size_t>(i) + k]; };
      const double drift = sum_over<double>(n, [&](Index i) { return mass(i) * v(i); }) / total;
      squares[k] = sum_over<double>(n, [&](Index i) { return mass(i) * (v(i) - drift) * (v(i) - drift); });
    }
    made.time.push_back(frame.time);
    values.push_back((squares[0] + squares[1] + squares[2]) / (static_cast<double>(3 * massive - 3) * *source.k_B));
  }
  PlotSource computed{.file = {}, .scene = {}, .frames = {}, .monitors = {made}, .time = source.time};
  return value_panel(computed, "temperature", "Temperature", source.temperature_unit, 1);
}

std::optional<PlotPanel> plot_pressure(const PlotSource& source) {
  return value_panel(source, "pressure", "Pressure", source.pressure_unit, 1);
}

std::optional<PlotPanel> plot_dihedrals(const PlotSource& source) {
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "dihedrals");
  if (monitor == nullptr) return {};
  const std::vector<double> angles = last_row(*monitor, "angle"), density = last_row(*monitor, "density");
  const std::vector<double> parts = last_row(*monitor, "fraction");
  if (angles.size() != density.size() || parts.size() != 3) return {};
  PlotCurve curve;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    if (std::isfinite(density[k])) curve.points.push_back({angles[k] / one_degree, 100 * density[k] * one_degree});
  }
  if (curve.points.empty()) return {};
  PlotPanel panel;
  panel.title = fmt::format("Dihedrals: trans {:.3f}, gauche+ {:.3f}, gauche- {:.3f}", parts[0], parts[1], parts[2]);
  panel.x = {.label = "phi (deg)", .low = -180, .high = 180};
  panel.y.label = "density (%/deg)";
  panel.curves = {std::move(curve)};
  fit_values(panel);
  panel.y.low = 0;
  return panel;
}

}  // namespace noether
