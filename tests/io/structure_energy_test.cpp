// Structures against the energies that LAMMPS computed of the same files: tests/data/lammps/README.md.

#include "engine/charge.hpp"
#include "forces/bonded.hpp"
#include "forces/check_gradient.hpp"
#include "io/structure.hpp"
#include "tests/io/support.hpp"
#include "tests/support/recorded.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>

using namespace noether;

namespace {

const std::filesystem::path lammps_files = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "lammps";
constexpr double kcal = 4.184;

bool agree(double value, double expected, double tolerance) {
  INFO(value << " against " << expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

/// Formulas of noether's kinds, written for this test: energies by the potentials' names.
class Terms {
 public:
  explicit Terms(const ParticleSystem<double>& s) : s_(s), topology_(*s.topology()) {
    for (const auto& one : topology_.bonds) bond(one);
    for (const auto& one : topology_.angles) angle(one);
    for (const auto& one : topology_.dihedrals) dihedral(one);
    for (const auto& one : topology_.impropers) improper(one);
  }

  std::map<std::string, double> energy;

 private:
  using Vec = Vec3<double>;

  Vec between(Index i, Index j) const { return s_.box().minimum_image(Vec(s_.positions()[j] - s_.positions()[i])); }

  void bond(const BondedTerm<2>& one) {
    const double r = between(one.particles[0], one.particles[1]).norm();
    const auto& [potential, p] = topology_.bond_kinds[static_cast<std::size_t>(one.type)];
    double u = 0;
    if (potential == "harmonic") u = p[0] * (r - p[1]) * (r - p[1]) / 2;
    if (potential == "morse") u = p[0] * std::pow(1 - std::exp(-p[1] * (r - p[2])), 2);
    if (potential == "fene") {
      u = -p[0] * p[1] * p[1] / 2 * std::log(1 - r * r / (p[1] * p[1]));
      const double six = std::pow(p[3] / r, 6);
      if (r < std::pow(2.0, 1.0 / 6) * p[3]) u += 4 * p[2] * (six * six - six) + p[2];
    }
    energy["bond." + potential] += u;
  }

  void angle(const BondedTerm<3>& one) {
    const Vec a = between(one.particles[1], one.particles[0]), b = between(one.particles[1], one.particles[2]);
    const double theta = std::atan2(a.cross(b).norm(), a.dot(b));
    const auto& [potential, p] = topology_.angle_kinds[static_cast<std::size_t>(one.type)];
    double u = 0;
    if (potential == "harmonic") u = p[0] * (theta - p[1]) * (theta - p[1]) / 2;
    if (potential == "cosine") u = p[0] * (1 + std::cos(theta));
    if (potential == "cosine_squared") u = p[0] * std::pow(std::cos(theta) - std::cos(p[1]), 2) / 2;
    if (potential == "urey_bradley") {
      u = p[0] * (theta - p[1]) * (theta - p[1]) / 2 + p[2] * std::pow((a - b).norm() - p[3], 2) / 2;
    }
    energy["angle." + potential] += u;
  }

  /// IUPAC: 0 is cis, pi is trans; positive is clockwise, seen along the middle bond.
  double torsion(const std::array<Index, 4>& i) const {
    const Vec b1 = between(i[0], i[1]), b2 = between(i[1], i[2]), b3 = between(i[2], i[3]);
    const Vec m = b1.cross(b2), n = b2.cross(b3);
    return std::atan2(b2.norm() * b1.dot(n), m.dot(n));
  }

  void dihedral(const BondedTerm<4>& one) {
    const double phi = torsion(one.particles);
    const auto& [potential, p] = topology_.dihedral_kinds[static_cast<std::size_t>(one.type)];
    double u = 0;
    if (potential == "periodic") u = p[0] * (1 + std::cos(p[1] * phi - p[2]));
    if (potential == "ryckaert_bellemans") {
      for (std::size_t n = 0; n < 6; ++n) u += p[n] * std::pow(std::cos(phi - std::numbers::pi), n);
    }
    if (potential == "one_four") {
      const double r = between(one.particles[0], one.particles[3]).norm(), six = std::pow(p[1] / r, 6);
      energy["ends.lennard_jones"] += 4 * p[0] * (six * six - six);
      energy["ends.charges"] += p[2] / r;
    }
    energy["dihedral." + potential] += u;
  }

  /// chi is the angle between the planes of 1, 2, 3 and of 2, 3, 4, without sign.
  void improper(const BondedTerm<4>& one) {
    const double phi = torsion(one.particles);
    const auto& [potential, p] = topology_.improper_kinds[static_cast<std::size_t>(one.type)];
    double u = 0;
    if (potential == "harmonic") u = p[0] * std::pow(std::abs(phi) - p[1], 2) / 2;
    if (potential == "periodic") u = p[0] * (1 + std::cos(p[1] * phi - p[2]));
    energy["improper." + potential] += u;
  }

  const ParticleSystem<double>& s_;
  const Topology& topology_;
};

/// Energies of pairs within a cutoff, Lennard-Jones and Coulomb's law, with exclusions and factors.
std::pair<double, double> pair_energies(const ParticleSystem<double>& s, double cutoff, bool shifted) {
  const Topology& topology = *s.topology();
  double lennard_jones = 0, coulomb = 0;
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = i + 1; j < s.size(); ++j) {
      const double r = s.box().minimum_image(Vec3<double>(s.positions()[j] - s.positions()[i])).norm();
      double factor = r < cutoff ? 1 : 0;
      const Topology::Pair pair(i, j);
      if (std::find(topology.exclusions.begin(), topology.exclusions.end(), pair) != topology.exclusions.end())
        continue;
      for (const auto& one : topology.scaled_pairs) factor *= one.pair == pair ? one.factor : 1;
      const PairKind kind = topology.pair_kind(topology.type(i), topology.type(j));
      const auto u = [&](double distance) {
        const double six = std::pow(kind.sigma / distance, 6);
        return 4 * kind.epsilon * (six * six - six);
      };
      lennard_jones += factor * (u(r) - (shifted ? u(cutoff) : 0));
      if (!s.has<Charge>()) continue;
      const auto& q = s.column<Charge>();
      coulomb += factor * s.units().coulomb_constant * q[i] * q[j] / r;
    }
  }
  return {lennard_jones, coulomb};
}

double kinetic_energy(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * Vec3<double>(s.velocities()[i]).squaredNorm() / 2;
  return sum;
}

}  // namespace

