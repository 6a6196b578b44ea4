#include "scene/minimize.hpp"

#include "scene/constrained.hpp"
#include "scene/fields.hpp"

#include <fmt/format.h>

namespace noether {

SceneValue read_minimize(const SceneContext& context, const SceneValue& table, Scene& scene) {
  TableReader reader(context, table, "[minimize]", "minimize");
  if (table.get<SceneValue::Table>() == nullptr) reader.wrong_kind(table, "minimize", "a table");
  if (scene.hamiltonian.rotating) {
    reader.fail(nullptr, "minimize",
                "some particles are rigid bodies, which [minimize] cannot turn; take [minimize] out, or minimize the "
                "molecules along constraints first");
  }
  MinimizeOptions options;
  read_part(reader, options);
  if (!scene.hamiltonian.splitting.claims().inertial) {
    reader.fail(nullptr, "",
                fmt::format("particles of {} have no minimum to move to; take [minimize] out",
                            scene.hamiltonian.splitting.name));
  }
  if (!scene.hamiltonian.splitting.only_forces) {
    reader.fail(nullptr, "",
                fmt::format("{} is more than forces, so a minimum of their energy is not at rest; take [minimize] out",
                            scene.hamiltonian.splitting.name));
  }
  for (const SceneForce& force : scene.hamiltonian.terms()) {
    if (!force.force.claims().time_dependent) continue;
    reader.fail(
        nullptr, "",
        fmt::format("force '{}' depends on time, so there is no minimum to move to; take [minimize] out", force.name));
  }
  scene.minimize = options;
  SceneValue effective = SceneValue::table();
  put_fields(reader, options, effective);
  return effective;
}

Minimized minimize_start(Scene& scene) {
  ForceField<double> forces;
  for (const SceneForce& force : scene.hamiltonian.terms()) forces.add(force.force);  // drag has no part in a minimum
  if (scene.hamiltonian.constraints.empty()) return minimize(scene.particles, forces, *scene.minimize);
  return minimize(scene.particles, forces, constraints_of(scene), *scene.minimize);
}

void begin_at_minimum(Scene& scene) {
  if (!scene.minimize) return;
  const Minimized found = minimize_start(scene);
  if (found.converged()) return;
  throw SceneError(
      fmt::format("[minimize] has no minimum for the run to begin at: none is found: {}", found.failure->message),
      {.file = scene.source.file, .key = "minimize"});
}

}  // namespace noether
