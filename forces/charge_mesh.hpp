#pragma once
/// Charges on a mesh: B-splines, how well they do, and the mesh itself.

#include "engine/particle_system.hpp"
#include "numbers/types.hpp"

#include <array>
#include <complex>
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

/// How a mesh is laid.
struct MeshLayout {
  std::array<std::int64_t, 3> points{};
  int order = 0;
  double alpha = 0;  ///< [1/length]
  Vec3<double> edges = Vec3<double>::Zero();
  double coulomb_constant = 0;  ///< [energy length/charge^2]

  bool operator==(const MeshLayout&) const = default;
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
/// The widest spacing with that error or less [length].
double spacing_for(double error, double alpha, int order, double neighbor);
/// As many points, or somewhat more, for which a Fourier transform is quick.
std::int64_t quick_size(std::int64_t points);

/// The mesh of one evaluation after the other.
class ChargeMesh {
 public:
  /// Lays it anew where anything differs.
  void lay(const MeshLayout& layout);
  /// Puts the charges on it, in whole units of `unit`: sums that have no order.
  void spread(const ParticleSystem<double>& s, const double* charges, double unit);
  /// Turns charges into their potential at the points of the mesh.
  /// @param sums  whether energy and virial are asked for
  void solve(bool sums);
  /// The slopes of the potential where a particle is [energy/(charge length)].
  Vec3<double> slope_at(const Vec3<double>& x) const;

  double energy() const { return energy_; }
  const Mat3<double>& virial() const { return virial_; }

 private:
  struct Place {
    std::array<std::array<std::int64_t, largest_order>, 3> points;
    std::array<SplineWeights, 3> weights;
  };
  Place place_of(const Vec3<double>& x) const;
  Vec3<double> wave(std::int64_t x, std::int64_t y, std::int64_t z) const;
  void add_up();

  MeshLayout layout_;
  double unit_ = 0, energy_ = 0;
  Mat3<double> virial_ = Mat3<double>::Zero();
  std::vector<std::int64_t> charges_;
  std::vector<double> field_;                ///< charges, then potential, shape (x, y, z)
  std::vector<std::complex<double>> waves_;  ///< shape (x, y, z/2 + 1)
  std::vector<double> influence_;            ///< D / V times C, of the same shape
};

}  // namespace noether::detail
