#pragma once
/// A run as it was read for a picture, and the parts of the picture that are made from it.

#include "cli/plot_axes.hpp"
#include "cli/plot_data.hpp"
#include "cli/run_caption.hpp"
#include "engine/particle_system.hpp"
#include "io/inspect.hpp"
#include "scene/value.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// Everything that stands in run.h5 and that a picture may show.
struct PlotSource {
  std::filesystem::path file;
  SceneValue scene;
  io::Frames frames;  ///< those whose numbers are all finite
  std::vector<io::MonitorSeries> monitors;
  PlotTime time;
  std::size_t shown = 0;           ///< the frame that is shown
  std::optional<double> G = {};    ///< constant of gravitation; nothing where the scene has no gravity
  std::optional<double> k_B = {};  ///< Boltzmann's constant
  std::string temperature_unit = {}, pressure_unit = {};
};

/// The first monitor of a name, one with a number behind it too; null if there is none.
const io::MonitorSeries* find_monitor(const std::vector<io::MonitorSeries>& monitors, std::string_view name);

/// Whether the first body has more than ten times the mass of all others.
bool has_primary(const io::Frames& frames);
/// The color of a body in orbits and in elements.
std::size_t body_color(const io::Frames& frames, std::size_t body);
/// Names with their colors; nothing where there are more than people can tell apart.
std::vector<PlotLegend> body_legend(const io::Frames& frames);

/// Whether particles are shown as a heap of dots at one moment, not as orbits: in a periodic box, or very many.
bool is_crowd(const io::Frames& frames);

/// The paths of few bodies, about the first where it has most of the mass.
std::vector<PlotOrbits> plot_orbits(const io::Frames& frames, std::size_t shown, std::optional<double> G,
                                    const std::string& projection);
/// Where every body stays on one line: x against time; nothing elsewhere.
std::optional<PlotPanel> plot_line_positions(const io::Frames& frames, const PlotTime& time);
/// The variables of a system against time.
std::vector<PlotPanel> plot_variables(const io::Frames& frames, const PlotTime& time);

/// Particles and bonds in perspective. @param legend  gets the kinds of particles
PlotBox plot_box(const ParticleSystem<double>& particles, const std::string& mass_unit,
                 std::vector<PlotLegend>& legend);

/// The errors that monitors have seen. @param changes_energy  whether the energy is meant to change
std::vector<PlotPanel> plot_errors(const std::vector<io::MonitorSeries>& monitors, const PlotTime& time,
                                   bool changes_energy);
/// Elements a, e, inc against time, from a monitor or from the frames.
std::vector<PlotPanel> plot_elements(const PlotSource& source);
/// Temperature against time, from a monitor or from the velocities of frames; nothing where neither tells it.
std::optional<PlotPanel> plot_temperature(const PlotSource& source);
/// Pressure against time, from a monitor.
std::optional<PlotPanel> plot_pressure(const PlotSource& source);

/// g(r) by pair of types where there are few types, each a mean of frames, up to half of the shortest edge.
std::vector<PlotCurve> radial_distributions(const io::Frames& frames, const std::vector<std::size_t>& chosen);
std::optional<PlotPanel> plot_radial_distribution(const PlotSource& source, bool one_frame);

/// Mean square displacement by lag, about the center of mass, unwrapped. Where frames are at equal distances in time, a
/// mean of all origins.
std::vector<PlotPoint> mean_square_displacement(const io::Frames& frames);
std::optional<PlotPanel> plot_mean_square_displacement(const PlotSource& source);

}  // namespace noether
