/// Liquids beside another program, against the order of the method, and against themselves on other threads.

#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/process.hpp"
#include "tests/support/recorded.hpp"
#include "tests/support/settings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace noether {
namespace {

const std::filesystem::path lammps_files = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "lammps";

LennardJonesForce argon(Cutoff style) { return {.cutoff = 2.5, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0}; }

/// Beads of LAMMPS's in.chain.
io::StructureOptions chain_options() {
  io::StructureOptions options;
  options.units = &unit_system("reduced");
  options.file_units = "lj";
  options.special = {0, 1, 1};
  return options;
}

const LennardJonesForce repulsion{.cutoff = 1.12, .cutoff_style = Cutoff::shifted};

ForceField<double> chain_forces() {
  ForceField<double> both;
  both.add(repulsion);
  both.add(Bonded{});
  return both;
}

/// Energy of what a force gives. [energy]
template <class Force> double energy_of(const Force& force, const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  REQUIRE_FALSE(sink.failure());
  return sink.potential();
}

/// The same particles with those bonded terms only whose potential has this name, of one sort.
template <auto terms, auto kinds> ParticleSystem<double> with_terms(ParticleSystem<double> s, const std::string& name) {
  Topology only = *s.topology();
  only.bonds.clear();
  only.angles.clear();
  only.dihedrals.clear();
  only.impropers.clear();
  for (const auto& term : (*s.topology()).*terms) {
    if ((only.*kinds).at(static_cast<std::size_t>(term.type)).potential == name) (only.*terms).push_back(term);
  }
  s.set_topology(std::make_shared<Topology>(only));
  return s;
}

/// Temperature, energies of a particle and pressure, as LAMMPS counts them.
struct Thermo {
  double temperature, potential, total, pressure;
};

template <class I> Thermo thermo_of(I& integrator, const ParticleSystem<double>& s) {
  const auto n = static_cast<double>(s.size());
  const EnergyTerms<double> energy = integrator.energy(s);
  const double temperature = 2 * energy.kinetic / (3 * n - 3), volume = s.box().volume();
  const double pressure = (n - 1) * temperature / volume + integrator.virial(s)->trace() / 3 / volume;
  return {temperature, energy.potential / n, energy.total() / n, pressure};
}

/// Bits after 300 steps of a melting crystal, and what its list did.
struct Melted {
  std::string digest;
  NeighborStatistics list;
};

Melted melted(int threads, const NeighborOptions& options) {
  const test::Threads now(threads);
  const auto liquid = test::kinetic_potential_over(test::field_of(argon(Cutoff::plain)), options);
  Simulation sim(test::liquid(5, 0.8442, 1.44), compose(liquid, schemes::verlet), 0.005);
  REQUIRE(sim.run(300).ok());
  return {io::digest(sim.particles()), sim.evaluations().neighbors.value()};
}

/// Rms of the relative energy error over a time of 2, after as much to begin with.
double energy_error(double step) {
  Simulation sim(test::liquid(4, 0.8442, 1.44),
                 compose(test::kinetic_potential(argon(Cutoff::switch_c4)), schemes::verlet), 0.004);
  REQUIRE(sim.run(500).ok());
  Simulation fine(sim.particles(), compose(test::kinetic_potential(argon(Cutoff::switch_c4)), schemes::verlet), step);
  auto& energy = fine.every(fine.steps_in(0.008), Energy{});
  REQUIRE(fine.run_until(2.0).ok());
  return energy.rms();
}

/// At the start and after 100 steps: LAMMPS prints eight digits; all are to agree, but the last.
template <class Force>
void check_against_lammps(const std::string& name, const ParticleSystem<double>& start, const Force& force) {
  Simulation sim(start, compose(test::kinetic_potential(force), schemes::verlet), 0.005);
  auto probe = compose(test::kinetic_potential(force), schemes::verlet);
  auto expected = test::lammps_energies(name);
  for (const std::string step : {"0.", "100."}) {
    const auto agree = [&](const char* key, double found) {
      const double of_lammps = expected.at(step + key);
      CAPTURE(step, key, of_lammps, found);
      CHECK(std::abs(found - of_lammps) < 1e-7);
    };
    ParticleSystem<double> s = sim.particles();
    probe.bind(s);
    const Thermo found = thermo_of(probe, s);
    agree("temp", found.temperature);
    agree("pe", found.potential);
    agree("etotal", found.total);
    agree("press", found.pressure);
    REQUIRE(sim.run(100).ok());
  }
}

}  // namespace

