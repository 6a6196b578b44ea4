#pragma once
/// How the momentum of a system is shared by its particles and their field.

#include "numbers/types.hpp"

#include <Eigen/Core>

#include <functional>

namespace noether {

/// Momenta of particles and of the field between them, and about the origin; `size` and `size_about` are sums of
/// magnitudes over particles, by which changes are measured.
struct MomentumShares {
  Vec3<double> particles = {0, 0, 0}, field = {0, 0, 0};              ///< [mass length/time]
  Vec3<double> particles_about = {0, 0, 0}, field_about = {0, 0, 0};  ///< [mass length^2/time]
  double size = 0, size_about = 0;
};

/// Of y = (q, p).
using MomentumSharing = std::function<MomentumShares(const Eigen::VectorXd& y)>;

}  // namespace noether
