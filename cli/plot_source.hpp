#pragma once
/// A run as it was read for a picture, and the parts of the picture that are made from it.

#include "cli/particle_links.hpp"
#include "cli/plot_axes.hpp"
#include "cli/plot_data.hpp"
#include "cli/plot_frames.hpp"
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
  PlotFrames frames;
  std::vector<io::MonitorSeries> monitors;
  PlotTime time;
  std::size_t shown = 0;           ///< the place of the frame that is shown
  std::optional<double> G = {};    ///< constant of gravitation; nothing where the scene has no gravity
  std::optional<double> k_B = {};  ///< Boltzmann's constant
  std::string temperature_unit = {}, pressure_unit = {};
  ParticleLinks links = {};               ///< by rows of frames
  std::optional<PlotLength> length = {};  ///< the unit of orbits; nothing: that of the file
};

/// The first monitor of a name, one with a number behind it too; null if there is none.
const io::MonitorSeries* find_monitor(const std::vector<io::MonitorSeries>& monitors, std::string_view name);

/// The color of a body in orbits and in elements: that of its name where all bodies are called by colors.
std::size_t body_color(const PlotFrames& frames, std::size_t body);
/// Names with their colors; nothing where there are more than people can tell apart.
std::vector<PlotLegend> body_legend(const PlotFrames& frames);

/// Whether particles are shown as a heap of dots at one moment, not as orbits: in a periodic box, or very many.
bool is_crowd(const PlotFrames& frames);

/// The paths of few bodies, about the primary where there is one and `G` tells of gravity, and what links bodies. Many
/// bodies that are linked have no paths; their links are drawn at some moments before too.
std::vector<PlotOrbits> plot_orbits(const PlotFrames& frames, std::size_t shown, std::optional<double> G,
                                    const std::string& projection, const ParticleLinks& links = {},
                                    const std::optional<PlotLength>& length = {});
/// Where there are no frames: the ellipses of the last sample of the monitor `elements`; nothing without it.
std::vector<PlotOrbits> plot_orbits_of_elements(const PlotSource& source, const std::string& projection = "");
/// Where every body stays on one line: x against time; nothing elsewhere.
std::optional<PlotPanel> plot_line_positions(const PlotFrames& frames, const PlotTime& time);
/// The variables of a system against time.
std::vector<PlotPanel> plot_variables(const PlotFrames& frames, const PlotTime& time);

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
/// The ways of the third axes of few rigid bodies, seen from above; nothing where they stay, or without frames.
std::optional<PlotPanel> plot_axes(const PlotSource& source);
/// The angle of a resonance of spin and orbit against time, or the rates of a body that has no orbit, from a monitor.
std::optional<PlotPanel> plot_spin(const PlotSource& source);
/// Angles of resonances of mean motions against time, one for each monitor.
std::vector<PlotPanel> plot_resonances(const PlotSource& source);
/// The mean exponential growth factor of nearby orbits and Lyapunov exponents against time, from their monitors.
std::vector<PlotPanel> plot_chaos(const PlotSource& source);
/// The histogram of dihedral angles over the run, from a monitor.
std::optional<PlotPanel> plot_dihedrals(const PlotSource& source);
/// Figures of the members of an ensemble, one panel each: over the first two keys that vary in color, over one key
/// against it. @param options  `what` are columns of the table: "megno_mean", "elements_value.Saturn.e"
/// @throws FileError; Error  for figures that the table does not have
PlotData plot_ensemble(const std::filesystem::path& file, const Parts& parts, const PlotOptions& options);

/// g(r) by pair of types where there are few types, each a mean of frames, up to half of the shortest edge.
/// @param molecules  the number of each particle's; pairs within one are left out. Empty: all pairs count
std::vector<PlotCurve> radial_distributions(const PlotFrames& frames, const std::vector<std::size_t>& chosen,
                                            const std::vector<std::size_t>& molecules = {});
std::optional<PlotPanel> plot_radial_distribution(const PlotSource& source, bool one_frame);

/// Mean square displacement by lag, about the center of mass, unwrapped. Where frames are at equal distances in time, a
/// mean of all origins. Of many particles in many frames some are looked at, so many as `most_numbers` coordinates.
std::vector<PlotPoint> mean_square_displacement(const PlotFrames& frames, std::size_t most_numbers = 20'000'000);
std::optional<PlotPanel> plot_mean_square_displacement(const PlotSource& source);

}  // namespace noether
