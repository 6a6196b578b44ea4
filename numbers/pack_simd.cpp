#include "numbers/pack_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
constexpr std::size_t lanes = hn::MaxLanes(Lanes());

void copy(const double* from, double* to, std::size_t packs) {
  const Lanes d;
  for (std::size_t k = 0; k < 8 * packs; k += lanes) hn::StoreU(hn::LoadU(d, from + k), d, to + k);
}

void clear(double* to, std::size_t packs) {
  const Lanes d;
  for (std::size_t k = 0; k < 8 * packs; k += lanes) hn::StoreU(hn::Zero(d), d, to + k);
}

}  // namespace

extern const PackKernels pack_kernels;
const PackKernels pack_kernels{copy, clear};

}  // namespace noether::NOETHER_SIMD_LEVEL
