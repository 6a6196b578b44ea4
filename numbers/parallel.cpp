#include "numbers/parallel.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#ifdef _OPENMP
#include <omp.h>

#include <atomic>
#include <cstdint>
#include <system_error>
#include <thread>
#endif

namespace noether {

#ifdef _OPENMP

namespace {

constexpr int most_threads = 65536;

/// OpenMP's number until somebody sets another: what OMP_NUM_THREADS says, or the processors that this process may use.
std::atomic<int>& threads_in_use() {
  static std::atomic<int> threads(std::min(omp_get_max_threads(), most_threads));
  return threads;
}

/// A hint to the processor that this thread waits in a loop.
void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Waits until `value` is no longer `old`, awake for some microseconds, then asleep: a thread that waits awake keeps
/// its core from those who compute.
template <class T> T changed(const std::atomic<T>& value, T old) {
  for (int k = 0; k < 1000; ++k) {
    if (const T now = value.load(std::memory_order_acquire); now != old) return now;
    pause();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

/// The blocks of one loop. Each thread has a range of its own, the same in every loop of one length, so that what it
/// has written stays in its cache; whoever is done helps the others, so that one on a busy core lets nobody wait.
class Shares {
 public:
  Shares(Index blocks, int threads, void (*run)(const void*, Index), const void* body)
      : blocks_(blocks),
        at_a_time_(std::max(Index(1), blocks / (Index(16) * threads))),
        ranges_(std::min(threads, most_ranges)),
        threads_(threads),
        run_(run),
        body_(body) {
    for (int r = 0; r < ranges_; ++r) next_[r].block.store(begin(r), std::memory_order_relaxed);
  }
  int threads() const { return threads_; }
  void take(int thread) {
    for (int k = 0; k < ranges_; ++k) {
      const int r = (thread + k) % ranges_;
      const Index end = begin(r + 1);
      while (true) {
        const Index from = next_[r].block.fetch_add(at_a_time_, std::memory_order_relaxed);
        if (from >= end) break;
        for (Index b = from; b < std::min(end, from + at_a_time_); ++b) run_(body_, b);
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
  int ranges_, threads_;
  void (*run_)(const void*, Index);
  const void* body_;
  Next next_[most_ranges];
};

/// The threads of this process that help a loop along: threads of OpenMP, in a parallel region that never ends.
///
/// The caller waits for those who have come, never for one that has still to wake up: on a busy machine it computes
/// everything itself, about as fast as alone. At the end of a parallel region of its own each loop would wait for all,
/// awake: beside two other programs two threads were 30 times slower than one.
class Team {
 public:
  /// @return false if the team is busy: with a loop of another thread, or with the one that this call is part of.
  bool share(Index blocks, int threads, void (*run)(const void*, Index), const void* body) {
    if (busy_.exchange(true, std::memory_order_acquire)) return false;
    threads = static_cast<int>(std::min<Index>(threads, blocks));
    hire(threads - 1);
    Shares shares(blocks, threads, run, body);
    shares_ = &shares;
    inside_.store(0, std::memory_order_release);  // the door is open
    loop_.fetch_add(1, std::memory_order_release);
    loop_.notify_all();
    shares.take(0);
    std::uint32_t inside = inside_.fetch_or(closed, std::memory_order_acq_rel) | closed;
    while (inside != closed) inside = changed(inside_, inside);
    busy_.store(false, std::memory_order_release);
    return true;
  }

 private:
  static constexpr std::uint32_t closed = 1u << 31;

  /// Starts helpers until there are `helpers`, or as many as the system allows, each in a parallel region of its own:
  /// OpenMP would end the program where it gets no thread. They end with the process.
  void hire(int helpers) {
    while (helpers_ < helpers) {
      try {
        std::thread([this, own = helpers_ + 1] {
#pragma omp parallel num_threads(1)
          help(own);
        }).detach();
      } catch (const std::system_error&) {  // there are no more to be had: the others and the caller compute
        return;
      }
      ++helpers_;
    }
  }

  [[noreturn]] void help(int thread) {
    std::uint32_t seen = 0;
    while (true) {
      seen = changed(loop_, seen);
      if (!enter()) continue;
      if (thread < shares_->threads()) shares_->take(thread);
      if (inside_.fetch_sub(1, std::memory_order_acq_rel) == closed + 1) inside_.notify_one();
    }
  }
  bool enter() {
    std::uint32_t inside = inside_.load(std::memory_order_relaxed);
    while (inside < closed) {
      if (inside_.compare_exchange_weak(inside, inside + 1, std::memory_order_acquire)) return true;
    }
    return false;
  }

  alignas(64) std::atomic<std::uint32_t> loop_{0};         // counts loops; helpers wait for it
  alignas(64) std::atomic<std::uint32_t> inside_{closed};  // helpers in this loop, and whether the door is closed
  alignas(64) std::atomic<bool> busy_{false};
  int helpers_ = 0;
  Shares* shares_ = nullptr;
};

}  // namespace

int thread_count() { return threads_in_use().load(std::memory_order_relaxed); }

void detail::share_blocks(Index blocks, void (*run)(const void* body, Index block), const void* body) {
  static Team& team = *new Team;  // never destroyed: helpers may wait on it while the process ends
  if (team.share(blocks, thread_count(), run, body)) return;
  for (Index b = 0; b < blocks; ++b) run(body, b);
}

#else

int thread_count() { return 1; }

void detail::share_blocks(Index blocks, void (*run)(const void* body, Index block), const void* body) {
  for (Index b = 0; b < blocks; ++b) run(body, b);
}

#endif

void set_thread_count(int threads) {
  if (threads < 1) throw Error(fmt::format("{} threads were requested; at least 1 is needed", threads));
#ifdef _OPENMP
  threads_in_use().store(std::min(threads, most_threads), std::memory_order_relaxed);
#endif
}

}  // namespace noether
