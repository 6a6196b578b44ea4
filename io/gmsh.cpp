// Meshes of Gmsh, .msh 2.2 and 4.1 in ASCII.
#include "engine/mesh.hpp"
#include "io/structure_parts.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

namespace noether::io {

namespace {

/// Kinds of elements that a mesh is made of here, and how many nodes they have.
constexpr std::int64_t line_element = 1, triangle_element = 2, tetrahedron_element = 4, point_element = 15;

/// What is known of kinds that are not taken.
std::string_view kind_of_element(std::int64_t kind) {
  switch (kind) {
    case 3:
      return "a quadrangle";
    case 5:
      return "a hexahedron";
    case 6:
      return "a prism";
    case 7:
      return "a pyramid";
    case 9:
      return "a triangle of second order";
    case 11:
      return "a tetrahedron of second order";
    default:
      return "of a kind that is not supported";
  }
}

class GmshReader {
 public:
  GmshReader(const TextFile& text, double length, const StructureOptions& options)
      : text_(text), length_(length), options_(options) {}

  Structure read() {
    find_sections();
    read_format();
    read_names();
    if (has("Entities") && version_ > 4) read_entities();
    version_ > 4 ? read_nodes_by_entity() : read_nodes();
    version_ > 4 ? read_elements_by_entity() : read_elements();
    return structure();
  }

 private:
  // ---- lines and sections ---------------------------------------------------------------------------------------

  void find_sections() {
    const auto& lines = text_.lines();
    for (std::size_t line = 1; line <= lines.size(); ++line) {
      const std::string_view content = trimmed(lines[line - 1]);
      if (content.size() < 2 || content[0] != '$' || content.starts_with("$End")) continue;
      const std::string name(content.substr(1));
      if (!sections_.emplace(name, line).second) text_.fail(line, fmt::format("${} appears twice", name), name);
    }
    for (const char* needed : {"MeshFormat", "Nodes", "Elements"}) {
      if (!has(needed)) text_.fail(0, fmt::format("there is no ${}, as a mesh of Gmsh has", needed));
    }
  }
  bool has(const std::string& section) const { return sections_.count(section) == 1; }
  void begin(const std::string& section) { line_ = sections_.at(section); }

  /// The words of the next line that is not empty; `what` names what is expected there.
  const std::vector<std::string_view>& next(std::string_view what, std::size_t least) {
    do {
      ++line_;
      if (line_ > text_.lines().size()) text_.fail(line_ - 1, fmt::format("the file ends where {} is expected", what));
      split_words(text_.lines()[line_ - 1], words_);
    } while (words_.empty());
    if (words_[0].starts_with("$")) text_.fail(line_, fmt::format("the section ends where {} is expected", what));
    if (words_.size() < least) {
      text_.fail(line_, fmt::format("{} has {} {}; {} are expected", what, words_.size(),
                                    words_.size() == 1 ? "number" : "numbers", least));
    }
    return words_;
  }
  std::int64_t whole(std::size_t word, std::string_view what, std::int64_t least = 0,
                     std::int64_t most = most_particles) const {
    if (word >= words_.size()) text_.fail(line_, fmt::format("the line ends where {} is expected", what));
    return whole_number_in(text_, line_, words_[word], what, least, most);
  }
  /// A tag of an entity or a group. A minus says only that a surface is turned over.
  std::int64_t tag(std::size_t word, std::string_view what) const {
    return std::abs(whole(word, what, -most_particles, most_particles));
  }

  // ---- sections -------------------------------------------------------------------------------------------------

  void read_format() {
    begin("MeshFormat");
    next("the version", 3);
    version_ = number_in(text_, line_, words_[0], "the version");
    const std::string version(words_[0]);
    if (version != "2.2" && version != "4.1") {
      text_.fail(
          line_,
          fmt::format("the mesh has version {}; 2.2 and 4.1 are supported: give Mesh.MshFileVersion = 4.1 to Gmsh",
                      version),
          version);
    }
    if (whole(1, "the kind of file", 0, 1) == 1) {
      text_.fail(line_, "the mesh is binary; ASCII is expected: give Mesh.Binary = 0 to Gmsh");
    }
  }

