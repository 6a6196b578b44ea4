#include "cli/explain_bodies.hpp"

#include "engine/bodies.hpp"
#include "integrators/lie/group_options.hpp"
#include "study/turning_steps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace noether {

namespace {

/// Bodies of a scene in figures.
struct BodyCount {
  std::int64_t bodies = 0, held = 0, sites = 0, excluded = 0;
  double turns = 0;  ///< of the fastest in a step, from its rate at the start; 0 where the method chooses the steps
};

BodyCount counted_bodies(const Scene& scene) {
  const ParticleSystem<double>& s = scene.particles;
  BodyCount count;
  for (Index i = 0; i < s.size(); ++i) {
    const BodyKind* kind = s.bodies()->kind(i);
    if (kind == nullptr) continue;
    const auto sites = static_cast<std::int64_t>(kind->sites.size());
    ++count.bodies;
    count.held += kind->held ? 1 : 0;
    count.sites += sites;
    count.excluded += sites * (sites - 1) / 2;
  }
  if (const auto turning = turning_steps(scene)) count.turns = std::abs(scene.integrator.step) / turning->period;
  return count;
}

std::string turns_of(const Scene& scene) {
  const RotatingOptions& options = *scene.hamiltonian.rotating;
  if (scene.integrator.on_groups()) {
    const GroupOptions on = group_options_of(scene.integrator.classical->options);
    return fmt::format("exponentials on {}, spins in axes of the {}", on.group == BodyGroup::so3 ? "SO(3)" : "SE(3)",
                       on.spin_axes == SpinAxes::body ? "body" : "space");
  }
  const Rotor rotor = rotor_of(scene).value_or(options.rotor);
  if (rotor != Rotor::axes) return std::string(rotor_name(rotor));
  const std::string_view axes = options.axes;
  return fmt::format("axes {} {} {} {} {}", axes[0], axes[1], axes[2], axes[1], axes[0]);
}

}  // namespace

std::string bodies_text(const Scene& scene) {
  if (!has_bodies(scene.particles)) return "";
  const BodyCount count = counted_bodies(scene);
  std::string text =
      fmt::format("rigid bodies: {} of {} site{}", count.bodies, count.sites, count.sites == 1 ? "" : "s");
  if (count.held > 0) text += fmt::format(", {} held by fixed points", count.held);
  if (count.excluded > 0) text += fmt::format("; {} pairs within a body are left out", count.excluded);
  text += fmt::format("; rotor {}", turns_of(scene));
  if (count.turns > 0) text += fmt::format("; the fastest turns {:.2g} times in a step", count.turns);
  return text;
}

Json bodies_json(const Scene& scene) {
  if (!has_bodies(scene.particles)) return Json();
  const BodyCount count = counted_bodies(scene);
  return Json::object({{"bodies", count.bodies},
                       {"held", count.held},
                       {"sites", count.sites},
                       {"excluded_pairs", count.excluded},
                       {"rotor", turns_of(scene)},
                       {"turns_per_step", count.turns}});
}

}  // namespace noether
