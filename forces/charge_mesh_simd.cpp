#include "forces/charge_mesh_simd.hpp"

#include "forces/fourier_simd.hpp"

#include <type_traits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

// --- splines ---------------------------------------------------------------------------------------------------------

/// What belongs to splines of one order: their weights fill `width` lanes, those beyond the order are 0.
template <class T, int order> struct Spline {
  static constexpr int width = order == 4 ? 4 : 8;
  using Tag = hn::CappedTag<T, width>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag())), parts = width / lanes;
  using Vector = hn::Vec<Tag>;

  /// sum_m coefficient_m t^m, m < count.
  template <int count> static HWY_INLINE void at(const T* coefficients, T t, Vector (&weights)[parts]) {
    const Tag d;
    const Vector place = hn::Set(d, t);
    for (int p = 0; p < parts; ++p) {
      weights[p] = hn::Load(d, coefficients + (count - 1) * 8 + p * lanes);
      for (int m = count - 2; m >= 0; --m)
        weights[p] = hn::MulAdd(weights[p], place, hn::Load(d, coefficients + m * 8 + p * lanes));
    }
  }
  static HWY_INLINE void keep(const Vector (&weights)[parts], T* memory) {
    for (int p = 0; p < parts; ++p) hn::Store(weights[p], Tag(), memory + p * lanes);
  }
};

/// A particle's point of the mesh, and how far it is beyond the middle of a cell.
template <class T> struct Cell {
  std::ptrdiff_t x, y, z;
  T tx, ty, tz;

  Cell(const MeshPlace& place)
      : x(static_cast<std::ptrdiff_t>(place.x)),
        y(static_cast<std::ptrdiff_t>(place.y)),
        z(static_cast<std::ptrdiff_t>(place.z)),
        tx(static_cast<T>(place.x - (static_cast<double>(x) + 0.5))),
        ty(static_cast<T>(place.y - (static_cast<double>(y) + 0.5))),
        tz(static_cast<T>(place.z - (static_cast<double>(z) + 0.5))) {}
};

/// Numbers near 1.5 times 2^52 (or 2^23) end with a whole number in their bits.
template <class T>
constexpr T whole_bits = sizeof(T) == 8 ? static_cast<T>(6755399441055744.0) : static_cast<T>(12582912.0);

template <class T, int order> void spread(const MeshMemory<T>& mesh, const MeshPlace* places, std::ptrdiff_t count) {
  using S = Spline<T, order>;
  const typename S::Tag d;
  const hn::RebindToSigned<typename S::Tag> whole;
  const auto bits = hn::Set(d, whole_bits<T>);
  const auto zero = hn::BitCast(whole, bits);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Cell<T> cell(places[i]);
    typename S::Vector weights[S::parts];
    HWY_ALIGN T x[8];
    HWY_ALIGN T y[8];
    S::template at<order>(mesh.values, cell.tx, weights);
    S::keep(weights, x);
    S::template at<order>(mesh.values, cell.ty, weights);
    S::keep(weights, y);
    S::template at<order>(mesh.values, cell.tz, weights);
    const auto charge = hn::Set(d, static_cast<T>(places[i].charge * mesh.counts_in_one));
    for (int p = 0; p < S::parts; ++p) weights[p] = hn::Mul(weights[p], charge);
    for (int a = 0; a < order; ++a) {
      auto* const plane = mesh.counts + mesh.planes[cell.x + a] + cell.z;
      typename S::Vector here[S::parts];
      for (int p = 0; p < S::parts; ++p) here[p] = hn::Mul(weights[p], hn::Set(d, x[a]));
      for (int b = 0; b < order; ++b) {
        auto* const row = plane + mesh.lines[cell.y + b];
        const auto along = hn::Set(d, y[b]);
        for (int p = 0; p < S::parts; ++p) {
          const auto part = hn::Sub(hn::BitCast(whole, hn::MulAdd(here[p], along, bits)), zero);
          hn::StoreU(hn::Add(hn::LoadU(whole, row + p * S::lanes), part), whole, row + p * S::lanes);
        }
      }
    }
  }
}

