// LAMMPS data files: atoms, velocities and the terms that join atoms.
#include "io/lammps_script.hpp"
#include "io/lammps_text.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace noether::io {

namespace {

/// A style of atoms: which column holds what, counted from 0; -1: none does. The id stands in column 0.
struct AtomStyle {
  std::string_view name;
  int molecule, type, charge, x;

  std::size_t columns() const { return static_cast<std::size_t>(x) + 3; }
};
constexpr std::array<AtomStyle, 6> atom_styles = {{{"atomic", -1, 1, -1, 2},
                                                   {"charge", -1, 1, 2, 3},
                                                   {"bond", 1, 2, -1, 3},
                                                   {"angle", 1, 2, -1, 3},
                                                   {"molecular", 1, 2, -1, 3},
                                                   {"full", 1, 2, 3, 4}}};

/// Styles of LAMMPS whose rows say more of an atom than is read.
constexpr std::array<std::string_view, 25> other_atom_styles = {
    "amoeba", "apip",   "body",      "bpm/sphere", "dielectric", "dipole", "dpd",       "edpd",         "electron",
    "hybrid", "line",   "ellipsoid", "mdpd",       "mesont",     "peri",   "rheo",      "rheo/thermal", "smd",
    "sph",    "sphere", "spin",      "tdpd",       "template",   "tri",    "wavepacket"};

struct LammpsAtom {
  std::int64_t id = 0, molecule = 0;
  std::size_t line = 0;
  int type = 0;
  double charge = 0;
  Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();
  Vec3<std::int32_t> image = Vec3<std::int32_t>::Zero();
};

bool is_whole(std::string_view word) {
  std::int64_t number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  return problem == std::errc() && end == word.data() + word.size();
}

class LammpsDataReader {
 public:
  LammpsDataReader(const TextFile& text, const LammpsScript& script, const FileUnits& units,
                   const StructureOptions& options)
      : text_(text), script_(script), units_(units), options_(options), data_(text) {}

  Structure read() {
    const LammpsSection* atoms = data_.section("Atoms", "atoms", true);
    if (atoms == nullptr || atoms->rows.empty()) text_.fail(0, "the file has 0 atoms; 1 or more are expected");
    read_masses();
    read_atoms(*atoms);
    if (const LammpsSection* found = data_.section("Velocities", "atoms", false)) read_velocities(*found);
    LammpsCoefficients kinds = read_lammps_coefficients(data_, script_, units_, structure_);
    read_terms("Bonds", "bond", kinds.bonds, topology_.bonds);
    read_terms("Angles", "angle", kinds.angles, topology_.angles);
    read_terms("Dihedrals", "dihedral", kinds.dihedrals, topology_.dihedrals);
    read_terms("Impropers", "improper", kinds.impropers, topology_.impropers);
    topology_.bond_kinds = std::move(kinds.bonds.kinds);
    topology_.angle_kinds = std::move(kinds.angles.kinds);
    topology_.dihedral_kinds = std::move(kinds.dihedrals.kinds);
    topology_.improper_kinds = std::move(kinds.impropers.kinds);
    return finish();
  }

 private:
  void read_masses() {
    const std::int64_t types = data_.count("atom types");
    masses_.assign(static_cast<std::size_t>(types), std::numeric_limits<double>::quiet_NaN());
    for (std::int64_t k = 1; k <= types; ++k) {
      const std::string label = data_.labels().label("atom", k);
      topology_.type_names.push_back(label.empty() ? fmt::format("{}", k) : label);
    }
    if (const LammpsSection* section = data_.section("Masses", "atom types", false)) {
      for (const std::size_t line : section->rows) {
        words_of_row(*section, line, 2);
        double& mass = masses_[static_cast<std::size_t>(type_in(line, words_[0], "the type"))];
        if (mass == mass) text_.fail(line, fmt::format("the mass of type {} appears twice", words_[0]));
        mass = mass_number_in(text_, line, words_[1], "the mass");
      }
    }
    for (const LammpsCommand* command : script_.all("mass")) {
      if (command->words.size() != 3) command->fail("a type and its mass are expected after 'mass'");
      const double mass = mass_number_in(*command->text, command->line, command->words[2], "the mass");
      const auto [from, to] = data_.labels().types_in(*command->text, command->line, command->words[1], "atom", types);
      for (std::int64_t type = from; type <= to; ++type) masses_[static_cast<std::size_t>(type - 1)] = mass;
    }
  }

  /// A type of atoms, counted from 0, by number or label.
  std::int64_t type_in(std::size_t line, std::string_view word, std::string_view what) const {
    return data_.labels().type_in(text_, line, word, "atom", what, data_.count("atom types")) - 1;
  }

