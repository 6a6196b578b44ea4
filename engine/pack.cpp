#include "engine/pack.hpp"

#include "engine/pack_simd.hpp"

namespace noether {

namespace {

const PackKernels& kernels() {
#if NOETHER_SIMD_LEVELS
  return at_simd_level(base::pack_kernels, avx2::pack_kernels, avx512::pack_kernels);
#else
  return base::pack_kernels;
#endif
}

}  // namespace

void copy_packs(const double* from, double* to, std::size_t packs) { kernels().copy(from, to, packs); }

void set_to_zero(Pack* packs, std::size_t count) {
  if (count > 0) kernels().clear(packs->lane.data(), count);
}

}  // namespace noether
