#include "tests/support/json.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace noether::test {
namespace {

/// Reads JSON from the beginning of a text; what is left of it is `rest()`.
class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : rest_(text) {}
  std::string_view rest() const { return rest_; }

  bool value() {
    if (rest_.empty()) return false;
    if (rest_[0] == '{') return items('{', '}', [this] { return string() && take(':') && value(); });
    if (rest_[0] == '[') return items('[', ']', [this] { return value(); });
    return rest_[0] == '"' ? string() : word("null") || word("true") || word("false") || number();
  }

 private:
  bool take(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool word(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }
  bool string() {
    if (!take('"')) return false;
    while (!rest_.empty() && rest_[0] != '"') {
      if (static_cast<unsigned char>(rest_[0]) < ' ') return false;
      rest_.remove_prefix(std::min<std::size_t>(rest_[0] == '\\' ? 2 : 1, rest_.size()));
    }
    return take('"');
  }
  bool digits() {
    const std::size_t before = rest_.size();
    while (!rest_.empty() && std::isdigit(static_cast<unsigned char>(rest_[0])) != 0) rest_.remove_prefix(1);
    return rest_.size() < before;
  }
  bool number() {
    take('-');
    if (!digits() || (take('.') && !digits())) return false;
    if (!take('e')) return true;
    if (!take('-')) take('+');
    return digits();
  }
  template <class Item> bool items(char open, char close, const Item& item) {
    if (!take(open)) return false;
    if (take(close)) return true;
    do {
      if (!item()) return false;
    } while (take(','));
    return take(close);
  }

  std::string_view rest_;
};

}  // namespace

bool is_json_line(const std::string& text) {
  JsonReader reader(text);
  return text.starts_with("{") && reader.value() && reader.rest() == "\n";
}

std::string json_member(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  if (at == std::string::npos) return "";
  const std::string_view from = std::string_view(json).substr(at + key.size() + 3);
  JsonReader reader(from);
  return reader.value() ? std::string(from.substr(0, from.size() - reader.rest().size())) : "";
}

}  // namespace noether::test
