#include "io/lammps_text.hpp"

#include "numbers/suggest.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace noether::io {

namespace {

constexpr std::array<std::string_view, 10> declared = {"atoms",          "bonds",         "angles",     "dihedrals",
                                                       "impropers",      "atom types",    "bond types", "angle types",
                                                       "dihedral types", "improper types"};
/// Room that LAMMPS is told to set aside.
constexpr std::array<std::string_view, 5> passed_over = {"extra bond per atom", "extra angle per atom",
                                                         "extra dihedral per atom", "extra improper per atom",
                                                         "extra special per atom"};
constexpr std::array<std::string_view, 18> section_names = {"Masses",
                                                            "Atoms",
                                                            "Velocities",
                                                            "Bonds",
                                                            "Angles",
                                                            "Dihedrals",
                                                            "Impropers",
                                                            "Pair Coeffs",
                                                            "PairIJ Coeffs",
                                                            "Bond Coeffs",
                                                            "Angle Coeffs",
                                                            "Dihedral Coeffs",
                                                            "Improper Coeffs",
                                                            "Atom Type Labels",
                                                            "Bond Type Labels",
                                                            "Angle Type Labels",
                                                            "Dihedral Type Labels",
                                                            "Improper Type Labels"};
/// Sections of other potentials and particles: nothing that is read stands in for them.
constexpr std::array<std::string_view, 13> other_sections = {"Ellipsoids",
                                                             "Lines",
                                                             "Triangles",
                                                             "Bodies",
                                                             "CMAP",
                                                             "BondBond Coeffs",
                                                             "BondAngle Coeffs",
                                                             "MiddleBondTorsion Coeffs",
                                                             "EndBondTorsion Coeffs",
                                                             "AngleTorsion Coeffs",
                                                             "AngleAngleTorsion Coeffs",
                                                             "BondBond13 Coeffs",
                                                             "AngleAngle Coeffs"};
constexpr std::array<std::string_view, 8> suffixes = {"/omp", "/opt",     "/gpu",       "/intel",
                                                      "/kk",  "/kk/host", "/kk/device", "/kk/gpu"};
constexpr std::array<std::string_view, 5> labelled = {"atom", "bond", "angle", "dihedral", "improper"};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

template <std::size_t n> bool stands_in(const std::array<std::string_view, n>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// The title of the section with the labels of a kind: "Atom Type Labels".
std::string section_of_labels(std::string_view kind) {
  std::string title(kind);
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title + " Type Labels";
}

}  // namespace

std::string without_suffix(std::string_view style) {
  for (const std::string_view suffix : suffixes) {
    if (style.size() > suffix.size() && style.ends_with(suffix)) {
      return std::string(style.substr(0, style.size() - suffix.size()));
    }
  }
  return std::string(style);
}

void TypeLabels::add(const TextFile& text, std::size_t line, const std::string& kind, std::int64_t type,
                     const std::string& label) {
  auto& types = types_[kind];
  const bool again = std::any_of(types.begin(), types.end(), [&](const auto& known) { return known.second == type; });
  if (!again && types.try_emplace(label, type).second) return;
  text.fail(line,
            fmt::format("{} of {} types appears twice", again ? fmt::format("type {}", type) : "'" + label + "'", kind),
            label);
}

std::int64_t TypeLabels::type_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& kind,
                                 std::string_view what, std::int64_t most) const {
  const auto known = types_.find(kind);
  if (known == types_.end() || std::isdigit(static_cast<unsigned char>(word.front())) != 0) {
    return whole_number_in(text, line, word, what, 1, most);
  }
  const std::string label(word);
  const auto found = known->second.find(label);
  if (found != known->second.end()) return found->second;
  std::vector<std::string> labels;
  for (const auto& [one, type] : known->second) labels.push_back(one);
  text.fail(
      line,
      fmt::format("{} is '{}', which is not a label of {} types{}", what, label, kind, did_you_mean(label, labels)),
      label);
}

std::pair<std::int64_t, std::int64_t> TypeLabels::types_in(const TextFile& text, std::size_t line,
                                                           std::string_view word, const std::string& kind,
                                                           std::int64_t most) const {
  const auto type = [&](std::string_view one) { return type_in(text, line, one, kind, "the type", most); };
  const std::size_t star = is_label(kind, word) ? std::string_view::npos : word.find('*');  // "C*" may be a label
  if (star == std::string_view::npos) return {type(word), type(word)};
  const std::string_view from = word.substr(0, star), to = word.substr(star + 1);
  return {from.empty() ? 1 : type(from), to.empty() ? most : type(to)};
}

bool TypeLabels::is_label(const std::string& kind, std::string_view word) const {
  const auto known = types_.find(kind);
  return known != types_.end() && known->second.contains(std::string(word));
}

std::string TypeLabels::label(const std::string& kind, std::int64_t type) const {
  const auto known = types_.find(kind);
  if (known == types_.end()) return "";
  for (const auto& [label, of_type] : known->second) {
    if (of_type == type) return label;
  }
  return "";
}

