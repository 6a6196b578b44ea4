#include "forces/charge_mesh.hpp"

#include "engine/column.hpp"
#include "forces/charge_mesh_simd.hpp"
#include "numbers/parallel.hpp"
#include "numbers/wide_sum.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace noether::detail {

namespace {

constexpr double half_turn = 3.141592653589793;
constexpr Index few_points = 4096;  // of a mesh for one thread

std::int64_t padded(std::int64_t size) { return (size + fourier_lines - 1) / fourier_lines * fourier_lines; }

/// Calls `body(task)` for every task below `count`, each by one thread.
template <class Body> void for_tasks(Index count, bool alone, const Body& body) {
  if (alone) {
    for (Index task = 0; task < count; ++task) body(task);
  } else {
    for_blocks(count * block_size, [&](Index begin, Index /*end*/) { body(begin / block_size); });
  }
}

/// Memory to work with, for as many as there are threads.
template <class T> class WorkingRooms {
 public:
  void make(std::size_t size) {
    const auto count = static_cast<std::size_t>(thread_count());
    if (size == size_ && count <= taken_.size()) return;
    size_ = size;
    memory_.resize(size * count);
    taken_ = std::vector<std::atomic<bool>>(count);
  }
  /// Calls `body(room)` with one that nobody else has.
  template <class Body> void with_one(const Body& body) {
    std::size_t k = 0;
    while (taken_[k].exchange(true, std::memory_order_acquire)) k = (k + 1) % taken_.size();
    body(memory_.data() + k * size_);
    taken_[k].store(false, std::memory_order_release);
  }

 private:
  std::size_t size_ = 0;
  AlignedVector<T> memory_;
  std::vector<std::atomic<bool>> taken_;
};

/// A Fourier transform of one length.
template <class T> struct FourierPlan {
  std::vector<int> factors;
  std::vector<T> turns;

  void make(std::int64_t n) {
    factors.clear();
    turns.clear();
    std::int64_t rest = n;
    for (const int radix : {4, 2, 3, 5, 7}) {
      for (; rest % radix == 0; rest /= radix) {
        factors.push_back(radix);
        const std::int64_t length = rest / radix;
        for (std::int64_t k = 1; k < length; ++k) {
          for (std::int64_t b = 1; b < radix; ++b) {
            const double angle = 2 * half_turn * static_cast<double>(b * k) / static_cast<double>(rest);
            turns.push_back(static_cast<T>(std::cos(angle)));
            turns.push_back(static_cast<T>(std::sin(angle)));
          }
        }
      }
    }
  }
  FourierPasses<T> passes() const { return {factors.data(), static_cast<int>(factors.size()), turns.data()}; }
};

/// The coefficients of splines and of their slopes as polynomials of the place beyond the middle of a cell, shape
/// (power, 8): from order n - 1 to n as SplineWeights has it,
///
///     (n - 1) M_n,j(w) = (w + n - 1 - j) M_n-1,j-1 + (j + 1 - w) M_n-1,j,      w = 1/2 + t.
template <class T> struct SplineCoefficients {
  AlignedVector<T> values, slopes;

  void make(int order) {
    std::array<std::array<double, largest_order>, largest_order> now{}, next{};  // [power][j]
    now[0][0] = 1;                                                               // order 1
    for (int n = 2; n <= order; ++n) {
      next = {};
      for (int j = 0; j < n; ++j) {
        for (int m = 0; m < n; ++m) {
          const auto power = static_cast<std::size_t>(m), at = static_cast<std::size_t>(j);
          double sum = 0;
          if (j > 0) sum += (n - j - 0.5) * now[power][at - 1] + (m > 0 ? now[power - 1][at - 1] : 0);
          if (j < n - 1) sum += (j + 0.5) * now[power][at] - (m > 0 ? now[power - 1][at] : 0);
          next[power][at] = sum / (n - 1);
        }
      }
      now = next;
    }
    values.assign(64, 0);
    slopes.assign(64, 0);
    for (std::size_t m = 0; m < 8; ++m) {
      for (std::size_t j = 0; j < 8; ++j) {
        values[8 * m + j] = static_cast<T>(now[m][j]);
        if (m > 0) slopes[8 * (m - 1) + j] = static_cast<T>(static_cast<double>(m) * now[m][j]);
      }
    }
  }
};

/// The wave number that wave m of `points` stands for.
double wave_number(std::int64_t m, std::int64_t points, double edge) {
  return 2 * half_turn * static_cast<double>(2 * m > points ? m - points : m) / edge;
}

/// A spline's largest weight in space.
double largest_weight(int order) {
  double most = 0;
  for (const double w : {0.0, 0.5}) {
    for (const double value : SplineWeights(w, order).value) most = std::max(most, value);
  }
  return most * most * most;
}

const MeshKernels<double>& kernels_of(double /*type*/) { return mesh_kernels(); }
const MeshKernels<float>& kernels_of(float /*type*/) { return mesh_kernels_mixed(); }

}  // namespace

