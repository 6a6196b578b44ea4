#pragma once
/// Beginning and end of a step of `EnckeGauss` in two words, eight bodies in lanes: the interface of
/// `encke_words_simd.cpp`.

#include "integrators/methods/encke_row.hpp"
#include "numbers/kernels_simd.hpp"

#include <cstddef>

namespace noether {

struct EnckeWordKernels {
  /// Positions and velocities relative to the heaviest body. @param primary  its six numbers, one a lane
  void (*relate)(EnckeEight* eights, std::ptrdiff_t n, EightWords& primary);
  /// Sums over the stages of eight bodies, and how well their perturbations are followed.
  void (*sum)(const EnckeBody* const* bodies, const EnckeWeights& weights, EnckeEight& eight);
  /// What a step of length h moves: Kepler arcs in two words, and departures at their ends.
  /// @param tau  time of the last stage
  /// @return a bit for each lane whose arc is too long, or was not found: it is left to others
  unsigned (*advance)(EnckeEight& eight, double h, double tau);
  /// All particles to the end of the step, so that the centre of mass goes on evenly.
  /// @param push  what forces beside gravity add to it, one of six numbers a lane
  void (*place)(EnckeEight* eights, std::ptrdiff_t n, EightWords& primary, const double* push, double h);
};

NOETHER_KERNELS(EnckeWordKernels, encke_word_kernels)

}  // namespace noether
