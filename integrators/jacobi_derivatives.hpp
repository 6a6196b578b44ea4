#pragma once
/// How the kicks of Jacobi coordinates change along a direction: (u . grad) a, for kernels.

#include "engine/columns.hpp"
#include "engine/particle_system.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace noether {

/// (u . grad) of - mu d/r^3 at d.
template <class Real> Vec3<Real> change_of_pull(const Vec3<Real>& d, const Vec3<Real>& u, const Real& mu) {
  using std::sqrt;
  const Real r2 = norm2(d);
  return -mu / (r2 * sqrt(r2)) * (u - Real(3) * dot(d, u) / r2 * d);
}

/// What the derivatives need of the bodies: massive ones first.
template <class Real> struct JacobiBodies {
  const std::vector<Real>& masses;          ///< by particle
  const std::vector<std::int64_t>& order;   ///< of Jacobi coordinates
  const std::vector<std::int64_t>& within;  ///< by particle, how many massive bodies its arc goes round, less one
  const std::vector<Real>& circled;         ///< by particle, their mass
  Index massive = 0;
  Real G = Real(0);

  Index inner() const { return massive > 1 ? static_cast<Index>(order[1]) : -1; }
  Real mu(Index i) const { return G * masses[static_cast<std::size_t>(i)]; }
  bool innermost(Index i) const { return within[static_cast<std::size_t>(i)] == 0; }
};

/// Adds (u . grad) of the pulls of all pairs but the innermost, x inertial positions, u = `along`.
template <class Real>
void add_pair_derivatives(const JacobiBodies<Real>& bodies, const VectorColumn<Real>& x,
                          const VectorColumn<Real>& along, VectorColumn<Real>& out) {
  for (Index i = 1; i < bodies.massive; ++i) {
    for (Index j = 0; j < i; ++j) {
      if (j == 0 && i == bodies.inner()) continue;  // exactly the innermost Kepler arc
      const Vec3<Real> change = change_of_pull<Real>(x[i] - x[j], along[i] - along[j], Real(1));
      out.add(i, Vec3<Real>(bodies.mu(j) * change));
      out.add(j, Vec3<Real>(-bodies.mu(i) * change));
    }
  }
  for_blocks(x.size() - bodies.massive, [&](Index begin, Index end) {
    for (Index i = bodies.massive + begin; i < bodies.massive + end; ++i) {
      for (Index j = bodies.innermost(i) ? 1 : 0; j < bodies.massive; ++j)
        out.add(i, change_of_pull<Real>(x[i] - x[j], along[i] - along[j], bodies.mu(j)));
    }
  });
}

/// Adds (u . grad) of what the arcs have done already and kicks take back, x and u = `along` in Jacobi coordinates.
template <class Real>
void add_arc_derivatives(const JacobiBodies<Real>& bodies, const VectorColumn<Real>& x, const VectorColumn<Real>& along,
                         VectorColumn<Real>& out) {
  Vec3<Real> of_primary = Vec3<Real>::Zero();
  if (const Index i = bodies.inner(); i > 0) of_primary = change_of_pull<Real>(x[i], along[i], bodies.mu(i));
  const Index first = std::min<Index>(2, bodies.massive);
  for_blocks(static_cast<Index>(bodies.order.size()) - first, [&](Index begin, Index end) {
    for (Index k = first + begin; k < first + end; ++k) {
      const auto i = static_cast<Index>(bodies.order[static_cast<std::size_t>(k)]);
      const Real mu = bodies.G * bodies.circled[static_cast<std::size_t>(i)];
      out.add(i, bodies.innermost(i) ? of_primary : Vec3<Real>(-change_of_pull<Real>(x[i], along[i], mu)));
    }
  });
}

}  // namespace noether
