#include "engine/finite_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// 0 times a number is 0, unless it is not finite; and what is no number spoils the sum.
bool all(const double* numbers, std::ptrdiff_t count) {
  const Lanes d;
  const auto zero = hn::Zero(d);
  auto sum = zero;
  for (std::ptrdiff_t i = 0; i < count; i += lanes) sum = hn::MulAdd(hn::LoadU(d, numbers + i), zero, sum);
  return hn::AllTrue(d, hn::Eq(sum, zero));
}

}  // namespace

extern const FiniteKernels finite_kernels;
constinit const FiniteKernels finite_kernels{all};

}  // namespace noether::NOETHER_SIMD_LEVEL
