/// What constraints cost: nanoseconds a constraint and step, and the violation that is left.
///
/// Zigzag chains of carbons at 300 K without forces, bonds of 0.153 nm, 2 fs, one thread: chains of 10, 100 and 10 000
/// bonds, solved to rounding and by sweeps to 1e-7; water-like triangles in which every bond is coupled.
///
/// Protocol: 20 slices of some hundred steps each, all cases in turn; medians of processor times. `cost_scaling` is the
/// cost of a bond in the chain of 10 000 over that in the chain of 100, slice by slice.

#include "bench/support.hpp"

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"

#include <random>

using namespace noether;

namespace {

struct Case {
  std::string name;
  ConstraintSet set;
  Simulation<double> simulation;
  std::int64_t steps;  ///< of a slice
  std::vector<double> cost = {};
  double violation = 0;

  /// Runs a slice. @return ns for each constraint and step
  double slice() {
    const double seconds = bench::processor_seconds_of([&] {
      if (!simulation.run(steps).ok()) throw Error("the benchmark's run failed");
    });
    violation = std::max(violation, set.worst(simulation.particles()).residual);
    cost.push_back(1e9 * seconds / static_cast<double>(steps * set.equations()));
    return cost.back();
  }
};

/// Particles at 300 K; the same numbers for each length of a chain.
void add_atom(ParticleSystem<double>& s, double mass, const Vec3<double>& x, std::mt19937& random) {
  std::normal_distribution<double> normal(0, std::sqrt(units::molecular::k_B * 300 / mass));
  const double u = normal(random), v = normal(random), w = normal(random);
  s.add("atom_" + std::to_string(s.size()), mass, x, {u, v, w});
}

Case made(std::string name, ParticleSystem<double> s, ConstraintSet set, std::int64_t work) {
  auto integrator = compose(KineticPotential(UniformField{}, set), schemes::verlet);
  const std::int64_t steps = std::max<std::int64_t>(10, work / set.equations());
  return {std::move(name), set, Simulation<double>(std::move(s), std::move(integrator), 0.002), steps};
}

Case chain(const std::string& name, Index bonds, const ConstraintOptions& options) {
  std::mt19937 random(1);
  ParticleSystem<double> s(unit_system("molecular"));
  const double half = 112 * M_PI / 360, bond = 0.153;
  for (Index i = 0; i <= bonds; ++i) {
    const double along = static_cast<double>(i) * bond * std::sin(half);
    add_atom(s, 14.027, {along, static_cast<double>(i % 2) * bond * std::cos(half), 0}, random);
  }
  ConstraintSet set(options);
  for (Index i = 0; i < bonds; ++i) set.add(s, Distance{}, {i, i + 1});
  return made(name, std::move(s), std::move(set), 200'000);
}

Case triangles(const std::string& name, Index molecules, const ConstraintOptions& options) {
  std::mt19937 random(1);
  ParticleSystem<double> s(unit_system("molecular"));
  ConstraintSet set(options);
  const double angle = 109.47 * M_PI / 180;
  for (Index m = 0; m < molecules; ++m) {
    const Vec3<double> x(0.31 * static_cast<double>(m % 10), 0.31 * static_cast<double>(m / 10), 0);
    add_atom(s, 15.9994, x, random);
    add_atom(s, 1.008, x + Vec3<double>(0.1, 0, 0), random);
    add_atom(s, 1.008, x + Vec3<double>(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0), random);
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      set.add(s, Distance{}, {3 * m + a, 3 * m + b});
    }
  }
  return made(name, std::move(s), std::move(set), 200'000);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("constraints", count, arguments);
  set_thread_count(1);
  const ConstraintOptions newton, sweeps{.solver = ConstraintMethod::rattle, .tolerance = 1e-7};
  std::vector<Case> cases;
  cases.push_back(chain("chain10/newton", 10, newton));
  cases.push_back(chain("chain100/newton", 100, newton));
  cases.push_back(chain("chain10000/newton", 10'000, newton));
  cases.push_back(chain("chain10/rattle", 10, sweeps));
  cases.push_back(chain("chain100/rattle", 100, sweeps));
  cases.push_back(triangles("triangles100/newton", 100, newton));
  cases.push_back(triangles("triangles100/rattle", 100, sweeps));
  for (Case& one : cases) {  // warm-up
    one.slice();
    one.cost.clear();
  }
  std::vector<double> scaling;
  for (int k = 0; k < 20; ++k) {
    for (Case& one : cases) one.slice();
    scaling.push_back(cases[2].cost.back() / cases[1].cost.back());
  }
  for (const Case& one : cases) {
    rows.add(one.name, "ns_per_constraint_step", bench::Measured(one.cost), "ns", one.set.equations());
    rows.add(one.name, "violation_max", bench::Measured({one.violation}), "1", one.set.equations());
  }
  rows.add("chain10000_over_100", "cost_scaling", bench::Measured(scaling), "1", 10'000);
}
