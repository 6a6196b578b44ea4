#include "cli/particle_links.hpp"

#include "cli/run_caption.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>

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
  std::size_t size() const { return by_id_.size(); }
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

Drawn drawn_as(const std::string& type, const Parts& parts) {
  for (const Parts::ConstraintKind& kind : parts.constraints()) {
    if (kind.info.name == type) return kind.drawn;
  }
  return Drawn::nothing;
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

void add_link(ParticleLinks& links, const std::optional<std::size_t>& a, const std::optional<std::size_t>& b) {
  if (a && b && *a != *b) links.pairs.emplace_back(*a, *b);
}

void add_pairs(ParticleLinks& links, const SceneValue& constraint, const Shown& shown) {
  for (const SceneValue& pair : list_at(constraint, "pairs")) {
    const SceneValue::Array* ends = pair.get<SceneValue::Array>();
    if (ends != nullptr && ends->size() == 2) add_link(links, shown.name(ends->front()), shown.name(ends->back()));
  }
  const SceneValue::Array& chain = list_at(constraint, "chain");
  if (chain.size() != 2) return;
  const auto first = shown.name(chain[0]), last = shown.name(chain[1]);
  if (!first || !last) return;
  for (std::size_t i = std::min(*first, *last); i < std::max(*first, *last); ++i) add_link(links, i, i + 1);
}

/// Particles in line, each with the next.
void add_chain(ParticleLinks& links, const SceneValue& constraint, const Shown& shown) {
  const SceneValue::Array& bodies = list_at(constraint, "bodies");
  for (std::size_t k = 1; k < bodies.size(); ++k) add_link(links, shown.name(bodies[k - 1]), shown.name(bodies[k]));
}

void add_rods(ParticleLinks& links, const SceneValue& constraint, const Shown& shown, const UnitSystem& units) {
  const SceneValue::Array& bodies = list_at(constraint, "bodies");
  const bool all = text_at(constraint, {"bodies"}) == "all";
  if ((all ? shown.size() : bodies.size()) > most_rods) return;
  const SceneValue::Array& center = list_at(constraint, "center");
  Vec3<double> point = Vec3<double>::Zero();
  for (std::size_t k = 0; k < 3 && center.size() == 3; ++k) point[static_cast<Index>(k)] = length_of(center[k], units);
  for (std::size_t i = 0; all && i < shown.size(); ++i) links.anchors.push_back({i, point});
  for (const SceneValue& body : bodies) {
    if (const auto i = shown.name(body)) links.anchors.push_back({*i, point});
  }
}

}  // namespace

ParticleLinks read_links(const io::Hdf5File& file, const SceneValue& scene, const Parts& parts, const UnitSystem& units,
                         const io::Frames& shared, const std::vector<std::size_t>& rows) {
  const Shown shown(shared, rows);
  ParticleLinks links;
  if (const std::string bonds = io::connectivity_path + "/bonds"; file.has(bonds)) {
    const std::vector<std::int64_t> ids = file.open(bonds).read_integers();
    for (std::size_t k = 0; k + 1 < ids.size(); k += 2) add_link(links, shown.id(ids[k]), shown.id(ids[k + 1]));
  }
  for (const SceneValue* constraint : tables_at(scene, {"hamiltonian", "constraint"})) {
    const Drawn drawn = drawn_as(text_at(*constraint, {"type"}), parts);
    if (drawn == Drawn::link) add_pairs(links, *constraint, shown);
    if (drawn == Drawn::chain) add_chain(links, *constraint, shown);
    if (drawn == Drawn::rod) add_rods(links, *constraint, shown, units);
  }
  return links;
}

std::vector<std::size_t> molecules_of(std::size_t n, const ParticleLinks& links) {
  std::vector<std::size_t> above(n);
  std::iota(above.begin(), above.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (above[i] != i) i = above[i] = above[above[i]];
    return i;
  };
  for (const auto& [i, j] : links.pairs) above[root(i)] = root(j);
  std::vector<std::size_t> molecules(n);
  std::unordered_map<std::size_t, std::size_t> numbers;
  for (std::size_t i = 0; i < n; ++i) molecules[i] = numbers.try_emplace(root(i), numbers.size()).first->second;
  return molecules;
}

}  // namespace noether
