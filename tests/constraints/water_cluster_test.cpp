/// A drop of rigid water by the solvers that solve molecules side by side to rounding: orders, the way back, momentum.

#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "monitors/monitors.hpp"
#include "scene/constrained.hpp"
#include "scene/water_box.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace noether::water_cluster {
namespace {

using namespace units::molecular;

/// 27 molecules of SPC/E in a box in which forces end with four derivatives, at rest in a minimum, then warmed.
struct Drop {
  ForceField<double> forces;
  ParticleSystem<double> water;
  ConstraintSet rigid;

  explicit Drop(ConstraintMethod solver)
      : water(WaterBox{
            .model = WaterModel::spce, .molecules = 27, .density = 0.997 * g_per_cm3, .temperature = 200 * K, .seed = 5}
                  .build()),
        rigid(ConstraintOptions{.solver = solver}) {
    forces.add(LennardJonesForce{.cutoff = 0.45 * nm, .cutoff_style = Cutoff::switch_c4, .switch_from = 0.3 * nm});
    forces.add(ReactionFieldForce{{.radius = 0.45 * nm, .switched_from = 0.3 * nm}});
    const ConstraintSet bonds = rigid_molecules(water);
    minimize(water, AnyForce<double>(forces), bonds, {.max_force = 300 * kJ_per_mol / nm});
    for (Index e = 0; e < bonds.equations(); ++e) {
      const auto* distances = dynamic_cast<const ConstraintsOf<Distance>*>(bonds.place(e).group);
      REQUIRE(distances != nullptr);
      const Index c = bonds.place(e).constraint;
      rigid.add(water, distances->constraint(c), {distances->particle(c, 0), distances->particle(c, 1)});
    }
  }
  Simulation<double> run_by(const Scheme& scheme, double h) const {
    return Simulation<double>(water, compose(KineticPotential(forces, rigid), scheme), h);
  }
  /// Largest distance of an atom, after a time, from where a run with a quarter of the step has it.
  double error(const Scheme& scheme, double h, Index steps) const {
    Simulation<double> coarse = run_by(scheme, h), fine = run_by(scheme, h / 4);
    REQUIRE(coarse.run(steps).ok());
    REQUIRE(fine.run(4 * steps).ok());
    double worst = 0;
    for (Index i = 0; i < water.size(); ++i)
      worst = std::max(worst, (coarse.particles().unwrapped(i) - fine.particles().unwrapped(i)).norm());
    return worst;
  }
};

constexpr std::array solvers{ConstraintMethod::newton, ConstraintMethod::settle, ConstraintMethod::m_shake};

TEST_CASE("compositions have orders 2, 4 and 6 on rigid water", "[constraints][order]") {
  struct Case {
    const Scheme* scheme;
    double step;
    Index steps;
    int order;
  };
  for (const ConstraintMethod solver : solvers) {
    const Drop drop(solver);
    for (const Case& one : {Case{&schemes::verlet, 1 * fs, 20, 2}, Case{&schemes::yoshida_4, 0.5 * fs, 40, 4},
                            Case{&schemes::kahan_li_6_s9, 1 * fs, 20, 6}}) {
      const double slope = std::log2(drop.error(*one.scheme, one.step, one.steps) /
                                     drop.error(*one.scheme, one.step / 2, 2 * one.steps));
      CAPTURE(info_of(solver).name, one.scheme->name);
      CHECK(std::abs(slope - one.order) < 0.25);
    }
  }
}

TEST_CASE("a hundred steps of rigid water forth and back return to rounding, and keep momentum",
          "[constraints][reversible]") {
  for (const ConstraintMethod solver : solvers) {
    const Drop drop(solver);
    Simulation<double> sim = drop.run_by(schemes::verlet, 1 * fs);
    const ParticleSystem<double> start = sim.particles();
    const auto momentum = [](const ParticleSystem<double>& s) {
      Vec3<double> sum = Vec3<double>::Zero();
      for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.velocities()[i];
      return sum;
    };
    REQUIRE(sim.run(100).ok());
    CHECK((momentum(sim.particles()) - momentum(start)).norm() < 1e-11);  // beside 80 molecules' 18 u at 0.4 nm/ps
    sim.change_step(-1 * fs);
    REQUIRE(sim.run(100).ok());
    double apart = 0;
    for (Index i = 0; i < start.size(); ++i)
      apart = std::max(apart, (sim.particles().unwrapped(i) - start.unwrapped(i)).norm());
    CAPTURE(info_of(solver).name, apart);
    CHECK(apart < 1e-11);
  }
}

}  // namespace
}  // namespace noether::water_cluster
