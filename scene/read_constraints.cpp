#include "scene/read_constraints.hpp"

#include "constraints/constraint_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace noether {

namespace {

std::string path_of(std::size_t table) { return fmt::format("hamiltonian.constraint.{}", table); }

/// Reads which particles a table ties: names, or tuples of names.
class TiedReader {
 public:
  TiedReader(TableReader& reader, std::size_t particles, const ParticleSystem<double>& s)
      : reader_(reader), particles_(particles), key_(key_of(particles)), s_(s) {
    for (Index i = 0; i < s.size(); ++i) index_.emplace(s.name(i), i);
    reader.find(key_);
    if (particles == 2) reader.find("chain");
  }

  TiedParticles read(SceneValue& effective) {
    const SceneValue* value = reader_.find(key_);
    const SceneValue* chain = particles_ == 2 ? reader_.find("chain") : nullptr;
    if (value != nullptr && chain != nullptr) {
      reader_.fail(chain, "chain",
                   fmt::format("{} and chain stand both in {}; give one of them", key_, reader_.what()));
    }
    if (chain != nullptr) {
      effective.put("chain", *chain);
      return links(*chain);
    }
    if (value == nullptr) {
      reader_.fail(
          nullptr, key_,
          fmt::format("{} does not say whom it ties; give {} = {}", reader_.what(), key_, example_of(particles_)));
    }
    effective.put(key_, *value);
    if (particles_ == 1 && value->get<std::string>() != nullptr && *value->get<std::string>() == "all") return all();
    const auto* list = value->get<SceneValue::Array>();
    if (list == nullptr || list->empty()) wrong(*value);
    TiedParticles tied;
    if (particles_ == 0) return {names(*value, *list)};
    for (const SceneValue& one : *list) {
      if (particles_ == 1) {
        tied.push_back({particle(*value, one)});
        continue;
      }
      const auto* tuple = one.get<SceneValue::Array>();
      if (tuple == nullptr || tuple->size() != particles_) wrong(*value);
      tied.push_back(names(*value, *tuple));
    }
    return tied;
  }

 private:
  static std::string key_of(std::size_t particles) {
    return particles < 2 ? "bodies" : particles == 2 ? "pairs" : particles == 3 ? "triples" : "groups";
  }
  static std::string example_of(std::size_t particles) {
    std::string tuple;
    for (std::size_t k = 0; k < std::max<std::size_t>(particles, 2); ++k) {
      tuple += fmt::format("{}\"{}\"", k == 0 ? "" : ", ", static_cast<char>('a' + static_cast<int>(k)));
    }
    return particles < 2 ? "[" + tuple + "]" : "[[" + tuple + "]]";
  }
  [[noreturn]] void wrong(const SceneValue& value) const {
    const std::string tuples = particles_ < 2 ? "names" : key_ + " of names";
    reader_.fail(&value, key_,
                 fmt::format("{} = {} does not list {}; such as {} is expected", key_, to_text(value), tuples,
                             example_of(particles_)));
  }

  std::vector<Index> names(const SceneValue& at, const SceneValue::Array& list) const {
    std::vector<Index> particles;
    for (const SceneValue& one : list) particles.push_back(particle(at, one));
    return particles;
  }
  Index particle(const SceneValue& at, const SceneValue& name) const {
    const std::string* text = name.get<std::string>();
    if (text == nullptr) wrong(at);
    const auto found = index_.find(*text);
    if (found != index_.end()) return found->second;
    reader_.fail(
        &at, key_,
        fmt::format("{} ties '{}', which is no particle{}", reader_.what(), *text, did_you_mean(*text, s_.names())));
  }
  TiedParticles all() const {
    TiedParticles tied;
    for (Index i = 0; i < s_.size(); ++i) tied.push_back({i});
    return tied;
  }
  /// Each particle from the first to the last of `chain` with the next one.
  TiedParticles links(const SceneValue& chain) const {
    const auto* ends = chain.get<SceneValue::Array>();
    if (ends == nullptr || ends->size() != 2) {
      reader_.wrong_kind(chain, "chain", "the names of its first and last particle such as [\"a\", \"z\"]");
    }
    const Index first = particle(chain, ends->front()), last = particle(chain, ends->back());
    if (first >= last)
      reader_.fail(&chain, "chain",
                   fmt::format("chain = {} goes backwards; particles stand in the "
                               "order of their table",
                               to_text(chain)));
    TiedParticles tied;
    for (Index i = first; i < last; ++i) tied.push_back({i, i + 1});
    return tied;
  }

