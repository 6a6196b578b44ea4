// Structures of GROMACS, .gro: fixed columns, positions in nm, velocities in nm/ps.
#include "io/structure_parts.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace noether::io {

namespace {

class GroReader {
 public:
  GroReader(const TextFile& text, const FileUnits& units) : text_(text), units_(units) {}

  Structure read() {
    const auto& lines = text_.lines();
    if (lines.size() < 2) text_.fail(0, "the file has no second line; .gro has a title, then the number of atoms");
    const auto atoms = static_cast<std::size_t>(
        whole_number_in(text_, 2, trimmed(lines[1]), "the number of atoms", 1, most_particles));
    if (lines.size() < atoms + 3) {
      text_.fail(2, fmt::format("{} atoms are announced, but the file ends after {} lines; expected {}", atoms,
                                lines.size(), atoms + 3));
    }
    width_ = width_of(lines[2]);
    velocities_ = trimmed_end(lines[2]).size() >= numbers_begin + 4 * width_;
    for (std::size_t line = 3; line < atoms + 3; ++line) read_atom(line);
    read_box(atoms + 3);
    for (std::size_t line = atoms + 4; line <= lines.size(); ++line) {
      if (trimmed(lines[line - 1]).empty()) continue;
      text_.fail(line,
                 fmt::format("there is more behind the {} atoms of the first frame; a structure is one frame", atoms));
    }
    return std::move(structure_);
  }

 private:
  static constexpr std::size_t numbers_begin = 20;

  static std::string_view trimmed_end(std::string_view line) {
    return line.substr(0, line.find_last_not_of(" \t") + 1);
  }

  /// The width of a number: the distance of two decimal points.
  std::size_t width_of(const std::string& line) const {
    const std::size_t first = line.find('.', numbers_begin), second = line.find('.', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      text_.fail(3, "there are no two numbers with decimal points behind column 20, where positions stand");
    }
    return second - first;
  }

  void read_atom(std::size_t line) {
    const std::string_view content = trimmed_end(text_.lines()[line - 1]);
    const std::size_t expected = numbers_begin + (velocities_ ? 6 : 3) * width_;
    // Numbers end with their columns, as the first atom has them.
    if (content.size() != expected) {
      text_.fail(line, fmt::format("this atom ends at column {}; expected {}, as its numbers have {} columns each",
                                   content.size(), expected, width_));
    }
    const std::string residue(trimmed(content.substr(0, 10))), atom(trimmed(content.substr(10, 5)));
    if (const std::string wrong = wrong_name(atom); !wrong.empty()) text_.fail(line, wrong, atom);
    if (residue != residue_ || structure_.ids.empty()) ++molecule_;
    residue_ = residue;
    const auto number = static_cast<std::int64_t>(structure_.ids.size()) + 1;
    structure_.ids.push_back(number);
    structure_.names.push_back(fmt::format("{}_{}", atom, number));
    structure_.masses.push_back(std::numeric_limits<double>::quiet_NaN());
    structure_.topology.types.push_back(type_of(atom));
    structure_.topology.molecules.push_back(molecule_);
    structure_.x.push_back(vector(line, content.substr(numbers_begin), "") * units_.length);
    structure_.v.push_back(
        velocities_ ? Vec3<double>(vector(line, content.substr(numbers_begin + 3 * width_), "v") * units_.velocity)
                    : Vec3<double>(Vec3<double>::Zero()));
  }

  Vec3<double> vector(std::size_t line, std::string_view content, const std::string& prefix) const {
    Vec3<double> v;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = prefix + static_cast<char>('x' + k);
      v[static_cast<int>(k)] = number_in(text_, line, trimmed(content.substr(k * width_, width_)), name);
    }
    return v;
  }

  void read_box(std::size_t line) {
    std::vector<std::string_view> words;
    split_words(text_.lines()[line - 1], words);
    if (words.size() != 3 && words.size() != 9) {
      text_.fail(line, fmt::format("the box has {} numbers; 3 are expected, or 9", words.size()));
    }
    Vec3<double> edges;
    for (std::size_t k = 0; k < words.size(); ++k) {
      const double number = number_in(text_, line, words[k], "an edge of the box");
      if (k < 3) edges[static_cast<int>(k)] = number * units_.length;
      if (k < 3 || number == 0) continue;
      text_.fail(
          line, fmt::format("the box is triclinic: its 9 numbers are {}; boxes are orthogonal", fmt::join(words, " ")));
    }
    if (edges != Vec3<double>::Zero()) structure_.box = box_in(text_, line, edges);
  }

  std::int64_t type_of(const std::string& atom) {
    const auto count = static_cast<std::int64_t>(types_.size());
    const auto [at, fresh] = types_.try_emplace(atom, count);
    if (fresh) structure_.topology.type_names.push_back(atom);
    return at->second;
  }

  const TextFile& text_;
  FileUnits units_;
  Structure structure_;
  std::size_t width_ = 0;
  bool velocities_ = false;
  std::string residue_;
  std::int64_t molecule_ = 0;
  std::map<std::string, std::int64_t> types_;
};

}  // namespace

Structure read_gro(const TextFile& text, const FileUnits& units) { return GroReader(text, units).read(); }

}  // namespace noether::io
