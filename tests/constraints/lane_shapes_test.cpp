/// Kernels of Newton's method in lanes for paths, trees, long chains, and molecules of any other shape.

#include "constraints/bond_path.hpp"
#include "constraints/bond_tree.hpp"
#include "tests/constraints/molecule_crowd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <set>

namespace noether {
namespace {

using namespace noether::test;

TEST_CASE("a path leads from one end of an unbranched molecule to the other, bond by bond", "[lanes]") {
  for (int bonds = 1; bonds < 12; ++bonds) {
    const Molecule m = path(bonds, static_cast<std::uint64_t>(bonds));
    const std::vector<Elimination::Pair> pairs = pairs_of(m);
    const auto made = bond_path(pairs, inverse_masses_of(m));
    REQUIRE(made);
    REQUIRE(made->bonds.size() == m.bonds.size());
    CHECK(std::set<int>(made->atoms.begin(), made->atoms.end()).size() == m.atoms.size());
    for (std::size_t k = 0; k < made->bonds.size(); ++k) {
      auto [a, b] = pairs[static_cast<std::size_t>(made->bonds[k])];
      if (a != made->atoms[k]) std::swap(a, b);
      CHECK(a == made->atoms[k]);
      CHECK(b == made->atoms[k + 1]);
      CHECK(made->inverse_masses[k] == 1 / m.masses[static_cast<std::size_t>(a)]);
    }
  }
  for (const Molecule& m : {star(3), ring(3), water(), branched(14, 1)})
    CHECK(!bond_path(pairs_of(m), inverse_masses_of(m)));
}

TEST_CASE("a step of trees with every kind of center is that in 113 bits, and others are no trees to kernels",
          "[lanes]") {
  std::set<int> seen;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Molecule molecule = seed == 0 ? full_tree() : branched(9 + static_cast<int>(seed), seed);
    const Elimination made = elimination(molecule);
    const std::vector<TreeCenter> centers = tree_centers(made.lists());
    if (bond_path(pairs_of(molecule), inverse_masses_of(molecule))) continue;
    REQUIRE(!centers.empty());
    const std::size_t before = seen.size();
    for (const TreeCenter& c : centers) seen.insert(c.shape);
    if (seen.size() == before) continue;
    Crowd crowd;
    for (int k = 0; k < 9; ++k) crowd.add(molecule, k);
    const ParticleSystem<Quad> right = after_step<Quad>(crowd, 0.002);
    for (const SimdLevel level : all_levels()) {
      const AtLevel at(level);
      const auto [x, v] = errors(after_step<double>(crowd, 0.002), right);
      CAPTURE(seed, x, v);
      CHECK(x < 4e-15);
      CHECK(v < 4e-15 / 0.002);
    }
  }
  for (int code = 0; code < TreeShape::codes; ++code) {
    CAPTURE(code);
    CHECK(TreeShape::of(code).code() == code);
    CHECK(seen.count(code) == (TreeShape::of(code).exists() ? 1U : 0U));
  }
  for (const Molecule& m : {star(4), star(5), ring(3), ring(6), water()})
    CHECK(tree_centers(elimination(m).lists()).empty());
}

TEST_CASE("a tree is eliminated without fill, a ring of n bonds with n - 3 entries at most", "[lanes]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Molecule m = tree(2 + static_cast<int>(seed), seed);
    const Elimination made = elimination(m);
    CHECK(made.fill() == 0);
    std::vector<int> places = made.places();
    std::sort(places.begin(), places.end());
    std::vector<int> all(m.bonds.size());
    std::iota(all.begin(), all.end(), 0);
    CHECK(places == all);
  }
  for (int n = 3; n < 12; ++n) {
    Molecule m{"ring", {}, {}, {}};
    for (int a = 0; a < n; ++a) m.masses.push_back(1), m.bonds.emplace_back(a, (a + 1) % n);
    CHECK(elimination(m).fill() <= n - 3);
  }
}

