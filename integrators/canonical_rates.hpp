#pragma once
/// The canonical rates of a function of coordinates and momenta, by dual numbers.

#include "integrators/vector_field.hpp"
#include "numbers/dual.hpp"

#include <algorithm>
#include <cstddef>

namespace noether::detail {

/// The canonical rates of H over numbers `Real`, and what they are computed in.
template <class S, class Real> class CanonicalRates {
 public:
  /// dy = (dH/dp, -dH/dq) at y = (q, p); dy has its size.
  /// @cost H in numbers with four slopes, for every four variables
  void find(const S& system, const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
    const Index n = y.size() / 2;
    q_.resize(n);
    p_.resize(n);
    for (Index i = 0; i < n; ++i) {
      q_[i] = y[i];
      p_[i] = y[n + i];
    }
    const Sloped time(t);
    for (Index first = 0; first < 2 * n; first += slopes) {
      const Index last = std::min(first + slopes, 2 * n);
      for (Index j = first; j < last; ++j) slope(j, j - first) = Real(1);
      const Sloped h = system.value(time, q_, p_);
      for (Index j = first; j < last; ++j) {
        slope(j, j - first) = Real(0);
        const Real& along = h.slope[static_cast<std::size_t>(j - first)];
        if (j < n) {
          dy[n + j] = -along;
        } else {
          dy[j - n] = along;
        }
      }
    }
  }

 private:
  static constexpr Index slopes = 4;
  using Sloped = Dual<Real, static_cast<std::size_t>(slopes)>;

  Real& slope(Index variable, Index direction) {
    const Index n = q_.size();
    Sloped& of = variable < n ? q_[variable] : p_[variable - n];
    return of.slope[static_cast<std::size_t>(direction)];
  }

  Vector<Sloped> q_, p_;
};

}  // namespace noether::detail
