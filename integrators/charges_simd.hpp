#pragma once
/// Charges in closed forms of fields in lanes: the interface of `charges_simd.cpp`.

#include "integrators/charge_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>
#include <cstdint>

namespace noether {

/// What charges are to do.
struct ChargeTask {
  double *x[3], *v[3];  ///< by charge
  const double *charge, *mass;
  const ChargeLetter* letters;
  std::ptrdiff_t count;
  const LaneFieldNumbers* fields;
  std::ptrdiff_t field_count;
  std::ptrdiff_t uniform_count;  ///< of the fields that come first and are uniform
  LanePush push;
  std::int64_t cycles, terms;  ///< of `LanePush::cycles`, as `GyrationAngle` has them
  const double* tangent;       ///< tan x = sum tangent_k x^(2 k + 1)
  double c;                    ///< speed of light of relativistic pushes, whose v is gamma times the velocity
  /// Sine and cosine of eight angles of any size, for turns that are longer than half a right angle.
  void (*turn)(const double* angle, double* sine, double* cosine);
};

struct ChargeKernels {
  /// Charges that go through all letters at once.
  static constexpr std::ptrdiff_t most = 64;
  /// Moves the charges of [begin, end), `most` or less, by all letters, with the bits of `ChargedParticles` letter by
  /// letter.
  void (*follow)(const ChargeTask& task, std::ptrdiff_t begin, std::ptrdiff_t end);
};

NOETHER_KERNELS(ChargeKernels, charge_kernels)

}  // namespace noether
