// Pairs three bonds apart with factors for charges of their own, and pairs with parameters of their own, against
// OpenMM.

#include "engine/force_sink.hpp"
#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "forces/check_gradient.hpp"
#include "numbers/error.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

const std::filesystem::path openmm_files = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "openmm";

/// The chain of tests/data/openmm with OpenMM's cutoffs; `particles` are further keys, from line 5 on.
Scene chain(const std::string& particles) {
  return read_scene("units = 'molecular'\n[particles]\nstructure = 'chain.data'\nfile_units = 'real'\n" + particles +
                        "\n[hamiltonian]\ntype = 'kinetic_potential'\n"
                        "[[hamiltonian.force]]\ntype = 'bonded'\n"
                        "[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = '0.5 nm'\n"
                        "cutoff_style = 'potential_switch'\nswitch_from = '0.4 nm'\n"
                        "[[hamiltonian.force]]\ntype = 'reaction_field'\ncutoff = '0.5 nm'\ndielectric = 78.3\n"
                        "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 20\n",
                    openmm_files / "scene.toml");
}

constexpr const char* mixing = "mixing = 'lorentz_berthelot'\n";
/// Amber's factors.
constexpr const char* amber = "special = {lennard_jones = [0, 0, 0.5], charges = [0, 0, 0.8333333333333334]}\n";
/// OWN of tests/data/openmm/make.py.
constexpr const char* own_pairs =
    "[[particles.special_pair]]\nids = [1, 4]\ncharge_product = '0.07 e^2'\nsigma = '0.31 nm'\n"
    "epsilon = '0.4 kJ/mol'\n"
    "[[particles.special_pair]]\nids = [6, 2]\ncharge_product = '-0.05 e^2'\nsigma = '2.8 angstrom'\nepsilon = '0.9 "
    "kJ/mol'\n"
    "[[particles.special_pair]]\nids = [3, 6]\ncharge_product = '0 e^2'\n";

/// Of the k-th force.
double energy_of(const Scene& scene, std::size_t k) {
  return test::evaluated<double>(scene.hamiltonian.forces.at(k).force, scene.particles).energy;
}

/// Of the force `bonded` with some of its terms.
template <class Keep> double bonded_energy(const Scene& scene, const Keep& keep) {
  auto topology = std::make_shared<Topology>(*scene.particles.topology());
  keep(*topology);
  ParticleSystem<double> s = scene.particles;
  s.set_topology(topology);
  return test::evaluated<Quad>(Bonded{}, s).energy;
}

double one_four_energy(const Scene& scene) {
  return bonded_energy(scene, [](Topology& t) {
    t.bonds.clear();
    t.angles.clear();
    std::erase_if(t.dihedrals, [&](const BondedTerm<4>& term) {
      return t.dihedral_kinds[static_cast<std::size_t>(term.type)].potential != "one_four";
    });
  });
}

std::string refusal(const std::string& particles) {
  try {
    static_cast<void>(chain(particles));
  } catch (const Error& error) {
    const std::string text = error.what();
    const auto scene = text.find("scene.toml:");
    return scene == std::string::npos ? text : text.substr(scene);
  }
  return "";
}

// What make.py printed: OpenMM 8.6.1, platform Reference [kJ/mol].
constexpr double bond_energy = 4.98720160861357, angle_energy = 1.28380597931969, dihedral_energy = 0.0803686313687028;
constexpr double one_four_lennard_jones = -0.821372930284916, one_four_charges = 12.4194258683371;
constexpr double far_lennard_jones = -0.0184811696702969, far_charges = -0.045883999296719;
constexpr double all_lennard_jones_own = -0.713351248610771, all_charges_own = 17.8419913911866;
constexpr double own_1_4 = 25.7317617746928, own_2_6 = -14.6419214654536;

}  // namespace

