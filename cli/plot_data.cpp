#include "cli/plot_data.hpp"

#include "cli/plot_source.hpp"
#include "cli/run_caption.hpp"
#include "cli/run_gravity.hpp"
#include "engine/sums.hpp"
#include "io/ensemble_file.hpp"
#include "io/frame_particles.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "scene/parts.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace noether {

namespace {

/// The least and the largest time at which something was seen.
std::pair<double, double> span_of(const PlotFrames& frames, const std::vector<io::MonitorSeries>& monitors) {
  double low = INFINITY, high = -INFINITY;
  const auto take = [&](double time) { low = std::min(low, time), high = std::max(high, time); };
  std::for_each(frames.times.begin(), frames.times.end(), take);
  for (const io::MonitorSeries& monitor : monitors) std::for_each(monitor.time.begin(), monitor.time.end(), take);
  return low <= high ? std::pair(low, high) : std::pair(0.0, 0.0);
}

/// The place of the frame that is shown: the last one that can be drawn up to the one that is wanted.
/// @throws Error if there is none of the number, or its numbers are not finite
std::size_t shown_frame(const FramesInFile& found, std::optional<std::int64_t> wanted, const std::string& file) {
  const auto last = static_cast<std::int64_t>(found.all) - 1;
  const std::int64_t number = wanted.value_or(-1) == -1 ? last : *wanted;
  if (wanted && (number < 0 || number > last)) {
    throw Error(found.all == 0
                    ? fmt::format("--frame {}: {} has no frames", *wanted, file)
                    : fmt::format("--frame {}: {} has the frames 0 to {}; -1 is the last", *wanted, file, last));
  }
  const std::vector<std::size_t>& numbers = found.frames.numbers;
  const auto after =
      std::upper_bound(numbers.begin(), numbers.end(), static_cast<std::size_t>(std::max<std::int64_t>(number, 0)));
  const std::size_t place = after == numbers.begin() ? 0 : static_cast<std::size_t>(after - numbers.begin()) - 1;
  // Nothing, as -1, asks for the last one that can be drawn.
  const bool there = !numbers.empty() && numbers[place] == static_cast<std::size_t>(number);
  if (wanted.value_or(-1) != -1 && !there) {
    throw Error(fmt::format("--frame {} has numbers that are not finite: the run failed before it; choose another one",
                            number));
  }
  return place;
}

/// What the picture takes from monitors: without the numbers that nothing draws.
std::vector<io::MonitorSeries> drawn_monitors(const std::filesystem::path& file) {
  static const std::vector<std::string> names = {"energy",
                                                 "shadow_hamiltonian",
                                                 "momentum",
                                                 "angular_momentum",
                                                 "constraint_residual",
                                                 "elements",
                                                 "temperature",
                                                 "pressure",
                                                 "dihedrals",
                                                 "radial_distribution",
                                                 "mean_square_displacement",
                                                 "spin",
                                                 "resonance_angle",
                                                 "megno",
                                                 "lyapunov"};
  const auto drawn = [](const std::string& monitor, const std::string& quantity) {
    const auto name =
        std::find_if(names.begin(), names.end(), [&](const auto& one) { return monitor.starts_with(one); });
    if (name == names.end()) return false;
    if (*name == "dihedrals") return quantity == "angle" || quantity == "density" || quantity == "fraction";
    if (*name == "spin") return quantity == "angle" || quantity == "rate";
    if (*name == "megno" || *name == "lyapunov") return quantity == "mean" || quantity == "exponent";
    const bool error = *name == "energy" || name->ends_with("momentum");
    return quantity == "relative_error" || quantity == "worst" ||
           (!error && (quantity == "value" || quantity == "lag" || quantity == "distance"));
  };
  // Of means over the run the last one is drawn.
  const auto last_alone = [](const std::string& monitor) {
    return monitor.starts_with("dihedrals") || monitor.starts_with("radial_distribution") ||
           monitor.starts_with("mean_square_displacement");
  };
  return io::read_monitors(file, {.wanted = drawn, .most_numbers = 20'000'000, .last_alone = last_alone});
}

ParticleLinks links_in(const std::filesystem::path& file, const PlotSource& source, const UnitSystem& units,
                       const Parts& parts) {
  const io::Frames& shared = source.frames.shared;
  std::vector<std::size_t> rows(shared.ids.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return io::try_first(
      file, [&] { return read_links(io::Hdf5File::open_to_read(file), source.scene, parts, units, shared, rows); });
}

/// The center of mass of a frame; of bodies without mass their mean.
PlotPlace center_of(const PlotFrames& frames, const io::Frame& frame) {
  const std::vector<double>& masses = frames.shared.masses;
  const auto n = static_cast<Index>(frames.bodies());
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const double total = sum_over<double>(n, [&](Index i) { return masses[at(i)]; });
  PlotPlace center{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto weighted = [&](Index i) { return (total > 0 ? masses[at(i)] : 1) * frame.positions[3 * at(i) + k]; };
    center[k] = sum_over<double>(n, weighted) / (total > 0 ? total : static_cast<double>(n));
  }
  return center;
}

/// The unit of orbits: by how far bodies are from the primary, or without one from the center of mass, at the frame
/// that is shown; where there are no frames by their largest orbit.
PlotLength length_of(const PlotSource& source) {
  const PlotFrames& frames = source.frames;
  double size = 0;
  if (!frames.empty() && frames.bodies() > 0 && !is_crowd(frames)) {
    const io::Frame frame = frames.frame(source.shown);
    PlotPlace center = center_of(frames, frame);
    for (std::size_t k = 0; k < 3 && frames.primary; ++k) center[k] = frame.positions[3 * *frames.primary + k];
    for (std::size_t i = 0; i < frames.bodies(); ++i) {
      const auto off = [&](std::size_t k) { return frame.positions[3 * i + k] - center[k]; };
      size = std::max(size, std::hypot(off(0), off(1), off(2)));
    }
  } else if (const io::MonitorSeries* elements = find_monitor(source.monitors, "elements"); elements != nullptr) {
    const auto found = elements->quantities.find("value");
    if (found != elements->quantities.end() && found->second.first.size() == 2) {
      const auto columns = static_cast<std::size_t>(found->second.first[1]);
      const std::vector<double>& values = found->second.second;
      const std::size_t row = columns * static_cast<std::size_t>(found->second.first[0]);
      for (std::size_t k = values.size() - std::min(row, values.size()); k < values.size(); k += columns) {
        if (values[k] > size) size = values[k];
      }
    }
  }
  return readable_length(frames.shared.length_unit, size);
}

/// Of the frames, or of the monitors where there are none.
std::string time_unit_of(const PlotSource& source, const io::FileInfo& about) {
  if (!source.frames.shared.time_unit.empty()) return source.frames.shared.time_unit;
  for (const io::MonitorSeries& monitor : source.monitors) {
    const auto found = monitor.units.find("time");
    if (found != monitor.units.end()) return found->second;
  }
  return about.time_unit;
}

/// What frames would have told of elements: the unit of the first of them.
void add_units_of_monitors(PlotSource& source) {
  const io::MonitorSeries* elements = find_monitor(source.monitors, "elements");
  if (!source.frames.shared.length_unit.empty() || elements == nullptr || !elements->units.contains("value")) return;
  const std::string& units = elements->units.at("value");
  source.frames.shared.length_unit = units.substr(0, units.find(','));
}

PlotSource read_source(const std::filesystem::path& file, const PlotOptions& options, const Parts& parts) {
  const io::FileInfo about = io::info(file);
  if (about.kind != "trajectory") {
    throw Error(fmt::format("{} is a {}, which contains one moment only; plot the run.h5 beside it", file.string(),
                            about.kind));
  }
  FramesInFile found = open_frames(file);
  const std::size_t shown = shown_frame(found, options.frame, file.string());
  PlotSource source{.file = file,
                    .scene = scene_in_file(about.scene_toml, file),
                    .frames = std::move(found.frames),
                    .monitors = drawn_monitors(file),
                    .time = {},
                    .shown = shown};
  const auto [begin, end] = span_of(source.frames, source.monitors);
  std::vector<double> times = source.frames.times;
  if (times.size() < 3) {
    for (const io::MonitorSeries& monitor : source.monitors) {
      if (monitor.time.size() > times.size()) times = monitor.time;
    }
  }
  const std::string unit = time_unit_of(source, about);
  source.time = time_axis(unit, times, begin, end);
  add_units_of_monitors(source);

  const bool attract = has_gravity(source.scene, parts);
  if (const double G = constant_of_gravity(source.scene, NAN); attract && !std::isnan(G)) source.G = G;
  if (!may_have_gravity(source.scene, parts) || source.frames.periodic) source.frames.primary = {};
  const std::string system = source.frames.shared.units.empty() ? about.units : source.frames.shared.units;
  if (!source.frames.empty() || !system.empty()) {
    const UnitSystem& units = io::known_units(system, file);
    source.links = links_in(file, source, units, parts);
    if (attract && !source.G) source.G = units.G;
    source.k_B = units.k_B;
    source.temperature_unit = std::string(units.temperature);
  }
  const io::MonitorSeries* pressure = find_monitor(source.monitors, "pressure");
  source.length = length_of(source);
  if (pressure != nullptr && pressure->units.contains("value")) source.pressure_unit = pressure->units.at("value");
  return source;
}

/// "frame 3, t = 10 ps, box 6.1 x 6.1 x 6.1 nm".
std::string box_title(const PlotSource& source) {
  const io::Frame frame = source.frames.frame(source.shown);
  std::string title =
      fmt::format("Frame {}, t = {}", source.frames.numbers[source.shown], told_time(source.time, frame.time));
  if (frame.edges.size() == 3) {
    const std::string& unit = source.frames.shared.length_unit;
    title += fmt::format(", box {:.4g} x {:.4g} x {:.4g}{}", frame.edges[0], frame.edges[1], frame.edges[2],
                         unit == "1" || unit.empty() ? "" : " " + unit);
  }
  return title;
}

/// Orbits, variables, or particles in their box.
void add_positions(PlotData& data, const PlotSource& source, const PlotOptions& options) {
  const PlotFrames& frames = source.frames;
  if (frames.empty()) {
    data.orbits = plot_orbits_of_elements(source, options.projection);
    if (!data.orbits.empty()) data.legend = body_legend(frames);
  } else if (!frames.shared.variable_names.empty()) {
    for (PlotPanel& panel : plot_variables(frames, source.time)) {
      if (data.legend.empty()) {
        for (const PlotCurve& curve : panel.curves) data.legend.push_back({curve.name, curve.color});
      }
      for (PlotCurve& curve : panel.curves) curve.name.clear();
      data.panels.push_back(std::move(panel));
    }
  } else if (is_crowd(frames) && options.projection.empty()) {
    const auto number = static_cast<std::int64_t>(frames.numbers[source.shown]);
    frames.close_file();
    const auto shown = io::read_frame_particles(source.file, {.frame = number});
    const UnitSystem& units = io::known_units(frames.shared.units, source.file);
    data.boxes.push_back(plot_box(shown.particles, std::string(units.mass), data.legend));
    data.boxes.back().title = box_title(source);
  } else {
    auto line = options.projection.empty() ? plot_line_positions(frames, source.time) : std::nullopt;
    if (line) {
      data.panels.push_back(std::move(*line));
    } else {
      data.orbits = plot_orbits(frames, source.shown, source.G, options.projection, source.links, source.length);
    }
    const bool links_alone = !data.orbits.empty() && data.orbits.front().links_alone;
    if (!links_alone) data.legend = body_legend(frames);
    if (!data.orbits.empty() && data.orbits.front().links.size() > 1) {
      data.orbits.front().title =
          fmt::format("At t = {}, and {} before", told_time(source.time, frames.times[source.shown]),
                      counted(static_cast<std::int64_t>(data.orbits.front().links.size()) - 1, "moment"));
    }
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
    throw Error(fmt::format("--what '{}' is not one of the panels{}", subject, did_you_mean(subject, known)));
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
  static const std::vector<std::string> subjects = {"positions", "errors",    "elements",   "temperature",
                                                    "pressure",  "dihedrals", "rdf",        "msd",
                                                    "axes",      "spin",      "resonances", "chaos"};
  return subjects;
}

PlotData read_plot_data(const std::filesystem::path& file, const Parts& parts, const PlotOptions& options) {
  if (io::holds_ensemble(file)) return plot_ensemble(file, parts, options);
  check(options);
  const PlotSource source = read_source(file, options, parts);
  const bool periodic = source.frames.periodic;
  PlotData data;
  const RunCaption caption = caption_of(source.scene, file, source.time.unit, 0, parts);
  data.title = caption.title;
  data.subtitle = caption.method;

  Page page(data, source, options);
  if (page.wants("positions", true)) {
    add_positions(data, source, options);
    if (!options.what.empty() && source.frames.empty() && data.orbits.empty())
      page.refuse("positions", "frames (a trajectory writer)");
  }
  if (page.wants("errors", true)) {
    page.add("errors", plot_errors(source.monitors, source.time, caption.energy_changes),
             "a monitor of energy, momenta or constraints");
  }
  const bool orbits = find_monitor(source.monitors, "elements") != nullptr ||
                      (source.G && source.frames.primary && !is_crowd(source.frames));
  if (page.wants("elements", orbits)) {
    page.add("elements", plot_elements(source), "the monitor elements, or frames about a body with most of the mass");
    if (data.legend.empty() && data.boxes.empty()) data.legend = body_legend(source.frames);
  }
  if (page.wants("resonances", true)) page.add("resonances", plot_resonances(source), "the monitor resonance_angle");
  if (page.wants("chaos", true)) page.add("chaos", plot_chaos(source), "the monitor megno or lyapunov");
  const bool heat = periodic || find_monitor(source.monitors, "temperature") != nullptr;
  if (page.wants("temperature", heat)) {
    page.add("temperature", plot_temperature(source), "the monitor temperature, or two frames and no constraints");
  }
  if (page.wants("pressure", true)) page.add("pressure", plot_pressure(source), "the monitor pressure");
  if (page.wants("dihedrals", true)) page.add("dihedrals", plot_dihedrals(source), "the monitor dihedrals");
  if (page.wants("axes", true)) {
    std::optional<PlotPanel> axes = plot_axes(source);
    if (axes) axes->large = data.orbits.empty();
    page.add("axes", std::move(axes), "frames of few rigid bodies whose axes move");
  }
  if (page.wants("spin", true)) page.add("spin", plot_spin(source), "the monitor spin");
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
