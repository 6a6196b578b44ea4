#pragma once
/// A type of 113 bits for constants that are made while `*_simd.cpp` is compiled. Others use `Quad`.

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 WideConstant;
#else
using WideConstant = long double;  // on processors where that has fewer bits numbers/real.hpp refuses to compile
#endif

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
