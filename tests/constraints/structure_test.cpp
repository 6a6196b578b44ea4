/// Constraints of a structure: which distances are held, how long they are, and which bonded terms go.

#include "constraints/structure_constraints.hpp"

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/hydrogens.hpp"
#include "engine/topology.hpp"
#include "io/structure.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>

namespace noether::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

ParticleSystem<double> alkanes(const std::string& name) {
  io::StructureOptions options;
  options.file_units = "real";
  options.units = &unit_system("molecular");
  return io::read_structure(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / "molecules" / name, options);
}

/// Particles of some masses and places, in molecular units.
ParticleSystem<double> atoms(const std::vector<double>& masses, const std::vector<Vec3<double>>& places) {
  ParticleSystem<double> s(unit_system("molecular"));
  for (std::size_t k = 0; k < masses.size(); ++k) {
    s.add("X" + std::to_string(k), masses[k], places[k], Vec3<double>::Zero());
  }
  return s;
}

void give(ParticleSystem<double>& s, Topology topology) {
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
}

/// How many distances of each length are held, to nine digits.
std::map<long, int> lengths_of(const std::vector<HeldDistance>& held) {
  std::map<long, int> count;
  for (const HeldDistance& one : held) ++count[std::lround(one.length.value() * 1e9)];
  return count;
}

/// What the solver says of a set at its start; empty if it is content.
std::string refusal_to_start(const ParticleSystem<double>& s, const ConstraintSet& set) {
  return refusal_of([&] {
    ParticleSystem<double> copy = s;
    ConstraintSolver<double>(set).bind(copy);
  });
}

/// Carbon and four hydrogens about it, in the corners of a cube.
ParticleSystem<double> methane() {
  const double d = 0.109 / std::sqrt(3.0);
  auto s = atoms({12, 1, 1, 1, 1}, {{0, 0, 0}, {d, d, d}, {d, -d, -d}, {-d, d, -d}, {-d, -d, d}});
  Topology topology;
  for (Index k = 1; k < 5; ++k) topology.bonds.push_back({{0, k}, 0});
  give(s, std::move(topology));
  return s;
}

TEST_CASE("bonds, bonds of hydrogens, and angles of alkanes are held at their equilibrium",
          "[constraints][structure]") {
  const auto butane = alkanes("butane.data"), hexane = alkanes("hexane.data");
  CHECK(lengths_of(held_distances(butane, RigidTerms::bonds)) ==
        std::map<long, int>{{152900000, 8 * 3}, {109000000, 8 * 10}});
  CHECK(lengths_of(held_distances(butane, RigidTerms::hydrogen_bonds)) == std::map<long, int>{{109000000, 8 * 10}});
  const double ends = 2 * 0.154 * std::sin(57 * degree);
  CHECK(lengths_of(held_distances(hexane, RigidTerms::bonds_and_angles)) ==
        std::map<long, int>{{154000000, 8 * 5}, {std::lround(ends * 1e9), 8 * 4}});
  CHECK(refusal_to_start(butane, bonds(butane)).empty());
  CHECK(refusal_to_start(butane, hydrogen_bonds(butane)).empty());
  CHECK(refusal_to_start(hexane, bonds_and_angles(hexane)).empty());
}

TEST_CASE("carbons with four neighbors have one angle too many for distances, and the solver says so",
          "[constraints][structure][refusal]") {
  const auto butane = alkanes("butane.data");
  ConstraintSet all;
  add_held(all, butane, held_distances(butane, RigidTerms::bonds_and_angles, HeldLengths::start));
  CHECK(refusal_to_start(butane, all).starts_with("constraints depend on each other: distance of "));
}

TEST_CASE("a start that is off is refused by name; lengths as at the start are taken as they are",
          "[constraints][structure][refusal]") {
  auto s = alkanes("hexane.data");
  s.positions().set(1, Vec3<double>(s.positions()[1] + Vec3<double>(0.001, 0, 0)));
  CHECK(refusal_to_start(s, bonds(s)).find("is violated at the start") != std::string::npos);
  ConstraintSet as_it_is;
  const auto held = held_distances(s, RigidTerms::bonds, HeldLengths::start);
  CHECK(held.size() == 40);
  CHECK(!held.front().length);
  CHECK(refusal_to_start(s, add_held(as_it_is, s, held)).empty());
}

TEST_CASE("kinds without an equilibrium are held as they start", "[constraints][structure]") {
  auto s = atoms({12, 12, 12}, {{0, 0, 0}, {0.15, 0, 0}, {0.15, 0.14, 0}});
  Topology topology;
  topology.bonds = {{{0, 1}, 0}, {{2, 1}, 1}};
  topology.angles = {{{0, 1, 2}, 0}};
  topology.bond_kinds = {{"fene", {30, 1.5, 1, 1}}, {"morse", {10, 2, 0.14}}};
  topology.angle_kinds = {{"cosine", {1}}};
  give(s, std::move(topology));
  CHECK(held_distances(s, RigidTerms::bonds_and_angles) ==
        std::vector<HeldDistance>{{{0, 1}, {}}, {{0, 2}, {}}, {{1, 2}, 0.14}});
}

