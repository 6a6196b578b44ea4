#pragma once
/// How multistep methods get their first values: short steps of a method that needs no past.

#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/methods/history.hpp"

namespace noether {

/// Goes one step by several short ones of DOP853 (order 8), with compensated sums.
///
/// Split into m parts, its error is m^8 times smaller than that of one step of order 8, far below what any method of
/// fixed steps that it serves makes in the same time.
/// @cost 12 evaluations for each part
/// @source HairerNoersettWanner1993
template <class Real> class Starter {
 public:
  explicit Starter(int parts)
      : parts_(parts),
        a_(as_real<Real>(tableaus::dop853().a)),
        b_(as_real<Real>(tableaus::dop853().b)),
        c_(as_real<Real>(tableaus::dop853().c)) {}

  void bind(Index size) {
    k_.assign(stages, Vector<Real>(size));
    y_.resize(size);
  }

  /// Evaluations of one step.
  int evaluations() const { return parts_ * static_cast<int>(stages); }

  /// From y(t) to y(t + h).
  void go(VectorField<Real>& f, const Real& t, CompensatedVector<Real>& y, double h) {
    const Real part = Real(h) / Real(parts_);
    for (int p = 0; p < parts_; ++p) {
      const Real begin = t + Real(p) * part;
      for (std::size_t i = 0; i < stages; ++i) {
        for (Index n = 0; n < y_.size(); ++n) y_[n] = y.value[n] + part * sum(a_[i], n);
        f.rate(begin + c_[i] * part, y_, k_[i]);
      }
      for (Index n = 0; n < y_.size(); ++n) y.add(n, part * sum(b_, n));
    }
  }

 private:
  static constexpr std::size_t stages = 12;

  Real sum(const std::vector<Real>& w, Index n) const {
    Real total(0);
    for (std::size_t j = 0; j < std::min(w.size(), stages); ++j) {
      if (w[j] != Real(0)) total += w[j] * k_[j][n];
    }
    return total;
  }

  int parts_;
  std::vector<std::vector<Real>> a_;
  std::vector<Real> b_, c_;
  std::vector<Vector<Real>> k_;
  Vector<Real> y_;
};

}  // namespace noether
