#include "forces/grid_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace noether {

namespace {

constexpr std::size_t taken_places = 6;  // places along an axis that a value between two of them takes

/// Weights of six places for a value and its slope, at the part u in [0, 1] of the way from the third to the fourth.
template <class Number> struct Weights { std::array<Number, taken_places> value{}, slope{}; };

template <class Number> Weights<Number> weights_at(const Number& u) {
  // Hermite's cubic of two values and two slopes, and these as differences of fourth order.
  constexpr std::array<double, 5> difference = {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12};
  const Number one(1), two(2), six(6), v = one - u;
  const std::array<Number, 4> h = {v * v * (one + two * u), u * u * (one + two * v), u * v * v, -u * u * v};
  const std::array<Number, 4> d = {-six * u * v, six * u * v, v * (v - two * u), u * (u - two * v)};
  Weights<Number> w;
  w.value[2] = h[0];
  w.value[3] = h[1];
  w.slope[2] = d[0];
  w.slope[3] = d[1];
  for (std::size_t k = 0; k < difference.size(); ++k) {
    const Number weight(difference[k]);
    w.value[k] += h[2] * weight;
    w.slope[k] += d[2] * weight;
    w.value[k + 1] += h[3] * weight;
    w.slope[k + 1] += d[3] * weight;
  }
  return w;
}

/// A value and its slopes along x, y and z.
template <class Number> struct Sloped {
  Number value = Number(0);
  std::array<Number, 3> slope{};
};

/// Where a place lies: the first of its six along each axis, and their weights.
template <class Number> struct Cell {
  std::array<Index, 3> first{};
  std::array<Weights<Number>, 3> weights;
};

/// Component `c` of `width` in values on a grid.
template <class Number>
Sloped<Number> between(const FieldGrid& grid, const std::vector<double>& values, std::size_t width, std::size_t c,
                       const Cell<Number>& cell) {
  const auto ny = static_cast<std::size_t>(grid.counts[1]), nz = static_cast<std::size_t>(grid.counts[2]);
  const auto i0 = static_cast<std::size_t>(cell.first[0]), j0 = static_cast<std::size_t>(cell.first[1]),
             k0 = static_cast<std::size_t>(cell.first[2]);
  const auto& [wx, wy, wz] = cell.weights;
  Sloped<Number> all;
  for (std::size_t i = 0; i < taken_places; ++i) {
    Number plane(0), by_y(0), by_z(0);
    for (std::size_t j = 0; j < taken_places; ++j) {
      Number row(0), along(0);
      for (std::size_t k = 0; k < taken_places; ++k) {
        const Number here(values[(((i0 + i) * ny + j0 + j) * nz + k0 + k) * width + c]);
        row += wz.value[k] * here;
        along += wz.slope[k] * here;
      }
      plane += wy.value[j] * row;
      by_y += wy.slope[j] * row;
      by_z += wy.value[j] * along;
    }
    all.value += wx.value[i] * plane;
    all.slope[0] += wx.slope[i] * plane;
    all.slope[1] += wx.value[i] * by_y;
    all.slope[2] += wx.value[i] * by_z;
  }
  for (std::size_t k = 0; k < 3; ++k) all.slope[k] /= Number(grid.spacing[k]);
  return all;
}

double plain(double x) { return x; }
double plain(const Dual<double, 1>& x) { return x.value; }

/// The cell that x lies in, or the nearest that is known.
template <class Number> Cell<Number> cell_at(const FieldGrid& grid, const Vec3<Number>& x) {
  Cell<Number> cell;
  for (std::size_t k = 0; k < 3; ++k) {
    const Number place = (x[static_cast<Index>(k)] - Number(grid.origin[k])) / Number(grid.spacing[k]);
    const auto last = static_cast<double>(grid.counts[k] - 4);
    const double within = std::clamp(std::floor(plain(place)), 2.0, last),
                 low = within >= 2 ? within : 2;  // a NaN is none
    cell.first[k] = static_cast<Index>(low) - 2;
    cell.weights[k] = weights_at<Number>(place - Number(low));
  }
  return cell;
}

std::uint64_t hash_of(std::uint64_t hash, const void* bytes, std::size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ at[k]) * 1099511628211ULL;
  return hash;
}

}  // namespace

