#pragma once
/// How the end of a Kepler arc moves when its start does.

#include "numbers/types.hpp"

#include <array>
#include <utility>

namespace noether {

/// A vector of the tangent space: a small change of position and velocity.
struct KeplerChange {
  Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();
};

/// The derivative of a Kepler arc by its start, the symplectic matrix
///
///     Phi = d(x1, v1) / d(x0, v0),   x1 = f x0 + g v0,   v1 = f' x0 + g' v0
///
/// in closed form for every conic. In space f, g, f' and g' turn a change as they turn x0 and v0 themselves; what is
/// left lies in the plane of the orbit, since f, g, f', g' depend on the start by r0, x0 . v0 and the energy alone.
/// @source ReinTamayo2015
class KeplerTangent {
 public:
  KeplerTangent() = default;
  /// @param s  universal variable of the arc, as `KeplerArc` has it; at most a period long
  KeplerTangent(const Vec3<double>& x0, const Vec3<double>& v0, double mu, double h, double s);

  /// What the start of the arc contributes to both halves of Phi: x1 by (x0, v0).
  Vec3<double> position(const KeplerChange& start) const { return upper_.turned(start, x0_, v0_); }
  /// v1 by (x0, v0).
  Vec3<double> velocity(const KeplerChange& start) const { return lower_.turned(start, x0_, v0_); }
  /// What x1 is made of: f, g, and their derivatives by x0 and v0 as multiples of x0 and v0, by whose symmetry
  ///     df/dx0 = f_x x0 + f_eta v0,   df/dv0 = f_eta x0 + f_v v0,   g likewise
  /// @return f, g, f_x, f_eta, f_v, g_x, g_eta, g_v
  std::array<double, 8> upper() const {
    return {upper_.f, upper_.g, upper_.f_x, upper_.f_eta, upper_.f_v, upper_.g_x, upper_.g_eta, upper_.g_v};
  }
  /// Phi^-1 (0, a): the change of the start that changes the end by a velocity `a` alone.
  KeplerChange start_of(const Vec3<double>& a) const;

 private:
  /// f or f', g or g', and their derivatives by x0 and v0 as multiples of x0 and v0:
  ///     df/dx0 = f_x x0 + f_eta v0,   df/dv0 = f_eta x0 + f_v v0,   g likewise
  struct Half {
    double f = 0, g = 0, f_x = 0, f_eta = 0, f_v = 0, g_x = 0, g_eta = 0, g_v = 0;

    Vec3<double> turned(const KeplerChange& start, const Vec3<double>& x0, const Vec3<double>& v0) const;
  };

  Half upper_, lower_;
  Vec3<double> x0_ = Vec3<double>::Zero(), v0_ = Vec3<double>::Zero();
};

}  // namespace noether