  void read_names() {
    if (!has("PhysicalNames")) return;
    begin("PhysicalNames");
    next("the number of names", 1);
    const std::int64_t count = whole(0, "the number of names");
    for (std::int64_t k = 0; k < count; ++k) {
      next("a name", 3);
      const std::int64_t dimension = whole(0, "a dimension", 0, 3), group = tag(1, "a group");
      const std::string& content = text_.lines()[line_ - 1];
      const std::size_t from = content.find('"'), to = content.rfind('"');
      if (from == std::string::npos || to == from) text_.fail(line_, "the name of a group is not in quotes");
      names_[{dimension, group}] = content.substr(from + 1, to - from - 1);
    }
  }

  /// The groups of each entity.
  void read_entities() {
    if (has("PartitionedEntities")) {
      text_.fail(sections_.at("PartitionedEntities"),
                 "the mesh is divided into partitions; a whole one is expected: give Mesh.PartitionCreateTopology = 0 "
                 "to Gmsh, or do not partition it");
    }
    begin("Entities");
    next("the numbers of entities", 4);
    std::array<std::int64_t, 4> counts{};
    for (std::size_t d = 0; d < 4; ++d) counts[d] = whole(d, "a number of entities");
    for (std::size_t d = 0; d < 4; ++d) {
      const std::size_t bounds = d == 0 ? 3 : 6;
      for (std::int64_t k = 0; k < counts[d]; ++k) {
        next("an entity", bounds + 2);
        const std::int64_t count_of_groups = whole(bounds + 1, "a number of groups");
        std::vector<std::int64_t>& groups = groups_of_[{static_cast<std::int64_t>(d), tag(0, "an entity")}];
        for (std::int64_t g = 0; g < count_of_groups; ++g) {
          groups.push_back(tag(bounds + 2 + static_cast<std::size_t>(g), "a group"));
        }
        if (d == 3 && groups.size() > 1) {
          text_.fail(line_, fmt::format("volume {} is in the physical volumes {}; put it into one", words_[0],
                                        fmt::join(groups, " and ")));
        }
      }
    }
  }

  void read_nodes() {
    begin("Nodes");
    next("the number of nodes", 1);
    const std::int64_t count = whole(0, "the number of nodes");
    for (std::int64_t k = 0; k < count; ++k) {
      next("a node", 4);
      add_node(whole(0, "the number of a node", 1), 1);
    }
  }
  void read_nodes_by_entity() {
    begin("Nodes");
    next("the numbers of nodes", 4);
    const std::int64_t blocks = whole(0, "the number of blocks");
    std::vector<std::int64_t> tags;
    for (std::int64_t b = 0; b < blocks; ++b) {
      next("a block of nodes", 4);
      const std::int64_t count = whole(3, "the number of nodes");
      tags.clear();
      for (std::int64_t k = 0; k < count; ++k) {
        next("the number of a node", 1);
        tags.push_back(whole(0, "the number of a node", 1));
      }
      for (const std::int64_t node : tags) {
        next("the place of a node", 3);
        add_node(node, 0);
      }
    }
  }
  void add_node(std::int64_t node, std::size_t first_word) {
    Vec3<double> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[static_cast<int>(k)] =
          number_in(text_, line_, words_[first_word + k], std::string(1, static_cast<char>('x' + k))) * length_;
    }
    if (!places_.emplace(node, x).second) text_.fail(line_, fmt::format("node {} is given twice", node));
  }

