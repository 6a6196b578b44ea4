#include "forces/charge_mesh.hpp"

#include "numbers/parallel.hpp"
#include "numbers/wide_sum.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#define POCKETFFT_NO_MULTITHREADING
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <third_party/pocketfft/pocketfft_hdronly.h>
#pragma GCC diagnostic pop

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

/// 1 / |sum_j M(j + 1) exp(2 pi i m j / points)|^2, for m from 0 to points - 1; 0 where the sum is.
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

/// m, or the negative number that it stands for.
double signed_wave(std::int64_t m, std::int64_t points) { return static_cast<double>(2 * m > points ? m - points : m); }

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

Vec3<double> ChargeMesh::wave(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return {2 * half_circle * signed_wave(x, layout_.points[0]) / layout_.edges[0],
          2 * half_circle * signed_wave(y, layout_.points[1]) / layout_.edges[1],
          2 * half_circle * signed_wave(z, layout_.points[2]) / layout_.edges[2]};
}

void ChargeMesh::lay(const MeshLayout& layout) {
  if (layout == layout_) return;
  layout_ = layout;
  const auto [nx, ny, nz] = layout.points;
  const std::int64_t half = nz / 2 + 1;
  charges_.resize(static_cast<std::size_t>(nx * ny * nz));
  field_.resize(charges_.size());
  waves_.resize(static_cast<std::size_t>(nx * ny * half));
  influence_.resize(waves_.size());
  const std::vector<double> bx = spline_factors(nx, layout.order), by = spline_factors(ny, layout.order),
                            bz = spline_factors(nz, layout.order);
  const double factor =
      4 * half_circle * layout.coulomb_constant / (layout.edges[0] * layout.edges[1] * layout.edges[2]);
  for (std::int64_t row = 0; row < nx * ny; ++row) {
    for (std::int64_t z = 0; z < half; ++z) {
      const double k2 = norm2(wave(row / ny, row % ny, z));
      const double b = bx[static_cast<std::size_t>(row / ny)] * by[static_cast<std::size_t>(row % ny)] *
                       bz[static_cast<std::size_t>(z)];
      influence_[static_cast<std::size_t>(row * half + z)] =
          k2 == 0 ? 0 : factor * b * std::exp(-k2 / (4 * layout.alpha * layout.alpha)) / k2;
    }
  }
}

ChargeMesh::Place ChargeMesh::place_of(const Vec3<double>& x) const {
  std::array<double, 3> beyond{};
  std::array<std::array<std::int64_t, largest_order>, 3> points{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    const double u = x[axis] / layout_.edges[axis] * static_cast<double>(layout_.points[k]);
    const auto cell = static_cast<std::int64_t>(u);
    beyond[k] = u - static_cast<double>(cell);
    for (std::size_t j = 0; j < static_cast<std::size_t>(layout_.order); ++j)
      points[k][j] = (cell + static_cast<std::int64_t>(j)) % layout_.points[k];
  }
  const int order = layout_.order;
  return {points, {SplineWeights(beyond[0], order), SplineWeights(beyond[1], order), SplineWeights(beyond[2], order)}};
}

void ChargeMesh::spread(const ParticleSystem<double>& s, const double* charges, double unit) {
  unit_ = unit;
  std::fill(charges_.begin(), charges_.end(), 0);
  const bool alone = thread_count() == 1 || s.size() < parallel_threshold;
  const auto order = static_cast<std::size_t>(layout_.order);
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (charges[i] == 0) continue;
      const Place place = place_of(s.positions()[i]);
      const double whole = charges[i] / unit;
      for (std::size_t a = 0; a < order; ++a) {
        for (std::size_t b = 0; b < order; ++b) {
          const double here = whole * place.weights[0].value[a] * place.weights[1].value[b];
          std::int64_t* const row =
              charges_.data() + (place.points[0][a] * layout_.points[1] + place.points[1][b]) * layout_.points[2];
          for (std::size_t c = 0; c < order; ++c) {
            const auto part = static_cast<std::int64_t>(here * place.weights[2].value[c]);
            std::int64_t& point = row[place.points[2][c]];
            if (alone) {
              point += part;
            } else {  // whole numbers have one sum in any order
              std::atomic_ref<std::int64_t>(point).fetch_add(part, std::memory_order_relaxed);
            }
          }
        }
      }
    }
  });
}

