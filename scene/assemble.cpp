#include "scene/scene.hpp"

#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "scene/constrained.hpp"

namespace noether {

namespace {

/// Larger than any run: a cadence of this many steps looks at step 0 only.
constexpr std::int64_t once = std::int64_t{1} << 62;

/// The Hamiltonian as the scene looks for neighbors, in its bath if it has one.
template <class H> AnyHamiltonian<double> in_bath(const Scene& scene, H hamiltonian) {
  if (scene.hamiltonian.neighbors) hamiltonian.set_neighbor_options(*scene.hamiltonian.neighbors);
  if (!scene.hamiltonian.thermostat) return hamiltonian;
  return Langevin<H>(std::move(hamiltonian), *scene.hamiltonian.thermostat);
}

AnyHamiltonian<double> without_drag(const Scene& scene) {
  ForceField<double> forces;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.force) forces.add(*force.force);
  }
  if (!scene.hamiltonian.constraints.empty()) {
    return in_bath(scene, Constrained(std::move(forces), constraints_of(scene)));
  }
  if (scene.hamiltonian.kind == SceneHamiltonian::Kind::kinetic_potential) {
    return in_bath(scene, KineticPotential<ForceField<double>>(std::move(forces)));
  }
  if (forces.terms().empty()) return WisdomHolman<double>(scene.hamiltonian.wisdom_holman);
  return WisdomHolman<double, ForceField<double>>(scene.hamiltonian.wisdom_holman, std::move(forces));
}

void attach_writers(Simulation<double>& sim, const Scene& scene, const SceneFiles& files) {
  bool frames = false, samples = false;
  for (const SceneWatch& watch : scene.watches) {
    samples = samples || watch.kind == SceneWatch::Kind::monitor;
    if (watch.kind != SceneWatch::Kind::trajectory || files.trajectory.empty()) continue;
    frames = true;
    detail::attach(sim, watch.cadence, io::TrajectoryWriter(files.trajectory, {.scene_toml = scene.effective_toml}));
  }
  if (!frames && samples && !files.trajectory.empty()) {
    sim.every(once, io::TrajectoryWriter(files.trajectory, {.frames = false, .scene_toml = scene.effective_toml}));
  }
}

void attach_checkpoints(Simulation<double>& sim, const Scene& scene, const SceneFiles& files) {
  if (files.checkpoint.empty()) return;
  const io::CheckpointWriter writer(files.checkpoint, scene.effective_toml);
  for (const SceneWatch& watch : scene.watches) {
    if (watch.kind == SceneWatch::Kind::checkpoint) detail::attach(sim, watch.cadence, writer);
  }
  if (files.checkpoint_wall > 0) sim.every_wall(files.checkpoint_wall, writer);
}

}  // namespace

Scheme scheme_of(const SceneIntegrator& integrator) {
  Scheme scheme = integrator.scheme;
  scheme.name = integrator.method;
  return scheme;
}

ConstraintSet constraints_of(const Scene& scene, std::size_t tables) {
  ConstraintSet set(scene.hamiltonian.constraint_options);
  for (const SceneConstraint& constraint : scene.hamiltonian.constraints) {
    if (tables-- == 0) break;
    constraint.add_to(set, scene.particles);
  }
  return set;
}

AnyHamiltonian<double> hamiltonian_of(const Scene& scene) {
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.drag) return Damped<AnyHamiltonian<double>>(without_drag(scene), *force.drag);
  }
  return without_drag(scene);
}

ForceField<double> forces_of(const Scene& scene) {
  ForceField<double> forces;
  if (scene.hamiltonian.kind == SceneHamiltonian::Kind::wisdom_holman) {
    forces.add(Gravity{.G = scene.hamiltonian.wisdom_holman.G});
  }
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.force) forces.add(*force.force);
    if (force.drag) forces.add(DragForce{*force.drag});
  }
  return forces;
}

std::unique_ptr<VectorField<double>> field_of(const Scene& scene) {
  if (scene.system) return scene.system->field();
  const bool split = scene.hamiltonian.kind == SceneHamiltonian::Kind::wisdom_holman;
  return std::make_unique<ForceMotion<ForceField<double>, double>>(forces_of(scene),
                                                                   split ? "wisdom_holman" : "kinetic_potential");
}

AnyIntegrator<double> integrator_of(const Scene& scene) {
  const SceneIntegrator& made = scene.integrator;
  if (made.classical) return Classical<double>(field_of(scene), *made.classical);
  return Composition<AnyHamiltonian<double>>(hamiltonian_of(scene), scheme_of(made), {.compensated = made.compensated});
}

Simulation<double> assemble(const Scene& scene, const SceneFiles& files) {
  const SceneIntegrator& own = scene.integrator;
  const auto clock = own.adaptive() ? Clock<double>::free(0, own.direction()) : Clock<double>::fixed(0, own.step);
  Simulation<double> sim(scene.particles, integrator_of(scene), clock);
  const ConstraintSet constraints = constraints_of(scene);
  for (const SceneWatch& watch : scene.watches) {
    if (watch.kind == SceneWatch::Kind::monitor) watch.monitor.attach(sim, watch.cadence, constraints);
  }
  attach_writers(sim, scene, files);
  for (const SceneStop& stop : scene.stops) sim.stop_when(stop.rule, stop.steps);
  attach_checkpoints(sim, scene, files);
  return sim;
}

}  // namespace noether
