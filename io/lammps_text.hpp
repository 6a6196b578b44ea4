#pragma once
/// A LAMMPS data file as text: the counts of its header, its box, and its sections by name.

#include "io/structure_parts.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// One section: the style behind `#`, and the lines of its rows, counted from 1.
struct LammpsSection {
  std::string name, style;
  std::size_t line = 0;
  std::vector<std::size_t> rows = {};
};

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
  /// The line of an edge of the box.
  std::size_t box_line() const { return bounds_.at("xlo xhi"); }

 private:
  void read_header_line(std::size_t line, const std::vector<std::string_view>& words);
  void read_bounds(std::size_t line, const std::vector<std::string_view>& words, const std::string& axis);
  void begin_section(std::size_t line);
  void check_bounds() const;

  struct Count {
    std::int64_t number;
    std::size_t line;
  };
  const TextFile& text_;
  std::map<std::string, Count> counts_;
  std::map<std::string, std::size_t> bounds_;
  std::vector<LammpsSection> sections_;
  Vec3<double> low_ = Vec3<double>::Zero(), edges_ = Vec3<double>::Zero();
};

/// Kinds of terms and pairs of a LAMMPS data file, in noether's conventions.
/// @throws SceneError
void read_lammps_coefficients(const LammpsText& data, const FileUnits& units, Topology& topology);

}  // namespace noether::io
