// Coefficients of LAMMPS data files, in LAMMPS's conventions, as kinds of noether.
#include "io/lammps_text.hpp"
#include "numbers/suggest.hpp"

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
/// e energy, l length, k energy/length^2, i 1/length, d degrees, n whole number, s sign (1 or -1), w weight (0).
struct CoefficientStyle {
  std::string_view section, name, numbers;
  TermKind (*kind)(const Coefficients& c);
};

/// k (1 + sign cos(n phi)), as a cosine with a phase of 0 or pi.
TermKind signed_cosine(double k, double sign, double n) {
  return {"periodic", {k, n, sign > 0 ? 0 : std::numbers::pi}};
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
constexpr std::array<CoefficientStyle, 11> coefficient_styles = {{
    {"Bond Coeffs", "harmonic", "kl",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"Bond Coeffs", "morse", "eil",
     [](const Coefficients& c) {
       return TermKind{"morse", {c[0], c[1], c[2]}};
     }},
    {"Bond Coeffs", "fene", "klel",
     [](const Coefficients& c) {
       return TermKind{"fene", {c[0], c[1], c[2], c[3]}};
     }},
    {"Angle Coeffs", "harmonic", "ed",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"Angle Coeffs", "cosine", "e",
     [](const Coefficients& c) {
       return TermKind{"cosine", {c[0]}};
     }},
    {"Dihedral Coeffs", "charmm", "endw",
     [](const Coefficients& c) {
       return TermKind{"periodic", {c[0], c[1], c[2]}};
     }},
    {"Dihedral Coeffs", "harmonic", "esn", [](const Coefficients& c) { return signed_cosine(c[0], c[1], c[2]); }},
    {"Dihedral Coeffs", "multi/harmonic", "eeeee", ryckaert_bellemans},
    {"Dihedral Coeffs", "opls", "eeee", opls},
    {"Improper Coeffs", "harmonic", "ed",
     [](const Coefficients& c) {
       return TermKind{"harmonic", {2 * c[0], c[1]}};
     }},
    {"Improper Coeffs", "cvff", "esn", [](const Coefficients& c) { return signed_cosine(c[0], c[1], c[2]); }},
}};

/// Styles whose first two coefficients are epsilon and sigma.
constexpr std::array<std::string_view, 6> pair_styles = {"lj/cut",          "lj/cut/coul/cut",   "lj/cut/coul/long",
                                                         "lj/cut/coul/dsf", "lj/cut/coul/debye", "lj/cut/coul/msm"};

/// One row of a section of coefficients.
struct CoefficientRow {
  std::size_t line;
  std::vector<std::string_view> words;  ///< the numbers
  std::string style;
};

class CoefficientReader {
 public:
  CoefficientReader(const LammpsText& data, const FileUnits& units) : data_(data), text_(data.text()), units_(units) {}

  std::vector<TermKind> kinds(const std::string& section, const std::string& counted) {
    const LammpsSection* found = data_.section(section, counted, false);
    if (found == nullptr) return {};
    std::vector<std::optional<TermKind>> kinds(found->rows.size());
    for (const std::size_t line : found->rows) {
      const auto [type, row] = split(*found, line, static_cast<std::int64_t>(kinds.size()), 1);
      auto& kind = kinds[static_cast<std::size_t>(type[0])];
      if (kind) text_.fail(line, fmt::format("type {} stands twice in section '{}'", type[0] + 1, section));
      kind = kind_of(*found, row);
    }
    std::vector<TermKind> result;
    for (auto& kind : kinds) result.push_back(std::move(*kind));
    return result;
  }

  void pairs(Topology& topology) {
    const std::int64_t types = data_.count("atom types");
    if (const LammpsSection* found = data_.section("Pair Coeffs", "atom types", false)) {
      std::vector<std::optional<PairKind>> kinds(static_cast<std::size_t>(types));
      for (const std::size_t line : found->rows) {
        const auto [type, row] = split(*found, line, types, 1);
        auto& kind = kinds[static_cast<std::size_t>(type[0])];
        if (kind) text_.fail(line, fmt::format("type {} stands twice in section 'Pair Coeffs'", type[0] + 1));
        kind = pair_of(row);
      }
      for (const auto& kind : kinds) topology.pair_kinds.push_back(*kind);
    }
    if (const LammpsSection* found = data_.find("PairIJ Coeffs")) explicit_pairs(*found, types, topology);
    topology.stated_cutoff = cutoff_ * units_.length;
  }

 private:
  /// The types a row begins with, counted from 0, its style, and its numbers.
  std::pair<std::array<int, 2>, CoefficientRow> split(const LammpsSection& section, std::size_t line,
                                                      std::int64_t types, std::size_t indices) const {
    CoefficientRow row{line, {}, section.style};
    split_words(text_.lines()[line - 1], row.words);
    if (row.words.size() <= indices) {
      text_.fail(line, fmt::format("this row of section '{}' has {} words; a type and its coefficients are expected",
                                   section.name, row.words.size()));
    }
    std::array<int, 2> type{};
    for (std::size_t k = 0; k < indices; ++k) {
      type[k] = static_cast<int>(whole_number_in(text_, line, row.words[k], "the type", 1, types) - 1);
    }
    row.words.erase(row.words.begin(), row.words.begin() + static_cast<std::ptrdiff_t>(indices));
    const bool names_style = std::isalpha(static_cast<unsigned char>(row.words.front().front())) != 0;
    if (names_style) {
      row.style = row.words.front();
      row.words.erase(row.words.begin());
    }
    return {type, row};
  }

  TermKind kind_of(const LammpsSection& section, const CoefficientRow& row) const {
    if (row.style.empty() || row.style.starts_with("hybrid")) {
      text_.fail(row.line, fmt::format("the style of these coefficients is not said; write it behind the name of the "
                                       "section: '{} # harmonic'",
                                       section.name));
    }
    std::vector<std::string> known;
    for (const CoefficientStyle& style : coefficient_styles) {
      if (style.section != section.name) continue;
      if (style.name == row.style) return style.kind(numbers(style, row));
      known.emplace_back(style.name);
    }
    text_.fail(row.line,
               fmt::format("style '{}' of section '{}' is not read{}", row.style, section.name,
                           did_you_mean(row.style, known)),
               row.style);
  }

  Coefficients numbers(const CoefficientStyle& style, const CoefficientRow& row) const {
    if (row.words.size() != style.numbers.size()) {
      text_.fail(row.line, fmt::format("style '{}' of section '{}' takes {} coefficients; this row has {}", style.name,
                                       style.section, style.numbers.size(), row.words.size()));
    }
    Coefficients c{};
    for (std::size_t k = 0; k < row.words.size(); ++k) c[k] = number(row, k, style.numbers[k]);
    return c;
  }

  double number(const CoefficientRow& row, std::size_t k, char what) const {
    const std::string name = fmt::format("coefficient {} of style '{}'", k + 1, row.style);
    const double value = number_in(text_, row.line, row.words[k], name);
    if (what == 's' && value != 1 && value != -1) {
      text_.fail(row.line, fmt::format("{} is {}; 1 or -1 is expected", name, row.words[k]));
    }
    if (what == 'w' && value != 0) {
      text_.fail(row.line,
                 fmt::format("the weight of a charmm dihedral is {}; only 0 is read: what it scales is said by "
                             "special",
                             row.words[k]));
    }
    if (what == 'n' && (value < 0 || value > 100 || value != static_cast<int>(value))) {
      text_.fail(row.line, fmt::format("{} is {}; a whole number is expected, 0 to 100", name, row.words[k]));
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

  /// epsilon, sigma, and cutoffs that must be one.
  PairKind pair_of(const CoefficientRow& row) {
    const std::string style = row.style.empty() || row.style.starts_with("hybrid") ? "lj/cut" : row.style;
    if (std::find(pair_styles.begin(), pair_styles.end(), style) == pair_styles.end()) {
      text_.fail(row.line,
                 fmt::format("pair style '{}' is not read{}", style,
                             did_you_mean(style, {pair_styles.begin(), pair_styles.end()})),
                 style);
    }
    if (row.words.size() < 2 || row.words.size() > 3) {
      text_.fail(row.line, fmt::format("this pair has {} coefficients; epsilon and sigma are expected, and perhaps a "
                                       "cutoff",
                                       row.words.size()));
    }
    std::array<double, 3> c{};
    for (std::size_t k = 0; k < row.words.size(); ++k) {
      static constexpr std::array<std::string_view, 3> names = {"epsilon", "sigma", "the cutoff"};
      c[k] = mass_number_in(text_, row.line, row.words[k], std::string(names[k]));
    }
    if (row.words.size() == 3 && cutoff_line_ != 0 && c[2] != cutoff_) {
      text_.fail(row.line,
                 fmt::format("the cutoffs of pairs differ: {} here, {} at line {}; a force has one cutoff, give "
                             "it in the scene and take these out",
                             c[2], cutoff_, cutoff_line_));
    }
    if (row.words.size() == 3) cutoff_ = c[2], cutoff_line_ = row.line;
    return {c[0] * units_.energy, c[1] * units_.length};
  }

  /// Pairs of one type are parameters of that type, the others stand instead of mixing.
  void explicit_pairs(const LammpsSection& section, std::int64_t types, Topology& topology) {
    std::map<std::pair<int, int>, PairKind> all;
    for (const std::size_t line : section.rows) {
      const auto [type, row] = split(section, line, types, 2);
      const std::pair<int, int> key = std::minmax(type[0], type[1]);
      if (all.try_emplace(key, pair_of(row)).second) continue;
      text_.fail(line, fmt::format("the pair of types {} {} stands twice", key.first + 1, key.second + 1));
    }
    const bool known = !topology.pair_kinds.empty();
    topology.pair_kinds.resize(static_cast<std::size_t>(types));
    for (int type = 0; type < types; ++type) {
      const auto own = all.find({type, type});
      if (own != all.end()) {
        topology.pair_kinds[static_cast<std::size_t>(type)] = own->second;
        all.erase(own);
      } else if (!known) {
        text_.fail(section.line,
                   fmt::format("section 'PairIJ Coeffs' has no pair {0} {0}, and there is no section 'Pair "
                               "Coeffs'",
                               type + 1));
      }
    }
    topology.explicit_pairs = std::move(all);
  }

  const LammpsText& data_;
  const TextFile& text_;
  FileUnits units_;
  double cutoff_ = 0;
  std::size_t cutoff_line_ = 0;
};

}  // namespace

void read_lammps_coefficients(const LammpsText& data, const FileUnits& units, Topology& topology) {
  CoefficientReader reader(data, units);
  reader.pairs(topology);
  topology.bond_kinds = reader.kinds("Bond Coeffs", "bond types");
  topology.angle_kinds = reader.kinds("Angle Coeffs", "angle types");
  topology.dihedral_kinds = reader.kinds("Dihedral Coeffs", "dihedral types");
  topology.improper_kinds = reader.kinds("Improper Coeffs", "improper types");
}

}  // namespace noether::io
