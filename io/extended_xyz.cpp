// Extended XYZ, and plain XYZ: one frame of a file.
#include "io/structure_parts.hpp"
#include "io/xyz_comment.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace noether::io {

namespace {

/// One property of a frame: where its columns begin, and how many there are.
struct XyzProperty {
  std::size_t column, count;
  bool read = false;
};

/// One frame: the line of its number of atoms.
struct XyzFrame {
  std::size_t line, atoms;
};

class ExtendedXyzReader {
 public:
  ExtendedXyzReader(const TextFile& text, const FileUnits& units, const StructureOptions& options)
      : text_(text), units_(units), options_(options) {}

  Structure read() {
    if (text_.lines().empty()) text_.fail(0, "the file is empty; XYZ begins with the number of atoms");
    const XyzFrame frame = chosen();
    comment_line_ = frame.line + 1;
    const XyzComment comment(text_, comment_line_);
    const std::string* properties = comment.find("Properties");
    plain_ = properties == nullptr;
    read_properties(plain_ ? "species:S:1:pos:R:3" : *properties);
    if (comment.is_periodic()) structure_.box = comment.box(units_.length);
    check_units_of_velocities(comment);
    if (plain_) pass_over_further_columns(frame);
    for (std::size_t k = 0; k < frame.atoms; ++k) read_atom(comment_line_ + 1 + k);
    take_masses_of_quip();
    return std::move(structure_);
  }

 private:
  /// The frame whose number of atoms stands in a line.
  XyzFrame frame_at(std::size_t line) const {
    const std::string_view count = trimmed(text_.lines()[line - 1]);
    const auto atoms =
        static_cast<std::size_t>(whole_number_in(text_, line, count, "the number of atoms", 1, most_particles));
    const std::size_t left = text_.lines().size() - line;
    if (left < atoms + 1) {
      text_.fail(line, fmt::format("{} atoms are declared, but the file ends after {} of them", atoms,
                                   std::max<std::size_t>(left, 1) - 1));
    }
    return {line, atoms};
  }

  /// The next line that is not empty; 0 if there is none.
  std::size_t line_behind(const XyzFrame& frame) const {
    for (std::size_t line = frame.line + frame.atoms + 2; line <= text_.lines().size(); ++line) {
      if (!trimmed(text_.lines()[line - 1]).empty()) return line;
    }
    return 0;
  }

  XyzFrame chosen() const {
    std::vector<XyzFrame> frames = {frame_at(1)};
    if (options_.frame) {
      while (const std::size_t next = line_behind(frames.back())) frames.push_back(frame_at(next));
      return frames[frame_of(options_, frames.size())];
    }
    if (const std::size_t next = line_behind(frames[0])) {
      text_.fail(
          next,
          fmt::format("there is more text after the {} atoms of the first frame, but a structure is one frame: give "
                      "frame = 0, or frame = -1 for the last",
                      frames[0].atoms));
    }
    return frames[0];
  }

  /// What the second column of plain XYZ may be in the place of x; every atom takes some of it away.
  struct SecondColumn {
    bool atomic_number = true, weight = true, atom_number = true, label = true;
    bool any_number = false, any_weight = false;  ///< of an element, not of atoms that are none
    double begin = 0;                             ///< of the first atom
  };

  /// Of plain XYZ: columns behind the position, charges or velocities or anything else, are passed over. One before
  /// the position, an atomic number, a mass or a number of atoms, would pass for x.
  void pass_over_further_columns(const XyzFrame& frame) {
    const std::size_t first = frame.line + 2;
    split_words(text_.lines()[first - 1], words_);
    if (words_.size() <= columns_) return;
    const std::size_t found = words_.size();
    const bool one = found == columns_ + 1;
    columns_ = found;
    SecondColumn second;
    for (std::size_t k = 0; k < frame.atoms; ++k) {
      split_words(text_.lines()[first + k - 1], words_);
      if (words_.size() != found) return;  // refused where atoms are read
      judge(second, k, number_in(text_, first + k, words_[1], "pos"));
    }
    std::string_view what;
    if (second.atomic_number && second.any_number) what = "has the atomic number of each atom";
    if (second.weight && second.any_weight) what = "has the mass of each atom";
    if (second.atom_number && frame.atoms > 1) what = "numbers the atoms";
    if (what.empty() && second.label) what = "has whole numbers before three numbers with a point";
    if (!what.empty()) {
      text_.fail(first, fmt::format("the second column {}, where XYZ has x; take that column out", what));
    }
    note(options_, fmt::format("x, y, z of the structure are taken from columns 2 to 4; column{} {} ignored",
                               one ? " 5" : fmt::format("s 5 to {}", found), one ? "is" : "are"));
  }

