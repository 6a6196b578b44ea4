#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

namespace noether {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table: exchanging neighbors looks two rows back.
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

namespace {

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& letter : lower) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return lower;
}

/// How far apart the numbers are that two words end in, where all before them is the same; else as far as can be.
long number_distance(std::string_view a, std::string_view b) {
  constexpr long far = std::numeric_limits<long>::max();
  const auto number_at = [](std::string_view word) { return word.find_last_not_of("0123456789") + 1; };
  const std::size_t begin = number_at(a);
  const auto number = [&](std::string_view word) {
    return std::strtol(std::string(word.substr(begin)).c_str(), nullptr, 10);
  };
  const bool numbered = begin == number_at(b) && begin < std::min(a.size(), b.size());
  if (!numbered || a.substr(0, begin) != b.substr(0, begin) || std::max(a.size(), b.size()) > begin + 9) return far;
  return std::abs(number(a) - number(b));
}

}  // namespace

std::string squeezed(std::string_view word) {
  std::string text;
  for (const char c : lower_case(word)) {
    if (std::string_view("_-/ .,()").find(c) == std::string_view::npos) text += c;
  }
  if (text.size() > 4 && text.ends_with("ies")) return text.substr(0, text.size() - 3) + 'y';
  if (text.size() > 3 && text.ends_with('s') && !text.ends_with("ss")) text.pop_back();
  return text;
}

/// So many letters of a word are enough where the rest is missing.
constexpr std::size_t least_begun = 5;
/// A word of two letters or more may lack so many at its end: "Mj" for "Mjup".
constexpr std::size_t most_missing = 2;
/// Words of so many letters that differ in two have hardly a letter in common.
constexpr std::size_t short_word = 3;

std::string suggest(std::string_view word, const std::vector<std::string>& known) {
  const std::string lower = lower_case(word);
  const std::size_t near = word.size() <= short_word ? 1 : std::max<std::size_t>(2, word.size() / 3);
  const std::string core = squeezed(word);
  std::string best;
  std::tuple<std::size_t, std::size_t, long> best_distance{near + 1, 0, 0};
  for (const std::string& candidate : known) {
    const bool same = core.size() > 1 && squeezed(candidate) == core;
    const bool enough =
        word.size() >= least_begun || (word.size() > 1 && candidate.size() <= word.size() + most_missing);
    const bool begun = enough && lower_case(candidate).starts_with(lower);
    const std::size_t distance = same ? 0 : begun ? near : edit_distance(lower, lower_case(candidate));
    if (distance > near || distance >= std::max(word.size(), candidate.size())) continue;
    const std::tuple measured{distance, edit_distance(word, candidate), number_distance(lower, lower_case(candidate))};
    if (measured < best_distance) {
      best_distance = measured;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  if (known.empty()) return "";
  const std::string nearest = suggest(word, known);
  if (!nearest.empty()) return fmt::format("; did you mean '{}'?", nearest);
  return fmt::format("; expected one of: {}", fmt::join(known, ", "));
}

}  // namespace noether
