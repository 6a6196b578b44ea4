#pragma once
/// The pericenter that a pair of bodies passes between two looks that are too far apart for a polynomial.

#include "engine/motion.hpp"
#include "engine/orbital_elements.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace noether {

/// Where two bodies that attract each other come nearest between two looks.
template <class Real> struct KeplerPassage {
  Real distance2;  ///< of the pericenter [length^2]
  Real at;         ///< when, as a part of the time between the looks
  bool agreed;     ///< both looks tell the same passage; else the first one alone does
  Real since;      ///< when they came nearer than the distance asked for; 0 where they are already, as `at` where they
                   ///< never do
};

namespace detail {

/// One end of the way as an orbit about one center: mu by the acceleration, a = -mu x / r^3.
template <class Real> struct PassageEnd {
  Real mu, a, e, M, n;  ///< n: mean motion [1/time]; M between -pi and pi, or of a hyperbola

  explicit PassageEnd(const Motion<Real>& motion) {
    using std::abs;
    using std::sqrt;
    mu = -dot(motion.a, motion.x) * sqrt(norm2(motion.x));
    const OrbitalElements<Real> o = elements_from_state<Real>(motion.x, motion.v, mu);
    const Real turn(2 * std::numbers::pi);
    a = o.a, e = o.e;
    M = o.a > Real(0) && o.M > turn / Real(2) ? Real(o.M - turn) : o.M;
    n = sqrt(mu / abs(a * a * a));
  }
  Real pericenter() const { return a * (Real(1) - e); }
  /// Mean anomaly at the distance r before the pericenter. @param r  between pericenter and apocenter
  Real anomaly_at(const Real& r) const {
    using std::acos;
    using std::acosh;
    using std::sin;
    using std::sinh;
    const Real c = (Real(1) - r / a) / e;
    if (a > Real(0)) {
      const Real E = acos(std::clamp(c, Real(-1), Real(1)));
      return -(E - e * sin(E));
    }
    const Real H = acosh(std::max(c, Real(1)));
    return -(e * sinh(H) - H);
  }
};

}  // namespace detail

/// The passage of a pericenter between two looks, as the first of them tells it: as two bodies that attract each other,
/// by the same strength at both looks to a tenth, and are disturbed little until then. A step that jumps over a
/// pericenter may end anywhere, so the second look need not agree. It does where pericenters differ by less than a
/// tenth of themselves or of `distance`, and times by less than a tenth of the time between the looks.
/// @param begin, end  motions of one body as seen from the other  @param h  time between them [time], signed
/// @param distance  below which they meet [length]
/// @return empty where no such passage is known
/// @cost two sets of orbital elements
template <class Real>
std::optional<KeplerPassage<Real>> kepler_passage(const Motion<Real>& begin, const Motion<Real>& end, const Real& h,
                                                  const Real& distance) {
  using std::abs;
  using std::sqrt;
  const Real sign = h < Real(0) ? Real(-1) : Real(1), whole = abs(h);
  const auto towards = [&](const Motion<Real>& m) { return Motion<Real>{m.x, sign * m.v, m.a}; };
  const detail::PassageEnd<Real> first(towards(begin)), last(towards(end));
  const auto close = [](const Real& a, const Real& b, const Real& scale) { return abs(a - b) <= Real(0.1) * scale; };
  if (!(first.mu > Real(0)) || !close(first.mu, last.mu, first.mu)) return {};
  const Real q = first.pericenter();
  const Real after_first = -first.M / first.n, before_last = whole - last.M / last.n;  // times of the passage
  if (!(after_first >= Real(0) && after_first <= whole)) return {};
  const bool agreed = close(q, last.pericenter(), std::max(q, distance)) && close(after_first, before_last, whole);
  KeplerPassage<Real> passage{q * q, after_first / whole, agreed, after_first / whole};
  if (q < distance && distance < sqrt(norm2(begin.x))) {
    const Real since = (first.anomaly_at(distance) - first.M) / (first.n * whole);
    passage.since = std::clamp(since, Real(0), passage.at);
  } else if (q < distance) {
    passage.since = Real(0);
  }
  return passage;
}

}  // namespace noether
