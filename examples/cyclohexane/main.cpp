// 96 rings of cyclohexane that start as boats, hot enough to turn into chairs while one looks.
#include "constraints/constraint_residual.hpp"
#include "constraints/structure_constraints.hpp"
#include "engine/simulation.hpp"
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
#include <vector>

using namespace noether;
using namespace noether::units::molecular;  // nm, ps, kJ/mol, K

/// A monitor of this program's own: the part of the rings whose six dihedral angles have signs by turns, as in a chair.
struct Chairs {
  std::vector<double> part;  ///< at each look

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    double chairs = 0;
    for (Index ring = 0; ring < s.size(); ring += 6) {
      const auto bond = [&](Index k) {  // from corner k to the next
        const Index from = ring + k % 6, to = ring + (k + 1) % 6;
        return s.box().minimum_image(Vec3<double>(s.positions()[to] - s.positions()[from]));
      };
      int by_turns = 0;
      for (Index k = 0; k < 6; ++k) {
        const bool positive = dot(bond(k), cross(bond(k + 1), bond(k + 2))) > 0;
        by_turns += positive == (k % 2 == 0) ? 1 : -1;
      }
      if (by_turns == 6 || by_turns == -6) ++chairs;
    }
    part.push_back(6 * chairs / static_cast<double>(s.size()));
  }
};

int main() {
  ParticleSystem carbons = io::read_structure(
      "cyclohexane.data", {.file_units = "real", .special = {{0, 0, 0}}, .mixing = Mixing::lorentz_berthelot});
  set_temperature(carbons, 600 * K, 1);
  const ConstraintSet rigid = bonds(carbons);
  leave_out_rigid_terms(carbons, rigid);

  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 1.2 * nm, .cutoff_style = Cutoff::switch_c4});
  forces.add(Bonded{});
  const Minimized start = minimize(carbons, AnyForce<double>(forces), rigid, {.max_force = 100 * kJ_per_mol / nm});

  auto bath = VelocityRescaling(KineticPotential(forces, rigid),
                                {.temperature = 600 * K, .relaxation_time = 0.5 * ps, .seed = 1});
  Simulation sim(std::move(carbons), compose(std::move(bath), word("VBABV")), 4 * fs);
  auto& energy = sim.every(10, Energy{});
  auto& temperature = sim.every(10, Temperature{});
  auto& residual = sim.every(10, ConstraintResidual(rigid));
  auto& chairs = sim.every(250, Chairs{});
  sim.every(250, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(10'000);
  const std::vector<double>& part = chairs.part;
  fmt::print("{}: temperature {:.1f} K of {} degrees of freedom\n", outcome, temperature.value(),
             temperature.degrees_of_freedom());
  fmt::print("the start was found in {} steps downhill, to a largest force of {:.1f} kJ/mol/nm\n", start.steps,
             start.force);
  fmt::print("drift of the conserved energy {:.1e}/ps, worst bond error {:.1e}\n", energy.slope(), residual.worst());
  fmt::print("chairs among the rings: {:.2f} at the start, {:.2f} half way, {:.2f} at the end\n", part.front(),
             part[part.size() / 2], part.back());
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
