// Structures of GROMACS, .gro: fixed columns, positions in nm, velocities in nm/ps.
#include "io/structure_parts.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

namespace noether::io {

namespace {

class GroReader {
 public:
  GroReader(const TextFile& text, const FileUnits& units, const StructureOptions& options)
      : text_(text), units_(units), options_(options) {}

  Structure read() {
    const auto& lines = text_.lines();
    if (lines.size() < 2)
      text_.fail(0, "the file has no second line; a .gro file begins with a title, then the number of atoms");
    const GroFrame frame = chosen();
    const std::size_t first = frame.line + 1;
    count_line_ = frame.line;
    width_ = width_of(first);
    velocities_ = trimmed_end(lines[first - 1]).size() >= numbers_begin + 4 * width_;
    for (std::size_t line = first; line < first + frame.atoms; ++line) read_atom(line);
    read_box(first + frame.atoms);
    return std::move(structure_);
  }

 private:
  /// One frame: the line of its number of atoms, behind the title.
  struct GroFrame {
    std::size_t line, atoms;
  };

  GroFrame frame_at(std::size_t line) const {
    const auto& lines = text_.lines();
    const auto atoms = static_cast<std::size_t>(
        whole_number_in(text_, line, trimmed(lines[line - 1]), "the number of atoms", 1, most_particles));
    if (lines.size() < line + atoms + 1) {
      text_.fail(line, fmt::format("{} atoms are declared, but the file ends after {} lines; expected {}", atoms,
                                   lines.size(), line + atoms + 1));
    }
    const std::size_t box = line + atoms + 1;
    std::size_t more = 0;
    while (box + more <= lines.size() && is_atom(box + more)) ++more;
    if (more > 0) {
      text_.fail(
          box, fmt::format("line {} says {} atoms, but the file has {}; check the number", line, atoms, atoms + more));
    }
    return {line, atoms};
  }

  /// The next line that is not empty; 0 if there is none.
  std::size_t line_behind(const GroFrame& frame) const {
    for (std::size_t line = frame.line + frame.atoms + 2; line <= text_.lines().size(); ++line) {
      if (!trimmed(text_.lines()[line - 1]).empty()) return line;
    }
    return 0;
  }

  GroFrame chosen() const {
    std::vector<GroFrame> frames = {frame_at(2)};
    if (options_.frame) {
      // A title may be empty.
      while (line_behind(frames.back()) != 0) frames.push_back(frame_at(frames.back().line + frames.back().atoms + 3));
      return frames[frame_of(options_, frames.size())];
    }
    const std::size_t next = line_behind(frames[0]);
    if (next != 0) {
      text_.fail(
          next,
          fmt::format("there is more text after the {} atoms of the first frame, but a structure is one frame: give "
                      "frame = 0, or frame = -1 for the last",
                      frames[0].atoms));
    }
    return frames[0];
  }

  /// Whether a line looks like an atom: names and a whole number up to column 20, decimal points in step behind it. The
  /// nine numbers of a box have points before column 20.
  bool is_atom(std::size_t line) const {
    const std::string_view content = trimmed_end(text_.lines()[line - 1]);
    if (content.size() <= numbers_begin || content.find('.') < numbers_begin) return false;
    const std::string_view number = trimmed(content.substr(15, 5));
    const std::size_t one = content.find('.', numbers_begin), two = content.find('.', one + 1),
                      three = content.find('.', two + 1);
    return !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos &&
           three != std::string_view::npos && two - one == three - two;
  }

  static constexpr std::size_t numbers_begin = 20;

  static std::string_view trimmed_end(std::string_view line) {
    return line.substr(0, line.find_last_not_of(" \t") + 1);
  }

  /// The width of a number: the distance of two decimal points.
  std::size_t width_of(std::size_t line) const {
    const std::string& content = text_.lines()[line - 1];
    const std::size_t first = content.find('.', numbers_begin), second = content.find('.', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      text_.fail(line, "there are not two numbers with decimal points after column 20, where positions are expected");
    }
    return second - first;
  }

