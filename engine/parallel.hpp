#pragma once
/// Loops over particles that give the same bits for any number of threads.

#include "engine/types.hpp"

#include <algorithm>
#include <vector>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace noether {

/// Threads that `for_blocks` and `reduce` may use; 1 without OpenMP.
int thread_count();
/// Sets that number. @throws Error if it is below 1
void set_thread_count(int threads);

/// Particles in one block: blocks are fixed by the problem, never by the number of threads.
inline constexpr Index block_size = 64;
/// Below this many particles a loop runs on the calling thread: waking others costs more.
inline constexpr Index parallel_threshold = 256;

/// Calls `body(begin, end)` for every block of [0, n); blocks may run at the same time, each by one thread.
///
/// The owner of a block computes all of it, so results cannot depend on the number of threads.
/// @throws never; `body` must not throw
template <class Body> void for_blocks(Index n, const Body& body) {
  const Index blocks = (n + block_size - 1) / block_size;
#ifdef _OPENMP
  if (n >= parallel_threshold && thread_count() > 1) {
    // Threads come back for more until all is done: one on a busy core does not let the others wait.
    const Index share = std::max(Index(1), blocks / (16 * thread_count()));
#pragma omp parallel for schedule(dynamic, share) num_threads(thread_count())
    for (Index b = 0; b < blocks; ++b) body(b * block_size, std::min(n, (b + 1) * block_size));
    return;
  }
#endif
  for (Index b = 0; b < blocks; ++b) body(b * block_size, std::min(n, (b + 1) * block_size));
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
