#pragma once
/// The programs of examples/, as functions that a test calls: each main.cpp in a namespace of its own, its calls of
/// `run` and `run_until` made as short as `shortened` says. One file includes this.

#include "examples/bead_on_wire/cycloid.hpp"
#include "examples/beads_on_sphere/sphere_attraction.hpp"
#include "examples/oblate_saturn/oblateness.hpp"
#include "examples/pendulum_by_its_action/action.hpp"
#include "examples/robertson/kinetics.hpp"

#include "constraints/constraint_residual.hpp"
#include "constraints/constraint_set.hpp"
#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/structure_constraints.hpp"
#include "constraints/surfaces.hpp"
#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "engine/given_orbit.hpp"
#include "engine/simulation.hpp"
#include "engine/sites.hpp"
#include "engine/sphere_columns.hpp"
#include "engine/statistics.hpp"
#include "engine/topology.hpp"
#include "forces/anharmonic_chain.hpp"
#include "forces/bonded.hpp"
#include "forces/check_gradient.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/hyperelastic.hpp"
#include "forces/lattice_accuracy.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/linear_drag.hpp"
#include "forces/on_sites.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/minimize.hpp"
#include "integrators/projected.hpp"
#include "integrators/rotating.hpp"
#include "integrators/shearing_sheet.hpp"
#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/schwarzschild.hpp"
#include "integrators/systems/weber.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "integrators/velocity_rescaling.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/bodies.hpp"
#include "io/body_sites.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/charges.hpp"
#include "monitors/dihedrals.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/pressure.hpp"
#include "monitors/radial_distribution.hpp"
#include "monitors/ring_monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/spin.hpp"
#include "monitors/temperature.hpp"
#include "monitors/time_correlation.hpp"
#include "monitors/turning.hpp"
#include "monitors/variables.hpp"
#include "numbers/elliptic.hpp"
#include "numbers/quantity.hpp"
#include "numbers/units.hpp"
#include "scene/block.hpp"
#include "scene/builders.hpp"
#include "scene/constrained.hpp"
#include "scene/ionic_crystal.hpp"
#include "scene/ring_patch.hpp"
#include "scene/run.hpp"
#include "scene/water_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace examples {

/// How many steps a program makes, if not all of them.
inline std::optional<std::int64_t> shortened;

}  // namespace examples

#define main program
namespace examples::bead_on_wire_from_scene {
#include "examples/bead_on_wire/from_scene.cpp"
}
namespace examples::beads_on_sphere_from_scene {
#include "examples/beads_on_sphere/from_scene.cpp"
}
namespace examples::heavy_top {
#include "examples/heavy_top/main.cpp"
}
namespace examples::oblate_saturn_from_scene {
#include "examples/oblate_saturn/from_scene.cpp"
}
namespace examples::robertson_from_scene {
#include "examples/robertson/from_scene.cpp"
}
// Methods that choose their steps end in time: they are never shortened.
namespace examples::heat_line {
#include "examples/heat_line/main.cpp"
}
namespace examples::robertson {
#include "examples/robertson/main.cpp"
}
#define run(steps) run(examples::shortened.value_or(steps))
#define run_until(end) run(sim.steps_in(end) - sim.step())
namespace examples::accelerator {
#include "examples/accelerator/main.cpp"
}
namespace examples::alkane_liquid {
#include "examples/alkane_liquid/main.cpp"
}
namespace examples::argon_crystal {
#include "examples/argon_crystal/main.cpp"
}
namespace examples::asteroid_binary {
#include "examples/asteroid_binary/main.cpp"
}
namespace examples::bead_on_wire {
#include "examples/bead_on_wire/main.cpp"
}
namespace examples::beads_on_sphere {
#include "examples/beads_on_sphere/main.cpp"
}
namespace examples::butane {
#include "examples/butane/main.cpp"
}
namespace examples::chain {
#include "examples/chain/main.cpp"
}
namespace examples::chain_of_10000 {
#include "examples/chain_of_10000/main.cpp"
}
namespace examples::cyclohexane {
#include "examples/cyclohexane/main.cpp"
}
namespace examples::decane {
#include "examples/decane/main.cpp"
}
namespace examples::double_pendulum {
#include "examples/double_pendulum/main.cpp"
}
namespace examples::driven_oscillator {
#include "examples/driven_oscillator/main.cpp"
}
namespace examples::fene_melt {
#include "examples/fene_melt/main.cpp"
}
namespace examples::fermi_pasta_ulam {
#include "examples/fermi_pasta_ulam/main.cpp"
}
namespace examples::figure_eight {
#include "examples/figure_eight/main.cpp"
}
namespace examples::henon_heiles {
#include "examples/henon_heiles/main.cpp"
}
namespace examples::ion_pair {
#include "examples/ion_pair/main.cpp"
}
namespace examples::kepler {
#include "examples/kepler/main.cpp"
}
namespace examples::kepler_projected {
#include "examples/kepler_projected/main.cpp"
}
namespace examples::lj_melt {
#include "examples/lj_melt/main.cpp"
}
namespace examples::oblate_saturn {
#include "examples/oblate_saturn/main.cpp"
}
namespace examples::moonlet {
#include "examples/moonlet/main.cpp"
}
namespace examples::outer_solar_system {
#include "examples/outer_solar_system/main.cpp"
}
namespace examples::pendulum {
#include "examples/pendulum/main.cpp"
}
namespace examples::pendulum_by_its_action {
#include "examples/pendulum_by_its_action/main.cpp"
}
namespace examples::penning_trap {
#include "examples/penning_trap/main.cpp"
}
namespace examples::pythagorean {
#include "examples/pythagorean/main.cpp"
}
namespace examples::rigid_water {
#include "examples/rigid_water/main.cpp"
}
namespace examples::saturn_rings {
#include "examples/saturn_rings/main.cpp"
}
namespace examples::schwarzschild {
#include "examples/schwarzschild/main.cpp"
}
namespace examples::sleeping_top {
#include "examples/sleeping_top/main.cpp"
}
namespace examples::sodium_chloride {
#include "examples/sodium_chloride/main.cpp"
}
namespace examples::solar_system {
#include "examples/solar_system/main.cpp"
}
namespace examples::spherical_pendulum {
#include "examples/spherical_pendulum/main.cpp"
}
namespace examples::spce_water {
#include "examples/spce_water/main.cpp"
}
namespace examples::spin_orbit {
#include "examples/spin_orbit/main.cpp"
}
namespace examples::template_project {
#include "examples/template_project/main.cpp"
}
namespace examples::tennis_racket {
#include "examples/tennis_racket/main.cpp"
}
namespace examples::tokamak_banana {
#include "examples/tokamak_banana/main.cpp"
}
namespace examples::tumbling_block {
#include "examples/tumbling_block/main.cpp"
}
namespace examples::two_phase_slab {
#include "examples/two_phase_slab/main.cpp"
}
namespace examples::van_allen {
#include "examples/van_allen/main.cpp"
}
namespace examples::weber_pair {
#include "examples/weber_pair/main.cpp"
}
namespace examples::water_box {
#include "examples/water_box/main.cpp"
}
#undef run_until
#undef run
#undef main
