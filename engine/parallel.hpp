#pragma once
/// Loops over particles that give the same bits for any number of threads.

#include "engine/types.hpp"

#include <algorithm>
#include <atomic>
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

namespace detail {

/// Blocks for some threads: each has a range of its own, the same in every loop of one length, so that what it has
/// written stays in its cache; whoever is done helps the others, so that one on a busy core lets nobody wait.
class Shares {
 public:
  Shares(Index blocks, int threads) : blocks_(blocks), ranges_(std::min(threads, most_ranges)) {
    for (int r = 0; r < ranges_; ++r) next_[r].block.store(begin(r), std::memory_order_relaxed);
    at_a_time_ = std::max(Index(1), blocks / (16 * threads));
  }
  template <class Body> void take(int thread, const Body& body) {
    for (int k = 0; k < ranges_; ++k) {
      const int r = (thread + k) % ranges_;
      const Index end = begin(r + 1);
      while (true) {
        const Index from = next_[r].block.fetch_add(at_a_time_, std::memory_order_relaxed);
        if (from >= end) break;
        for (Index b = from; b < std::min(end, from + at_a_time_); ++b) body(b);
      }
    }
  }

 private:
  static constexpr int most_ranges = 64;
  struct alignas(64) Next {
    std::atomic<Index> block{0};
  };
  Index begin(int range) const { return blocks_ * range / ranges_; }

  Index blocks_, at_a_time_;
  int ranges_;
  Next next_[most_ranges];
};

}  // namespace detail

/// Calls `body(begin, end)` for every block of [0, n); blocks may run at the same time, each by one thread.
///
/// The owner of a block computes all of it, so results cannot depend on the number of threads.
/// @throws never; `body` must not throw
template <class Body> void for_blocks(Index n, const Body& body) {
  const Index blocks = (n + block_size - 1) / block_size;
#ifdef _OPENMP
  if (n >= parallel_threshold && thread_count() > 1) {
    detail::Shares shares(blocks, thread_count());
#pragma omp parallel num_threads(thread_count())
    shares.take(omp_get_thread_num(), [&](Index b) { body(b * block_size, std::min(n, (b + 1) * block_size)); });
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
