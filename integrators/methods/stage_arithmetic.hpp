#pragma once
/// Sums over the stages of a collocation method: in lanes for double, in plain loops for other number types.

#include "integrators/vector_field.hpp"

#include <array>

namespace noether {

/// One coefficient for each of eight lanes.
template <class Real> using StageLanes = std::array<Real, lane_count>;
/// [j][i]: what stage i takes from stage j.
template <class Real> using StageMatrix = std::array<StageLanes<Real>, lane_count>;

/// The sums of a collocation step over n variables whose stages stand side by side.
///
/// Rates, and what is found for each variable, are padded to a multiple of eight variables.
template <class Real> struct StageArithmetic {
  Index n = 0;
  int terms = lane_count;  ///< rates that paths are made of; the others are 0

  /// out_i = y + (h sum_j a_ji F_j + low)
  void values(const Real* rates, const StageMatrix<Real>& a, const Real* y, const Real* low, double h, Real* out) const;
  /// out_i = y + (c_i h v + (c_low_i h v + h^2 sum_j a_ji F_j + low))
  void positions(const Real* rates, const StageMatrix<Real>& a, const StageLanes<Real>& c,
                 const StageLanes<Real>& c_low, const Real* y, const Real* low, const Real* v, double h,
                 Real* out) const;
  /// w_ji: what the polynomial through `stages` nodes c has at 1 + c_i ratio, from node j, by Lagrange's formula.
  void extrapolation(int stages, const StageLanes<Real>& c, const StageLanes<Real>& barycentric, const Real& ratio,
                     StageMatrix<Real>& w) const;
  /// out_i = sum_j w_ji F_j
  void combine(const Real* rates, const StageMatrix<Real>& w, Real* out) const;
  /// The stages, a bit each, where any variable is another than `known`, which becomes q.
  std::uint8_t moved(const Real* q, Real* known) const;
  /// Rates become `fresh`; the largest change, and the largest |fresh|.
  std::array<Real, 2> take(const Real* fresh, Real* rates) const;
  /// into_i becomes sum_j w_ji F_j for i < terms, other w being 0; the largest change, and the largest |into|.
  std::array<Real, 2> take_combined(const Real* rates, const StageMatrix<Real>& w, Real* into) const;
  /// sum_j w_j F_j, and largest |F_j|, of each variable.
  void coefficient(const Real* rates, const StageLanes<Real>& w, Real* sum, Real* largest) const;
  /// Ends a step: velocities (or variables) from weights 0 and 1 (what rounding took), positions, if there are any,
  /// from 2 and 3.
  void finish(const Real* rates, const std::array<StageLanes<Real>, 4>& weights, double h, Real* q, Real* q_low,
              Real* v, Real* v_low) const;
};

extern template struct StageArithmetic<double>;
extern template struct StageArithmetic<Quad>;

}  // namespace noether
