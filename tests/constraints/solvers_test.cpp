/// Solvers of constraints beside each other: how fast each converges, and what each refuses.

#include "constraints/angle.hpp"
#include "constraints/constraint_solver.hpp"
#include "tests/constraints/molecule_crowd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>

namespace noether {
namespace {

using namespace noether::test;

/// What a step of 2 fs of 21 molecules at 300 K comes to.
struct Step {
  ParticleSystem<double> particles;
  std::int64_t iterations;  ///< of both stages
  double violation;         ///< relative
};
Step step_of(const Molecule& molecule, const ConstraintOptions& options, double side = 0) {
  Crowd crowd(options, side);
  for (int k = 0; k < 21; ++k) crowd.add(molecule, k);
  ParticleSystem<double> s = crowd.particles;
  ConstraintSolver<double> solver(crowd.constraints);
  solver.bind(s);
  solver.advance_positions(s, 0.002);
  solver.project_velocities(s, 0.002);
  if (solver.failure()) FAIL(solver.failure()->message);
  const double violation = crowd.constraints.worst(s).residual;
  return {std::move(s), solver.iterations(), violation};
}

/// The largest part of velocities across the constraints that LINCS leaves of them.
double left_of_velocities(const Molecule& molecule, Index order) {
  Crowd crowd({.solver = ConstraintMethod::lincs, .order = order});
  for (int k = 0; k < 21; ++k) crowd.add(molecule, k);
  ParticleSystem<double>& s = crowd.particles;
  ConstraintSolver<double> solver(crowd.constraints);
  s.phase().opened = true;  // else they would be projected to rounding here
  solver.bind(s);
  const auto across = [&] {
    double worst = 0;
    for (Index e = 0; e < crowd.constraints.equations(); ++e) {
      const ConstraintPlace place = crowd.constraints.place(e);
      const Index i = place.group->particle(place.constraint, 0), j = place.group->particle(place.constraint, 1);
      const auto& c = std::as_const(s);
      worst =
          std::max(worst, std::abs(dot(c.positions()[i] - c.positions()[j], c.velocities()[i] - c.velocities()[j])));
    }
    return worst;
  };
  const double before = across();
  solver.project_velocities(s, 0.002);
  return across() / before;
}

TEST_CASE("each power of LINCS's series leaves less of velocities across, by a factor that depends on the molecule",
          "[solvers]") {
  struct Shape {
    Molecule molecule;
    double least, most;  ///< of the mean factor of a power
  };
  for (const auto& [molecule, least, most] : {Shape{chain(9), 0.3, 0.5}, Shape{with_hydrogens(9), 0.3, 0.6},
                                              Shape{ring(6), 0.3, 0.6}, Shape{water(), 0.6, 0.9}}) {
    double before = left_of_velocities(molecule, 2);
    for (const Index order : {4, 6, 8, 10}) {
      const double now = left_of_velocities(molecule, order);
      CAPTURE(molecule.name, order, now);
      CHECK(std::sqrt(now / before) > least);
      CHECK(std::sqrt(now / before) < most);
      before = now;
    }
  }
}

TEST_CASE("LINCS has the violation that its order and iterations leave, far below a turn's", "[solvers]") {
  const auto violation = [](const Molecule& molecule, Index order, Index iterations) {
    return step_of(molecule, {.solver = ConstraintMethod::lincs, .iterations = iterations, .order = order}).violation;
  };
  for (const Molecule& molecule : {chain(9), with_hydrogens(9), ring(6)}) {
    CHECK(violation(molecule, 4, 1) < 1e-4);  // free motion violates by 4e-2
    CHECK(violation(molecule, 4, 1) > 1e-6);
    CHECK(violation(molecule, 8, 2) < 1e-6);
    CHECK(violation(molecule, 8, 2) > 1e-9);
    // With a series long enough each correction leaves some hundredths, as chord steps do.
    double before = violation(molecule, 16, 1);
    for (const Index iterations : {2, 3, 4}) {
      const double now = violation(molecule, 16, iterations);
      CHECK(now < 0.05 * before);
      before = now;
    }
    CHECK(violation(molecule, 30, 12) < 1e-13);
  }
}

TEST_CASE("what a set says that LINCS leaves of the violation is enough, and not far too much", "[solvers]") {
  for (const Molecule& molecule : {chain(9), with_hydrogens(9), ring(6)}) {
    for (const auto& [order, iterations] :
         {std::pair{2, 1}, {4, 1}, {8, 1}, {16, 1}, {4, 2}, {8, 2}, {30, 2}, {30, 4}}) {
      const ConstraintOptions options{.solver = ConstraintMethod::lincs, .iterations = iterations, .order = order};
      CAPTURE(molecule.name, order, iterations);
      const double left = step_of(molecule, options).violation;
      CHECK(left <= options.violation());
      CHECK(left > 1e-5 * options.violation());
    }
  }
}

TEST_CASE("p_lincs is LINCS of all molecules together, on any number of threads, in a box too", "[solvers]") {
  for (const double side : {0.0, 2.8}) {
    for (const Molecule& molecule : {with_hydrogens(9), ring(6)}) {
      const Step alone = step_of(molecule, {.solver = ConstraintMethod::lincs}, side);
      const ParticleSystem<double>& one = alone.particles;
      CHECK(alone.iterations == step_of(molecule, {.solver = ConstraintMethod::p_lincs}, side).iterations);
      std::optional<ParticleSystem<double>> first;
      for (const int threads : {1, 2, 3}) {
        const Threads as(threads);
        ParticleSystem<double> all = step_of(molecule, {.solver = ConstraintMethod::p_lincs}, side).particles;
        for (Index i = 0; i < one.size(); ++i) {
          REQUIRE((one.positions()[i] - all.positions()[i]).norm() < 4e-15);
          REQUIRE((one.velocities()[i] - all.velocities()[i]).norm() < 4e-12);
          if (first) REQUIRE(all.positions()[i] == first->positions()[i]);
          if (first) REQUIRE(all.velocities()[i] == first->velocities()[i]);
        }
        if (!first) first = std::move(all);
      }
    }
  }
}

TEST_CASE("p_shake needs at most half of the sweeps of rattle on decane, m_shake of the steps of newton", "[solvers]") {
  for (const Molecule& molecule : {chain(9), with_hydrogens(9)}) {
    for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
      const auto sweeps = [&](ConstraintMethod solver) {
        return step_of(molecule, {.solver = solver, .tolerance = tolerance}).iterations;
      };
      CHECK(2 * sweeps(ConstraintMethod::p_shake) <= sweeps(ConstraintMethod::rattle));
      CHECK(step_of(molecule, {.solver = ConstraintMethod::p_shake, .tolerance = tolerance}).violation <= tolerance);
    }
    const auto steps = [&](ConstraintMethod solver) { return step_of(molecule, {.solver = solver}).iterations; };
    CHECK(2 * steps(ConstraintMethod::m_shake) <= steps(ConstraintMethod::newton));
  }
}

TEST_CASE("a molecule too large for its solver's lanes is solved among the others", "[solvers]") {
  const Molecule large = chain(300);
  const ParticleSystem<double> right = step_of(large, {}).particles;
  for (const ConstraintMethodInfo& info : constraint_methods) {
    if (info.lanes == nullptr && info.triangles != nullptr) continue;  // for triangles alone
    const Step step = step_of(large, {.solver = info.method, .tolerance = 1e-9});
    const double allowed = info.end == SolverEnd::rounding ? 1e-12 : info.end == SolverEnd::tolerance ? 1e-9 : 1e-4;
    CAPTURE(info.name, step.violation);
    CHECK(step.violation <= allowed);
    double apart = 0;
    for (Index i = 0; i < right.size(); ++i)
      apart = std::max(apart, (step.particles.positions()[i] - right.positions()[i]).norm());
    CHECK(apart < 10 * allowed);
  }
}

TEST_CASE("LINCS refuses what is no distance, and names it", "[solvers]") {
  for (const ConstraintMethod solver : {ConstraintMethod::lincs, ConstraintMethod::p_lincs}) {
    Crowd crowd({.solver = solver});
    crowd.add(chain(3), 0);
    crowd.constraints.add(crowd.particles, Angle{}, {0, 1, 2});
    ConstraintSolver<double> made(crowd.constraints);
    CHECK_THROWS_WITH(made.bind(crowd.particles), Catch::Contains("'chain0_0', 'chain0_1' and 'chain0_2'") &&
                                                      Catch::Contains("is not a distance") &&
                                                      Catch::Contains("newton"));
  }
}

TEST_CASE("a molecule that LINCS cannot hold is named", "[solvers]") {
  for (const ConstraintMethod solver : {ConstraintMethod::lincs, ConstraintMethod::p_lincs}) {
    Crowd crowd({.solver = solver});
    for (int k = 0; k < 21; ++k) crowd.add(chain(9), k, k == 13 ? 1e7 : 300);
    std::optional<Failure> failure;
    after_step<double>(crowd, 0.004, &failure);
    REQUIRE(failure);
    CHECK(failure->particle / 10 == 13);
    CHECK_THAT(failure->message, Catch::Contains("'chain13_") && Catch::Contains("turns by more than 45 degrees"));
    // Three bonds of an atom whose series does not converge, and no bond that turns: violations grow from step to step.
    Crowd heavy({.solver = solver});
    Molecule star{"star", {1, 100, 100, 100}, {{0, 0, 0}, {0.1, 0, 0}, {0.0999, 0.005, 0}, {0.0998, -0.006, 0}}, {}};
    star.bonds = {{0, 1}, {0, 2}, {0, 3}};
    for (int k = 0; k < 9; ++k) heavy.add(star, k);
    ParticleSystem<double> s = heavy.particles;
    ConstraintSolver<double> made(heavy.constraints);
    made.bind(s);
    for (int k = 0; k < 100 && !made.failure(); ++k)
      made.advance_positions(s, 0.002), made.project_velocities(s, 0.002);
    REQUIRE(made.failure());
    CHECK_THAT(made.failure()->message, Catch::Contains("'star") && Catch::Contains("newton"));
  }
}

TEST_CASE("a run tells what an iteration leaves of the violation", "[solvers]") {
  for (const ConstraintMethod solver : {ConstraintMethod::rattle, ConstraintMethod::p_shake}) {
    const auto work_of = [&](double tolerance) {
      Crowd crowd({.solver = solver, .tolerance = tolerance});
      for (int k = 0; k < 21; ++k) crowd.add(with_hydrogens(9), k);
      ParticleSystem<double> s = crowd.particles;
      ConstraintSolver<double> made(crowd.constraints);
      made.bind(s);
      for (int k = 0; k < 5; ++k) {
        made.advance_positions(s, 0.002);
        made.project_velocities(s, 0.002);
      }
      REQUIRE(!made.failure());
      return made.work();
    };
    const ConstraintWork loose = work_of(1e-4), tight = work_of(1e-12);
    // Both stages take about as many: eight orders of magnitude by so many more iterations.
    const double more = static_cast<double>(tight.iterations - loose.iterations) / 10;
    const double expected = std::pow(1e-8, 1 / more);
    CAPTURE(expected, tight.contraction());
    CHECK(tight.contraction() > 0.5 * expected);
    CHECK(tight.contraction() < 1.5 * expected);
    CHECK(tight.measured > 0);
    CHECK(tight.measured < tight.iterations);
  }
  const auto work_of = [](const ConstraintOptions& options, int bonds) {
    Crowd crowd(options);
    crowd.add(path(bonds, 3), 0);
    ParticleSystem<double> s = crowd.particles;
    ConstraintSolver<double> made(crowd.constraints);
    made.bind(s);
    made.advance_positions(s, 0.0001);
    REQUIRE(!made.failure());
    return made.work();
  };
  for (const int bonds : {9, 300}) {  // in lanes, and by the solver of all cases
    for (const ConstraintMethod solver : {ConstraintMethod::newton, ConstraintMethod::rattle}) {
      const ConstraintWork work = work_of({.solver = solver, .tolerance = 1e-6}, bonds);
      CAPTURE(bonds, work.contraction());
      CHECK(work.measured > 0);
      CHECK(work.contraction() > 0);
      CHECK(work.contraction() < (solver == ConstraintMethod::newton ? 0.01 : 0.95));
    }
  }
}

/// Largest | |r|^2 - d^2 | / 2 d^2 of a crowd's bonds where its particles would be after so long a time of free motion.
double violation_after(const Crowd& crowd, const ParticleSystem<double>& s, double h) {
  double worst = 0;
  for (Index e = 0; e < crowd.constraints.equations(); ++e) {
    const ConstraintPlace place = crowd.constraints.place(e);
    const Index i = place.group->particle(place.constraint, 0), j = place.group->particle(place.constraint, 1);
    const Vec3<double> r = s.box().is_periodic()
                               ? s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j]))
                               : Vec3<double>(s.positions()[i] - s.positions()[j]);
    const Vec3<double> d = r + h * Vec3<double>(s.velocities()[i] - s.velocities()[j]);
    worst = std::max(worst, std::abs(norm2(d) / place.group->scale(place.constraint) - 1) / 2);
  }
  return worst;
}