TEST_CASE("rings of three, and angles that share their ends, are held once", "[constraints][structure]") {
  auto s = atoms({12, 12, 12, 12}, {{0, 0, 0}, {0.15, 0, 0}, {0.15, 0.15, 0.02}, {0, 0.15, 0}});
  Topology ring;
  ring.bonds = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 3}, 0}, {{3, 0}, 0}};
  ring.angles = {{{0, 1, 2}, 0}, {{1, 2, 3}, 0}, {{2, 3, 0}, 0}, {{3, 0, 1}, 0}};
  give(s, ring);
  CHECK(held_distances(s, RigidTerms::bonds_and_angles).size() == 6);
  ring.bonds = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 0}, 0}};
  ring.angles = {{{0, 1, 2}, 0}, {{1, 2, 0}, 0}, {{2, 0, 1}, 0}};
  give(s, ring);
  CHECK(held_distances(s, RigidTerms::bonds_and_angles).size() == 3);
}

TEST_CASE("hydrogens are known by mass, and by name where masses do not tell", "[constraints][structure]") {
  for (const char* name : {"H", "HW", "HW1", "1HB", "hc", "ho", "H_2"}) CHECK(is_hydrogen_name(name));
  for (const char* name : {"He", "Hg", "Hf", "Ho", "Hs", "C", "OH", "1", "", "D"}) CHECK(!is_hydrogen_name(name));
  auto s = atoms({1.008, 1.59, 2.1, 3.9, 4.2, 15.0}, std::vector<Vec3<double>>(6, Vec3<double>::Zero()));
  CHECK(is_hydrogen(s, 0));
  CHECK(is_hydrogen(s, 1));
  CHECK(refusal_of([&] { is_hydrogen(s, 2); }) ==
        "whether 'X2' of 2.1 u is a hydrogen of repartitioned mass cannot be told by its name; give its type a name "
        "that begins with H, or another mass, or use bonds");
  CHECK(!is_hydrogen(s, 4));
  CHECK(!is_hydrogen(s, 5));
  Topology topology;
  topology.type_names = {"HC", "1", "HEAD"};
  topology.types = {0, 0, 0, 0, 2, 2};
  give(s, topology);
  CHECK(is_hydrogen(s, 2));
  CHECK(is_hydrogen(s, 3));
  CHECK(!is_hydrogen(s, 4));
  topology.types = {1, 1, 1, 1, 1, 1};
  give(s, topology);
  CHECK(refusal_of([&] { is_hydrogen(s, 3); }) != "");
}

TEST_CASE("reduced units have hydrogens by the names of types alone", "[constraints][structure][refusal]") {
  ParticleSystem<double> s;
  s.add("a", 1, {0, 0, 0}, {0, 0, 0});
  s.add("b", 1, {1, 0, 0}, {0, 0, 0});
  Topology topology;
  topology.types = {0, 1};
  topology.type_names = {"1", "2"};
  topology.bonds = {{{0, 1}, 0}};
  give(s, topology);
  CHECK(refusal_of([&] { hydrogen_bonds(s); }) ==
        "whether 'a' is a hydrogen cannot be told in reduced units, whose masses are in no known unit; give its type a "
        "name, such as H or C, or use bonds");
  topology.type_names = {"C", "H"};
  give(s, topology);
  CHECK(hydrogen_bonds(s).equations() == 1);
  topology.type_names = {"C", "O"};
  give(s, topology);
  CHECK(refusal_of([&] { hydrogen_bonds(s); }) ==
        "no bond of the structure ends in a hydrogen, so there is nothing to be held; use bonds");
}

TEST_CASE("rigid molecules of two, three and more sites have no distance that follows from others",
          "[constraints][structure]") {
  auto two = atoms({14, 14, 40}, {{0, 0, 0}, {0.11, 0, 0}, {1, 0, 0}});
  Topology nitrogen;
  nitrogen.molecules = {1, 1, 2};
  give(two, nitrogen);
  CHECK(held_distances(two, RigidTerms::molecules) == std::vector<HeldDistance>{{{0, 1}, {}}});
  const auto five = methane();
  CHECK(rigid_molecules(five).equations() == 9);
  CHECK(refusal_to_start(five, rigid_molecules(five)).empty());
  const auto many = alkanes("butane.data");
  CHECK(rigid_molecules(many).equations() == 8 * (3 * 14 - 6));
  ConstraintSet as_it_is;
  add_held(as_it_is, many, held_distances(many, RigidTerms::molecules, HeldLengths::start));
  CHECK(refusal_to_start(many, as_it_is).empty());
}

