/// Frequency analysis against sums of terms that are known.

#include "study/frequencies.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <numbers>

using namespace noether;
using namespace noether::test;

namespace {

using Complex = std::complex<double>;

const std::vector<FrequencyTerm> known_terms = {
    {1.0, 1.0, 0.3}, {-0.77, 0.4, -2.0}, {2.31, 0.1, 1.0}, {0.123, 0.01, 2.5}};

std::vector<Complex> signal_of(const std::vector<FrequencyTerm>& terms, double start, double dt, std::size_t count) {
  std::vector<Complex> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = start + dt * static_cast<double>(i);
    for (const FrequencyTerm& one : terms) values[i] += std::polar(one.amplitude, one.frequency * t + one.phase);
  }
  return values;
}

/// Largest error of the frequency of the first term over three lengths near `length`, each of which meets the side
/// lobes of the other terms elsewhere.
double error_of_first(double length, int window, int sweeps) {
  double worst = 0;
  for (const double factor : {1.0, 1.03, 1.07, 1.11}) {
    const double dt = 0.25;
    const auto count = static_cast<std::size_t>(length * factor / dt);
    const auto found =
        frequency_terms(signal_of(known_terms, 0, dt, count), 0, dt, {.terms = 4, .window = window, .sweeps = sweeps});
    worst = std::max(worst, std::abs(found.at(0).frequency - 1.0));
  }
  return worst;
}

}  // namespace

TEST_CASE("frequencies, amplitudes and phases of a known sum come back", "[frequencies]") {
  const double start = 37, dt = 0.25;
  const auto found = frequency_terms(signal_of(known_terms, start, dt, 4001), start, dt, {.terms = 4, .sweeps = 3});
  REQUIRE(found.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    INFO("term " << k);
    CHECK(std::abs(found[k].frequency - known_terms[k].frequency) < 1e-11);
    CHECK(std::abs(found[k].amplitude - known_terms[k].amplitude) < 1e-9);
    CHECK(std::abs(std::remainder(found[k].phase - known_terms[k].phase, 2 * std::numbers::pi)) < 1e-8);
  }
}

TEST_CASE("a frequency found alone is off by T^-(2p+2)", "[frequencies]") {
  // Laskar (1993): T^-4 under Hann's window, T^-6 under its square.
  for (const int window : {1, 2}) {
    const double first = error_of_first(200, window, 0), second = error_of_first(800, window, 0);
    const double slope = std::log2(second / first) / 2;
    INFO("window " << window << ": " << first << " and " << second << ", slope " << slope);
    CHECK(std::abs(slope + 2 * window + 2) < 0.7);
    CHECK(error_of_first(800, window, 2) < 0.01 * second + 1e-14);
  }
}

TEST_CASE("a frequency that drifts shows in the two halves of a signal", "[frequencies]") {
  const double dt = 0.25;
  const auto steady = frequency_changes(signal_of(known_terms, 0, dt, 8000), 0, dt, {.terms = 2});
  REQUIRE(steady.size() == 2);
  CHECK(steady[0].diffusion() < -9);
  std::vector<Complex> drifting(8000);
  const double rate = 1e-7;  // nu = 1 + rate t, whose mean over the halves differs by rate times half the length
  for (std::size_t i = 0; i < drifting.size(); ++i) {
    const double t = dt * static_cast<double>(i);
    drifting[i] = std::polar(1.0, t + 0.5 * rate * t * t);
  }
  const auto changes = frequency_changes(drifting, 0, dt, {.terms = 1});
  REQUIRE(changes.size() == 1);
  CHECK(std::abs(changes[0].second.frequency - changes[0].first.frequency - rate * 1000) < 1e-3 * rate * 1000);
}

TEST_CASE("signals that cannot be analysed are refused", "[frequencies]") {
  CHECK(refusal_of([] { frequency_terms(std::vector<Complex>(15), 0, 1); }).find("15 samples is too short") !=
        std::string::npos);
  std::vector<Complex> broken(20, Complex(1, 0));
  broken[3] = Complex(NAN, 0);
  CHECK(refusal_of([&] { frequency_terms(broken, 0, 1); }).find("not finite") != std::string::npos);
}
