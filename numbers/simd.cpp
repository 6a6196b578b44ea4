#include "numbers/simd.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <atomic>
#include <string>
#include <vector>

namespace noether {

namespace {

constexpr SimdLevel levels[] = {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512};

SimdLevel best() {
  SimdLevel found = SimdLevel::base;
  for (const SimdLevel level : levels) {
    if (has_simd_level(level)) found = level;
  }
  return found;
}

}  // namespace

constinit std::atomic<int> detail::level_in_use{-1};

SimdLevel detail::use_highest_level() {
  const SimdLevel level = best();
  level_in_use.store(static_cast<int>(level), std::memory_order_relaxed);
  return level;
}

std::string_view name(SimdLevel level) {
  switch (level) {
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::base:
      break;
  }
  return "base";
}

SimdLevel simd_level_named(std::string_view text) {
  std::vector<std::string> known;
  for (const SimdLevel level : levels) {
    if (text == name(level)) return level;
    known.emplace_back(name(level));
  }
  throw Error(fmt::format("unknown SIMD level '{}'{}", text, did_you_mean(std::string(text), known)));
}

bool has_simd_level(SimdLevel level) {
  if (level == SimdLevel::base) return true;
#if NOETHER_SIMD_LEVELS
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                    __builtin_cpu_supports("bmi2") != 0 && __builtin_cpu_supports("aes") != 0 &&
                    __builtin_cpu_supports("pclmul") != 0;
  if (level == SimdLevel::avx2) return avx2;
  return avx2 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

void set_simd_level(SimdLevel level) {
  if (!has_simd_level(level)) {
    throw Error(fmt::format("SIMD level '{}' is not supported by this processor; its highest is '{}'", name(level),
                            name(best())));
  }
  detail::level_in_use.store(static_cast<int>(level), std::memory_order_relaxed);
}

}  // namespace noether
