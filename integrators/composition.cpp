#include "integrators/composition.hpp"

#include "numbers/error.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

namespace {

bool uses(const std::vector<Stage>& word, char letter) {
  return std::any_of(word.begin(), word.end(), [&](const Stage& stage) { return stage.letter == letter; });
}

bool has(std::string_view letters, char letter) { return letters.find(letter) != std::string_view::npos; }

/// @throws SchemeMismatch  why a Hamiltonian lacks the kick of a kernel
[[noreturn]] void refuse_kernel(char letter, const Scheme& scheme, const HamiltonianClaims& claims,
                                const std::string& hamiltonian) {
  const bool of_saba = scheme.word.front().letter == 'G';  // for which there is no other kernel
  const char* remedy = of_saba                                      ? "take it out"
                       : letter == 'G' && has(claims.alphabet, 'L') ? "use kernel = \"lazy\" or \"composed\""
                                                                    : "use kernel = \"composed\"";
  throw SchemeMismatch(fmt::format("kernel = \"{}\" is not for this '{}', {}; {}", letter == 'G' ? "modified" : "lazy",
                                   hamiltonian, claims.no_kernel, remedy),
                       {.key = "kernel"});
}

/// Sum of the weights of some letters.
Quad weight_of(const std::vector<Stage>& word, std::string_view letters) {
  Quad sum = 0;
  for (const Stage& stage : word) sum += has(letters, stage.letter) ? stage.weight : Quad(0);
  return sum;
}

/// The letter L is a kick in the place of B, and letters that elsewhere belong to kernels may be kicks of forces: their
/// weights, which no table has checked, must be those of one step.
void check_kicks(const Scheme& scheme, const std::vector<Stage>& word, const HamiltonianClaims& claims,
                 const std::string& hamiltonian) {
  const auto check = [&](std::string_view letters, const char* why) {
    const auto steps = static_cast<double>(weight_of(word, letters));
    if (std::abs(steps - 1) < 1e-9) return;
    throw SchemeMismatch(
        fmt::format("the kicks {} of scheme '{}' over '{}' are {:.6g} steps long in all, where 1 is "
                    "expected{}",
                    fmt::join(letters, " and "), scheme.name, hamiltonian, steps, why));
  };
  for (const char letter : {'G', 'L'}) {
    if (!uses(word, letter)) continue;
    if (has(claims.lazy, letter)) {
      check(std::string({'B', letter}), ": L is a kick in the place of B; use kernel = \"lazy\"");
    } else if (has(claims.kicks, letter)) {
      check(std::string(1, letter), "");
    }
  }
}

/// Correctors and kernels take away errors that are small because B is small beside A.
void check_kepler(const CompositionOptions& options, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  if (!options.changes_scheme() || claims.kepler) return;
  throw SchemeMismatch(fmt::format("{} is for kicks between Kepler arcs, but '{}' has none; use the Hamiltonian "
                                   "'wisdom_holman', or take it out",
                                   options.processing_text(), hamiltonian),
                       {.key = options.corrector != 0 ? "corrector" : "kernel"});
}

void check_letters(const Scheme& scheme, const std::vector<Stage>& stages, const HamiltonianClaims& claims,
                   const std::string& hamiltonian, const CompositionOptions& options) {
  const auto check = [&](const Stage& stage) {
    if (has(claims.alphabet, stage.letter)) return;
    if (options.kernel != StepKernel::plain && !claims.no_kernel.empty() &&
        (stage.letter == 'G' || stage.letter == 'L'))
      refuse_kernel(stage.letter, scheme, claims, hamiltonian);
    throw SchemeMismatch(fmt::format("scheme '{}' uses the letter {}, but '{}' has only {}", scheme.name, stage.letter,
                                     hamiltonian, claims.alphabet));
  };
  std::for_each(stages.begin(), stages.end(), check);
  std::for_each(scheme.before.begin(), scheme.before.end(), check);
  std::for_each(scheme.after.begin(), scheme.after.end(), check);
  for (const char letter : claims.basic) {
    if (uses(stages, letter)) continue;
    if (letter == 'B' && has(claims.lazy, 'L') && uses(stages, 'L')) continue;  // a kick too
    throw SchemeMismatch(
        fmt::format("scheme '{}' has no letter {}, which is a part of '{}'; use a composition of its steps {}, such as "
                    "'yoshida_4', or a word with all of its letters",
                    scheme.name, letter, hamiltonian, claims.basic));
  }
}

void check_class(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  for (const char letter : scheme.is_composition() ? std::string_view() : scheme.exact) {
    if (claims.inexact.find(letter) == std::string_view::npos) continue;
    const bool constrained = letter == 'A' && claims.constraints > 0;
    throw SchemeMismatch(fmt::format(
        "scheme '{}' needs exact flows, but part {} of '{}'{} is a symmetric map of order 2; use 'verlet', {}",
        scheme.name, letter, hamiltonian, constrained ? " with constraints" : "",
        constrained ? "or a composition of its whole steps such as 'yoshida_4' or 'kahan_li_6_s9'"
                    : "a composition of its steps such as 'yoshida_4', or a scheme made for it such as "
                      "'abah_8_6_4'"));
  }
  const bool loses = scheme.order.any_splitting() < scheme.order.classical;
  if (scheme.scheme_class == SchemeClass::rkn && !claims.quadratic_kinetic && loses) {
    throw SchemeMismatch(fmt::format(
        "scheme '{}' is a Runge-Kutta-Nystroem splitting and keeps its order only where {{B,{{B,{{B,A}}}}}} = 0, which "
        "'{}' does not guarantee; use a general scheme such as 'blanes_moan_s10'",
        scheme.name, hamiltonian));
  }
}

/// Appends a stage; one of the letter before it is joined with that, if it may be.
void append(std::vector<Stage>& word, const Stage& stage, bool joined) {
  if (joined && !word.empty() && word.back().letter == stage.letter) {
    word.back().weight += stage.weight;
  } else {
    word.push_back(stage);
  }
}

/// A composition over the basic word of a Hamiltonian, which is a palindrome: of each letter the weights are equal.
std::vector<Stage> composed(const Scheme& scheme, std::string_view basic, bool joined) {
  std::map<char, int> times;
  for (const char letter : basic) ++times[letter];
  std::vector<Stage> word;
  for (std::size_t k = 0; k < scheme.substep_count; ++k) {
    for (const char letter : basic) append(word, {letter, scheme.substeps[k] / Quad(times.at(letter))}, joined);
  }
  return word;
}

/// The basic word of multiple time steps: within each step of slower kicks so many of faster ones, and at its ends half
/// a kick.
/// @throws SchemeMismatch  for other levels than there are letters of kicks, or kicks that do not stand at the ends
std::string nested_word(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian,
                        const InnerSteps& steps) {
  const std::string& kicks = claims.kicks;
  if (steps.size() + 1 != kicks.size()) {
    const bool single = kicks.size() == 1;
    throw SchemeMismatch(
        fmt::format("method '{}' has inner_steps = {}, but the forces of '{}' are in the {} {}; {}", scheme.name,
                    steps.text(), hamiltonian, single ? "kick" : "kicks", fmt::join(kicks, ", "),
                    single ? "give kick = \"C\" in the table of a slow force, or take inner_steps out"
                           : fmt::format("give {}: {}", counted(static_cast<std::int64_t>(kicks.size()) - 1, "number"),
                                         kicks.size() == 2 ? "the steps of B in one of C"
                                                           : "the steps of each kick in one of the next")),
        {.key = "inner_steps", .value = steps.text()});
  }
  std::string word = claims.basic;
  for (std::size_t k = kicks.size() - 1; k > 0; --k) {
    if (word.size() < 3 || word.front() != kicks[k] || word.back() != kicks[k]) {
      throw SchemeMismatch(fmt::format(
          "method '{}' needs slow kicks at both ends of a step, but those of '{}' are the steps {}; use 'verlet'",
          scheme.name, hamiltonian, claims.basic));
    }
    word = word.substr(1, word.size() - 2);
  }
  for (std::size_t k = 1; k < kicks.size(); ++k) {
    const std::string inner = std::exchange(word, std::string(1, kicks[k]));
    for (int n = 0; n < steps.begin()[k - 1]; ++n) word += inner;
    word += kicks[k];
  }
  return word;
}

/// Half a D at both ends; between the two stages of a symplectic Euler, one D.
std::vector<Stage> with_outer(const std::vector<Stage>& word, char letter) {
  if (word.size() == 2) return {word[0], {letter, Quad(1)}, word[1]};
  std::vector<Stage> result = {{letter, Quad(1) / Quad(2)}};
  result.insert(result.end(), word.begin(), word.end());
  result.push_back({letter, Quad(1) / Quad(2)});
  return result;
}

/// The claim that compositions stand on. @throws LogicError
void check_basic(const HamiltonianClaims& claims, const std::string& hamiltonian) {
  const std::string& basic = claims.basic;
  if (!basic.empty() && std::equal(basic.begin(), basic.end(), basic.rbegin()) &&
      basic.find_first_not_of(claims.alphabet) == std::string::npos) {
    return;
  }
  throw LogicError(fmt::format("the basic word '{}' of '{}' is not a palindrome of its letters {}", basic, hamiltonian,
                               claims.alphabet));
}

/// Where nothing turns every scheme may walk.
void check_rotor(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian) {
  if (!claims.turns || scheme.rotor.empty() || scheme.rotor == claims.rotor) return;
  throw SchemeMismatch(
      fmt::format("scheme '{}' turns bodies by the rotor '{}', but '{}' has '{}'; use 'verlet' with it", scheme.name,
                  scheme.rotor, hamiltonian, claims.rotor));
}

}  // namespace