TEST_CASE("solvers whose stages do not see violations look at one stage in 64: the contraction is that of the stage",
          "[solvers]") {
  struct Case {
    Molecule molecule;
    ConstraintOptions options;
    double rounding;  ///< of what is left
  };
  const ConstraintOptions series{.solver = ConstraintMethod::lincs}, together{.solver = ConstraintMethod::p_lincs};
  for (const auto& [molecule, options, rounding] :
       {Case{chain(9), series, 1e-6}, Case{chain(9), together, 1e-6}, Case{water(), {}, 4}}) {
    for (const double side : {0.0, 2.8}) {
      CAPTURE(molecule.name, info_of(options.solver).name, side);
      Crowd crowd(options, side);
      for (int k = 0; k < (molecule.name == "water" ? 21 : 7); ++k) crowd.add(molecule, k);  // 63 bonds
      ParticleSystem<double> s = crowd.particles;
      ConstraintSolver<double> solver(crowd.constraints);
      solver.bind(s);
      solver.advance_positions(s, 0.002);
      solver.project_velocities(s, 0.002);
      CHECK(solver.work().measured == 0);
      const std::int64_t first = solver.iterations();
      const double before = violation_after(crowd, s, 0.002);
      solver.advance_positions(s, 0.002);
      const std::int64_t made = solver.iterations() - first;
      CHECK(solver.work().measured == made);
      const double after = std::max(violation_after(crowd, s, 0), 0x1p-53);
      const double expected = std::pow(after / before, 1 / static_cast<double>(made));
      CAPTURE(expected, solver.work().contraction());
      CHECK(std::abs(std::log(solver.work().contraction() / expected)) <
            std::log1p(rounding) / static_cast<double>(made));
      for (int k = 0; k < 200; ++k) solver.project_velocities(s, 0.002), solver.advance_positions(s, 0.0005);
      REQUIRE(!solver.failure());
      // One that goes on from there looks at the same stages.
      ParticleSystem<double> other = s;
      other.phase().opened = true;
      ConstraintSolver<double> resumed(crowd.constraints);
      resumed.bind(other);
      resumed.restore(solver.work());
      for (int k = 0; k < 100; ++k) {
        solver.project_velocities(s, 0.002), solver.advance_positions(s, 0.0005);
        resumed.project_velocities(other, 0.002), resumed.advance_positions(other, 0.0005);
      }
      REQUIRE(!solver.failure());
      CHECK(resumed.work().measured == solver.work().measured);
      CHECK(resumed.work().log == solver.work().log);
      CHECK(solver.work().measured > made);
      CHECK(solver.work().measured < solver.iterations() / 40);
    }
  }
}