  /// Parts a row that must have so many words.
  void words_of_row(const LammpsSection& section, std::size_t line, std::size_t expected) {
    split_words(text_.lines()[line - 1], words_);
    if (words_.size() == expected) return;
    text_.fail(
        line, fmt::format("this row of section '{}' has {} words; expected {}", section.name, words_.size(), expected));
  }

  void read_atoms(const LammpsSection& section) {
    const AtomStyle style = style_of(section);
    split_words(text_.lines()[section.rows.front() - 1], words_);
    const bool images = words_.size() == style.columns() + 3;
    for (const std::size_t line : section.rows) {
      split_words(text_.lines()[line - 1], words_);
      if (words_.size() != style.columns() + (images ? 3 : 0)) {
        text_.fail(line,
                   fmt::format("this row of section 'Atoms' has {} words; style '{}' has {}, or {} with images, in "
                               "every row",
                               words_.size(), style.name, style.columns(), style.columns() + 3));
      }
      atoms_.push_back(atom_in(line, style, images));
    }
    has_images_ = images;
    has_charges_ = style.charge >= 0;
    has_molecules_ = style.molecule >= 0;
    std::stable_sort(atoms_.begin(), atoms_.end(),
                     [](const LammpsAtom& a, const LammpsAtom& b) { return a.id < b.id; });
    const auto twice = std::adjacent_find(atoms_.begin(), atoms_.end(),
                                          [](const LammpsAtom& a, const LammpsAtom& b) { return a.id == b.id; });
    if (twice == atoms_.end()) return;
    text_.fail((twice + 1)->line, fmt::format("atom {} appears twice, also at line {}", twice->id, twice->line),
               fmt::format("{}", twice->id));
  }

  LammpsAtom atom_in(std::size_t line, const AtomStyle& style, bool images) const {
    constexpr std::int64_t most_cells = 1 << 29;
    const auto word = [&](int column) { return words_[static_cast<std::size_t>(column)]; };
    LammpsAtom atom;
    atom.line = line;
    atom.id = whole_number_in(text_, line, word(0), "the id of an atom", 1, ParticleSystem<double>::largest_id);
    atom.type = static_cast<int>(type_in(line, word(style.type), "the type of an atom"));
    if (style.molecule >= 0) {
      atom.molecule = whole_number_in(text_, line, word(style.molecule), "the molecule of an atom", 0,
                                      ParticleSystem<double>::largest_id);
    }
    if (style.charge >= 0) atom.charge = number_in(text_, line, word(style.charge), "the charge of an atom");
    for (int k = 0; k < 3; ++k) {
      const double x = number_in(text_, line, word(style.x + k), std::string(1, static_cast<char>('x' + k)));
      atom.x[k] = (x - data_.low()[k]) * units_.length;
      if (!images) continue;
      atom.image[k] = static_cast<std::int32_t>(
          whole_number_in(text_, line, word(style.x + 3 + k), "an image", -most_cells, most_cells));
    }
    return atom;
  }

  AtomStyle style_of(const LammpsSection& section) {
    const std::string said = without_suffix(options_.atom_style);
    // A word that is no style of LAMMPS is a remark.
    const std::string own = is_atom_style(section.style) ? section.style : "";
    if (!said.empty() && !own.empty() && said != own) {
      text_.fail(section.line,
                 fmt::format("the file says atom style '{}', but the scene says '{}'; take atom_style out", own, said));
    }
    const std::string& name = own.empty() ? said : own;
    if (name.empty()) return deduced_style(section);
    std::vector<std::string> known;
    for (const AtomStyle& style : atom_styles) {
      if (style.name == name) return style;
      known.emplace_back(style.name);
    }
    if (own.empty() && !is_atom_style(name)) {
      throw Error(fmt::format("atom style '{}' is not supported{}", name, did_you_mean(name, known)),
                  {.key = "atom_style", .value = name});
    }
    const std::string message =
        fmt::format("atom style '{}' is not supported; expected one of: {}", name, fmt::join(known, ", "));
    if (own.empty()) throw Error(message, {.key = "atom_style", .value = name});
    text_.fail(section.line, message, name);
  }

  static bool is_atom_style(const std::string& name) {
    const auto is_name = [&](const AtomStyle& style) { return style.name == name; };
    return std::any_of(atom_styles.begin(), atom_styles.end(), is_name) ||
           std::find(other_atom_styles.begin(), other_atom_styles.end(), name) != other_atom_styles.end();
  }

  /// The style by the number of columns; molecular and charge have as many, and differ where charges are no whole
  /// numbers, or atoms are bonded.
  AtomStyle deduced_style(const LammpsSection& section) {
    split_words(text_.lines()[section.rows.front() - 1], words_);
    const std::size_t columns = words_.size();
    if (columns == 5 || columns == 8) return atom_styles[0];
    if (columns == 7 || columns == 10) return atom_styles[5];
    if (columns == 6 || columns == 9) {
      if (data_.count("bonds") > 0) return atom_styles[4];
      for (const std::size_t line : section.rows) {
        split_words(text_.lines()[line - 1], words_);
        if (words_.size() == columns && !is_whole(words_[2])) return atom_styles[1];
      }
    }
    text_.fail(
        section.line,
        fmt::format("rows of {} words could be of several styles{}; write 'Atoms # molecular', or give "
                    "atom_style = \"molecular\" or another one",
                    columns, section.style.empty() ? "" : fmt::format(", but '{}' is not one of them", section.style)));
  }

