// What Horizons' API answers: JSON with the tables as one text in it, or why there are none.
#include "io/body_readers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <utility>

namespace noether::io {

namespace {

/// The texts among the members of the object that a JSON text is; values of other kinds are passed over.
class JsonTexts {
 public:
  explicit JsonTexts(const TextFile& text) : text_(text) {
    for (const std::string& line : text.lines()) bytes_ += line + '\n';
  }

  struct Member {
    std::size_t line = 0;
    std::string content;
  };

  bool at_end() { return !next_is('\0') && at_ == bytes_.size(); }

  /// The next object.
  std::map<std::string, Member> read() {
    std::map<std::string, Member> members;
    expect('{');
    if (!next_is('}')) {
      do {
        const std::string key = read_text();
        expect(':');
        const std::size_t line = line_;
        if (next_is('"')) {
          members[key] = {line, read_text()};
        } else {
          skip_value();
        }
      } while (take(','));
    }
    expect('}');
    return members;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { text_.fail(line_, "this is not JSON: " + message); }

  char step() {
    if (at_ == bytes_.size()) fail("its end is missing");
    if (bytes_[at_] == '\n' && at_ + 1 < bytes_.size()) ++line_;
    return bytes_[at_++];
  }

  bool next_is(char c) {
    while (at_ < bytes_.size() && std::string_view(" \t\n").find(bytes_[at_]) != std::string_view::npos) step();
    return at_ < bytes_.size() && bytes_[at_] == c;
  }

  bool take(char c) {
    if (!next_is(c)) return false;
    step();
    return true;
  }

  void expect(char c) {
    if (!take(c)) fail(fmt::format("'{}' is expected", c));
  }

  /// Numbers, true, false, null, objects and lists: to the comma or bracket that ends them.
  void skip_value() {
    std::size_t depth = 0;
    while (depth > 0 || !(next_is(',') || next_is('}'))) {
      if (next_is('"')) {
        read_text();
        continue;
      }
      const char c = step();
      if (c == '{' || c == '[') ++depth;
      if (c != '}' && c != ']') continue;
      if (depth == 0) fail(fmt::format("'{}' has no opening bracket", c));
      --depth;
    }
  }

  std::string read_text() {
    expect('"');
    std::string text;
    for (char c = step(); c != '"'; c = step()) {
      if (c == '\\') {
        add_escaped(text);
      } else {
        text += c;
      }
    }
    return text;
  }

  void add_escaped(std::string& text) {
    static constexpr std::string_view names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    const char c = step();
    const std::size_t known = names.find(c);
    if (known != std::string_view::npos) {
      text += meanings[known];
    } else if (c == 'u') {
      add_code_point(text);
    } else {
      fail(fmt::format("'\\{}' is not a valid escape in a text", c));
    }
  }

  std::uint32_t read_code_unit() {
    std::string digits;
    for (int k = 0; k < 4; ++k) digits += step();
    std::uint32_t unit = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), unit, 16);
    if (problem != std::errc() || end != digits.data() + digits.size())
      fail("'\\u' is not followed by four hexadecimal digits");
    return unit;
  }

  void add_code_point(std::string& text) {
    std::uint32_t code = read_code_unit();
    if (code >= 0xD800 && code < 0xDC00) {
      const bool more = step() == '\\' && step() == 'u';
      const std::uint32_t low = more ? read_code_unit() : 0;
      if (low < 0xDC00 || low > 0xDFFF) fail("half of a surrogate pair is missing");
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code < 0xE000) {
      fail("half of a surrogate pair is missing");
    }
    const auto add = [&](std::uint32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (code < 0x80) {
      add(code);
    } else if (code < 0x800) {
      add(0xC0 | code >> 6), add(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      add(0xE0 | code >> 12), add(0x80 | (code >> 6 & 0x3F)), add(0x80 | (code & 0x3F));
    } else {
      add(0xF0 | (code >> 18 & 0x7)), add(0x80 | (code >> 12 & 0x3F)), add(0x80 | (code >> 6 & 0x3F)),
          add(0x80 | (code & 0x3F));
    }
  }

  const TextFile& text_;
  std::string bytes_;
  std::size_t at_ = 0, line_ = 1;
};

/// The first line that says something, and is no rule of stars.
std::string first_words(const TextFile& text) {
  for (const std::string& line : text.lines()) {
    const std::string_view words = trimmed(line);
    if (words.find_first_not_of("* ") == std::string_view::npos) continue;
    if (words.starts_with("API ")) continue;
    return std::string(words.substr(0, 100));
  }
  return "";
}

/// Whether this is an answer of Horizons: it says so in its first lines.
bool is_of_horizons(const TextFile& text) {
  const std::vector<std::string>& lines = text.lines();
  const std::size_t count = std::min<std::size_t>(lines.size(), 10);
  return std::any_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(count), [](const std::string& line) {
    const std::string_view words = trimmed(line);
    return words.starts_with("API SOURCE:") || words.starts_with("Ephemeris /");
  });
}

[[noreturn]] void refuse_answer(const TextFile& text, std::size_t line, const std::string& words) {
  text.fail(line, fmt::format("this answer of Horizons has no table: '$$SOE' is missing; it says '{}'", words));
}

}  // namespace

TextFile horizons_answer(TextFile text) {
  const auto first = std::find_if(text.lines().begin(), text.lines().end(),
                                  [](const std::string& line) { return !trimmed(line).empty(); });
  const char begin = first == text.lines().end() ? ' ' : trimmed(*first).front();
  if (begin == '[') text.fail(1, "this is a list in JSON; expected answers of Horizons, {...}, one after the other");
  if (begin != '{') {
    if (!is_horizons(text) && is_of_horizons(text)) refuse_answer(text, 1, first_words(text));
    return text;
  }
  JsonTexts answers(text);
  std::string content;
  std::size_t line = 0;
  while (!answers.at_end()) {
    const auto members = answers.read();
    const auto result = members.find("result"), error = members.find("error");
    const auto said = result != members.end() ? result : error;
    if (said == members.end()) {
      text.fail(1,
                "this JSON has no \"result\", as answers of Horizons have; expected CSV or a vector table of Horizons");
    }
    const TextFile answer = text.within(said->second.line, said->second.content);
    if (!is_horizons(answer)) refuse_answer(text, said->second.line, first_words(answer));
    if (line == 0) line = said->second.line;
    content += said->second.content + '\n';
  }
  return text.within(line, content);
}

}  // namespace noether::io