TEST_CASE("the closed form makes no iterations, but where it has no solution", "[solvers]") {
  for (const double temperature : {300.0, 2e5}) {
    Crowd crowd({.solver = ConstraintMethod::settle});
    for (int k = 0; k < 21; ++k) crowd.add(water(), k, k == 5 ? temperature : 300);
    ParticleSystem<double> s = crowd.particles;
    ConstraintSolver<double> solver(crowd.constraints);
    solver.bind(s);
    solver.advance_positions(s, 0.002);
    CHECK(solver.failure().has_value() == (temperature > 300));
    CHECK((solver.iterations() > 0) == (temperature > 300));  // of Newton's method, which says what is wrong
    CHECK(solver.work().contraction() == 0);
  }
}

TEST_CASE("in 113 bits a solver that is exact there leaves no violation on purpose", "[solvers][quad]") {
  for (const ConstraintMethodInfo& info : constraint_methods) {
    Crowd crowd({.solver = info.method});
    crowd.add(info.method == ConstraintMethod::settle ? water() : path(3, 2), 0);
    ParticleSystem<double> s = crowd.particles;
    ParticleSystem<Quad> wide = s.as<Quad>();
    ConstraintSolver<double> solver(crowd.constraints);
    ConstraintSolver<Quad> exact(crowd.constraints);
    solver.bind(s), exact.bind(wide);
    CAPTURE(info.name);
    CHECK(solver.tolerance() == crowd.constraints.tolerance());
    CHECK(exact.tolerance() == (info.method == ConstraintMethod::rattle ? crowd.constraints.tolerance() : 0));
    if (exact.tolerance() > 0) continue;
    exact.advance_positions(wide, Quad(0.0001));
    REQUIRE(!exact.failure());
    for (Index e = 0; e < crowd.constraints.equations(); ++e) {
      const ConstraintPlace place = crowd.constraints.place(e);
      Quad value;
      place.group->values(ConstraintPositions<Quad>(wide), place.constraint, place.constraint + 1, &value);
      CHECK(std::abs(static_cast<double>(value)) < 1e-28);
    }
  }
}

}  // namespace
}  // namespace noether
