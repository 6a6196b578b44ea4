#pragma once
/// A mesh of charges in lanes: the interface of `charge_mesh_simd.cpp`, which is compiled once per level of
/// `numbers/simd.hpp`.

#include "forces/charge_row.hpp"
#include "forces/fourier_passes_simd.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// Whole numbers that the charges of a mesh are counted in.
template <class T> struct WholeOf;
template <> struct WholeOf<double> { using type = std::int64_t; };
template <> struct WholeOf<float> { using type = std::int32_t; };

/// The memory of a mesh. Rows of points go on beyond their end, with the same points again, so that a spline needs not
/// be folded along z.
template <class T> struct MeshMemory {
  std::ptrdiff_t nx, ny, nz;
  std::ptrdiff_t rows, row;              ///< of a plane of points: ny or one more, an even number; numbers in a row
  std::ptrdiff_t wave_rows, wave_row;    ///< of a plane of waves: ny and nz, padded
  typename WholeOf<T>::type* counts;     ///< of charges, shape (nx, rows, row); 0 where nobody spreads
  T* potential;                          ///< of the same shape
  T* waves;                              ///< shape (nx/2 + 1, 2, wave_rows, wave_row): real parts of a plane first
  const T* influence;                    ///< shape (nx/2 + 1, wave_rows/8, nz, 8), lanes along y; 0 in the padding
  const double *kx, *ky, *kz;            ///< wave numbers, ky also in the padding
  const double *odd_x, *odd_y, *odd_z;   ///< the same, 0 for a wave that stands for its opposite too
  const std::ptrdiff_t *planes, *lines;  ///< where plane x and row y begin, for x and y beyond the end too
  const T *values, *slopes;              ///< coefficients of the splines, shape (power, 8)
  FourierPasses<T> x, y, z;
  double counts_in_one;  ///< that a charge of 1 is
  T half_count;          ///< half of what a count stands for
};

/// Of one plane of waves k: sums of e = D |q_k|^2, and of (2/k^2 + 1/(2 alpha^2)) e times kx kx, ky ky, kz kz, and
/// odd_x odd_y, odd_x odd_z, odd_y odd_z.
struct WaveSums {
  double energy, moments[6];
};

template <class T> struct MeshKernels {
  using Memory = MeshMemory<T>;
  /// Adds the charges of particles to the counts, by splines of order 4 to 8 [order - 4].
  void (*spread[5])(const Memory& mesh, const MeshPlace* places, std::ptrdiff_t count);
  /// The slopes of the potential at particles along the axes of the mesh, shape (count, 3).
  void (*slopes[5])(const Memory& mesh, const MeshPlace* places, std::ptrdiff_t count, double* slopes);
  /// From counts to waves along x, of rows 2 pair and 2 pair + 1; the counts are 0 again.
  /// @param scratch  room for 6 fourier_lines of the longest edge
  void (*forward)(const Memory& mesh, std::ptrdiff_t pair, T* scratch);
  /// Waves of plane kx along y and z, times the influence, and back.
  void (*waves)(const Memory& mesh, std::ptrdiff_t plane, T* scratch);
  /// The same, with sums. @param inverse  1 / (2 alpha^2)
  void (*waves_and_sums)(const Memory& mesh, std::ptrdiff_t plane, T* scratch, double inverse, WaveSums& sums);
  /// From waves along x to the potential.
  void (*backward)(const Memory& mesh, std::ptrdiff_t pair, T* scratch);
};

NOETHER_KERNELS(MeshKernels<double>, mesh_kernels)
NOETHER_KERNELS(MeshKernels<float>, mesh_kernels_mixed)

}  // namespace noether
