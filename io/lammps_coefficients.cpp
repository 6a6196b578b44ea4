// Coefficients of LAMMPS data files and input scripts, in LAMMPS's conventions, as kinds of noether.
#include "io/lammps_script.hpp"
#include "io/lammps_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <numbers>
#include <optional>

namespace noether::io {

namespace {

using Coefficients = std::array<double, 6>;

/// A style of terms: what its numbers are, one letter each, and the kind they make.
///
/// e energy, l length, k energy/length^2, i 1/length, d degrees, n whole number, s sign (1 or -1), w weight (0 to 1).
/// Behind "m" stands what is repeated as often as the first number says, each time a kind of its own.
struct CoefficientStyle {
  std::string_view family, name, numbers;
  TermKind (*kind)(const Coefficients& c);
};

/// k (1 + sign cos(n phi)), as a cosine with a phase of 0 or pi.
TermKind signed_cosine(double k, double sign, double n) {
  return {"periodic", {k, n, sign > 0 ? 0 : std::numbers::pi}};
}

TermKind periodic(const Coefficients& c) { return {"periodic", {c[0], c[1], c[2]}}; }

/// A spring in the angle, and one between the ends, which may be absent.
TermKind urey_bradley(const Coefficients& c) {
  if (c[2] == 0) return {"harmonic", {2 * c[0], c[1]}};
  return {"urey_bradley", {2 * c[0], c[1], 2 * c[2], c[3]}};
}

/// sum_n a_n cos^n(phi); psi = phi - pi, so cos(psi) = -cos(phi).
TermKind ryckaert_bellemans(const Coefficients& a) {
  return {"ryckaert_bellemans", {a[0], -a[1], a[2], -a[3], a[4], -a[5]}};
}

/// K1/2 (1 + cos phi) + K2/2 (1 - cos 2 phi) + K3/2 (1 + cos 3 phi) + K4/2 (1 - cos 4 phi) by powers of cos phi.
TermKind opls(const Coefficients& k) {
  return ryckaert_bellemans(
      {k[0] / 2 + k[1] + k[2] / 2, k[0] / 2 - 1.5 * k[2], 4 * k[3] - k[1], 2 * k[2], -4 * k[3], 0});
}

/// LAMMPS leaves out the 1/2 of harmonic terms.
constexpr std::array<CoefficientStyle, 14> coefficient_styles = {{
    {"bond", "harmonic", "kl",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"bond", "morse", "eil",
     [](const Coefficients& c) {
       return TermKind{"morse", {c[0], c[1], c[2]}};
     }},
    {"bond", "fene", "klel",
     [](const Coefficients& c) {
       return TermKind{"fene", {c[0], c[1], c[2], c[3]}};
     }},
    {"angle", "harmonic", "ed",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"angle", "cosine", "e",
     [](const Coefficients& c) {
       return TermKind{"cosine", {c[0]}};
     }},
    {"angle", "cosine/squared", "ed",
     [](const Coefficients& c) {
       return TermKind{"cosine_squared", {2 * c[0], c[1]}};
     }},
    {"angle", "charmm", "edkl", urey_bradley},
    {"dihedral", "charmm", "endw", periodic},
    {"dihedral", "fourier", "mend", periodic},
    {"dihedral", "harmonic", "esn", [](const Coefficients& c) { return signed_cosine(c[0], c[1], c[2]); }},
    {"dihedral", "multi/harmonic", "eeeee", ryckaert_bellemans},
    {"dihedral", "opls", "eeee", opls},
    {"improper", "harmonic", "ed",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"improper", "cvff", "esn", [](const Coefficients& c) { return signed_cosine(c[0], c[1], c[2]); }},
}};

/// A style of pairs whose first two coefficients are epsilon and sigma.
struct PairStyle {
  std::string_view name;
  std::size_t cutoff;  ///< which number behind the name in pair_style is the cutoff of Lennard-Jones
  bool charmm;         ///< may have an epsilon and a sigma for the ends of dihedrals too; mixes arithmetically
};
constexpr std::array<PairStyle, 10> pair_styles = {{{"lj/cut", 1, false},
                                                    {"lj", 1, false},  // as other programs call it behind "Pair Coeffs"
                                                    {"lj/cut/coul/cut", 1, false},
                                                    {"lj/cut/coul/long", 1, false},
                                                    {"lj/cut/coul/dsf", 2, false},
                                                    {"lj/cut/coul/debye", 2, false},
                                                    {"lj/cut/coul/msm", 1, false},
                                                    {"lj/charmm/coul/charmm", 2, true},
                                                    {"lj/charmm/coul/long", 2, true},
                                                    {"lj/charmm/coul/msm", 2, true}}};

bool is_hybrid(std::string_view style) { return style.starts_with("hybrid"); }
bool begins_with_letter(std::string_view word) { return std::isalpha(static_cast<unsigned char>(word.front())) != 0; }

/// Names that are read; nothing else stands in for a potential, so no other one is proposed.
std::string those_read(const std::vector<std::string>& names) {
  return fmt::format("; expected one of: {}", fmt::join(names, ", "));
}

/// One row of coefficients, in a section or in a command.
struct CoefficientRow {
  const TextFile* text;
  std::size_t line;
  std::vector<std::string_view> words;  ///< the numbers
  std::string style;
  std::string where;                           ///< for messages: "section 'Bond Coeffs'"
  std::array<std::pair<int, int>, 2> types{};  ///< from, up to and with, counted from 0; of a pair there are two
  bool of_script = false;                      ///< a command, which may say again what another row says

