#include "cli/scene_tables.hpp"

#include "constraints/constraint_set.hpp"
#include "engine/neighbor_options.hpp"
#include "integrators/composition_options.hpp"
#include "integrators/rotating.hpp"
#include "scene/minimize.hpp"

#include <initializer_list>
#include <string_view>
#include <utility>

namespace noether {

namespace {

/// A key as this file writes it down.
struct Key {
  std::string_view name, kind, unit, fallback, help;
  std::string_view example = "";  ///< not empty: the key must be there
  std::initializer_list<std::string_view> choices = {};
};

std::vector<FieldInfo> fields(std::initializer_list<Key> keys) {
  std::vector<FieldInfo> all;
  for (const Key& key : keys) {
    all.push_back({std::string(key.name),
                   std::string(key.unit),
                   std::string(key.help),
                   std::string(key.kind),
                   std::string(key.fallback),
                   std::string(key.example),
                   {}});
    for (const std::string_view choice : key.choices) all.back().choices.emplace_back(choice);
  }
  return all;
}

/// These keys, then those that a struct describes.
template <class T> std::vector<FieldInfo> and_of(std::vector<FieldInfo> first) {
  const std::vector<FieldInfo> own = part_info<T>().fields;
  first.insert(first.end(), own.begin(), own.end());
  return first;
}

SceneTable top() {
  return {
      "",
      "The keys above the first table. A scene has [particles] and [hamiltonian], or [system], and [integrator]; all "
      "other tables may be missing.",
      fields({{"title", "text", "1", "", "what the run is called in reports, files and pictures"},
              {"program", "text", "1", "", "how to run a program that has parts of this scene which noether lacks"},
              {"units",
               "choice",
               "1",
               "",
               "the units of bare numbers, of files and of the constant G",
               "\"solar\"",
               {"solar", "molecular", "si", "reduced"}}})};
}

SceneTable particles() {
  return {
      "[particles]",
      "Which particles there are. They come from `bodies`, from `[[particles.body]]` tables, from both, from a "
      "`structure`, or from a builder (`type`).",
      fields({
          {"bodies", "text", "1", "", "file of bodies: CSV, vector tables of JPL Horizons, or the run.h5 of a run"},
          {"bodies_sha256", "text", "1", "", "the SHA-256 of the file; another file is refused"},
          {"structure", "text", "1", "", "file of a structure: LAMMPS data, (extended) XYZ, .gro, or a mesh of Gmsh"},
          {"structure_sha256", "text", "1", "", "the SHA-256 of the file; another file is refused"},
          {"type", "text", "1", "", "a builder; its keys are in this table too"},
          {"molecules",
           "choice",
           "1",
           "",
           "\"rigid\" makes each molecule of a structure, or of run.h5, one rigid body",
           "",
           {"rigid"}},
          {"frame",
           "choice",
           "1",
           "\"as_given\"",
           "\"barycenter\" moves the centre of mass to the origin, at rest; a whole number is the frame of run.h5, "
           "XYZ or .gro to start from",
           "",
           {"as_given", "barycenter"}},
          {"epoch", "text", "1", "", "the Julian day of the start, such as \"JD 2451545 TDB\""},
          {"elements",
           "choice",
           "1",
           "\"first_body\"",
           "what orbital elements are about: the first body, or the barycenter of all bodies above",
           "",
           {"first_body", "jacobi"}},
          {"box", "list", "length", "", "the three edges of a periodic box, or \"open\""},
          {"exclusions", "list", "1", "", "pairs of ids between which no pair force acts: [[1, 5], [2, 7]]"},
          {"mixing",
           "choice",
           "1",
           "\"lorentz_berthelot\"",
           "how unlike types mix",
           "",
           {"lorentz_berthelot", "geometric"}},
          {"special", "list", "1", "[0, 0, 0]",
           "factors of pair forces one, two and three bonds apart, or a table of two such lists, `lennard_jones` and "
           "`charges`"},
          {"file_units",
           "choice",
           "1",
           "",
           "units of a structure that does not say them; of a mesh its unit of length, such as \"mm\"",
           "",
           {"lj", "real", "metal"}},
          {"density", "number", "density", "", "of the bodies of a mesh, or a table of those of its regions"},
          {"atom_style", "text", "1", "", "style of `Atoms` in a LAMMPS data file that does not say it"},
          {"coefficients", "text", "1", "", "LAMMPS input script with coefficients, or a list of them"},
          {"coefficients_sha256", "text", "1", "", "the SHA-256 of these files; others are refused"},
          {"temperature", "number", "temperature", "", "draws the velocities of a structure anew"},
          {"seed", "whole number", "1", "1", "of these velocities"},
      })};
}

SceneTable body() {
  return {
      "[[particles.body]]",
      "One body. It has `x` and `v`, or orbital elements; the first body has neither and rests at the origin. What a "
      "Hamiltonian or a force declares for each particle is a key too.",
      fields({
          {"name", "text", "1", "\"body_N\"", "a name that no other body has"},
          {"mass", "number", "mass", "", "0 is a tracer", "\"1 Msun\""},
          {"x", "vector", "length", "", "position"},
          {"v", "vector", "velocity", "", "velocity"},
          {"about", "text", "1", "", "the body above, or a list of bodies, that x and v or the elements are about"},
          {"a", "number", "length", "", "semi-major axis, below 0 for a hyperbola; or P or q"},
          {"P", "number", "time", "", "period of an ellipse"},
          {"q", "number", "length", "", "distance of the pericenter"},
          {"e", "number", "1", "0", "eccentricity; 1, a parabola, with q"},
          {"inc", "number", "angle", "0", "inclination"},
          {"Omega", "number", "angle", "0", "longitude of the ascending node"},
          {"omega", "number", "angle", "0", "argument of the pericenter; or pomega"},
          {"pomega", "number", "angle", "", "longitude of the pericenter, Omega + omega"},
          {"M", "number", "angle", "0", "mean anomaly; or f, l or T"},
          {"f", "number", "angle", "", "true anomaly"},
          {"l", "number", "angle", "", "mean longitude, Omega + omega + M"},
          {"T", "number", "time", "", "time of the passage of the pericenter from the start on, or \"JD ...\""},
          {"type", "text", "1", "", "its type, where there are [[particles.type]] tables"},
          {"charge", "number", "charge", "", "its charge; default: that of its type"},
      })};
}

SceneTable rigid_body() {
  return {
      "[[particles.rigid_body]]",
      "One rigid body. It has `semi_axes`, `inertia` or sites, and the keys of `[[particles.body]]`; or it is a top "
      "that turns about a `fixed_point`.",
      fields({
          {"semi_axes", "vector", "length", "", "half the axes of a homogeneous ellipsoid"},
          {"inertia", "vector", "mass length^2", "", "principal moments of inertia"},
          {"sites", "text", "1", "", "CSV file of its sites, in place of `[[particles.rigid_body.site]]` tables"},
          {"site", "tables", "1", "", "its sites: `[[particles.rigid_body.site]]`"},
          {"linear", "flag", "1", "false", "true: the sites lie on one line, about which nothing turns"},
          {"fixed_point", "vector", "length", "", "where a top is held; its inertia is about this point"},
          {"center", "vector", "length", "", "the centre of mass of a top from its fixed point, in its own axes"},
          {"orientation", "list", "1", "[1, 0, 0, 0]",
           "quaternion w, x, y, z of the turn from its axes to those of space"},
          {"axis", "vector", "1", "", "of the turn from the axes of space, in place of an orientation; with angle"},
          {"angle", "number", "angle", "", "of this turn"},
          {"spin", "vector", "mass length^2/time", "", "angular momentum about its centre, along the axes of space"},
          {"angular_velocity", "vector", "1/time", "", "along its own axes, in place of the spin"},
          {"spin_period", "number", "time", "", "turns once in this time about the axis of its largest moment"},
      })};
}

SceneTable site() {
  return {"[[particles.rigid_body.site]]", "One site of a rigid body: where forces between points act.",
          fields({{"name", "text", "1", "", "in frames and messages"},
                  {"place", "vector", "length", "", "from any point of the body, along any axes", "[0, 0, \"0.1 nm\"]"},
                  {"mass", "number", "mass", "0", "0: a site that only takes forces"},
                  {"charge", "number", "charge", "", "its charge; default: that of its type"},
                  {"type", "text", "1", "", "its type, where there are [[particles.type]] tables"}})};
}

SceneTable type() {
  return {"[[particles.type]]", "What particles of one type have. It replaces what a structure says.",
          fields({{"name", "text", "1", "", "of the type, or its number", "\"O\""},
                  {"mass", "number", "mass", "", "of a particle"},
                  {"charge", "number", "charge", "", "of a particle"},
                  {"epsilon", "number", "energy", "", "depth of the well of `lennard_jones`; with sigma"},
                  {"sigma", "number", "length", "", "where the energy of `lennard_jones` is 0"}})};
}

SceneTable special() {
  return {
      "[particles.special]",
      "Factors of pair forces one, two and three bonds apart, where charges have others than Lennard-Jones: 1/2 and "
      "1/1.2 of Amber. Where they are the same, a list alone does.",
      fields({{"lennard_jones", "list", "1", "", "of all forces but those of charges", "[0, 0, 0.5]"},
              {"charges", "list", "1", "", "of forces between charges", "[0, 0, 0.8333333333333334]"}})};
}

SceneTable special_pair() {
  return {"[[particles.special_pair]]",
          "A pair of particles with its own parameters: it is left out of pair forces, and becomes a term `one_four` "
          "of the force `bonded`, without a cutoff.",
          fields({{"ids", "list", "1", "", "of the two particles", "[1, 4]"},
                  {"epsilon", "number", "energy", "0", "depth of the well; with sigma"},
                  {"sigma", "number", "length", "", "where the energy of Lennard-Jones is 0"},
                  {"charge_product", "number", "charge^2", "0", "of the two charges"}})};
}

SceneTable pair() {
  return {"[[particles.pair]]", "The parameters of one pair of types, in place of mixing.",
          fields({{"types", "list", "1", "", "the two types", "[\"O\", \"Na\"]"},
                  {"epsilon", "number", "energy", "", "depth of the well", "\"0.2 kJ/mol\""},
                  {"sigma", "number", "length", "", "where the energy is 0", "\"0.29 nm\""}})};
}

SceneTable hamiltonian() {
  return {"[hamiltonian]", "What moves the particles. The keys of the Hamiltonian itself are here too.",
          and_of<RotatingOptions>(fields(
              {{"type", "text", "1", "", "a Hamiltonian", "\"kinetic_potential\""},
               {"G", "number", "length^3/mass/time^2", "",
                "the constant of gravitation, a bare number in the units of the scene; default: that of the units"}}))};
}

SceneTable force() {
  return {"[[hamiltonian.force]]", "One force; as many tables as there are forces.",
          fields({{"type", "text", "1", "", "a force", "\"gravity\""},
                  {"kick", "text", "1", "\"B\"",
                   "the letter of its kicks, for multiple time steps by respa or a word such as \"CBABABC\""}})};
}

SceneTable charge_field() {
  return {"[[hamiltonian.field]]", "One field that acts on charges; as many tables as there are fields.",
          fields({{"type", "text", "1", "", "a field", "\"tokamak\""}})};
}

SceneTable constraint() {
  return {"[[hamiltonian.constraint]]",
          "Constraints of one kind. All tables share one solver; `tolerance` belongs to `rattle` and `p_shake`, "
          "`order` to `lincs` and "
          "`p_lincs`, `iterations` to all four.",
          and_of<ConstraintOptions>(fields({{"type", "text", "1", "", "a constraint", "\"distance\""}}))};
}

SceneTable system() {
  return {"[system]", "A system y' = f(t, y), in place of [particles] and [hamiltonian].",
          fields({{"type", "text", "1", "", "a system", "\"robertson\""},
                  {"start", "list", "1", "", "the variables at the start; default: those of the system"}})};
}

/// The keys of all methods together.
SceneTable integrator(const Parts& parts) {
  std::vector<FieldInfo> keys = and_of<CompositionOptions>(fields({
      {"method", "text", "1", "", "a name of `noether list methods`, or a word of letters such as \"BAOAB\"",
       "\"verlet\""},
      {"step", "number", "time", "",
       "length of a step, below 0 to go back in time, or part of a turn of the first charge, \"0.05 gyration\"; "
       "methods that choose their steps take it as the first one"},
      {"until", "number", "time", "",
       "the time at which the run ends, at the first whole step at or after it; or steps"},
      {"steps", "whole number", "1", "", "how many steps the run has, in place of until"},
      {"start_time", "number", "time", "0", "what the clock shows at the start"},
      {"exact", "flag", "1", "false", "true: refuses times between two steps where the method has no states"},
  }));
  for (const OptionGroup* group : parts.method_options()) {
    for (const OptionValue& one : group->values({})) {
      keys.push_back({std::string(one.name),
                      std::string(one.dimension),
                      std::string(one.help),
                      std::string(one.kind),
                      "",
                      "",
                      {one.choices.begin(), one.choices.end()}});
    }
  }
  return {"[integrator]",
          "The method and the length of the run. The section Methods below says which method takes which of the later "
          "keys.",
          keys};
}

SceneTable every() {
  return {
      "[[every]]",
      "A monitor or a writer, and its times: one of `every`, `steps` and `times`. Without any such table a run "
      "has `energy` and about 200 frames; `every = []`, above all tables, leaves both out.",
      fields({{"type", "text", "1", "", "a monitor or a writer", "\"energy\""},
              {"every", "number", "time", "",
               "time between two samples; to the nearest step where the method has no states between two"},
              {"steps", "whole number", "1", "", "steps between two samples"},
              {"times", "list", "time", "", "samples at these times only; or the name of a file with one time a line"},
              {"after", "number", "time", "", "with `every` or `steps`: no samples before this time of the clock"},
              {"wall", "text", "1", "", "of `checkpoint`: wall time between two checkpoints, such as \"5 min\""}})};
}

SceneTable stop() {
  return {"[[stop]]", "A condition that ends the run.",
          fields({{"type", "text", "1", "", "a stop", "\"collision\""},
                  {"every", "number", "time", "", "time between two checks, instead of the steps of the stop"}})};
}

SceneTable verdict() {
  return {"[[verdict]]", "What runs of the scene show, for `noether stability --suite`; a run ignores it.",
          fields({{"methods", "list", "1", "", "names of methods, or \"all\""},
                  {"set", "list", "1", "[]", "changes as for `--set`, such as \"integrator.step=0.1\""},
                  {"outcome",
                   "choice",
                   "1",
                   "\"bounded\"",
                   "what the runs do",
                   "",
                   {"bounded", "unbounded", "solver", "theory"}},
                  {"energy_below", "number", "1", "", "the largest error of the energy is below this"},
                  {"energy_above", "number", "1", "", "and above this"},
                  {"sharing_below", "number", "1", "", "the energy that the modes exchange is below this"},
                  {"sharing_above", "number", "1", "", "and above this"},
                  {"nightly", "flag", "1", "false", "true: runs only with the nightly tests"},
                  {"why", "text", "1", "", "the reason, for the report"}})};
}

SceneTable named(std::string name, std::string help, std::vector<FieldInfo> keys) {
  return {std::move(name), std::move(help), std::move(keys)};
}

}  // namespace

std::vector<SceneTable> scene_tables(const Parts& parts) {
  std::vector<SceneTable> all = {top(),   particles(),    body(),      rigid_body(),   site(),
                                 type(),  pair(),         special(),   special_pair(), hamiltonian(),
                                 force(), charge_field(), constraint()};
  all.push_back(named("[hamiltonian.neighbors]", "How neighbors of pair forces are found; only `renewal` changes bits.",
                      and_of<NeighborOptions>({})));
  all.push_back(named("[hamiltonian.thermostat]", "Keeps the particles at a temperature, by friction and noise.",
                      fields({{"type", "text", "1", "", "a thermostat", "\"langevin\""}})));
  all.push_back(system());
  all.push_back(named("[minimize]", "Moves the particles to a minimum of the energy before the first step.",
                      and_of<MinimizeOptions>({})));
  all.push_back(integrator(parts));
  all.push_back(named("[[integrator.decorator]]",
                      "Something around the method; the first table is next to it. One of each may stand under its own "
                      "name as well, such as [integrator.projection]: next to the method then.",
                      fields({{"type", "text", "1", "", "a decorator", "\"NAME\""}})));
  all.push_back(every());
  all.push_back(stop());
  all.push_back(named("[expect]",
                      "What this run shows, for tests; a run ignores it. Keys are figures of monitors: `energy.worst = "
                      "1e-9`, and `.rms`, `.first`, `.last`.",
                      {}));
  all.push_back(verdict());
  return all;
}

}  // namespace noether
