// The word test: every table against the algebra it claims to satisfy, to all 4095 words of up to 11 letters.

#include "integrators/all_schemes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/free_algebra.hpp"

#include <algorithm>
#include <string>

namespace noether::test {
namespace {

constexpr int full_degree = 11;

TEST_CASE("every scheme satisfies the words of its claim and violates the next", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->order.outside_class != 0) continue;
    const WordSeries series = series_of(scheme->word, full_degree);
    for (const auto& [kind, degree] : claims_of_order(scheme->order)) {
      INFO(std::string(scheme->name) << ": words of " << kind.kicks_min << " or more kicks, degree " << degree);
      REQUIRE(degree < full_degree);
      const Quad within = word_error(series, 1, degree, kind);
      const Quad beyond = word_error(series, degree + 1, degree + 1, kind);
      CHECK(static_cast<double>(within) < static_cast<double>(word_tolerance(*scheme)));
      CHECK(static_cast<double>(beyond) > 1e-12);
      CHECK(static_cast<double>(beyond) > 1000 * static_cast<double>(within));
    }
  }
}

TEST_CASE("near-integrable schemes have their classical order, and no more", "[schemes]") {
  int seen = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->scheme_class != SchemeClass::near_integrable) continue;
    CAPTURE(std::string(scheme->name));
    CHECK(word_order(scheme->word, 6, word_tolerance(*scheme)) == scheme->order.classical);
    const auto& orders = scheme->order.near_integrable;
    CHECK(scheme->order.classical ==
          *std::min_element(orders.begin(), orders.end(), [](int a, int b) { return b == 0 || (a != 0 && a < b); }));
    ++seen;
  }
  CHECK(seen >= 11);
}

TEST_CASE("Runge-Kutta-Nystroem tables that need their class fail the word test within their order", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->order.outside_class == 0) continue;
    CAPTURE(std::string(scheme->name));
    CHECK(scheme->scheme_class == SchemeClass::rkn);
    CHECK(scheme->order.outside_class < scheme->order.classical);
    CHECK(word_order(scheme->word, full_degree, word_tolerance(*scheme)) == scheme->order.any_splitting());
    CHECK(static_cast<double>(word_error(series_of(scheme->word, 6), 1, scheme->order.classical)) > 1e-5);
  }
  const double srkn11b_violation = static_cast<double>(word_error(series_of(schemes::srkn11b.word, 6), 1, 6));
  CHECK(srkn11b_violation > 1.45e-5);
  CHECK(srkn11b_violation < 1.55e-5);
}

TEST_CASE("the Runge-Kutta-Nystroem tables known to need their class are those that say so", "[schemes]") {
  CHECK(schemes::srkn11b.order.outside_class == 4);
  CHECK(schemes::srkn14a.order.outside_class == 4);
  CHECK(schemes::okunbor_skeel_6_13.order.outside_class == 4);
  CHECK(schemes::mclachlan_atela_4.order.outside_class == 3);
  CHECK(schemes::mclachlan_atela_5.order.outside_class == 3);
  for (const Scheme* scheme : {&schemes::srkn6b, &schemes::mclachlan_sb3a_m4, &schemes::mclachlan_sb3a_m5}) {
    CAPTURE(std::string(scheme->name));
    CHECK(scheme->scheme_class == SchemeClass::rkn);
    CHECK(scheme->order.outside_class == 0);  // and so they are among those of the first test
  }
}

TEST_CASE("the first violation of ABA(10,6,4) is the smallest of all and still seen", "[schemes]") {
  const WordSeries series = series_of(schemes::aba_10_6_4.word, full_degree);
  const double violation = static_cast<double>(word_error(series, 11, 11, {1, 1}));
  CHECK(violation > 2.45e-11);
  CHECK(violation < 2.55e-11);
}

TEST_CASE("the series of exp(A) exp(B) has 1/(j! k!) at the word of j letters A before k letters B", "[schemes]") {
  Word word;
  word.push_back({'A', 1});
  word.push_back({'B', 1});
  const WordSeries series = series_of(word, 4);
  CHECK(series[0b1] == Quad(1));
  CHECK(series[0b101] == Quad(1));                        // AB
  CHECK(series[0b110] == Quad(0));                        // BA
  CHECK(series[0b10011] == Quad(1) / Quad(4));            // AABB
  CHECK(series[0b10111] == Quad(1) / Quad(2) / Quad(3));  // ABBB
  CHECK(series[0b10101] == Quad(0));                      // ABAB
}

}  // namespace
}  // namespace noether::test