TEST_CASE("molecules of one kind may have different lengths", "[lanes]") {
  for (const Molecule& molecule : {path(9, 3), branched(14, 1), ring(6)}) {
    Molecule longer = molecule;
    for (Vec3<double>& x : longer.atoms) x *= 1.1;
    Crowd crowd;
    for (int k = 0; k < 21; ++k) crowd.add(k % 3 == 0 ? longer : molecule, k);
    const ParticleSystem<Quad> right = after_step<Quad>(crowd, 0.002);
    for (const SimdLevel level : all_levels()) {
      const AtLevel at(level);
      const auto [x, v] = errors(after_step<double>(crowd, 0.002), right);
      CAPTURE(molecule.name, x, v);
      CHECK(x < 4e-15);
      CHECK(v < 4e-15 / 0.002);
    }
  }
}

TEST_CASE("molecules that move along, or rest, do just that beside others that turn", "[lanes]") {
  for (const Molecule& molecule : all_molecules()) {
    Crowd crowd;
    for (int k = 0; k < 48; ++k) crowd.add(molecule, k);
    ParticleSystem<double>& s = crowd.particles;
    const auto atoms = static_cast<Index>(molecule.atoms.size());
    for (Index i = 16 * atoms; i < 48 * atoms; ++i)
      s.velocities().set(i, i < 32 * atoms ? Vec3<double>(0.5, 0.25, -1) : Vec3<double>::Zero());
    for (const SimdLevel level : all_levels()) {
      const AtLevel at(level);
      const ParticleSystem<double> moved = after_step<double>(crowd, 0x1p-9);
      for (Index i = 16 * atoms; i < 48 * atoms; ++i) {
        const Vec3<double> v = std::as_const(s).velocities()[i], x = std::as_const(s).positions()[i];
        CAPTURE(molecule.name, i);
        CHECK((moved.velocities()[i] - v).norm() < 2e-12);
        CHECK((moved.positions()[i] - (x + 0x1p-9 * v)).norm() < 4e-15);
      }
    }
  }
}

/// A zigzag, somewhat shaken; on the way its atoms are numbered from one end to the other, or in any order.
Molecule long_chain(int bonds, bool in_order) {
  std::mt19937_64 random(static_cast<std::uint64_t>(bonds));
  std::uniform_real_distribution<double> shake(-0.02, 0.02);
  Molecule m{"chain", {}, {}, {}};
  for (int a = 0; a <= bonds; ++a) {
    const double x = shake(random), y = shake(random), z = shake(random);
    m.masses.push_back(random() % 2 == 0 ? 1.008 : 14.027);
    const int along = a / 40 % 2 == 0 ? a % 40 : 39 - a % 40;  // rows, to and fro
    m.atoms.emplace_back(0.1 * along + x, 0.1 * (a % 2) + 0.2 * (a / 40) + y, z);
    if (a > 0) m.bonds.emplace_back(a - 1, a);
  }
  return in_order ? m : shuffled(m, random);
}

TEST_CASE("a long chain by segments side by side is that in 113 bits, wherever its end is in the last one", "[lanes]") {
  for (const int bonds : {257, 271, 272, 300, 999}) {
    for (const bool in_order : {true, false}) {
      for (const double edge : {0.0, 7.0}) {
        if (edge > 0 && bonds != 300) continue;
        Crowd crowd({}, edge);
        crowd.add(long_chain(bonds, in_order), 0);
        const ParticleSystem<Quad> right = after_step<Quad>(crowd, 0.001);
        for (const SimdLevel level : all_levels()) {
          const AtLevel at(level);
          std::optional<Failure> failure;
          const ParticleSystem<double> s = after_step<double>(crowd, 0.001, &failure);
          const auto [x, v] = errors(s, right);
          CAPTURE(bonds, in_order, edge, x, v);
          REQUIRE(!failure);
          CHECK(x < 1e-14);
          CHECK(v < 1e-14 / 0.001);
          CHECK(crowd.constraints.worst(s).residual < 1e-13);
        }
      }
    }
  }
}

