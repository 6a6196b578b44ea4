#pragma once
/// Measured orders: errors over a ladder of step sizes, and the slope of the part of it that means something.

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace noether::test {

/// One rung: a step [time] and the error made with it.
struct ErrorPoint {
  double h = 0, error = 0;
};

/// Slope of log(error) over log(h) by least squares; NaN for fewer than two points.
inline double fitted_slope(const std::vector<ErrorPoint>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [h, error] : points) {
    const double u = std::log(h), w = std::log(error);
    n += 1, x += u, y += w, xx += u * u, xy += u * w;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Numbers of steps 2, 3, 4, 6, 8, 12, ...: a duration of 3 x 2^k divides by each of them exactly.
inline std::vector<long> ladder(long first, long last) {
  std::vector<long> counts;
  for (long n = 2; n <= last; n *= 2) {
    if (n >= first) counts.push_back(n);
    if (3 * n / 2 >= first && 3 * n / 2 <= last) counts.push_back(3 * n / 2);
  }
  return counts;
}

/// The three finest points that lie above the floor of the arithmetic, but below `ceiling`, where no order is to be
/// seen yet; fewer if there are none.
/// @param points  from coarse to fine
inline std::vector<ErrorPoint> finest(const std::vector<ErrorPoint>& points, double floor, double ceiling,
                                      std::size_t count = 3) {
  std::vector<ErrorPoint> valid;
  for (const auto& point : points) {
    if (point.error > floor && point.error < ceiling) valid.push_back(point);
  }
  if (valid.size() > count) valid.erase(valid.begin(), valid.end() - static_cast<std::ptrdiff_t>(count));
  return valid;
}

/// The ladder in words, for messages of failed tests.
inline std::string to_text(const std::vector<ErrorPoint>& points) {
  std::string text;
  for (const auto& [h, error] : points) {
    text += "h " + std::to_string(h) + " log10(error) " + std::to_string(std::log10(error)) + "\n";
  }
  return text;
}

}  // namespace noether::test