template <class T, int order>
void slopes(const MeshMemory<T>& mesh, const MeshPlace* places, std::ptrdiff_t count, double* slopes) {
  using S = Spline<T, order>;
  using Vector = typename S::Vector;
  const typename S::Tag d;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Cell<T> cell(places[i]);
    Vector z[S::parts], dz[S::parts];
    HWY_ALIGN T x[8];
    HWY_ALIGN T dx[8];
    HWY_ALIGN T y[8];
    HWY_ALIGN T dy[8];
    S::template at<order>(mesh.values, cell.tx, z);
    S::keep(z, x);
    S::template at<order - 1>(mesh.slopes, cell.tx, z);
    S::keep(z, dx);
    S::template at<order>(mesh.values, cell.ty, z);
    S::keep(z, y);
    S::template at<order - 1>(mesh.slopes, cell.ty, z);
    S::keep(z, dy);
    S::template at<order>(mesh.values, cell.tz, z);
    S::template at<order - 1>(mesh.slopes, cell.tz, dz);
    Vector along_x[S::parts], along_y[S::parts], value[S::parts];
    for (int p = 0; p < S::parts; ++p) along_x[p] = along_y[p] = value[p] = hn::Zero(d);
    for (int a = 0; a < order; ++a) {
      const T* const plane = mesh.potential + mesh.planes[cell.x + a] + cell.z;
      Vector sum[S::parts], slope[S::parts];
      for (int p = 0; p < S::parts; ++p) sum[p] = slope[p] = hn::Zero(d);
      for (int b = 0; b < order; ++b) {
        const T* const row = plane + mesh.lines[cell.y + b];
        for (int p = 0; p < S::parts; ++p) {
          const Vector points = hn::LoadU(d, row + p * S::lanes);
          sum[p] = hn::MulAdd(points, hn::Set(d, y[b]), sum[p]);
          slope[p] = hn::MulAdd(points, hn::Set(d, dy[b]), slope[p]);
        }
      }
      for (int p = 0; p < S::parts; ++p) {
        along_x[p] = hn::MulAdd(sum[p], hn::Set(d, dx[a]), along_x[p]);
        along_y[p] = hn::MulAdd(slope[p], hn::Set(d, x[a]), along_y[p]);
        value[p] = hn::MulAdd(sum[p], hn::Set(d, x[a]), value[p]);
      }
    }
    Vector sums[3] = {hn::Mul(along_x[0], z[0]), hn::Mul(along_y[0], z[0]), hn::Mul(value[0], dz[0])};
    for (int p = 1; p < S::parts; ++p) {
      sums[0] = hn::MulAdd(along_x[p], z[p], sums[0]);
      sums[1] = hn::MulAdd(along_y[p], z[p], sums[1]);
      sums[2] = hn::MulAdd(value[p], dz[p], sums[2]);
    }
    for (int k = 0; k < 3; ++k) slopes[3 * i + k] = static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sums[k])));
  }
}

// --- transforms ------------------------------------------------------------------------------------------------------

/// Counts of two rows of every plane, as charges.
template <class T> struct CountLines {
  const typename WholeOf<T>::type *re, *im;
  std::ptrdiff_t stride;
  T one;

  HWY_INLINE ComplexLanes<T> get(std::ptrdiff_t k) const {
    const FourierTag<T> d;
    const hn::RebindToSigned<FourierTag<T>> whole;
    const auto unit = hn::Set(d, one);
    return {hn::Mul(hn::ConvertTo(d, hn::LoadU(whole, re + k * stride)), unit),
            hn::Mul(hn::ConvertTo(d, hn::LoadU(whole, im + k * stride)), unit)};
  }
};

/// Part b, 0 real and 1 imaginary, of the waves of a row.
template <class T> T* wave_row(const MeshMemory<T>& mesh, std::ptrdiff_t plane, int part, std::ptrdiff_t row) {
  return mesh.waves + ((2 * plane + part) * mesh.wave_rows + row) * mesh.wave_row;
}

template <class T> void forward(const MeshMemory<T>& mesh, std::ptrdiff_t pair, T* scratch) {
  const FourierTag<T> d;
  const std::ptrdiff_t n = mesh.nx, lanes = lines_at_once<T>, plane = mesh.rows * mesh.row;
  auto* const counts = mesh.counts + 2 * pair * mesh.row;
  for (std::ptrdiff_t x = 0; x < n; ++x) {  // points beyond the end of a row are those of its begin
    for (int r = 0; r < 2; ++r) {
      auto* const row = counts + x * plane + r * mesh.row;
      for (std::ptrdiff_t z = mesh.nz; z < mesh.row; ++z) row[z % mesh.nz] += row[z];
    }
  }
  T* const transformed = scratch + 4 * lanes * n;
  const FourierLines<T> lines = buffered<T>(transformed);
  for (std::ptrdiff_t z = 0; z < mesh.wave_row; z += lanes) {
    const CountLines<T> from{counts + z, counts + z + mesh.row, plane, mesh.half_count};
    fourier<T>(mesh.x, n, from, lines, scratch);
    for (std::ptrdiff_t k = 0; k <= n / 2; ++k) {  // twice the waves of both rows
      const ComplexLanes<T> a = lines.get(k), b = lines.get(k == 0 ? 0 : n - k);
      T* const re = wave_row(mesh, k, 0, 2 * pair) + z;
      T* const im = wave_row(mesh, k, 1, 2 * pair) + z;
      hn::StoreU(hn::Add(a.re, b.re), d, re);
      hn::StoreU(hn::Sub(a.im, b.im), d, im);
      hn::StoreU(hn::Add(a.im, b.im), d, re + mesh.wave_row);
      hn::StoreU(hn::Sub(b.re, a.re), d, im + mesh.wave_row);
    }
  }
  const hn::RebindToSigned<FourierTag<T>> whole;
  for (std::ptrdiff_t x = 0; x < n; ++x) {
    for (std::ptrdiff_t z = 0; z < 2 * mesh.row; z += lanes) hn::StoreU(hn::Zero(whole), whole, counts + x * plane + z);
  }
}