TEST_CASE("a long chain has the same bits beside others, on any number of threads, and fails by itself", "[lanes]") {
  const Molecule chain = long_chain(300, true);
  Crowd alone, crowd;
  alone.add(chain, 3);
  for (int k = 0; k < 5; ++k) crowd.add(water(), 10 + k), crowd.add(chain, k, k == 1 ? 5e4 : 300);
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    const ParticleSystem<double> right = after_step<double>(alone, 0.001);
    for (const int threads : {1, 2, 3}) {
      const Threads as(threads);
      std::optional<Failure> failure;
      const ParticleSystem<double> s = after_step<double>(crowd, 0.001, &failure);
      REQUIRE(!failure);
      const Index first = std::find(s.names().begin(), s.names().end(), right.name(0)) - s.names().begin();
      for (Index a = 0; a < right.size(); ++a) {
        REQUIRE(s.positions()[first + a] == right.positions()[a]);
        REQUIRE(s.velocities()[first + a] == right.velocities()[a]);
      }
      CHECK(crowd.constraints.worst(s).residual < 1e-13);  // of the hot one too
    }
    Crowd lost;
    for (int k = 0; k < 3; ++k) lost.add(chain, k, k == 1 ? 3e6 : 300);
    std::optional<Failure> failure;
    after_step<double>(lost, 0.001, &failure);
    REQUIRE(failure);
    CHECK(failure->message.find("'chain1_") != std::string::npos);
    CHECK(failure->particle / 301 == 1);
  }
}

TEST_CASE("a molecule whose constraints have become dependent is named, and the others are solved", "[lanes]") {
  // Atoms around a middle of almost no mass: two of them in a line with it, three in a plane.
  for (const int bonds : {2, 3}) {
    for (const int more : {0, 7}) {
      const auto molecule = [&](bool flat) {
        std::mt19937_64 random(1);
        Molecule m = star(bonds, 1e-16);
        for (std::size_t a = 1; flat && a < m.atoms.size(); ++a) {
          const double angle = M_PI * static_cast<double>(a) / (bonds == 2 ? 1 : 1.5);
          m.atoms[a] = 0.15 * Vec3<double>(std::cos(angle), std::sin(angle), 0);
        }
        for (int k = 0; k < more; ++k) hang(m, k == 0 ? 1 : static_cast<Index>(m.atoms.size()) - 1, random);
        return m;
      };
      Crowd crowd;
      for (int k = 0; k < 21; ++k) crowd.add(molecule(k == 5), k, 0);
      for (const SimdLevel level : all_levels()) {
        const AtLevel at(level);
        std::optional<Failure> failure;
        after_step<double>(crowd, 0.002, &failure);
        CAPTURE(bonds, more);
        REQUIRE(failure);
        CHECK_THAT(failure->message, Catch::Contains("'star5_") && Catch::Contains("dependent"));
      }
    }
  }
}

TEST_CASE("an atom that is nowhere is named, and not lost among those beside it", "[lanes]") {
  for (const Molecule& molecule : {path(9, 3), branched(14, 1), star(5), ring(6), long_chain(260, true)}) {
    const auto atoms = static_cast<Index>(molecule.atoms.size());
    for (Index a = 0; a<atoms; a += atoms> 100 ? 17 : 1) {
      Crowd crowd;
      for (int k = 0; k < (atoms > 100 ? 6 : 21); ++k) crowd.add(molecule, k);
      crowd.particles.velocities().set(5 * atoms + a, Vec3<double>(std::nan(""), 0, 0));
      std::optional<Failure> failure;
      after_step<double>(crowd, 0.002, &failure);
      CAPTURE(molecule.name, a);
      REQUIRE(failure);
      CHECK(failure->particle / atoms == 5);
    }
  }
}

TEST_CASE("a velocity that is no number is named at once, by every solver", "[lanes]") {
  for (const ConstraintMethodInfo& info : constraint_methods) {
    for (const double lost : {std::nan(""), HUGE_VAL}) {
      for (const Molecule& molecule : {water(), path(9, 3), branched(14, 1), star(5), ring(6), long_chain(260, true)}) {
        const auto atoms = static_cast<Index>(molecule.atoms.size());
        if (atoms > 100 && info.method != ConstraintMethod::newton) continue;
        if (info.method == ConstraintMethod::settle && molecule.name != "water") continue;
        const Index stride = atoms > 100 ? 37 : 1;
        for (Index a = 0; a < atoms; a += stride) {
          Crowd crowd({.solver = info.method});
          for (int k = 0; k < (atoms > 100 ? 6 : 21); ++k) crowd.add(molecule, k);
          crowd.particles.velocities().set(5 * atoms + a, Vec3<double>(0, lost, 0));
          crowd.particles.phase().opened = true;
          ConstraintSolver<double> solver(crowd.constraints);
          solver.bind(crowd.particles);
          solver.project_velocities(crowd.particles, 0.002);
          CAPTURE(info.name, molecule.name, a, lost);
          REQUIRE(solver.failure());
          CHECK(solver.failure()->particle / atoms == 5);
          CHECK_THAT(solver.failure()->message, Catch::Contains("'" + molecule.name + "5_"));
        }
      }
    }
  }
}

