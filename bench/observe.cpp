/// What a look costs: six bodies with a monitor of energy at every step, against the bare run.
///
/// Protocol: 51 slices of 20 000 steps, watched and bare in turn; medians of processor times, and of their ratios.

#include "bench/planets.hpp"

#include "engine/monitors.hpp"

using namespace noether;

namespace {

constexpr std::int64_t slice_steps = 20'000;

void measure(const bench::Rows& rows, const std::string& name, Simulation<double> bare, Simulation<double> watched) {
  watched.every(1, Energy{});
  std::vector<double> looks, ratios;
  for (int slice = 0; slice <= 50; ++slice) {
    const double step = bench::step_ns(bare, slice_steps), seen = bench::step_ns(watched, slice_steps);
    if (slice == 0) continue;  // warm-up
    looks.push_back(seen - step);
    ratios.push_back(seen / step);
  }
  rows.add(name, "settle_ns", bench::Measured(looks), "ns", 6);
  rows.add(name, "watched_over_bare", bench::Measured(ratios), "1", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("observe", count, arguments);
  set_thread_count(1);
  measure(rows, "leapfrog6", bench::leapfrog6(), bench::leapfrog6());
  measure(rows, "wh6", bench::wh6(), bench::wh6());
}
