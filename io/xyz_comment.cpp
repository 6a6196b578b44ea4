#include "io/xyz_comment.hpp"

#include "io/structure_parts.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

namespace noether::io {

namespace {

bool is_blank_of_comment(char c) { return c == ' ' || c == '\t'; }

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

/// Whether a comment has a key, in small letters, with its mark.
bool has_key(std::string_view comment, std::string_view key) {
  const std::string small = in_small_letters(comment);
  const std::size_t at = small.find(key);
  const std::size_t behind = at == std::string::npos ? at : small.find_first_not_of(" \t", at + key.size());
  return behind != std::string::npos && small[behind] == '=';
}

void skip_blanks(std::string_view& rest) {
  while (!rest.empty() && is_blank_of_comment(rest.front())) rest.remove_prefix(1);
}

/// The words of a value that may be a list: "1 0 0", [[1, 0], [0, 1]].
std::vector<std::string_view> words_of_list(std::string& value) {
  std::replace_if(
      value.begin(), value.end(), [](char c) { return c == ',' || c == '[' || c == ']' || c == '{' || c == '}'; }, ' ');
  std::vector<std::string_view> words;
  split_words(value, words);
  return words;
}

/// Keys by which other programs give a box, and what is expected instead.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> keys_of_others = {
    {{"cell", "Lattice"},
     {"unit_cell", "Lattice"},
     {"unitcell", "Lattice"},
     {"box", "Lattice"},
     {"boxsize", "Lattice"},
     {"box_size", "Lattice"},
     {"lattice_vectors", "Lattice"},
     {"cell_vectors", "Lattice"},
     {"abc", "Lattice"},
     {"periodic", "pbc"},
     {"boundary", "pbc"},
     {"columns", "Properties"}}};

}  // namespace

XyzComment::XyzComment(const TextFile& text, std::size_t line) : text_(text), line_(line) {
  std::string_view rest = text.lines()[line - 1];
  if (rest.find('=') == std::string_view::npos) {
    // As i-PI writes it, with units of its own.
    if (rest.find("CELL(") == std::string_view::npos && rest.find("CELL{") == std::string_view::npos) return;
    fail(
        "the cell of i-PI in this comment is not supported; give Lattice=\"ax 0 0 0 by 0 0 0 cz\", and positions in "
        "angstrom");
  }
  const bool extended = has_key(rest, "properties") || has_key(rest, "lattice");
  for (skip_blanks(rest); !rest.empty(); skip_blanks(rest)) {
    std::string said = "T";
    std::string name = extended ? flag(rest) : "";
    if (name.empty()) {
      name = key(rest);
      said = value(rest, name);
    }
    const std::string small = in_small_letters(name);
    if (!values_.try_emplace(small, std::move(said)).second) {
      fail(fmt::format("'{}' appears twice in the comment", name), name);
    }
    spelt_[small] = name;
  }
  check_keys();
}

/// Takes a word that stands alone, a key that is true; empty where the next is none. What means a box or columns is
/// none.
std::string XyzComment::flag(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of(" \t="), rest.size());
  const std::string name(rest.substr(0, end));
  const bool plain =
      std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  std::string_view behind = rest.substr(end);
  skip_blanks(behind);
  // One letter, or a word of truth, belongs to a value that has lost its quotes: pbc=T F T.
  const std::string small = in_small_letters(name);
  if (name.size() < 2 || !plain || small == "true" || small == "false" || behind.starts_with('=')) return "";
  if (std::isalpha(static_cast<unsigned char>(name.front())) == 0) return "";
  if (!suggest(name, {"Lattice", "Properties"}).empty()) return "";
  for (const auto& other : keys_of_others) {
    if (small == other.first) return "";
  }
  rest.remove_prefix(end);
  return name;
}

/// Takes a key and the mark behind it.
std::string XyzComment::key(std::string_view& rest) const {
  const bool quoted = rest.front() == '"' || rest.front() == '\'';
  std::string name;
  if (quoted) {
    name = enclosed(rest, "in the comment");
  } else {
    const std::size_t end = std::min(rest.find_first_of(" \t="), rest.size());
    name = rest.substr(0, end);
    rest.remove_prefix(end);
  }
  skip_blanks(rest);
  if (name.empty() || !rest.starts_with('=')) {
    fail(fmt::format("'{}' is not understood: a comment with '=' is read as key=value; put quotes around values with "
                     "spaces, or take the '=' out of a comment that is only a text",
                     name.empty() ? "=" : name),
         name);
  }
  rest.remove_prefix(1);
  return name;
}

