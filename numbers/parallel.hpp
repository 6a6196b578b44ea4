#pragma once
/// Loops over particles that give the same bits for any number of threads.

#include "numbers/types.hpp"

#include <algorithm>
#include <vector>

namespace noether {

/// Threads that `for_blocks` and `reduce` may use: what OMP_NUM_THREADS says, or else as many as the processors that
/// this process may use; 1 without OpenMP.
int thread_count();
/// Sets that number; more than 65536 are as many. @throws Error if it is below 1
void set_thread_count(int threads);

/// Particles in one block: blocks are fixed by the problem, never by the number of threads.
inline constexpr Index block_size = 64;
/// Below this many particles a loop runs on the calling thread: waking others costs more.
inline constexpr Index parallel_threshold = 256;

namespace detail {

/// Calls `run(body, block)` for every block, each by one of thread_count() threads; see numbers/parallel.cpp.
void share_blocks(Index blocks, void (*run)(const void* body, Index block), const void* body);

}  // namespace detail

/// Calls `body(begin, end)` for every block of [0, n); blocks may run at the same time, each by one thread.
///
/// Whoever takes a block computes all of it, so results cannot depend on the number of threads.
/// @throws never; a `body` that throws ends the program
template <class Body> void for_blocks(Index n, const Body& body) {
  const Index blocks = (n + block_size - 1) / block_size;
  const auto run = [&body, n](Index b) noexcept { body(b * block_size, std::min(n, (b + 1) * block_size)); };
  if (n >= parallel_threshold && thread_count() > 1) {
    detail::share_blocks(
        blocks, [](const void* run_it, Index b) noexcept { (*static_cast<decltype(run)*>(run_it))(b); }, &run);
    return;
  }
  for (Index b = 0; b < blocks; ++b) run(b);
}

/// Sum over [0, n) of `partial(begin, end)`, one value per block, added in block order.
/// @cost allocates one value per block when n is above the block size
template <class T, class Partial> T reduce(Index n, T zero, const Partial& partial) {
  if (n <= block_size) {
    if (n > 0) zero += partial(Index(0), n);
    return zero;
  }
  std::vector<T> parts(static_cast<std::size_t>((n + block_size - 1) / block_size), zero);
  for_blocks(
      n, [&](Index begin, Index end) { parts[static_cast<std::size_t>(begin / block_size)] = partial(begin, end); });
  for (const T& part : parts) zero += part;
  return zero;
}

}  // namespace noether