TEST_CASE("Amber's factors of pairs three bonds apart give OpenMM's energies term by term",
          "[scene][special][oracle]") {
  const Scene scene = chain(std::string(mixing) + amber);
  CHECK(std::abs(bonded_energy(scene, [](Topology& t) { t.angles.clear(), t.dihedrals.clear(); }) - bond_energy) <
        1e-11);
  CHECK(std::abs(bonded_energy(scene, [](Topology& t) { t.bonds.clear(), t.dihedrals.clear(); }) - angle_energy) <
        1e-11);
  CHECK(std::abs(one_four_energy(scene) - (one_four_lennard_jones + one_four_charges)) < 1e-10);
  CHECK(std::abs(energy_of(scene, 0) -
                 (bond_energy + angle_energy + dihedral_energy + one_four_lennard_jones + one_four_charges)) < 1e-10);
  CHECK(std::abs(energy_of(scene, 1) - far_lennard_jones) < 1e-11);
  CHECK(std::abs(energy_of(scene, 2) - far_charges) < 1e-9);  // sums count whole units of a strong force
  CHECK(scene.particles.topology()->scaled_pairs.empty());
  const Scene again = read_scene(scene.effective_toml, scene.file);
  CHECK(again.effective_toml == scene.effective_toml);
  CHECK(energy_of(again, 0) == energy_of(scene, 0));
}

TEST_CASE("pairs with parameters of their own give OpenMM's energies with its exceptions", "[scene][special][oracle]") {
  const Scene scene = chain(std::string(mixing) + amber + own_pairs);
  const double all = bond_energy + angle_energy + dihedral_energy + all_lennard_jones_own + all_charges_own;
  CHECK(std::abs(energy_of(scene, 0) + energy_of(scene, 1) + energy_of(scene, 2) - all) < 1e-9);
  // Each by itself: the pairs 1-4, of the three that were 1-4 before, 2-6 and 3-6 are OWN; 2-5 stays Amber's.
  const Topology& t = *scene.particles.topology();
  for (const auto& [i, j] : {Topology::Pair{0, 3}, Topology::Pair{1, 5}, Topology::Pair{2, 5}})
    CHECK(t.pair_factor(i, j) == 0);
  const Scene without = chain(std::string(mixing) + "special = [0, 0, 0]\n" + own_pairs);
  CHECK(std::abs(one_four_energy(without) - (own_1_4 + own_2_6)) < 1e-10);
  CHECK(gradient_error(Bonded{}, scene.particles) < 1e-12);
  // Lanes and threads have them, and a run goes on with them.
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(20).ok());
  CHECK(read_scene(scene.effective_toml, scene.file).effective_toml == scene.effective_toml);
}

TEST_CASE("two equal lists of factors are one", "[scene][special]") {
  const Scene two = chain(std::string(mixing) + "special = {lennard_jones = [0, 0, 0.5], charges = [0, 0, 0.5]}\n");
  const Scene one = chain(std::string(mixing) + "special = [0, 0, 0.5]\n");
  CHECK(two.particles.topology()->scaled_pairs == one.particles.topology()->scaled_pairs);
  CHECK(one.particles.topology()->scaled_pairs.size() == 3);
  CHECK(two.particles.topology()->dihedrals == one.particles.topology()->dihedrals);
}

