#include "engine/finite_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// 0 times a number is 0, unless it is not finite; and what is no number spoils the sum.
bool all(const double* a, const double* b, std::ptrdiff_t count) {
  const Lanes d;
  const auto zero = hn::Zero(d);
  auto of_a = zero, of_b = zero;
  for (std::ptrdiff_t i = 0; i < count; i += lanes) {
    of_a = hn::MulAdd(hn::LoadU(d, a + i), zero, of_a);
    of_b = hn::MulAdd(hn::LoadU(d, b + i), zero, of_b);
  }
  return hn::AllTrue(d, hn::Eq(hn::Add(of_a, of_b), zero));
}

}  // namespace

extern const FiniteKernels finite_kernels;
constinit const FiniteKernels finite_kernels{all};

}  // namespace noether::NOETHER_SIMD_LEVEL
