#pragma once
/// The second line of a frame of extended XYZ: keys and values.

#include "io/text_table.hpp"

#include <map>
#include <string>
#include <string_view>

namespace noether::io {

/// What the comment of a frame says: `key=value`, with blanks about the mark or without. A value that has blanks stands
/// in double or single quotes, in braces or in brackets. A line without `=` is a text that says nothing.
class XyzComment {
 public:
  /// @throws SceneError for what is not understood in a line with `=`, and for a key that stands twice
  XyzComment(const TextFile& text, std::size_t line);

  std::size_t line() const { return line_; }
  /// The value of a key, in whatever case it is written; null where it is not said.
  const std::string* find(std::string_view key) const;

  /// Whether all three directions are periodic, or none; a `Lattice` without `pbc` is periodic.
  /// @throws SceneError
  bool is_periodic() const;
  /// The box of `Lattice`, its edges times `length`.
  /// @throws SceneError where it is not orthogonal along the axes
  Box box(double length) const;

 private:
  static std::string flag(std::string_view& rest);
  std::string key(std::string_view& rest) const;
  std::string value(std::string_view& rest, const std::string& key) const;
  std::string enclosed(std::string_view& rest, const std::string& where) const;
  void check_keys() const;
  [[noreturn]] void fail(const std::string& message, const std::string& value = "") const {
    text_.fail(line_, message, value);
  }

  const TextFile& text_;
  std::size_t line_;
  std::map<std::string, std::string, std::less<>> values_;  ///< by key in small letters
  std::map<std::string, std::string, std::less<>> spelt_;   ///< keys as they are written, by key in small letters
};

}  // namespace noether::io
