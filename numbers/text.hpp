#pragma once
/// Text from outside: what may be a name, and what can be shown on one line.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What is wrong with the name of a body; "" if nothing.
///
/// A name is UTF-8, has at least one character, and none that controls a terminal or ends a line.
/// @throws std::bad_alloc
std::string wrong_name(std::string_view name);

/// The words of a text, parted by blanks.
/// @throws std::bad_alloc
std::vector<std::string> words_of(std::string_view text);

/// A number and its noun: "1 step", "2 steps", "0 bodies".
/// @param many  the noun of any other number than 1; "": `one` with an s
/// @throws std::bad_alloc
std::string counted(std::int64_t n, std::string_view one, std::string_view many = "");

/// Whether all of a text is UTF-8: no stray bytes, no overlong forms, no surrogates.
/// @throws never
bool is_utf8(std::string_view text) noexcept;

/// So many characters of a text from its beginning, or all of it; a byte that is not UTF-8 counts as one.
/// @throws never
std::string_view first_characters(std::string_view text, std::size_t count) noexcept;

/// A text that keeps to its line and leaves a terminal alone: "\n", "\u001b", "\xff" instead of control characters and
/// bytes that are not UTF-8.
/// @throws std::bad_alloc
std::string escaped(std::string_view text);

/// A text to be shown as it is: each control character becomes a blank, each byte that is not UTF-8 becomes U+FFFD.
/// @throws std::bad_alloc
std::string plain_line(std::string_view text);

/// UTF-8: each byte that is not becomes U+FFFD, the replacement character.
/// @throws std::bad_alloc
std::string valid_utf8(std::string_view text);

}  // namespace noether