template <class T> struct ChargeMesh<T>::Memory {
  using Whole = typename WholeOf<T>::type;

  MeshLayout layout;
  MeshMemory<T> view{};
  AlignedVector<Whole> counts;
  AlignedVector<T> potential, waves, influence;
  std::array<AlignedVector<double>, 3> wave_numbers, odd_numbers;
  std::array<std::vector<std::ptrdiff_t>, 2> begins;  ///< of planes, of rows of a plane
  std::array<FourierPlan<T>, 3> plans;
  SplineCoefficients<T> splines;
  WorkingRooms<T> rooms;
  std::vector<WaveSums> sums;
  std::vector<double> slopes;  ///< where the charges are
  double size = 0;             ///< an edge of a cube as large as the box [length]
  double field_unit = 0;       ///< of the potential [energy/charge]

  bool alone() const { return thread_count() == 1 || view.nx * view.ny * view.nz < few_points; }
  void lay(const MeshLayout& wanted);
  void lay_memory();
  void lay_influence();
  void count_charges(const ChargeTiles& tiles, double strongest);
  void transform(MeshSums* total, double energy_unit);
  void add_up(MeshSums& total, double energy_unit) const;
};

template <class T> void ChargeMesh<T>::Memory::lay(const MeshLayout& wanted) {
  if (wanted == layout) return;
  const bool other = wanted.points != layout.points || wanted.order != layout.order;
  layout = wanted;
  if (other) lay_memory();
  lay_influence();
}

template <class T> void ChargeMesh<T>::Memory::lay_memory() {
  const auto [nx, ny, nz] = layout.points;
  const std::int64_t beyond = layout.order == 4 ? 3 : 7;  // numbers that a spline takes at once, less one
  view.nx = nx;
  view.ny = ny;
  view.nz = nz;
  view.rows = ny + ny % 2;
  view.row = padded(nz + beyond);
  view.wave_rows = padded(ny);
  view.wave_row = padded(nz);
  const auto points = static_cast<std::size_t>(nx * view.rows * view.row);
  counts.assign(points, 0);
  potential.assign(points, 0);
  waves.assign(static_cast<std::size_t>((nx / 2 + 1) * 2 * view.wave_rows * view.wave_row), 0);
  influence.assign(static_cast<std::size_t>((nx / 2 + 1) * view.wave_rows * nz), 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plans[axis].make(layout.points[axis]);
    wave_numbers[axis].assign(static_cast<std::size_t>(padded(layout.points[axis])), 0);
    odd_numbers[axis] = wave_numbers[axis];
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::int64_t along = layout.points[axis], stride = axis == 0 ? view.rows * view.row : view.row;
    begins[axis].resize(static_cast<std::size_t>(along + layout.order));
    for (std::int64_t k = 0; k < along + layout.order; ++k)
      begins[axis][static_cast<std::size_t>(k)] = k % along * stride;
  }
  splines.make(layout.order);
  sums.resize(static_cast<std::size_t>(nx / 2 + 1));
  view.counts = counts.data();
  view.potential = potential.data();
  view.waves = waves.data();
  view.influence = influence.data();
  view.kx = wave_numbers[0].data();
  view.ky = wave_numbers[1].data();
  view.kz = wave_numbers[2].data();
  view.odd_x = odd_numbers[0].data();
  view.odd_y = odd_numbers[1].data();
  view.odd_z = odd_numbers[2].data();
  view.planes = begins[0].data();
  view.lines = begins[1].data();
  view.values = splines.values.data();
  view.slopes = splines.slopes.data();
  view.x = plans[0].passes();
  view.y = plans[1].passes();
  view.z = plans[2].passes();
}

