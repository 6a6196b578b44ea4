// The book of costs: whose time it is where parts call each other, and that a closed book costs nothing.

#include "numbers/cost_book.hpp"

#include "numbers/error.hpp"
#include "tests/support/catch.hpp"

#include <chrono>
#include <string>
#include <thread>

namespace noether {
namespace {

using Stopwatch = std::chrono::steady_clock;

/// Works for so many seconds; returns how many it were.
double work(double seconds) {
  const auto begin = Stopwatch::now();
  const auto passed = [&] { return std::chrono::duration<double>(Stopwatch::now() - begin).count(); };
  while (passed() < seconds) {
  }
  return passed();
}

double seconds_of(const CostBook& book, const std::string& kind, const std::string& name = "") {
  double seconds = -1;
  for (const CostBook::Entry& one : book.entries()) {
    if (one.kind == kind && one.name == name) seconds = one.seconds;
  }
  return seconds;
}

}  // namespace

TEST_CASE("each part is charged what it spends itself, and what nobody claims is the integrator's", "[cost_book]") {
  const auto begin = Stopwatch::now();
  const CostBook book;
  double force = 0, neighbors = 0, other = 0;
  for (int k = 0; k < 3; ++k) {
    const Spent spent("force", "lennard_jones");
    force += work(0.01);
    {
      const Spent inside("neighbors");
      neighbors += work(0.02);
    }
    force += work(0.005);
  }
  {
    const Spent spent("force", [] { return std::string("bonded"); });
    other += work(0.004);
  }
  work(0.003);
  const double all = std::chrono::duration<double>(Stopwatch::now() - begin).count();
  // A busy machine may take the processor away between the two looks at its clock, from any of them.
  const double slack = all - force - neighbors - other - 0.003 + 1e-4;
  CHECK(seconds_of(book, "force", "lennard_jones") >= force);
  CHECK(seconds_of(book, "force", "lennard_jones") <= force + slack);
  CHECK(seconds_of(book, "neighbors") >= neighbors);
  CHECK(seconds_of(book, "neighbors") <= neighbors + slack);
  CHECK(seconds_of(book, "force", "bonded") >= other);
  CHECK(seconds_of(book, "force", "bonded") <= other + slack);
  CHECK(seconds_of(book, "integrator") >= 0.003);
  const auto entries = book.entries();
  REQUIRE(entries.size() == 4);
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    sum += entries[k].seconds;
    if (k > 0) CHECK(entries[k - 1].seconds >= entries[k].seconds);
  }
  CHECK(sum >= all);
  CHECK(sum < std::chrono::duration<double>(Stopwatch::now() - begin).count());
}

TEST_CASE("nothing is charged while no book is open, nor by other threads", "[cost_book]") {
  int asked = 0;
  const auto name = [&] {
    ++asked;
    return std::string("x");
  };
  { const Spent spent("force", name); }
  CHECK(asked == 0);
  {
    const CostBook book;
    std::thread([&] { const Spent spent("force", name); }).join();
    CHECK(asked == 0);
    { const Spent spent("force", name); }
    CHECK(asked == 1);
    CHECK(book.entries().size() == 2);
    CHECK_THROWS_AS(CostBook(), LogicError);
  }
  CostBook again;
  CHECK(again.entries().size() == 1);
  work(0.01);
  const auto anew = Stopwatch::now();
  again.begin_anew();
  const double since = seconds_of(again, "integrator");
  CHECK(since <= std::chrono::duration<double>(Stopwatch::now() - anew).count());
}

}  // namespace noether
