#include "scene/read_thermostat.hpp"

#include "scene/fields.hpp"

#include <fmt/format.h>

namespace noether {

SceneValue read_thermostat(const SceneContext& context, const SceneValue& table, const Parts& parts, Scene& scene) {
  TableReader bare(context, table, "[hamiltonian.thermostat]", "hamiltonian.thermostat");
  if (table.get<SceneValue::Table>() == nullptr) bare.wrong_kind(table, "thermostat", "a table");
  const auto [kind, type] =
      kind_of_part(context, table, "hamiltonian.thermostat", "thermostat", parts.thermostats(), {});
  TableReader reader(context, table, fmt::format("thermostat '{}'", type), "hamiltonian.thermostat");
  reader.find("type");
  SceneThermostat made = kind->read(reader);
  if (!scene.hamiltonian.splitting.claims().inertial) {
    bare.fail("type", fmt::format("{} does not support a thermostat, whose noise acts on inertial velocities; use {}",
                                  scene.hamiltonian.splitting.name, parts.hamiltonians().front().info.name));
  }
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (force.force.claims().drag == 0) continue;
    bare.fail("type", fmt::format("a thermostat together with {} would be colder than its temperature; take the force "
                                  "out, or add its rate to the friction of a thermostat 'langevin'",
                                  force.name));
  }
  SceneValue effective = SceneValue::table();
  effective.put("type", SceneValue::of(type, reader.line("type")));
  for (const auto& [key, value] : *made.effective.get<SceneValue::Table>()) effective.put(key, value);
  scene.hamiltonian.thermostat = std::move(made);
  return effective;
}

}  // namespace noether
