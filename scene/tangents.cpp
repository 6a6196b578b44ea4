#include "scene/tangents.hpp"

#include "integrators/tangent_run.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

/// The first part of a run that moves states in a way of its own; empty without one.
std::string moves_otherwise(const Scene& scene) {
  const SceneHamiltonian& h = scene.hamiltonian;
  if (!scene.integrator.decorators.empty()) return fmt::format("'{}'", scene.integrator.decorators.front().name);
  if (h.thermostat) return fmt::format("thermostat '{}'", h.thermostat->name);
  if (!h.constraints.empty()) return fmt::format("constraint '{}'", h.constraints.front().name);
  if (h.rotating) return "turns of rigid bodies";
  if (scene.integrator.on_groups()) return fmt::format("method '{}'", scene.integrator.method);
  return "";
}

/// The first force without derivatives, or the empty name.
std::string without_derivative(const Scene& scene) {
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (!force.force.has_derivative()) return force.name;
  }
  return "";
}

}  // namespace

std::unique_ptr<TangentFlow<double>> tangents_of(const Scene& scene, Index changes) {
  const std::string other = moves_otherwise(scene);
  if (!other.empty())
    throw Error(fmt::format("changes of the state cannot be followed through {}; take it out", other));
  if (const std::string force = without_derivative(scene); !force.empty())
    throw Error(fmt::format("force '{}' is written for doubles only and has no derivatives; take it out", force));
  ParticleSystem<double> start = scene.particles;
  start.clock() = clock_of(scene.integrator);
  if (scene.integrator.classical) {
    if (moves_momenta(scene)) {
      throw Error(
          fmt::format("method '{}' moves charges by their momenta here, which have no derivatives; use 'gauss_8' with "
                      "adaptive = false",
                      scene.integrator.method));
    }
    return tangent_flow<double>(field_of(scene), *scene.integrator.classical, start, changes);
  }
  return tangent_flow(hamiltonian_of(scene), scheme_of(scene.integrator), start, changes, scene.integrator.composition);
}

}  // namespace noether