  [[noreturn]] void fail(const std::string& message, const std::string& value = "") const {
    text->fail(line, message, value);
  }
};

/// Rows of the sections of a data file and of the commands of its scripts, alike.
class CoefficientRows {
 public:
  CoefficientRows(const LammpsText& data, const LammpsScript& script) : data_(data), script_(script) {}

  /// Those of one family, those of the script last. @param indices  types that a row begins with
  std::vector<CoefficientRow> of(const std::string& family, const std::string& kind, std::int64_t types) const {
    std::vector<CoefficientRow> rows;
    const std::string title = title_of(family);
    if (const LammpsSection* found = data_.section(title, kind + " types", false))
      add(*found, family, kind, types, 1, rows);
    if (const LammpsSection* found = data_.find("PairIJ Coeffs"); found != nullptr && family == "pair") {
      add(*found, family, kind, types, 2, rows);
    }
    for (const LammpsCommand* command : script_.all(family + "_coeff")) {
      CoefficientRow row{command->text, command->line, command->words, script_.style(family), family + "_coeff"};
      row.of_script = true;
      row.words.erase(row.words.begin());
      take_types(row, kind, types, family == "pair" ? 2 : 1);
      rows.push_back(std::move(row));
    }
    return rows;
  }

  static std::string title_of(const std::string& family) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(family[0]))) + family.substr(1) + " Coeffs";
  }

  const LammpsText& data() const { return data_; }
  const LammpsScript& script() const { return script_; }

 private:
  void add(const LammpsSection& section, const std::string& family, const std::string& kind, std::int64_t types,
           std::size_t indices, std::vector<CoefficientRow>& rows) const {
    for (const std::size_t line : section.rows) {
      CoefficientRow row{&data_.text(), line, {}, style_of(section, family), fmt::format("section '{}'", section.name)};
      split_words(data_.text().lines()[line - 1], row.words);
      take_types(row, kind, types, indices);
      rows.push_back(std::move(row));
    }
  }

  /// The style of a section: what stands behind its name, which is a remark where the script has a style.
  std::string style_of(const LammpsSection& section, const std::string& family) const {
    const std::string said = script_.style(family);
    if (said.empty() || !is_style(section.style, family)) return said.empty() ? section.style : said;
    if (said == section.style || is_hybrid(said)) return section.style;
    data_.text().fail(section.line, fmt::format("section '{}' is of style '{}', but the script says {}_style {}",
                                                section.name, section.style, family, said));
  }

  static bool is_style(const std::string& name, const std::string& family) {
    if (is_hybrid(name)) return true;
    if (family == "pair") {
      return std::any_of(pair_styles.begin(), pair_styles.end(),
                         [&](const PairStyle& style) { return style.name == name; });
    }
    return std::any_of(coefficient_styles.begin(), coefficient_styles.end(),
                       [&](const CoefficientStyle& style) { return style.family == family && style.name == name; });
  }

  /// Takes the types that a row begins with, and the style that may stand behind them.
  void take_types(CoefficientRow& row, const std::string& kind, std::int64_t types, std::size_t indices) const {
    if (row.words.size() <= indices) {
      row.fail(fmt::format("this row of {} has {} words; a type and its coefficients are expected", row.where,
                           row.words.size()));
    }
    for (std::size_t k = 0; k < indices; ++k) row.types[k] = range(row, row.words[k], kind, types);
    if (indices == 1) row.types[1] = row.types[0];
    row.words.erase(row.words.begin(), row.words.begin() + static_cast<std::ptrdiff_t>(indices));
    if (!begins_with_letter(row.words.front())) return;
    row.style = without_suffix(row.words.front());
    row.words.erase(row.words.begin());
  }

  /// One type, or in a command perhaps several.
  std::pair<int, int> range(const CoefficientRow& row, std::string_view word, const std::string& kind,
                            std::int64_t types) const {
    const auto index = [](std::int64_t type) { return static_cast<int>(type - 1); };
    const TypeLabels& labels = data_.labels();
    if (row.of_script) {
      const auto [from, to] = labels.types_in(*row.text, row.line, word, kind, types);
      return {index(from), index(to)};
    }
    const int type = index(labels.type_in(*row.text, row.line, word, kind, "the type", types));
    return {type, type};
  }

  const LammpsText& data_;
  const LammpsScript& script_;
};

