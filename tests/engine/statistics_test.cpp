#include "engine/statistics.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

namespace noether {
namespace {

/// Noise that is the same on every machine: a linear congruence, mean 0, in [-1/2, 1/2).
class Noise {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) * 0x1p-53 - 0.5;
  }

 private:
  std::uint64_t state_ = 7;
};

SeriesStatistics line_with_noise(int n, double slope, double amplitude) {
  SeriesStatistics series;
  Noise noise;
  for (int k = 0; k < n; ++k) series.add(0.5 * k, 3 + slope * 0.5 * k + amplitude * noise.next());
  return series;
}

}  // namespace

TEST_CASE("worst and rms count the sign and every sample", "[statistics]") {
  SeriesStatistics series;
  for (const double y : {1.0, -4.0, 2.0, 2.0}) series.add(0, y);
  CHECK(series.samples() == 4);
  CHECK(series.first() == 1);
  CHECK(series.last() == 2);
  CHECK(series.worst() == 4);
  CHECK(series.rms() == 2.5);
}

TEST_CASE("a value that is not finite stays visible in the worst", "[statistics]") {
  SeriesStatistics series;
  series.add(0, 1);
  series.add(1, std::numeric_limits<double>::quiet_NaN());
  CHECK(std::isnan(series.worst()));
}

TEST_CASE("the slope of a straight line is exact however many blocks were joined", "[statistics]") {
  for (const int n : {2, 20, 63, 64, 65, 1000, 100'000}) {
    CAPTURE(n);
    const auto slope = line_with_noise(n, 0.25, 0).slope();
    REQUIRE(slope);
    CHECK(std::abs(*slope - 0.25) < 1e-12);
  }
}

TEST_CASE("there is no slope of one sample and no error of a slope below twenty blocks", "[statistics]") {
  CHECK(!line_with_noise(1, 1, 0).slope());
  CHECK(!line_with_noise(19, 1, 0).line());
  CHECK(line_with_noise(20, 1, 0).line());
}

TEST_CASE("the error of the slope covers what noise does to it", "[statistics]") {
  const auto line = line_with_noise(6400, 1e-3, 1).line();
  REQUIRE(line);
  const double spread = 6400 * 0.5 / std::sqrt(12.0);  // of the times
  const double expected = 1 / std::sqrt(12.0) / spread / std::sqrt(6400.0);
  CHECK(std::abs(line->slope - 1e-3) < 3 * line->error);
  CHECK(line->error > 0.6 * expected);
  CHECK(line->error < 1.6 * expected);
}

TEST_CASE("the error of the slope shrinks with the length of the run to the power 3/2", "[statistics]") {
  const double shorter = line_with_noise(1600, 0, 1).line()->error, longer = line_with_noise(25600, 0, 1).line()->error;
  const double power = std::log(shorter / longer) / std::log(16.0);
  CHECK(std::abs(power - 1.5) < 0.2);
}

TEST_CASE("the error of a mean is that of many series, of values that stay alike for longer than a block too",
          "[statistics]") {
  Noise noise;
  for (const double memory : {0.0, 5.0, 20.0, 40.0}) {  // samples
    const double keep = memory > 0 ? std::exp(-1 / memory) : 0;
    const int series = 200, samples = 2000;
    double scatter = 0, told = 0;
    for (int k = 0; k < series; ++k) {
      SeriesStatistics one;
      double y = 0;
      for (int warm = 0; warm < 200; ++warm) y = keep * y + noise.next();
      for (int n = 0; n < samples; ++n) {
        y = keep * y + noise.next();
        one.add(n, y);
      }
      scatter += one.mean() * one.mean() / series;
      told += *one.mean_error() * *one.mean_error() / series;
    }
    CAPTURE(memory, std::sqrt(told / scatter));
    CHECK(std::sqrt(told / scatter) > 0.85);
    CHECK(std::sqrt(told / scatter) < 1.3);
  }
}

TEST_CASE("statistics go on after a restart as if there had been none", "[statistics]") {
  SeriesStatistics whole, first;
  Noise noise;
  for (int k = 0; k < 1001; ++k) {
    const double y = noise.next();
    whole.add(k, y);
    if (k < 400) first.add(k, y);
  }
  SavedState saved;
  first.save(saved, "series");
  SeriesStatistics second;
  second.load(saved, "series");
  Noise again;
  for (int k = 0; k < 1001; ++k) {
    const double y = again.next();
    if (k >= 400) second.add(k, y);
  }
  CHECK(second.samples() == whole.samples());
  CHECK(second.worst() == whole.worst());
  CHECK(second.rms() == whole.rms());
  CHECK(second.line()->slope == whole.line()->slope);
  CHECK(second.line()->error == whole.line()->error);
}

}  // namespace noether
