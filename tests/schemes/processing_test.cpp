// Correctors and kernels: the words that they put around a run, against the algebra they claim to satisfy.

#include "integrators/processing.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/schemes/correctors.hpp"
#include "numbers/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/free_algebra.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

/// The word before the run, one step, and the word after it, as one: more than a `Word` holds.
using Stages = std::vector<Stage>;

Stages whole(const Scheme& scheme) {
  Stages all;
  for (const Word* part : {&scheme.before, &scheme.word, &scheme.after})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

WordSeries series_of(const Stages& stages, int degree) {
  WordSeries series(degree);
  for (const Stage& stage : stages) series.multiply_exponential(stage.letter, stage.weight);
  return series;
}

/// The largest n for which all words of up to n letters are right.
int order_of(const Stages& stages, int degree) {
  const WordSeries series = series_of(stages, degree);
  int order = 0;
  while (order < degree && static_cast<double>(word_error(series, order + 1, order + 1)) < 1e-24) ++order;
  return order;
}

/// sum_k w_k x_k^n - 1/(n + 1) over the kicks w_k at x_k, the sum of all drifts before: the error in the first power of
/// B of words with n letters A is this over factorials.
double moment_error(const Stages& word, int n) {
  Quad at = 0, sum = 0;
  for (const Stage& stage : word) {
    if (stage.letter == 'A') at += stage.weight;
    if (stage.letter != 'B') continue;
    Quad power = stage.weight;
    for (int k = 0; k < n; ++k) power *= at;
    sum += power;
  }
  return std::fabs(static_cast<double>(sum - Quad(1) / Quad(n + 1)));
}

std::string refusal(const Scheme& scheme, const CompositionOptions& options) {
  try {
    processed(scheme, options);
  } catch (const SchemeMismatch& mismatch) {
    return mismatch.message() + " [" + mismatch.key() + "]";
  }
  return "";
}

TEST_CASE("a corrector takes away the error in the first power of B up to its order, and no further", "[schemes]") {
  for (const Scheme* scheme : {&schemes::verlet_aba, &schemes::verlet}) {
    for (const std::int64_t order : schemes::corrector_orders) {
      CAPTURE(std::string(scheme->name), order);
      const Scheme made = processed(*scheme, {.corrector = order});
      CHECK(made.order.near_integrable == std::array<int, 3>{static_cast<int>(order) + 1, 2, 0});
      const Stages word = whole(made);
      for (int n = 0; n <= order; ++n) CHECK(moment_error(word, n) < 1e-26);
      CHECK(moment_error(word, static_cast<int>(order) + 1) > 1e-2);
    }
    CHECK(moment_error(whole(*scheme), 2) > 1e-2);
  }
}

TEST_CASE("the word after a run undoes the one before it, and both carry no time", "[schemes]") {
  for (const bool second : {false, true}) {
    const Scheme made =
        processed(schemes::verlet_aba, {.corrector = 17, .kernel = StepKernel::composed, .second_corrector = second});
    Word both = made.before;
    for (const Stage& stage : made.after) both.push_back(stage);
    CHECK(both.size() == 0);
    Quad time = 0;
    for (const Stage& stage : made.before) time += stage.letter == 'A' ? stage.weight : Quad(0);
    CHECK(abs(time) < Quad(1e-32));
    CHECK(made.before.size() > 60);
  }
  for (const Scheme* scheme : {&schemes::verlet, &schemes::verlet_aba}) {
    for (const std::int64_t order : schemes::corrector_orders) {
      CAPTURE(std::string(scheme->name), order);
      Quad time = 0;
      for (const Stage& stage : processed(*scheme, {.corrector = order}).before)
        time += stage.letter == 'A' ? stage.weight : Quad(0);
      CHECK(abs(time) < Quad(1e-32));
    }
  }
}

TEST_CASE("the composed kernel is right to order 4 in the second power of B, the plain one to order 2", "[schemes]") {
  constexpr WordKind twice{2, 2};
  const auto error = [&](const CompositionOptions& options, int degree) {
    const WordSeries series = series_of(whole(processed(schemes::verlet_aba, options)), degree);
    return static_cast<double>(word_error(series, 1, degree, twice));
  };
  CHECK(error({.corrector = 7}, 2) < 1e-28);
  CHECK(error({.corrector = 7}, 3) > 1e-2);
  const CompositionOptions composed{.corrector = 7, .kernel = StepKernel::composed};
  CHECK(error(composed, 4) < 1e-28);
  CHECK(error(composed, 5) > 1e-3);
}

TEST_CASE("a kernel without its corrector is of order 2", "[schemes]") {
  const Scheme bare = processed(schemes::verlet_aba, {.kernel = StepKernel::composed});
  CHECK(bare.order.classical == 2);
  CHECK(order_of(whole(bare), 4) == 2);
  const Scheme made = processed(schemes::verlet_aba, {.corrector = 5, .kernel = StepKernel::composed});
  CHECK(made.order.classical == 4);  // where the kinetic energy is quadratic
  CHECK(order_of(whole(made), 5) == made.order.any_splitting());
}

TEST_CASE("after the second corrector a multiple of [B,[A,[A,[A,B]]]] is left in the second power of B", "[schemes]") {
  // Of c [A,[A,[B,[A,B]]]] + d [[A,B],[A,[A,B]]] the word BBAAA has - c and BABAA 2 c - d; that bracket is c = - d.
  const auto others = [](bool second) {
    const Scheme made =
        processed(schemes::verlet_aba, {.corrector = 17, .kernel = StepKernel::composed, .second_corrector = second});
    const WordSeries series = series_of(whole(made), 5);
    const Quad exact = Quad(1) / Quad(120);
    return std::fabs(static_cast<double>(series[0b110100] - exact + Quad(3) * (series[0b111000] - exact)));
  };
  CHECK(others(false) > 1e-4);
  CHECK(others(true) < 1e-26);
}

TEST_CASE("without changes a scheme stays what it is", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CHECK(processed(*scheme, {.compensated = true}).word.size() == scheme->word.size());
    CHECK(processed(*scheme, {}).before.size() == 0);
  }
}