/// 4 pi exp(-k^2/4 alpha^2) / (k^2 V) over the squares of the splines' sums, times `size`.
template <class T> void ChargeMesh<T>::Memory::lay_influence() {
  const Vec3<double>& edges = layout.edges;
  const double volume = edges[0] * edges[1] * edges[2];
  size = std::cbrt(volume);
  std::array<std::vector<double>, 3> factors;  // the function is a product of three, over k^2
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t points = layout.points[axis];
    factors[axis] = spline_factors(points, layout.order);
    for (std::int64_t m = 0; m < points; ++m) {
      const auto at = static_cast<std::size_t>(m);
      const double k = wave_number(m, points, edges[static_cast<Index>(axis)]);
      wave_numbers[axis][at] = k;
      odd_numbers[axis][at] = 2 * m == points ? 0 : k;
      factors[axis][at] *= std::exp(-k * k / (4 * layout.alpha * layout.alpha));
    }
  }
  const double factor = 4 * half_turn * size / volume;
  for_tasks(view.nx / 2 + 1, alone(), [&](Index plane) {
    const double kx = view.kx[plane], by_x = factor * factors[0][static_cast<std::size_t>(plane)];
    for (Index y = 0; y < view.ny; ++y) {
      const double ky = view.ky[y], by_y = by_x * factors[1][static_cast<std::size_t>(y)];
      T* const row = influence.data() + (plane * view.wave_rows + y / fourier_lines * fourier_lines) * view.nz;
      for (Index z = 0; z < view.nz; ++z) {
        const double kz = view.kz[z], k2 = kx * kx + ky * ky + kz * kz;
        row[z * fourier_lines + y % fourier_lines] =
            static_cast<T>(k2 == 0 ? 0 : by_y * factors[2][static_cast<std::size_t>(z)] / k2);
      }
    }
  });
}

template <class T> void ChargeMesh<T>::Memory::count_charges(const ChargeTiles& tiles, double strongest) {
  // The sum at a point is below 2^62 (2^30) units, and each part of it below 2^51 (2^22), which are exact.
  constexpr int most_bits = std::numeric_limits<Whole>::digits - 1, part_bits = std::numeric_limits<T>::digits - 2;
  const double part = strongest * largest_weight(layout.order);
  const double sum = part * static_cast<double>(tiles.most_together());
  const double unit =
      std::max(std::ldexp(1.0, std::ilogb(sum) + 1 - most_bits), std::ldexp(1.0, std::ilogb(part) + 1 - part_bits));
  view.counts_in_one = 1 / unit;
  view.half_count = static_cast<T>(unit / std::ldexp(2.0, std::ilogb(strongest)));
  const auto spread = kernels_of(T()).spread[layout.order - least_order];
  const Index nx = tiles.tiles()[0], ny = tiles.tiles()[1];
  const auto spread_tile = [&](Index tile) {
    spread(view, tiles.places() + tiles.begin(tile), tiles.begin(tile + 1) - tiles.begin(tile));
  };
  if (alone()) {
    for_tasks(nx * ny, true, spread_tile);
    return;
  }
  const Index colors_x = std::min<Index>(nx, 2), colors_y = std::min<Index>(ny, 2);
  for (Index color = 0; color < colors_x * colors_y; ++color) {  // tiles of one color have no point in common
    const Index from_x = color / colors_y, from_y = color % colors_y, lines = ny / colors_y;
    for_tasks(nx / colors_x * lines, false,
              [&](Index k) { spread_tile((from_x + colors_x * (k / lines)) * ny + from_y + colors_y * (k % lines)); });
  }
}

