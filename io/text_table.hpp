#pragma once
/// Tables in text files, line by line, with errors that name file and line.

#include "engine/particle_system.hpp"
#include "numbers/units.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// The lines of a text file, without line ends.
class TextFile {
 public:
  /// @param expected  what the file should be, for the message
  /// @throws FileError if it cannot be read or is no text
  explicit TextFile(std::filesystem::path file, std::string_view expected = "CSV or a vector table of Horizons");

  const std::vector<std::string>& lines() const { return lines_; }
  /// A text that stands within a line of this one: messages name that line, and theirs in words.
  TextFile within(std::size_t line, std::string_view content) const;
  /// @param line  counted from 1; 0 for the file as a whole
  [[noreturn]] void fail(std::size_t line, const std::string& message, const std::string& value = "") const;

 private:
  TextFile() = default;
  void set_lines(std::string_view content);

  std::filesystem::path file_;
  std::vector<std::string> lines_;
  std::size_t outer_line_ = 0;  ///< of the file, where the text stands within it
};

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// The fields between separators, trimmed; empty ones count.
std::vector<std::string> split_at(std::string_view text, char separator);

/// A heading such as "vx [au/day]" or "vx (au/day)".
struct Heading {
  std::string name;
  std::optional<std::string> unit;  ///< what stands in brackets of either kind
};
Heading parse_heading(std::string_view text);

/// Reads a finite decimal number, with the exponent of C or of Fortran, 1.5D+03; `what` names it in messages, such as
/// "column 'x'".
/// @throws SceneError
double number_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& what);

/// The same, and not negative.
double mass_number_in(const TextFile& text, std::size_t line, std::string_view word, const std::string& what);

/// Gathers bodies: names differ, states are finite.
class BodyList {
 public:
  BodyList(const TextFile& text, const UnitSystem& units) : text_(text), particles_(units) {}
  /// @throws SceneError
  void add(std::size_t line, const std::string& name, double mass, const Vec3<double>& x, const Vec3<double>& v);
  const ParticleSystem<double>& particles() const { return particles_; }
  ParticleSystem<double> take() { return std::move(particles_); }

 private:
  const TextFile& text_;
  ParticleSystem<double> particles_;
  std::set<std::string> names_;
};

/// Whether the text has a Horizons table.
bool is_horizons(const TextFile& text);

}  // namespace noether::io
