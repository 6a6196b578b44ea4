#include "scene/toml.hpp"

#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

// toml++ 3 ends in undefined behavior, or in an assertion, on some texts that are no TOML: `[.`, `a = [}`, letters
// beyond ASCII outside quotes. Its assertions are taken out, and its tables of Unicode answer no where they hold a
// character impossible; the parser then refuses the character as it does any other.
#define TOML_ASSERT(expr) static_assert(true)
#if __has_include(<toml++/toml.hpp>)
#define NOETHER_TOML_PART(name) <toml++/impl/name.hpp>
#else
#define NOETHER_TOML_PART(name) <toml++/impl/name.h>
#endif
#include NOETHER_TOML_PART(preprocessor)
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT_ASSUME(...) static_assert(true)
#undef TOML_UNREACHABLE
#define TOML_UNREACHABLE return false
#include NOETHER_TOML_PART(forward_declarations)
#include NOETHER_TOML_PART(unicode)
#undef TOML_UNREACHABLE
#define TOML_UNREACHABLE __builtin_unreachable()
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace noether {

namespace {

SceneValue converted(const toml::node& node, int line, const std::string& file);

SceneValue converted_table(const toml::table& table, int line, const std::string& file) {
  SceneValue result = SceneValue::table(line);
  auto& entries = std::get<SceneValue::Table>(result.data);
  for (const auto& [key, node] : table) {
    const int at = static_cast<int>(key.source().begin.line);
    entries.emplace_back(std::string(key.str()), converted(node, at == 0 ? line : at, file));
  }
  // The parser sorts by name; readers of messages expect the order of the file.
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.second.line < b.second.line; });
  return result;
}

SceneValue converted(const toml::node& node, int line, const std::string& file) {
  if (const auto* table = node.as_table()) return converted_table(*table, line, file);
  if (const auto* array = node.as_array()) {
    SceneValue::Array list;
    for (const toml::node& element : *array) {
      const int at = static_cast<int>(element.source().begin.line);
      list.push_back(converted(element, at == 0 ? line : at, file));
    }
    return SceneValue::of(std::move(list), line);
  }
  if (const auto* text = node.as_string()) return SceneValue::of(text->get(), line);
  if (const auto* integer = node.as_integer()) return SceneValue::of(std::int64_t{integer->get()}, line);
  if (const auto* number = node.as_floating_point()) return SceneValue::of(number->get(), line);
  if (const auto* flag = node.as_boolean()) return SceneValue::of(flag->get(), line);
  throw SceneError("dates and times of day are not supported in a scene; write a time as text, such as \"100 day\"",
                   {.file = file, .line = line});
}

/// Walks over the text of a document and counts how deep tables and lists stand in one another, without recursion:
/// dots of keys count like brackets. Strings and comments are skipped.
class DepthScan {
 public:
  explicit DepthScan(std::string_view text) : text_(text) {}

  /// The first line that is too deep; 0 if there is none.
  int too_deep() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else {
        count(c);
      }
      if (above_ + dots_ + static_cast<int>(open_.size()) > deepest_table) return line_;
    }
    return 0;
  }

 private:
  void count(char c) {
    if (c == '\n') ++line_;
    if (c == '.') ++dots_;
    if (c == '\n' || c == ',') dots_ = 0;
    if (c == '[' || c == '{') {
      open_.push_back(dots_);
      above_ += dots_;
      dots_ = 0;
    }
    if ((c == ']' || c == '}') && !open_.empty()) {
      above_ -= open_.back();
      dots_ = open_.back();
      open_.pop_back();
    }
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool long_one = text_.substr(at_, 3) == three;
    at_ += long_one ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c == '\n' && !long_one) return;  // the parser will say that it does not end
      if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == quote && (!long_one || text_.substr(at_, 3) == three)) {
        if (long_one) at_ += 2;
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, dots_ = 0, above_ = 0;
  std::vector<int> open_;  ///< for each open bracket, the dots of the key before it
};

/// "Error while parsing key-value pair: expected a comment ..." without the part that says nothing.
std::string plain(std::string_view description) {
  constexpr std::string_view lead = "Error while parsing ";
  std::string text(description);
  if (description.substr(0, lead.size()) == lead) {
    const std::size_t colon = text.find(": ");
    if (colon != std::string::npos) {
      const std::string where = text.substr(lead.size(), colon - lead.size());
      text = text.substr(colon + 2) + " (in a " + where + ")";
    }
  }
  std::string line;
  for (const char c : text) line += c == '\n' || c == '\r' ? ' ' : c;
  if (!line.empty()) line[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(line[0])));
  return line;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

