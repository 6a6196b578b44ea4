// Extended XYZ, and plain XYZ: one frame.
#include "io/structure_parts.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace noether::io {

namespace {

/// What the comment of a frame says: key=value, values in double quotes where they have blanks.
using Comment = std::map<std::string, std::string>;

/// One property of a frame: where its columns begin, and how many there are.
struct XyzProperty {
  std::size_t column, count;
};

class ExtendedXyzReader {
 public:
  ExtendedXyzReader(const TextFile& text, const FileUnits& units) : text_(text), units_(units) {}

  Structure read() {
    if (text_.lines().empty()) text_.fail(0, "the file is empty; XYZ begins with the number of atoms");
    const std::string_view first = trimmed(text_.lines()[0]);
    const auto atoms =
        static_cast<std::size_t>(whole_number_in(text_, 1, first, "the number of atoms", 1, most_particles));
    if (text_.lines().size() < atoms + 2) {
      text_.fail(1, fmt::format("{} atoms are announced, but the file ends after {} of them", atoms,
                                std::max<std::size_t>(text_.lines().size(), 2) - 2));
    }
    read_comment();
    for (std::size_t line = 3; line < atoms + 3; ++line) read_atom(line);
    for (std::size_t line = atoms + 3; line <= text_.lines().size(); ++line) {
      if (trimmed(text_.lines()[line - 1]).empty()) continue;
      text_.fail(line,
                 fmt::format("there is more behind the {} atoms of the first frame; a structure is one frame", atoms));
    }
    return std::move(structure_);
  }

 private:
  void read_comment() {
    const Comment comment = parts_of(text_.lines()[1]);
    const auto properties = comment.find("Properties");
    read_properties(properties == comment.end() ? "species:S:1:pos:R:3" : properties->second);
    bool periodic = comment.count("Lattice") != 0;
    if (const auto pbc = comment.find("pbc"); pbc != comment.end()) periodic = is_periodic(pbc->second);
    if (!periodic) return;
    const auto lattice = comment.find("Lattice");
    if (lattice == comment.end()) text_.fail(2, "pbc is true, but there is no Lattice");
    read_lattice(lattice->second);
  }

  Comment parts_of(std::string_view line) const {
    Comment comment;
    while (true) {
      line = trimmed(line);
      const std::size_t mark = line.find('='), blank = line.find_first_of(" \t");
      if (line.empty()) return comment;
      if (mark == std::string_view::npos || (blank < mark)) {  // a lone word
        line.remove_prefix(std::min(blank, line.size()));
        continue;
      }
      const std::string key(line.substr(0, mark));
      line.remove_prefix(mark + 1);
      const bool quoted = line.starts_with('"');
      if (quoted) line.remove_prefix(1);
      const std::size_t end = quoted ? line.find('"') : std::min(line.find_first_of(" \t"), line.size());
      if (end == std::string_view::npos) text_.fail(2, fmt::format("a double quote behind '{}=' is not closed", key));
      comment[key] = std::string(line.substr(0, end));
      line.remove_prefix(end + (quoted ? 1 : 0));
    }
  }

  /// All three directions, or none.
  bool is_periodic(const std::string& value) const {
    std::vector<std::string_view> words;
    split_words(value, words);
    int periodic = 0;
    for (const std::string_view word : words) {
      const bool yes = word == "T" || word == "True" || word == "true" || word == "1";
      if (!yes && word != "F" && word != "False" && word != "false" && word != "0") words.clear();
      periodic += yes ? 1 : 0;
    }
    if (words.size() != 3)
      text_.fail(2, fmt::format("pbc=\"{}\" is not understood; \"T T T\" or \"F F F\" is expected", value));
    if (periodic != 0 && periodic != 3) {
      text_.fail(
          2, fmt::format("pbc=\"{}\" is periodic in {} of 3 directions; all or none are expected", value, periodic));
    }
    return periodic == 3;
  }

  void read_lattice(const std::string& value) {
    std::vector<std::string_view> words;
    split_words(value, words);
    if (words.size() != 9) text_.fail(2, fmt::format("Lattice has {} numbers; 9 are expected", words.size()));
    Vec3<double> edges;
    for (std::size_t k = 0; k < 9; ++k) {
      const double number = number_in(text_, 2, words[k], "a number of Lattice");
      if (k % 4 == 0) edges[static_cast<int>(k / 4)] = number * units_.length;
      if (k % 4 == 0 || number == 0) continue;
      text_.fail(2, fmt::format("Lattice=\"{}\" is not orthogonal along the axes; boxes are", value));
    }
    structure_.box = box_in(text_, 2, edges);
  }

