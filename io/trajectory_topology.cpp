#include "io/trajectory_topology.hpp"

#include "engine/mesh.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace noether::io {

namespace {

// Texts of their own: nobody says which variable of several files is made first.
const std::string species_path = "/particles/system/species", order_path = "/noether/topology/order";

[[noreturn]] void refuse_topology(const Hdf5File& file, const std::string& what) {
  throw FileError("damaged: " + what, {.file = file.name()});
}

// ---- writing -------------------------------------------------------------------------------------------------------

/// Writes topologies; nothing that is empty.
class TopologyWriter {
 public:
  TopologyWriter(const Hdf5File& file, const std::vector<std::int64_t>& ids) : file_(file), ids_(ids) {}

  template <std::size_t n> void write_elements(const std::string& name, const std::vector<BondedTerm<n>>& terms) const {
    std::vector<std::int64_t> tuples, kind_of_term;
    for (const BondedTerm<n>& term : terms) {
      for (const Index i : term.particles) tuples.push_back(id(i));
      kind_of_term.push_back(term.type);
    }
    if (!terms.empty()) {
      const std::string path = connectivity_path + "/" + name;
      file_.write(path, tuples, {static_cast<Index>(terms.size()), Index{n}});
      file_.set_reference(path, "particles_group", particles_path);
    }
    integers(name + "_kind", kind_of_term, 1);
  }
  template <std::size_t n>
  void write_terms(const std::string& name, const std::vector<BondedTerm<n>>& terms,
                   const std::vector<TermKind>& kinds) const {
    write_elements(name, terms);
    std::vector<std::string> potentials;
    std::vector<std::int64_t> counts;
    std::vector<double> parameters;
    for (const TermKind& kind : kinds) {
      potentials.push_back(kind.potential);
      counts.push_back(static_cast<std::int64_t>(kind.parameters.size()));
      parameters.insert(parameters.end(), kind.parameters.begin(), kind.parameters.end());
    }
    texts(name + "_potential", potentials);
    integers(name + "_parameter_count", counts, 1);
    reals(name + "_parameters", parameters, 1);
  }

  void write_pairs(const Topology& topology) const {
    std::vector<double> kinds, explicit_kinds, factors;
    std::vector<std::int64_t> types, excluded, scaled;
    for (const PairKind& kind : topology.pair_kinds) kinds.insert(kinds.end(), {kind.epsilon, kind.sigma});
    for (const auto& [pair, kind] : topology.explicit_pairs) {
      types.insert(types.end(), {pair.first, pair.second});
      explicit_kinds.insert(explicit_kinds.end(), {kind.epsilon, kind.sigma});
    }
    for (const Topology::Pair& pair : topology.exclusions)
      excluded.insert(excluded.end(), {id(pair.first), id(pair.second)});
    for (const Topology::ScaledPair& one : topology.scaled_pairs) {
      scaled.insert(scaled.end(), {id(one.pair.first), id(one.pair.second)});
      factors.push_back(one.factor);
    }
    reals("pair_kinds", kinds, 2);
    integers("pair_types", types, 2);
    reals("pair_parameters", explicit_kinds, 2);
    integers("excluded", excluded, 2);
    integers("scaled", scaled, 2);
    reals("scaled_factor", factors, 1);
    texts("mixing", {topology.mixing == Mixing::geometric ? "geometric" : "lorentz_berthelot"});
    if (topology.stated_cutoff != 0) reals("stated_cutoff", {topology.stated_cutoff}, 1);
  }

  /// Elements and surfaces as connectivity, and where each particle is in the bodies at rest; their edges for VMD.
  void write_mesh(const Mesh& mesh, const std::vector<Index>& order) const {
    write_elements("tetrahedra", mesh.tetrahedra);
    write_elements("triangles", mesh.triangles);
    texts("region_name", mesh.regions);
    texts("surface_name", mesh.surfaces);
    std::vector<double> rest;
    std::vector<std::int64_t> row(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const Vec3<double>& place = mesh.rest[static_cast<std::size_t>(order[k])];
      rest.insert(rest.end(), {place[0], place[1], place[2]});
      row[static_cast<std::size_t>(order[k])] = static_cast<std::int64_t>(k) + 1;
    }
    reals("rest", rest, 3);
    std::vector<std::int64_t> from, to;
    for (const auto& [i, j] : mesh.edges()) {
      from.push_back(row[static_cast<std::size_t>(i)]);
      to.push_back(row[static_cast<std::size_t>(j)]);
    }
    file_.write(vmd_structure_path + "/bond_from", from, {static_cast<Index>(from.size())});
    file_.write(vmd_structure_path + "/bond_to", to, {static_cast<Index>(to.size())});
  }