TEST_CASE("velocities of molecules with atoms of very different masses are those in 113 bits", "[lanes]") {
  for (const double ratio : {1e4, 1e8, 1e10}) {
    Molecule light_centers = full_tree();  // each between three heavy leaves and the heavy middle
    light_centers.name = "light";
    for (Molecule molecule : {light_centers, path(9, 3), branched(14, 1), full_tree(), star(4), ring(6)}) {
      std::mt19937_64 random(3);
      for (std::size_t a = 0; a < molecule.masses.size(); ++a) {
        const bool light = molecule.name == "light" ? a >= 1 && a <= 4 : random() % 3 == 0;
        molecule.masses[a] = light ? 12 / ratio : 12;
      }
      Crowd crowd;
      for (int k = 0; k < 9; ++k) crowd.add(molecule, k, 0);
      ParticleSystem<double>& s = crowd.particles;
      std::normal_distribution<double> normal;
      for (Index i = 0; i < s.size(); ++i) {
        const double x = normal(random), y = normal(random), z = normal(random);
        s.velocities().set(i, Vec3<double>(x, y, z));
      }
      s.phase().opened = true;
      ParticleSystem<Quad> right = s.as<Quad>();
      right.phase().opened = true;
      ConstraintSolver<Quad> exact(crowd.constraints);
      exact.bind(right);
      exact.project_velocities(right, 0.002);
      for (const SimdLevel level : all_levels()) {
        const AtLevel at(level);
        ParticleSystem<double> made = s;
        ConstraintSolver<double> solver(crowd.constraints);
        solver.bind(made);
        solver.project_velocities(made, 0.002);
        double across = 0;
        for (Index e = 0; e < crowd.constraints.equations(); ++e) {
          const ConstraintPlace place = crowd.constraints.place(e);
          const Index i = place.group->particle(place.constraint, 0), j = place.group->particle(place.constraint, 1);
          const auto& c = std::as_const(made);
          const Vec3<double> r = c.positions()[i] - c.positions()[j], v = c.velocities()[i] - c.velocities()[j];
          across = std::max(across, std::abs(dot(r, v)) / r.norm());
        }
        const double v = errors(made, right).second;
        CAPTURE(ratio, molecule.name, v, across);
        CHECK(!solver.failure());
        CHECK(across < 1e-11);
        CHECK(v < 1e-11);
      }
    }
  }
}

TEST_CASE("a long chain in segments whose constraints have become dependent is named", "[lanes]") {
  // An atom of almost no mass in a line with its neighbors: within a segment, at its ends, and in the last one.
  const int bonds = 300, of_segment = bonds / 16 + 1;
  for (const int at : {1, 7, of_segment - 1, of_segment, of_segment + 1, 5 * of_segment, bonds - 1}) {
    Molecule chain = long_chain(bonds, true), singular = chain;
    const auto middle = static_cast<std::size_t>(at);
    singular.masses[middle] = 1e-16;
    singular.atoms[middle] = 0.5 * (singular.atoms[middle - 1] + singular.atoms[middle + 1]);
    chain.masses[middle] = 1e-16;
    Crowd crowd;
    for (int k = 0; k < 4; ++k) crowd.add(k == 2 ? singular : chain, k, 0);
    for (const SimdLevel level : all_levels()) {
      const AtLevel as(level);
      std::optional<Failure> failure;
      after_step<double>(crowd, 0.001, &failure);
      CAPTURE(at);
      REQUIRE(failure);
      CHECK(failure->particle / (bonds + 1) == 2);
      CHECK_THAT(failure->message, Catch::Contains("'chain2_") && Catch::Contains("dependent"));
    }
  }
}

}  // namespace
}  // namespace noether
