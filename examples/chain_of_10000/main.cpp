// One chain of 10 000 rigid links that nothing else holds: a random coil in free flight.
#include "constraints/constraint_residual.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "engine/statistics.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "scene/builders.hpp"
#include "scene/constrained.hpp"

#include <fmt/format.h>

#include <utility>

using namespace noether;

/// A monitor of this program's own: the cosine of the angle by which a link leaves the direction of the one before, and
/// its square, as means along the chain.
struct Bends {
  SeriesStatistics cosine, square;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const auto link = [&](Index i) {
      return s.box().minimum_image(Vec3<double>(s.positions()[i + 1] - s.positions()[i]));
    };
    const double length2 = norm2(link(0));
    const Index joints = s.size() - 2;
    double sum = 0, squares = 0;
    Vec3<double> before = link(0);
    for (Index i = 1; i <= joints; ++i) {
      const Vec3<double> next = link(i);
      const double c = dot(before, next) / length2;
      sum += c;
      squares += c * c;
      before = next;
    }
    if (now.time() < 4.99) return;  // bends forget how the chain was made
    cosine.add(now.time(), sum / static_cast<double>(joints));
    square.add(now.time(), squares / static_cast<double>(joints));
  }
};

int main() {
  ParticleSystem beads =
      PolymerChains{
          .chains = 1, .beads = 10'001, .density = 4e-4, .mass = 1, .bond_length = 1.4, .temperature = 1, .seed = 13}
          .build();
  const ConstraintSet rigid = bonds(beads);

  Simulation sim(std::move(beads), compose(KineticPotential(ForceField<double>{}, rigid), schemes::verlet), 0.05);
  auto& energy = sim.every(1, Energy{});
  auto& residual = sim.every(1, ConstraintResidual(rigid));
  auto& bends = sim.every(5, Bends{});
  sim.every(20, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(400);
  fmt::print("{}: worst energy error {:.1e}, links within {:.0e}\n", outcome, energy.worst(), residual.worst());
  fmt::print("cosine of bends: mean {:.4f}, mean square {:.4f} +- {:.4f}\n", bends.cosine.mean(), bends.square.mean(),
             bends.square.mean_error().value_or(0));
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
