#include "scene/named_parts.hpp"

#include "scene/check.hpp"
#include "scene/read_force.hpp"
#include "scene/read_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace noether {

namespace {

const Parts& parts_of(const NamedFrom& from) {
  static const Parts known = standard_parts();
  return from.parts != nullptr ? *from.parts : known;
}

/// The table that a scene would have, and what it is read in.
struct NamedTable {
  NamedTable(const std::string& key, const std::string& name, const SceneValue& values, const NamedFrom& from)
      : table(SceneValue::table()) {
    context.units = from.units;
    const SceneValue::Table* entries = values.get<SceneValue::Table>();
    if (entries == nullptr) {
      throw SceneError(fmt::format("the values of '{}' are {}; a table is expected", name, kind_of(values)));
    }
    check_tree(values, context.source);
    if (values.find(key) != nullptr) {
      throw SceneError(fmt::format("the values of '{}' have the key '{}', which is its name; take it out", name, key));
    }
    table.put(key, SceneValue::of(name));
    for (const auto& [entry, value] : *entries) table.put(entry, value);
  }

  SceneContext context;
  SceneValue table;
};

}  // namespace

SceneForce make_force(const std::string& name, const SceneValue& values, const NamedFrom& from) {
  const NamedTable named("type", name, values, from);
  const Parts::ForceKind* kind =
      kind_of_part(named.context, named.table, "force", "force", parts_of(from).forces(), {}).first;
  TableReader reader(named.context, named.table, fmt::format("force '{}'", name), "force");
  SceneValue effective = SceneValue::table();
  SceneForce force = read_force(reader, *kind, from.particles, effective);
  set_kick(reader, force);
  if (force.letter || from.particles == nullptr) return force;
  try {
    force.force.check(*from.particles);
  } catch (const Error& error) {
    reader.fail("type", error.message());
  }
  return force;
}

AnyMonitor<double> make_monitor(const std::string& name, const SceneValue& values, const NamedFrom& from,
                                const ConstraintSet& constraints) {
  const NamedTable named("type", name, values, from);
  const Parts::MonitorKind* kind =
      kind_of_part(named.context, named.table, "monitor", "monitor", parts_of(from).monitors(), {}).first;
  TableReader reader(named.context, named.table, fmt::format("monitor '{}'", name), "monitor");
  reader.find("type");
  return kind->read(reader).make({constraints, {}, {}, {}});
}

SceneHamiltonian make_hamiltonian(const std::string& name, const SceneValue& values, std::vector<SceneForce> forces,
                                  const NamedFrom& from) {
  const Parts& parts = parts_of(from);
  const NamedTable named("type", name, values, from);
  const Parts::HamiltonianKind* kind =
      kind_of_part(named.context, named.table, "hamiltonian", "hamiltonian", parts.hamiltonians(), {}).first;
  TableReader reader(named.context, named.table, "[hamiltonian]", "hamiltonian");
  reader.find("type");
  SceneHamiltonian made;
  made.splitting = kind->read(reader);
  if (kind->needs_forces && forces.empty()) {
    reader.fail("type", fmt::format("{} has no force, so nothing would move anything; give it one", name));
  }
  for (SceneForce& force : forces) {
    const auto known = std::find_if(parts.forces().begin(), parts.forces().end(),
                                    [&](const Parts::ForceKind& one) { return one.info.name == force.name; });
    if (known != parts.forces().end()) {
      const TableReader beside(named.context, force.effective, fmt::format("force '{}'", force.name), "force");
      check_force_beside(beside, *known, force, made, parts);
    }
    made.forces.push_back(std::move(force));
  }
  return made;
}

SceneIntegrator make_method(const std::string& name, const SceneValue& values, const NamedFrom& from) {
  const NamedTable named("method", name, values, from);
  SceneValue effective = SceneValue::table();
  return read_method_alone(named.context, named.table, parts_of(from), effective);
}

AnyIntegrator<double> make_integrator(SceneHamiltonian hamiltonian, SceneIntegrator method) {
  Scene scene;
  scene.hamiltonian = std::move(hamiltonian);
  scene.integrator = std::move(method);
  return integrator_of(scene);
}

}  // namespace noether
