#pragma once
/// Scenes as text: TOML in, TOML out.

#include "scene/value.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// How many tables and lists may stand in one another: readers and writers of scenes walk them by recursion.
inline constexpr int deepest_table = 64;

/// Reads a TOML document.
/// @param file  the name that errors show
/// @throws SceneError with file and line
SceneValue parse_toml(std::string_view text, const std::string& file);

/// Reads one value as it stands behind an equals sign; empty if it is not TOML, or nested too deeply.
std::optional<SceneValue> parse_toml_value(std::string_view text, int line);

/// Writes a table as a TOML document: plain keys first, then tables, then lists of tables, each in order.
///
/// `parse_toml` reads it back to the same values, numbers to the bit.
std::string print_toml(const SceneValue& table);

}  // namespace noether
