#pragma once
/// A LAMMPS data file as text: the counts of its header, its box, and its sections by name.

#include "io/structure_parts.hpp"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether::io {

/// One section: the style behind `#`, and the lines of its rows, counted from 1.
struct LammpsSection {
  std::string name, style;
  std::size_t line = 0;
  std::vector<std::size_t> rows = {};
};

/// Names that a file gives to types: of atoms, bonds, angles, dihedrals and impropers.
class TypeLabels {
 public:
  /// @throws SceneError  where it stands twice
  void add(const TextFile& text, std::size_t line, const std::string& kind, std::int64_t type,
           const std::string& label);
  /// The type that a word means, its number or its label. @param kind  "atom", "bond", ...
  /// @param what  names it in messages
  /// @throws SceneError
  std::int64_t type_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& kind,
                       std::string_view what, std::int64_t most) const;
  /// The types, from and up to with, that a word of a command means: one, or those of "*", "2*", "*3", "2*3".
  /// @throws SceneError
  std::pair<std::int64_t, std::int64_t> types_in(const TextFile& text, std::size_t line, std::string_view word,
                                                 const std::string& kind, std::int64_t most) const;
  bool is_label(const std::string& kind, std::string_view word) const;
  /// The label of a type; empty if it has none.
  std::string label(const std::string& kind, std::int64_t type) const;

 private:
  std::map<std::string, std::map<std::string, std::int64_t>> types_;  ///< by kind and label
};

/// A style without the suffix of the package that computes it: "harmonic" of "harmonic/kk".
std::string without_suffix(std::string_view style);

/// Header and sections of a LAMMPS data file; rows are counted, not read.
class LammpsText {
 public:
  /// @throws SceneError
  explicit LammpsText(const TextFile& text);

  const TextFile& text() const { return text_; }
  /// What the header says of "atoms", "bond types", ...; 0 where it says nothing.
  std::int64_t count(const std::string& what) const;
  /// A section with as many rows as `count` of `what`; null where there is none, and none is needed.
  /// @param needed  whether a count above 0 asks for the section
  /// @throws SceneError
  const LammpsSection* section(const std::string& name, const std::string& what, bool needed) const;
  const LammpsSection* find(const std::string& name) const;

  const Vec3<double>& low() const { return low_; }
  const Vec3<double>& edges() const { return edges_; }
  const TypeLabels& labels() const { return labels_; }
  /// The line of an edge of the box.
  std::size_t box_line() const { return bounds_.at("xlo xhi"); }

 private:
  void read_header_line(std::size_t line, const std::vector<std::string_view>& words);
  void read_bounds(std::size_t line, const std::vector<std::string_view>& words, const std::string& axis);
  void begin_section(std::size_t line);
  void check_bounds() const;
  void read_labels();

  struct Count {
    std::int64_t number;
    std::size_t line;
  };
  const TextFile& text_;
  std::map<std::string, Count> counts_;
  std::map<std::string, std::size_t> bounds_;
  std::vector<LammpsSection> sections_;
  Vec3<double> low_ = Vec3<double>::Zero(), edges_ = Vec3<double>::Zero();
  Vec3<double> tilts_ = Vec3<double>::Zero();
  std::size_t tilt_line_ = 0;
  TypeLabels labels_;
};

/// The kinds of one family of terms, and which of them a type of the file stands for: a sum has several.
struct LammpsKinds {
  struct OfType {
    int first = 0, count = 0;
    double weight = 0;  ///< of the pair force between the ends of a dihedral
  };
  std::vector<TermKind> kinds = {};
  std::vector<OfType> types = {};  ///< empty where the file has no coefficients
};

/// Kinds of the four families of terms.
struct LammpsCoefficients {
  LammpsKinds bonds, angles, dihedrals, impropers;
};

class LammpsScript;

/// Kinds of terms of a LAMMPS data file and its scripts, in noether's conventions; those of pairs go into the
/// structure.
/// @throws SceneError
LammpsCoefficients read_lammps_coefficients(const LammpsText& data, const LammpsScript& script, const FileUnits& units,
                                            Structure& structure);

}  // namespace noether::io
