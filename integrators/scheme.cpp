#include "integrators/scheme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <string>

namespace noether {

namespace {

/// Keeps the text of user-made words alive: a Scheme only refers to its name.
std::string_view kept(std::string_view text) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> texts;
  const std::lock_guard<std::mutex> lock(mutex);
  return *texts.emplace(text).first;
}

}  // namespace

Scheme word(std::string_view letters) {
  const bool capitals = std::all_of(letters.begin(), letters.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  if (letters.empty() || letters.size() > Word::capacity || !capitals || letters.find('A') == letters.npos ||
      letters.find('B') == letters.npos) {
    throw SchemeMismatch(
        fmt::format("'{}' is no word: 1 to {} capital letters are expected, A and B among them, such as "
                    "'BAB'",
                    letters, Word::capacity));
  }
  Scheme scheme;
  scheme.name = kept(letters);
  scheme.summary = "a word of equal weights";
  for (const char letter : letters) {
    scheme.word.push_back({letter, Quad(1) / Quad(std::count(letters.begin(), letters.end(), letter))});
  }
  scheme.order = {scheme.is_symmetric() ? 2 : 1};
  if (letters.front() == 'A' && letters.back() == 'A') scheme.exact = "A";  // neighbouring steps join their drifts
  return scheme;
}

}  // namespace noether