TEST_CASE("molecules in line or in a plane, and what has no molecules, are refused with a proposal",
          "[constraints][structure][refusal]") {
  auto line = atoms({12, 16, 16}, {{0, 0, 0}, {0.12, 0, 0}, {-0.12, 0, 0}});
  Topology topology;
  topology.molecules = {3, 3, 3};
  give(line, topology);
  CHECK(refusal_of([&] { rigid_molecules(line); }) ==
        "the molecule of 'X0', 'X1', 'X2' is on a line, which distances do not hold; use rigid_bar with the names of "
        "its particles");
  auto plane = atoms({12, 12, 12, 12, 12}, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}});
  topology.molecules = {3, 3, 3, 3, 3};
  give(plane, topology);
  CHECK(refusal_of([&] { rigid_molecules(plane); }) ==
        "the molecule of 'X0', 'X1', 'X2', 'X3' and 1 more lies in a plane, which distances do not hold; use bonds or "
        "bonds_and_angles");
  topology.molecules = {1, 2, 3, 0, 0};
  give(plane, topology);
  CHECK(refusal_of([&] { rigid_molecules(plane); }) ==
        "there is no molecule of two or more particles, so there is nothing to be held; give a structure with "
        "molecules or bonds");
  CHECK(refusal_of([&] { bonds(plane); }) ==
        "the particles have no bonds, so there is nothing to be held; give a structure or a builder with bonds, or "
        "name the particles of a constraint 'distance'");
}

TEST_CASE("what a set holds rigid is found: pairs, angles, whole molecules", "[constraints][structure]") {
  const auto hexane = alkanes("hexane.data");
  const auto groups = rigid_groups(bonds_and_angles(hexane));
  std::map<std::size_t, int> sizes;
  for (const auto& group : groups) ++sizes[group.size()];
  CHECK(sizes == std::map<std::size_t, int>{{2, 8 * 9}, {3, 8 * 4}});
  CHECK(rigid_groups(rigid_molecules(methane())) == std::vector<std::vector<Index>>{{0, 1, 2, 3, 4}});
  const auto butane = alkanes("butane.data");
  CHECK(rigid_groups(rigid_molecules(butane)).size() == 8);
  CHECK(rigid_groups(hydrogen_bonds(butane)).size() == 80);
}

TEST_CASE("bonded terms within what is held go, and no others", "[constraints][structure]") {
  const auto left = [](ParticleSystem<double> s, const ConstraintSet& set) {
    leave_out_rigid_terms(s, set);
    const Topology rest = s.topology()->without_rigid_terms(s.size());
    CHECK(rest.exclusions == s.topology()->exclusions);
    return std::array{rest.bonds.size(), rest.angles.size(), rest.dihedrals.size()};
  };
  const auto butane = alkanes("butane.data"), hexane = alkanes("hexane.data");
  CHECK(left(butane, hydrogen_bonds(butane)) == std::array<std::size_t, 3>{8 * 3, 8 * 24, 8 * 27});
  CHECK(left(butane, bonds(butane)) == std::array<std::size_t, 3>{0, 8 * 24, 8 * 27});
  CHECK(left(butane, rigid_molecules(butane)) == std::array<std::size_t, 3>{0, 0, 0});
  CHECK(left(hexane, bonds_and_angles(hexane)) == std::array<std::size_t, 3>{0, 0, 8 * 3});
  CHECK(left(hexane, bonds(hexane)) == std::array<std::size_t, 3>{0, 8 * 4, 8 * 3});
}

TEST_CASE("the peptide of the bench has every hydrogen on one atom, at lengths of chemistry", "[structure]") {
  const UnitSystem units = unit_system("molecular");
  const ParticleSystem<double> s = io::read_structure(NOETHER_SOURCE_DIR "/bench/structures/peptide.data",
                                                      {.units = &units, .file_units = "real"});
  const std::vector<HeldDistance> held = held_distances(s, RigidTerms::hydrogen_bonds, HeldLengths::start);
  CHECK(s.size() == 239);
  std::map<Index, int> hydrogens, of_center;
  for (const HeldDistance& one : held) {
    const auto [i, j] = one.particles;
    const Index hydrogen = s.masses()[i] < 2 ? i : j;
    ++hydrogens[hydrogen];
    ++of_center[i + j - hydrogen];
    const double length = (s.positions()[i] - s.positions()[j]).norm();
    CHECK(length > 0.095);
    CHECK(length < 0.11);
  }
  const auto& masses = s.masses();
  CHECK(std::ssize(hydrogens) == std::count_if(masses.begin(), masses.end(), [](double m) { return m < 2; }));
  std::array<int, 4> clusters{};  // by hydrogens on one atom
  for (const auto& [atom, count] : of_center) ++clusters.at(static_cast<std::size_t>(count));
  CHECK(clusters == std::array<int, 4>{0, 46, 20, 11});
  const ConstraintSet set = hydrogen_bonds(s);
  CHECK(set.equations() == 46 + 2 * 20 + 3 * 11);
}

}  // namespace
}  // namespace noether::test
