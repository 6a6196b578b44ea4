#include "study/wide_scene.hpp"

#include "forces/sum.hpp"
#include "integrators/force_motion.hpp"
#include "integrators/hamiltonian_motion.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "study/sampling.hpp"

#include <fmt/format.h>

#include <utility>

namespace noether {

namespace {

/// Bodies that turn have no y' = f: their truth is the splitting itself, with exact turns whatever rotor the run has.
/// @param beside  forces that are no part of its kicks
void split_bodies(const SceneHamiltonian& h, const ForceField<Quad>& forces, const ForceField<Quad>& beside,
                  WideScene& wide) {
  if (!beside.terms().empty()) {
    wide.reason = fmt::format("force '{}' depends on velocities, which a reference of rigid bodies does not support",
                              beside.terms().front().name());
    return;
  }
  if (!h.splitting.only_forces) {
    wide.reason = fmt::format("hamiltonian '{}' of rigid bodies is more than p^2/2m and forces", h.splitting.name);
    return;
  }
  const AnyHamiltonian<Quad> points = KineticPotential<ForceField<Quad>, Quad>(h.all_on_bodies(forces));
  wide.splitting = Rotating<AnyHamiltonian<Quad>>(points);
}

}  // namespace

WideScene wide_scene(const Scene& scene) {
  WideScene wide;
  const SceneHamiltonian& h = scene.hamiltonian;
  if (scene.particles.size() > most_bodies) {
    wide.reason = fmt::format("more than {} bodies are too many for a reference", most_bodies);
    return wide;
  }
  if (!h.constraints.empty()) {
    wide.reason = "constraints are solved in double precision only";
    return wide;
  }
  if (scene.system) {
    if (scene.system->wide_field) wide.field = scene.system->wide_field();
    if (wide.field == nullptr) wide.reason = fmt::format("system '{}' is written for doubles only", scene.system->name);
    wide.start = scene.particles.as<Quad>();
    return wide;
  }
  ForceField<Quad> all, kicks, beside;  // as `field_of` parts them: what depends on velocities is no kick
  const auto widen = [&](const SceneForce& force) {
    const auto in_quad = force.force.in_quad();
    if (!in_quad) return false;
    all.add(*in_quad);
    const bool kicks_not = force.force.claims().velocity_dependent && !h.splitting.claims().velocity_forces;
    (force.letter || kicks_not ? beside : kicks).add(*in_quad);
    return true;
  };
  for (const std::vector<SceneForce>* list : {&h.splitting.own, &h.forces}) {
    for (const SceneForce& force : *list) {
      if (widen(force)) continue;
      wide.reason = fmt::format("force '{}' is written for doubles only", force.name);
      return wide;
    }
  }
  wide.start = scene.particles.as<Quad>();
  if (h.rotating) {
    split_bodies(h, all, beside, wide);
  } else if (h.splitting.only_forces) {
    wide.field = std::make_unique<ForceMotion<ForceField<Quad>, Quad>>(std::move(all));
  } else if (!h.splitting.make_wide) {
    wide.reason = fmt::format("hamiltonian '{}' is written for doubles only", h.splitting.name);
  } else if (!h.splitting.claims().inertial && h.splitting.claims().velocity_forces && beside.terms().empty()) {
    wide.splitting = h.splitting.make_wide(std::move(kicks));
  } else if (!h.splitting.claims().inertial) {
    wide.reason =
        fmt::format("hamiltonian '{}' uses its own coordinates, which a reference does not support", h.splitting.name);
  } else if (h.splitting.claims().columns && !beside.terms().empty()) {
    wide.reason = fmt::format("hamiltonian '{}' has forces beside its kicks, which exist in double precision only",
                              h.splitting.name);
  } else if (h.splitting.claims().columns) {
    wide.splitting = h.splitting.make_wide(std::move(kicks));
  } else {
    wide.field = std::make_unique<HamiltonianMotion<Quad>>(h.splitting.make_wide(std::move(kicks)), std::move(beside),
                                                           all.claims());
  }
  return wide;
}

void refuse_noise(const Scene& scene) {
  if (!scene.hamiltonian.thermostat) return;
  throw SceneError(
      "the scene has a thermostat, whose noise a reference cannot reproduce, so errors and limits of steps cannot "
      "be told; take [hamiltonian.thermostat] out",
      {.file = scene.source.file, .key = "hamiltonian.thermostat"});
}

}  // namespace noether
