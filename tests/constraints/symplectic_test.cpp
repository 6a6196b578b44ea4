/// The map of steps with constraints is symplectic: M^T J M = J on the phase space that constraints leave, for
/// molecules solved side by side in lanes, by each solver that ends at rounding, and in 113 bits.

#include "constraints/surfaces.hpp"
#include "forces/external_fields.hpp"
#include "tests/constraints/molecule_crowd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/settings.hpp"

#include <fmt/format.h>

#include <array>

namespace noether {
namespace {

using namespace noether::test;

/// Central differences of the eighth order: f' = sum_j weight_j (f(j e) - f(-j e)) / e.
constexpr std::array<double, 4> weights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
constexpr int points = 2 * weights.size();

/// A molecule, free or with its first atom on a sphere, which lanes do not take.
struct Tied {
  Molecule molecule;
  bool hung = false;

  Index atoms() const { return static_cast<Index>(molecule.masses.size()); }
};

/// States of a molecule on curves through one of them, all on its constraints: on each curve one for each point of the
/// differences, which is `distance` and a multiple from the one state, in the direction of a coordinate of phase space.
struct Curves {
  Tied tied;
  double distance;
  Index count;
  ParticleSystem<Quad> states{};  ///< curve by curve, point by point
};

/// The same molecule `count` times, each where the first stands.
Crowd copies(const Tied& tied, Index count, const ConstraintOptions& options) {
  const Molecule& molecule = tied.molecule;
  Crowd one, crowd(options);
  one.add(molecule, 0);
  const auto& s = std::as_const(one.particles);
  for (Index k = 0; k < count; ++k) {
    const Index first = crowd.particles.size();
    for (Index a = 0; a < s.size(); ++a)
      crowd.particles.add(fmt::format("{}_{}", k, a), s.masses()[a], s.positions()[a], s.velocities()[a]);
    for (const auto& [a, b] : molecule.bonds) {
      const double length =
          (molecule.atoms[static_cast<std::size_t>(a)] - molecule.atoms[static_cast<std::size_t>(b)]).norm();
      crowd.constraints.add(crowd.particles, Distance{.length = length}, {first + a, first + b});
    }
    const Vec3<double> x = s.positions()[0];
    if (tied.hung)
      crowd.constraints.add(crowd.particles, OnSphere{.center = {x[0] - 0.06, x[1] - 0.08, x[2]}, .radius = 0.1},
                            {first});
  }
  return crowd;
}

/// A curve goes where a step of free motion takes a molecule, in 113 bits: on the constraints for any distance, and
/// smoothly. @param stride  every so many coordinates of phase space have a curve
Curves curves_about(const Tied& tied, double distance, Index stride = 1) {
  constexpr double length = 0.1;  // what a coordinate moves by, beside 1 nm/ps of a velocity [nm]
  const Index atoms = tied.atoms();
  Curves curves{tied, distance, (6 * atoms + stride - 1) / stride};
  Crowd crowd = copies(tied, curves.count * points, {});
  ParticleSystem<Quad> s = crowd.particles.as<Quad>();
  ConstraintSolver<Quad> solver(crowd.constraints);
  solver.bind(s);  // takes velocities along the constraints too
  /// What a particle of a state moves by, of coordinates from `first` on.
  const auto moved = [&](Index i, Index first) {
    const Index state = i / atoms, point = state % points, along = state / points * stride - first;
    Vec3<Quad> by = Vec3<Quad>::Zero();
    if (along >= 0 && along / 3 == i % atoms)
      by[along % 3] = Quad(distance) * Quad(static_cast<double>(point % 2 == 0 ? point / 2 + 1 : -(point / 2 + 1)));
    return by;
  };
  const VectorColumn<Quad> velocities = std::as_const(s).velocities();
  for (Index i = 0; i < s.size(); ++i) s.velocities().set(i, Vec3<Quad>(Quad(length) * moved(i, 0)));
  solver.project_velocities(s, Quad(1));
  solver.advance_positions(s, Quad(1));
  for (Index i = 0; i < s.size(); ++i) s.velocities().set(i, Vec3<Quad>(velocities[i] + moved(i, 3 * atoms)));
  solver.project_velocities(s, Quad(1));
  if (solver.failure()) FAIL(solver.failure()->message);
  curves.states = std::move(s);
  return curves;
}

/// Tangents of the curves as numbers of J: m^(1/2) dx and m^(1/2) dv, coordinate by coordinate.
std::vector<std::vector<Quad>> tangents(const Curves& curves, const ParticleSystem<Quad>& s) {
  using std::sqrt;
  const Index atoms = curves.tied.atoms();
  std::vector<std::vector<Quad>> all(static_cast<std::size_t>(curves.count));
  for (Index c = 0; c < curves.count; ++c) {
    std::vector<Quad>& one = all[static_cast<std::size_t>(c)];
    for (const VectorColumn<Quad>* column : {&s.positions(), &s.velocities()}) {
      for (Index a = 0; a < atoms; ++a) {
        Vec3<Quad> sum = Vec3<Quad>::Zero();
        for (int j = 0; j < points / 2; ++j) {
          const Index up = (c * points + 2 * j) * atoms + a;
          sum += Quad(weights[static_cast<std::size_t>(j)]) * Vec3<Quad>((*column)[up] - (*column)[up + atoms]);
        }
        const Quad root = sqrt(s.masses()[a]) / Quad(curves.distance);
        for (int k = 0; k < 3; ++k) one.push_back(root * sum[k]);
      }
    }
  }
  return all;
}

/// Largest entry of M^T J M - J between unit tangents, M the derivative of three steps of Verlet's method in a field.
template <class Real> double defect(const Curves& curves, const ConstraintOptions& options, double h) {
  const Crowd crowd = copies(curves.tied, curves.count * points, options);
  Simulation<Real> sim(
      curves.states.as<Real>(),
      compose(kinetic_potential_over(field_of<Real>(HarmonicField{.k = 2e4}), crowd.constraints), schemes::verlet), h);
  const Outcome outcome = sim.run(3);
  if (!outcome.ok()) FAIL(to_text(outcome));
  const auto start = tangents(curves, curves.states), end = tangents(curves, sim.particles().template as<Quad>());
  const std::size_t half = start[0].size() / 2;
  const auto form = [&](const std::vector<Quad>& one, const std::vector<Quad>& other) {
    Quad sum(0);
    for (std::size_t k = 0; k < half; ++k) sum += one[k] * other[half + k] - one[half + k] * other[k];
    return sum;
  };
  const auto size = [](const std::vector<Quad>& one) {
    Quad sum(0);
    for (const Quad& x : one) sum += x * x;
    return std::sqrt(static_cast<double>(sum));
  };
  double worst = 0;
  for (std::size_t a = 0; a < start.size(); ++a) {
    for (std::size_t b = a + 1; b < start.size(); ++b) {
      const double apart = std::abs(static_cast<double>(form(end[a], end[b]) - form(start[a], start[b])));
      worst = std::max(worst, apart / (size(start[a]) * size(start[b])));
    }
  }
  return worst;
}

/// Differences of the eighth order leave below 1e-13 at this distance. States to an ulp of 0.5 nm leave 1e-14 of a
/// tangent, steps of many constraints some ten times as much.
constexpr double nearby = 0.01, rounding = 1e-11;
constexpr double step = 0.002;  // [ps]

TEST_CASE("steps of molecules in lanes are symplectic to rounding, by each solver that ends there", "[symplectic]") {
  for (const Molecule& molecule : {water(), chain(5), tree(9, 8), ring(3)}) {
    const Curves curves = curves_about({molecule}, nearby);
    for (const ConstraintMethodInfo& info : constraint_methods) {
      if (info.end != SolverEnd::rounding || (info.lanes == nullptr && molecule.name != "water")) continue;
      for (const SimdLevel level : all_levels()) {
        const AtLevel at(level);
        CAPTURE(molecule.name, info.name);
        CHECK(defect<double>(curves, {.solver = info.method}, step) < rounding);
      }
    }
  }
}

TEST_CASE("so are those of a long chain in segments, and of molecules that lanes do not take", "[symplectic]") {
  const Curves long_chain = curves_about({chain(300)}, nearby, 300);
  for (const SimdLevel level : all_levels()) {
    const AtLevel at(level);
    CHECK(defect<double>(long_chain, {}, step) < rounding);
  }
  for (const Molecule& molecule : {chain(5), ring(3)}) {
    CAPTURE(molecule.name);
    CHECK(defect<double>(curves_about({molecule, true}, nearby), {}, step) < rounding);
  }
}

TEST_CASE("in 113 bits steps with constraints are symplectic to 1e-24", "[symplectic][quad]") {
  for (const Molecule& molecule : {water(), chain(3), tree(5, 8), ring(3)}) {
    for (const bool hung : {false, true}) {
      CAPTURE(molecule.name, hung);
      CHECK(defect<Quad>(curves_about({molecule, hung}, 1e-5), {}, step) < 1e-24);
    }
  }
}

TEST_CASE("steps whose constraints are solved to a tolerance or an order are symplectic to no more than these",
          "[symplectic]") {
  const Curves curves = curves_about({chain(5)}, nearby);
  for (const ConstraintMethod solver : {ConstraintMethod::rattle, ConstraintMethod::p_shake}) {
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
      // Violations of the tolerance differ from state to state: over the distance, they are differences of 100 times
      // it.
      const double one = defect<double>(curves, {.solver = solver, .tolerance = tolerance}, step);
      CAPTURE(info_of(solver).name, tolerance, one);
      CHECK(one > 0.1 * tolerance);
      CHECK(one < 100 * tolerance);
    }
  }
  for (const ConstraintMethod solver : {ConstraintMethod::lincs, ConstraintMethod::p_lincs}) {
    const auto series = [&](Index order, Index iterations) {
      return defect<double>(curves, {.solver = solver, .iterations = iterations, .order = order}, step);
    };
    CAPTURE(info_of(solver).name);
    const double one = series(1, 1);
    CHECK(one > 1e-5);
    CHECK(series(4, 1) < 0.1 * one);
    CHECK(series(40, 10) < rounding);
  }
}

}  // namespace
}  // namespace noether
