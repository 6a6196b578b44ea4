// Random numbers by counters: published vectors, accuracy of the deviates, and their distribution.

#include "numbers/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/normal_bins.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace noether;

using Block = std::array<std::uint32_t, 4>;

TEST_CASE("Philox gives the vectors published with it", "[random]") {
  // The three lines "philox4x32 10" of kat_vectors, Random123 1.14.
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  const std::uint32_t ones = 0xffffffff;
  CHECK(philox({ones, ones, ones, ones}, {ones, ones}) == Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("a stream is a function of seed, stream and place", "[random]") {
  Philox random(0x243f6a88'85a308d3, 7), again(0x243f6a88'85a308d3, 7);
  const Block third = again.at(2);
  random.next();
  random.uniform();
  CHECK(random.next() == third);
  CHECK(random.place() == 3);
  random.set_place(2);
  CHECK(random.next() == third);
  CHECK(Philox(1, 0).at(0) != Philox(1, 1).at(0));
  CHECK(Philox(1, 0).at(0) != Philox(2, 0).at(0));
  CHECK(Philox(1, 5).at(3, 4) == Philox(1, 5).at((std::uint64_t{3} << 32U) + 4));
  CHECK(Philox(1, 5).at(std::uint64_t{7} << 32U | 6, 8) == philox({8, 6, 7, 5}, {1, 0}));
  CHECK(Philox(0x299f31d0'a4093822, 0).at(0) == philox({0, 0, 0, 0}, {0xa4093822, 0x299f31d0}));
}

TEST_CASE("uniform numbers reach neither 0 nor 1", "[random]") {
  CHECK(open_uniform(0, 0) == 0x1p-53);
  CHECK(open_uniform(0xffffffff, 0xffffffff) == 1 - 0x1p-53);
  CHECK(open_uniform(0, 0x80000000) == 0.5 + 0x1p-53);
}

TEST_CASE("the series of normal deviates agree with the functions they stand for", "[random]") {
  Philox random(3);
  double worst_log = 0, worst_turn = 0;
  for (int k = 0; k < 100000; ++k) {
    const double u =
        k % 2 == 0 ? random.uniform() : std::ldexp(random.uniform(), -static_cast<int>(random.uniform() * 50));
    worst_log = std::max(worst_log, std::abs(detail::log_by_series(u) / std::log(u) - 1));
    const auto [cosine, sine] = detail::turn_by_series(u);
    const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(u);
    worst_turn = std::max({worst_turn, std::abs(cosine - static_cast<double>(std::cos(angle))),
                           std::abs(sine - static_cast<double>(std::sin(angle)))});
  }
  CHECK(worst_log < 1e-14);  // of numbers near 1, where the logarithm is small: 1 ulp of u
  CHECK(worst_turn < 4e-16);
  CHECK(detail::turn_by_series(0.25)[0] == 0);
  CHECK(detail::turn_by_series(0.25)[1] == 1);
  CHECK(detail::turn_by_series(0.5)[0] == -1);
}

TEST_CASE("normal deviates have the moments of the normal distribution", "[random]") {
  Philox random(2026, 11);
  const int pairs = 1000000;
  double sums[5] = {0, 0, 0, 0, 0}, product = 0;
  int beyond_two = 0;
  for (int k = 0; k < pairs; ++k) {
    const auto [a, b] = random.normal_pair();
    product += a * b;
    for (const double z : {a, b}) {
      double power = 1;
      for (double& sum : sums) sum += power, power *= z;
      beyond_two += std::abs(z) > 2 ? 1 : 0;
    }
  }
  const double n = sums[0];
  // Five standard deviations of each mean: their variances are 1, 2, 15, 96, 1.
  CHECK(std::abs(sums[1] / n) < 5 * std::sqrt(1 / n));
  CHECK(std::abs(sums[2] / n - 1) < 5 * std::sqrt(2 / n));
  CHECK(std::abs(sums[3] / n) < 5 * std::sqrt(15 / n));
  CHECK(std::abs(sums[4] / n - 3) < 5 * std::sqrt(96 / n));
  CHECK(std::abs(product / pairs) < 5 / std::sqrt(pairs));
  const double tail = std::erfc(std::sqrt(2.0));
  CHECK(std::abs(beyond_two / n - tail) < 5 * std::sqrt(tail / n));
}

TEST_CASE("normal deviates have the bits they had", "[random]") {
  const auto [a, b] = Philox(42).normal_pair();
  CHECK(a == -0x1.54ac03c1a033p-1);
  CHECK(b == 0x1.0938db380d75fp+0);
}

TEST_CASE("normal deviates are normal, by particles, by steps and by stages", "[random]") {
  const auto key = noise_key(42);
  test::NormalBins particles[3], steps[3], stages[3];
  double sum = 0, products[3] = {0, 0, 0};
  constexpr int count = 100000;
  for (int k = 0; k < count; ++k) {
    const auto v = noise(key, k, 3, 2);
    const auto w = noise(key, 7, k, 2);
    const auto u = noise(key, 7, k / 128, static_cast<std::uint32_t>(k % 128));
    for (int c = 0; c < 3; ++c) {
      const auto at = static_cast<std::size_t>(c), next = static_cast<std::size_t>((c + 1) % 3);
      particles[c].add(v[at]);
      steps[c].add(w[at]);
      stages[c].add(u[at]);
      products[c] += v[at] * v[next] + v[at] * w[at] + w[at] * u[at];
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

TEST_CASE("seed, particle, step and stage each give other numbers", "[random]") {
  std::set<double> seen;
  int asked = 0;
  for (const std::int64_t seed : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 40, std::int64_t{-1}}) {
    for (const std::int64_t id : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 33, std::int64_t{1} << 53}) {
      for (const std::int64_t step : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 35}) {
        for (const std::uint32_t stage : {0U, 1U, 127U}) {
          const auto v = noise(noise_key(seed), id, step, stage);
          for (const double x : {v[0], v[1], v[2]}) seen.insert(x);
          asked += 3;
        }
      }
    }
  }
  CHECK(static_cast<int>(seen.size()) == asked);
}

TEST_CASE("noise in lanes is the noise of each particle, bit for bit", "[random]") {
  std::vector<std::int64_t> ids;
  for (std::int64_t k = 0; k < 4000; ++k) ids.push_back(k < 2000 ? k : (std::int64_t{1} << 53U) - k * k * k);
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    CAPTURE(name(level));
    for (const std::int64_t step : {std::int64_t{0}, std::int64_t{77}, std::int64_t{1} << 40U}) {
      for (const std::uint32_t stage : {0U, 3U, 127U}) {
        for (const std::ptrdiff_t count : {0, 1, 7, 8, 13, 64, 4000}) {
          const auto key = noise_key(step - 5);
          std::vector<double> x(4001, -1), y(4001, -1), z(4001, -1);
          noise(key, ids.data(), count, step, stage, x.data(), y.data(), z.data());
          bool same = true;
          for (std::ptrdiff_t k = 0; k < count; ++k) {
            const auto i = static_cast<std::size_t>(k);
            same = same && std::array{x[i], y[i], z[i]} == noise(key, ids[i], step, stage);
          }
          CHECK(same);
          const auto after = static_cast<std::size_t>(count);
          CHECK(std::array{x[after], y[after], z[after]} == std::array{-1.0, -1.0, -1.0});
        }
      }
    }
  }
}
