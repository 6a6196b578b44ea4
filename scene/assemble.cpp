#include "scene/scene.hpp"

#include "forces/on_sites.hpp"
#include "forces/sum.hpp"
#include "integrators/canonical_charges.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/hamiltonian_motion.hpp"
#include "integrators/lie/body_motion.hpp"
#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "numbers/parallel.hpp"
#include "scene/default_watches.hpp"
#include "scene/tangents.hpp"

#include <algorithm>
#include <iterator>

namespace noether {

namespace {

/// Larger than any run: a cadence of this many steps looks at step 0 only.
constexpr std::int64_t once = std::int64_t{1} << 62;

void attach_monitors(Simulation<double>& sim, const Scene& scene) {
  const Watched watched = detail::watched_of(scene);
  for (const SceneWatch& watch : scene.watches) {
    if (watch.kind == SceneWatch::Kind::monitor) {
      detail::attach(sim, watch.cadence, watch.monitor.make(watched));
    }
  }
}

void attach_writers(Simulation<double>& sim, const Scene& scene, const SceneFiles& files) {
  bool frames = false, samples = false;
  for (const SceneWatch& watch : scene.watches) {
    samples = samples || watch.kind == SceneWatch::Kind::monitor;
    if (watch.kind != SceneWatch::Kind::trajectory || files.trajectory.empty()) continue;
    frames = true;
    detail::attach(
        sim, watch.cadence,
        io::TrajectoryWriter(files.trajectory,
                             {.scene_toml = scene.effective_toml, .lost = files.lost, .sites = watch.sites}));
  }
  if (!frames && samples && !files.trajectory.empty()) {
    sim.every(once, io::TrajectoryWriter(files.trajectory,
                                         {.frames = false, .scene_toml = scene.effective_toml, .lost = files.lost}));
  }
}

void attach_checkpoints(Simulation<double>& sim, const Scene& scene, const SceneFiles& files) {
  if (files.checkpoint.empty()) return;
  const io::CheckpointWriter writer(files.checkpoint, scene.effective_toml, mark_of_kept_watches(scene));
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

ConstraintSet SceneHamiltonian::constraint_set(const ParticleSystem<double>& particles, std::size_t tables) const {
  ConstraintSet set(constraint_options);
  for (const SceneConstraint& constraint : constraints) {
    if (tables-- == 0) break;
    constraint.add_to(set, particles);
  }
  return set;
}

ConstraintSet constraints_of(const Scene& scene, std::size_t tables) {
  return scene.hamiltonian.constraint_set(scene.particles, tables);
}

std::vector<SceneForce> SceneHamiltonian::terms() const {
  std::vector<SceneForce> all = splitting.own;
  std::copy_if(forces.begin(), forces.end(), std::back_inserter(all), [](const SceneForce& f) { return !f.letter; });
  return all;
}

bool SceneHamiltonian::is_keplerian() const {
  const std::vector<SceneForce> all = terms();
  return std::any_of(all.begin(), all.end(), [](const SceneForce& f) { return f.force.claims().kepler; });
}

namespace {

/// @throws SchemeMismatch  if the part gives no letter of its own: another one would hide it
AnyHamiltonian<double> with_part(AnyHamiltonian<double> hamiltonian, const SceneLetter& letter,
                                 const std::string& name) {
  const std::string before = hamiltonian.claims().alphabet;
  AnyHamiltonian<double> made = letter(std::move(hamiltonian));
  for (const char one : made.claims().alphabet.substr(before.size())) {
    if (before.find(one) == std::string::npos) continue;
    throw SchemeMismatch(
        fmt::format("the letter {} of '{}' is already in the Hamiltonian; take one of the two out", one, name));
  }
  return made;
}

}  // namespace

void SceneHamiltonian::check_kicks(const std::string& kicks) const {
  for (const SceneForce& force : forces) {
    const std::string own = force.force.claims().kicks;
    if (force.letter || own.find_first_not_of(kicks) == std::string::npos) continue;
    throw SchemeMismatch(fmt::format("force '{}' is in the kick {}, but '{}' has only {}; take its kick out",
                                     force.name, own, splitting.name, kicks));
  }
}

template <class Real> ForceField<Real> SceneHamiltonian::on_bodies(const ForceField<Real>& all) const {
  if (!rotating) return all;
  ForceField<Real> parted, on_sites;
  for (const AnyForce<Real>& force : all.terms()) (force.claims().on_bodies ? parted : on_sites).add(force);
  if (!on_sites.terms().empty()) parted.add(OnSites<Real>(std::move(on_sites)));
  return parted;
}
AnyForce<double> SceneHamiltonian::on_bodies(const AnyForce<double>& force) const {
  if (!rotating || force.claims().on_bodies) return force;
  return AnyForce<double>(OnSites<double>(ForceField<double>().add(force)));
}
template <class Real> ForceField<Real> SceneHamiltonian::all_on_bodies(const ForceField<Real>& all) const {
  if (!rotating) return all;
  ForceField<Real> at_centres, others;
  for (std::size_t k = 0; k < all.terms().size(); ++k) {
    (k < splitting.own.size() ? at_centres : others).add(all.terms()[k]);
  }
  const ForceField<Real> placed = on_bodies(others);
  for (const AnyForce<Real>& force : placed.terms()) at_centres.add(force);
  return at_centres;
}
template ForceField<double> SceneHamiltonian::on_bodies(const ForceField<double>&) const;
template ForceField<Quad> SceneHamiltonian::on_bodies(const ForceField<Quad>&) const;
template ForceField<double> SceneHamiltonian::all_on_bodies(const ForceField<double>&) const;
template ForceField<Quad> SceneHamiltonian::all_on_bodies(const ForceField<Quad>&) const;

AnyHamiltonian<double> SceneHamiltonian::make(const ParticleSystem<double>& particles) const {
  ForceField<double> kicking;
  for (const SceneForce& force : forces) {
    if (force.letter) continue;
    if (force.force.claims().velocity_dependent && !splitting.claims().velocity_forces) {
      if (force.force.claims().gyrates) {
        throw SchemeMismatch(fmt::format(
            "field '{}' turns velocities, which no kick of {} does; use the Hamiltonian 'charged_particles', "
            "or a method for y' = f, such as 'gauss_8'",
            force.name, splitting.name));
      }
      throw SchemeMismatch(
          fmt::format("force '{}' depends on velocities, so no kick is its exact flow; use a method for "
                      "y' = f, such as 'gauss_radau_15' or 'dop853'",
                      force.name));
    }
    kicking.add(force.force);
  }
  kicking = on_bodies(kicking);
  AnyHamiltonian<double> hamiltonian = constraints.empty()
                                           ? splitting.make(std::move(kicking))
                                           : splitting.make_constrained(std::move(kicking), constraint_set(particles));
  if (neighbors) hamiltonian.set_neighbor_options(*neighbors);
  if (rotating) hamiltonian = Rotating<AnyHamiltonian<double>>(std::move(hamiltonian), *rotating);
  for (const SceneForce& force : forces) {
    if (force.letter) hamiltonian = with_part(std::move(hamiltonian), force.letter, force.name);
  }
  // Outermost, because noise is walked by whole steps.
  if (thermostat) hamiltonian = with_part(std::move(hamiltonian), thermostat->letter, thermostat->name);
  return hamiltonian;
}

std::optional<Rotor> rotor_of(const Scene& scene) {
  if (scene.integrator.classical || !scene.hamiltonian.rotating) return {};
  const std::optional<Rotor> own = rotor_of(scene.integrator.scheme.rotor);
  return own ? own : scene.hamiltonian.rotating->rotor;
}

AnyHamiltonian<double> hamiltonian_of(const Scene& scene) {
  const std::optional<Rotor> rotor = rotor_of(scene);
  if (!rotor || *rotor == scene.hamiltonian.rotating->rotor) return scene.hamiltonian.make(scene.particles);
  SceneHamiltonian turned = scene.hamiltonian;
  turned.rotating->rotor = *rotor;
  return turned.make(scene.particles);
}

ForceField<double> forces_of(const Scene& scene) {
  ForceField<double> forces;
  for (const std::vector<SceneForce>* list : {&scene.hamiltonian.splitting.own, &scene.hamiltonian.forces}) {
    for (const SceneForce& force : *list) forces.add(force.force);
  }
  return forces;
}

std::unique_ptr<VectorField<double>> field_of(const Scene& scene) {
  if (scene.system) return scene.system->field();
  const SceneSplitting& splitting = scene.hamiltonian.splitting;
  if (scene.integrator.on_groups() && scene.hamiltonian.rotating) {
    return std::make_unique<BodyMotion<double>>(scene.hamiltonian.all_on_bodies(forces_of(scene)),
                                                group_options_of(scene.integrator.classical->options), splitting.name);
  }
  if (splitting.only_forces) {
    return std::make_unique<ForceMotion<ForceField<double>, double>>(forces_of(scene), splitting.name);
  }
  ForceField<double> kicks, letters;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const bool beside = force.letter || (force.force.claims().velocity_dependent &&
                                         !splitting.claims().velocity_forces);  // no part of the splitting
    (beside ? letters : kicks).add(force.force);
  }
  return std::make_unique<HamiltonianMotion<double>>(splitting.make(std::move(kicks)), std::move(letters),
                                                     forces_of(scene).claims());
}

bool moves_momenta(const Scene& scene) {
  const SceneSplitting& splitting = scene.hamiltonian.splitting;
  const std::vector<SceneForce>& forces = scene.hamiltonian.forces;
  const auto gyrates = [](const SceneForce& force) { return force.force.claims().gyrates; };
  if (!scene.integrator.classical || scene.system || !splitting.only_forces) return false;
  if (std::none_of(forces.begin(), forces.end(), gyrates)) return false;
  const auto& [info, options] = *scene.integrator.classical;
  const MethodClaims method = make_method<double>(*info, options)->claims();
  return !method.second_order_only && (splitting.canonical || method.of_momenta);
}

Clock<double> clock_of(const SceneIntegrator& integrator) {
  return integrator.adaptive() ? Clock<double>::free(integrator.start, integrator.direction())
                               : Clock<double>::fixed(integrator.start, integrator.step);
}

AnyIntegrator<double> integrator_of(const Scene& scene, std::size_t decorators) {
  const SceneIntegrator& made = scene.integrator;
  AnyIntegrator<double> integrator = [&]() -> AnyIntegrator<double> {
    if (moves_momenta(scene)) {
      return Classical<double>(
          std::make_unique<CanonicalCharges<double>>(forces_of(scene), scene.hamiltonian.splitting.name),
          *made.classical);
    }
    if (made.classical) return Classical<double>(field_of(scene), *made.classical);
    AnyHamiltonian<double> hamiltonian = hamiltonian_of(scene);
    scene.hamiltonian.check_kicks(hamiltonian.claims().kicks);
    return Composition<AnyHamiltonian<double>>(std::move(hamiltonian), scheme_of(made), made.composition);
  }();
  if (made.decorators.empty()) return integrator;
  const ConstraintSet constraints = constraints_of(scene);
  for (const SceneDecorator& decorator : made.decorators) {
    if (decorators-- == 0) break;
    integrator = decorator.around(std::move(integrator), constraints);
  }
  return integrator;
}

namespace detail {

Watched watched_of(const Scene& scene) {
  Watched watched{.constraints = constraints_of(scene), .symmetries = {}, .charges = {}, .momenta = {}, .tangents = {}};
  watched.tangents.make = [&scene](Index changes) { return tangents_of(scene, changes); };
  if (scene.system) {
    watched.symmetries = scene.system->symmetries;
    watched.momenta = scene.system->momenta;
  }
  for (const SceneForce& term : scene.hamiltonian.terms()) {
    const ForceClaims claims = term.force.claims();
    if (!claims.kepler) continue;
    watched.gravity = claims;
    watched.gravity.G = claims.G.value_or(scene.units->G);
  }
  watched.charges = {fields_among(forces_of(scene)).terms(), scene.hamiltonian.splitting.c};
  return watched;
}

Simulation<double> assemble_start(const Scene& scene) {
  Simulation<double> sim(scene.particles, integrator_of(scene), clock_of(scene.integrator));
  if (!scene.default_watches) attach_monitors(sim, scene);
  for (const SceneStop& stop : scene.stops) sim.stop_when(stop.rule, stop.steps);
  return sim;
}

}  // namespace detail

namespace {

/// The start of a run, with the files it writes and what a scene without [[every]] is given.
Simulation<double> completed(Simulation<double> sim, const Scene& scene, const SceneFiles& files) {
  if (scene.default_watches && files.by_default) attach_monitors(sim, scene);
  if (!scene.default_watches || files.by_default) attach_writers(sim, scene, files);
  attach_checkpoints(sim, scene, files);
  return sim;
}

}  // namespace

Simulation<double> assemble(const Scene& scene, const SceneFiles& files) {
  return completed(detail::assemble_start(scene), scene, files);
}

SceneRun::SceneRun(Scene scene, Simulation<double> start)
    : scene_(std::move(scene)), start_(std::move(start)), simd_(simd_level()), threads_(thread_count()) {}

Simulation<double> SceneRun::assemble(const SceneFiles& files) {
  // What was bound for other kernels or threads is made anew.
  if (!start_ || simd_ != simd_level() || threads_ != thread_count()) return noether::assemble(scene_, files);
  Simulation<double> sim = std::move(*start_);
  start_.reset();
  return completed(std::move(sim), scene_, files);
}

}  // namespace noether
