#include "scene/read_thermostat.hpp"

#include "engine/suggest.hpp"
#include "scene/fields.hpp"

#include <fmt/format.h>

namespace noether {

SceneValue read_thermostat(const SceneContext& context, const SceneValue& table, Scene& scene) {
  TableReader bare(context, table, "[hamiltonian.thermostat]", "hamiltonian.thermostat");
  if (table.get<SceneValue::Table>() == nullptr) bare.wrong_kind(table, "thermostat", "a table");
  const std::string type = bare.text("type");
  if (!bare.has("type")) bare.fail(nullptr, "type", "the thermostat has no type; give \"langevin\"");
  if (type != "langevin") {
    bare.fail("type", fmt::format("unknown thermostat '{}'{}", type, did_you_mean(type, {"langevin"})));
  }
  TableReader reader(context, table, "thermostat 'langevin'", "hamiltonian.thermostat");
  reader.find("type");
  LangevinOptions options;
  read_part(reader, options);
  if (scene.hamiltonian.kind == SceneHamiltonian::Kind::wisdom_holman) {
    bare.fail("type", "wisdom_holman has no thermostat: noise is that of inertial velocities; use kinetic_potential");
  }
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (!force.drag) continue;
    bare.fail("type", "a thermostat beside linear_drag would be colder than it says; add the rate to its friction");
  }
  scene.hamiltonian.thermostat = options;
  SceneValue effective = SceneValue::table();
  effective.put("type", SceneValue::of(type, reader.line("type")));
  put_fields(reader, options, effective);
  return effective;
}

}  // namespace noether