TEST_CASE("a melt has LAMMPS's temperature, energy and pressure at the start and after 100 steps", "[melts][oracle]") {
  io::StructureOptions options;
  options.units = &unit_system("reduced");
  options.file_units = "lj";
  check_against_lammps("melt", io::read_structure(lammps_files / "melt.data", options),
                       LennardJonesForce{.cutoff = 2.5, .cutoff_style = Cutoff::plain});
}

TEST_CASE("a melt of chains has LAMMPS's temperature, energy and pressure at the start and after 100 steps",
          "[melts][oracle]") {
  check_against_lammps("chain_melt", io::read_structure(lammps_files / "chain_melt.data", chain_options()),
                       chain_forces());
}

TEST_CASE("LAMMPS's whole in.lj, 32 000 atoms, is where LAMMPS has it after 100 steps", "[melts][oracle]") {
  ParticleSystem<double> s = test::liquid(20, 0.8442, 1.44);
  std::ifstream file(lammps_files / "in_lj.velocities", std::ios::binary);
  for (Index i = 0; i < s.size(); ++i) {
    double v[3];
    file.read(reinterpret_cast<char*>(v), sizeof v);  // NOLINT: as make.py has written them
    s.velocities().set(i, {v[0], v[1], v[2]});
  }
  REQUIRE(file.good());
  REQUIRE(file.peek() == std::ifstream::traits_type::eof());
  check_against_lammps("in_lj", s, argon(Cutoff::plain));
}

