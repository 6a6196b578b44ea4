#include "engine/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace

std::string suggest(std::string_view word, const std::vector<std::string>& known) {
  const std::string lower = lower_case(word);
  const std::size_t near = std::max<std::size_t>(2, word.size() / 3);
  std::string best;
  std::pair<std::size_t, std::size_t> best_distance{near + 1, 0};
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(lower, lower_case(candidate));
    if (distance > near || distance >= std::max(word.size(), candidate.size())) continue;
    const std::pair measured{distance, edit_distance(word, candidate)};
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
  return fmt::format("; known are: {}", fmt::join(known, ", "));
}

}  // namespace noether
