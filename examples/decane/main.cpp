// Liquid decane whose bonds are rigid: brought to a minimum along its constraints, then kept at 298 K.
#include "constraints/constraint_residual.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
#include "engine/statistics.hpp"
#include "forces/bonded.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/velocity_rescaling.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/dihedrals.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "numbers/units.hpp"
#include "scene/builders.hpp"
#include "scene/constrained.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

constexpr Index carbons_of_one = 10;

/// A monitor of this program's own: how long chains are from end to end, mean over chains.
struct EndToEnd {
  SeriesStatistics length;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    double sum = 0;
    for (Index first = 0; first < s.size(); first += carbons_of_one) {
      Vec3<double> end(0, 0, 0);
      for (Index i = first + 1; i < first + carbons_of_one; ++i) {
        end += s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[i - 1]));
      }
      sum += std::sqrt(norm2(end));
    }
    length.add(now.time(), sum / static_cast<double>(s.size() / carbons_of_one));
  }
};

int main() {
  ParticleSystem carbons =
      io::read_structure("decane.data", {.file_units = "real", .mixing = Mixing::lorentz_berthelot});
  set_temperature(carbons, 298 * K, 1);
  const ConstraintSet rigid = bonds(carbons);
  leave_out_rigid_terms(carbons, rigid);

  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 1.2 * nm, .cutoff_style = Cutoff::switch_c4});
  forces.add(Bonded{});
  const Minimized start = minimize(carbons, AnyForce<double>(forces), rigid, {.max_force = 100 * kJ_per_mol / nm});

  auto bath = VelocityRescaling(KineticPotential(forces, rigid),
                                {.temperature = 298 * K, .relaxation_time = 0.5 * ps, .seed = 1});
  Simulation sim(std::move(carbons), compose(std::move(bath), word("VBABV")), 4 * fs);
  auto& energy = sim.every(10, Energy{});
  auto& temperature = sim.every(10, Temperature{});
  auto& residual = sim.every(10, ConstraintResidual(rigid));
  auto& angles = sim.every(10, Dihedrals{});
  auto& ends = sim.every(10, EndToEnd{});
  sim.every(250, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(7500);
  fmt::print("{}: temperature {:.1f} K of {} degrees of freedom\n", outcome, temperature.value(),
             temperature.degrees_of_freedom());
  fmt::print("the start was found in {} steps downhill, to a largest force of {:.1f} kJ/mol/nm\n", start.steps,
             start.force);
  fmt::print("drift of the conserved energy {:.1e}/ps, worst bond error {:.1e}\n", energy.slope(), residual.worst());
  fmt::print("trans {:.3f}; chains are {:.3f} nm long from end to end\n", angles.fractions()[0], ends.length.mean());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