class CoefficientReader {
 public:
  CoefficientReader(const CoefficientRows& rows, const FileUnits& units) : rows_(rows), units_(units) {}

  /// The kinds of a family, by type.
  LammpsKinds kinds(const std::string& family) const {
    const std::int64_t types = rows_.data().count(family + " types");
    const std::vector<CoefficientRow> rows = rows_.of(family, family, types);
    LammpsKinds result;
    if (rows.empty()) return result;
    std::vector<const CoefficientRow*> of_type(static_cast<std::size_t>(types), nullptr);
    for (const CoefficientRow& row : rows) {
      for (int type = row.types[0].first; type <= row.types[0].second; ++type) {
        const CoefficientRow*& own = of_type[static_cast<std::size_t>(type)];
        if (own != nullptr && !row.of_script) {
          row.fail(fmt::format("type {} appears twice in {}", type + 1, row.where));
        }
        own = &row;
      }
    }
    for (std::size_t type = 0; type < of_type.size(); ++type) {
      if (of_type[type] == nullptr) {
        rows.back().fail(
            fmt::format("{} type {} of {} has no coefficients; give them as well", family, type + 1, types));
      }
      add(*of_type[type], family, result);
    }
    return result;
  }

 private:
  void add(const CoefficientRow& row, const std::string& family, LammpsKinds& kinds) const {
    std::vector<std::string> known;
    for (const CoefficientStyle& style : coefficient_styles) {
      if (style.family != family) continue;
      if (style.name == row.style) return add(style, row, kinds);
      known.emplace_back(style.name);
    }
    if (row.style.empty() || is_hybrid(row.style)) {
      row.fail(fmt::format("the style of these coefficients is not given; {}{}",
                           row.of_script ? fmt::format("give a line {}_style too", family)
                                         : fmt::format("write it after the name of the section, '{} # STYLE'",
                                                       CoefficientRows::title_of(family)),
                           those_read(known)));
    }
    row.fail(fmt::format("style '{}' of {} is not supported{}", row.style, row.where, those_read(known)), row.style);
  }

  void add(const CoefficientStyle& style, const CoefficientRow& row, LammpsKinds& kinds) const {
    const auto first = static_cast<int>(kinds.kinds.size());
    const bool sum = style.numbers.starts_with('m');
    const std::string_view letters = style.numbers.substr(sum ? 1 : 0);
    std::size_t times = 1;
    if (sum) {
      const auto most = static_cast<std::int64_t>(row.words.size() / letters.size());
      times = static_cast<std::size_t>(whole_number_in(*row.text, row.line, row.words[0],
                                                       fmt::format("the number of terms of style '{}'", style.name), 1,
                                                       std::max<std::int64_t>(most, 1)));
    }
    if (row.words.size() != letters.size() * times + (sum ? 1 : 0)) {
      row.fail(fmt::format("style '{}' of {} has {} coefficients{}; this row has {}", style.name, row.where,
                           letters.size() * times + (sum ? 1 : 0),
                           sum ? fmt::format(" for {} terms", times) : std::string(), row.words.size()));
    }
    LammpsKinds::OfType type{first, static_cast<int>(times)};
    for (std::size_t one = 0; one < times; ++one) {
      Coefficients c{};
      for (std::size_t k = 0; k < letters.size(); ++k) {
        c[k] = number(row, (sum ? 1 : 0) + one * letters.size() + k, letters[k]);
        if (letters[k] == 'w') type.weight = c[k];
      }
      kinds.kinds.push_back(style.kind(c));
    }
    kinds.types.push_back(type);
  }