  /// What the number in the second column of atom k, whose words these are, may be in the place of x.
  void judge(SecondColumn& second, std::size_t k, double number) const {
    const std::string meant = element_meant_by(words_[0]);
    // CA is calcium, or carbon of a protein; what is no element at all is a dummy, of number and mass 0.
    const std::string_view initial = words_[0].substr(0, 1);
    const bool dummy = meant.empty() && number == 0;
    bool is_number = false, is_weight = false;
    for (const std::string_view element : {std::string_view(meant), initial}) {
      const int expected = number_of_element(element);
      if (expected == 0) continue;
      is_number = is_number || number == expected;
      is_weight = is_weight || std::abs(number - standard_atomic_weight(element)) <= 0.1;
    }
    second.atomic_number = second.atomic_number && (is_number || dummy);
    second.any_number = second.any_number || is_number;
    second.weight = second.weight && (is_weight || dummy);
    second.any_weight = second.any_weight || is_weight;
    const auto has_point = [](std::string_view word) { return word.find('.') != std::string_view::npos; };
    const bool whole = !has_point(words_[1]) && number == std::floor(number);
    const auto steps = static_cast<double>(k);
    if (k == 0) second.begin = number;
    second.atom_number =
        second.atom_number && whole && (second.begin == 0 || second.begin == 1) && number == second.begin + steps;
    second.label = second.label && whole && has_point(words_[2]) && has_point(words_[3]) && has_point(words_[4]);
  }

  /// QUIP writes masses in eV fs^2/angstrom^2 where others write u: all of them are then 103.64 times too large.
  void take_masses_of_quip() {
    static constexpr double factor = 1.66053906660e-27 / 1.602176634e-29;
    if (!mass_) return;
    std::size_t judged = 0;
    for (std::size_t k = 0; k < structure_.masses.size(); ++k) {
      const std::string& species =
          structure_.topology.type_names[static_cast<std::size_t>(structure_.topology.types[k])];
      const double ratio = structure_.masses[k] / standard_atomic_weight(species);
      if (std::isnan(ratio)) continue;
      if (std::abs(ratio / factor - 1) > 0.02) return;
      ++judged;
    }
    if (judged == 0) return;
    for (double& mass : structure_.masses) mass /= factor;
    // Velocities of momenta have been divided by the mass as it stands in the file.
    if (momentum_) {
      for (Vec3<double>& velocity : structure_.v) velocity *= factor;
    }
    note(options_,
         "the masses of the structure are 103.64 times the atomic weights: they are taken as eV fs^2/angstrom^2, as "
         "QUIP writes them");
  }

  void read_properties(const std::string& value) {
    std::vector<std::string> words(1);
    for (const char c : value) {
      if (c == ':') words.emplace_back();
      if (c != ':') words.back() += c;
    }
    if (words.size() % 3 != 0) {
      fail(fmt::format("Properties={} is not of the form name:type:columns:...", value), value);
    }
    for (std::size_t k = 0; k < words.size(); k += 3) {
      const auto count = static_cast<std::size_t>(whole_number_in(
          text_, comment_line_, words[k + 2], fmt::format("the columns of property '{}'", words[k]), 1, 1000));
      if (!properties_.try_emplace(words[k], XyzProperty{columns_, count}).second) {
        fail(fmt::format("property '{}' appears twice", words[k]), words[k]);
      }
      columns_ += count;
    }
    species_ = property({"species"}, 1);
    if (!species_) atomic_number_ = property({"Z", "numbers", "atomic_numbers"}, 1);
    position_ = property({"pos"}, 3);
    for (const auto& [name, wanted] :
         {std::pair("species", species_ ? species_ : atomic_number_), std::pair("pos", position_)}) {
      if (!wanted) fail(fmt::format("there is no property '{}' in Properties={}", name, value), value);
    }
    velocity_ = property({"velo", "vel", "velocities", "velocity"}, 3);
    momentum_ = property({"momenta"}, 3);
    charge_ = property({"charge", "initial_charges"}, 1);
    // Of other counts these are something else, such as quaternions.
    for (const char* const name : {"charges", "q"}) {
      const auto found = properties_.find(name);
      if (!charge_ && found != properties_.end() && found->second.count == 1) charge_ = property({name}, 1);
    }
    mass_ = property({"mass", "masses"}, 1);
    for (const auto& [name, one] : properties_) {
      // Forces are computed anew.
      if (one.read || name == "forces" || name == "force" || (name == "Z" && species_)) continue;
      note(options_, fmt::format("the columns '{}' of the structure are ignored", name));
    }
  }