TEST_CASE("special factors and pairs that make no sense are refused by name", "[scene][special][messages]") {
  CHECK(refusal("special = {lennard_jones = [0, 0.5, 0.5], charges = [0, 0, 0.8]}\n") ==
        "scene.toml:5: special keeps [0, 0.5, 0.5] of lennard_jones and [0, 0, 0.8] of charges; only the third factor "
        "may differ");
  CHECK(refusal("special = {lennard_jones = [0, 0, 0.5], charges = [0, 0, 1.5]}\n") ==
        "scene.toml:5: special contains 1.5; factors from 0 to 1 are expected");
  CHECK(refusal("special = {lennard_jones = [0, 0, 0.5], charges = [0, 0]}\n")
            .starts_with("scene.toml:5: charges = [0, 0] is not a list of three numbers"));
  CHECK(refusal("special = {lennard_jones = [0, 0, 0.5]}\n") ==
        "scene.toml:5: special has no charges; give lennard_jones and charges, each as [s12, s13, s14]");
  const std::string pair = "[[particles.special_pair]]\n";
  CHECK(refusal(pair + "ids = [1, 1]\ncharge_product = '1 e^2'\n") ==
        "scene.toml:6: ids = [1, 1], which is the same particle twice; two different ids are expected");
  CHECK(refusal(pair + "ids = [1, 2, 3]\ncharge_product = '1 e^2'\n") ==
        "scene.toml:6: ids = [1, 2, 3]; two ids are expected, such as [1, 5]");
  CHECK(refusal(pair + "ids = [1, 9]\ncharge_product = '1 e^2'\n") ==
        "scene.toml:6: ids = [1, 9], but there is no particle with id 9");
  CHECK(
      refusal(pair + "ids = [1, 4]\ncharge_product = '1 e^2'\n" + pair + "ids = [4, 1]\ncharge_product = '1 e^2'\n") ==
      "scene.toml:9: ids = [4, 1], a pair that is already listed; take one out");
  CHECK(refusal(pair + "ids = [1, 4]\nepsilon = '1 kJ/mol'\n") ==
        "scene.toml:7: epsilon is given alone; give both epsilon and sigma, or neither");
  CHECK(refusal(pair + "ids = [1, 4]\nepsilon = '-1 kJ/mol'\nsigma = '1 nm'\n") ==
        "scene.toml:7: epsilon = \"-1 kJ/mol\" is not a valid depth; 0 or more is expected");
  CHECK(refusal(pair + "ids = [1, 4]\nepsilon = '1 kJ/mol'\nsigma = '0 nm'\n") ==
        "scene.toml:8: sigma = \"0 nm\" is not a valid length; a length above 0 is expected");
  CHECK(
      refusal(pair + "ids = [1, 4]\n") ==
      "scene.toml:5: this [[particles.special_pair]] has neither epsilon and sigma nor a charge_product; give some of "
      "them, or list the pair in exclusions");
  CHECK(refusal(pair + "charge_product = '1 e^2'\n") ==
        "scene.toml:5: this [[particles.special_pair]] has no ids; give those of its two particles");
}

TEST_CASE("dihedrals without parameters never take those of special pairs", "[scene][special][messages]") {
  const test::ScratchFolder folder;
  test::write_text(folder / "chain.data",
                   "#\n4 atoms\n3 bonds\n1 dihedrals\n1 atom types\n1 bond types\n1 dihedral types\n0 9 xlo xhi\n0 9 "
                   "ylo yhi\n0 9 zlo zhi\n\nMasses\n\n1 1\n\nPair Coeffs # lj/cut\n\n1 1 1\n\nBond Coeffs # "
                   "harmonic\n\n1 1 1\n\nAtoms # full\n\n1 1 1 1 1 1 1\n2 1 1 0 2 1 1\n3 1 1 0 2 2 1\n4 1 1 -1 2 2 "
                   "2\n\nBonds\n\n1 1 1 2\n2 1 2 3\n3 1 3 4\n\nDihedrals\n\n1 1 1 2 3 4\n");
  const auto read = [&](const std::string& keys) {
    return test::refusal_of([&] {
      read_scene(
          "units = 'reduced'\n[particles]\nstructure = 'chain.data'\n" + keys +
              "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = 2\n"
              "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = "
              "1\n",
          folder / "scene.toml");
    });
  };
  CHECK(read("").empty());
  const std::string told = "give the parameters of each kind in section 'Dihedral Coeffs'";
  CHECK(read("[[particles.special_pair]]\nids = [1, 4]\ncharge_product = 1\n").find(told) != std::string::npos);
  CHECK(read("special = {lennard_jones = [0, 0, 0.5], charges = [0, 0, 0.8]}\n").find(told) != std::string::npos);
}

TEST_CASE("special pairs that nothing acts on are warned of, with constraints too", "[scene][special][warnings]") {
  const auto of = [](const std::string& force) {
    return warnings_of(
        read_scene("units = 'reduced'\n[particles]\n[[particles.body]]\nname = 'a'\nmass = 1\ncharge = 1\n"
                   "[[particles.body]]\nname = 'b'\nmass = 1\ncharge = 1\nx = [1, 0, 0]\nv = [0, 0, 0]\n"
                   "[[particles.special_pair]]\nids = [0, 1]\ncharge_product = 0.5\n[hamiltonian]\n"
                   "type = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'coulomb'\n" +
                       force +
                       "[[hamiltonian.constraint]]\ntype = 'fixed'\nbodies = ['b']\n"
                       "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1\n",
                   "scene.toml"));
  };
  CHECK(of("") ==
        std::vector<std::string>{"the structure has 1 bonded term that nothing acts on: there is no force 'bonded'"});
  CHECK(of("[[hamiltonian.force]]\ntype = 'bonded'\n").empty());
}

}  // namespace noether