FittedWord fitted_word(const Scheme& scheme, const HamiltonianClaims& claims, const std::string& hamiltonian,
                       const CompositionOptions& options) {
  check_kepler(options, claims, hamiltonian);
  check_basic(claims, hamiltonian);
  check_rotor(scheme, claims, hamiltonian);
  FittedWord word{{scheme.word.begin(), scheme.word.end()}};
  if (!options.inner_steps.empty() && !scheme.nested) {
    throw SchemeMismatch(fmt::format("inner_steps = {} is for method 'respa', not for '{}'; take it out",
                                     options.inner_steps.text(), scheme.name),
                         {.key = "inner_steps", .value = options.inner_steps.text()});
  }
  if (scheme.is_composition()) {
    const std::string basic =
        scheme.nested ? nested_word(scheme, claims, hamiltonian, options.inner_steps) : claims.basic;
    const bool exact = claims.inexact.find(claims.basic.front()) == std::string_view::npos;
    word.stages = composed(scheme, basic, exact);
    word.joins = exact || scheme.substep_count == 1;
  }
  check_letters(scheme, word.stages, claims, hamiltonian, options);
  check_kicks(scheme, word.stages, claims, hamiltonian);
  check_class(scheme, claims, hamiltonian);
  for (const char letter : claims.irreversible) {
    if (scheme.has_negative_steps()) {
      throw SchemeMismatch(
          fmt::format("scheme '{}' steps backwards, but part {} of '{}' is irreversible; use a scheme with "
                      "forward steps only, such as 'verlet' or 'mclachlan_2_s2'",
                      scheme.name, letter, hamiltonian));
    }
    if (!uses(word.stages, letter)) word.stages = with_outer(word.stages, letter);
  }
  return word;
}

