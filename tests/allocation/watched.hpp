#pragma once
/// Allocations of one size, counted by the operators new of this program (allocation_test.cpp).

#include <atomic>
#include <cstddef>

namespace noether::test {

extern std::atomic<std::size_t> watched_bytes;  ///< the size that is counted
extern std::atomic<long> watched_allocations;   ///< how many there have been

}  // namespace noether::test
