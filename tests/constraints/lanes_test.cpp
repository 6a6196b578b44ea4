/// Molecules side by side in lanes: what they come to is that of the solver of all cases in 113 bits, and no molecule
/// feels who is beside it.

#include "tests/constraints/molecule_crowd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

namespace noether {
namespace {

using namespace noether::test;

/// A step of crowds of a molecule, of several sizes, is that in 113 bits.
void check_rounding(const Molecule& molecule, ConstraintMethod solver) {
  for (const int count : {1, 7, 8, 9, 16, 21}) {
    for (const double h : {0.002, -0.004}) {
      Crowd crowd({.solver = solver});
      for (int k = 0; k < count; ++k) crowd.add(molecule, k);
      const ParticleSystem<Quad> right = after_step<Quad>(crowd, h);
      for (const SimdLevel level : all_levels()) {
        const AtLevel at(level);
        const ParticleSystem<double> s = after_step<double>(crowd, h);
        const auto [x, v] = errors(s, right);
        CAPTURE(molecule.name, count, h, x, v);
        CHECK(x < 4e-15);
        CHECK(v < 4e-15 / std::abs(h));
        CHECK(crowd.constraints.worst(s).residual < 3e-14);  // 4 ulp of coordinates of 3 beside bonds of 0.1
      }
    }
  }
}

TEST_CASE("a step in lanes is that in 113 bits, to rounding, for any number of molecules", "[lanes]") {
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::m_shake}) {
    for (const Molecule& molecule : all_molecules()) check_rounding(molecule, solver);
  }
}

TEST_CASE("rigid molecules of three sites by three multipliers and in closed form are those in 113 bits", "[lanes]") {
  Molecule bent = water(), turned = water();
  bent.masses[2] = 3;  // no two sites are equal: Newton's method alone
  std::swap(turned.masses[0], turned.masses[1]);
  std::swap(turned.atoms[0], turned.atoms[1]);  // the apex is no longer the first
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::settle}) {
    for (const Molecule& molecule : {water(), turned, bent}) {
      if (solver == ConstraintMethod::settle && molecule.masses[2] == 3) continue;
      for (const double h : {0.002, -0.004, 0.008}) {
        Crowd crowd({.solver = solver});
        for (int k = 0; k < 43; ++k) crowd.add(molecule, k);
        project_all(crowd);
        const ParticleSystem<Quad> right = after_step<Quad>(crowd, h);
        for (const SimdLevel level : all_levels()) {
          const AtLevel at(level);
          const ParticleSystem<double> s = after_step<double>(crowd, h);
          const auto [x, v] = errors(s, right);
          CAPTURE(h, x, v);
          CHECK(x < 4e-15);
          CHECK(v < 4e-15 / std::abs(h));
          CHECK(crowd.constraints.worst(s).residual < 3e-14);
        }
      }
    }
  }
}

TEST_CASE("settle refuses what is no rigid molecule of three sites, two of them equal", "[lanes]") {
  Molecule bent = water(), open = water();
  bent.masses[2] = 3;
  open.bonds.pop_back();
  for (const Molecule& molecule : {bent, open, tree(10, 1)}) {
    Crowd crowd({.solver = ConstraintMethod::settle});
    crowd.add(molecule, 0);
    ConstraintSolver<double> solver(crowd.constraints);
    CHECK_THROWS_WITH(solver.bind(crowd.particles), Catch::Contains("two of them equal") && Catch::Contains("newton"));
  }
}

/// Bits of the last of so many molecules, in a crowd of its kind and among others, are those of it alone.
void check_bits(const Molecule& molecule, ConstraintMethod solver, int count, double edge) {
  const ConstraintOptions options{.solver = solver};
  Crowd alone(options, edge), crowd(options, edge), turned(options, edge);
  alone.add(molecule, count - 1);
  for (int k = 0; k < count; ++k) crowd.add(molecule, k);
  for (int k = count; k-- > 0;) {
    const bool rigid = k % 3 == 0 || solver == ConstraintMethod::settle || info_of(solver).end == SolverEnd::order;
    turned.add(rigid ? water() : tree(10, 1), 1000 + k);
    turned.add(molecule, k);
  }
  std::optional<Failure> failure;
  const ParticleSystem<double> right = after_step<double>(alone, 0.002, &failure);
  REQUIRE(!failure);
  for (const int threads : count > 100 ? std::vector<int>{1, 2, 3} : std::vector<int>{1}) {
    const Threads as(threads);
    for (const Crowd* among : {&crowd, &turned}) {
      const ParticleSystem<double> s = after_step<double>(*among, 0.002);
      for (Index a = 0; a < right.size(); ++a) {
        const Index i = std::find(s.names().begin(), s.names().end(), right.name(a)) - s.names().begin();
        REQUIRE(s.positions()[i] == right.positions()[a]);
        REQUIRE(s.velocities()[i] == right.velocities()[a]);
      }
    }
  }
}

