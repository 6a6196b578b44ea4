#pragma once
/// What a test sets for the whole process, and puts back.

#include "engine/parallel.hpp"
#include "engine/simd.hpp"

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

}  // namespace noether::test
