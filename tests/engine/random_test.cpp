// Random numbers by counter: known answers, uniformity, normal deviates by chi square.

#include "engine/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

namespace noether {
namespace {

constexpr bool gives(RandomCounter counter, RandomKey key, std::array<std::uint32_t, 4> expected) {
  return philox(counter, key) == expected;
}

// The known answers published with the generator. Counter and key of the last are digits of pi.
static_assert(gives({0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
static_assert(gives({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff},
                    {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
static_assert(gives({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0},
                    {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));

/// Chi square of normal deviates in 64 bins that are equally likely.
class NormalBins {
 public:
  void add(double x) {
    const double probability = std::erfc(-x / std::sqrt(2.0)) / 2;
    ++counts_[static_cast<std::size_t>(std::min(63.0, 64 * probability))];
    ++total_;
  }
  double chi_square() const {
    const double expected = static_cast<double>(total_) / 64;
    double sum = 0;
    for (const long count : counts_) sum += std::pow(static_cast<double>(count) - expected, 2) / expected;
    return sum;
  }

 private:
  std::array<long, 64> counts_{};
  long total_ = 0;
};

TEST_CASE("uniform numbers lie inside (0, 1), the ends left out", "[random]") {
  CHECK(uniform(0, 0) == 0x1p-53);
  CHECK(uniform(0xffffffff, 0xffffffff) == 1 - 0x1p-53);
  CHECK(std::isfinite(normal_pair({0, 0, 0, 0})[0]));
  CHECK(normal_pair({0xffffffff, 0xffffffff, 0, 0})[0] > 0);
  CHECK(normal_pair({0, 0, 0, 0})[0] < 8.6);
}

TEST_CASE("normal deviates are normal, by particles, by steps and by stages", "[random]") {
  const RandomKey key = random_key(-42);
  NormalBins particles[3], steps[3], stages[3];
  double sum = 0, products[3] = {0, 0, 0};
  constexpr int count = 100000;
  for (int k = 0; k < count; ++k) {
    const auto v = normal_vector(key, RandomPurpose::thermostat, k, 3, 2);
    const auto w = normal_vector(key, RandomPurpose::thermostat, 7, k, 2);
    const auto u = normal_vector(key, RandomPurpose::velocities, 7, k / 128, static_cast<std::uint32_t>(k % 128));
    for (int c = 0; c < 3; ++c) {
      particles[c].add(v[c]);
      steps[c].add(w[c]);
      stages[c].add(u[c]);
      products[c] += v[c] * v[(c + 1) % 3] + v[c] * w[c] + w[c] * u[c];
    }
    sum += v[0] + v[1] + v[2];
  }
  // Above 131.7 once in a million times, with 63 degrees of freedom; means within 5 standard deviations.
  for (const auto* bins : {particles, steps, stages}) {
    for (int c = 0; c < 3; ++c) CHECK(bins[c].chi_square() < 131.7);
  }
  CHECK(std::abs(sum) < 5 * std::sqrt(3.0 * count));
  for (const double product : products) CHECK(std::abs(product) < 5 * std::sqrt(3.0 * count));
}

TEST_CASE("seed, purpose, particle, step and stage each give other numbers", "[random]") {
  std::set<double> seen;
  int asked = 0;
  for (const std::int64_t seed : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 40, std::int64_t{-1}}) {
    for (const RandomPurpose purpose : {RandomPurpose::velocities, RandomPurpose::thermostat}) {
      for (const std::int64_t id : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 33, std::int64_t{1} << 53}) {
        for (const std::int64_t step : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 35}) {
          for (const std::uint32_t stage : {0U, 1U, 127U}) {
            const auto v = normal_vector(random_key(seed), purpose, id, step, stage);
            for (const double x : {v[0], v[1], v[2]}) seen.insert(x);
            asked += 3;
          }
        }
      }
    }
  }
  CHECK(static_cast<int>(seen.size()) == asked);
}

}  // namespace
}  // namespace noether
