#pragma once
/// The word test: what a scheme is, in the free associative algebra on {A, B}, word by word.

#include "integrators/scheme.hpp"
#include "numbers/error.hpp"
#include "numbers/real.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string>
#include <vector>

namespace noether::test {

/// A truncated series in words over {A, B}; a word is its bits (A 0, B 1) behind a leading 1, first letter first.
class WordSeries {
 public:
  /// The series 1, to words of `degree` letters.
  explicit WordSeries(int degree) : degree_(degree), coefficients_(std::size_t{1} << (degree + 1)) {
    coefficients_[1] = 1;
  }

  int degree() const { return degree_; }
  Quad operator[](std::size_t word) const { return coefficients_[word]; }

  /// Multiplies from the right by exp(w X), X a letter.
  ///     new[u] = sum_k old[u without its last k letters, all of them X] w^k / k!
  /// @cost about two products a word
  void multiply_exponential(char letter, Quad w) {
    const std::size_t bit = letter == 'B' ? 1 : 0;
    for (std::size_t word = coefficients_.size() - 1; word > 1; --word) {  // longest first: prefixes are still old
      Quad factor = 1;
      std::size_t prefix = word;
      for (int k = 1; prefix > 1 && (prefix & 1U) == bit; ++k) {
        prefix >>= 1;
        factor *= w / Quad(k);
        coefficients_[word] += coefficients_[prefix] * factor;
      }
    }
  }

 private:
  int degree_;
  std::vector<Quad> coefficients_;
};

inline int length_of(std::size_t word) { return static_cast<int>(std::bit_width(word)) - 1; }
inline int kicks_of(std::size_t word) { return std::popcount(word) - 1; }

/// The product of exp(w X) over the stages of a word in A and B, the first stage leftmost.
inline WordSeries series_of(const Word& word, int degree) {
  WordSeries series(degree);
  for (const Stage& stage : word) {
    if (stage.letter != 'A' && stage.letter != 'B') throw LogicError("the word test knows the letters A and B");
    series.multiply_exponential(stage.letter, stage.weight);
  }
  return series;
}

/// Words with `kicks_min` to `kicks_max` letters B.
struct WordKind {
  int kicks_min = 0, kicks_max = 1000;
};

/// Worst deviation from exp(A + B), where a word of n letters has 1/n!, over the words of `first` to `last` letters.
inline Quad word_error(const WordSeries& series, int first, int last, WordKind kind = {}) {
  std::vector<Quad> exact(1, Quad(1));
  for (int n = 1; n <= last; ++n) exact.push_back(exact.back() / Quad(n));
  Quad worst = 0;
  for (std::size_t word = std::size_t{1} << first; word < std::size_t{2} << last; ++word) {
    if (kicks_of(word) < kind.kicks_min || kicks_of(word) > kind.kicks_max) continue;
    worst = std::max(worst, abs(series[word] - exact[static_cast<std::size_t>(length_of(word))]));
  }
  return worst;
}

/// One claim of a scheme: words of a kind are right up to `degree` letters, and wrong with one more.
struct WordClaim {
  WordKind kind;
  int degree;
};

/// What the order of a scheme says about words: (p1, p2, p3) by the number of kicks, else all words alike.
inline std::vector<WordClaim> claims_of_order(const Order& order) {
  const auto [p1, p2, p3] = order.near_integrable;
  if (p1 == 0) return {{{}, order.classical}};
  if (p3 == 0) return {{{1, 1}, p1}, {{2, 1000}, p2}};
  return {{{1, 1}, p1}, {{2, 2}, p2}, {{3, 1000}, p3}};
}

inline Quad sum_of_magnitudes(const Word& word) {
  Quad sum = 0;
  for (const Stage& stage : word) sum += abs(stage.weight);
  return sum;
}

/// What digits printed to 15 or 16 places leave of an order condition; 1e-12 for longer tables.
inline Quad word_tolerance(const Scheme& scheme) {
  return scheme.printed_digits <= 16 ? Quad(1e-13) * sum_of_magnitudes(scheme.word) : Quad(1e-12);
}

/// The largest n for which all words of up to n letters are right within a tolerance.
inline int word_order(const Word& word, int degree, Quad tolerance = Quad(1e-12)) {
  const WordSeries series = series_of(word, degree);
  int order = 0;
  while (order < degree && word_error(series, order + 1, order + 1) < tolerance) ++order;
  return order;
}

}  // namespace noether::test