// The beads are those of bench/data.chain, 3 MB, which are not kept: Debian's package `lammps-examples` has them, and
// NOETHER_LAMMPS_CHAIN may name another copy. The figures are those printed beside bench/in.chain.
TEST_CASE("LAMMPS's in.chain, 32 000 beads of its own, has LAMMPS's printed figures", "[melts][oracle]") {
  const char* named = std::getenv("NOETHER_LAMMPS_CHAIN");
  const std::filesystem::path file = named != nullptr ? named : "/usr/share/lammps/examples/COUPLE/multiple/data.chain";
  if (!std::filesystem::exists(file)) {
    WARN("not compared: there is no " << file << "; install lammps-examples, or name data.chain in "
                                      << "NOETHER_LAMMPS_CHAIN");
    return;
  }
  const test::ScratchFolder folder;
  test::write_text(folder / "chain.data", test::read_text(file) + "\nBond Coeffs # fene\n\n1 30.0 1.5 1.0 1.0\n");
  io::StructureOptions options = chain_options();
  options.types = {{.type = "1", .epsilon = 1.0, .sigma = 1.0}};
  ParticleSystem<double> s = io::read_structure(folder / "chain.data", options);
  REQUIRE(s.size() == 32'000);
  auto pairs = compose(test::kinetic_potential(repulsion), schemes::verlet);
  auto all = compose(test::kinetic_potential(chain_forces()), schemes::verlet);
  ParticleSystem<double> copy = s;
  pairs.bind(copy);
  all.bind(s);
  const Thermo found = thermo_of(all, s);
  const double of_pairs = pairs.energy(copy).potential / 32'000;
  CHECK(fmt::format("{:.8g} {:.8g} {:.8g} {:.8g} {:.8g}", found.temperature, of_pairs, found.potential - of_pairs,
                    found.total, found.pressure) == "0.97029772 0.44484087 20.494523 22.394765 4.6721833");
}

TEST_CASE("a molecule with pairs of 1-4 at half their strength has LAMMPS's energies, style by style",
          "[melts][oracle]") {
  const auto read = [](double factor) {
    return io::read_structure(lammps_files / "molecule.data", {.file_units = "real", .special = {{0, 0, factor}}});
  };
  constexpr double kcal = 4.184;
  const LennardJonesForce pairs{.cutoff = 0.9, .cutoff_style = Cutoff::plain};
  const ParticleSystem<double> s = read(0.5);
  REQUIRE(s.topology()->scaled_pairs.size() == 5);
  auto expected = test::lammps_energies("molecule");
  const auto agree = [&](double found, std::initializer_list<const char*> styles) {
    double of_lammps = 0;
    for (const char* style : styles) of_lammps += kcal * expected.at(style);
    CAPTURE(*styles.begin(), of_lammps, found);
    CHECK(std::abs(found - of_lammps) < 1e-12 * std::abs(of_lammps));
  };
  agree(energy_of(pairs, s), {"evdwl"});
  // Whole pairs, and none, are far from it: the factor is seen.
  for (const double other : {0.0, 1.0})
    CHECK(std::abs(energy_of(pairs, read(other)) / kcal - expected["evdwl"]) > 0.01);
  constexpr auto bond = with_terms<&Topology::bonds, &Topology::bond_kinds>;
  constexpr auto angle = with_terms<&Topology::angles, &Topology::angle_kinds>;
  constexpr auto dihedral = with_terms<&Topology::dihedrals, &Topology::dihedral_kinds>;
  constexpr auto improper = with_terms<&Topology::impropers, &Topology::improper_kinds>;
  agree(energy_of(Bonded{}, bond(s, "harmonic")), {"bond.harmonic"});
  agree(energy_of(Bonded{}, bond(s, "morse")), {"bond.morse"});
  agree(energy_of(Bonded{}, angle(s, "harmonic")), {"angle.harmonic"});
  agree(energy_of(Bonded{}, angle(s, "cosine")), {"angle.cosine"});
  agree(energy_of(Bonded{}, dihedral(s, "periodic")), {"dihedral.charmm", "dihedral.harmonic"});
  agree(energy_of(Bonded{}, dihedral(s, "ryckaert_bellemans")), {"dihedral.multi/harmonic", "dihedral.opls"});
  agree(energy_of(Bonded{}, improper(s, "harmonic")), {"improper.harmonic"});
  agree(energy_of(Bonded{}, improper(s, "periodic")), {"improper.cvff"});
  agree(energy_of(Bonded{}, s), {"ebond", "eangle", "edihed", "eimp"});
}

TEST_CASE("liquid decane has the energy that LAMMPS gives it", "[melts][oracle]") {
  const Scene scene =
      load_scene(std::filesystem::path(NOETHER_SOURCE_DIR) / "examples/alkane_liquid/scene.toml", standard_parts());
  const double of_lammps = 4.184 * test::lammps_energies("decane").at("pe");
  CHECK(std::abs(evaluate(scene).potential - of_lammps) < 1e-9);
  CHECK(fmt::format("{:.10f}", of_lammps) == "30987.4993645753");  // as its README says
}

TEST_CASE("the energy of a liquid fluctuates with the square of the step", "[melts][order]") {
  const double coarse = energy_error(0.008), middle = energy_error(0.004), fine = energy_error(0.002);
  CAPTURE(coarse, middle, fine);
  CHECK(std::abs(std::log2(coarse / middle) - 2) < 0.25);
  CHECK(std::abs(std::log2(middle / fine) - 2) < 0.15);
}

TEST_CASE("threads and skins do not change a bit of a melt", "[melts][determinism]") {
  const std::string expected = melted(1, {}).digest;
  for (const int threads : {1, 2, 3, 8}) CHECK(melted(threads, {.skin = 0.3}).digest == expected);
  for (const double skin : {0.1, 0.2, 0.45, 0.6}) CHECK(melted(2, {.skin = skin}).digest == expected);
}

TEST_CASE("a fixed schedule of searches misses pairs, the same on any number of threads", "[melts][determinism]") {
  const NeighborOptions fixed{.skin = 0.3, .renewal = 20};
  const Melted expected = melted(1, fixed);
  for (const int threads : {2, 3}) CHECK(melted(threads, fixed).digest == expected.digest);
  CHECK(expected.list.searches == 1 + (expected.list.updates - 1) / 20);
  CHECK(expected.digest != melted(1, {.skin = 0.3}).digest);
  CHECK(melted(1, {.skin = 0.3, .renewal = 1}).digest == melted(1, {}).digest);  // too often to miss anybody
}

TEST_CASE("list and columns of state of LAMMPS's melt take at most 700 bytes for each atom, 760 with all of its own",
          "[melts][memory]") {
  const ParticleSystem<double> start = test::liquid(20, 0.8442, 1.44);
  Simulation sim(start, compose(test::kinetic_potential(argon(Cutoff::plain)), schemes::verlet), 0.005);
  REQUIRE(sim.run(200).ok());  // molten, and the skin is the one that costs least
  const double list = static_cast<double>(sim.evaluations().neighbors.value().bytes) / 32'000;
  const double state = static_cast<double>(sim.particles().bytes_per_particle());
  const double accelerations = sizeof(Vec3<double>), name = sizeof(std::string);  // short ones are kept within
  CAPTURE(list, state, accelerations, name);
  CHECK(list > 100);
  CHECK(state == 8 + 7 * 8 + 3 * 4);  // id, place, velocity, mass, images
  CHECK(list + state <= 700);
  CHECK(list + state + accelerations + name <= 760);
}

TEST_CASE("the shadow of a liquid's energy is flat across the faces of its box", "[melts][shadow]") {
  Simulation sim(test::liquid(3, 0.8442, 1.44),
                 compose(test::kinetic_potential(argon(Cutoff::switch_c4)), schemes::verlet), 0.004);
  auto& energy = sim.every(1, Energy{});
  auto& shadow = sim.every(1, ShadowHamiltonian<double>{});
  REQUIRE(sim.run(300).ok());
  std::int64_t crossed = 0;
  for (const std::int32_t image : sim.particles().images().all().reshaped()) crossed += image != 0 ? 1 : 0;
  CHECK(crossed > 10);
  CHECK(shadow.fluctuation(1) < 1e-2 * energy.rms());
}

TEST_CASE("a melt that was saved goes on with the same bits", "[melts][restart]") {
  const auto make = [] {
    return Simulation(test::liquid(4, 0.8442, 1.44),
                      compose(test::kinetic_potential(argon(Cutoff::shifted_force)), schemes::verlet), 0.005);
  };
  auto whole = make(), first = make(), second = make();
  REQUIRE(whole.run(120).ok());
  REQUIRE(first.run(47).ok());
  second.restore(first.save());
  REQUIRE(second.run(73).ok());
  CHECK(io::digest(second.particles()) == io::digest(whole.particles()));
}

TEST_CASE("a run in which two atoms collide head on ends as overlap, and names them", "[melts][extremes]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({20, 20, 20}));
  s.add("left", 1, {5, 5, 5}, {5000, 0, 0});
  s.add("right", 1, {8, 5, 5}, {-5000, 0, 0});
  Simulation sim(std::move(s), compose(test::kinetic_potential(argon(Cutoff::shifted_force)), schemes::verlet), 1e-5);
  const Outcome outcome = sim.run(1000);
  CHECK(outcome.kind == Outcome::Kind::overlap);
  CHECK(exit_code(outcome) == 1);
  CHECK(outcome.message ==
        "particles 'left' and 'right' are 0.4 apart, too close for their Lennard-Jones force; start with [minimize], "
        "or take a smaller step");
}

TEST_CASE("no atoms, one atom and extreme densities run or stop with a name", "[melts][extremes]") {
  for (const double density : {1e-3, 0.5, 1e3}) {
    const double edge = std::cbrt(4 / density);
    CAPTURE(density);
    Simulation sim(test::liquid(edge < 1 ? 2 : 1, density, 1.0),
                   compose(test::kinetic_potential(argon(Cutoff::shifted_force)), schemes::verlet), 1e-4);
    const Outcome outcome = sim.run(20);
    CHECK(outcome.kind == (density > 100 ? Outcome::Kind::overlap : Outcome::Kind::completed));
  }
  ParticleSystem<double> s;
  s.set_box(Box::periodic({3, 3, 3}));
  const auto liquid = compose(test::kinetic_potential(argon(Cutoff::shifted_force)), schemes::verlet);
  CHECK_THROWS_WITH(Simulation(s, liquid, 0.01), Catch::Contains("there are no particles"));
  s.add("alone", 1, {1, 1, 1}, {0.1, 0.2, 0.3});
  CHECK(Simulation(s, liquid, 0.01).run(100).ok());
}

}  // namespace noether
