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
        fmt::format("'{}' is not a valid word: 1 to {} capital letters are expected, A and B among them, such as "
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

std::vector<double> detail::rounded_to_double(std::span<const Stage> word) {
  std::vector<double> weights;
  std::set<char> letters;
  for (const Stage& stage : word) weights.push_back(static_cast<double>(stage.weight));
  for (const Stage& one : word) {
    if (!letters.insert(one.letter).second) continue;
    std::vector<std::size_t> places;
    Quad total = 0;
    for (std::size_t k = 0; k < word.size(); ++k) {
      if (word[k].letter != one.letter) continue;
      places.push_back(k);
      total += word[k].weight;
    }
    const std::size_t n = places.size(), middle = n / 2;
    Quad others = 0;
    const bool pair = n % 2 == 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (k != middle && !(pair && k + 1 == middle)) others += Quad(weights[places[k]]);
    }
    const Quad left = total - others;
    weights[places[middle]] = static_cast<double>(pair ? left / Quad(2) : left);
    if (pair && word[places[middle - 1]].weight == word[places[middle]].weight) {
      weights[places[middle - 1]] = weights[places[middle]];
    } else if (pair) {
      weights[places[middle - 1]] = static_cast<double>(word[places[middle - 1]].weight);
      weights[places[middle]] = static_cast<double>(left - Quad(weights[places[middle - 1]]));
    }
  }
  return weights;
}

}  // namespace noether
