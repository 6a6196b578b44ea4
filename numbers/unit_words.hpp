#pragma once
/// The words that texts have for units: symbols, names in English, and those of other programs.

#include "numbers/units.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// The unit of a symbol, or null.
/// @throws never
const units::Definition* find_unit(std::string_view symbol) noexcept;

/// The symbol that a word stands for: itself, or that of a name in English, singular or plural: "days", "AU".
/// @throws never
std::string_view symbol_of(std::string_view word) noexcept;

/// All symbols, in the order of their tables.
/// @throws std::bad_alloc
std::vector<std::string> symbols_of_units();

/// The other words for units, in the singular.
/// @throws std::bad_alloc
std::vector<std::string> words_for_units();

/// The units that texts have beside those of programs.
/// @throws never
std::span<const units::Definition> units_of_texts() noexcept;

}  // namespace noether
