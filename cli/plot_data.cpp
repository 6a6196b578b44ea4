#include "cli/plot_data.hpp"

#include "cli/plot_source.hpp"
#include "cli/run_caption.hpp"
#include "cli/view_links.hpp"
#include "io/frame_particles.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"
#include "numbers/suggest.hpp"
#include "scene/parts.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace noether {

namespace {

/// The least and the largest time at which something was seen.
std::pair<double, double> span_of(const io::Frames& frames, const std::vector<io::MonitorSeries>& monitors) {
  double low = INFINITY, high = -INFINITY;
  const auto take = [&](double time) { low = std::min(low, time), high = std::max(high, time); };
  for (const io::Frame& frame : frames.frames) take(frame.time);
  for (const io::MonitorSeries& monitor : monitors) std::for_each(monitor.time.begin(), monitor.time.end(), take);
  return low <= high ? std::pair(low, high) : std::pair(0.0, 0.0);
}

bool is_finite(const io::Frame& frame) {
  const auto finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  return finite(frame.positions) && finite(frame.velocities) && finite(frame.variables);
}

/// The frame that is shown. @throws Error if there is none of the number, or its numbers are not finite
std::size_t shown_frame(const io::Frames& frames, std::optional<std::int64_t> wanted, const std::string& file) {
  const auto count = static_cast<std::int64_t>(frames.frames.size());
  const std::int64_t last = count - 1, number = wanted.value_or(-1) == -1 ? last : *wanted;
  if (wanted && (number < 0 || number > last)) {
    throw Error(count == 0 ? fmt::format("--frame {}: {} has no frames", *wanted, file)
                           : fmt::format("--frame {}: {} has the frames 0 to {}; -1 is the last", *wanted, file, last));
  }
  return static_cast<std::size_t>(std::max<std::int64_t>(number, 0));
}

/// Takes out frames with numbers that are not finite, such as of a run that failed.
/// @param number  of the frame that is shown in the file; becomes that of the one that is shown instead
/// @return its place among those that are left
std::size_t take_out_failed(io::Frames& frames, std::size_t& number, bool wanted) {
  const std::size_t shown = number;
  if (frames.frames.empty()) return 0;
  if (wanted && !is_finite(frames.frames[shown])) {
    throw Error(
        fmt::format("--frame {} has numbers that are not finite: the run failed before it; choose another one", shown));
  }
  std::vector<io::Frame> left;
  std::size_t place = 0;
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    if (!is_finite(frames.frames[k])) continue;
    if (k <= shown || left.empty()) place = left.size(), number = k;
    left.push_back(std::move(frames.frames[k]));
  }
  frames.frames = std::move(left);
  return place;
}

/// Of the frames, or of the monitors where there are none.
std::string time_unit_of(const PlotSource& source, const io::FileInfo& about) {
  if (!source.frames.time_unit.empty()) return source.frames.time_unit;
  for (const io::MonitorSeries& monitor : source.monitors) {
    const auto found = monitor.units.find("time");
    if (found != monitor.units.end()) return found->second;
  }
  return about.time_unit;
}

/// What frames would have told of elements: the unit of the first of them.
void add_units_of_monitors(PlotSource& source) {
  const io::MonitorSeries* elements = find_monitor(source.monitors, "elements");
  if (!source.frames.length_unit.empty() || elements == nullptr || !elements->units.contains("value")) return;
  const std::string& units = elements->units.at("value");
  source.frames.length_unit = units.substr(0, units.find(','));
}