  void read_elements() {
    begin("Elements");
    next("the number of elements", 1);
    const std::int64_t count = whole(0, "the number of elements");
    for (std::int64_t k = 0; k < count; ++k) {
      next("an element", 4);
      const std::int64_t kind = whole(1, "the kind of an element", 1);
      const auto tags = static_cast<std::size_t>(whole(2, "the number of tags", 0, 1000));
      add_element(kind, {tags > 0 ? tag(3, "a group") : 0}, 3 + tags);
    }
  }
  void read_elements_by_entity() {
    begin("Elements");
    next("the numbers of elements", 4);
    const std::int64_t blocks = whole(0, "the number of blocks");
    for (std::int64_t b = 0; b < blocks; ++b) {
      next("a block of elements", 4);
      const std::int64_t dimension = whole(0, "a dimension", 0, 3), entity = tag(1, "an entity");
      const std::int64_t kind = whole(2, "the kind of an element", 1), count = whole(3, "the number of elements");
      const auto found = groups_of_.find({dimension, entity});
      const bool grouped = found != groups_of_.end() && !found->second.empty();
      const std::vector<std::int64_t> groups = grouped ? found->second : std::vector<std::int64_t>{0};
      for (std::int64_t k = 0; k < count; ++k) {
        next("an element", 2);
        add_element(kind, groups, 1);
      }
    }
  }
  /// A triangle is there once for each of its groups, a tetrahedron has one.
  void add_element(std::int64_t kind, const std::vector<std::int64_t>& groups, std::size_t first_word) {
    if (kind == line_element || kind == point_element) return;
    if (kind == tetrahedron_element) {
      tetrahedra_.push_back({nodes<4>(first_word), group_number(regions_, groups.front()), line_});
    } else if (kind == triangle_element) {
      for (const std::int64_t group : groups) {
        triangles_.push_back({nodes<3>(first_word), group_number(surfaces_, group), line_});
      }
    } else {
      text_.fail(line_, fmt::format("this element is {}; tetrahedra of first order are expected, with triangles",
                                    kind_of_element(kind)));
    }
  }
  template <std::size_t n> std::array<std::int64_t, n> nodes(std::size_t first_word) const {
    std::array<std::int64_t, n> found{};
    for (std::size_t k = 0; k < n; ++k) found[k] = whole(first_word + k, "the number of a node", 1);
    return found;
  }
  /// The number of a group among those of its dimension, in the order in which they are met.
  static int group_number(std::vector<std::int64_t>& known, std::int64_t group) {
    const auto found = std::find(known.begin(), known.end(), group);
    if (found != known.end()) return static_cast<int>(found - known.begin());
    known.push_back(group);
    return static_cast<int>(known.size()) - 1;
  }

  // ---- the whole ------------------------------------------------------------------------------------------------

  template <std::size_t n> struct Element {
    std::array<std::int64_t, n> nodes;
    int group;
    std::size_t line;
  };

  std::vector<std::string> names_of(const std::vector<std::int64_t>& groups, std::int64_t dimension) const {
    std::vector<std::string> names;
    for (const std::int64_t group : groups) {
      const auto known = names_.find({dimension, group});
      names.push_back(known != names_.end() ? known->second : fmt::format("{}", group));
    }
    return names;
  }

  template <std::size_t n>
  BondedTerm<n> term_of(const Element<n>& element, const std::map<std::int64_t, Index>& index) const {
    BondedTerm<n> term;
    term.type = element.group;
    for (std::size_t k = 0; k < n; ++k) {
      const auto found = index.find(element.nodes[k]);
      if (found == index.end()) {
        text_.fail(element.line,
                   fmt::format("node {} {}", element.nodes[k],
                               places_.count(element.nodes[k]) == 0 ? "of this element is not in the mesh"
                                                                    : "of this triangle belongs to no tetrahedron"));
      }
      term.particles[k] = found->second;
    }
    return term;
  }