bool is_bare(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || c == '_' || c == '-';
  });
}

std::string key_text(std::string_view key) { return is_bare(key) ? std::string(key) : in_quotes(key); }

void relabel(SceneValue& value, int line) {
  value.line = line;
  if (auto* list = value.get<SceneValue::Array>()) {
    for (SceneValue& element : *list) relabel(element, line);
  } else if (auto* table = value.get<SceneValue::Table>()) {
    for (auto& [key, entry] : *table) relabel(entry, line);
  }
}

/// A double that reads back as a double: "100" would become an integer.
std::string number_text(double x) {
  const std::string text = format_number(x);
  const bool shows = text.find_first_of(".en") != std::string::npos;
  return shows ? text : text + ".0";
}

void print_table(std::string& out, const SceneValue& table, const std::string& path) {
  const auto& entries = std::get<SceneValue::Table>(table.data);
  for (const auto& [key, value] : entries) {
    if (value.is_table() || value.is_table_list()) continue;
    out += fmt::format("{} = {}\n", key_text(key), to_text(value));
  }
  for (const auto& [key, value] : entries) {
    const std::string name = path.empty() ? key_text(key) : path + "." + key_text(key);
    if (value.is_table()) {
      out += fmt::format("\n[{}]\n", name);
      print_table(out, value, name);
    } else if (value.is_table_list()) {
      for (const SceneValue& element : std::get<SceneValue::Array>(value.data)) {
        out += fmt::format("\n[[{}]]\n", name);
        print_table(out, element, name);
      }
    }
  }
}

}  // namespace

SceneValue parse_toml(std::string_view text, const std::string& file) {
  if (const int line = DepthScan(text).too_deep(); line > 0) {
    throw SceneError(
        fmt::format("tables and lists are nested more than {} levels deep; a scene needs far fewer", deepest_table),
        {.file = file, .line = line});
  }
  try {
    return converted_table(toml::parse(text), 1, file);
  } catch (const toml::parse_error& error) {
    if (text.starts_with("\x89HDF")) {
      throw SceneError(
          fmt::format("this is an HDF5 file, and a scene is expected; `noether info {}` tells what is in it", file),
          {.file = file});
    }
    throw SceneError("this is not TOML: " + plain(error.description()),
                     {.file = file, .line = static_cast<int>(error.source().begin.line)});
  }
}

std::optional<SceneValue> parse_toml_value(std::string_view text, int line) {
  if (DepthScan(text).too_deep() > 0) return {};
  try {
    const toml::table document = toml::parse("value = " + std::string(text));
    const toml::node* node = document.get("value");
    if (node == nullptr || document.size() != 1) return {};
    const std::string none;
    SceneValue value = converted(*node, line, none);
    relabel(value, line);
    return value;
  } catch (const toml::parse_error&) {
    return {};
  } catch (const SceneError&) {  // a date
    return {};
  }
}

std::string print_toml(const SceneValue& table) {
  std::string out;
  print_table(out, table, "");
  return out;
}

std::string_view kind_of(const SceneValue& value) {
  constexpr std::string_view words[] = {"a flag", "a whole number", "a number", "a text", "a list", "a table"};
  return words[value.data.index()];
}

std::string to_text(const SceneValue& value) {
  if (const bool* flag = value.get<bool>()) return *flag ? "true" : "false";
  if (const auto* integer = value.get<std::int64_t>()) return fmt::format("{}", *integer);
  if (const double* number = value.get<double>()) return number_text(*number);
  if (const std::string* text = value.get<std::string>()) return in_quotes(*text);
  std::string out;
  if (const auto* list = value.get<SceneValue::Array>()) {
    for (const SceneValue& element : *list) out += (out.empty() ? "" : ", ") + to_text(element);
    return "[" + out + "]";
  }
  for (const auto& [key, entry] : std::get<SceneValue::Table>(value.data)) {
    out += (out.empty() ? "" : ", ") + key_text(key) + " = " + to_text(entry);
  }
  return "{" + out + "}";
}

}  // namespace noether