TEST_CASE("every style of terms has the energy that LAMMPS computes", "[structure]") {
  const auto s = io::read_structure(lammps_files / "molecule.data", {.file_units = "real", .special = {{0, 0, 0.5}}});
  auto expected = test::lammps_energies("molecule");
  auto energy = Terms(s).energy;
  const double rounding = 1e-13;
  CHECK(agree(energy["bond.harmonic"], kcal * expected["bond.harmonic"], rounding));
  CHECK(agree(energy["bond.morse"], kcal * expected["bond.morse"], rounding));
  CHECK(agree(energy["angle.harmonic"], kcal * expected["angle.harmonic"], rounding));
  CHECK(agree(energy["angle.cosine"], kcal * expected["angle.cosine"], rounding));
  CHECK(
      agree(energy["dihedral.periodic"], kcal * (expected["dihedral.charmm"] + expected["dihedral.harmonic"]), 1e-12));
  CHECK(agree(energy["dihedral.ryckaert_bellemans"],
              kcal * (expected["dihedral.multi/harmonic"] + expected["dihedral.opls"]), 1e-12));
  CHECK(agree(energy["improper.harmonic"], kcal * expected["improper.harmonic"], 1e-12));
  CHECK(agree(energy["improper.periodic"], kcal * expected["improper.cvff"], 1e-12));
  const auto [lennard_jones, coulomb] = pair_energies(s, 0.9, false);
  CHECK(agree(lennard_jones, kcal * expected["evdwl"], 1e-12));
  CHECK(agree(coulomb, kcal * expected["ecoul"], 2e-8));  // LAMMPS rounds Coulomb's constant to 332.06371
}