template <class T> void backward(const MeshMemory<T>& mesh, std::ptrdiff_t pair, T* scratch) {
  const FourierTag<T> d;
  const std::ptrdiff_t n = mesh.nx, lanes = lines_at_once<T>, plane = mesh.rows * mesh.row;
  T* const potential = mesh.potential + 2 * pair * mesh.row;
  const FourierLines<T> lines = buffered<T>(scratch + 4 * lanes * n);
  for (std::ptrdiff_t z = 0; z < mesh.wave_row; z += lanes) {
    for (std::ptrdiff_t k = 0; k <= n / 2; ++k) {
      const T* const re = wave_row(mesh, k, 0, 2 * pair) + z;
      const T* const im = wave_row(mesh, k, 1, 2 * pair) + z;
      const auto a_re = hn::LoadU(d, re), a_im = hn::LoadU(d, im);
      const auto b_re = hn::LoadU(d, re + mesh.wave_row), b_im = hn::LoadU(d, im + mesh.wave_row);
      if (k > 0) lines.put(n - k, {hn::Add(a_re, b_im), hn::Sub(b_re, a_im)});
      lines.put(k, {hn::Sub(a_re, b_im), hn::Add(a_im, b_re)});
    }
    const FourierLines<T> to{potential + z, potential + z + mesh.row, plane};
    fourier<T>(mesh.x, n, lines.exchanged(), to.exchanged(), scratch);
  }
  for (std::ptrdiff_t x = 0; x < n; ++x) {
    for (int r = 0; r < 2; ++r) {
      T* const row = potential + x * plane + r * mesh.row;
      for (std::ptrdiff_t z = mesh.nz; z < mesh.row; ++z) row[z] = row[z % mesh.nz];
    }
  }
}

/// What is to be added up over a plane of waves, in the lanes of ky.
struct PlaneSums {
  FourierVector<double> energy, moments[6];

  PlaneSums() {
    energy = hn::Zero(FourierTag<double>());
    for (auto& moment : moments) moment = energy;
  }
  HWY_INLINE void add(const MeshMemory<double>& mesh, std::ptrdiff_t plane, std::ptrdiff_t y, std::ptrdiff_t z,
                      FourierVector<double> e, double inverse) {
    const FourierTag<double> d;
    const auto kx = hn::Set(d, mesh.kx[plane]), ky = hn::LoadU(d, mesh.ky + y), kz = hn::Set(d, mesh.kz[z]);
    const auto k2 = hn::MulAdd(kx, kx, hn::MulAdd(ky, ky, hn::Mul(kz, kz)));
    const auto over = hn::IfThenElseZero(hn::Gt(k2, hn::Zero(d)), hn::Div(hn::Set(d, 2.0), k2));
    energy = hn::Add(energy, e);
    const auto weight = hn::Mul(e, hn::Add(over, hn::Set(d, inverse)));
    const auto odd_x = hn::Mul(weight, hn::Set(d, mesh.odd_x[plane])), odd_y = hn::LoadU(d, mesh.odd_y + y);
    const auto odd_z = hn::Set(d, mesh.odd_z[z]);
    moments[0] = hn::MulAdd(hn::Mul(weight, kx), kx, moments[0]);
    moments[1] = hn::MulAdd(hn::Mul(weight, ky), ky, moments[1]);
    moments[2] = hn::MulAdd(hn::Mul(weight, kz), kz, moments[2]);
    moments[3] = hn::MulAdd(odd_x, odd_y, moments[3]);
    moments[4] = hn::MulAdd(odd_x, odd_z, moments[4]);
    moments[5] = hn::MulAdd(hn::Mul(weight, odd_y), odd_z, moments[5]);
  }
  void total(WaveSums& sums) const {
    const FourierTag<double> d;
    sums.energy = hn::GetLane(hn::SumOfLanes(d, energy));
    for (int k = 0; k < 6; ++k) sums.moments[k] = hn::GetLane(hn::SumOfLanes(d, moments[k]));
  }
};

