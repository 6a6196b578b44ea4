/// What a look costs: six bodies with a monitor at every step, of energy where nothing else is said, against the bare
/// run.
///
/// Protocol: 50 slices of 20 000 steps each, watched and bare in turn, after one to warm up; medians of processor
/// times, and of their ratios.

#include "bench/planets.hpp"

#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"

using namespace noether;

namespace {

template <class M>
void measure(const bench::Rows& rows, const std::string& name, Simulation<double> bare, Simulation<double> watched,
             M monitor) {
  watched.every(1, std::move(monitor));
  const bench::Turns turns = bench::take_turns(bare, watched, 20'000);
  rows.add(name, "settle_ns", bench::Measured(turns.longer), "ns", 6);
  rows.add(name, "watched_over_bare", bench::Measured(turns.as_long), "1", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("observe", count, arguments);
  set_thread_count(1);
  measure(rows, "leapfrog6", bench::leapfrog6(), bench::leapfrog6(), Energy{});
  measure(rows, "leapfrog6/angular_momentum", bench::leapfrog6(), bench::leapfrog6(), AngularMomentum{});
  measure(rows, "leapfrog6/momentum", bench::leapfrog6(), bench::leapfrog6(), Momentum{});
  measure(rows, "leapfrog6/center_of_mass", bench::leapfrog6(), bench::leapfrog6(), CenterOfMass{});
  measure(rows, "leapfrog6/shadow", bench::leapfrog6(), bench::leapfrog6(), ShadowHamiltonian<>{});
  measure(rows, "wh6", bench::wh6(), bench::wh6(), Energy{});
}
