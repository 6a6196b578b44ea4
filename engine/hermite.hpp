#pragma once
/// The quintic Hermite polynomial between two settled states: where in a step an event happened.

#include "engine/motion.hpp"

#include <algorithm>

namespace noether {

/// The polynomial of degree 5 that meets position, velocity and acceleration at both ends of an interval.
///
///     x(theta), theta = (t - t0) / h in [0, 1]; its error is O(h^6)
template <class Real> class Hermite {
 public:
  Hermite(const Motion<Real>& begin, const Motion<Real>& end, const Real& h)
      : c0_(begin.x), c1_(h * begin.v), c2_(h * h / Real(2) * begin.a) {
    const Vec3<Real> dx = end.x - c0_ - c1_ - c2_;
    const Vec3<Real> dv = h * end.v - c1_ - Real(2) * c2_;
    const Vec3<Real> da = h * h * end.a - Real(2) * c2_;
    c3_ = Real(10) * dx - Real(4) * dv + Real(0.5) * da;
    c4_ = Real(-15) * dx + Real(7) * dv - da;
    c5_ = Real(6) * dx - Real(3) * dv + Real(0.5) * da;
  }

  Vec3<Real> position(const Real& u) const {
    return c0_ + u * (c1_ + u * (c2_ + u * (c3_ + u * (c4_ + u * c5_)))).eval();
  }
  /// Derivative by theta.
  Vec3<Real> slope(const Real& u) const {
    return c1_ + u * (Real(2) * c2_ + u * (Real(3) * c3_ + u * (Real(4) * c4_ + u * (Real(5) * c5_)))).eval();
  }

  /// Whether some point of the interval can be this near the origin; false is certain.
  bool may_come_within(const Real& distance) const {
    using std::sqrt;
    Real reach(0);
    for (const Vec3<Real>* c : {&c1_, &c2_, &c3_, &c4_, &c5_}) reach += sqrt(norm2(*c));
    return !(sqrt(norm2(c0_)) - reach > distance);
  }

  /// Smallest distance from the origin on the interval, and where.
  ///
  /// `resolved`: without its accelerations the polynomial would have led to the same place within a tenth of that
  /// distance, or of the one that matters, and not by chance. Where it would not, the interval is too long for the
  /// motion in it, and the distance means nothing.
  struct Nearest {
    Real distance2, at;
    bool resolved;
  };
  /// @param matters  a distance below which nothing is told apart
  Nearest nearest(const Real& matters = Real(0)) const {
    Nearest best = lowest();
    const Real compared2 = std::max(best.distance2, Real(matters * matters));
    // Both polynomials differ by u^2 (1 - u)^2 (A + B u), which may vanish anywhere: the larger one of its ends counts.
    const Real u = best.at, bump = u * u * (Real(1) - u) * (Real(1) - u);
    const Real most2 = std::max(norm2(Vec3<Real>(c4_ + Real(2) * c5_)), norm2(Vec3<Real>(c4_ + Real(3) * c5_)));
    best.resolved = bump * bump * most2 <= Real(0.01) * compared2;
    return best;
  }

  /// The point in [low, high] where `past` turns from false to true.
  template <class Past> static Real bisect(Real low, Real high, const Past& past) {
    for (int k = 0; k < 100; ++k) {
      const Real middle = (low + high) / Real(2);
      if (middle == low || middle == high) break;
      (past(middle) ? high : low) = middle;
    }
    return high;
  }

 private:
  Nearest lowest() const {
    Nearest best{norm2(position(Real(0))), Real(0), true};
    constexpr int pieces = 16;
    for (int k = 1; k <= pieces; ++k) {
      const Real low = Real(k - 1) / Real(pieces), high = Real(k) / Real(pieces);
      Real u = high;
      if (dot(position(low), slope(low)) < Real(0) && dot(position(high), slope(high)) > Real(0)) {
        u = bisect(low, high, [this](const Real& w) { return dot(position(w), slope(w)) > Real(0); });
      }
      if (const Real d2 = norm2(position(u)); d2 < best.distance2) best = {d2, u, true};
    }
    return best;
  }

  Vec3<Real> c0_, c1_, c2_, c3_, c4_, c5_;
};

}  // namespace noether
