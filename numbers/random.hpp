#pragma once
/// Random numbers by counters: the k-th number of a stream is a function of seed, stream and k, and of nothing else.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace noether {

/// Philox4x32 with 10 rounds: a bijection of 128 bits for each key.
/// @throws never
/// @source Salmon2011
constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0], b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32U) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32U) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// A number in (0, 1): the middle of one of 2^52 equal intervals, so that its logarithm and that of 1 - u are finite.
/// @throws never
constexpr double open_uniform(std::uint32_t low, std::uint32_t high) {
  const std::uint64_t bits = (std::uint64_t{high} << 32U | low) >> 12U;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

namespace detail {

/// ln u for a normal double u > 0: u = m 2^e, 1/2 < m^2 < 2, ln m = 2 artanh s with s = (m - 1)/(m + 1), |s| < 0.172.
constexpr double log_by_series(double u) {
  const auto bits = std::bit_cast<std::uint64_t>(u);
  int exponent = static_cast<int>(bits >> 52U) - 1023;
  double m = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | 0x3FF0000000000000U);
  if (m > std::numbers::sqrt2) m /= 2, ++exponent;
  const double s = (m - 1) / (m + 1), s2 = s * s;
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
  return exponent * std::numbers::ln2 + 2 * s * sum;
}

/// cos and sin of 2 pi u for u in (0, 1): series in the quarter that is nearest, where the angle is below pi/4.
constexpr std::array<double, 2> turn_by_series(double u) {
  const int quarter = static_cast<int>(4 * u + 0.5);
  const double angle = 2 * std::numbers::pi * (u - 0.25 * quarter), a2 = angle * angle;
  double cosine = 1, sine = 1;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = 1 - cosine * (a2 / (k * (k - 1)));
    sine = 1 - sine * (a2 / (k * (k + 1)));
  }
  sine *= angle;
  if (quarter % 4 == 1) return {-sine, cosine};
  if (quarter % 4 == 2) return {-cosine, -sine};
  if (quarter % 4 == 3) return {sine, -cosine};
  return {cosine, sine};
}

}  // namespace detail

/// Two independent normal deviates of mean 0 and variance 1 from 128 random bits.
///
///     r = sqrt(-2 ln u1),  (r cos 2 pi u2, r sin 2 pi u2)
///
/// By sums, products, quotients and one root only, all of which IEEE 754 rounds in one way: the bits are the same
/// everywhere, whatever C library. Accurate to a few 1e-16; the tails end at 8.6.
/// @throws never
/// @source BoxMuller1958
inline std::array<double, 2> normal_pair(const std::array<std::uint32_t, 4>& bits) {
  const double radius = std::sqrt(-2 * detail::log_by_series(open_uniform(bits[0], bits[1])));
  const auto [cosine, sine] = detail::turn_by_series(open_uniform(bits[2], bits[3]));
  return {radius * cosine, radius * sine};
}

/// The key of the noise of a seed, which no `Philox` of a seed of 0 or more has.
/// @throws never
constexpr std::array<std::uint32_t, 2> noise_key(std::int64_t seed) {
  const auto bits = static_cast<std::uint64_t>(seed);
  return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32U) ^ 0x80000000U};
}

/// Three normal deviates for particle `id` in stage `stage` of step `step`: noise without a state.
/// @param id  0 to 2^53
/// @param stage  0 to 127
/// @throws never
/// @cost two calls of `philox`
inline std::array<double, 3> noise(const std::array<std::uint32_t, 2>& key, std::int64_t id, std::int64_t step,
                                   std::uint32_t stage) {
  const auto who = static_cast<std::uint64_t>(id), when = static_cast<std::uint64_t>(step);
  std::array<std::uint32_t, 4> counter = {static_cast<std::uint32_t>(who),
                                          static_cast<std::uint32_t>(who >> 32U) | stage << 22U,
                                          static_cast<std::uint32_t>(when), static_cast<std::uint32_t>(when >> 32U)};
  const auto one = normal_pair(philox(counter, key));
  counter[1] |= 1U << 29U;
  return {one[0], one[1], normal_pair(philox(counter, key))[0]};
}

/// The same for many particles, in lanes: the same bits.
/// @param ids  shape (count) @param x, y, z  what to fill, shape (count) each
/// @cost a tenth of as many calls with AVX-512
void noise(const std::array<std::uint32_t, 2>& key, const std::int64_t* ids, std::ptrdiff_t count, std::int64_t step,
           std::uint32_t stage, double* x, double* y, double* z);

/// One stream of random numbers, taken in order or by their place; streams of a seed never meet.
///
///     Philox random(42);                            // a sequence
///     const double u = random.uniform();
///     const auto bits = random.at(step, particle);  // or by place: no state, any order, any thread
///
/// The key is the seed; the counter is, from its highest word down, the stream, 64 bits of the first number of a place
/// and 32 of the second. Each purpose takes a stream of its own. State to be saved is `place()`.
class Philox {
 public:
  explicit Philox(std::uint64_t seed, std::uint32_t stream = 0) : seed_(seed), stream_(stream) {}

  /// The 128 bits at a place, such as step and particle.
  std::array<std::uint32_t, 4> at(std::uint64_t first, std::uint32_t second) const {
    return philox({second, lower(first), lower(first >> 32U), stream_}, {lower(seed_), lower(seed_ >> 32U)});
  }
  /// The 128 bits at a place of the sequence; its lower 32 bits are the second number.
  std::array<std::uint32_t, 4> at(std::uint64_t place) const { return at(place >> 32U, lower(place)); }

  /// The next 128 bits.
  std::array<std::uint32_t, 4> next() { return at(place_++); }
  /// The next number in (0, 1).
  double uniform() {
    const auto b = next();
    return open_uniform(b[0], b[1]);
  }
  /// The next two normal deviates.
  std::array<double, 2> normal_pair() { return noether::normal_pair(next()); }

  /// How many times 128 bits have been taken.
  std::uint64_t place() const { return place_; }
  void set_place(std::uint64_t place) { place_ = place; }

 private:
  static constexpr std::uint32_t lower(std::uint64_t x) { return static_cast<std::uint32_t>(x); }

  std::uint64_t seed_, place_ = 0;
  std::uint32_t stream_;
};

}  // namespace noether
