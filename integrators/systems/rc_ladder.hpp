#pragma once
/// A ladder of resistors and capacitors, with time constants decades apart.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace noether {

/// n stages in a row, each a resistor R_k in the line and a capacitor C_k to the ground, behind a source of voltage.
///
///     R C_k v_k' = (v_(k-1) - v_k) - (v_k - v_(k+1)),   C_k = C spread^(-(k - 1)/(n - 1)),   v_0 = V cos(omega t)
///
/// The last stage carries no load. Voltages count in a unit of their own, resistances relative to a resistance R0, and
/// capacitances by the time R0 C.
/// @source HairerWanner1996
struct RcLadder {
  std::int64_t stages = 10;  ///< n
  double resistance = 1;     ///< R of every stage [1]
  double capacitance = 1;    ///< C of the first stage [time]
  double spread = 1e6;       ///< C of the first stage over C of the last [1]
  double voltage = 1;        ///< V of the source [1]
  double omega = 0;          ///< of the source; 0: direct current [1/time]

  static constexpr auto describe() {
    return part<RcLadder>(
        "rc_ladder", "resistors and capacitors in a row, with time constants decades apart",
        formula("R C_k v_k' = v_(k-1) - 2 v_k + v_(k+1),  C_k = C spread^(-(k - 1)/(n - 1)),  v_0 = V cos(omega t)"),
        source("HairerWanner1996"), quantities("v[stages] [1]"), field<&RcLadder::stages>("stages", "1", "n"),
        field<&RcLadder::resistance>("resistance", "1", "resistance of every stage"),
        field<&RcLadder::capacitance>("capacitance", "time", "time constant of the first stage"),
        field<&RcLadder::spread>("spread", "1", "capacitance of the first stage over that of the last"),
        field<&RcLadder::voltage>("voltage", "1", "amplitude of the source"),
        field<&RcLadder::omega>("omega", "1/time", "angular frequency of the source; 0: direct current"));
  }
  /// @throws Error  for what is no ladder
  void check() const {
    if (stages > most) {
      refuse_field("stages", static_cast<double>(stages), fmt::format("is too many; at most {} are expected", most));
    }
    if (stages < 1) refuse_field("stages", static_cast<double>(stages), "is too few; 1 or more is expected");
    if (!(resistance > 0))
      refuse_field("resistance", resistance, "is not a valid resistance; a number above 0 is expected");
    if (!(capacitance > 0))
      refuse_field("capacitance", capacitance, "is not a valid capacitance; a time above 0 is expected");
    if (!(spread > 0))
      refuse_field("spread", spread, "is not a valid ratio of capacitances; a number above 0 is expected");
  }

  static constexpr std::int64_t most = 1'000'000;  ///< of them, so that memory is not asked for in vain

  Index size() const { return static_cast<Index>(stages); }
  std::vector<double> start() const { return std::vector<double>(static_cast<std::size_t>(stages), 0.0); }
  /// Capacitance of stage `k`, counted from 0 [time].
  double capacitance_of(Index k) const {
    if (stages == 1) return capacitance;
    return capacitance * std::pow(spread, -static_cast<double>(k) / static_cast<double>(stages - 1));
  }
  Sparsity sparsity() const {
    Sparsity columns(static_cast<std::size_t>(stages));
    for (Index j = 0; j < size(); ++j) {
      for (Index i = std::max<Index>(j - 1, 0); i <= std::min(j + 1, size() - 1); ++i) {
        columns[static_cast<std::size_t>(j)].push_back(i);
      }
    }
    return columns;
  }

  template <class Real> void rates(const Real& t, const Vector<Real>& y, Vector<Real>& dy) const {
    using std::cos;
    const Index last = size() - 1;
    const Real source = Real(voltage) * cos(Real(omega) * t);
    for (Index k = 0; k <= last; ++k) {
      Real current = (k == 0 ? source : y[k - 1]) - y[k];
      if (k < last) current = current - (y[k] - y[k + 1]);
      dy[k] = current / Real(resistance * capacitance_of(k));
    }
  }
};

}  // namespace noether