  void read_atom(std::size_t line) {
    const std::string_view content = trimmed_end(text_.lines()[line - 1]);
    const std::size_t expected = numbers_begin + (velocities_ ? 6 : 3) * width_;
    // Numbers end with their columns, as the first atom has them.
    if (content.size() != expected) {
      refuse_missing(line, content);
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
    structure_.topology.types.push_back(type_of(atom, line));
    structure_.topology.molecules.push_back(molecule_);
    structure_.x.push_back(vector(line, content.substr(numbers_begin), "") * units_.length);
    structure_.v.push_back(
        velocities_ ? Vec3<double>(vector(line, content.substr(numbers_begin + 3 * width_), "v") * units_.velocity)
                    : Vec3<double>(Vec3<double>::Zero()));
  }

  /// Refuses an atom that is the box, because there are fewer atoms, and one without velocities beside those that have
  /// some.
  void refuse_missing(std::size_t line, std::string_view content) const {
    if (content.find_first_not_of(" \t0123456789.+-") == std::string_view::npos && !is_atom(line)) {
      text_.fail(line, fmt::format("line {} says {} atoms, but the box follows after {}; check the number", count_line_,
                                   trimmed(text_.lines()[count_line_ - 1]), structure_.ids.size()));
    }
    for (const bool own : {false, true}) {
      if (own == velocities_ || content.size() != numbers_begin + (own ? 6 : 3) * width_) continue;
      text_.fail(line,
                 fmt::format("this atom has {}, but the first one has {}; give velocities for all atoms or for none",
                             own ? "a velocity" : "no velocity", own ? "none" : "one"));
    }
  }

  Vec3<double> vector(std::size_t line, std::string_view content, const std::string& prefix) const {
    Vec3<double> v;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = prefix + static_cast<char>('x' + k);
      v[static_cast<int>(k)] = number_in(text_, line, trimmed(content.substr(k * width_, width_)), name);
    }
    return v;
  }

  /// The numbers of the box, also where they have grown together: all of them then have as many decimals as the last.
  std::vector<std::string_view> numbers_of_box(std::size_t line) const {
    std::vector<std::string_view> words;
    const std::string_view content = trimmed(text_.lines()[line - 1]);
    split_words(content, words);
    const auto points = [](std::string_view word) { return std::count(word.begin(), word.end(), '.'); };
    if (std::none_of(words.begin(), words.end(), [&](std::string_view word) { return points(word) > 1; })) return words;
    const std::size_t decimals = content.size() - content.rfind('.');
    words.clear();
    for (std::size_t begin = 0; begin < content.size();) {
      const std::size_t end = std::min(content.find('.', begin), content.size() - decimals) + decimals;
      words.push_back(trimmed(content.substr(begin, end - begin)));
      begin = end;
    }
    return words;
  }

  void read_box(std::size_t line) {
    const std::vector<std::string_view> words = numbers_of_box(line);
    if (words.size() != 3 && words.size() != 9) {
      text_.fail(line, fmt::format("the box has {} numbers; 3 are expected, or 9", words.size()));
    }
    std::array<double, 9> numbers{};
    for (std::size_t k = 0; k < words.size(); ++k) numbers[k] = number_in(text_, line, words[k], "an edge of the box");
    const Vec3<double> edges(numbers[0], numbers[1], numbers[2]);
    for (std::size_t k = 3; k < words.size(); ++k) {
      if (is_rounding_beside(numbers[k], edges)) continue;
      text_.fail(line, fmt::format("the box is triclinic, with the 9 numbers {}; only orthogonal boxes are supported",
                                   fmt::join(words, " ")));
    }
    if (edges != Vec3<double>::Zero()) structure_.box = box_in(text_, line, edges * units_.length);
  }

  std::int64_t type_of(const std::string& atom, std::size_t line) {
    const auto count = static_cast<std::int64_t>(types_.size());
    const auto [at, fresh] = types_.try_emplace(atom, count);
    if (fresh) structure_.topology.type_names.push_back(atom), structure_.type_lines.push_back(line);
    return at->second;
  }

  const TextFile& text_;
  FileUnits units_;
  const StructureOptions& options_;
  std::size_t count_line_ = 0;  ///< of the number of atoms
  Structure structure_;
  std::size_t width_ = 0;
  bool velocities_ = false;
  std::string residue_;
  std::int64_t molecule_ = 0;
  std::map<std::string, std::int64_t> types_;
};

}  // namespace

Structure read_gro(const TextFile& text, const FileUnits& units, const StructureOptions& options) {
  return GroReader(text, units, options).read();
}

}  // namespace noether::io