/// Rows of waves along z, times the influence, and back.
template <class T, class Sums>
HWY_INLINE void turn_rows(const MeshMemory<T>& mesh, std::ptrdiff_t plane, T* scratch, double inverse, Sums& sums) {
  const FourierTag<T> d;
  const std::ptrdiff_t n = mesh.nz, lanes = lines_at_once<T>;
  T* const buffer = scratch + 4 * lanes * n;
  const FourierLines<T> lines = buffered<T>(buffer);
  for (std::ptrdiff_t y = 0; y < mesh.wave_rows; y += lanes) {
    T* const re = wave_row(mesh, plane, 0, y);
    T* const im = wave_row(mesh, plane, 1, y);
    for (std::ptrdiff_t j = 0; j < lanes; ++j) {
      for (std::ptrdiff_t z = 0; z < n; ++z) {
        buffer[2 * lanes * z + j] = re[mesh.wave_row * j + z];
        buffer[2 * lanes * z + lanes + j] = im[mesh.wave_row * j + z];
      }
    }
    fourier<T>(mesh.z, n, lines, lines, scratch);
    const std::ptrdiff_t batch = plane * (mesh.wave_rows / fourier_lines) + y / fourier_lines;
    const T* const influence = mesh.influence + batch * n * fourier_lines + y % fourier_lines;
    for (std::ptrdiff_t z = 0; z < n; ++z) {
      const auto weight = hn::LoadU(d, influence + z * fourier_lines);
      const ComplexLanes<T> wave = lines.get(z);
      if constexpr (std::is_same_v<Sums, PlaneSums>) {
        const auto square = hn::MulAdd(wave.re, wave.re, hn::Mul(wave.im, wave.im));
        sums.add(mesh, plane, y, z, hn::Mul(weight, square), inverse);
      }
      lines.put(z, {hn::Mul(wave.re, weight), hn::Mul(wave.im, weight)});
    }
    fourier<T>(mesh.z, n, lines.exchanged(), lines.exchanged(), scratch);
    for (std::ptrdiff_t j = 0; j < lanes; ++j) {
      for (std::ptrdiff_t z = 0; z < n; ++z) {
        re[mesh.wave_row * j + z] = buffer[2 * lanes * z + j];
        im[mesh.wave_row * j + z] = buffer[2 * lanes * z + lanes + j];
      }
    }
  }
}

template <class T, class Sums>
HWY_INLINE void turn_plane(const MeshMemory<T>& mesh, std::ptrdiff_t plane, T* scratch, double inverse, Sums& sums) {
  const auto columns = [&](std::ptrdiff_t z) {
    return FourierLines<T>{wave_row(mesh, plane, 0, 0) + z, wave_row(mesh, plane, 1, 0) + z, mesh.wave_row};
  };
  for (std::ptrdiff_t z = 0; z < mesh.wave_row; z += lines_at_once<T>)
    fourier<T>(mesh.y, mesh.ny, columns(z), columns(z), scratch);
  turn_rows(mesh, plane, scratch, inverse, sums);
  for (std::ptrdiff_t z = 0; z < mesh.wave_row; z += lines_at_once<T>)
    fourier<T>(mesh.y, mesh.ny, columns(z).exchanged(), columns(z).exchanged(), scratch);
}

struct NoSums {};

template <class T> void waves(const MeshMemory<T>& mesh, std::ptrdiff_t plane, T* scratch) {
  NoSums none;
  turn_plane(mesh, plane, scratch, 0, none);
}

void waves_and_sums(const MeshMemory<double>& mesh, std::ptrdiff_t plane, double* scratch, double inverse,
                    WaveSums& sums) {
  PlaneSums lanes;
  turn_plane(mesh, plane, scratch, inverse, lanes);
  lanes.total(sums);
}

template <class T> constexpr MeshKernels<T> kernels_with_sums(decltype(MeshKernels<T>::waves_and_sums) with_sums) {
  return {{spread<T, 4>, spread<T, 5>, spread<T, 6>, spread<T, 7>, spread<T, 8>},
          {slopes<T, 4>, slopes<T, 5>, slopes<T, 6>, slopes<T, 7>, slopes<T, 8>},
          forward<T>,
          waves<T>,
          with_sums,
          backward<T>};
}

}  // namespace

extern const MeshKernels<double> mesh_kernels;
const MeshKernels<double> mesh_kernels = kernels_with_sums<double>(waves_and_sums);
extern const MeshKernels<float> mesh_kernels_mixed;
const MeshKernels<float> mesh_kernels_mixed = kernels_with_sums<float>(nullptr);

}  // namespace noether::NOETHER_SIMD_LEVEL
