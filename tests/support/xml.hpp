#pragma once
/// Reads XML as far as to say whether it is well-formed.

#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace noether::test {

/// One element after the other: names nest, attributes are quoted and stand once, no bare < and &.
class XmlCheck {
 public:
  explicit XmlCheck(std::string_view text) : rest_(text) {}
  /// Whether the text is one element and nothing else.
  bool whole() { return element() && rest_.empty(); }

 private:
  bool take(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }
  void blanks() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_[0])) != 0) rest_.remove_prefix(1);
  }
  std::string name() {
    std::size_t end = 0;
    while (end < rest_.size() && (std::isalnum(static_cast<unsigned char>(rest_[end])) != 0 || rest_[end] == '-'))
      ++end;
    const std::string found(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return found;
  }
  /// Characters up to one of `ends`, references resolved.
  bool text(std::string_view ends) {
    while (!rest_.empty() && ends.find(rest_[0]) == std::string_view::npos) {
      if (rest_[0] == '<') return false;
      if (rest_[0] == '&') {
        if (!take("&amp;") && !take("&lt;") && !take("&gt;") && !take("&quot;")) return false;
      } else {
        rest_.remove_prefix(1);
      }
    }
    return !rest_.empty();
  }
  bool attributes() {
    std::set<std::string> seen;
    for (blanks(); !rest_.empty() && rest_[0] != '>' && rest_[0] != '/'; blanks()) {
      const std::string one = name();
      if (one.empty() || !seen.insert(one).second || !take("=\"") || !text("\"") || !take("\"")) return false;
    }
    return true;
  }
  bool element() {
    std::vector<std::string> open;
    do {
      if (take("</")) {
        if (open.empty() || name() != open.back() || !take(">")) return false;
        open.pop_back();
      } else {
        if (!take("<")) return false;
        const std::string one = name();
        if (one.empty() || !attributes()) return false;
        if (!take("/>")) {
          if (!take(">")) return false;
          open.push_back(one);
        }
      }
      if (!open.empty() && !text("<")) return false;
    } while (!open.empty());
    return true;
  }

  std::string_view rest_;
};

/// Every element of a name in a page, from its first tag to its last; elements of one name do not nest.
inline std::vector<std::string> elements(const std::string& page, const std::string& opening, const std::string& name) {
  std::vector<std::string> found;
  const std::string closing = "</" + name + ">";
  for (std::size_t at = 0; (at = page.find(opening, at)) != std::string::npos;) {
    const std::size_t end = page.find(closing, at);
    if (end == std::string::npos) break;
    found.push_back(page.substr(at, end + closing.size() - at));
    at = end;
  }
  return found;
}

}  // namespace noether::test
