#pragma once
/// What charges of short range do, as the kernels in lanes read it.

namespace noether {

/// What two unit charges do up to a range, with t = scale r^2 + offset:
///
///     U = S (1/r + sum_k energy[k] t^k),    -U'/r = S (1/r^3 + sum_k force[k] t^k) - S'/r (1/r + ...)
///
/// S is the switch of Cutoff::switch_c4, of (r^2 - switch_from2) switch_inverse; 1 where that factor is 0.
struct ChargeSeries {
  static constexpr int most_terms = 48;
  double range2 = 0;  ///< square of the range [length^2]
  double scale = 1, offset = 0;
  int energy_terms = 0, force_terms = 0;  ///< how many; 0: there is no such series
  double energy[most_terms] = {}, force[most_terms] = {};
  double switch_from2 = 0, switch_inverse = 0;
};

}  // namespace noether
