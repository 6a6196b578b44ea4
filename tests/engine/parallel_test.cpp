/// Loops in fixed blocks: every particle once, sums in block order, whatever the number of threads.

#include "numbers/parallel.hpp"

#include "numbers/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"
#include "tests/support/settings.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace noether {
namespace {

double harmonic(Index n) {
  return reduce(n, 0.0, [](Index begin, Index end) {
    double sum = 0;
    for (Index i = begin; i < end; ++i) sum += 1.0 / static_cast<double>(i + 1);
    return sum;
  });
}

/// The same sum by hand: blocks of 64, added in order.
double harmonic_in_blocks(Index n) {
  double total = 0;
  for (Index begin = 0; begin < n; begin += block_size) {
    double sum = 0;
    for (Index i = begin; i < std::min(n, begin + block_size); ++i) sum += 1.0 / static_cast<double>(i + 1);
    total += sum;
  }
  return total;
}

}  // namespace

TEST_CASE("every index is visited once, in blocks of a fixed size", "[parallel]") {
  for (const int threads : {1, 2, 3, 8}) {
    const test::Threads use(threads);
    for (const Index n : {0, 1, 63, 64, 65, 255, 256, 1000}) {
      CAPTURE(threads, n);
      std::vector<int> visits(static_cast<std::size_t>(n), 0);
      std::vector<int> whole(static_cast<std::size_t>(n), 1);
      for_blocks(n, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) visits[static_cast<std::size_t>(i)] += begin % block_size == 0 ? 1 : 100;
      });
      CHECK(visits == whole);
    }
  }
}

TEST_CASE("a sum is that of its blocks in order, for any number of threads", "[parallel]") {
  for (const Index n : {0, 1, 64, 65, 300, 5000}) {
    const double expected = harmonic_in_blocks(n);
    for (const int threads : {1, 2, 3, 8}) {
      const test::Threads use(threads);
      CAPTURE(threads, n);
      CHECK(harmonic(n) == expected);
    }
  }
}

TEST_CASE("loops that call loops, and loops of several threads at once, give the same bits", "[parallel]") {
  const double expected = harmonic_in_blocks(5000);
  for (const int threads : {1, 2, 3, 8}) {
    const test::Threads use(threads);
    CAPTURE(threads);
    std::vector<double> inner(20);
    for_blocks(20 * block_size,
               [&](Index begin, Index) { inner[static_cast<std::size_t>(begin / block_size)] = harmonic(5000); });
    CHECK(inner == std::vector<double>(20, expected));

    std::vector<double> outer(3);
    std::vector<std::thread> callers;
    for (double& sum : outer) {
      callers.emplace_back([&sum, expected] {
        sum = expected;
        for (int k = 0; k < 50; ++k) sum = sum == expected ? harmonic(5000) : sum;
      });
    }
    for (std::thread& caller : callers) caller.join();
    CHECK(outer == std::vector<double>(3, expected));
  }
}

TEST_CASE("several threads share one loop", "[parallel]") {
  const test::Threads use(2);
  if (thread_count() == 1) return;  // without OpenMP
  // Whoever waits in a block keeps that block; the loop ends only if another thread takes the other one.
  std::atomic<int> begun{0};
  std::vector<std::thread::id> by(2);
  for_blocks(2 * parallel_threshold, [&](Index begin, Index) {
    if (begin != 0 && begin != parallel_threshold) return;
    by[begin == 0 ? 0 : 1] = std::this_thread::get_id();
    ++begun;
    test::wait_until([&] { return begun == 2; });
  });
  CHECK(begun == 2);
  CHECK(by[0] != by[1]);
}

TEST_CASE("a sum in another order has other bits, so the equality above means something", "[parallel]") {
  double backwards = 0;
  for (Index i = 5000; i > 0; --i) backwards += 1.0 / static_cast<double>(i);
  CHECK(backwards != harmonic(5000));
}

TEST_CASE("fewer than one thread are refused", "[parallel]") {
  CHECK_THROWS_WITH(set_thread_count(0), "0 threads were requested; at least 1 is needed");
  CHECK_THROWS_WITH(set_thread_count(-3), "-3 threads were requested; at least 1 is needed");
}

}  // namespace noether
