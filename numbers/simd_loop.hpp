#pragma once
/// Plain loops that the compiler turns into lanes, compiled once per SIMD level where they are used.

#include "numbers/simd.hpp"

namespace noether {

namespace detail {

#if defined(__clang__)
#define NOETHER_AVX512_LOOPS "avx512f,avx512dq,avx512vl"
#else
#define NOETHER_AVX512_LOOPS "avx512f,avx512dq,avx512vl,prefer-vector-width=512"
#endif

template <auto loop, class Function = decltype(loop)> struct SimdLoop;

/// What `loop` calls is made part of it: functions of a header are compiled for the level as well, and none of these
/// copies has a name that other sources could meet.
template <auto loop, class Result, class... Arguments> struct SimdLoop<loop, Result (*)(Arguments...)> {
  [[gnu::flatten]] static Result base(Arguments... arguments) { return loop(arguments...); }
#if NOETHER_SIMD_LEVELS
  [[gnu::flatten, gnu::target("avx2,fma")]] static Result avx2(Arguments... arguments) { return loop(arguments...); }
  [[gnu::flatten, gnu::target(NOETHER_AVX512_LOOPS)]] static Result avx512(Arguments... arguments) {
    return loop(arguments...);
  }
  static auto in_use() { return at_simd_level<Result (*)(Arguments...)>(base, avx2, avx512); }
#else
  static auto in_use() { return base; }
#endif
};

#undef NOETHER_AVX512_LOOPS

}  // namespace detail

/// The copy for the level in use of an inline function that loops over numbers: best without branches or calls.
template <auto loop> auto simd_loop() { return detail::SimdLoop<loop>::in_use(); }

}  // namespace noether
