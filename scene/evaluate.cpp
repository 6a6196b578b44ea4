#include "scene/evaluate.hpp"

#include "engine/bodies.hpp"
#include "engine/sites.hpp"
#include "forces/check_gradient.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/pressure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace noether {

namespace {

std::string numbered(const std::string& name, const std::vector<std::pair<std::string, double>>& taken) {
  std::string result = name;
  const auto is_taken = [&] {
    return std::any_of(taken.begin(), taken.end(), [&](const auto& term) { return term.first == result; });
  };
  for (int k = 2; is_taken(); ++k) result = fmt::format("{}_{}", name, k);
  return result;
}

Outcome outcome_of(const Failure& failure, const ParticleSystem<double>& s) {
  Outcome outcome;
  outcome.kind = failure.kind;
  outcome.quantity = failure.quantity;
  outcome.message = failure.message;
  if (failure.particle >= 0) {
    outcome.particle =
        ParticleRef{failure.particle, s.ids()[static_cast<std::size_t>(failure.particle)], s.name(failure.particle)};
  }
  return outcome;
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What a Hamiltonian has beside forces: its own energy as one more term, and all that it does to the particles.
/// Forces that depend on velocities are no part of it, and are added to that.
void add_hamiltonian(const Scene& scene, ParticleSystem<double>& s, Evaluation& result) {
  Scene split = scene;
  std::erase_if(split.hamiltonian.forces,
                [](const SceneForce& force) { return !force.letter && force.force.claims().velocity_dependent; });
  AnyHamiltonian<double> hamiltonian = hamiltonian_of(split);
  hamiltonian.bind(s);
  const EnergyTerms<double> energy = hamiltonian.energy(s);
  result.kinetic = energy.kinetic;
  double of_forces = 0;  // as far as they have one
  for (const auto& [name, potential] : result.terms) of_forces += std::isnan(potential) ? 0 : potential;
  const double own = scene.hamiltonian.splitting.claims().energy ? energy.potential - of_forces : nan;
  result.terms.emplace_back(scene.hamiltonian.splitting.name, own);
  result.potential = std::isnan(result.potential) || std::isnan(own) ? nan : energy.potential;
  const bool all = split.hamiltonian.forces.size() == scene.hamiltonian.forces.size();
  const std::optional<Mat3<double>> virial = hamiltonian.virial(s);
  result.virial = all && virial ? *virial : Mat3<double>(Mat3<double>::Constant(nan));
  VectorColumn<double> a(s.size());
  hamiltonian.accelerations(s, a);
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.letter || !force.force.claims().velocity_dependent) continue;
    VectorColumn<double> more(s.size());
    ForceSink<double> sink(more, s, Request{});
    AnyForce<double> bound = force.force;
    bind_force(bound, s);
    bound.add_to(sink, s);
    for (Index i = 0; i < s.size(); ++i) a.add(i, std::as_const(more)[i]);
  }
  for (Index i = 0; i < s.size(); ++i) result.forces.set(i, std::as_const(s).masses()[i] * std::as_const(a)[i]);
}

}  // namespace

Evaluation evaluate(const Scene& scene, bool check) {
  if (scene.system) {
    const bool has_energy = field_of(scene)->claims().energy;
    throw SceneError(
        fmt::format("there is nothing to evaluate: system '{}' has {}; {}`noether explain` shows how stiff it is",
                    scene.system->name, has_energy ? "no forces on particles" : "neither energy nor forces",
                    has_energy ? "the monitor 'energy' shows its energy, and " : ""),
        {.file = scene.source.file, .key = "system"});
  }
  ParticleSystem<double> s = scene.particles;
  s.clock() = Clock<double>::fixed(scene.integrator.start, scene.integrator.step);
  Evaluation result;
  result.forces = VectorColumn<double>(s.size());
  result.kinetic = kinetic_energy(s);
  if (has_bodies(s)) result.kinetic += turning_energy_of(s);
  result.gradient_asked = check ? particles_asked(s.size()) : 0;
  VectorColumn<double> a(s.size());
  // Constraints have a part in the virial, which is not looked at here.
  bool has_pressure =
      s.box().is_periodic() && scene.hamiltonian.constraints.empty() && !(has_bodies(s) && s.bodies()->any_held());
  std::size_t own = scene.hamiltonian.splitting.own.size();  // these pull at centres of bodies
  std::vector<SceneForce> terms = scene.hamiltonian.terms();
  // Where a splitting has forces of its own that know no box, it knows the box itself: images slide there.
  const std::vector<SceneForce>& inside = scene.hamiltonian.splitting.own;
  const bool whole = !scene.hamiltonian.splitting.only_forces ||
                     (s.box().is_periodic() && std::any_of(inside.begin(), inside.end(), [](const SceneForce& force) {
                        return !force.force.claims().periodic;
                      }));
  if (scene.hamiltonian.splitting.only_forces && whole) terms.clear();
  for (const SceneForce& force : scene.hamiltonian.forces) {  // a letter of its own that has a potential: tides
    if (force.letter && force.force.claims().on_bodies) terms.push_back(force);
  }
  for (const SceneForce& term : terms) {
    ForceSink<double> sink(a, s, {.energy = true, .virial = true});
    AnyForce<double> bound = own > 0 ? term.force : scene.hamiltonian.on_bodies(term.force);
    if (own > 0) --own;
    bind_force(bound, s);
    bound.add_to(sink, s);
    const ForceClaims claims = term.force.claims();
    const bool failed = sink.failure().has_value();
    if (failed && result.outcome.ok()) result.outcome = outcome_of(*sink.failure(), s);
    if (check && !failed) {
      const auto accuracy = lattice_accuracy(term.force, has_bodies(s) ? Sites<double>(s).particles() : s);
      if (accuracy) result.lattices.emplace_back(numbered(term.name, result.terms), *accuracy);
    }
    const double potential = failed || !claims.energy ? nan : sink.potential();
    result.terms.emplace_back(numbered(term.name, result.terms), potential);
    result.potential += potential;
    const bool has_virial = claims.virial && !failed;
    result.virial += has_virial ? sink.virial() : Mat3<double>(Mat3<double>::Constant(nan));
    has_pressure = has_pressure && has_virial;
    for (Index i = 0; i < s.size(); ++i) result.forces.add(i, std::as_const(s).masses()[i] * a[i]);
    if (check && !failed && claims.energy && !claims.velocity_dependent)  // else it is the gradient of nothing
      result.gradient_error = std::max(result.gradient_error.value_or(0), gradient_error(bound, s));
  }
  if (whole) {
    add_hamiltonian(scene, s, result);
    has_pressure = false;
  }
  if (has_pressure) result.pressure = pressure_tensor(s, result.virial).trace() / 3;
  for (Index i = 0; i < s.size(); ++i) {
    result.force_max = std::max(result.force_max, std::sqrt(norm2(std::as_const(result.forces)[i])));
  }
  if (!result.outcome.ok()) {
    result.force_max = nan;
    result.gradient_error.reset();
    result.lattices.clear();
  }
  return result;
}

}  // namespace noether