PlotSource read_source(const std::filesystem::path& file, const PlotOptions& options, std::size_t& number) {
  const io::FileInfo about = io::info(file);
  if (about.kind != "trajectory") {
    throw Error(fmt::format("{} is a {}, which contains one moment only; plot the run.h5 beside it", file.string(),
                            about.kind));
  }
  PlotSource source{.file = file,
                    .scene = scene_in_file(about.scene_toml, file),
                    .frames = io::read_frames(file),
                    .monitors = io::read_monitors(file),
                    .time = {}};
  number = shown_frame(source.frames, options.frame, file.string());
  source.shown = take_out_failed(source.frames, number, options.frame.has_value());

  const auto [begin, end] = span_of(source.frames, source.monitors);
  std::vector<double> times;
  for (const io::Frame& frame : source.frames.frames) times.push_back(frame.time);
  if (times.size() < 3) {
    for (const io::MonitorSeries& monitor : source.monitors) {
      if (monitor.time.size() > times.size()) times = monitor.time;
    }
  }
  const std::string unit = time_unit_of(source, about);
  source.time = time_axis(unit, times, begin, end);
  add_units_of_monitors(source);

  const bool attract = has_gravity(source.scene);
  if (const double G = constant_of_gravity(source.scene, NAN); attract && !std::isnan(G)) source.G = G;
  const std::string system = source.frames.units.empty() ? about.units : source.frames.units;
  if (!source.frames.frames.empty() || !system.empty()) {
    const UnitSystem& units = io::known_units(system, file);
    if (attract && !source.G) source.G = units.G;
    source.k_B = units.k_B;
    source.temperature_unit = std::string(units.temperature);
  }
  const io::MonitorSeries* pressure = find_monitor(source.monitors, "pressure");
  if (pressure != nullptr && pressure->units.contains("value")) source.pressure_unit = pressure->units.at("value");
  return source;
}

/// "frame 3, t = 10 ps, box 6.1 x 6.1 x 6.1 nm".
std::string box_title(const PlotSource& source, std::size_t number) {
  const io::Frame& frame = source.frames.frames[source.shown];
  const std::string time = source.time.unit.empty() ? "" : " " + source.time.unit;
  std::string title = fmt::format("Frame {}, t = {:.4g}{}", number, frame.time / source.time.length, time);
  if (frame.edges.size() == 3) {
    const std::string& unit = source.frames.length_unit;
    title += fmt::format(", box {:.4g} x {:.4g} x {:.4g}{}", frame.edges[0], frame.edges[1], frame.edges[2],
                         unit == "1" || unit.empty() ? "" : " " + unit);
  }
  return title;
}

/// Orbits, variables, or particles in their box.
void add_positions(PlotData& data, const PlotSource& source, const PlotOptions& options, std::size_t number) {
  const io::Frames& frames = source.frames;
  if (frames.frames.empty()) return;
  if (!frames.variable_names.empty()) {
    for (PlotPanel& panel : plot_variables(frames, source.time)) {
      if (data.legend.empty()) {
        for (const PlotCurve& curve : panel.curves) data.legend.push_back({curve.name, curve.color});
      }
      for (PlotCurve& curve : panel.curves) curve.name.clear();
      data.panels.push_back(std::move(panel));
    }
  } else if (is_crowd(frames) && options.projection.empty()) {
    const auto shown = io::read_frame_particles(source.file, {.frame = static_cast<std::int64_t>(number)});
    const UnitSystem& units = io::known_units(frames.units, source.file);
    data.boxes.push_back(plot_box(shown.particles, std::string(units.mass), data.legend));
    data.boxes.back().title = box_title(source, number);
  } else {
    auto line = options.projection.empty() ? plot_line_positions(frames, source.time) : std::nullopt;
    if (line) {
      data.panels.push_back(std::move(*line));
    } else {
      data.orbits = plot_orbits(frames, source.shown, source.G, options.projection);
    }
    data.legend = body_legend(frames);
  }
}

class Page {
 public:
  Page(PlotData& data, const PlotSource& source, const PlotOptions& options)
      : data_(data), source_(source), options_(options) {}

  bool wants(const std::string& subject, bool fits) const {
    if (options_.what.empty()) return fits;
    return std::find(options_.what.begin(), options_.what.end(), subject) != options_.what.end();
  }
  void add(const std::string& subject, std::vector<PlotPanel> panels, const std::string& needs) {
    if (panels.empty() && !options_.what.empty()) refuse(subject, needs);
    std::move(panels.begin(), panels.end(), std::back_inserter(data_.panels));
  }
  void add(const std::string& subject, std::optional<PlotPanel> panel, const std::string& needs) {
    std::vector<PlotPanel> panels;
    if (panel) panels.push_back(std::move(*panel));
    add(subject, std::move(panels), needs);
  }
  [[noreturn]] void refuse(const std::string& subject, const std::string& needs) const {
    throw Error(fmt::format("{} has no {} to draw; it needs {}", source_.file.string(), subject, needs));
  }