  void integers(const std::string& name, const std::vector<std::int64_t>& values, Index width) const {
    if (!values.empty()) file_.write(topology_path + "/" + name, values, shape(values.size(), width));
  }
  void reals(const std::string& name, const std::vector<double>& values, Index width) const {
    if (!values.empty()) file_.write(topology_path + "/" + name, values, shape(values.size(), width));
  }
  void texts(const std::string& name, const std::vector<std::string>& values) const {
    if (!values.empty()) file_.write(topology_path + "/" + name, values);
  }

 private:
  std::int64_t id(Index i) const { return ids_[static_cast<std::size_t>(i)]; }
  static std::vector<Index> shape(std::size_t values, Index width) {
    const Index rows = static_cast<Index>(values) / width;
    return width == 1 ? std::vector<Index>{rows} : std::vector<Index>{rows, width};
  }

  const Hdf5File& file_;
  const std::vector<std::int64_t>& ids_;
};

// ---- reading -------------------------------------------------------------------------------------------------------

/// Reads topologies: every number of a damaged file is looked at before it is taken for an index.
class TopologyReader {
 public:
  TopologyReader(const Hdf5File& file, const std::vector<std::int64_t>& ids, const std::vector<Index>& order)
      : file_(file) {
    for (std::size_t i = 0; i < order.size(); ++i)
      index_.emplace(ids[static_cast<std::size_t>(order[i])], static_cast<Index>(i));
  }

  template <std::size_t n>
  void read_terms(const std::string& name, std::vector<BondedTerm<n>>& terms, std::vector<TermKind>& kinds) const {
    kinds = read_kinds(name);
    read_elements(name, kinds.size(), terms);
  }
  /// @param kinds  that they may be of; 0: one without a name
  template <std::size_t n>
  void read_elements(const std::string& name, std::size_t kinds, std::vector<BondedTerm<n>>& terms) const {
    const std::string path = connectivity_path + "/" + name;
    if (!file_.has(path)) return;
    const std::vector<std::int64_t> tuples = rows_of(path, n), kind_of_term = integers(name + "_kind");
    if (tuples.size() != n * kind_of_term.size())
      refuse_topology(file_, fmt::format("{} and their kinds differ in number", name));
    for (std::size_t k = 0; k < kind_of_term.size(); ++k) {
      BondedTerm<n> term;
      for (std::size_t j = 0; j < n; ++j) term.particles[j] = index(tuples[n * k + j]);
      term.type = static_cast<int>(below(kind_of_term[k], std::max<std::size_t>(kinds, 1), name + "_kind"));
      terms.push_back(term);
    }
  }

  /// @param order  the row of each particle
  std::shared_ptr<const Mesh> read_mesh(const std::vector<Index>& order) const {
    if (!file_.has(connectivity_path + "/tetrahedra")) return nullptr;
    auto mesh = std::make_shared<Mesh>();
    mesh->regions = texts("region_name");
    mesh->surfaces = texts("surface_name");
    read_elements("tetrahedra", mesh->regions.size(), mesh->tetrahedra);
    read_elements("triangles", mesh->surfaces.size(), mesh->triangles);
    const std::vector<double> rest = reals("rest");
    if (rest.size() != 3 * order.size()) refuse_topology(file_, "ids and places at rest differ in number");
    for (const Index row : order) {
      const auto at = 3 * static_cast<std::size_t>(row);
      mesh->rest.emplace_back(rest[at], rest[at + 1], rest[at + 2]);
    }
    try {
      mesh->check(static_cast<Index>(order.size()));
    } catch (const Error& error) {
      refuse_topology(file_, error.message());
    }
    return mesh;
  }

