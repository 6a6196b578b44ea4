/// Pictures ask parts for their claims, not for their names: parts from outside the library are shown as built-in ones.

#include "cli/particle_links.hpp"
#include "cli/plot_source.hpp"
#include "cli/run_gravity.hpp"
#include "io/trajectory_reader.hpp"
#include "scene/parts.hpp"
#include "tests/cli/support.hpp"

#include <algorithm>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// A pull of masses by another name.
struct Pull {
  static constexpr auto describe() {
    return part<Pull>("harmonic_field", "a pull of masses", formula("U = - m M / r"));
  }
  static ForceClaims claims() { return {.kepler = true, .G = 1}; }
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& /*s*/) const {}
};
/// Something else by the name of gravity.
struct Breeze {
  static constexpr auto describe() { return part<Breeze>("gravity", "a breeze", formula("a = g")); }
  template <class Real> void add_to(ForceSink<Real>& /*out*/, const ParticleSystem<Real>& /*s*/) const {}
};
/// A constraint of two particles that is no rod.
struct SameHeight {
  static constexpr std::size_t particles = 2;
  static constexpr auto describe() { return part<SameHeight>("distance", "the same height", formula("z_1 = z_2")); }
  template <class Real> Real value(const Points<Real, 2>& x) const { return x[0][2] - x[1][2]; }
  double scale() const { return 1; }
};

std::string bodies_of_two_parts(const std::string& hamiltonian) {
  return "units = \"reduced\"\n[particles]\nbody = [{ name = \"heavy\", mass = 1, x = [0, 0, 0], v = [0, 0, 0] }, { "
         "name = \"light\", mass = 0.001, x = [1, 0, 0], v = [0, 1, 0] }]\n[hamiltonian]\n" +
         hamiltonian +
         "[integrator]\nmethod = \"verlet\"\nstep = 0.01\nsteps = 30\n[[every]]\ntype = \"trajectory\"\nsteps = 10\n";
}

bool shows_elements(const std::filesystem::path& run, const Parts& parts) {
  const PlotData data = read_plot_data(run, parts);
  return std::any_of(data.panels.begin(), data.panels.end(),
                     [](const PlotPanel& panel) { return panel.title == "Semi-major axis"; });
}

/// By a reader that is open while the file is opened again.
std::size_t links_of(const std::filesystem::path& run, const Parts& parts) {
  const io::TrajectoryReader reader(run);
  const SceneValue scene = scene_in_file(io::info(run).scene_toml, run);
  return read_links(reader.file(), scene, parts, unit_system("reduced"), reader.shared(), {0, 1}).pairs.size();
}

}  // namespace

TEST_CASE("orbits are drawn where a force claims to move pairs on them, whatever its name", "[cli][plot]") {
  const std::string free = "type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = ";
  const SceneFolder pulled(bodies_of_two_parts(free + "\"gravity\"\n")),
      held(bodies_of_two_parts(free + "\"harmonic_field\"\nk = 1\n"));
  const SceneFolder arcs(bodies_of_two_parts("type = \"wisdom_holman\"\n"));
  for (const SceneFolder* folder : {&pulled, &held, &arcs}) output(*folder, "run scene.toml --quiet");
  Parts others = standard_parts();
  others.add_force<Pull>();
  others.add_force<Breeze>();
  CHECK(shows_elements(pulled / "scene.out/run.h5", standard_parts()));
  CHECK_FALSE(shows_elements(pulled / "scene.out/run.h5", others));
  CHECK_FALSE(shows_elements(held / "scene.out/run.h5", standard_parts()));
  CHECK(shows_elements(held / "scene.out/run.h5", others));
  CHECK(shows_elements(arcs / "scene.out/run.h5", others));
}

TEST_CASE("rods are drawn where a constraint says that it is one, whatever its name", "[cli][plot]") {
  const SceneFolder folder(
      bodies_of_two_parts("type = \"kinetic_potential\"\n[[hamiltonian.constraint]]\ntype = \"distance\"\n"
                          "pairs = [[\"heavy\", \"light\"]]\n"));
  output(folder, "run scene.toml --quiet");
  Parts others = standard_parts();
  CHECK(links_of(folder / "scene.out/run.h5", others) == 1);
  others.add_constraint<SameHeight>();
  CHECK(links_of(folder / "scene.out/run.h5", others) == 0);
}

}  // namespace noether::test

#endif
