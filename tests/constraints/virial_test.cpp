/// The virial of constraints, and the pressure with it, by every solver: that of Newton's method as far as a solver's
/// tolerance reaches, and closed forms.

#include "engine/simulation.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/pressure.hpp"
#include "tests/constraints/molecule_crowd.hpp"
#include "tests/support/catch.hpp"

namespace noether {
namespace {

using namespace noether::test;

constexpr double two_fs = 0.002, edge = 2.8;  // [ps], [nm]; faces of the box cut molecules

/// Solvers as they are where they leave as little as they can: a series of water takes many powers.
std::vector<ConstraintOptions> tightest(const Molecule& molecule) {
  std::vector<ConstraintOptions> all;
  for (const ConstraintMethodInfo& info : constraint_methods) {
    if (info.method == ConstraintMethod::settle && molecule.name != "water") continue;
    ConstraintOptions options{.solver = info.method, .tolerance = 1e-12};
    if (info.end == SolverEnd::order) options.iterations = 12, options.order = molecule.name == "water" ? 120 : 30;
    all.push_back(options);
  }
  return all;
}

/// What a step of 21 molecules comes to.
struct AfterStep {
  Mat3<double> virial;    ///< of constraints that hold against a harmonic field [energy]
  Mat3<double> pressure;  ///< of the monitor, without forces
  double molecular = 0;   ///< of the centres of mass [pressure]
};
AfterStep after_step_of(const Molecule& molecule, const ConstraintOptions& options) {
  Crowd crowd(options, edge);
  for (int k = 0; k < 21; ++k) crowd.add(molecule, k);
  const KineticPotential<ForceField<double>, double, ConstraintSet> free(ForceField<double>(), crowd.constraints);
  Simulation<double> sim(crowd.particles, compose(free, schemes::verlet), two_fs);
  const Pressure& pressure = sim.every(1, Pressure{});
  const Outcome outcome = sim.run(1);
  if (!outcome.ok()) FAIL(to_text(outcome));
  AfterStep after;
  for (int k = 0; k < 9; ++k) after.pressure(k / 3, k % 3) = pressure.tensor()[static_cast<std::size_t>(k)];
  ParticleSystem<double> s = sim.particles();
  VectorColumn<double> a(s.size());
  for (Index i = 0; i < s.size(); ++i) a.set(i, Vec3<double>(-2e4 / s.masses()[i] * s.unwrapped(i)));
  ConstraintSolver<double> solver(crowd.constraints);
  s.phase().opened = true;  // it stays where it is
  solver.bind(s);
  after.virial = solver.virial(s, a);
  const auto atoms = static_cast<Index>(molecule.atoms.size());
  for (Index first = 0; first < s.size(); first += atoms) {
    Vec3<double> momentum = Vec3<double>::Zero();
    double mass = 0;
    for (Index i = first; i < first + atoms; ++i) momentum += s.masses()[i] * s.velocities()[i], mass += s.masses()[i];
    after.molecular += norm2(momentum) / mass / (3 * s.box().volume());
  }
  return after;
}

/// The largest difference beside the largest number.
double apart(const Mat3<double>& one, const Mat3<double>& right) {
  return (one - right).cwiseAbs().maxCoeff() / right.cwiseAbs().maxCoeff();
}

std::vector<Molecule> shapes() { return {water(), chain(9), with_hydrogens(3), ring(6)}; }

/// What a tolerance leaves: of a virial about as much; of a pressure as much as of velocities, whose tolerance is a
/// length in a step, 50 nm/ps for one of 0.1 nm.
constexpr double of_virial = 2, of_pressure = 50;

TEST_CASE("the virial of constraints and the pressure after a step are those of Newton's method by every solver",
          "[virial]") {
  for (const Molecule& molecule : shapes()) {
    const AfterStep right = after_step_of(molecule, {});
    for (const ConstraintOptions& options : tightest(molecule)) {
      const AfterStep after = after_step_of(molecule, options);
      const bool loose = info_of(options.solver).end == SolverEnd::tolerance;
      CAPTURE(molecule.name, info_of(options.solver).name);
      CHECK(apart(after.virial, right.virial) < (loose ? of_virial * options.tolerance : 2e-14));
      CHECK(apart(after.pressure, right.pressure) < (loose ? of_pressure * options.tolerance : 2e-14));
    }
  }
}

/// The slope of the logarithm of an error over that of a tolerance, by least squares.
class Slope {
 public:
  void add(double tolerance, double error) {
    const double at = std::log(tolerance), value = std::log(error);
    n_ += 1, x_ += at, y_ += value, xx_ += at * at, xy_ += at * value;
  }
  double value() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

TEST_CASE("ten times the tolerance is ten times the error of a virial and of a pressure", "[virial]") {
  for (const Molecule& molecule : shapes()) {
    const AfterStep right = after_step_of(molecule, {});
    for (const ConstraintMethod solver : {ConstraintMethod::rattle, ConstraintMethod::p_shake}) {
      Slope virial, pressure;
      for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}) {
        const AfterStep after = after_step_of(molecule, {.solver = solver, .tolerance = tolerance});
        const double of_first = apart(after.virial, right.virial), of_second = apart(after.pressure, right.pressure);
        CAPTURE(molecule.name, info_of(solver).name, tolerance);
        CHECK(of_first < of_virial * tolerance);
        CHECK(of_second < of_pressure * tolerance);
        virial.add(tolerance, of_first);
        pressure.add(tolerance, of_second);
      }
      CAPTURE(molecule.name, info_of(solver).name, virial.value(), pressure.value());
      CHECK(std::abs(virial.value() - 1) < 0.1);
      CHECK(std::abs(pressure.value() - 1) < 0.15);  // sweeps of p_shake leave up to 30 times less than is asked for
    }
    if (molecule.name == "water") continue;
    for (const ConstraintMethod solver : {ConstraintMethod::lincs, ConstraintMethod::p_lincs}) {
      double before = 1;
      for (const auto& [order, iterations] : {std::pair{4, 1}, {8, 2}, {16, 4}}) {
        const ConstraintOptions options{.solver = solver, .iterations = iterations, .order = order};
        const double error = apart(after_step_of(molecule, options).virial, right.virial);
        CAPTURE(molecule.name, info_of(solver).name, order, error);
        CHECK(error < 1e-2 * before);
        before = error;
      }
    }
  }
}

TEST_CASE("a gas of rigid waters has the pressure of their centres, by every solver and at any tolerance", "[virial]") {
  // sum m v^2 + tr W = sum M V^2 where bonds are not accelerated: the virial of constraints is - 2 K of turning.
  std::vector<ConstraintOptions> all = tightest(water());
  for (const double tolerance : {1e-4, 1e-8}) {
    for (const ConstraintMethod solver : {ConstraintMethod::rattle, ConstraintMethod::p_shake})
      all.push_back({.solver = solver, .tolerance = tolerance});
  }
  for (const ConstraintOptions& options : all) {
    const AfterStep after = after_step_of(water(), options);
    CAPTURE(info_of(options.solver).name, options.tolerance);
    CHECK(std::abs(after.pressure.trace() / 3 / after.molecular - 1) < 1e-13);
  }
}

/// Turning dumbbells of 12 u and 1 u, 0.1 nm long, side by side, each with its own speed.
Crowd dumbbells(const Molecule& two, const ConstraintOptions& options) {
  Crowd crowd(options, edge);
  for (int k = 0; k < 21; ++k) crowd.add(two, k);
  for (Index k = 0; k < 21; ++k) {
    const auto& s = std::as_const(crowd.particles);
    const Vec3<double> r = s.box().minimum_image(Vec3<double>(s.positions()[2 * k + 1] - s.positions()[2 * k]));
    const double speed = 0.5 + 0.2 * static_cast<double>(k);  // of the second about the first [nm/ps]
    const Vec3<double> v = speed / r.norm() * Vec3<double>(0.6 * r[1], -0.6 * r[0], 0.8 * r.norm());
    crowd.particles.velocities().set(2 * k, Vec3<double>(-v / 13));
    crowd.particles.velocities().set(2 * k + 1, Vec3<double>(12 * v / 13));
  }
  return crowd;
}

TEST_CASE("constraints of turning dumbbells have the virial - mu v^2 n n, n turned by arcsin(h v / d) in a step",
          "[virial]") {
  constexpr int steps = 5;
  const Molecule two{"dumbbell", {12, 1}, {{0, 0, 0}, {0.1, 0, 0}}, {{0, 1}}};
  for (const ConstraintOptions& options : tightest(two)) {
    Crowd crowd = dumbbells(two, options);
    ParticleSystem<double> s = crowd.particles;
    Mat3<double> expected = Mat3<double>::Zero();
    for (Index k = 0; k < 21; ++k) {
      const Vec3<double> v = std::as_const(s).velocities()[2 * k + 1] - std::as_const(s).velocities()[2 * k];
      const Vec3<double> r = std::as_const(s).positions()[2 * k + 1] - std::as_const(s).positions()[2 * k];
      const double angle = steps * std::asin(two_fs * v.norm() / 0.1);
      const Vec3<double> n =
          std::cos(angle) * s.box().minimum_image(r) / 0.1 + std::sin(angle) * Vec3<double>(v / v.norm());
      expected -= 12.0 / 13 * norm2(v) * n * n.transpose();
    }
    ConstraintSolver<double> solver(crowd.constraints);
    solver.bind(s);
    for (int k = 0; k < steps; ++k) solver.advance_positions(s, two_fs), solver.project_velocities(s, two_fs);
    REQUIRE(!solver.failure());
    CAPTURE(info_of(options.solver).name);
    const bool loose = info_of(options.solver).end == SolverEnd::tolerance;
    CHECK(apart(solver.virial(s, VectorColumn<double>(s.size())), expected) < (loose ? options.tolerance : 5e-14));
  }
}

}  // namespace
}  // namespace noether