  double number(const CoefficientRow& row, std::size_t k, char what) const {
    const std::string name = fmt::format("coefficient {} of style '{}'", k + 1, row.style);
    const double value = number_in(*row.text, row.line, row.words[k], name);
    if (what == 's' && value != 1 && value != -1) {
      row.fail(fmt::format("{} is {}; 1 or -1 is expected", name, row.words[k]));
    }
    if (what == 'w' && !(value >= 0 && value <= 1)) {
      row.fail(fmt::format("the weight of a charmm dihedral is {}; 0 to 1 is expected", row.words[k]));
    }
    if (what == 'n' && (value < 0 || value > 100 || value != static_cast<int>(value))) {
      row.fail(fmt::format("{} is {}; a whole number is expected, 0 to 100", name, row.words[k]));
    }
    const double l = units_.length;
    const double factor = what == 'e'   ? units_.energy
                          : what == 'l' ? l
                          : what == 'k' ? units_.energy / (l * l)
                          : what == 'i' ? 1 / l
                          : what == 'd' ? std::numbers::pi / 180
                                        : 1;
    return value * factor;
  }

  const CoefficientRows& rows_;
  FileUnits units_;
};

/// Lennard-Jones parameters of types and pairs.
class PairReader {
 public:
  PairReader(const CoefficientRows& rows, const FileUnits& units) : rows_(rows), units_(units) {}

  void read(Structure& structure) {
    const std::int64_t types = rows_.data().count("atom types");
    read_style();
    const std::vector<CoefficientRow> rows = rows_.of("pair", "atom", types);
    std::map<std::pair<int, int>, const CoefficientRow*> from;
    for (const CoefficientRow& row : rows) {
      structure.pair_style_assumed = structure.pair_style_assumed || row.style.empty() || is_hybrid(row.style);
      const auto [pair, ends] = pair_of(row);
      for (int a = row.types[0].first; a <= row.types[0].second; ++a) {
        for (int b = row.types[1].first; b <= row.types[1].second; ++b) {
          const std::pair<int, int> key = std::minmax(a, b);
          const CoefficientRow*& own = from[key];
          if (own != nullptr && own != &row && !row.of_script && own->where == row.where) refuse_twice(row, key);
          own = &row;
          pairs_[key] = pair;
          ends_[key] = ends;
        }
      }
    }
    if (rows.empty()) return;
    for (int type = 0; type < types; ++type) {
      if (pairs_.contains({type, type})) continue;
      rows.back().fail(
          fmt::format("type {0} has no epsilon and sigma: there is no row for the pair {0} {0}", type + 1));
    }
    give(types, pairs_, structure.topology.pair_kinds, structure.topology.explicit_pairs);
    if (four_numbers_) give(types, ends_, structure.end_kinds, structure.explicit_end_kinds);
    structure.mixing = charmm_ ? Mixing::lorentz_berthelot : Mixing::geometric;
    structure.topology.stated_cutoff = cutoff_ * units_.length;
  }

 private:
  using Kinds = std::map<std::pair<int, int>, PairKind>;

  static const PairStyle* find(std::string_view name) {
    const auto* found = std::find_if(pair_styles.begin(), pair_styles.end(),
                                     [&](const PairStyle& style) { return style.name == name; });
    return found == pair_styles.end() ? nullptr : found;
  }

  static std::string not_read(std::string_view style) {
    std::vector<std::string> known;
    for (const PairStyle& one : pair_styles) known.emplace_back(one.name);
    return fmt::format("pair style '{}' is not supported{}", style, those_read(known));
  }

  /// Cutoffs by pair_style: "lj/cut 10", "hybrid lj/cut 10 lj/cut/coul/long 12".
  void read_style() {
    const LammpsCommand* command = rows_.script().find("pair_style");
    if (command == nullptr) return;
    const PairStyle* style = nullptr;
    std::size_t numbers = 0;
    for (std::size_t k = 1; k < command->words.size(); ++k) {
      const std::string word = without_suffix(command->words[k]);
      if (!begins_with_letter(word)) {
        if (style == nullptr || ++numbers != style->cutoff) continue;
        cutoffs_[std::string(style->name)] =
            mass_number_in(*command->text, command->line, word, fmt::format("the cutoff of {}", style->name));
      } else if (k != 1 || word != "hybrid") {
        style = find(word);
        numbers = 0;
        if (style == nullptr) command->fail(not_read(word), word);
      }
    }
  }

