#pragma once
/// The lesser of two numbers, lane by lane. For `*_simd.cpp` alone.

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

template <class V> HWY_INLINE V lesser(V a, V b) {
#if HWY_TARGET == HWY_SCALAR
  return hwy::HWY_NAMESPACE::IfThenElse(hwy::HWY_NAMESPACE::Lt(b, a), b, a);  // its Min is of the standard library
#else
  return hwy::HWY_NAMESPACE::Min(a, b);
#endif
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