/// Takes the value of a key, without what encloses it.
std::string XyzComment::value(std::string_view& rest, const std::string& key) const {
  skip_blanks(rest);
  std::string said;
  static constexpr std::string_view openings = "\"'{[";
  if (!rest.empty() && openings.find(rest.front()) != std::string_view::npos) {
    said = enclosed(rest, fmt::format("after '{}='", key));
    if (rest.starts_with(',')) rest.remove_prefix(1);
    if (rest.empty() || is_blank_of_comment(rest.front())) return said;
    const std::string_view glued = rest.substr(0, rest.find_first_of(" \t"));
    fail(fmt::format("after the value of '{}=' comes '{}'; a space is expected", key, glued), std::string(glued));
  }
  const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
  said = rest.substr(0, end);
  rest.remove_prefix(end);
  if (said.ends_with(',')) said.pop_back();
  if (said.empty() || said.find('=') != std::string::npos) {
    fail(fmt::format("after '{}=' comes {}; a value is expected, in quotes if it has spaces or '='", key,
                     said.empty() ? "nothing" : fmt::format("'{}'", said)),
         said);
  }
  return said;
}

/// Takes what stands in quotes, braces or brackets.
std::string XyzComment::enclosed(std::string_view& rest, const std::string& where) const {
  const char opening = rest.front();
  const bool quote = opening == '"' || opening == '\'';
  const char closing = opening == '{' ? '}' : opening == '[' ? ']' : opening;
  std::string inside;
  int depth = 1;
  for (std::size_t k = 1; k < rest.size(); ++k) {
    const char c = rest[k];
    if (quote && c == '\\' && k + 1 < rest.size()) {
      inside += rest[++k];
      continue;
    }
    if (!quote && c == opening) ++depth;
    if (c == closing && --depth == 0) {
      rest.remove_prefix(k + 1);
      return inside;
    }
    inside += c;
  }
  const std::string_view called = opening == '"'    ? "double quote"
                                  : opening == '\'' ? "single quote"
                                  : opening == '{'  ? "brace"
                                                    : "bracket";
  fail(fmt::format("a {} {} is not closed", called, where));
}

/// Refuses keys that mean a box or columns, and are not those that are read.
void XyzComment::check_keys() const {
  const std::vector<std::string> known = {"Lattice", "Properties"};
  for (const auto& [small, spelt] : spelt_) {
    if (small == "lattice" || small == "properties") continue;
    std::string meant = suggest(spelt, known);
    for (const auto& [other, expected] : keys_of_others) {
      if (small == other) meant = expected;
    }
    if (meant.empty() || find(meant) != nullptr) continue;
    fail(fmt::format("'{}=' is not supported; {}", spelt,
                     meant == "Lattice" ? "the box is given as Lattice=\"ax 0 0 0 by 0 0 0 cz\""
                     : meant == "pbc"   ? "write pbc=\"T T T\" or pbc=\"F F F\""
                                        : "columns are given as Properties=species:S:1:pos:R:3"),
         spelt);
  }
}

const std::string* XyzComment::find(std::string_view key) const {
  const auto found = values_.find(in_small_letters(key));
  return found == values_.end() ? nullptr : &found->second;
}

bool XyzComment::is_periodic() const {
  const std::string* said = find("pbc");
  if (said == nullptr) return find("Lattice") != nullptr;
  std::string value = *said;
  std::vector<std::string_view> words = words_of_list(value);
  if (words.size() == 1 && words[0].size() == 3 && words[0].find_first_not_of("TF") == std::string_view::npos) {
    words = {words[0].substr(0, 1), words[0].substr(1, 1), words[0].substr(2, 1)};  // TTT
  }
  if (words.size() == 1) words.resize(3, words[0]);
  int periodic = 0;
  for (const std::string_view word : std::vector<std::string_view>(words)) {
    const bool yes = word == "T" || word == "True" || word == "true" || word == "TRUE" || word == "1";
    const bool no = word == "F" || word == "False" || word == "false" || word == "FALSE" || word == "0";
    if (!yes && !no) words.clear();
    periodic += yes ? 1 : 0;
  }
  if (words.size() != 3) fail(fmt::format("pbc=\"{}\" is not understood; \"T T T\" or \"F F F\" is expected", *said));
  if (periodic != 0 && periodic != 3) {
    fail(fmt::format("pbc=\"{}\" is periodic in {} of 3 directions; all or none are expected", *said, periodic));
  }
  if (periodic == 3 && find("Lattice") == nullptr) fail("pbc is true, but there is no Lattice");
  return periodic == 3;
}

Box XyzComment::box(double length) const {
  std::string value = *find("Lattice");
  const std::vector<std::string_view> words = words_of_list(value);
  if (words.size() != 9) fail(fmt::format("Lattice has {} numbers; 9 are expected", words.size()));
  std::array<double, 9> numbers{};
  for (std::size_t k = 0; k < 9; ++k) numbers[k] = number_in(text_, line_, words[k], "a number of Lattice");
  const Vec3<double> edges(numbers[0], numbers[4], numbers[8]);
  for (std::size_t k = 0; k < 9; ++k) {
    if (k % 4 == 0 || is_rounding_beside(numbers[k], edges)) continue;
    fail(fmt::format("Lattice=\"{}\" is not orthogonal along the axes; only orthogonal boxes are supported",
                     *find("Lattice")));
  }
  return box_in(text_, line_, edges * length);
}

}  // namespace noether::io
