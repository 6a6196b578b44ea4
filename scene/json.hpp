#pragma once
/// JSON on one line: what reports are written in.

#include "numbers/quantity.hpp"
#include "numbers/text.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// A JSON value, written as soon as it is made.
///
/// Numbers are the shortest decimals that read back to the same double; what is not finite is null.
class Json {
 public:
  using Members = std::vector<std::pair<std::string_view, Json>>;

  Json() : text_("null") {}
  Json(double x) : text_(std::isfinite(x) ? format_number(x) : "null") {}
  Json(std::int64_t x) : text_(std::to_string(x)) {}
  Json(int x) : Json(std::int64_t{x}) {}
  Json(bool x) : text_(x ? "true" : "false") {}
  Json(std::string_view x) : text_(quoted(x)) {}
  Json(const std::string& x) : Json(std::string_view(x)) {}
  Json(const char* x) : Json(std::string_view(x)) {}
  template <class T> Json(const std::optional<T>& x) : text_(x ? Json(*x).text_ : "null") {}

  static Json list(const std::vector<Json>& values) {
    std::string inside;
    for (const Json& value : values) inside.append(inside.empty() ? "" : ",").append(value.text_);
    return raw(enclosed('[', inside, ']'));
  }
  template <class T> static Json list_of(const T& values) {
    std::vector<Json> all;
    for (const auto& value : values) all.emplace_back(value);
    return list(all);
  }
  /// Members in the order given.
  static Json object(const Members& members) {
    std::string inside;
    for (const auto& [key, value] : members) {
      inside.append(inside.empty() ? "" : ",").append(quoted(key)).append(":").append(value.text_);
    }
    return raw(enclosed('{', inside, '}'));
  }

  const std::string& text() const { return text_; }

 private:
  static Json raw(std::string text) {
    Json value;
    value.text_ = std::move(text);
    return value;
  }
  static std::string enclosed(char open, const std::string& inside, char close) {
    std::string text(1, open);
    return text.append(inside).append(1, close);
  }
  /// A string of JSON is UTF-8: U+FFFD stands for each byte that is not.
  static std::string quoted(std::string_view x) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : valid_utf8(x)) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') {
        out += {'\\', c};
      } else if (byte < 0x20) {
        out += {'\\', 'u', '0', '0', digits[byte >> 4U], digits[byte & 15U]};
      } else {
        out += c;
      }
    }
    return out.append("\"");
  }

  std::string text_;
};

}  // namespace noether
