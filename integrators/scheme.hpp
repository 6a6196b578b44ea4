#pragma once
/// Schemes: words in exactly solvable flows, with weights. Numbers only; `Composition` walks them.

#include "numbers/error.hpp"
#include "numbers/real.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace noether {

/// Apply the flow of part `letter` for `weight` steps.
struct Stage {
  char letter = 'A';
  Quad weight = 0;

  constexpr bool operator==(const Stage&) const = default;
};

/// Stages in order of execution, the first one first. Neighbours of one letter are joined as they are added, and
/// stages of weight 0 dropped.
class Word {
 public:
  static constexpr std::size_t capacity = 96;

  constexpr std::size_t size() const { return size_; }
  constexpr const Stage* begin() const { return stages_.data(); }
  constexpr const Stage* end() const { return stages_.data() + size_; }
  constexpr const Stage& operator[](std::size_t k) const { return stages_[k]; }
  constexpr const Stage& front() const { return stages_[0]; }
  constexpr const Stage& back() const { return stages_[size_ - 1]; }

  constexpr void push_back(const Stage& stage) {
    if (stage.weight == Quad(0)) return;
    if (size_ > 0 && stages_[size_ - 1].letter == stage.letter) {
      stages_[size_ - 1].weight += stage.weight;
      if (stages_[size_ - 1].weight == Quad(0)) --size_;
      return;
    }
    if (size_ == capacity) throw LogicError("a word holds at most 96 stages");
    stages_[size_++] = stage;
  }

 private:
  std::array<Stage, capacity> stages_{};
  std::size_t size_ = 0;
};

/// For which splittings a scheme has its order.
enum class SchemeClass : std::uint8_t {
  general,          ///< any splitting into exact flows
  rkn,              ///< {B,{B,{B,A}}} = 0: quadratic kinetic energy, kicks by positions
  near_integrable,  ///< any; the error is small where B is small beside A
};

/// Order of a scheme; for H = A + eps B also (p1, p2, p3): error O(eps h^p1 + eps^2 h^p2 + eps^3 h^p3), 0 for none.
struct Order {
  int classical = 0;
  std::array<int, 3> near_integrable = {0, 0, 0};
  int outside_class = 0;  ///< order for any splitting, where it is less than `classical`; 0 where it is not

  /// Order for any splitting H = A + B.
  constexpr int any_splitting() const { return outside_class != 0 ? outside_class : classical; }
};

/// One splitting method, as data.
struct Scheme {
  static constexpr std::size_t most_substeps = 36;

  std::string_view name;
  std::string_view aliases = "";  ///< other names, parted by blanks
  std::string_view summary = "";
  std::string_view use = "";     ///< what it is best for, in a few words; empty: its family says so
  std::string_view source = "";  ///< key of docs/references.bib
  Order order = {};
  SchemeClass scheme_class = SchemeClass::general;
  bool nested = false;          ///< kicks of several letters stand inside each other (`InnerSteps`)
  std::string_view exact = "";  ///< letters whose maps must be exact flows, unless it is walked as sub-steps
  std::string_view rotor = "";  ///< how bodies must turn; empty: as they like
  /// First h omega on the harmonic oscillator that is unstable; NaN: it does not say.
  double stability_limit = std::numeric_limits<double>::quiet_NaN();
  int printed_digits = 34;  ///< significant digits of the shortest coefficient in the source
  Word word = {};
  Word before = {}, after = {};  ///< once before the run; on copies shown to users
  /// Of a symmetric composition: the lengths of its sub-steps, each a step of the Hamiltonian's basic word; `word` is
  /// what becomes of them over drifts and kicks. Empty for a scheme that is a word of its own.
  std::array<Quad, most_substeps> substeps = {};
  std::size_t substep_count = 0;

  /// Whether it is walked as sub-steps: where it has some, and its word is theirs over drifts and kicks.
  constexpr bool is_composition() const {
    Word theirs;
    for (std::size_t k = 0; k < substep_count; ++k) {
      theirs.push_back({'B', substeps[k] / Quad(2)});
      theirs.push_back({'A', substeps[k]});
      theirs.push_back({'B', substeps[k] / Quad(2)});
    }
    if (theirs.size() == 0 || theirs.size() != word.size()) return false;
    for (std::size_t k = 0; k < word.size(); ++k) {
      if (!(theirs[k] == word[k])) return false;
    }
    return true;
  }
  constexpr bool has_negative_steps() const {
    for (const Stage& stage : word) {
      if (stage.weight < Quad(0)) return true;
    }
    return false;
  }
  /// Whether the word is a palindrome, weights included.
  constexpr bool is_symmetric() const {
    for (std::size_t k = 0; k < word.size(); ++k) {
      if (!(word[k] == word[word.size() - 1 - k])) return false;
    }
    return true;
  }
  /// Kicks (B) per step, the last one joined to the first of the next step.
  constexpr int evaluations() const {
    int kicks = 0;
    for (const Stage& stage : word) kicks += stage.letter == 'B' ? 1 : 0;
    return word.size() > 1 && word.front().letter == 'B' && word.back().letter == 'B' ? kicks - 1 : kicks;
  }
  /// Sum of the weights of one letter.
  constexpr Quad sum(char letter) const {
    Quad total = 0;
    for (const Stage& stage : word) total += stage.letter == letter ? stage.weight : Quad(0);
    return total;
  }
};

/// In a table: the coefficient that the sum rule fixes.
inline constexpr Quad rest = std::numeric_limits<Quad>::quiet_NaN();

/// A list of coefficients, typed as printed.
template <class... Q> constexpr std::array<Quad, sizeof...(Q)> list(Q... q) { return {Quad(q)...}; }