Order order_over(const Scheme& scheme, const HamiltonianClaims& claims) {
  Order order = scheme.order;
  if (!claims.quadratic_kinetic) order.classical = order.any_splitting();
  if (!scheme.is_composition() && order.classical > 2) {
    // The error of a map of order 2 is that of the third power of its weight.
    for (const char letter : claims.inexact) {
      Quad cubes = 0;
      for (const Stage& stage : scheme.word)
        cubes += stage.letter == letter ? stage.weight * stage.weight * stage.weight : Quad(0);
      if (abs(cubes) > Quad(1e-12)) order.classical = 2;
    }
  }
  // An irreversible letter that the scheme does not have stands around its word.
  for (const char letter : claims.irreversible) {
    const bool inside =
        std::any_of(scheme.word.begin(), scheme.word.end(), [&](const Stage& stage) { return stage.letter == letter; });
    if (!scheme.is_composition() && !inside) order.classical = std::min(order.classical, 2);
  }
  return order;
}

template class Composition<AnyHamiltonian<double>>;
template class Composition<AnyHamiltonian<Quad>>;
template struct detail::IntegratorModel<Composition<AnyHamiltonian<double>>>;
template struct detail::IntegratorModel<Composition<AnyHamiltonian<Quad>>>;

namespace detail {

void expect_turns(bool bodies, bool turns, const std::string& hamiltonian) {
  if (!bodies || turns) return;
  throw SchemeMismatch(
      fmt::format("some particles are rigid bodies, but '{}' does not turn them; put Rotating around it", hamiltonian));
}

}  // namespace detail

}  // namespace noether