TEST_CASE("a molecule has the same bits wherever it is, whoever is beside it, on any number of threads", "[lanes]") {
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    for (const ConstraintMethodInfo& info : constraint_methods) {
      const ConstraintMethod solver = info.method;
      for (const Molecule& molecule : all_molecules()) {
        const bool random = molecule.name == "tree" || molecule.name == "path" || molecule.name == "star" ||
                            molecule.name == "branched";
        if (solver == ConstraintMethod::settle && molecule.name != "water") continue;
        // Only Newton's method has kernels for shapes; of bonds that nearly coincide no series converges.
        if (random && solver != ConstraintMethod::newton && (molecule.name != "tree" || info.end == SolverEnd::order))
          continue;
        for (const int count : {2, 6, 10, 14, 18}) {
          for (const double edge : {0.0, 2.8}) check_bits(molecule, solver, count, edge);
        }
        check_bits(molecule, solver, 300, 0);
      }
    }
  }
}

/// A water whose lengths differ from those of other numbers in last digits, of each fifth by a tenth too; both of its
/// bonds are as long.
Molecule water_as_it_starts(int number) {
  Molecule m = water();
  m.atoms[1] = {0.0816 * (1 + number * 0x1p-52) + (number % 5 == 4 ? 0.01 : 0), 0.0577, 0};
  m.atoms[2] = {-m.atoms[1][0], m.atoms[1][1], 0};
  return m;
}

TEST_CASE("rigid waters whose lengths differ in last digits fill packs together", "[lanes]") {
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::settle}) {
    Crowd equal({.solver = solver}), differ({.solver = solver});
    for (int k = 0; k < 21; ++k) equal.add(water(), k), differ.add(water_as_it_starts(k), k);
    MoleculeLanes of_equal, of_differ;
    of_equal.lay_out(equal.constraints, equal.particles);
    of_differ.lay_out(differ.constraints, differ.particles);
    CHECK(of_equal.packs() == 3);
    CHECK(of_differ.packs() == 3);
  }
}

TEST_CASE("rigid waters of lengths of their own have the bits that each has alone, those in 113 bits", "[lanes]") {
  for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::settle}) {
    Crowd crowd({.solver = solver});
    for (int k = 0; k < 21; ++k) crowd.add(water_as_it_starts(k), k);
    project_all(crowd);
    const ParticleSystem<Quad> right = after_step<Quad>(crowd, 0.002);
    for (const SimdLevel level : all_levels()) {
      const AtLevel at(level);
      const ParticleSystem<double> s = after_step<double>(crowd, 0.002);
      const auto [x, v] = errors(s, right);
      CAPTURE(x, v);
      CHECK(x < 4e-15);
      CHECK(v < 4e-15 / 0.002);
      CHECK(crowd.constraints.worst(s).residual < 3e-14);
      for (int k = 0; k < 21; ++k) {
        Crowd alone({.solver = solver});
        alone.add(water_as_it_starts(k), k);
        for (Index a = 0; a < 3; ++a)
          alone.particles.velocities().set(a, std::as_const(crowd.particles).velocities()[3 * k + a]);
        const ParticleSystem<double> one = after_step<double>(alone, 0.002);
        for (Index a = 0; a < 3; ++a) {
          REQUIRE(one.positions()[a] == s.positions()[3 * k + a]);
          REQUIRE(one.velocities()[a] == s.velocities()[3 * k + a]);
        }
      }
    }
  }
}

TEST_CASE("rigid molecules of other lengths beside a molecule of three sites do not change its bits", "[lanes]") {
  Molecule longer = water();
  for (Vec3<double>& x : longer.atoms) x *= 1.1;
  for (const ConstraintMethodInfo& info : constraint_methods) {
    if (info.end == SolverEnd::order) continue;
    Crowd alone({.solver = info.method}), mixed({.solver = info.method});
    for (int k = 0; k < 9; ++k) alone.add(water(), k), mixed.add(water(), k);
    mixed.add(longer, 9);
    const ParticleSystem<double> right = after_step<double>(alone, 0.002), s = after_step<double>(mixed, 0.002);
    CAPTURE(info.name);
    for (Index i = 0; i < right.size(); ++i) {
      CHECK(s.positions()[i] == right.positions()[i]);
      CHECK(s.velocities()[i] == right.velocities()[i]);
    }
  }
}

TEST_CASE("a bond that would turn over in lanes is named, by every solver", "[lanes]") {
  for (const ConstraintMethod solver :
       {ConstraintMethod::newton, ConstraintMethod::rattle, ConstraintMethod::m_shake, ConstraintMethod::p_shake}) {
    Crowd crowd({.solver = solver});
    for (int k = 0; k < 21; ++k) crowd.add(tree(2, 3), k);
    ParticleSystem<double>& s = crowd.particles;
    const Vec3<double> r = s.positions()[11] - s.positions()[10];
    s.velocities().set(10, Vec3<double>::Zero());
    s.velocities().set(11, Vec3<double>(-2.2 / 0.002 * r));
    std::optional<Failure> failure;
    after_step<double>(crowd, 0.002, &failure);
    REQUIRE(failure);
    CHECK_THAT(failure->message, Catch::Contains("'tree5_") && Catch::Contains("turn over"));
  }
}

