#include "numbers/text.hpp"

#include <fmt/format.h>

#include <sstream>

#include <cstddef>
#include <cstdint>

namespace noether {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

/// One character, or one byte that begins none.
struct Character {
  std::string_view bytes;
  std::uint32_t code = 0;
  bool valid = true;

  /// C0, DEL, C1, and the separators of lines and paragraphs.
  bool controls() const {
    return valid && (code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x2028 || code == 0x2029);
  }
};

Character first_of(std::string_view text) noexcept {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k])); };
  const std::uint32_t head = byte(0);
  if (head < 0x80) return {text.substr(0, 1), head};
  const std::size_t length = head >= 0xF0 ? 4 : head >= 0xE0 ? 3 : 2;
  const Character stray{text.substr(0, 1), head, false};
  if (head < 0xC2 || head > 0xF4 || text.size() < length) return stray;
  std::uint32_t code = head & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80) return stray;
    code = code << 6U | (byte(k) & 0x3FU);
  }
  const bool overlong = code < (length == 4 ? 0x10000U : length == 3 ? 0x800U : 0x80U);
  if (overlong || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return stray;
  return {text.substr(0, length), code};
}

/// Calls `visit(character)` for each character.
template <class Visit> void for_each_character(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const Character one = first_of(text);
    visit(one);
    text.remove_prefix(one.bytes.size());
  }
}

std::string escape_of(const Character& one) {
  if (!one.valid) return fmt::format("\\x{:02x}", one.code);
  if (one.code == '\n') return "\\n";
  if (one.code == '\r') return "\\r";
  return one.code == '\t' ? "\\t" : fmt::format("\\u{:04x}", one.code);
}

}  // namespace

std::string wrong_name(std::string_view name) {
  if (name.empty()) return "the name is empty";
  std::string wrong;
  for_each_character(name, [&](const Character& one) {
    if (!wrong.empty() || (one.valid && !one.controls())) return;
    wrong = one.valid
                ? fmt::format("the name '{}' contains the control character {}; only printable characters are allowed",
                              escaped(name), escape_of(one))
                : fmt::format("the name '{}' contains the byte {}, which is not UTF-8; save the text as UTF-8",
                              escaped(name), escape_of(one));
  });
  return wrong;
}

std::vector<std::string> words_of(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string one; stream >> one;) words.push_back(one);
  return words;
}

std::string counted(std::int64_t n, std::string_view one, std::string_view many) {
  if (n == 1) return fmt::format("1 {}", one);
  return many.empty() ? fmt::format("{} {}s", n, one) : fmt::format("{} {}", n, many);
}

std::string_view first_characters(std::string_view text, std::size_t count) noexcept {
  std::string_view rest = text;
  for (; count > 0 && !rest.empty(); --count) rest.remove_prefix(first_of(rest).bytes.size());
  return text.substr(0, text.size() - rest.size());
}

bool is_utf8(std::string_view text) noexcept {
  bool valid = true;
  for_each_character(text, [&](const Character& one) { valid = valid && one.valid; });
  return valid;
}

std::string escaped(std::string_view text) {
  std::string out;
  for_each_character(text, [&](const Character& one) {
    out += one.valid && !one.controls() ? std::string(one.bytes) : escape_of(one);
  });
  return out;
}

std::string plain_line(std::string_view text) {
  std::string out;
  for_each_character(text, [&](const Character& one) {
    out += !one.valid ? replacement : one.controls() ? std::string_view(" ") : one.bytes;
  });
  return out;
}

std::string valid_utf8(std::string_view text) {
  std::string out;
  for_each_character(text, [&](const Character& one) { out += one.valid ? one.bytes : replacement; });
  return out;
}

}  // namespace noether
