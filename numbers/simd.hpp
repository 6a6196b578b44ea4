#pragma once
/// Which instruction set the lane kernels use.
///
/// Code in lanes stands in `*_simd.cpp` alone. Each is compiled once per level, in a namespace named for it, and offers
/// plain functions on pointers in one table; `NOETHER_KERNELS` (numbers/kernels_simd.hpp) declares it for the others,
/// and picks the one of the level in use.

#include <atomic>
#include <cstdint>
#include <string_view>

namespace noether {

/// Levels of x86-64; other processors have the base level alone.
enum class SimdLevel : std::uint8_t {
  base,    ///< what every processor has: no fused multiply-add
  avx2,    ///< 4 doubles, fused multiply-add (x86-64-v3)
  avx512,  ///< 8 doubles (x86-64-v4)
};

std::string_view name(SimdLevel level);
/// The level of this name, as typed after `--simd`. @throws Error  with a proposal
SimdLevel simd_level_named(std::string_view text);

/// Whether this build and this processor have a level.
bool has_simd_level(SimdLevel level);
namespace detail {
/// The level in use; -1 before it was asked for.
extern constinit std::atomic<int> level_in_use;
SimdLevel use_highest_level();
}  // namespace detail

/// The level in use: the highest there is, unless another was set.
inline SimdLevel simd_level() {
  const int level = detail::level_in_use.load(std::memory_order_relaxed);
  return level >= 0 ? static_cast<SimdLevel>(level) : detail::use_highest_level();
}
/// Sets it, for all runs of this process: bits are the same at one level, and may differ from level to level.
/// @throws Error  if this build or this processor does not have it
void set_simd_level(SimdLevel level);

#if defined(__x86_64__)
#define NOETHER_SIMD_LEVELS 1  // kernels exist at every level
/// The table for the level in use.
template <class Table> const Table& at_simd_level(const Table& base, const Table& avx2, const Table& avx512) {
  const SimdLevel level = simd_level();
  return level == SimdLevel::avx512 ? avx512 : level == SimdLevel::avx2 ? avx2 : base;
}
#else
#define NOETHER_SIMD_LEVELS 0
#endif

}  // namespace noether
