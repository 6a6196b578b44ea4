// Scenes of structures, builders, types and boxes.

#include "engine/charge.hpp"
#include "io/digest.hpp"
#include "numbers/error.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

namespace noether::test {
namespace {

const std::filesystem::path lammps_files = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "lammps";

const std::string rest =
    "\n[hamiltonian]\ntype = 'kinetic_potential'\n"
    "[[hamiltonian.force]]\ntype = 'uniform_field'\nacceleration = [0, 0, 0]\n"
    "[integrator]\nmethod = 'verlet'\nstep = 0.001\nsteps = 2\n";

/// A scene whose `[particles]` begins at line 2.
Scene scene_of(const std::string& particles, const std::string& units = "reduced") {
  std::string end = rest;
  if (units != "reduced") end.replace(end.find("[0, 0, 0]"), 9, "['0 nm/ps^2', '0 nm/ps^2', '0 nm/ps^2']");
  if (units != "reduced") end.replace(end.find("0.001"), 5, "'1 fs'");
  return read_scene("units = '" + units + "'\n[particles]\n" + particles + end, lammps_files / "scene.toml");
}

std::string structure_refusal(const std::string& particles, const std::string& units = "reduced") {
  try {
    scene_of(particles, units);
  } catch (const Error& error) {
    const std::string text = error.what();
    const auto folder = lammps_files.string() + "/";
    std::string shown = text;
    for (auto at = shown.find(folder); at != std::string::npos; at = shown.find(folder)) shown.erase(at, folder.size());
    return shown;
  }
  return "";
}

/// The effective scene is the same scene, particle by particle.
void check_effective(const Scene& scene) {
  const Scene again = read_scene(scene.effective_toml, scene.file);
  CHECK(again.effective_toml == scene.effective_toml);
  CHECK(io::digest(again.particles) == io::digest(scene.particles));
  CHECK(again.particles.topology()->pair_kinds == scene.particles.topology()->pair_kinds);
  CHECK(again.particles.topology()->explicit_pairs == scene.particles.topology()->explicit_pairs);
  CHECK(again.particles.topology()->mixing == scene.particles.topology()->mixing);
  CHECK(again.particles.topology()->exclusions == scene.particles.topology()->exclusions);
  CHECK(again.particles.has<Charge>() == scene.particles.has<Charge>());
}

TEST_CASE("a scene reads a structure with all the keys beside it", "[scene][structure]") {
  const Scene scene = scene_of(
      "structure = 'molecule.data'\nfile_units = 'real'\nspecial = [0, 0, 0.5]\nmixing = 'lorentz_berthelot'\n"
      "temperature = '300 K'\nseed = 5\n"
      "[[particles.type]]\nname = 1\nmass = '14 u'\nepsilon = '1 kJ/mol'\nsigma = '3 angstrom'\n"
      "[[particles.pair]]\ntypes = ['2', 1]\nepsilon = '2 kJ/mol'\nsigma = '0.4 nm'\n",
      "molecular");
  const ParticleSystem<double>& s = scene.particles;
  CHECK(s.size() == 7);
  CHECK(s.box().is_periodic());
  CHECK(s.masses()[0] == 14);
  CHECK(s.topology()->pair_kind(0, 0).epsilon == 1);
  CHECK(s.topology()->pair_kind(0, 1) == PairKind{2, 0.4});
  CHECK(s.topology()->mixing == Mixing::lorentz_berthelot);
  CHECK(s.topology()->scaled_pairs.size() + s.topology()->exclusions.size() > 0);
  CHECK(s.column<Charge>()[0] == 0.25);
  CHECK(std::abs(s.velocities()[0][0]) > 0);
  CHECK(scene.effective_toml.find("structure_sha256 = ") != std::string::npos);
  check_effective(scene);
  check_effective(scene_of("structure = 'chains.data'\nspecial = [0, 1, 1]\n"));
}

TEST_CASE("exclusions by id have the bits of those that a program names by index", "[scene][structure]") {
  const std::string liquid =
      "\n[hamiltonian]\ntype = 'kinetic_potential'\n"
      "[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = 1.5\ncutoff_style = 'shifted_force'\n"
      "[integrator]\nmethod = 'verlet'\nstep = 0.002\nsteps = 40\n";
  const auto scene_with = [&](const std::string& particles) {
    return read_scene("units = 'reduced'\n[particles]\nstructure = 'chains.data'\n" + particles +
                          "[[particles.type]]\nname = 1\nepsilon = 1\nsigma = 0.8\n"
                          "[[particles.type]]\nname = 2\nepsilon = 0.5\nsigma = 0.9\n" +
                          liquid,
                      lammps_files / "scene.toml");
  };
  const auto end_of = [](const Scene& scene) {
    Simulation<double> sim = assemble(scene);
    REQUIRE(sim.run(40).ok());
    return io::digest(sim.particles());
  };
  const Scene plain = scene_with("special = [0, 1, 0.5]\n");
  // 1 and 4 are the ends of a chain, and half of their force would be left; 2 and 5, 3 and 12 are of two chains.
  const Scene named = scene_with("special = [0, 1, 0.5]\nexclusions = [[5, 2],\n [4, 1], [3, 12]]\n");
  Scene by_hand = plain;
  auto topology = std::make_shared<Topology>(*plain.particles.topology());
  REQUIRE(topology->scaled_pairs.front() == Topology::ScaledPair{{0, 3}, 0.5});
  topology->scaled_pairs.erase(topology->scaled_pairs.begin());
  topology->exclusions.insert(topology->exclusions.end(), {{0, 3}, {1, 4}, {2, 11}});
  std::sort(topology->exclusions.begin(), topology->exclusions.end());
  by_hand.particles.set_topology(topology);
  CHECK(named.particles.topology()->exclusions == topology->exclusions);
  CHECK(end_of(named) == end_of(by_hand));
  CHECK(end_of(named) != end_of(plain));
  check_effective(named);
  CHECK(structure_refusal("structure = 'chains.data'\nexclusions = [[1, 2],\n [3, 99]]\n") ==
        "scene.toml:5: exclusions contains [3, 99], but there is no particle with id 99");
}

TEST_CASE("a structure runs in its box, and has changed where its hash has", "[scene][structure]") {
  const Scene scene = scene_of("structure = 'argon.data'\nfile_units = 'metal'\n", "molecular");
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(2).ok());
  CHECK(sim.particles().box() == scene.particles.box());
  CHECK(sim.particles().topology() == scene.particles.topology());
  std::string text = scene.effective_toml;
  const auto at = text.find("structure_sha256 = \"") + 20;
  text[at] = text[at] == '0' ? '1' : '0';
  CHECK_THROWS_WITH(read_scene(text, scene.file),
                    Catch::Matchers::Contains("'argon.data' differs from the file this scene was run with"));
}

TEST_CASE("coefficients of an input script are kept with their hash", "[scene][structure]") {
  const std::string charmm = "structure = 'charmm.data'\ncoefficients = 'charmm.in'\n";
  const Scene scene = scene_of(charmm, "molecular");
  CHECK(scene.particles.topology()->mixing == Mixing::lorentz_berthelot);
  CHECK(scene.effective_toml.find("coefficients_sha256 = ") != std::string::npos);
  CHECK(scene.effective_toml.find("special = ") == std::string::npos);
  check_effective(scene);
  check_effective(
      scene_of("structure = 'charmm.data'\ncoefficients = ['charmm.in']\nspecial = [0, 0, 0]\n", "molecular"));
  CHECK(structure_refusal(charmm + "special = [0, 0, 1]\n", "molecular") ==
        "charmm.in:11: special_bonds keeps [0, 0, 0], but special says [0, 0, 1]; take one of them out");
  CHECK(
      structure_refusal(charmm + "coefficients_sha256 = '12'\n", "molecular")
          .starts_with("scene.toml:5: the coefficients differ from those this scene was run with: their hash is now "));
  CHECK(structure_refusal("structure = 'charmm.data'\ncoefficients = []\ncoefficients_sha256 = ''\n", "molecular") ==
        "scene.toml:4: coefficients = [] names no file; give one, such as \"system.in.settings\", or a list");
  CHECK(structure_refusal("structure = 'charmm.data'\ncoefficients = ['charmm.in', 3]\n", "molecular") ==
        "scene.toml:4: coefficients = [\"charmm.in\", 3] names no file; give one, such as \"system.in.settings\", or a "
        "list");
  CHECK(structure_refusal("structure = 'charmm.data'\ncoefficients = 'none.in'\n", "molecular")
            .starts_with("scene.toml:4: none.in: "));
}

TEST_CASE("a scene takes one frame of several, and is told of columns that nobody reads", "[scene][structure]") {
  const ScratchFolder folder;
  write_text(folder / "run.xyz",
             "1\nstep=0\nO 1 0 0\n2\nstep=1 Properties=species:S:1:pos:R:3:magmom:R:1\nO 2 0 0 0.5\nH 3 0 0 0.5\n");
  const auto with = [&](const std::string& more) {
    return read_scene(
        "units = 'molecular'\n[particles]\nstructure = 'run.xyz'\n" + more +
            "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
            "'uniform_field'\nacceleration = ['0 nm/ps^2', '0 nm/ps^2', '0 nm/ps^2']\n[integrator]\nmethod = "
            "'verlet'\nstep = '1 fs'\nsteps = 2\n",
        folder / "scene.toml");
  };
  const Scene last = with("frame = -1\n");
  CHECK(last.particles.size() == 2);
  CHECK(last.effective_toml.find("frame = -1\n") != std::string::npos);
  check_effective(last);
  CHECK(warnings_of(last) == std::vector<std::string>{"the columns 'magmom' of the structure are ignored"});
  CHECK(with("frame = 0\n").particles.size() == 1);
  CHECK_THROWS_WITH(
      with("frame = 2\n"),
      Catch::Matchers::Contains("scene.toml:4: frame = 2, but the file has 2 frames: 0 to 1, or -1 for the "
                                "last"));
  CHECK_THROWS_WITH(with("frame = 'barycenter'\n"),
                    Catch::Matchers::Contains("run.xyz:4: there is more text after the 1 atoms"));
}

TEST_CASE("a builder is asked for by its name, and its scene is the same again", "[scene][builders]") {
  const Scene melt = scene_of("type = 'lattice'\ncells = [3, 3, 3]\ndensity = 0.8442\nmass = 1\ntemperature = 1.44\n");
  CHECK(melt.particles.size() == 108);
  CHECK(melt.effective_toml.find("lattice = \"fcc\"") != std::string::npos);
  check_effective(melt);
  check_effective(
      scene_of("type = 'liquid'\nparticles = 100\ndensity = '1.374 g/cm^3'\nmass = '39.948 u'\nepsilon = "
               "'0.996 kJ/mol'\nsigma = '3.4 angstrom'\ntemperature = '94 K'\n",
               "molecular"));
  const Scene chains = scene_of("type = 'polymer_chains'\nchains = 3\nbeads = 5\ndensity = 0.85\nmass = 1\nseed = 9\n");
  CHECK(chains.particles.topology()->bonds.size() == 12);
  check_effective(chains);
}

TEST_CASE("bodies of a scene can have a box, types and charges", "[scene]") {
  const Scene scene = scene_of(
      "box = [5, 6, 7]\nmixing = 'geometric'\n"
      "body = [{name = 'a', type = 'A', x = [-1, 0, 0], v = [0, 0, 0]},"
      " {name = 'b', type = 'B', mass = 3, charge = 2, x = [1, 0, 0], v = [0, 0, 0]}]\n"
      "[[particles.type]]\nname = 'A'\nmass = 2\ncharge = -1\nepsilon = 1\nsigma = 4\n"
      "[[particles.type]]\nname = 'B'\nepsilon = 4\nsigma = 9\n");
  const ParticleSystem<double>& s = scene.particles;
  CHECK(s.box() == Box::periodic({5, 6, 7}));
  CHECK(s.positions()[0] == Vec3<double>(4, 0, 0));
  CHECK(s.masses()[0] == 2);
  CHECK(s.masses()[1] == 3);
  CHECK(s.column<Charge>()[0] == -1);
  CHECK(s.column<Charge>()[1] == 2);
  CHECK(s.topology()->pair_kind(0, 1) == PairKind{2, 6});
  check_effective(scene);
}

TEST_CASE("keys of structures that are wrong are refused at their lines", "[scene][structure][messages]") {
  CHECK(structure_refusal("structure = '../../scenes/bad/cut.data'\n", "molecular") ==
        "scene.toml:2: this LAMMPS data file does not say its units; give file_units = \"real\" or \"metal\"");
  CHECK(structure_refusal("structure = 'molecule.data'\n") ==
        "scene.toml:2: a LAMMPS data file in real needs units = \"molecular\", not \"reduced\"");
  CHECK(structure_refusal("structure = 'molecule.data'\nfile_units = 'reel'\n", "molecular") ==
        "molecule.data:1: the file says units = real, but file_units says 'reel'; take file_units out");
  CHECK(structure_refusal("structure = 'make.py'\n") ==
        "scene.toml:3: 'make.py' has no supported format; a structure is a .data or .lmp file or data.NAME (LAMMPS), "
        ".xyz or .extxyz, .gro, or .msh (Gmsh)");
  CHECK(structure_refusal("structure = 'none.data'\n").starts_with("scene.toml:3: none.data: "));
  CHECK(structure_refusal("structure = ''\n") ==
        "scene.toml:3: structure = \"\" names no file; give one, such as \"water.data\"");
  CHECK(structure_refusal("structure = 'chains.data'\nspecial = [0, 2, 1]\n") ==
        "scene.toml:4: special contains 2; factors from 0 to 1 are expected");
  CHECK(structure_refusal("structure = 'chains.data'\nspecial = [0, 1]\n") ==
        "scene.toml:4: special = [0, 1] is not a list of three numbers; the factors of the forces between particles "
        "one, two and three bonds apart are expected: [s12, s13, s14]");
  CHECK(structure_refusal("structure = 'chains.data'\natom_style = 'full'\n") ==
        "chains.data:32: the file says atom style 'molecular', but the scene says 'full'; take atom_style out");
  CHECK(structure_refusal("structure = 'chains.data'\nbox = [1, 2, 3]\n") ==
        "scene.toml:4: the file has its own box, 5 x 6 x 7; leave box out, or give box = \"open\" to remove it");
  CHECK(structure_refusal("structure = 'chains.data'\nbox = 'closed'\n") ==
        "scene.toml:4: box = \"closed\" is not understood; three lengths are expected, or \"open\"");
  CHECK(structure_refusal("structure = 'chains.data'\nframe = 'barycenter'\n") ==
        "scene.toml:4: a periodic box has no centre of mass; take frame = \"barycenter\" out");
  CHECK(structure_refusal("structure = 'chains.data'\nmixing = 'arithmetic'\n") ==
        "scene.toml:4: unknown mixing 'arithmetic'; expected one of: lorentz_berthelot, geometric");
  CHECK(structure_refusal("structure = 'chains.data'\nseed = 3\n") ==
        "scene.toml:4: seed has no effect without a temperature; give a temperature too");
  CHECK(structure_refusal(
            "structure = 'chains.data'\n[[particles.type]]\nname = '1'\n[[particles.type]]\nname = '3'\n") ==
        "scene.toml:6: there is no type '3'; expected one of: 1, 2");
  CHECK(structure_refusal("structure = 'chains.data'\n[[particles.type]]\nmass = 1\n") ==
        "scene.toml:4: this [[particles.type]] has no name; give the name of the type");
  CHECK(structure_refusal("structure = 'chains.data'\n[[particles.pair]]\ntypes = ['1']\n") ==
        "scene.toml:5: a pair has two types; give them as types = [\"A\", \"B\"]");
  CHECK(structure_refusal("structure = 'chains.data'\n[[particles.pair]]\ntypes = ['1', '2']\nsigma = 1\n") ==
        "scene.toml:4: this [[particles.pair]] has no epsilon; give one");
  CHECK(structure_refusal("structure = 'chains.data'\nmass = 1\n")
            .starts_with("scene.toml:4: unknown key 'mass' in [particles]"));
}

TEST_CASE("particles come from one place, and its keys are the only ones", "[scene][messages]") {
  CHECK(structure_refusal("structure = 'chains.data'\ntype = 'lattice'\n") ==
        "scene.toml:3: bodies come from a structure and from a builder; give one or the other");
  CHECK(structure_refusal("type = 'latice'\n") == "scene.toml:3: unknown builder 'latice'; did you mean 'lattice'?");
  CHECK(structure_refusal("type = 'lattice'\nmass = 1\ndensity = 1\n")
            .starts_with("scene.toml:2: builder 'lattice' has no cells"));
  CHECK(structure_refusal("type = 'lattice'\nmass = 1\ndensity = 1\ncells = [1, 2]\n") ==
        "scene.toml:6: cells = [1, 2] is not a list of three numbers; the cells along x, y and z are expected");
  CHECK(structure_refusal("type = 'liquid'\nmass = 1\ndensity = 1\nparticles = 9\ncells = 3\n")
            .starts_with("scene.toml:7: unknown key 'cells' in builder 'liquid'"));
  CHECK(structure_refusal("body = [{type = 'A', mass = 1, x = [0, 0, 0], v = [0, 0, 0]}]\n") ==
        "scene.toml:3: body 'body_1' has a type, but there are no types; give [[particles.type]] tables");
  CHECK(structure_refusal("mixing = 'geometric'\nbody = [{mass = 1, x = [0, 0, 0], v = [0, 0, 0]}]\n") ==
        "scene.toml:3: mixing needs types, but there are none; give [[particles.type]] tables");
  CHECK(structure_refusal(
            "body = [{type = 'C', mass = 1, x = [0, 0, 0], v = [0, 0, 0]}]\n[[particles.type]]\nname = 'A'\n") ==
        "scene.toml:3: there is no type 'C'; expected one of: A");
}

}  // namespace
}  // namespace noether::test