TEST_CASE("coefficients of an input script have the energies that LAMMPS computes with it", "[structure]") {
  // Sums of cosines, springs between the ends of angles, weights and four numbers of a pair; labels, "*", "&"; and
  // special_bonds amber.
  for (const std::string name : {"charmm", "amber"}) {
    INFO(name);
    const auto s = io::read_structure(lammps_files / "charmm.data", {.coefficients = {lammps_files / (name + ".in")}});
    auto expected = test::lammps_energies(name);
    auto energy = Terms(s).energy;
    CHECK(s.topology()->type_names == std::vector<std::string>{"CT", "OH", "C*"});
    CHECK(s.topology()->mixing == Mixing::lorentz_berthelot);
    CHECK(std::abs(s.topology()->stated_cutoff - (name == "charmm" ? 1.1 : 0.9)) < 1e-15);
    CHECK(agree(energy["bond.harmonic"], kcal * expected["ebond"], 1e-13));
    CHECK(agree(energy["angle.harmonic"] + energy["angle.urey_bradley"] + energy["angle.cosine_squared"],
                kcal * expected["eangle"], 1e-13));
    CHECK(agree(energy["dihedral.periodic"], kcal * expected["edihed"], 1e-12));
    CHECK(agree(energy["improper.harmonic"] + energy["improper.periodic"], kcal * expected["eimp"], 1e-12));
    const auto [lennard_jones, charges] = pair_energies(s, 0.9, false);
    CHECK(agree(lennard_jones + energy["ends.lennard_jones"], kcal * expected["evdwl"], 1e-12));
    CHECK(agree(charges + energy["ends.charges"], kcal * expected["ecoul"], 2e-8));  // LAMMPS rounds Coulomb's constant
    // And so has the force of a run.
    double sum = 0;
    for (const auto& [part, of_part] : energy) sum += of_part;
    VectorColumn<double> accelerations(s.size());
    ForceSink<double> sink(accelerations, s, {true, true, false});
    Bonded{}.add_to(sink, s);
    CHECK(agree(sink.potential(), sum, 1e-12));
    check_gradient(Bonded{}, s);
  }
}

TEST_CASE("chains of beads have the energies that LAMMPS computes", "[structure]") {
  const auto s =
      io::read_structure(lammps_files / "chains.data", {.units = &unit_system("reduced"), .special = {{0, 1, 1}}});
  auto expected = test::lammps_energies("chains");
  auto energy = Terms(s).energy;
  CHECK(agree(energy["bond.fene"], expected["ebond"], 1e-13));
  CHECK(agree(energy["angle.cosine"], expected["eangle"], 1e-12));
  CHECK(agree(pair_energies(s, std::pow(2.0, 1.0 / 6), true).first, expected["evdwl"], 1e-12));
}

TEST_CASE("a crystal has the energies that LAMMPS computes", "[structure]") {
  const auto s = io::read_structure(lammps_files / "argon.data", {.file_units = "metal"});
  auto expected = test::lammps_energies("argon");
  const double electronvolt = 96.48533212331002;
  CHECK(agree(pair_energies(s, 0.5, false).first, electronvolt * expected["evdwl"], 1e-13));
  CHECK(agree(kinetic_energy(s), electronvolt * expected["ke"], 1e-7));  // LAMMPS rounds 1 u A^2/ps^2 in eV
}

TEST_CASE("a LAMMPS data file that is cut is refused, wherever it is cut", "[structure]") {
  const test::ScratchFolder folder;
  std::ifstream file(lammps_files / "chains.data");
  std::string content((std::istreambuf_iterator<char>(file)), {});
  while (content.ends_with('\n')) content.pop_back();
  const std::size_t last_row = content.rfind('\n');
  for (std::size_t size = 0; size < content.size(); size += 3) {
    test::write_text(folder / "cut.data", content.substr(0, size));
    std::string message;
    try {
      io::read_structure(folder / "cut.data", {.units = &unit_system("reduced")});
    } catch (const SceneError& error) {
      message = error.message();
    }
    INFO(size);
    // Of the last row a part may stand that is whole by itself.
    CHECK((!message.empty() || size > last_row));
  }
}
