// Stability on the harmonic oscillator, from the step's matrix: no simulation.

#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace noether {
namespace {

/// The map of one step for q'' = -q and step z = h omega, as the matrix ((qq, qp), (pq, pp)) of determinant 1.
struct StepMatrix {
  Quad qq = 1, qp = 0, pq = 0, pp = 1;

  Quad half_trace() const { return (qq + pp) / Quad(2); }
};

StepMatrix step_matrix(const Word& word, Quad z) {
  StepMatrix m;
  for (const Stage& stage : word) {
    const Quad w = stage.weight * z;
    if (stage.letter == 'A') {
      m.qq += w * m.pq;
      m.qp += w * m.pp;
    } else {
      m.pq -= w * m.qq;
      m.pp -= w * m.qp;
    }
  }
  return m;
}

/// The zero of a function that changes sign once between two arguments.
template <class F> Quad zero_between(const F& f, Quad below, Quad above) {
  const bool negative = f(below) < Quad(0);
  for (int k = 0; k < 60; ++k) {
    const Quad middle = (below + above) / Quad(2);
    (((f(middle) < Quad(0)) == negative) ? below : above) = middle;
  }
  return below;
}

constexpr int steps_per_unit = 400;

/// First z > `start` at which |trace/2| passes 1, or `none` up to z = 7.
///
/// For a palindrome qq = pp, so (trace/2)^2 - 1 = qp pq: gaps lie between the zeros of qp and of pq, and are found
/// however low they are (7e-8 for sofroniou_spaletta_10_s35, which a scan of the trace overlooks).
std::optional<double> unstable_from(const Scheme& scheme, double start = 0) {
  const auto qp = [&](Quad z) { return step_matrix(scheme.word, z).qp; };
  const auto pq = [&](Quad z) { return step_matrix(scheme.word, z).pq; };
  const auto excess = [&](Quad z) { return abs(step_matrix(scheme.word, z).half_trace()) - Quad(1) - Quad(1e-25); };
  for (int k = static_cast<int>(start * steps_per_unit) + 1; k < 7 * steps_per_unit; ++k) {
    const Quad z = Quad(k) / Quad(steps_per_unit), next = Quad(k + 1) / Quad(steps_per_unit);
    if (!scheme.is_symmetric()) {
      if (excess(next) > Quad(0)) return static_cast<double>(zero_between(excess, z, next));
      continue;
    }
    std::optional<Quad> first;
    for (const bool upper : {true, false}) {
      const auto entry = [&](Quad at) { return upper ? qp(at) : pq(at); };
      if ((entry(z) < Quad(0)) == (entry(next) < Quad(0))) continue;
      const Quad zero = zero_between(entry, z, next);
      first = first ? std::min(*first, zero) : zero;
    }
    if (first) return static_cast<double>(*first);
  }
  return std::nullopt;
}

TEST_CASE("the tabulated stability limit is where the harmonic oscillator first becomes unstable", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    const auto limit = unstable_from(*scheme);
    REQUIRE(limit.has_value());
    CHECK(std::abs(*limit - scheme->stability_limit) < 1e-4);
  }
}

/// Schemes whose first gap, at half a period a step, is very low and narrow: where it ends and where the next begins.
struct LowGap {
  const Scheme& scheme;
  double end, height, next;
};

TEST_CASE("four schemes of small error have a low gap near pi and a wide one beyond", "[schemes]") {
  const LowGap gaps[] = {{schemes::srkn11b, 3.14232, 9.86e-8, 6.34785},
                         {schemes::srkn14a, 3.14211, 1.76e-7, 6.15001},
                         {schemes::sofroniou_spaletta_8_s21, 3.13835, 2.29e-7, 5.61092},
                         {schemes::sofroniou_spaletta_10_s35, 3.14184, 7.24e-8, 5.97367}};
  for (const auto& [scheme, end, height, next] : gaps) {
    CAPTURE(std::string(scheme.name));
    const Quad middle = (Quad(scheme.stability_limit) + Quad(end)) / Quad(2);
    const double excess = static_cast<double>(abs(step_matrix(scheme.word, middle).half_trace()) - Quad(1));
    CHECK(std::abs(excess / height - 1) < 0.01);
    const auto second = unstable_from(scheme, end + 1.0 / steps_per_unit);
    REQUIRE(second.has_value());
    CHECK(std::abs(*second - next) < 1e-4);
  }
}

TEST_CASE("no scheme is stable beyond two per kick", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    CHECK(scheme->stability_limit <= 2.0 * scheme->evaluations());
  }
}

TEST_CASE("the step's matrix has determinant 1 for every scheme", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    const StepMatrix m = step_matrix(scheme->word, Quad(0.5));
    CHECK(abs(m.qq * m.pp - m.qp * m.pq - Quad(1)) < Quad(1e-30));
  }
}

}  // namespace
}  // namespace noether
