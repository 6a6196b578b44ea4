#include "io/lammps_text.hpp"

#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace noether::io {

namespace {

constexpr std::array<std::string_view, 10> counted = {"atoms",          "bonds",         "angles",     "dihedrals",
                                                      "impropers",      "atom types",    "bond types", "angle types",
                                                      "dihedral types", "improper types"};
/// Room that LAMMPS is told to set aside.
constexpr std::array<std::string_view, 5> passed_over = {"extra bond per atom", "extra angle per atom",
                                                         "extra dihedral per atom", "extra improper per atom",
                                                         "extra special per atom"};
constexpr std::array<std::string_view, 13> section_names = {
    "Masses",      "Atoms",         "Velocities",  "Bonds",        "Angles",          "Dihedrals",      "Impropers",
    "Pair Coeffs", "PairIJ Coeffs", "Bond Coeffs", "Angle Coeffs", "Dihedral Coeffs", "Improper Coeffs"};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

template <std::size_t n> bool stands_in(const std::array<std::string_view, n>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

}  // namespace

LammpsText::LammpsText(const TextFile& text) : text_(text) {
  if (text.lines().empty()) text.fail(0, "the file is empty; a LAMMPS data file is expected");
  std::vector<std::string_view> words;
  for (std::size_t line = 2; line <= text.lines().size(); ++line) {
    split_words(text.lines()[line - 1], words);
    if (words.empty()) continue;
    const char first = words.front().front();
    const bool number =
        std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '-' || first == '+' || first == '.';
    if (!number) {
      begin_section(line);
    } else if (sections_.empty()) {
      read_header_line(line, words);
    } else {
      sections_.back().rows.push_back(line);
    }
  }
  if (counts_.count("atoms") == 0) {
    text.fail(0, "there is no line 'N atoms'; a LAMMPS data file is expected: a comment, then the header");
  }
  check_bounds();
}

void LammpsText::read_header_line(std::size_t line, const std::vector<std::string_view>& words) {
  const auto number = std::find_if(words.begin(), words.end(), [](std::string_view w) { return is_letter(w.front()); });
  const std::string key = fmt::format("{}", fmt::join(number, words.end(), " "));
  const auto numbers = number - words.begin();
  if (stands_in(counted, key) && numbers == 1) {
    const std::int64_t most = key.ends_with("types") ? most_types : most_particles;
    const bool fresh =
        counts_.try_emplace(key, Count{whole_number_in(text_, line, words[0], key, 0, most), line}).second;
    if (!fresh) text_.fail(line, fmt::format("'{}' stands twice, also at line {}", key, counts_.at(key).line), key);
  } else if ((key == "xlo xhi" || key == "ylo yhi" || key == "zlo zhi") && numbers == 2) {
    read_bounds(line, words, key);
  } else if (key == "xy xz yz" && numbers == 3) {
    for (const std::string_view tilt : {words[0], words[1], words[2]}) {
      if (number_in(text_, line, tilt, "a tilt factor") == 0) continue;
      text_.fail(line, fmt::format("the box is triclinic, with tilt factors xy xz yz = {} {} {}; boxes are orthogonal",
                                   words[0], words[1], words[2]));
    }
  } else if (!(stands_in(passed_over, key) && numbers == 1)) {
    std::vector<std::string> known(counted.begin(), counted.end());
    known.insert(known.end(), {"xlo xhi", "ylo yhi", "zlo zhi"});
    text_.fail(
        line,
        fmt::format("'{}' is no line of the header that is read{}", fmt::join(words, " "), did_you_mean(key, known)),
        key);
  }
}

void LammpsText::read_bounds(std::size_t line, const std::vector<std::string_view>& words, const std::string& axis) {
  const int k = axis.front() - 'x';
  low_[k] = number_in(text_, line, words[0], axis.substr(0, 3));
  edges_[k] = number_in(text_, line, words[1], axis.substr(4)) - low_[k];
  if (!bounds_.try_emplace(axis, line).second) text_.fail(line, fmt::format("'{}' stands twice", axis), axis);
  if (!(edges_[k] > 0)) {
    text_.fail(line,
               fmt::format("{} = {} is not above {} = {}", axis.substr(4), words[1], axis.substr(0, 3), words[0]));
  }
}

void LammpsText::check_bounds() const {
  for (const char* axis : {"xlo xhi", "ylo yhi", "zlo zhi"}) {
    if (bounds_.count(axis) != 0) continue;
    text_.fail(0, fmt::format("there is no line '{}'; the header gives the box by xlo xhi, ylo yhi and zlo zhi", axis));
  }
}

void LammpsText::begin_section(std::size_t line) {
  const std::string& content = text_.lines()[line - 1];
  const std::size_t mark = std::min(content.find('#'), content.size());
  std::vector<std::string_view> words;
  split_words(content, words);
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  if (!stands_in(section_names, name)) {
    const std::vector<std::string> known(section_names.begin(), section_names.end());
    text_.fail(line, fmt::format("'{}' is no section that is read{}", name, did_you_mean(name, known)), name);
  }
  if (const LammpsSection* other = find(name)) {
    text_.fail(line, fmt::format("section '{}' stands twice, also at line {}", name, other->line), name);
  }
  if (mark < content.size()) split_words(std::string_view(content).substr(mark + 1), words);
  sections_.push_back({name, mark < content.size() && !words.empty() ? std::string(words.front()) : "", line});
}

std::int64_t LammpsText::count(const std::string& what) const {
  const auto found = counts_.find(what);
  return found == counts_.end() ? 0 : found->second.number;
}

const LammpsSection* LammpsText::find(const std::string& name) const {
  for (const LammpsSection& one : sections_) {
    if (one.name == name) return &one;
  }
  return nullptr;
}

const LammpsSection* LammpsText::section(const std::string& name, const std::string& what, bool needed) const {
  const std::int64_t expected = count(what);
  const auto counted_at = counts_.find(what);
  const LammpsSection* found = find(name);
  if (found == nullptr) {
    if (expected > 0 && needed) {
      text_.fail(
          counted_at->second.line,
          fmt::format("{} {} are announced, but there is no section '{}'; is the file cut?", expected, what, name));
    }
    return nullptr;
  }
  if (static_cast<std::int64_t>(found->rows.size()) == expected) return found;
  const std::string source = counted_at == counts_.end()
                                 ? fmt::format("the header has no line '{}'", what)
                                 : fmt::format("line {} says {} {}", counted_at->second.line, expected, what);
  text_.fail(found->line, fmt::format("section '{}' has {} rows, but {}", name, found->rows.size(), source), name);
}

}  // namespace noether::io