namespace detail {

/// Fills in `rest` so that all weights of a letter sum to 1: the single centre of a palindrome, or the doubled one.
template <std::size_t n> constexpr std::array<Quad, n> solved(std::array<Quad, n> half, bool single_center) {
  Quad others = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const bool center = single_center && k == n - 1;
    if (!isnan(half[k]) && !center) others += half[k];
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (!isnan(half[k])) continue;
    if (k != n - 1) throw LogicError("only the last coefficient of a half can be the rest");
    half[k] = single_center ? Quad(1) - Quad(2) * others : Quad(1) / Quad(2) - others;
  }
  return half;
}

/// What the compiler checks of every table: the weights of each letter sum to 1, to 4 ulp of their absolute sum.
constexpr Scheme checked(const Scheme& scheme) {
  for (const char letter : {'A', 'B'}) {
    Quad sizes = 0;
    for (const Stage& stage : scheme.word) sizes += stage.letter == letter ? abs(stage.weight) : Quad(0);
    if (abs(scheme.sum(letter) - Quad(1)) > Quad(4) * std::numeric_limits<Quad>::epsilon() * sizes) {
      throw LogicError("the weights of a letter do not sum to 1");
    }
  }
  return scheme;
}

}  // namespace detail

/// A symmetric composition of steps of order 2: weights w_1, ..., w_m of its steps, of which the first half with the
/// centre is given. Over drifts and kicks each is a step of velocity Verlet, kick first, and the kicks of neighbouring
/// steps are joined.
template <std::size_t n> constexpr Scheme symmetric_composition(Scheme scheme, const std::array<Quad, n>& half) {
  static_assert(2 * n - 1 <= Scheme::most_substeps);
  if (n > 1) scheme.exact = "B";  // as a word of its own; over sub-steps nothing is joined that is not exact
  const auto weights = detail::solved(half, true);
  for (std::size_t k = 0; k < 2 * n - 1; ++k) {
    const Quad w = weights[k < n ? k : 2 * n - 2 - k];
    scheme.substeps[scheme.substep_count++] = w;
    scheme.word.push_back({'B', w / Quad(2)});
    scheme.word.push_back({'A', w});
    scheme.word.push_back({'B', w / Quad(2)});
  }
  return detail::checked(scheme);
}

/// A palindrome that begins and ends with `outer`: outer_1, inner_1, outer_2, ...; both halves with their centres.
template <std::size_t n, std::size_t m>
constexpr Scheme palindrome(Scheme scheme, char outer, const std::array<Quad, n>& outer_half,
                            const std::array<Quad, m>& inner_half) {
  static_assert(n == m || n == m + 1, "letters alternate: one of them has a single centre");
  const auto o = detail::solved(outer_half, n == m + 1);
  const auto i = detail::solved(inner_half, n == m);
  const char inner = outer == 'A' ? 'B' : 'A';
  const std::size_t outers = n == m ? 2 * n : 2 * n - 1;
  for (std::size_t k = 0; k < outers; ++k) {
    scheme.word.push_back({outer, o[k < n ? k : outers - 1 - k]});
    if (k + 1 < outers) scheme.word.push_back({inner, i[k < m ? k : outers - 2 - k]});
  }
  return detail::checked(scheme);
}

/// first_1, second_1, first_2, ...: no symmetry. The last entry of a list may be `rest`: 1 minus the others.
template <std::size_t n>
constexpr Scheme alternating(Scheme scheme, char first, const std::array<Quad, n>& first_weights,
                             const std::array<Quad, n>& second_weights) {
  Quad first_rest = 1, second_rest = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Quad one = isnan(first_weights[k]) ? first_rest : first_weights[k];
    const Quad other = isnan(second_weights[k]) ? second_rest : second_weights[k];
    scheme.word.push_back({first, one});
    scheme.word.push_back({first == 'A' ? 'B' : 'A', other});
    first_rest -= one;
    second_rest -= other;
  }
  return detail::checked(scheme);
}

/// Any word of letters: "BAOAB". Each letter's weights are equal and sum to 1; neighbours of one letter are joined.
/// @throws SchemeMismatch  unless the text is one to 96 capital letters, A and B among them
Scheme word(std::string_view letters);

namespace detail {
/// The weights of a word in double: see `rounded_weights`.
std::vector<double> rounded_to_double(std::span<const Stage> word);

/// A number type that knows no more digits than double takes the weights that double has.
template <class Real>
inline constexpr bool counts_in_doubles = std::is_same_v<Real, double> || !std::is_constructible_v<Real, Quad>;

template <class Real> Real weight_in(const Quad& weight) {
  if constexpr (counts_in_doubles<Real>) {
    return Real(static_cast<double>(weight));
  } else {
    return static_cast<Real>(weight);
  }
}
}  // namespace detail

/// The weights of a word in the working type: Quad as they are, dual numbers and packs over doubles as double has them.
///
/// In double each weight is rounded, and then the middle one (or pair) of each letter is solved again, so that the
/// exact sum of the rounded weights is that of the word to an ulp of the middle: a sum off by 1e-16 would be a
/// clock that is wrong by as much.
template <class Real> std::vector<Real> rounded_weights(std::span<const Stage> word) {
  std::vector<Real> weights;
  if constexpr (detail::counts_in_doubles<Real>) {
    for (const double weight : detail::rounded_to_double(word)) weights.push_back(Real(weight));
  } else {
    for (const Stage& stage : word) weights.push_back(static_cast<Real>(stage.weight));
  }
  return weights;
}
template <class Real> std::vector<Real> rounded_weights(const Word& word) {
  return rounded_weights<Real>(std::span<const Stage>(word.begin(), word.end()));
}

}  // namespace noether