LammpsText::LammpsText(const TextFile& text) : text_(text) {
  if (text.lines().empty()) text.fail(0, "the file is empty; a LAMMPS data file is expected");
  std::vector<std::string_view> words;
  bool has_labels = false;  // rows may begin with them
  for (std::size_t line = 2; line <= text.lines().size(); ++line) {
    split_words(text.lines()[line - 1], words);
    if (words.empty()) continue;
    const char first = words.front().front();
    const bool number =
        std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '-' || first == '+' || first == '.';
    const std::string name = fmt::format("{}", fmt::join(words, " "));
    const bool begins = stands_in(section_names, name) || stands_in(other_sections, name);
    if (!number && (begins || !has_labels)) {
      begin_section(line);
      has_labels = has_labels || name.ends_with(" Type Labels");
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
  read_labels();
}

void LammpsText::read_labels() {
  std::vector<std::string_view> words;
  for (const std::string_view of : labelled) {
    const std::string kind(of), counter = kind + " types";
    const LammpsSection* found = section(section_of_labels(kind), counter, false);
    if (found == nullptr) continue;
    for (const std::size_t line : found->rows) {
      split_words(text_.lines()[line - 1], words);
      if (words.size() != 2) {
        text_.fail(line, fmt::format("this row of section '{}' has {} words; expected 2", found->name, words.size()));
      }
      const std::string label(words[1]);
      if (std::isdigit(static_cast<unsigned char>(label[0])) != 0) {
        text_.fail(line, fmt::format("the label '{}' begins with a digit, so it could be the number of a type", label),
                   label);
      }
      labels_.add(text_, line, kind, whole_number_in(text_, line, words[0], "the type", 1, count(counter)), label);
    }
  }
}

void LammpsText::read_header_line(std::size_t line, const std::vector<std::string_view>& words) {
  const auto number = std::find_if(words.begin(), words.end(), [](std::string_view w) { return is_letter(w.front()); });
  const std::string key = fmt::format("{}", fmt::join(number, words.end(), " "));
  const auto numbers = number - words.begin();
  if (stands_in(declared, key) && numbers == 1) {
    const std::int64_t most = key.ends_with("types") ? most_types : most_particles;
    const bool fresh =
        counts_.try_emplace(key, Count{whole_number_in(text_, line, words[0], key, 0, most), line}).second;
    if (!fresh) text_.fail(line, fmt::format("'{}' appears twice, also at line {}", key, counts_.at(key).line), key);
  } else if ((key == "xlo xhi" || key == "ylo yhi" || key == "zlo zhi") && numbers == 2) {
    read_bounds(line, words, key);
  } else if (key == "xy xz yz" && numbers == 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double tilt = number_in(text_, line, words[k], "a tilt factor");
      if (tilt != 0) tilts_[static_cast<int>(k)] = tilt, tilt_line_ = line;
    }
  } else if (key == "avec" || key == "bvec" || key == "cvec" || key == "abc origin") {
    text_.fail(line,
               fmt::format("'{}' belongs to a general triclinic box; only orthogonal boxes are supported, given by xlo "
                           "xhi, ylo yhi, zlo zhi",
                           fmt::join(words, " ")),
               key);
  } else if (!(numbers == 1 && (stands_in(passed_over, key) || words[0] == "0"))) {
    std::vector<std::string> known(declared.begin(), declared.end());
    known.insert(known.end(), {"xlo xhi", "ylo yhi", "zlo zhi"});
    text_.fail(
        line,
        fmt::format("'{}' is not a supported line of the header{}", fmt::join(words, " "), did_you_mean(key, known)),
        key);
  }
}

void LammpsText::read_bounds(std::size_t line, const std::vector<std::string_view>& words, const std::string& axis) {
  const int k = axis.front() - 'x';
  low_[k] = number_in(text_, line, words[0], axis.substr(0, 3));
  edges_[k] = number_in(text_, line, words[1], axis.substr(4)) - low_[k];
  if (!bounds_.try_emplace(axis, line).second) text_.fail(line, fmt::format("'{}' appears twice", axis), axis);
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
  for (int k = 0; k < 3; ++k) {
    if (is_rounding_beside(tilts_[k], edges_)) continue;
    text_.fail(
        tilt_line_,
        fmt::format("the box is triclinic, with tilt factors xy xz yz = {} {} {}; only orthogonal boxes are supported",
                    tilts_[0], tilts_[1], tilts_[2]));
  }
}

void LammpsText::begin_section(std::size_t line) {
  const std::string& content = text_.lines()[line - 1];
  const std::size_t mark = std::min(content.find('#'), content.size());
  std::vector<std::string_view> words;
  split_words(content, words);
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  if (stands_in(other_sections, name)) {
    text_.fail(line, fmt::format("section '{}' is not supported: no force here uses it", name), name);
  }
  if (!stands_in(section_names, name)) {
    const std::vector<std::string> known(section_names.begin(), section_names.end());
    text_.fail(line, fmt::format("'{}' is not a supported section{}", name, did_you_mean(name, known)), name);
  }
  if (const LammpsSection* other = find(name)) {
    text_.fail(line, fmt::format("section '{}' appears twice, also at line {}", name, other->line), name);
  }
  if (mark < content.size()) split_words(std::string_view(content).substr(mark + 1), words);
  sections_.push_back({name, mark < content.size() && !words.empty() ? without_suffix(words.front()) : "", line});
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
      text_.fail(counted_at->second.line,
                 fmt::format("{} {} are declared, but there is no section '{}'; the file may be cut short", expected,
                             what, name));
    }
    return nullptr;
  }
  if (static_cast<std::int64_t>(found->rows.size()) == expected) return found;
  const std::string source = counted_at == counts_.end()
                                 ? fmt::format("the header has no line '{}'", what)
                                 : fmt::format("line {} says {} {}", counted_at->second.line, expected, what);
  text_.fail(found->line,
             fmt::format("section '{}' has {}, but {}", name,
                         counted(static_cast<std::int64_t>(found->rows.size()), "row"), source),
             name);
}

}  // namespace noether::io