void FieldGrid::check() const {
  for (std::size_t k = 0; k < 3; ++k) {
    if (counts[k] < 6) {
      throw Error(fmt::format("a grid of {} x {} x {} places is too small; six or more along each axis are expected",
                              counts[0], counts[1], counts[2]));
    }
    if (!(spacing[k] > 0)) throw Error(fmt::format("a spacing of {} is not a length above 0", spacing[k]));
  }
  const auto places = static_cast<std::size_t>(counts[0] * counts[1] * counts[2]);
  if (!A.empty() && !B.empty()) throw Error("a grid has either A or B; take one of the two out");
  if (A.empty() && B.empty() && phi.empty()) throw Error("a grid has no values; give A, B or phi");
  const std::vector<double>& vectors = A.empty() ? B : A;
  if ((!vectors.empty() && vectors.size() != 3 * places) || (!phi.empty() && phi.size() != places)) {
    throw Error(fmt::format("a grid of {} x {} x {} places has {} numbers of {} and {} of phi", counts[0], counts[1],
                            counts[2], vectors.size(), A.empty() ? "B" : "A", phi.size()));
  }
  for (const std::vector<double>* list : {&A, &B, &phi}) {
    if (!std::all_of(list->begin(), list->end(), [](double value) { return std::isfinite(value); })) {
      throw Error("a value of the grid is not finite");
    }
  }
}

std::uint64_t FieldGrid::fingerprint() const {
  if (known_fingerprint != 0) return known_fingerprint;
  std::uint64_t hash = 14695981039346656037ULL;
  hash = hash_of(hash, counts.data(), sizeof(counts));
  hash = hash_of(hash, origin.data(), sizeof(origin));
  hash = hash_of(hash, spacing.data(), sizeof(spacing));
  for (const std::vector<double>* list : {&A, &B, &phi}) {
    hash = hash_of(hash, list->data(), list->size() * sizeof(double));
  }
  return known_fingerprint = hash;
}

std::string GridField::signature() const {
  return fmt::format("field_grid(values {:016x})", grid != nullptr ? grid->fingerprint() : 0);
}

void GridField::expect_values() const {
  if (grid == nullptr) throw Error("a field_grid has no grid; give it one, or a file in a scene");
  grid->check();
}

bool GridField::covers(const Vec3<double>& x) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const double place = (x[static_cast<Index>(k)] - grid->origin[k]) / grid->spacing[k];
    if (!(place >= 2 && place <= static_cast<double>(grid->counts[k] - 3))) return false;
  }
  return true;
}

double GridField::divergence() const {
  if (grid->B.empty()) return 0;
  double largest = 0, strongest = 0;
  const auto cells = static_cast<double>(grid->counts[0] * grid->counts[1] * grid->counts[2]);
  const auto stride = std::max(Index{1}, static_cast<Index>(std::lround(std::cbrt(cells / 1e5))));
  for (Index i = 2; i + 3 < grid->counts[0]; i += stride) {
    for (Index j = 2; j + 3 < grid->counts[1]; j += stride) {
      for (Index k = 2; k + 3 < grid->counts[2]; k += stride) {
        const std::array<Index, 3> low = {i, j, k};
        Vec3<double> x;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          x[static_cast<Index>(axis)] =
              grid->origin[axis] + (static_cast<double>(low[axis]) + 0.5) * grid->spacing[axis];
        }
        const Cell<double> cell = cell_at(*grid, x);
        double divergence = 0, strength = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const Sloped<double> B = between(*grid, grid->B, 3, c, cell);
          divergence += B.slope[c] * grid->spacing[c];
          strength += B.value * B.value;
        }
        largest = std::max(largest, std::abs(divergence));
        strongest = std::max(strongest, std::sqrt(strength));
      }
    }
  }
  return strongest > 0 ? largest / strongest : 0;
}

template <class Number> void GridField::interpolate(const Vec3<Number>& x, FieldValues<Number>& field) const {
  const Cell<Number> cell = cell_at(*grid, x);
  if (!grid->A.empty()) {
    std::array<Sloped<Number>, 3> A;
    for (std::size_t c = 0; c < 3; ++c) A[c] = between(*grid, grid->A, 3, c, cell);
    field.A = Vec3<Number>(A[0].value, A[1].value, A[2].value);
    field.B = Vec3<Number>(A[2].slope[1] - A[1].slope[2], A[0].slope[2] - A[2].slope[0], A[1].slope[0] - A[0].slope[1]);
  } else if (!grid->B.empty()) {
    for (std::size_t c = 0; c < 3; ++c) field.B[static_cast<Index>(c)] = between(*grid, grid->B, 3, c, cell).value;
  }
  if (grid->phi.empty()) return;
  const Sloped<Number> phi = between(*grid, grid->phi, 1, 0, cell);
  field.phi = phi.value;
  field.E = -Vec3<Number>(phi.slope[0], phi.slope[1], phi.slope[2]);
}

template void GridField::interpolate(const Vec3<double>&, FieldValues<double>&) const;
template void GridField::interpolate(const Vec3<Dual<double, 1>>&, FieldValues<Dual<double, 1>>&) const;
template struct detail::ForceModel<InField<GridField>, double>;

}  // namespace noether