  void read_pairs(Topology& topology) const {
    const std::vector<double> kinds = reals("pair_kinds"), explicit_kinds = reals("pair_parameters"),
                              factors = reals("scaled_factor"), cutoff = reals("stated_cutoff");
    const std::vector<std::int64_t> types = integers("pair_types"), scaled = integers("scaled");
    for (std::size_t k = 0; k + 1 < kinds.size(); k += 2) topology.pair_kinds.push_back({kinds[k], kinds[k + 1]});
    if (types.size() != explicit_kinds.size() || scaled.size() != 2 * factors.size())
      refuse_topology(file_, "pairs and their parameters differ in number");
    const auto most = static_cast<std::size_t>(topology.type_count());
    for (std::size_t k = 0; k + 1 < types.size(); k += 2) {
      const auto first = static_cast<int>(below(types[k], most, "pair_types")),
                 second = static_cast<int>(below(types[k + 1], most, "pair_types"));
      topology.explicit_pairs[{first, second}] = {explicit_kinds[k], explicit_kinds[k + 1]};
    }
    topology.exclusions = pairs(integers("excluded"));
    const std::vector<Topology::Pair> of_factors = pairs(scaled);
    for (std::size_t k = 0; k < of_factors.size(); ++k) topology.scaled_pairs.push_back({of_factors[k], factors[k]});
    std::sort(topology.scaled_pairs.begin(), topology.scaled_pairs.end(),
              [](const auto& a, const auto& b) { return a.pair < b.pair; });
    std::sort(topology.exclusions.begin(), topology.exclusions.end());
    const std::vector<std::string> mixing = texts("mixing");
    if (mixing == std::vector<std::string>{"geometric"}) topology.mixing = Mixing::geometric;
    if (!cutoff.empty()) topology.stated_cutoff = cutoff[0];
  }

  std::vector<std::int64_t> integers(const std::string& name) const {
    const std::string path = topology_path + "/" + name;
    return file_.has(path) ? file_.open(path).read_integers() : std::vector<std::int64_t>{};
  }
  std::vector<std::string> texts(const std::string& name) const {
    const std::string path = topology_path + "/" + name;
    return file_.has(path) ? file_.open(path).read_texts() : std::vector<std::string>{};
  }
  std::int64_t below(std::int64_t number, std::size_t most, const std::string& what) const {
    if (number >= 0 && number < static_cast<std::int64_t>(most)) return number;
    refuse_topology(file_, fmt::format("'{}' contains {} where there are {}", what, number, most));
  }

 private:
  std::vector<double> reals(const std::string& name) const {
    const std::string path = topology_path + "/" + name;
    if (!file_.has(path)) return {};
    std::vector<double> values = file_.open(path).read_reals();
    if (std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) return values;
    refuse_topology(file_, fmt::format("'{}' contains a value that is not finite", path));
  }
  std::vector<std::int64_t> rows_of(const std::string& path, std::size_t width) const {
    const Hdf5Dataset dataset = file_.open(path);
    const std::vector<Index> shape = dataset.shape();
    if (shape.size() == 2 && shape[1] == static_cast<Index>(width)) return dataset.read_integers();
    refuse_topology(file_, fmt::format("'{}' does not have the shape (m, {})", path, width));
  }
  std::vector<TermKind> read_kinds(const std::string& name) const {
    const std::vector<std::string> potentials = texts(name + "_potential");
    const std::vector<std::int64_t> counts = integers(name + "_parameter_count");
    const std::vector<double> parameters = reals(name + "_parameters");
    if (potentials.size() != counts.size())
      refuse_topology(file_, fmt::format("kinds of {} and their parameters differ in number", name));
    std::vector<TermKind> kinds;
    std::size_t first = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const std::size_t left = parameters.size() - first;
      const auto count = static_cast<std::size_t>(below(counts[k], left + 1, name + "_parameter_count"));
      const auto from = parameters.begin() + static_cast<std::ptrdiff_t>(first);
      kinds.push_back({potentials[k], {from, from + static_cast<std::ptrdiff_t>(count)}});
      first += count;
    }
    return kinds;
  }
  std::vector<Topology::Pair> pairs(const std::vector<std::int64_t>& numbers) const {
    std::vector<Topology::Pair> found;
    for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) {
      const Index a = index(numbers[k]), b = index(numbers[k + 1]);
      found.emplace_back(std::min(a, b), std::max(a, b));
    }
    return found;
  }
  Index index(std::int64_t id) const {
    const auto found = index_.find(id);
    if (found != index_.end()) return found->second;
    refuse_topology(file_, fmt::format("a bond or a pair names the id {}, which no particle has", id));
  }

  const Hdf5File& file_;
  std::unordered_map<std::int64_t, Index> index_;
};

