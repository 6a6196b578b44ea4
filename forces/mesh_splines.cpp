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
  const bool equal = spacing[0] == spacing[1] && spacing[1] == spacing[2];  // then six orders of the axes are one
  WideSum<double> sum;
  for (int i = 0; i < parts * parts * parts; ++i) {
    const auto at = [&](std::size_t axis, int j) { return axes[axis][static_cast<std::size_t>(j)]; };
    const int x = i % parts, y = i / parts % parts, z = i / parts / parts;
    if (equal && (x > y || y > z)) continue;
    const double times = !equal || (x == y && y == z) ? 1 : x == y || y == z ? 3 : 6;
    const Aliases one = in_space(at(0, x), at(1, y), at(2, z));
    const double k2 = one.k * one.k, own2 = one.own * one.own, all = one.own + one.plain, b = 1 / (all * all);
    const double A = 4 * half_circle * std::exp(-k2 / (4 * alpha * alpha)) / k2;
    const double less = one.plain * (all + one.own) * b;  // 1 - b U(k)^2
    sum += times * A * A * (k2 * less * less + b * b * (k2 * own2 * one.squares + one.moments * (own2 + one.squares)));
  }
  double cell = 8;  // all octants have the same
  for (int axis = 0; axis < 3; ++axis) cell /= 2 * parts * spacing[axis];
  return std::sqrt(neighbor * sum.value() * cell);
}

namespace {

/// Logarithms of mesh_error, of alpha = neighbor = 1, at equal steps of that of the spacing.
struct ErrorsOfSpacings {
  static constexpr int count = 33;
  static constexpr double narrowest = 0.01, widest = 3;
  std::array<double, count> logarithms{};

  explicit ErrorsOfSpacings(int order) {
    for (int k = 0; k < count; ++k)
      logarithms[static_cast<std::size_t>(k)] = std::log(mesh_error(1, Vec3<double>::Constant(at(k)), order, 1));
  }
  static double at(double k) { return narrowest * std::pow(widest / narrowest, k / (count - 1)); }
  /// The last one with that error or less.
  double widest_for(double error) const {
    const double wanted = std::log(error);
    int k = count - 1;
    while (k >= 0 && logarithms[static_cast<std::size_t>(k)] > wanted) --k;
    if (k < 0) return narrowest;
    if (k == count - 1) return widest;
    const double below = logarithms[static_cast<std::size_t>(k)], above = logarithms[static_cast<std::size_t>(k + 1)];
    return at(k + (wanted - below) / (above - below));
  }
};

}  // namespace

double spacing_for(double error, double alpha, int order, double neighbor) {
  static const std::array<ErrorsOfSpacings, 5> errors = {ErrorsOfSpacings(4), ErrorsOfSpacings(5), ErrorsOfSpacings(6),
                                                         ErrorsOfSpacings(7), ErrorsOfSpacings(8)};
  return errors[static_cast<std::size_t>(order - least_order)].widest_for(error / std::sqrt(neighbor * alpha)) / alpha;
}

double single_precision_error(double alpha, double spacing, double neighbor) {
  return 6 * 0x1p-24 * alpha * neighbor * neighbor / spacing;
}

double mesh_work(double charges, double points, int order) {
  return charges * order * order + points * std::log2(points) / 6;
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
