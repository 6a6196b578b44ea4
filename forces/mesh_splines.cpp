#include "forces/mesh_splines.hpp"

#include "numbers/wide_sum.hpp"

#include <cmath>
#include <complex>

namespace noether::detail {

namespace {

constexpr double half_circle = 3.141592653589793;

/// U(k) along one axis, and sums over all other waves k_m that look the same: of U(k_m), U(k_m)^2, k_m^2 U(k_m)^2.
struct Aliases {
  double k = 0, own = 0, plain = 0, squares = 0, moments = 0;
};
/// @param k  along the axis, at most half a turn a point @param h  distance of points
Aliases aliases_of(double k, double h, int order) {
  Aliases all{.k = k};
  constexpr int far = 3;  // the next ones are below a thousandth of these, at order 4
  for (int m = -far; m <= far; ++m) {
    const double k_m = k + 2 * half_circle * m / h, half = k_m * h / 2;
    const double u = std::pow(half == 0 ? 1 : std::sin(half) / half, order);
    if (m == 0) {
      all.own = u;
    } else {
      all.plain += u;
      all.squares += u * u;
      all.moments += k_m * k_m * u * u;
    }
  }
  return all;
}

/// The same of a wave in space. Nothing is taken from anything, so that small errors keep their digits.
Aliases in_space(const Aliases& x, const Aliases& y, const Aliases& z) {
  Aliases all{.own = 1};
  double k2 = 0, moment = 0;  // k^2 U(k)^2 along the axes so far
  for (const Aliases* one : {&x, &y, &z}) {
    const double own2 = one->own * one->own, before2 = all.own * all.own;
    const double along = one->k * one->k * own2;
    all.moments = all.moments * (own2 + one->squares) + moment * one->squares + one->moments * (before2 + all.squares) +
                  along * all.squares;
    moment = moment * own2 + along * before2;
    all.squares = all.squares * (own2 + one->squares) + before2 * one->squares;
    all.plain = all.plain * (one->own + one->plain) + all.own * one->plain;
    all.own *= one->own;
    k2 += one->k * one->k;
  }
  all.k = std::sqrt(k2);
  return all;
}

}  // namespace

SplineWeights::SplineWeights(double w, int order) {
  const auto p = static_cast<std::size_t>(order);
  value[0] = 1 - w;
  value[1] = w;
  const auto raise = [&](std::size_t n) {  // from order n - 1 to n
    const double by = 1 / static_cast<double>(n - 1);
    value[n - 1] = by * w * value[n - 2];
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const auto j = static_cast<double>(k), left = static_cast<double>(n - k);
      value[n - k - 1] = by * ((w + j) * value[n - k - 2] + (left - w) * value[n - k - 1]);
    }
    value[0] = by * (1 - w) * value[0];
  };
  for (std::size_t n = 3; n < p; ++n) raise(n);
  slope[0] = -value[0];
  for (std::size_t k = 1; k + 1 < p; ++k) slope[k] = value[k - 1] - value[k];
  slope[p - 1] = value[p - 2];
  raise(p);
}

double mesh_error(double alpha, const Vec3<double>& spacing, int order, double neighbor) {
  constexpr int parts = 16;  // of half of the waves along an axis
  std::array<std::array<Aliases, parts>, 3> axes;
  const auto wave = [&](int axis, int j) { return (j + 0.5) * half_circle / (parts * spacing[axis]); };
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < parts; ++j)
      axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(j)] =
          aliases_of(wave(axis, j), spacing[axis], order);
  }
  WideSum<double> sum;
  for (int i = 0; i < parts * parts * parts; ++i) {
    const auto at = [&](std::size_t axis, int j) { return axes[axis][static_cast<std::size_t>(j)]; };
    const Aliases one = in_space(at(0, i % parts), at(1, i / parts % parts), at(2, i / parts / parts));
    const double k2 = one.k * one.k, own2 = one.own * one.own, all = one.own + one.plain, b = 1 / (all * all);
    const double A = 4 * half_circle * std::exp(-k2 / (4 * alpha * alpha)) / k2;
    const double less = one.plain * (all + one.own) * b;  // 1 - b U(k)^2
    sum += A * A * (k2 * less * less + b * b * (k2 * own2 * one.squares + one.moments * (own2 + one.squares)));
  }
  double cell = 8;  // all octants have the same
  for (int axis = 0; axis < 3; ++axis) cell /= 2 * parts * spacing[axis];
  return std::sqrt(neighbor * sum.value() * cell);
}

double spacing_for(double error, double alpha, int order, double neighbor) {
  double below = 0.01 / alpha, above = 3 / alpha;
  for (int k = 0; k < 20; ++k) {
    const double middle = std::sqrt(below * above);
    (mesh_error(alpha, Vec3<double>::Constant(middle), order, neighbor) > error ? above : below) = middle;
  }
  return below;
}

std::int64_t quick_size(std::int64_t points) {
  const auto is_quick = [](std::int64_t n) {
    for (const std::int64_t factor : {2, 3, 5, 7}) {
      while (n % factor == 0) n /= factor;
    }
    return n == 1;
  };
  while (!is_quick(points)) ++points;
  return points;
}

std::vector<double> spline_factors(std::int64_t points, int order) {
  const SplineWeights at_points(0, order);  // M at whole numbers
  std::vector<double> factors(static_cast<std::size_t>(points));
  for (std::int64_t m = 0; m < points; ++m) {
    std::complex<double> sum = 0;
    for (int j = 0; j < order; ++j) {
      const double angle = 2 * half_circle * static_cast<double>(m * j % points) / static_cast<double>(points);
      sum += at_points.value[static_cast<std::size_t>(j)] * std::polar(1.0, angle);
    }
    const bool none = 2 * m == points && order % 2 == 1;
    factors[static_cast<std::size_t>(m)] = none ? 0 : 1 / std::norm(sum);
  }
  return factors;
}

}  // namespace noether::detail
