#pragma once
/// Whether a system depends on time without saying so.

#include "numbers/dual.hpp"
#include "numbers/types.hpp"

#include <algorithm>
#include <cmath>

namespace noether::detail {

/// What a system says of itself by `static constexpr bool time_dependent`; without it: that it does not.
template <class S> constexpr bool depends_on_time() {
  if constexpr (requires { S::time_dependent; }) return S::time_dependent;
  return false;
}

/// Whether something changes with time at the start, where all q may be 0, or beside it.
/// @param changes  changes(t, q, p): whether it does there, over numbers whose slope is along time
template <class Real, class Changes>
bool hides_time(const Real& start, const Vector<Real>& q, const Vector<Real>& p, const Changes& changes) {
  using std::abs;
  using Moving = Dual<Real, 1>;
  const auto beside = [](const Vector<Moving>& of) {
    Vector<Moving> shifted = of;
    for (Index i = 0; i < of.size(); ++i) {
      shifted[i].value +=
          (Real(0.37) + Real(0.11 * static_cast<double>(i % 7))) * std::max(Real(1), Real(abs(of[i].value)));
    }
    return shifted;
  };
  const Vector<Moving> at_q = q.template cast<Moving>(), at_p = p.template cast<Moving>();
  for (const double later : {0.0, 0.3, 7.7}) {
    const Moving t = along(start + Real(later), Real(1));
    if (changes(t, at_q, at_p) || changes(t, beside(at_q), beside(at_p))) return true;
  }
  return false;
}

/// Whether a number moves with time; where it is not finite, nothing is known of it.
template <class Real> bool moves(const Dual<Real, 1>& number) {
  using std::isfinite;
  return number.slope[0] != Real(0) && isfinite(number.slope[0]);
}

}  // namespace noether::detail
