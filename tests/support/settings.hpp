#pragma once
/// What a test sets for the whole process, and puts back.

#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"

#include <vector>

namespace noether::test {

/// As many threads, while this lives.
class Threads {
 public:
  explicit Threads(int count) { set_thread_count(count); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { set_thread_count(before_); }

 private:
  int before_ = thread_count();
};

/// This SIMD level, while this lives.
class AtLevel {
 public:
  explicit AtLevel(SimdLevel level) { set_simd_level(level); }
  AtLevel(const AtLevel&) = delete;
  AtLevel& operator=(const AtLevel&) = delete;
  ~AtLevel() { set_simd_level(before_); }

 private:
  SimdLevel before_ = simd_level();
};

/// Every SIMD level of this processor.
inline std::vector<SimdLevel> all_levels() {
  std::vector<SimdLevel> all;
  for (const SimdLevel level : {SimdLevel::base, SimdLevel::avx2, SimdLevel::avx512}) {
    if (has_simd_level(level)) all.push_back(level);
  }
  return all;
}

}  // namespace noether::test
