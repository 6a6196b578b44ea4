#include "scene/particle_keys.hpp"

#include "io/digest.hpp"
#include "io/files.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <utility>

namespace noether {

namespace {

/// Reads a file; if there is none to be read, the scene's line that asks for it is told too.
ParticleSystem<double> told_of_line(const TableReader& reader, const std::string& key,
                                    const std::filesystem::path& file,
                                    const std::function<ParticleSystem<double>(const std::filesystem::path&)>& read) {
  try {
    return read(file);
  } catch (const FileError& error) {
    const int line = reader.line(key);
    if (line <= 0) throw;
    throw FileError(
        error.what(),
        {.file = reader.context().source.file, .line = line, .key = reader.path_of(key), .value = file.string()});
  }
}

/// The name of a type: a text, or its number.
std::string type_name(TableReader& table, std::string_view key, const SceneValue& value) {
  if (const auto* number = value.get<std::int64_t>()) return fmt::format("{}", *number);
  const std::string* text = value.get<std::string>();
  if (text == nullptr) table.wrong_kind(value, key, "the name of a type");
  return *text;
}

std::vector<const SceneValue*> tables_and_keep(TableReader& reader, const std::string& key, SceneValue& effective) {
  const auto tables = tables_of(reader, key);
  if (!tables.empty()) effective.put(key, *reader.find(key));
  return tables;
}

}  // namespace

ParticleSystem<double> particles_in_file(
    TableReader& reader, const std::string& key, const std::filesystem::path& folder, const std::string& example,
    const std::string& what, SceneValue& effective,
    const std::function<ParticleSystem<double>(const std::filesystem::path&)>& read,
    const std::function<std::string()>& hash_of) {
  const std::string name = reader.text(key), hash_key = key + "_sha256";
  if (name.empty()) reader.fail(key, fmt::format("{} = \"\" names no file; give one, such as \"{}\"", key, example));
  const std::filesystem::path file = folder / name;
  std::error_code none;
  if (std::filesystem::equivalent(file, reader.context().source.file, none)) {
    reader.fail(key,
                fmt::format("{} = \"{}\" is this scene itself; give {}, such as \"{}\"", key, name, what, example));
  }
  ParticleSystem<double> s = told_of_line(reader, key, file, read);
  const std::string hash = hash_of ? hash_of() : io::sha256(io::read_bytes(file));
  if (reader.text(hash_key, hash) != hash) {
    reader.fail(hash_key, fmt::format("'{}' differs from the file this scene was run with: its hash is now {}; take "
                                      "the key out to use the new file",
                                      name, hash));
  }
  effective.put(key, SceneValue::of(name, reader.line(key)));
  effective.put(hash_key, SceneValue::of(hash, reader.line(key)));
  return s;
}

std::optional<Box> read_box(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("box");
  if (value == nullptr) return {};
  effective.put("box", *value);
  if (const std::string* text = value->get<std::string>()) {
    if (*text == "open") return Box::open();
    reader.fail("box", fmt::format("box = \"{}\" is not understood; three lengths are expected, or \"open\"", *text));
  }
  if (const auto* each = value->get<SceneValue::Array>()) {
    for (const SceneValue& edge : *each) {
      const std::string* text = edge.get<std::string>();
      if (text == nullptr || *text != "open") continue;
      reader.fail("box",
                  "the box is \"open\" along one axis; it is periodic along all three, a shearing sheet too, or "
                  "along none: give three lengths, or box = \"open\"");
    }
  }
  const auto edges = reader.vector("box", "length");
  try {
    return Box::periodic(Vec3<double>((*edges)[0], (*edges)[1], (*edges)[2]));
  } catch (const Error& error) {
    reader.fail("box", error.message());
  }
}

bool has_frame_number(TableReader& reader) {
  const SceneValue* frame = reader.find("frame");
  if (frame != nullptr && frame->get<std::int64_t>() == nullptr && frame->get<std::string>() == nullptr)
    reader.wrong_kind(*frame, "frame", "\"barycenter\", or the number of a frame, such as 0 or -1 for the last,");
  return frame != nullptr && frame->get<std::int64_t>() != nullptr;
}

std::string no_such_frame(const std::string& frame, bool has_frames) {
  std::string told = fmt::format("unknown frame '{}'{}", frame, did_you_mean(frame, {"barycenter", "as_given"}));
  if (has_frames && !told.ends_with('?')) told += ", or the number of a frame, such as 0 or -1 for the last";
  return told;
}

std::optional<Mixing> read_mixing(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("mixing");
  if (value == nullptr) return {};
  effective.put("mixing", *value);
  const std::string text = reader.text("mixing");
  if (text == "geometric") return Mixing::geometric;
  if (text == "lorentz_berthelot") return Mixing::lorentz_berthelot;
  reader.fail("mixing",
              fmt::format("unknown mixing '{}'{}", text, did_you_mean(text, {"lorentz_berthelot", "geometric"})));
}

namespace {

std::array<double, 3> three_factors(TableReader& reader, const std::string& key) {
  const SceneValue* value = reader.find(key);
  const auto* factors = value != nullptr ? value->get<SceneValue::Array>() : nullptr;
  if (value != nullptr && (factors == nullptr || factors->size() != 3)) {
    reader.fail(key, fmt::format("{} = {} is not a list of three numbers; the factors of the forces between "
                                 "particles one, two and three bonds apart are expected: [s12, s13, s14]",
                                 key, to_text(*value)));
  }
  return reader.vector(key, "1").value_or(std::array<double, 3>{0, 0, 0});
}

SceneValue list_of(const std::array<double, 3>& factors, int line) {
  SceneValue::Array list;
  for (const double factor : factors) list.push_back(SceneValue::of(factor));
  return SceneValue::of(std::move(list), line);
}

}  // namespace

SpecialFactors read_special(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("special");
  if (value == nullptr || value->get<SceneValue::Table>() == nullptr) {
    const std::array<double, 3> special = three_factors(reader, "special");
    effective.put("special", list_of(special, reader.line("special")));
    return {special};
  }
  TableReader table(reader.context(), *value, "special", "particles.special");
  table.expect_only({"lennard_jones", "charges"});
  for (const char* key : {"lennard_jones", "charges"}) {
    if (!table.has(key)) {
      table.fail(value, key,
                 fmt::format("special has no {}; give lennard_jones and charges, each as [s12, s13, s14]", key));
    }
  }
  effective.put("special", *value);
  return {three_factors(table, "lennard_jones"), three_factors(table, "charges")};
}

namespace {

/// The particle of each id.
std::unordered_map<std::int64_t, Index> particles_by_id(const ParticleSystem<double>& s) {
  std::unordered_map<std::int64_t, Index> index;
  for (Index i = 0; i < s.size(); ++i) index.emplace(s.ids()[static_cast<std::size_t>(i)], i);
  return index;
}

/// Two ids as the particles that have them, the smaller index first; a message where they are none.
/// @param refuse  (why)
template <class Refuse>
Topology::Pair pair_of_ids(const SceneValue& value, const std::unordered_map<std::int64_t, Index>& index,
                           const Refuse& refuse) {
  const auto* ids = value.get<SceneValue::Array>();
  if (ids == nullptr || ids->size() != 2) refuse("; two ids are expected, such as [1, 5]");
  std::array<Index, 2> pair{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto* id = (*ids)[k].get<std::int64_t>();
    if (id == nullptr) refuse("; two ids are expected, such as [1, 5]");
    const auto found = index.find(*id);
    if (found == index.end()) refuse(fmt::format(", but there is no particle with id {}", *id));
    pair[k] = found->second;
  }
  if (pair[0] == pair[1]) refuse(", which is the same particle twice; two different ids are expected");
  return std::minmax(pair[0], pair[1]);
}

}  // namespace

void read_special_pairs(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective) {
  const auto tables = tables_and_keep(reader, "special_pair", effective);
  if (tables.empty()) return;
  const auto index = particles_by_id(s);
  std::map<Topology::Pair, std::array<double, 3>> pairs;
  for (const SceneValue* one : tables) {
    TableReader table(reader.context(), *one, "[[particles.special_pair]]",
                      fmt::format("particles.special_pair.{}", pairs.size()));
    table.expect_only({"ids", "epsilon", "sigma", "charge_product"});
    const SceneValue* ids = table.find("ids");
    if (ids == nullptr) {
      table.fail(nullptr, "ids", "this [[particles.special_pair]] has no ids; give those of its two particles");
    }
    const auto refuse = [&](const std::string& why) {
      table.fail("ids", fmt::format("ids = {}{}", to_text(*ids), why));
    };
    const Topology::Pair pair = pair_of_ids(*ids, index, refuse);
    const auto epsilon = table.quantity("epsilon", "energy"), sigma = table.quantity("sigma", "length");
    const auto product = table.quantity("charge_product", "charge^2");
    if (epsilon.has_value() != sigma.has_value()) {
      table.fail(
          epsilon ? "epsilon" : "sigma",
          fmt::format("{} is given alone; give both epsilon and sigma, or neither", epsilon ? "epsilon" : "sigma"));
    }
    if (epsilon && !(*epsilon >= 0)) {
      table.fail("epsilon", fmt::format("epsilon = {} is not a valid depth; 0 or more is expected",
                                        to_text(*table.find("epsilon"))));
    }
    if (sigma && !(*sigma > 0)) {
      table.fail("sigma", fmt::format("sigma = {} is not a valid length; a length above 0 is expected",
                                      to_text(*table.find("sigma"))));
    }
    if (!epsilon && !product) {
      table.fail(nullptr, "epsilon",
                 "this [[particles.special_pair]] has neither epsilon and sigma nor a charge_product; "
                 "give some of them, or list the pair in exclusions");
    }
    const std::array<double, 3> own = {epsilon.value_or(0), sigma.value_or(0),
                                       s.units().coulomb_constant * product.value_or(0)};
    if (!pairs.emplace(pair, own).second) refuse(", a pair that is already listed; take one out");
  }
  Topology topology = s.topology() != nullptr ? *s.topology() : Topology{};
  if (!topology.has_dihedral_kinds()) {
    reader.fail("special_pair",
                "special pairs become terms beside the dihedrals of the structure, but there are no parameters for the "
                "kinds of these; give the parameters of each kind in section 'Dihedral Coeffs'");
  }
  std::vector<Topology::Pair> all;
  for (const auto& [pair, own] : pairs) all.push_back(pair);
  topology.exclude(all);
  std::erase_if(topology.dihedrals, [&](const BondedTerm<4>& term) {
    const auto [first, last] = std::minmax(term.particles.front(), term.particles.back());
    return topology.acts_on_ends(term) && pairs.contains({first, last});
  });
  std::map<std::array<double, 3>, int> known;
  for (const auto& [pair, own] : pairs) {
    const auto [at, fresh] = known.try_emplace(own, static_cast<int>(topology.dihedral_kinds.size()));
    if (fresh) topology.dihedral_kinds.push_back({"one_four", {own.begin(), own.end()}});
    topology.dihedrals.push_back({{pair.first, pair.first, pair.second, pair.second}, at->second});
  }
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
}

void read_exclusions(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective) {
  const SceneValue* value = reader.find("exclusions");
  if (value == nullptr) return;
  const auto* list = value->get<SceneValue::Array>();
  if (list == nullptr) {
    reader.fail(
        "exclusions",
        fmt::format("exclusions = {} is not a list of pairs; pairs of ids are expected, such as [[1, 5], [2, 7]]",
                    to_text(*value)));
  }
  const auto index = particles_by_id(s);
  std::set<Topology::Pair> pairs;
  for (const SceneValue& one : *list) {
    const auto refuse = [&](const std::string& why) {
      reader.fail(one.line != 0 ? &one : value, "exclusions",
                  fmt::format("exclusions contains {}{}", to_text(one), why));
    };
    if (!pairs.insert(pair_of_ids(one, index, refuse)).second) refuse(", a pair that is already listed; take one out");
  }
  Topology topology = s.topology() != nullptr ? *s.topology() : Topology{};
  topology.exclude({pairs.begin(), pairs.end()});
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  effective.put("exclusions", *value);
}

std::vector<TypeParameters> read_types(TableReader& reader, SceneValue& effective) {
  std::vector<TypeParameters> types;
  for (const SceneValue* one : tables_and_keep(reader, "type", effective)) {
    TableReader table(reader.context(), *one, "[[particles.type]]", fmt::format("particles.type.{}", types.size()));
    table.expect_only({"name", "mass", "charge", "epsilon", "sigma"});
    const SceneValue* name = table.find("name");
    if (name == nullptr) table.fail(nullptr, "name", "this [[particles.type]] has no name; give the name of the type");
    TypeParameters type{.type = type_name(table, "name", *name)};
    type.mass = table.quantity("mass", "mass");
    type.charge = table.quantity("charge", "charge");
    type.epsilon = table.quantity("epsilon", "energy");
    type.sigma = table.quantity("sigma", "length");
    types.push_back(std::move(type));
  }
  return types;
}

std::vector<PairParameters> read_pairs(TableReader& reader, SceneValue& effective) {
  std::vector<PairParameters> pairs;
  for (const SceneValue* one : tables_and_keep(reader, "pair", effective)) {
    TableReader table(reader.context(), *one, "[[particles.pair]]", fmt::format("particles.pair.{}", pairs.size()));
    table.expect_only({"types", "epsilon", "sigma"});
    const SceneValue* types = table.find("types");
    const auto* list = types != nullptr ? types->get<SceneValue::Array>() : nullptr;
    if (list == nullptr || list->size() != 2) {
      table.fail(types, "types", "a pair has two types; give them as types = [\"A\", \"B\"]");
    }
    const auto epsilon = table.quantity("epsilon", "energy"), sigma = table.quantity("sigma", "length");
    for (const auto& [key, value] : {std::pair("epsilon", epsilon), std::pair("sigma", sigma)}) {
      if (!value) table.fail(nullptr, key, fmt::format("this [[particles.pair]] has no {}; give one", key));
    }
    pairs.push_back({type_name(table, "types", (*list)[0]), type_name(table, "types", (*list)[1]), *epsilon, *sigma});
  }
  return pairs;
}

void refuse_particle_key(TableReader& reader, const Error& error) {
  const std::string& key = error.key();
  const std::size_t dot = key.find('.');
  if (dot == std::string::npos) reader.fail(key, error.message());
  std::size_t number = 0;
  std::from_chars(key.data() + dot + 1, key.data() + key.size(), number);
  const std::string list = key.substr(0, dot);
  reader.fail(tables_of(reader, list).at(number), key, error.message());
}

void refuse_without_mass(TableReader& body) {
  const SceneValue* anomaly = body.find("M");
  if (const std::string* text = anomaly != nullptr ? anomaly->get<std::string>() : nullptr) {
    bool is_mass = true;
    try {
      parse_quantity(*text, dimensions::mass, *body.context().units);
    } catch (const Error&) {
      is_mass = false;
    }
    if (is_mass && !body.context().units->is_reduced()) {
      body.fail("M", fmt::format("M = \"{}\" is a mass, but M is the mean anomaly; did you mean 'mass'?", *text));
    }
  }
  body.fail(nullptr, "mass", fmt::format("{} has no mass; give one, or 0 for a tracer", body.what()));
}

void read_temperature(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective) {
  const auto temperature = reader.quantity("temperature", "temperature");
  const std::int64_t seed = reader.integer("seed").value_or(1);
  if (!temperature) {
    if (reader.has("seed")) reader.fail("seed", "seed has no effect without a temperature; give a temperature too");
    return;
  }
  try {
    set_temperature(s, *temperature, static_cast<std::uint64_t>(seed));
  } catch (const Error& error) {
    reader.refuse(error);
  }
  effective.put("temperature", *reader.find("temperature"));
  effective.put("seed", SceneValue::of(seed, reader.line("seed")));
}

}  // namespace noether
