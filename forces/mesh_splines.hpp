#pragma once
/// B-splines for charges on a mesh, and how well they do.

#include "numbers/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace noether::detail {

inline constexpr int least_order = 4, largest_order = 8;

/// Values and slopes of a B-spline of some order at the points of a mesh around a place.
/// @source EssmannPereraBerkowitzDardenLeePedersen1995
struct SplineWeights {
  std::array<double, largest_order> value{}, slope{};

  /// @param w  of the place beyond a point of the mesh, 0 to 1
  SplineWeights(double w, int order);
};

/// The error of forces by the waves of a mesh, in the units of SplitErrors: that of charges in no order, from the
/// Fourier transforms U(k) of the splines. k_m are the waves that look like k on the mesh, A = 4 pi exp(-k^2/4
/// alpha^2)/k^2, and D = A / (sum_m U(k_m))^2 is what the mesh has in its place.
///
///     a  integral d^3k/(2 pi)^3 (k^2 A^2 - 2 D A k^2 U(k)^2 + D^2 sum_m k_m^2 U(k_m)^2 sum_m U(k_m)^2)
///
/// is the square of it.
/// @param neighbor  a of SplitErrors [length] @param spacing  of the mesh [length]
/// @source HockneyEastwood1988, BalleneggerCerdaHolm2012
double mesh_error(double alpha, const Vec3<double>& spacing, int order, double neighbor);
/// The widest spacing with that error, to a hundredth of it, or less [length]; in equal steps along all axes.
/// @cost the first call of a process 10 ms: mesh_error is sqrt(neighbor alpha) times a function of alpha h
double spacing_for(double error, double alpha, int order, double neighbor);
/// Errors of forces on a mesh in single precision, of their root mean square, in the same units: measured, and mostly
/// less. Slopes of the potential are differences of numbers that single precision rounds.
double single_precision_error(double alpha, double spacing, double neighbor);
/// How long a mesh takes, in the time for a row of points of one particle: p^2 rows, and the transforms.
double mesh_work(double charges, double points, int order);
/// As many points, or somewhat more, for which a Fourier transform is quick.
std::int64_t quick_size(std::int64_t points);

/// 1 / |sum_j M(j + 1) exp(2 pi i m j / points)|^2, for m from 0 to points - 1; 0 where the sum is.
std::vector<double> spline_factors(std::int64_t points, int order);

}  // namespace noether::detail