  std::size_t index_of(std::int64_t id) const {
    const auto at = std::lower_bound(atoms_.begin(), atoms_.end(), id,
                                     [](const LammpsAtom& atom, std::int64_t wanted) { return atom.id < wanted; });
    return at != atoms_.end() && at->id == id ? static_cast<std::size_t>(at - atoms_.begin()) : atoms_.size();
  }

  void read_velocities(const LammpsSection& section) {
    std::vector<bool> seen(atoms_.size(), false);
    for (const std::size_t line : section.rows) {
      words_of_row(section, line, 4);
      const std::size_t i =
          index_of(whole_number_in(text_, line, words_[0], "the id of an atom", 1, ParticleSystem<double>::largest_id));
      if (i == atoms_.size())
        text_.fail(line, fmt::format("a velocity is given for atom {}, which does not exist", words_[0]));
      if (seen[i]) text_.fail(line, fmt::format("the velocity of atom {} appears twice", words_[0]));
      seen[i] = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::string name = std::string("v") + static_cast<char>('x' + k);
        atoms_[i].v[static_cast<int>(k)] = number_in(text_, line, words_[k + 1], name) * units_.velocity;
      }
    }
  }

  template <std::size_t n>
  void read_terms(const std::string& name, const std::string& term, const LammpsKinds& kinds,
                  std::vector<BondedTerm<n>>& terms) {
    const LammpsSection* section = data_.section(name, term + "s", true);
    if (section == nullptr) return;
    const std::int64_t types = data_.count(fmt::format("{} types", term));
    const std::string what = fmt::format("the type of this {}", term);
    for (const std::size_t line : section->rows) {
      words_of_row(*section, line, n + 2);
      BondedTerm<n> one;
      one.type = static_cast<int>(data_.labels().type_in(text_, line, words_[1], term, what, types) - 1);
      for (std::size_t k = 0; k < n; ++k) one.particles[k] = joined(line, term, words_[k + 2]);
      auto sorted = one.particles;
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
        text_.fail(line, fmt::format("{} {} joins an atom to itself", term, words_[0]));
      }
      if (kinds.types.empty()) {
        terms.push_back(one);
        continue;
      }
      const LammpsKinds::OfType& of_type = kinds.types[static_cast<std::size_t>(one.type)];
      for (int k = 0; k < of_type.count; ++k) terms.push_back({one.particles, of_type.first + k});
      if constexpr (n == 4) {
        if (of_type.weight != 0) structure_.end_pairs.push_back({one.particles, of_type.weight, of_type.weight});
      }
    }
  }

  Index joined(std::size_t line, std::string_view term, std::string_view word) const {
    const std::int64_t id =
        whole_number_in(text_, line, word, "the id of an atom", 1, ParticleSystem<double>::largest_id);
    const std::size_t i = index_of(id);
    if (i == atoms_.size())
      text_.fail(line, fmt::format("{} {} joins atom {}, which does not exist", term, words_[0], id));
    return static_cast<Index>(i);
  }

  Structure finish() {
    Structure& s = structure_;
    for (const LammpsAtom& atom : atoms_) {
      s.ids.push_back(atom.id);
      s.names.push_back(fmt::format("atom_{}", atom.id));
      s.masses.push_back(masses_[static_cast<std::size_t>(atom.type)]);
      s.x.push_back(atom.x);
      s.v.push_back(atom.v);
      if (has_images_) s.images.push_back(atom.image);
      if (has_charges_) s.charges.push_back(atom.charge);
      topology_.types.push_back(atom.type);
      if (has_molecules_) topology_.molecules.push_back(atom.molecule);
    }
    s.box = box_in(text_, data_.box_line(), data_.edges() * units_.length);
    return std::move(s);
  }

  const TextFile& text_;
  const LammpsScript& script_;
  FileUnits units_;
  const StructureOptions& options_;
  LammpsText data_;
  std::vector<double> masses_;
  std::vector<LammpsAtom> atoms_;
  Structure structure_;
  Topology& topology_ = structure_.topology;
  bool has_images_ = false, has_charges_ = false, has_molecules_ = false;
  std::vector<std::string_view> words_;
};

}  // namespace

Structure read_lammps_data(const TextFile& text, const LammpsScript& script, const FileUnits& units,
                           const StructureOptions& options) {
  return LammpsDataReader(text, script, units, options).read();
}

}  // namespace noether::io
