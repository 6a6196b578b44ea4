#include "cli/described_parts.hpp"

#include "scene/read_builder.hpp"
#include "scene/references.hpp"

namespace noether {

namespace {

constexpr std::string_view of_names = "[\"NAME\", ...]", of_pairs = "[[\"NAME\", \"NAME\"], ...]",
                           of_triples = "[[\"NAME\", \"NAME\", \"NAME\"], ...]";

/// The keys that say between which particles a part of `particles` each acts.
std::vector<FieldInfo> particle_keys(std::size_t particles) {
  const auto key = [](std::string_view name, std::string_view example, std::string_view help) {
    return FieldInfo{std::string(name), "1", std::string(help), "list", "", std::string(example), {}};
  };
  if (particles == 0) return {key("bodies", of_names, "names of the particles that it ties together")};
  if (particles == 1) {
    return {key("bodies", of_names, "names of the particles, or \"all\""),
            key("surface", "", "instead of bodies: the name of a surface of a mesh")};
  }
  if (particles == 2) {
    return {
        key("pairs", of_pairs, "pairs of names, or \"bonds\" for every bond of a structure"),
        key("chain", "", "instead of pairs: [\"FIRST\", \"LAST\"], each particle with the next from first to last")};
  }
  if (particles == 3) return {key("triples", of_triples, "triples of names, or \"angles\" for every angle of one")};
  return {key("groups", "[[\"NAME\", ...], ...]", "groups of names")};
}

PartInfo with_particles(PartInfo info, std::size_t particles) {
  std::vector<FieldInfo> keys = particle_keys(particles);
  info.fields.insert(info.fields.begin(), keys.begin(), keys.end());
  return info;
}

}  // namespace

std::vector<std::pair<std::string, PartInfo>> described_parts(const Parts& parts) {
  std::vector<std::pair<std::string, PartInfo>> all;
  for (const auto& kind : parts.hamiltonians()) all.emplace_back("hamiltonian", kind.info);
  for (const auto& kind : parts.thermostats()) all.emplace_back("thermostat", kind.info);
  for (auto& part : other_parts()) all.push_back(std::move(part));
  for (const BuilderKind& kind : builders()) all.emplace_back("builder", kind.info);
  for (const auto& kind : parts.forces()) {
    all.emplace_back(kind.field ? "field" : "force",
                     kind.particles > 0 ? with_particles(kind.info, kind.particles) : kind.info);
  }
  for (const auto& kind : parts.constraints()) {
    all.emplace_back("constraint", kind.of_structure ? kind.info : with_particles(kind.info, kind.particles));
  }
  for (const auto& kind : parts.systems()) all.emplace_back("system", kind.info);
  for (const auto& kind : parts.decorators()) all.emplace_back("decorator", kind.info);
  for (const auto& kind : parts.monitors()) all.emplace_back("monitor", kind.info);
  for (const PartInfo& info : writer_parts()) all.emplace_back("writer", info);
  for (const auto& kind : parts.stops()) all.emplace_back("stop", kind.info);
  return all;
}

std::string table_of(const std::string& kind) {
  if (kind == "builder") return "[particles], as type = \"NAME\"";
  if (kind == "force") return "[[hamiltonian.force]]";
  if (kind == "field") return "[[hamiltonian.field]]";
  if (kind == "thermostat") return "[hamiltonian.thermostat]";
  if (kind == "start") return "[minimize]";
  if (kind == "constraint") {
    return "[[hamiltonian.constraint]], with the particles; solver = \"newton\" unless given, of the list under "
           "[[hamiltonian.constraint]] above";
  }
  if (kind == "system") {
    return "[system], instead of [particles] and [hamiltonian]; start = [...] sets another start";
  }
  if (kind == "decorator")
    return "[integrator.NAME], or [[integrator.decorator]] with type = \"NAME\"; the first wraps the method, each "
           "further one wraps the one before";
  if (kind == "monitor") return "[[every]], with every = \"TIME\", steps = N or times = [...]";
  if (kind == "writer") {
    return "[[every]], with every = \"TIME\", steps = N or times = [...] (checkpoint also: wall = \"5 min\")";
  }
  if (kind == "stop") return "[[stop]]; every = \"TIME\" may be given instead of steps = N";
  return "";
}

Json json_of(const std::vector<FieldInfo>& fields) {
  std::vector<Json> all;
  for (const FieldInfo& f : fields) {
    all.push_back(Json::object({{"name", f.name},
                                {"kind", f.kind},
                                {"dimension", f.dimension},
                                {"required", !f.example.empty()},
                                {"example", f.example.empty() ? Json() : Json(f.example)},
                                {"default", f.default_value.empty() ? Json() : Json(f.default_value)},
                                {"choices", Json::list_of(f.choices)},
                                {"help", f.help}}));
  }
  return Json::list(all);
}

Json json_of(const std::vector<ColumnInfo>& columns) {
  std::vector<Json> all;
  for (const ColumnInfo& one : columns)
    all.push_back(Json::object({{"name", one.name}, {"dimension", one.dimension}, {"width", one.width}}));
  return Json::list(all);
}

std::vector<std::string> texts_of(const std::vector<ColumnInfo>& columns, std::string_view mark) {
  std::vector<std::string> all;
  for (const ColumnInfo& one : columns) {
    const std::string dimension = one.dimension == "1" ? "" : " [" + one.dimension + "]";
    all.push_back(fmt::format("{}{}{}{}", mark, one.name, mark, dimension));
  }
  return all;
}

std::string entries_of(std::string_view sources) {
  std::string all;
  while (!sources.empty()) {
    const std::size_t end = sources.find_first_of(", ");
    const std::string entry = bibtex(sources.substr(0, end));
    if (!entry.empty()) all += entry + "\n";
    sources = end == std::string_view::npos ? "" : sources.substr(end + 1);
  }
  return all;
}

}  // namespace noether