  /// Refuses velocities of which nobody says what they count.
  void check_units_of_velocities(const XyzComment& comment) {
    if (velocity_ && momentum_) fail("both velocities and momenta are given; only one of them is expected");
    const std::string* temperature = comment.find("Temperature");
    if (temperature != nullptr && (velocity_ || momentum_)) {
      const double stated = mass_number_in(text_, comment_line_, *temperature, "Temperature");
      structure_.temperature = {stated, comment_line_, momentum_.has_value()};
    }
    static constexpr std::string_view remedy = "give file_units = \"real\" (angstrom/fs) or \"metal\" (angstrom/ps)";
    if (momentum_ && !options_.file_units.empty() && options_.file_units != "lj") {
      fail(fmt::format(
          "momenta are in sqrt(eV u), as ASE writes them, whatever file_units = \"{}\" says; take file_units out",
          options_.file_units));
    }
    if (!velocity_ || !options_.file_units.empty()) return;
    structure_.velocity_units_assumed = true;
    if (const std::string name = velocity_name_; name != "velo" && name != "vel") {
      fail(fmt::format("'{}' may be in any units; {}", name, remedy), name);
    }
    if (temperature == nullptr && comment.find("Timestep") != nullptr) {
      fail(fmt::format(
          "velocities that LAMMPS writes are in the units of its run, but the file does not say which they are; {}",
          remedy));
    }
  }

  /// The first of these properties that is there.
  std::optional<XyzProperty> property(const std::vector<std::string>& names, std::size_t count) {
    for (const std::string& name : names) {
      const auto found = properties_.find(name);
      if (found == properties_.end()) continue;
      if (found->second.count != count) {
        fail(fmt::format("property '{}' has {} columns; expected {}", name, found->second.count, count), name);
      }
      if (name.starts_with("vel")) velocity_name_ = name;
      found->second.read = true;
      return found->second;
    }
    return {};
  }

  void read_atom(std::size_t line) {
    split_words(text_.lines()[line - 1], words_);
    if (words_.size() != columns_) {
      text_.fail(line, fmt::format("this atom has {} columns; expected {}, as {}", words_.size(), columns_,
                                   !plain_         ? "Properties say"
                                   : columns_ == 4 ? "there are a species and x, y, z"
                                                   : "the first atom has"));
    }
    const std::string species = species_of_atom(line);
    if (const std::string wrong = wrong_name(species); !wrong.empty()) text_.fail(line, wrong, species);
    const auto number = static_cast<std::int64_t>(structure_.ids.size()) + 1;
    structure_.ids.push_back(number);
    structure_.names.push_back(fmt::format("{}_{}", species, number));
    structure_.topology.types.push_back(type_of(species, line));
    const double mass =
        mass_ ? mass_number_in(text_, line, words_[mass_->column], "the mass") : standard_atomic_weight(species);
    structure_.masses.push_back(mass);
    structure_.x.push_back(vector(line, *position_, "pos") * units_.length);
    structure_.v.push_back(velocity(line, mass, species));
    if (charge_) structure_.charges.push_back(number_in(text_, line, words_[charge_->column], "the charge"));
  }

  /// The species of an atom, by its name or its atomic number.
  std::string species_of_atom(std::size_t line) const {
    if (species_) return std::string(words_[species_->column]);
    const std::string_view word = words_[atomic_number_->column];
    return std::string(
        symbol_of_element(static_cast<int>(whole_number_in(text_, line, word, "the atomic number", 1, 118))));
  }

  Vec3<double> velocity(std::size_t line, double mass, const std::string& species) const {
    if (velocity_) return vector(line, *velocity_, "velo") * units_.velocity;
    if (!momentum_) return Vec3<double>::Zero();
    const Vec3<double> momentum = vector(line, *momentum_, "momenta");
    if (mass == 0 && momentum == Vec3<double>::Zero()) return momentum;  // a site without mass
    if (!(mass > 0))
      text_.fail(line, fmt::format("momenta are given, but there is no mass for '{}'", species), species);
    return momentum * (units_.momentum_velocity / mass);
  }

  Vec3<double> vector(std::size_t line, const XyzProperty& property, const std::string& name) const {
    Vec3<double> v;
    for (std::size_t k = 0; k < 3; ++k)
      v[static_cast<int>(k)] = number_in(text_, line, words_[property.column + k], name);
    return v;
  }

  std::int64_t type_of(const std::string& species, std::size_t line) {
    const auto count = static_cast<std::int64_t>(types_.size());
    const auto [at, fresh] = types_.try_emplace(species, count);
    if (fresh) structure_.topology.type_names.push_back(species), structure_.type_lines.push_back(line);
    return at->second;
  }

  [[noreturn]] void fail(const std::string& message, const std::string& value = "") const {
    text_.fail(comment_line_, message, value);
  }

  const TextFile& text_;
  FileUnits units_;
  const StructureOptions& options_;
  std::size_t comment_line_ = 0;
  Structure structure_;
  std::map<std::string, XyzProperty> properties_;
  std::size_t columns_ = 0;
  bool plain_ = false;  ///< without Properties
  std::optional<XyzProperty> species_, atomic_number_, position_, velocity_, momentum_, charge_, mass_;
  std::string velocity_name_;
  std::map<std::string, std::int64_t> types_;
  std::vector<std::string_view> words_;
};

}  // namespace

Structure read_extended_xyz(const TextFile& text, const FileUnits& units, const StructureOptions& options) {
  return ExtendedXyzReader(text, units, options).read();
}

}  // namespace noether::io
