#pragma once
/// How the end of a Kepler arc moves when its start does.

#include "numbers/real.hpp"
#include "numbers/types.hpp"

#include <array>
#include <utility>

namespace noether {

/// A vector of the tangent space: a small change of position and velocity.
template <class Real> struct KeplerChangeOf { Vec3<Real> x = Vec3<Real>::Zero(), v = Vec3<Real>::Zero(); };
using KeplerChange = KeplerChangeOf<double>;

/// The derivative of a Kepler arc by its start, the symplectic matrix
///
///     Phi = d(x1, v1) / d(x0, v0),   x1 = f x0 + g v0,   v1 = f' x0 + g' v0
///
/// in closed form for every conic. In space f, g, f' and g' turn a change as they turn x0 and v0 themselves; what is
/// left lies in the plane of the orbit, since f, g, f', g' depend on the start by r0, x0 . v0 and the energy alone.
/// @source ReinTamayo2015
template <class Real> class KeplerTangentOf {
 public:
  KeplerTangentOf() = default;
  /// @param s  universal variable of the arc, as `KeplerArc` has it; at most a period long
  KeplerTangentOf(const Vec3<Real>& x0, const Vec3<Real>& v0, const Real& mu, const Real& h, const Real& s);

  /// What the start of the arc contributes to both halves of Phi: x1 by (x0, v0).
  Vec3<Real> position(const KeplerChangeOf<Real>& start) const { return upper_.turned(start, x0_, v0_); }
  /// v1 by (x0, v0).
  Vec3<Real> velocity(const KeplerChangeOf<Real>& start) const { return lower_.turned(start, x0_, v0_); }
  /// What x1 is made of: f, g, and their derivatives by x0 and v0 as multiples of x0 and v0, by whose symmetry
  ///     df/dx0 = f_x x0 + f_eta v0,   df/dv0 = f_eta x0 + f_v v0,   g likewise
  /// @return f, g, f_x, f_eta, f_v, g_x, g_eta, g_v
  std::array<Real, 8> upper() const {
    return {upper_.f, upper_.g, upper_.f_x, upper_.f_eta, upper_.f_v, upper_.g_x, upper_.g_eta, upper_.g_v};
  }
  /// Phi^-1 (0, a): the change of the start that changes the end by a velocity `a` alone.
  KeplerChangeOf<Real> start_of(const Vec3<Real>& a) const;

 private:
  /// f or f', g or g', and their derivatives by x0 and v0 as multiples of x0 and v0:
  ///     df/dx0 = f_x x0 + f_eta v0,   df/dv0 = f_eta x0 + f_v v0,   g likewise
  struct Half {
    Real f = Real(0), g = Real(0), f_x = Real(0), f_eta = Real(0), f_v = Real(0), g_x = Real(0), g_eta = Real(0),
         g_v = Real(0);

    Vec3<Real> turned(const KeplerChangeOf<Real>& start, const Vec3<Real>& x0, const Vec3<Real>& v0) const;
  };

  Half upper_, lower_;
  Vec3<Real> x0_ = Vec3<Real>::Zero(), v0_ = Vec3<Real>::Zero();
};

using KeplerTangent = KeplerTangentOf<double>;

extern template class KeplerTangentOf<double>;
extern template class KeplerTangentOf<Quad>;

}  // namespace noether
