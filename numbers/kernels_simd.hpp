#pragma once
/// How `*_simd.hpp` offer what their `*_simd.cpp` define once per SIMD level.

#include "numbers/simd.hpp"

/// Declares `const Type name` at every level, and `name()`, the one of the level in use. Stands in namespace noether.
#if NOETHER_SIMD_LEVELS
#define NOETHER_KERNELS(Type, name) \
  namespace base {                  \
  extern const Type name;           \
  }                                 \
  namespace avx2 {                  \
  extern const Type name;           \
  }                                 \
  namespace avx512 {                \
  extern const Type name;           \
  }                                 \
  inline const Type& name() { return at_simd_level(base::name, avx2::name, avx512::name); }
#else
#define NOETHER_KERNELS(Type, name) \
  namespace base {                  \
  extern const Type name;           \
  }                                 \
  inline const Type& name() { return base::name; }
#endif