  void refuse_twins() const {
    std::vector<std::pair<std::array<std::int64_t, 4>, std::size_t>> all;
    for (const Element<4>& element : tetrahedra_) {
      all.emplace_back(element.nodes, element.line);
      std::sort(all.back().first.begin(), all.back().first.end());
    }
    std::sort(all.begin(), all.end());
    const auto twin =
        std::adjacent_find(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
    if (twin == all.end()) return;
    text_.fail(
        (twin + 1)->second,
        fmt::format("this tetrahedron is given in line {} already; put each into one physical volume", twin->second));
  }

  Structure structure() {
    if (tetrahedra_.empty()) {
      text_.fail(sections_.at("Elements"), "the mesh has no tetrahedra; let Gmsh mesh the volume, gmsh -3");
    }
    refuse_twins();
    // Nodes of tetrahedra are particles, in the order of their numbers; others carry no mass.
    std::map<std::int64_t, Index> index;
    for (const Element<4>& element : tetrahedra_) {
      for (const std::int64_t node : element.nodes) {
        if (places_.count(node) == 1) index.emplace(node, 0);
      }
    }
    Structure made;
    auto mesh = std::make_shared<Mesh>();
    for (auto& [node, at] : index) {
      at = static_cast<Index>(made.ids.size());
      made.ids.push_back(node);
      made.names.push_back(fmt::format("node_{}", node));
      mesh->rest.push_back(places_.at(node));
    }
    for (const Element<4>& element : tetrahedra_) mesh->tetrahedra.push_back(term_of(element, index));
    for (const Element<3>& element : triangles_) mesh->triangles.push_back(term_of(element, index));
    mesh->regions = names_of(regions_, 3);
    mesh->surfaces = names_of(surfaces_, 2);
    mesh->turn_outside_in();
    check(*mesh);
    made.masses = mesh->lumped_masses(densities(mesh->regions));
    made.x = mesh->rest;
    made.v.assign(made.x.size(), Vec3<double>::Zero());
    if (const std::size_t left = places_.size() - index.size(); left > 0) {
      note(options_, fmt::format("{} of the mesh {} to no tetrahedron and {} left out", counted_nodes(left),
                                 left == 1 ? "belongs" : "belong", left == 1 ? "is" : "are"));
    }
    made.topology.mesh = std::move(mesh);
    return made;
  }
  static std::string counted_nodes(std::size_t count) { return count == 1 ? "1 node" : fmt::format("{} nodes", count); }
  void check(const Mesh& mesh) const {
    try {
      mesh.check(static_cast<Index>(mesh.rest.size()));
    } catch (const Error& error) {
      text_.fail(0, error.message());
    }
  }
  std::vector<double> densities(const std::vector<std::string>& regions) const {
    if (options_.densities.empty()) {
      throw Error("a mesh does not say how heavy it is; give density = ...", {.key = "density"});
    }
    for (const auto& [name, density] : options_.densities) {
      if (name.empty() || std::find(regions.begin(), regions.end(), name) != regions.end()) continue;
      throw Error(
          fmt::format("density is given for '{}', but the regions of the mesh are {}", name, fmt::join(regions, ", ")),
          {.key = "density", .value = name});
    }
    std::vector<double> all;
    for (const std::string& name : regions) {
      const auto own = options_.densities.find(name), common = options_.densities.find("");
      if (own == options_.densities.end() && common == options_.densities.end()) {
        throw Error(fmt::format("no density is given for the region '{}' of the mesh", name), {.key = "density"});
      }
      all.push_back(own != options_.densities.end() ? own->second : common->second);
    }
    return all;
  }

  const TextFile& text_;
  double length_;
  const StructureOptions& options_;
  double version_ = 0;
  std::map<std::string, std::size_t> sections_;  ///< the line of each
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
  using Group = std::pair<std::int64_t, std::int64_t>;  ///< dimension and tag
  std::map<Group, std::string> names_;
  std::map<Group, std::vector<std::int64_t>> groups_of_;  ///< of each entity
  std::map<std::int64_t, Vec3<double>> places_;
  std::vector<std::int64_t> regions_, surfaces_;  ///< tags of groups
  std::vector<Element<4>> tetrahedra_;
  std::vector<Element<3>> triangles_;
};

/// The unit of length that `file_units` names; that of the system where it is empty.
double length_of(const StructureOptions& options) {
  if (options.file_units.empty()) return 1;
  try {
    return parse_quantity("1 " + options.file_units, dimensions::length, *options.units);
  } catch (const Error&) {
    throw Error(fmt::format("file_units = \"{}\" is not a unit of length{}, as a mesh needs one", options.file_units,
                            options.units->is_reduced() ? " of reduced units" : ""),
                {.key = "file_units", .value = options.file_units});
  }
}

}  // namespace

Structure read_gmsh(const TextFile& text, const StructureOptions& options) {
  return GmshReader(text, length_of(options), options).read();
}

}  // namespace noether::io
