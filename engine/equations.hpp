#pragma once
/// Equations of a state, g(x, v) or g(y), with their gradients: what a projection moves a state onto.

#include "engine/particle_system.hpp"

#include <Eigen/Core>

#include <memory>
#include <string>

namespace noether {

/// Some equations over one number type, erased.
///
/// A state is y = (x, v) of n particles: all x, then all y, then all z, then velocities likewise, shape (6 n); or the
/// variables of a first-order system.
template <class Real> class Equations {
 public:
  using Values = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Gradients = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  virtual ~Equations() = default;
  virtual std::unique_ptr<Equations> clone() const = 0;
  /// As messages call them.
  virtual std::string name() const = 0;
  /// With what they were made, for saved runs.
  virtual std::string signature() const { return name(); }
  /// Whether they are to be 0, and not what they were at the start.
  virtual bool vanish() const { return false; }
  /// Takes what it needs of a system. @throws Error  if they make no sense there
  virtual void bind(const ParticleSystem<Real>& s) = 0;
  /// Number of equations, after `bind`.
  virtual Index size() const = 0;
  /// g, shape (size), and what errors of it are small beside.
  virtual void values(const ParticleSystem<Real>& s, Real* g, Real* scale) = 0;
  /// dg/dy, one column for each equation from column `first` on; all of it is 0 before.
  virtual void gradients(const ParticleSystem<Real>& s, Gradients& G, Index first) = 0;
};

}  // namespace noether
