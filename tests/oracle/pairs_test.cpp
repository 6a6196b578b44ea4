/// Pair potentials against LAMMPS (tests/data/lammps/README.md) and NIST (tests/data/nist/README.md).

#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "io/structure.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace noether {
namespace {

const std::filesystem::path data = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data";

/// The forces of one potential in tests/data/lammps/pairs.forces.txt, by the atoms' ids, which count from 1.
std::vector<Vec3<double>> lammps_forces(const std::string& name) {
  std::vector<Vec3<double>> forces;
  std::ifstream file(data / "lammps" / "pairs.forces.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string of;
    double x = 0, y = 0, z = 0;
    if (words >> of >> x >> y >> z && of == name) forces.emplace_back(x, y, z);
  }
  return forces;
}

/// Energy, pressures of atoms at rest, and the force on each of them.
template <class F> void check_against_lammps(const std::string& name, const F& force) {
  io::StructureOptions options;
  options.units = &unit_system("reduced");
  options.file_units = "lj";
  const ParticleSystem<double> s = io::read_structure(data / "lammps" / "pairs.data", options);
  auto expected = test::lammps_energies("pairs");
  REQUIRE(expected.size() == 42);
  const test::Evaluated all = test::evaluated<double>(force, s);
  REQUIRE_FALSE(all.failure);
  const double energy = expected[name + ".evdwl"];
  CHECK(std::abs(all.energy - energy) < 1e-12 * std::abs(energy));
  const char* pressures[3][3] = {{"pxx", "pxy", "pxz"}, {"pxy", "pyy", "pyz"}, {"pxz", "pyz", "pzz"}};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const double pressure = expected[name + "." + pressures[r][c]];
      CAPTURE(name, pressures[r][c], pressure);
      CHECK(std::abs(all.virial(r, c) / s.box().volume() - pressure) < 1e-11);
    }
  }
  const std::vector<Vec3<double>> forces = lammps_forces(name);
  REQUIRE(static_cast<Index>(forces.size()) == s.size());
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double>& of_lammps = forces[static_cast<std::size_t>(s.ids()[static_cast<std::size_t>(i)] - 1)];
    CAPTURE(name, i);
    CHECK((all.a[i] - of_lammps).cwiseAbs().maxCoeff() < 1e-12 * std::max(100.0, of_lammps.cwiseAbs().maxCoeff()));
  }
}

/// One of the configurations of NIST's Lennard-Jones calculations.
ParticleSystem<double> nist_configuration(const std::string& name) {
  std::ifstream file(data / "nist" / (name + ".xyz"));
  Index atoms = 0, types = 0;
  Vec3<double> edges, x;
  file >> atoms >> types >> edges[0] >> edges[1] >> edges[2];
  ParticleSystem<double> s;
  s.set_box(Box::periodic(edges));
  for (std::string id; file >> id >> x[0] >> x[1] >> x[2];) s.add("", 1, x, {0, 0, 0});
  REQUIRE(s.size() == atoms);
  return s;
}

/// A line of NIST's table, as it is printed there.
struct Published {
  double cutoff;
  Cutoff style;
  const char *name, *energy, *virial, *tail;
};

/// Against what is printed, and against 40 digits. @param rounding  of energies; tails have a thousandth of it
void check_against_nist(const std::string& file, const std::vector<Published>& lines, double rounding) {
  const ParticleSystem<double> s = nist_configuration(file);
  auto exact = test::recorded("nist/" + file + ".energies.txt");
  const auto printed = [](double value) { return fmt::format("{:.4e}", value); };
  for (const Published& one : lines) {
    const std::string name = one.name;
    CAPTURE(file, name);
    LennardJonesForce force{.cutoff = one.cutoff, .cutoff_style = one.style, .epsilon = 1.0, .sigma = 1.0};
    const test::Evaluated all = test::evaluated<double>(force, s);
    CHECK(printed(all.energy) == one.energy);
    CHECK(printed(all.virial.trace()) == one.virial);
    CHECK(std::abs(all.energy - exact.at(name + ".U")) < rounding);
    CHECK(std::abs(all.virial.trace() - exact.at(name + ".W")) < 4 * rounding);
    if (one.tail == nullptr) continue;
    force.tail = true;
    const double tail = test::evaluated<double>(force, s).energy - all.energy;
    CHECK(printed(tail) == one.tail);
    CHECK(std::abs(tail - exact.at(name + ".LRC")) < rounding / 100);
  }
}

}  // namespace

TEST_CASE("pairs of Morse, Buckingham and WCA are those of LAMMPS", "[pair_force]") {
  check_against_lammps("morse", MorseForce{{1.7, 4.5, 1.15}, 2.3, Cutoff::plain});
  check_against_lammps("buckingham", BuckinghamForce{{2500, 0.18, 3.1}, 2.4, Cutoff::plain});
  check_against_lammps("wca", WcaForce{{1.3, 1.0}});
}

TEST_CASE("Lennard-Jones pairs, cut, lifted and with a shifted force, are those of LAMMPS", "[lennard_jones]") {
  for (const auto& [name, style] : {std::pair("plain", Cutoff::plain), std::pair("shifted", Cutoff::shifted),
                                    std::pair("shifted_force", Cutoff::shifted_force)}) {
    check_against_lammps(name, LennardJonesForce{.cutoff = 2.5, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0});
  }
}

TEST_CASE("configurations have the energies, virials and tails that NIST has published", "[lennard_jones]") {
  check_against_nist("lj_sample_config_periodic1",
                     {{3, Cutoff::plain, "plain3", "-4.3515e+03", "-5.6867e+02", "-1.9849e+02"},
                      {4, Cutoff::plain, "plain4", "-4.4675e+03", "-1.2639e+03", "-8.3769e+01"},
                      {3, Cutoff::shifted_force, "shifted_force3", "-3.8709e+03", "3.1754e+02", nullptr}},
                     1e-9);  // 86 000 pairs, each to half a unit of 2e-12
  check_against_nist("lj_sample_config_periodic4",
                     {{3, Cutoff::plain, "plain3", "-1.6790e+01", "-4.6249e+01", "-5.4517e-01"},
                      {4, Cutoff::plain, "plain4", "-1.7060e+01", "-4.7869e+01", "-2.3008e-01"},
                      {3, Cutoff::shifted_force, "shifted_force3", "-1.5001e+01", "-4.3096e+01", nullptr}},
                     3e-11);
  auto exact = test::recorded("nist/lj_sample_config_periodic4.energies.txt");
  // The tests of NIST's FEASST have more digits.
  CHECK(std::abs(exact.at("plain3.U") - -16.790321304625856) < 1e-14);
  CHECK(std::abs(exact.at("plain3.LRC") - -0.5451660014945704) < 1e-15);
}

}  // namespace noether