/// The type of each row, from 0; empty where particles have none.
std::vector<std::int64_t> read_types(const Hdf5File& file, Index rows) {
  if (!file.has(topology_path + "/type_name") || !file.has(species_path)) return {};
  std::vector<std::int64_t> types = file.open(species_path).read_integers();
  if (static_cast<Index>(types.size()) != rows) refuse_topology(file, "ids and species differ in number");
  for (std::int64_t& type : types) --type;
  return types;
}

}  // namespace

void write_topology(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order) {
  const TopologyWriter writer(file, state.ids());
  if (!std::is_sorted(order.begin(), order.end())) {
    std::vector<std::int64_t> rows(order.size());
    for (std::size_t row = 0; row < order.size(); ++row)
      rows[static_cast<std::size_t>(order[row])] = static_cast<std::int64_t>(row);
    writer.integers("order", rows, 1);
  }
  const Topology* topology = state.topology();
  if (topology == nullptr) return;
  if (!topology->types.empty()) {
    std::vector<std::int64_t> species;
    for (const Index i : order) species.push_back(topology->type(i) + 1);
    file.write(species_path, species, {state.size()});
    std::vector<std::string> names = topology->type_names;
    for (int k = static_cast<int>(names.size()); k < topology->type_count(); ++k)
      names.push_back(std::to_string(k + 1));
    writer.texts("type_name", names);
  }
  if (!topology->molecules.empty()) {
    std::vector<std::int64_t> molecules;
    for (const Index i : order) molecules.push_back(topology->molecules[static_cast<std::size_t>(i)]);
    writer.integers("molecule", molecules, 1);
  }
  writer.write_terms("bonds", topology->bonds, topology->bond_kinds);
  writer.write_terms("angles", topology->angles, topology->angle_kinds);
  writer.write_terms("dihedrals", topology->dihedrals, topology->dihedral_kinds);
  writer.write_terms("impropers", topology->impropers, topology->improper_kinds);
  if (topology->mesh != nullptr) writer.write_mesh(*topology->mesh, order);
  writer.write_pairs(*topology);
}

std::vector<std::string> read_type_names(const Hdf5File& file, Index rows) {
  std::vector<std::string> names;
  const std::vector<std::int64_t> types = read_types(file, rows);
  if (types.empty()) return names;
  const std::vector<std::string> known = file.open(topology_path + "/type_name").read_texts();
  for (const std::int64_t type : types) {
    if (type < 0 || type >= static_cast<std::int64_t>(known.size()))
      refuse_topology(file, fmt::format("the species {} is not one of the {} types", type + 1, known.size()));
    names.push_back(known[static_cast<std::size_t>(type)]);
  }
  return names;
}

std::vector<Index> read_order(const Hdf5File& file, Index rows) {
  std::vector<Index> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), Index{0});
  if (!file.has(order_path)) return order;
  const std::vector<std::int64_t> stored = file.open(order_path).read_integers();
  std::vector<Index> sorted(stored.begin(), stored.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted != order) refuse_topology(file, fmt::format("'{}' does not name each particle once", order_path));
  order.assign(stored.begin(), stored.end());
  return order;
}

std::shared_ptr<const Topology> read_topology(const Hdf5File& file, const std::vector<std::int64_t>& ids,
                                              const std::vector<Index>& order) {
  const TopologyReader reader(file, ids, order);
  const std::vector<std::string> mixing = reader.texts("mixing");
  if (mixing.empty()) return nullptr;  // it is written with every topology
  Topology topology;
  topology.type_names = reader.texts("type_name");
  const std::vector<std::int64_t> types = read_types(file, static_cast<Index>(ids.size())),
                                  molecules = reader.integers("molecule");
  if (!molecules.empty() && molecules.size() != ids.size()) refuse_topology(file, "ids and molecules differ in number");
  for (const Index row : order) {
    const auto at = static_cast<std::size_t>(row);
    if (!types.empty()) topology.types.push_back(reader.below(types[at], topology.type_names.size(), species_path));
    if (!molecules.empty()) topology.molecules.push_back(molecules[at]);
  }
  reader.read_terms("bonds", topology.bonds, topology.bond_kinds);
  reader.read_terms("angles", topology.angles, topology.angle_kinds);
  reader.read_terms("dihedrals", topology.dihedrals, topology.dihedral_kinds);
  reader.read_terms("impropers", topology.impropers, topology.improper_kinds);
  topology.mesh = reader.read_mesh(order);
  reader.read_pairs(topology);
  return std::make_shared<const Topology>(std::move(topology));
}

}  // namespace noether::io