template <class T> void ChargeMesh<T>::Memory::transform(MeshSums* total, double energy_unit) {
  const MeshKernels<T>& kernels = kernels_of(T());
  const std::int64_t longest = *std::max_element(layout.points.begin(), layout.points.end());
  rooms.make(static_cast<std::size_t>(6 * fourier_lines * longest));
  const bool one = alone();
  for_tasks(view.rows / 2, one,
            [&](Index pair) { rooms.with_one([&](T* room) { kernels.forward(view, pair, room); }); });
  const double inverse = 1 / (2 * layout.alpha * layout.alpha);
  for_tasks(view.nx / 2 + 1, one, [&](Index plane) {
    rooms.with_one([&](T* room) {
      if (total != nullptr) {
        kernels.waves_and_sums(view, plane, room, inverse, sums[static_cast<std::size_t>(plane)]);
      } else {
        kernels.waves(view, plane, room);
      }
    });
  });
  for_tasks(view.rows / 2, one,
            [&](Index pair) { rooms.with_one([&](T* room) { kernels.backward(view, pair, room); }); });
  if (total != nullptr) add_up(*total, energy_unit);
}

template <class T> void ChargeMesh<T>::Memory::add_up(MeshSums& total, double energy_unit) const {
  WideSum<double> energy;
  std::array<WideSum<double>, 6> moments;
  for (std::int64_t plane = 0; plane <= view.nx / 2; ++plane) {
    const WaveSums& of = sums[static_cast<std::size_t>(plane)];
    const double both = plane == 0 || 2 * plane == view.nx ? 0.5 : 1;  // a wave and its opposite
    energy += both * of.energy;
    for (std::size_t k = 0; k < 6; ++k) moments[k] += both * of.moments[k];
  }
  total.energy = energy_unit * energy.value();
  const auto moment = [&](std::size_t k) { return energy_unit * moments[k].value(); };
  total.virial << total.energy - moment(0), -moment(3), -moment(4),  //
      -moment(3), total.energy - moment(1), -moment(5),              //
      -moment(4), -moment(5), total.energy - moment(2);
}

template <class T> ChargeMesh<T>::ChargeMesh() : memory_(std::make_unique<Memory>()) {}
template <class T> ChargeMesh<T>::ChargeMesh(ChargeMesh&& other) noexcept = default;
template <class T> ChargeMesh<T>& ChargeMesh<T>::operator=(ChargeMesh&& other) noexcept = default;
template <class T> ChargeMesh<T>::~ChargeMesh() = default;

template <class T> void ChargeMesh<T>::lay(const MeshLayout& layout) { memory_->lay(layout); }

template <class T>
void ChargeMesh<T>::solve(const ChargeTiles& tiles, double strongest, double coulomb_constant, MeshSums* sums) {
  Memory& own = *memory_;
  own.count_charges(tiles, strongest);
  const double charge = std::ldexp(1.0, std::ilogb(strongest));
  own.field_unit = coulomb_constant * charge / own.size;
  own.transform(sums, own.field_unit * charge);
}

template <class T>
void ChargeMesh<T>::add_accelerations(VectorColumn<double>& a, const ParticleSystem<double>& s,
                                      const ChargeTiles& tiles) {
  Memory& own = *memory_;
  own.slopes.resize(static_cast<std::size_t>(3 * tiles.size()));
  double* const all = own.slopes.data();
  const auto slopes = kernels_of(T()).slopes[own.layout.order - least_order];
  for_blocks(tiles.size(),
             [&](Index begin, Index end) { slopes(own.view, tiles.places() + begin, end - begin, all + 3 * begin); });
  double scale[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto points = static_cast<double>(own.layout.points[static_cast<std::size_t>(axis)]);
    scale[axis] = -own.field_unit * points / own.layout.edges[axis];
  }
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Index at = tiles.place_of(i);
      if (at < 0 || s.masses()[i] == 0) continue;
      const double by = tiles.places()[at].charge / s.masses()[i];
      const double* const felt = all + 3 * at;
      a.add(i, Vec3<double>(by * (scale[0] * felt[0]), by * (scale[1] * felt[1]), by * (scale[2] * felt[2])));
    }
  });
}

template class ChargeMesh<double>;
template class ChargeMesh<float>;

}  // namespace noether::detail