  [[noreturn]] static void refuse_twice(const CoefficientRow& row, const std::pair<int, int>& key) {
    if (key.first == key.second) row.fail(fmt::format("type {} appears twice in {}", key.first + 1, row.where));
    row.fail(fmt::format("the pair of types {} {} appears twice", key.first + 1, key.second + 1));
  }

  /// Epsilon and sigma, those of the ends of dihedrals, and cutoffs that must be one.
  std::pair<PairKind, PairKind> pair_of(const CoefficientRow& row) {
    if (is_hybrid(row.style) && row.of_script) row.fail("the style of these coefficients is not given; write it there");
    const std::string name = row.style.empty() || is_hybrid(row.style) ? "lj/cut" : row.style;
    const PairStyle* style = find(name);
    if (style == nullptr) row.fail(not_read(name), name);
    const std::size_t count = row.words.size();
    if (count < 2 || count > (style->charmm ? 4 : 3) || (style->charmm && count == 3)) {
      const bool unsaid = row.style.empty() && count == 4;
      row.fail(fmt::format(
          "this pair has {} coefficients; epsilon and sigma are expected, and optionally {}{}", count,
          style->charmm ? "both again for the ends of dihedrals" : "a cutoff",
          unsaid ? ", or the style after the name of the section: 'Pair Coeffs # lj/charmm/coul/long'" : ""));
    }
    static constexpr std::array<std::string_view, 4> names = {"epsilon", "sigma", "epsilon of ends", "sigma of ends"};
    std::array<double, 4> c{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::string what(k == 2 && count == 3 ? std::string_view("the cutoff") : names[k]);
      c[k] = mass_number_in(*row.text, row.line, row.words[k], what);
    }
    check_style(row, *style);
    const auto known = cutoffs_.find(name);
    if (count == 3 || known != cutoffs_.end()) check_cutoff(row, count == 3 ? c[2] : known->second);
    const PairKind pair = {c[0] * units_.energy, c[1] * units_.length};
    if (count < 4) return {pair, pair};
    four_numbers_ = true;
    return {pair, {c[2] * units_.energy, c[3] * units_.length}};
  }

  void check_style(const CoefficientRow& row, const PairStyle& style) {
    if (style_line_ != 0 && style.charmm != charmm_) {
      row.fail(fmt::format("pairs of style '{}' are mixed differently from those at line {}; one style is expected",
                           style.name, style_line_));
    }
    charmm_ = style.charmm;
    style_line_ = row.line;
  }

  void check_cutoff(const CoefficientRow& row, double cutoff) {
    if (cutoff_line_ != 0 && cutoff != cutoff_) {
      row.fail(
          fmt::format("the cutoffs of pairs differ: {} here, {} at line {}; a force has one cutoff; give it in the "
                      "scene, and take these out",
                      cutoff, cutoff_, cutoff_line_));
    }
    cutoff_ = cutoff, cutoff_line_ = row.line;
  }

  /// Pairs of one type are parameters of that type, the others stand instead of mixing.
  static void give(std::int64_t types, Kinds all, std::vector<PairKind>& of_types, Kinds& explicit_pairs) {
    for (int type = 0; type < types; ++type) {
      const auto own = all.find({type, type});
      of_types.push_back(own->second);
      all.erase(own);
    }
    explicit_pairs = std::move(all);
  }

  const CoefficientRows& rows_;
  FileUnits units_;
  Kinds pairs_, ends_;
  std::map<std::string, double> cutoffs_;  ///< that a style has by pair_style
  double cutoff_ = 0;
  std::size_t cutoff_line_ = 0, style_line_ = 0;
  bool charmm_ = false, four_numbers_ = false;
};

}  // namespace

LammpsCoefficients read_lammps_coefficients(const LammpsText& data, const LammpsScript& script, const FileUnits& units,
                                            Structure& structure) {
  const CoefficientRows rows(data, script);
  PairReader(rows, units).read(structure);
  const CoefficientReader reader(rows, units);
  return {reader.kinds("bond"), reader.kinds("angle"), reader.kinds("dihedral"), reader.kinds("improper")};
}

}  // namespace noether::io