TEST_CASE("atoms of a molecule that are scattered among others end where they do side by side", "[lanes]") {
  const Molecule molecule = tree(10, 1);
  Crowd crowd;
  for (int k = 0; k < 21; ++k) crowd.add(molecule, k);
  const ParticleSystem<double> right = after_step<double>(crowd, 0.002);
  Crowd scattered;
  for (Index a = 0; a < 10; ++a) {
    for (Index m = 0; m < 21; ++m) {
      const Index i = 10 * m + a;
      const auto& c = std::as_const(crowd.particles);
      scattered.particles.add(c.name(i), c.masses()[i], c.positions()[i], c.velocities()[i]);
    }
  }
  for (Index m = 0; m < 21; ++m) {
    for (const auto& [a, b] : molecule.bonds) {
      const double length =
          (molecule.atoms[static_cast<std::size_t>(a)] - molecule.atoms[static_cast<std::size_t>(b)]).norm();
      scattered.constraints.add(scattered.particles, Distance{.length = length}, {21 * a + m, 21 * b + m});
    }
  }
  const ParticleSystem<double> s = after_step<double>(scattered, 0.002);
  for (Index a = 0; a < 10; ++a) {
    for (Index m = 0; m < 21; ++m) {
      const Vec3<double> one = s.positions()[21 * a + m], other = right.positions()[10 * m + a];
      CHECK((one - other).norm() < 2e-15);
    }
  }
}

TEST_CASE("a molecule whose step is hard is solved by itself, and the others keep their bits", "[lanes]") {
  for (const Molecule& molecule : {tree(10, 1), path(9, 3), branched(14, 1), star(5), ring(6)}) {
    Crowd cool, mixed;
    for (int k = 0; k < 21; ++k) cool.add(molecule, k), mixed.add(molecule, k, k == 5 ? 6e4 : 300);
    const ParticleSystem<Quad> wide = after_step<Quad>(mixed, 0.002);
    for (const SimdLevel level : all_levels()) {
      const AtLevel at(level);
      const ParticleSystem<double> right = after_step<double>(cool, 0.002);
      std::optional<Failure> failure;
      const ParticleSystem<double> s = after_step<double>(mixed, 0.002, &failure);
      CAPTURE(molecule.name);
      REQUIRE(!failure);
      for (Index i = 0; i < s.size(); ++i) {
        if (i / static_cast<Index>(molecule.atoms.size()) == 5) continue;
        CHECK(s.positions()[i] == right.positions()[i]);
        CHECK(s.velocities()[i] == right.velocities()[i]);
      }
      const auto [x, v] = errors(s, wide);
      CHECK(x < 1e-13);
      CHECK(v < 1e-10);
    }
  }
}

TEST_CASE("a step that has no solution names the molecule's atoms", "[lanes]") {
  const Molecule molecule = water();
  for (const ConstraintMethodInfo& info : constraint_methods) {
    Crowd crowd({.solver = info.method});
    for (int k = 0; k < 21; ++k) crowd.add(molecule, k, k == 17 ? 3e6 : 300);
    std::optional<Failure> failure;
    after_step<double>(crowd, 0.002, &failure);
    REQUIRE(failure);
    CHECK(failure->kind == Outcome::Kind::constraint_failure);
    CHECK(failure->message.find("'water17_") != std::string::npos);
    CHECK(failure->particle / 3 == 17);
  }
}

TEST_CASE("sweeps in lanes end at their tolerance, and take more of them for less", "[lanes]") {
  const ConstraintMethod sweeping = GENERATE(ConstraintMethod::rattle, ConstraintMethod::p_shake);
  std::int64_t before = 0;
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    Crowd crowd({.solver = sweeping, .tolerance = tolerance});
    for (int k = 0; k < 21; ++k) crowd.add(sweeping == ConstraintMethod::rattle ? tree(32, 2) : with_hydrogens(9), k);
    ParticleSystem<double> s = crowd.particles;
    ConstraintSolver<double> solver(crowd.constraints);
    solver.bind(s);
    solver.advance_positions(s, 0.002);
    solver.project_velocities(s, 0.002);
    REQUIRE(!solver.failure());
    const double left = crowd.constraints.worst(s).residual;
    CHECK(left <= tolerance + 3e-14);
    CHECK(left > 1e-4 * tolerance);
    CHECK(solver.iterations() > before);
    before = solver.iterations();
  }
}

}  // namespace
}  // namespace noether
