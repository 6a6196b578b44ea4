#include "scene/read_constraints.hpp"

#include "constraints/constraint_solver.hpp"
#include "constraints/structure_constraints.hpp"
#include "integrators/projection.hpp"
#include "scene/read_tied.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace noether {

namespace {

std::string path_of(std::size_t table) { return fmt::format("hamiltonian.constraint.{}", table); }

/// Keys of the options, all of which any table may have.
constexpr std::array<const char*, 4> option_keys = {"solver", "tolerance", "iterations", "order"};

/// Whether a solver that ends so reads a key beside `solver`.
bool reads(SolverEnd end, std::string_view key) {
  if (key == "tolerance") return end == SolverEnd::tolerance;
  if (key == "order") return end == SolverEnd::order;
  return end != SolverEnd::rounding;
}

/// The solvers that read a key, as a scene types them, "or" between them.
std::string solvers_that_read(std::string_view key) {
  std::string names;
  for (const ConstraintMethodInfo& info : constraint_methods) {
    if (reads(info.end, key)) names += fmt::format("{}\"{}\"", names.empty() ? "" : " or ", info.name);
  }
  return names;
}

/// Where a solver ends, in words.
std::string_view end_in_words(SolverEnd end) {
  switch (end) {
    case SolverEnd::rounding:
      return "solves to rounding";
    case SolverEnd::tolerance:
      return "solves to a tolerance";
    case SolverEnd::order:
      break;
  }
  return "has an order and a number of iterations instead";
}

/// How all constraints are solved: keys that any of the tables may have, but only in one way.
ConstraintOptions read_options(const SceneContext& context, const std::vector<const SceneValue*>& tables) {
  ConstraintOptions options;
  std::map<std::string, const SceneValue*> given;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TableReader reader(context, *tables[k], "[[hamiltonian.constraint]]", path_of(k));
    for (const char* key : option_keys) {
      const SceneValue* value = reader.find(key);
      if (value == nullptr) continue;
      const auto [before, is_new] = given.emplace(key, value);
      if (is_new || to_text(*before->second) == to_text(*value)) continue;
      reader.fail(
          key,
          fmt::format("{} = {} differs from {} before; all constraints are solved together, so give the same value",
                      key, to_text(*value), to_text(*before->second)));
    }
    if (const SceneValue* solver = reader.find("solver"); solver != nullptr && to_text(*solver) == "\"shake\"")
      reader.fail("solver", "unknown solver 'shake' in [[hamiltonian.constraint]]; SHAKE's sweeps are \"rattle\" here");
    read_fields(reader, options);
    try {
      options.check();
    } catch (const SceneError&) {
      throw;
    } catch (const Error& error) {
      reader.refuse(error);
    }
  }
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TableReader reader(context, *tables[k], "[[hamiltonian.constraint]]", path_of(k));
    for (const std::string_view key : option_keys) {
      if (key == "solver" || reads(options.end(), key) || !reader.has(key)) continue;
      reader.fail(key, fmt::format("{} is for solver = {} only; {} {}", key, solvers_that_read(key),
                                   info_of(options.solver).name, end_in_words(options.end())));
    }
  }
  return options;
}

void put_options(const ConstraintOptions& options, const UnitSystem& units, SceneValue& effective) {
  effective.put("solver", detail::field_value(options.solver, "1", units));
  const auto put = [&](const char* key, const auto& value) {
    if (reads(options.end(), key)) effective.put(key, detail::field_value(value, "1", units));
  };
  put("tolerance", options.tolerance);
  put("iterations", options.most_iterations());
  put("order", options.order);
}

/// Takes the bonded terms that constraints of the structure hold out of the force `bonded`.
void leave_out_held_terms(Scene& scene) {
  ConstraintSet held;
  for (const SceneConstraint& constraint : scene.hamiltonian.constraints) {
    if (constraint.find) constraint.add_to(held, scene.particles);
  }
  if (!held.empty()) leave_out_rigid_terms(scene.particles, held);
}

/// q x p = L_0 binds momenta too: no solver of constraints on positions can hold it.
void refuse_invariants(const SceneContext& context, const SceneValue& table, const std::string& path) {
  TableReader reader(context, table, "[[hamiltonian.constraint]]", path);
  const std::string type = reader.text("type");
  for (const auto& [invariant, name] : EnumNames<Invariant>::values) {
    if (invariant == Invariant::constraints || type != name) continue;
    reader.fail("type", fmt::format("'{0}' binds momenta, and constraints bind positions only; use "
                                    "[integrator.projection] with onto = [\"{0}\"]",
                                    name));
  }
}

}  // namespace

SceneValue::Array read_constraints(const SceneContext& context, const std::vector<const SceneValue*>& tables,
                                   const Parts& parts, Scene& scene) {
  SceneValue::Array list;
  SceneHamiltonian& made = scene.hamiltonian;
  made.constraint_options = read_options(context, tables);
  for (const SceneValue* table : tables) {
    const std::string path = path_of(list.size());
    refuse_invariants(context, *table, path);
    const auto [kind, type] = kind_of_part(context, *table, path, "constraint", parts.constraints(), {});
    TableReader reader(context, *table, fmt::format("constraint '{}'", type), path);
    reader.find("type");
    std::optional<TiedReader> tied;
    if (!kind->of_structure) tied.emplace(reader, kind->particles, scene.particles);
    for (const char* key : option_keys) reader.find(key);
    SceneConstraint constraint = kind->read(reader);
    SceneValue effective = SceneValue::table();
    effective.put("type", SceneValue::of(type, reader.line("type")));
    if (tied) constraint.tied = tied->read(effective);
    for (auto& [key, value] : *constraint.effective.get<SceneValue::Table>()) effective.put(key, value);
    try {
      if (constraint.find) constraint.find(constraint, scene.particles);
      ConstraintSet alone;
      constraint.add_to(alone, scene.particles);
    } catch (const Error& error) {
      reader.fail("type", error.message());
    }
    list.push_back(effective);
    constraint.effective = std::move(effective);
    made.constraints.push_back(std::move(constraint));
  }
  leave_out_held_terms(scene);
  for (SceneValue& one : list) put_options(made.constraint_options, *scene.units, one);
  return list;
}

void refuse_constraints(const SceneContext& context, const std::vector<const SceneValue*>& tables, const Scene& scene) {
  const auto refusal = [&](std::size_t count) -> std::string {
    ParticleSystem<double> s = scene.particles;
    try {
      ConstraintSolver<double>(constraints_of(scene, count)).bind(s);
    } catch (const BadConstraints& error) {
      return error.message();
    }
    return "";
  };
  if (tables.empty() || refusal(tables.size()).empty()) return;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const std::string message = refusal(k + 1);
    if (message.empty()) continue;
    TableReader(context, *tables[k], "[[hamiltonian.constraint]]", path_of(k)).fail("type", message);
  }
}

}  // namespace noether