void ChargeMesh::solve(bool sums) {
  const auto size = static_cast<Index>(charges_.size());
  for_blocks(size, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const auto at = static_cast<std::size_t>(k);
      field_[at] = unit_ * static_cast<double>(charges_[at]);
    }
  });
  const auto [nx, ny, nz] = layout_.points;
  const pocketfft::shape_t shape = {static_cast<std::size_t>(nx), static_cast<std::size_t>(ny),
                                    static_cast<std::size_t>(nz)};
  constexpr std::ptrdiff_t one = sizeof(double), pair = 2 * one;
  const std::ptrdiff_t half = nz / 2 + 1;
  const pocketfft::stride_t of_field = {ny * nz * one, nz * one, one}, of_waves = {ny * half * pair, half * pair, pair};
  const pocketfft::shape_t axes = {0, 1, 2};
  pocketfft::r2c(shape, of_field, of_waves, axes, true, field_.data(), waves_.data(), 1.0, 1);
  if (sums) add_up();
  for_blocks(static_cast<Index>(waves_.size()), [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) waves_[static_cast<std::size_t>(k)] *= influence_[static_cast<std::size_t>(k)];
  });
  pocketfft::c2r(shape, of_waves, of_field, axes, false, waves_.data(), field_.data(), 1.0, 1);
}

void ChargeMesh::add_up() {
  struct Totals {
    WideSum<double> energy;
    WideTensor<double> virial;
    Totals& operator+=(const Totals& other) {
      energy += other.energy;
      virial += other.virial;
      return *this;
    }
  };
  const auto [nx, ny, nz] = layout_.points;
  const std::int64_t half = nz / 2 + 1, rows_y = ny, points_z = nz;
  const Totals totals = reduce(static_cast<Index>(nx * ny), Totals{}, [&](Index begin, Index end) {
    Totals block;
    for (Index row = begin; row < end; ++row) {
      for (std::int64_t z = 0; z < half; ++z) {
        const auto at = static_cast<std::size_t>(row * half + z);
        if (influence_[at] == 0) continue;
        const double both = z == 0 || 2 * z == points_z ? 0.5 : 1;  // a wave and its opposite
        const double energy = both * influence_[at] * std::norm(waves_[at]);
        const Vec3<double> k = wave(row / rows_y, row % rows_y, z);
        const double by = 2 * (1 / norm2(k) + 1 / (4 * layout_.alpha * layout_.alpha));
        block.energy += energy;
        block.virial += Mat3<double>(energy * (Mat3<double>::Identity() - by * k * k.transpose()));
      }
    }
    return block;
  });
  energy_ = totals.energy.value();
  virial_ = totals.virial.value();
}

Vec3<double> ChargeMesh::slope_at(const Vec3<double>& x) const {
  const Place place = place_of(x);
  const auto order = static_cast<std::size_t>(layout_.order);
  double sum[3] = {0, 0, 0};
  for (std::size_t a = 0; a < order; ++a) {
    for (std::size_t b = 0; b < order; ++b) {
      const double* const row =
          field_.data() + (place.points[0][a] * layout_.points[1] + place.points[1][b]) * layout_.points[2];
      double value = 0, slope = 0;
      for (std::size_t c = 0; c < order; ++c) {
        const double potential = row[place.points[2][c]];
        value += potential * place.weights[2].value[c];
        slope += potential * place.weights[2].slope[c];
      }
      sum[0] += place.weights[0].slope[a] * place.weights[1].value[b] * value;
      sum[1] += place.weights[0].value[a] * place.weights[1].slope[b] * value;
      sum[2] += place.weights[0].value[a] * place.weights[1].value[b] * slope;
    }
  }
  Vec3<double> slopes;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Index>(k);
    slopes[axis] = sum[k] * static_cast<double>(layout_.points[k]) / layout_.edges[axis];
  }
  return slopes;
}

}  // namespace noether::detail
