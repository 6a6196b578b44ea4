/// What a look costs: six bodies with a monitor of energy at every step, against the bare run.
///
/// Protocol: 50 slices of 20 000 steps each, watched and bare in turn, after one to warm up; medians of processor
/// times, and of their ratios.

#include "bench/planets.hpp"

#include "engine/monitors.hpp"

using namespace noether;

namespace {

void measure(const bench::Rows& rows, const std::string& name, Simulation<double> bare, Simulation<double> watched) {
  watched.every(1, Energy{});
  const bench::Turns turns = bench::take_turns(bare, watched, 20'000);
  rows.add(name, "settle_ns", bench::Measured(turns.longer), "ns", 6);
  rows.add(name, "watched_over_bare", bench::Measured(turns.as_long), "1", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("observe", count, arguments);
  set_thread_count(1);
  measure(rows, "leapfrog6", bench::leapfrog6(), bench::leapfrog6());
  measure(rows, "wh6", bench::wh6(), bench::wh6());
}
