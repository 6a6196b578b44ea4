#include "integrators/composition.hpp"

#include "engine/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

bool uses(const Word& word, char letter) {
  return std::any_of(word.begin(), word.end(), [&](const Stage& stage) { return stage.letter == letter; });
}

void check_letters(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  for (const Word* word : {&scheme.word, &scheme.before, &scheme.after}) {
    for (const Stage& stage : *word) {
      if (claims.alphabet.find(stage.letter) != std::string_view::npos) continue;
      throw SchemeMismatch(fmt::format("scheme '{}' uses the letter {}, but '{}' has only {}", scheme.name,
                                       stage.letter, hamiltonian, claims.alphabet));
    }
  }
}

void check_class(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  for (const char letter : scheme.exact) {
    if (claims.inexact.find(letter) == std::string_view::npos) continue;
    const bool constrained = letter == 'A' && claims.constraints > 0;
    throw SchemeMismatch(fmt::format(
        "scheme '{}' needs exact flows, but part {} of '{}'{} is a symmetric map of order 2; use 'verlet', or {}",
        scheme.name, letter, hamiltonian, constrained ? " with constraints" : "",
        constrained ? "a composition of its whole steps such as 'yoshida_4' or 'kahan_li_6_s9'"
                    : "a scheme made for it such as 'abah_8_6_4' or 'abah_10_6_4'"));
  }
  if (scheme.scheme_class == SchemeClass::rkn && !claims.quadratic_kinetic) {
    throw SchemeMismatch(
        fmt::format("scheme '{}' is a Runge-Kutta-Nystroem splitting and keeps its order only where "
                    "{{B,{{B,{{B,A}}}}}} = 0, which '{}' does not grant; use a general scheme such as "
                    "'blanes_moan_s10'",
                    scheme.name, hamiltonian));
  }
}

/// Half a D at both ends; between the two stages of a symplectic Euler, one D.
Word with_letter(const Word& word, char letter) {
  Word result;
  if (word.size() == 2) {
    result.push_back(word[0]);
    result.push_back({letter, Quad(1)});
    result.push_back(word[1]);
    return result;
  }
  result.push_back({letter, Quad(1) / Quad(2)});
  for (const Stage& stage : word) result.push_back(stage);
  result.push_back({letter, Quad(1) / Quad(2)});
  return result;
}

}  // namespace

Word fitted_word(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  check_letters(scheme, claims, hamiltonian);
  check_class(scheme, claims, hamiltonian);
  Word word = scheme.word;
  for (const char letter : claims.irreversible) {
    if (scheme.has_negative_steps()) {
      throw SchemeMismatch(
          fmt::format("scheme '{}' steps backwards, but part {} of '{}' is irreversible; use a scheme with "
                      "forward steps only, such as 'verlet' or 'mclachlan_2_s2'",
                      scheme.name, letter, hamiltonian));
    }
    if (!uses(word, letter)) word = with_letter(word, letter);
  }
  return word;
}

template class Composition<AnyHamiltonian<double>>;
template class Composition<AnyHamiltonian<Quad>>;
template struct detail::IntegratorModel<Composition<AnyHamiltonian<double>>>;
template struct detail::IntegratorModel<Composition<AnyHamiltonian<Quad>>>;

}  // namespace noether