TEST_CASE("the gradient kicks of saba_n stand at both ends and are one where steps meet", "[schemes]") {
  for (const Scheme* scheme : {&schemes::saba_1, &schemes::saba_2, &schemes::saba_3, &schemes::saba_4}) {
    CAPTURE(std::string(scheme->name));
    const Scheme made = processed(*scheme, {.kernel = StepKernel::modified});
    CHECK(made.is_symmetric());
    CHECK(made.word.front() == made.word.back());
    CHECK(made.word.front().letter == 'G');
    CHECK(made.word.size() == scheme->word.size() + 2);
    CHECK(made.before.size() == 0);
    // c = 1/4 [1/3 - 2 sum_{i<j} w_i w_j (x_j - x_i)] over the kicks, half of it at each end.
    Quad pairs = 0, x = 0;
    std::vector<std::pair<Quad, Quad>> kicks;
    for (const Stage& stage : scheme->word) {
      if (stage.letter == 'A') x += stage.weight;
      if (stage.letter != 'B') continue;
      for (const auto& [at, weight] : kicks) pairs += weight * stage.weight * (x - at);
      kicks.emplace_back(x, stage.weight);
    }
    CHECK(abs(made.word.front().weight - (Quad(1) / Quad(3) - Quad(2) * pairs) / Quad(8)) < Quad(1e-32));
  }
}

TEST_CASE("what no corrector or kernel is made for is refused, with what to use", "[schemes]") {
  CHECK(refusal(schemes::verlet_aba, {.corrector = 4}) ==
        "there is no corrector of order 4; give 3, 5, 7, 11 or 17, or 0 for none [corrector]");
  CHECK(refusal(schemes::aba_10_6_4, {.corrector = 17}) ==
        "corrector = 17 is not for method 'aba_10_6_4'; use 'verlet_aba' [corrector]");
  CHECK(refusal(schemes::yoshida_4, {.kernel = StepKernel::modified}) ==
        "kernel = \"modified\" is not for method 'yoshida_4'; use 'verlet_aba', or one of 'saba_1' to 'saba_4' "
        "[kernel]");
  CHECK(refusal(schemes::verlet, {.corrector = 5, .second_corrector = true}) ==
        "second_corrector = true needs a corrector and a kernel other than \"plain\"; give both, or take it out "
        "[second_corrector]");
  CHECK(refusal(schemes::verlet, {.corrector = 5, .kernel = StepKernel::lazy, .second_corrector = true}) == "");
  Scheme own = schemes::verlet_aba;
  own.before.push_back({'A', 0.5_q});
  own.after.push_back({'A', -0.5_q});
  CHECK(refusal(own, {.kernel = StepKernel::lazy}) ==
        "kernel = \"lazy\" is not for scheme 'verlet_aba', which has words around the run of its own; take it out "
        "[kernel]");
  CHECK(refusal(own, {.compensated = true}) == "");
}

}  // namespace
}  // namespace noether::test