  void read_properties(const std::string& value) {
    std::vector<std::string> words(1);
    for (const char c : value) {
      if (c == ':') words.emplace_back();
      if (c != ':') words.back() += c;
    }
    if (words.size() % 3 != 0) {
      text_.fail(2, fmt::format("Properties={} is not of the form name:type:columns:...", value), value);
    }
    for (std::size_t k = 0; k < words.size(); k += 3) {
      const auto count = static_cast<std::size_t>(
          whole_number_in(text_, 2, words[k + 2], fmt::format("the columns of property '{}'", words[k]), 1, 1000));
      if (!properties_.try_emplace(words[k], XyzProperty{columns_, count}).second) {
        text_.fail(2, fmt::format("property '{}' stands twice", words[k]), words[k]);
      }
      columns_ += count;
    }
    species_ = property({"species"}, 1);
    position_ = property({"pos"}, 3);
    for (const auto& [name, wanted] : {std::pair("species", species_), std::pair("pos", position_)}) {
      if (!wanted) text_.fail(2, fmt::format("there is no property '{}' in Properties={}", name, value), value);
    }
    velocity_ = property({"velo", "vel"}, 3);
    momentum_ = property({"momenta"}, 3);
    charge_ = property({"charge", "initial_charges"}, 1);
    mass_ = property({"mass", "masses"}, 1);
    if (velocity_ && momentum_) text_.fail(2, "there are both velocities and momenta; one of them is expected");
  }

  /// The first of these properties that is there.
  std::optional<XyzProperty> property(const std::vector<std::string>& names, std::size_t count) const {
    for (const std::string& name : names) {
      const auto found = properties_.find(name);
      if (found == properties_.end()) continue;
      if (found->second.count == count) return found->second;
      text_.fail(2, fmt::format("property '{}' has {} columns; expected {}", name, found->second.count, count), name);
    }
    return {};
  }

  void read_atom(std::size_t line) {
    split_words(text_.lines()[line - 1], words_);
    if (words_.size() != columns_) {
      text_.fail(line,
                 fmt::format("this atom has {} columns; expected {}, as Properties say", words_.size(), columns_));
    }
    const std::string species(words_[species_->column]);
    if (const std::string wrong = wrong_name(species); !wrong.empty()) text_.fail(line, wrong, species);
    const auto number = static_cast<std::int64_t>(structure_.ids.size()) + 1;
    structure_.ids.push_back(number);
    structure_.names.push_back(fmt::format("{}_{}", species, number));
    structure_.topology.types.push_back(type_of(species));
    const double mass =
        mass_ ? mass_number_in(text_, line, words_[mass_->column], "the mass") : standard_atomic_weight(species);
    structure_.masses.push_back(mass);
    structure_.x.push_back(vector(line, *position_, "pos") * units_.length);
    structure_.v.push_back(velocity(line, mass, species));
    if (charge_) structure_.charges.push_back(number_in(text_, line, words_[charge_->column], "the charge"));
  }

  Vec3<double> velocity(std::size_t line, double mass, const std::string& species) const {
    if (velocity_) return vector(line, *velocity_, "velo") * units_.velocity;
    if (!momentum_) return Vec3<double>::Zero();
    if (!(mass > 0)) text_.fail(line, fmt::format("momenta are given, but no mass of '{}'", species), species);
    return vector(line, *momentum_, "momenta") * (units_.momentum_velocity / mass);
  }

  Vec3<double> vector(std::size_t line, const XyzProperty& property, const std::string& name) const {
    Vec3<double> v;
    for (std::size_t k = 0; k < 3; ++k)
      v[static_cast<int>(k)] = number_in(text_, line, words_[property.column + k], name);
    return v;
  }

  std::int64_t type_of(const std::string& species) {
    const auto count = static_cast<std::int64_t>(types_.size());
    const auto [at, fresh] = types_.try_emplace(species, count);
    if (fresh) structure_.topology.type_names.push_back(species);
    return at->second;
  }

  const TextFile& text_;
  FileUnits units_;
  Structure structure_;
  std::map<std::string, XyzProperty> properties_;
  std::size_t columns_ = 0;
  std::optional<XyzProperty> species_, position_, velocity_, momentum_, charge_, mass_;
  std::map<std::string, std::int64_t> types_;
  std::vector<std::string_view> words_;
};

}  // namespace

Structure read_extended_xyz(const TextFile& text, const FileUnits& units) {
  return ExtendedXyzReader(text, units).read();
}

}  // namespace noether::io
