#include "numbers/pack.hpp"

#include "numbers/pack_simd.hpp"

namespace noether {

void copy_packs(const double* from, double* to, std::size_t packs) { pack_kernels().copy(from, to, packs); }

void set_to_zero(Pack* packs, std::size_t count) {
  if (count > 0) pack_kernels().clear(packs->lane.data(), count);
}

}  // namespace noether
