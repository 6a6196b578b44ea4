#pragma once
/// Random numbers without a state: each is a function of a key and a counter, so that runs restart and threads share
/// the work without a change of bits.

#include "engine/types.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace noether {

using RandomCounter = std::array<std::uint32_t, 4>;
using RandomKey = std::array<std::uint32_t, 2>;

/// 128 random bits by the counter, Philox 4x32 with 10 rounds.
/// @throws never
/// @source SalmonEtAl2011
constexpr std::array<std::uint32_t, 4> philox(RandomCounter c, RandomKey k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
    const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
    c = {high(b) ^ c[1] ^ k[0], static_cast<std::uint32_t>(b), high(a) ^ c[3] ^ k[1], static_cast<std::uint32_t>(a)};
    k[0] += 0x9E3779B9;
    k[1] += 0xBB67AE85;
  }
  return c;
}

/// A seed as a key.
constexpr RandomKey random_key(std::int64_t seed) {
  const auto bits = static_cast<std::uint64_t>(seed);
  return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32U)};
}

/// A number in (0, 1), the middle of one of 2^52 equal parts.
/// @throws never
constexpr double uniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32U) | low;
  return (static_cast<double>(bits >> 12U) + 0.5) * 0x1p-52;
}

/// Two independent normal deviates of mean 0 and variance 1 from 128 random bits; they reach 8.5 standard deviations.
///
///     sqrt(-2 ln u) (cos 2 pi w, sin 2 pi w)
///
/// @throws never
/// @source BoxMuller1958
inline std::array<double, 2> normal_pair(const std::array<std::uint32_t, 4>& bits) {
  constexpr double two_pi = 6.28318530717958647692;
  const double r = std::sqrt(-2 * std::log(uniform(bits[0], bits[1])));
  const double angle = two_pi * uniform(bits[2], bits[3]);
  return {r * std::cos(angle), r * std::sin(angle)};
}

/// What random numbers are for: those of one purpose are not those of another, under one seed.
enum class RandomPurpose : std::uint8_t { velocities, thermostat };

/// Three normal deviates for particle `id` in stage `stage` of step `step`.
/// @param id  0 to 2^53
/// @param stage  0 to 127
/// @throws never
/// @cost two calls of `philox`
inline Vec3<double> normal_vector(const RandomKey& key, RandomPurpose purpose, std::int64_t id, std::int64_t step,
                                  std::uint32_t stage) {
  const auto who = static_cast<std::uint64_t>(id), when = static_cast<std::uint64_t>(step);
  RandomCounter counter = {
      static_cast<std::uint32_t>(who),
      static_cast<std::uint32_t>(who >> 32U) | stage << 22U | static_cast<std::uint32_t>(purpose) << 30U,
      static_cast<std::uint32_t>(when), static_cast<std::uint32_t>(when >> 32U)};
  const auto one = normal_pair(philox(counter, key));
  counter[1] |= 1U << 29U;
  return Vec3<double>(one[0], one[1], normal_pair(philox(counter, key))[0]);
}

}  // namespace noether
