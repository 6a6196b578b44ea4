/// Pair potentials against LAMMPS: tests/data/lammps/README.md.

#include "forces/pair_potentials.hpp"
#include "io/structure.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/recorded.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace noether {
namespace {

const std::filesystem::path folder = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "lammps";

/// Energy, pressures of atoms at rest, and the force on atom 100.
template <class F> void check_against_lammps(const std::string& name, const F& force) {
  io::StructureOptions options;
  options.units = &unit_system("reduced");
  options.file_units = "lj";
  const ParticleSystem<double> s = io::read_structure(folder / "pairs.data", options);
  auto expected = test::lammps_energies("pairs");
  REQUIRE(expected.size() == 30);
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
    const std::string axis(1, "xyz"[r]);
    const double component = expected[name + ".f100." + axis];
    const Index atom = std::find(s.ids().begin(), s.ids().end(), 100) - s.ids().begin();
    REQUIRE(atom < s.size());
    CHECK(std::abs(all.a.component(r)[atom] - component) < 1e-10);
  }
}

}  // namespace

TEST_CASE("pairs of Morse, Buckingham and WCA are those of LAMMPS", "[pair_force]") {
  check_against_lammps("morse", MorseForce{{1.7, 4.5, 1.15}, 2.3, Cutoff::plain});
  check_against_lammps("buckingham", BuckinghamForce{{2500, 0.18, 3.1}, 2.4, Cutoff::plain});
  check_against_lammps("wca", WcaForce{{1.3, 1.0}});
}

}  // namespace noether
