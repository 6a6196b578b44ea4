#include "cli/view_links.hpp"

#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

namespace noether {

namespace {

/// More bodies than these on one sphere are beads on it, not ends of rods.
constexpr std::size_t most_rods = 3;

/// Where each particle of the file stands in the picture.
class Shown {
 public:
  Shown(const io::Frames& shared, const std::vector<std::size_t>& rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      by_id_.emplace(shared.ids[rows[k]], k);
      by_name_.emplace(shared.names[rows[k]], k);
    }
  }
  std::optional<std::size_t> id(std::int64_t id) const { return found(by_id_, id); }
  std::optional<std::size_t> name(const SceneValue& value) const {
    const std::string* text = value.get<std::string>();
    return text == nullptr ? std::nullopt : found(by_name_, *text);
  }

 private:
  template <class Key> static std::optional<std::size_t> found(const std::map<Key, std::size_t>& all, const Key& key) {
    const auto at = all.find(key);
    return at == all.end() ? std::nullopt : std::optional(at->second);
  }
  std::map<std::int64_t, std::size_t> by_id_;
  std::map<std::string, std::size_t> by_name_;
};

/// The tables of a list such as `[[hamiltonian.force]]`.
std::vector<const SceneValue*> tables_of(const SceneValue& scene, std::string_view list) {
  std::vector<const SceneValue*> tables;
  const SceneValue* hamiltonian = scene.find("hamiltonian");
  const SceneValue* found = hamiltonian == nullptr ? nullptr : hamiltonian->find(list);
  if (found == nullptr || !found->is_table_list()) return tables;
  for (const SceneValue& one : *found->get<SceneValue::Array>()) tables.push_back(&one);
  return tables;
}

std::string type_of(const SceneValue& table) {
  const SceneValue* type = table.find("type");
  const std::string* text = type == nullptr ? nullptr : type->get<std::string>();
  return text == nullptr ? "" : *text;
}

const SceneValue::Array& list_at(const SceneValue& table, std::string_view key) {
  static const SceneValue::Array none;
  const SceneValue* value = table.find(key);
  const SceneValue::Array* list = value == nullptr ? nullptr : value->get<SceneValue::Array>();
  return list == nullptr ? none : *list;
}

double length_of(const SceneValue& value, const UnitSystem& units) {
  if (const double* number = value.get<double>()) return *number;
  if (const std::int64_t* whole = value.get<std::int64_t>()) return static_cast<double>(*whole);
  const std::string* text = value.get<std::string>();
  return text == nullptr ? 0 : parse_quantity(*text, dimensions::length, units);
}

void add_link(ViewData& data, const std::optional<std::size_t>& a, const std::optional<std::size_t>& b) {
  if (a && b && *a != *b) data.links.insert(data.links.end(), {*a, *b});
}

void add_distances(ViewData& data, const SceneValue& constraint, const Shown& shown) {
  for (const SceneValue& pair : list_at(constraint, "pairs")) {
    const SceneValue::Array* ends = pair.get<SceneValue::Array>();
    if (ends != nullptr && ends->size() == 2) add_link(data, shown.name(ends->front()), shown.name(ends->back()));
  }
  const SceneValue::Array& chain = list_at(constraint, "chain");
  if (chain.size() != 2) return;
  const auto first = shown.name(chain[0]), last = shown.name(chain[1]);
  if (!first || !last) return;
  for (std::size_t i = std::min(*first, *last); i < std::max(*first, *last); ++i) add_link(data, i, i + 1);
}

void add_rods(ViewData& data, const SceneValue& constraint, const Shown& shown, const UnitSystem& units) {
  const SceneValue::Array& bodies = list_at(constraint, "bodies");
  if (bodies.size() > most_rods) return;
  const SceneValue::Array& center = list_at(constraint, "center");
  Vec3<double> point = Vec3<double>::Zero();
  for (std::size_t k = 0; k < 3 && center.size() == 3; ++k) point[static_cast<Index>(k)] = length_of(center[k], units);
  for (const SceneValue& body : bodies) {
    if (const auto i = shown.name(body)) data.anchors.push_back({*i, point});
  }
}

}  // namespace

void read_links(ViewData& data, const io::Hdf5File& file, const SceneValue& scene, const UnitSystem& units,
                const io::Frames& shared, const std::vector<std::size_t>& rows) {
  const Shown shown(shared, rows);
  if (const std::string bonds = io::connectivity_path + "/bonds"; file.has(bonds)) {
    const std::vector<std::int64_t> ids = file.open(bonds).read_integers();
    for (std::size_t k = 0; k + 1 < ids.size(); k += 2) add_link(data, shown.id(ids[k]), shown.id(ids[k + 1]));
  }
  for (const SceneValue* constraint : tables_of(scene, "constraint")) {
    const std::string type = type_of(*constraint);
    if (type == "distance") add_distances(data, *constraint, shown);
    if (type == "on_sphere") add_rods(data, *constraint, shown, units);
  }
}

bool has_gravity(const SceneValue& scene) {
  const SceneValue* hamiltonian = scene.find("hamiltonian");
  if (hamiltonian == nullptr) return false;
  const std::string type = type_of(*hamiltonian);
  if (type == "wisdom_holman" || type == "hybrid") return true;
  const auto forces = tables_of(scene, "force");
  return std::any_of(forces.begin(), forces.end(),
                     [](const SceneValue* force) { return type_of(*force).starts_with("gravity"); });
}

double constant_of_gravity(const SceneValue& scene, double of_units) {
  std::vector<const SceneValue*> tables = tables_of(scene, "force");
  if (const SceneValue* hamiltonian = scene.find("hamiltonian")) tables.push_back(hamiltonian);
  for (const SceneValue* table : tables) {
    const SceneValue* G = table->find("G");
    if (G == nullptr) continue;
    if (const double* number = G->get<double>()) return *number;
    if (const std::int64_t* whole = G->get<std::int64_t>()) return static_cast<double>(*whole);
  }
  return of_units;
}

}  // namespace noether