 private:
  PlotData& data_;
  const PlotSource& source_;
  const PlotOptions& options_;
};

void check(const PlotOptions& options) {
  for (const std::string& subject : options.what) {
    const std::vector<std::string>& known = plot_subjects();
    if (std::find(known.begin(), known.end(), subject) != known.end()) continue;
    throw Error(fmt::format("--what '{}' is nothing that plot draws{}", subject, did_you_mean(subject, known)));
  }
  const std::vector<std::string> projections = {"xy", "xz", "yz", "all"};
  if (!options.projection.empty() &&
      std::find(projections.begin(), projections.end(), options.projection) == projections.end()) {
    throw Error(fmt::format("--projection '{}' is not one of xy, xz, yz and all", options.projection));
  }
}

}  // namespace

const io::MonitorSeries* find_monitor(const std::vector<io::MonitorSeries>& monitors, std::string_view name) {
  for (const bool exact : {true, false}) {
    for (const io::MonitorSeries& monitor : monitors) {
      const std::string_view ending = std::string_view(monitor.name).substr(std::min(name.size(), monitor.name.size()));
      const bool numbered =
          ending.size() > 1 && ending[0] == '_' && ending.find_first_not_of("0123456789", 1) == ending.npos;
      if (monitor.name.starts_with(name) && (exact ? ending.empty() : numbered)) return &monitor;
    }
  }
  return nullptr;
}

const std::vector<std::string>& plot_subjects() {
  static const std::vector<std::string> subjects = {"positions", "errors", "elements", "temperature",
                                                    "pressure",  "rdf",    "msd"};
  return subjects;
}

PlotData read_plot_data(const std::filesystem::path& file, const Parts& parts, const PlotOptions& options) {
  check(options);
  std::size_t number = 0;
  const PlotSource source = read_source(file, options, number);
  const bool periodic = !source.frames.frames.empty() && !source.frames.frames.front().edges.empty();
  PlotData data;
  const RunCaption caption = caption_of(source.scene, file, source.time.unit, 0, parts);
  data.title = caption.title;
  data.subtitle = caption.method;

  Page page(data, source, options);
  if (page.wants("positions", true)) {
    add_positions(data, source, options, number);
    if (!options.what.empty() && source.frames.frames.empty()) page.refuse("positions", "frames (a trajectory writer)");
  }
  if (page.wants("errors", true)) {
    page.add("errors", plot_errors(source.monitors, source.time, caption.energy_changes),
             "a monitor of energy, momenta or constraints");
  }
  const bool orbits = find_monitor(source.monitors, "elements") != nullptr ||
                      (source.G && has_primary(source.frames) && !periodic && !is_crowd(source.frames));
  if (page.wants("elements", orbits)) {
    page.add("elements", plot_elements(source), "the monitor elements, or frames about a body with most of the mass");
    if (data.legend.empty() && data.boxes.empty()) data.legend = body_legend(source.frames);
  }
  const bool heat = periodic || find_monitor(source.monitors, "temperature") != nullptr;
  if (page.wants("temperature", heat)) {
    page.add("temperature", plot_temperature(source), "the monitor temperature, or two frames and no constraints");
  }
  if (page.wants("pressure", true)) page.add("pressure", plot_pressure(source), "the monitor pressure");
  const bool crowd = periodic && is_crowd(source.frames);
  if (page.wants("rdf", crowd)) {
    page.add("rdf", plot_radial_distribution(source, options.frame.has_value()), "frames of a periodic box");
  }
  const bool moves = find_monitor(source.monitors, "mean_square_displacement") != nullptr;
  if (page.wants("msd", crowd || moves)) {
    page.add("msd", plot_mean_square_displacement(source), "two frames, or the monitor mean_square_displacement");
  }
  if (data.orbits.empty() && data.boxes.empty() && data.panels.empty()) {
    const bool system = value_at(source.scene, {"system"}) != nullptr;
    throw Error(fmt::format("{} has nothing to draw; it needs frames (a trajectory writer){}", file.string(),
                            system ? "" : " or a monitor of energy, momenta or constraints"));
  }
  return data;
}

}  // namespace noether
