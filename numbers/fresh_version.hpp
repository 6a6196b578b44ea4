#pragma once
/// Numbers that name states: equal ones on copies mean equal values.

#include <atomic>
#include <cstdint>

namespace noether::detail {

/// A number no other call returns: names a state of the positions, so that a force already known is not computed again.
inline std::uint64_t fresh_version() {
  static std::atomic<std::uint64_t> next_thread{1};
  thread_local std::uint64_t version = next_thread.fetch_add(1) << 40U;
  return ++version;
}

}  // namespace noether::detail