  TableReader& reader_;
  std::size_t particles_;
  std::string key_;
  const ParticleSystem<double>& s_;
  std::map<std::string, Index> index_;
};

/// How all constraints are solved: keys that any of the tables may have, but only in one way.
ConstraintOptions read_options(const SceneContext& context, const std::vector<const SceneValue*>& tables) {
  constexpr std::array<const char*, 3> keys = {"solver", "tolerance", "iterations"};
  ConstraintOptions options;
  std::map<std::string, const SceneValue*> given;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TableReader reader(context, *tables[k], "[[hamiltonian.constraint]]", path_of(k));
    for (const char* key : keys) {
      const SceneValue* value = reader.find(key);
      if (value == nullptr) continue;
      const auto [before, is_new] = given.emplace(key, value);
      if (is_new || to_text(*before->second) == to_text(*value)) continue;
      reader.fail(key, fmt::format("{} = {} differs from {} before; all constraints are solved together", key,
                                   to_text(*value), to_text(*before->second)));
    }
    read_fields(reader, options);
    try {
      options.check();
    } catch (const SceneError&) {
      throw;
    } catch (const Error& error) {
      reader.refuse(error);
    }
  }
  for (std::size_t k = 0; k < tables.size() && options.solver == ConstraintMethod::newton; ++k) {
    TableReader reader(context, *tables[k], "[[hamiltonian.constraint]]", path_of(k));
    for (const char* key : {"tolerance", "iterations"}) {
      if (!reader.has(key)) continue;
      reader.fail(key, fmt::format("{} belongs to solver = \"rattle\"; newton solves to rounding", key));
    }
  }
  return options;
}

void put_options(const ConstraintOptions& options, const UnitSystem& units, SceneValue& effective) {
  effective.put("solver", detail::field_value(options.solver, "1", units));
  if (options.solver == ConstraintMethod::newton) return;
  effective.put("tolerance", detail::field_value(options.tolerance, "1", units));
  effective.put("iterations", detail::field_value(options.iterations, "1", units));
}

}  // namespace

SceneValue::Array read_constraints(const SceneContext& context, const std::vector<const SceneValue*>& tables,
                                   const Parts& parts, Scene& scene) {
  SceneValue::Array list;
  SceneHamiltonian& made = scene.hamiltonian;
  made.constraint_options = read_options(context, tables);
  for (const SceneValue* table : tables) {
    const std::string path = path_of(list.size());
    const auto [kind, type] = kind_of_part(context, *table, path, "constraint", parts.constraints(), {});
    TableReader reader(context, *table, fmt::format("constraint '{}'", type), path);
    reader.find("type");
    TiedReader tied(reader, kind->particles, scene.particles);
    for (const char* key : {"solver", "tolerance", "iterations"}) reader.find(key);
    SceneConstraint constraint = kind->read(reader);
    SceneValue effective = SceneValue::table();
    effective.put("type", SceneValue::of(type, reader.line("type")));
    constraint.tied = tied.read(effective);
    for (auto& [key, value] : *constraint.effective.get<SceneValue::Table>()) effective.put(key, value);
    try {
      ConstraintSet alone;
      constraint.add_to(alone, scene.particles);
    } catch (const Error& error) {
      reader.fail("type", error.message());
    }
    list.push_back(effective);
    constraint.effective = std::move(effective);
    made.constraints.push_back(std::move(constraint));
  }
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
