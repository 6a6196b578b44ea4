#pragma once
/// A symmetry of a system with coordinates, by its generator.

#include <Eigen/Core>

#include <functional>
#include <string>

namespace noether {

/// Motions of all coordinates that change nothing: q -> q + epsilon xi(q). By Noether's theorem p . xi(q) is kept.
///
///     Symmetry{"rotation", [](const Eigen::VectorXd& q) { return Eigen::VectorXd::Unit(q.size(), 1); }}
/// @source Noether1918
struct Symmetry {
  std::string name;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& q)> generator;  ///< xi, of the shape of q
};

}  // namespace noether
