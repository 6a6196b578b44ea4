#pragma once
/// How long steps of collocation may be under gravity, from the rates of a step just made.

#include "engine/column.hpp"
#include "integrators/methods/collocation_table.hpp"
#include "numbers/types.hpp"

#include <vector>

namespace noether {

/// A step by two measures.
///
/// First, by the timescale of each body, from acceleration a, jerk j and snap s of the polynomial through the rates, in
/// the middle and at the end of the step:
///
///     tau^-2 = max over bodies of (j^2 + a s) / (2 a^2)
///
/// The step made may be eta min(tau_middle, tau_end), the next one eta tau_end, less where tau shrinks. Second, by the
/// last Legendre coefficient of the rates, relative to the rates of the same body.
///
/// The first counts. Where it would shorten the step, it is no less than the second: a body that crosses a place where
/// forces cancel has a short timescale although nothing happens. And it is at most 1.5 times the second: what two
/// bodies do to each other hardly shows in timescales where a third one pulls both harder.
///
/// The rate of the heaviest body is a sum that may cancel: it counts as no smaller than that by which any other one
/// alone would move it.
/// @source PhamReinSpiegel2024
class StageControl {
 public:
  /// A step is made again if it may have no more than this part of its length.
  static constexpr double kept = 0.75;
  /// The first measure is taken for no longer than so many times the second.
  static constexpr double farther = 1.5;

  /// @param mirrored  eight nodes that are symmetric about the middle of a step: half the products
  StageControl(const CollocationTable& table, bool mirrored, double rtol);
  void bind(const std::vector<double>& masses);

  struct Lengths {
    double made = 0, next = 0;  ///< that the step just made, and the next one, may have [time], above 0
  };
  /// @param rates    of the step just made, shape (3 n, 8), padded to a multiple of eight variables
  /// @param h        its length
  /// @param at_hand  of the next step, unless it is to become shorter or longer
  Lengths lengths(const double* rates, double h, double at_hand);

 private:
  Lengths by_timescale(const double* rates, double h);
  double by_last_coefficient(const double* rates, double h);
  double timescale(std::size_t row) const;

  bool mirrored_;
  int degree_;  ///< of the polynomial
  double eta_, target_;
  AlignedVector<double> weights_;  ///< value and derivatives in the middle and at the end, shape (6, 8)
  AlignedVector<double> last_;     ///< of the last coefficient, shape (8)
  Index n_ = 0;
  std::size_t heaviest_ = 0, stride_ = 0;
  std::vector<double> mass2_;  ///< squares of masses, that of the heaviest one is 1
  AlignedVector<double> rows_, sums_, largest_;
};

}  // namespace noether
