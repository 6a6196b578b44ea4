#pragma once
/// Melts that take turns: ours, and those of other programs.

#include "bench/peer_program.hpp"
#include "bench/support.hpp"
#include "engine/neighbor_options.hpp"
#include "engine/particle_system.hpp"
#include "integrators/composition.hpp"
#include "numbers/error.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether::bench {

struct Melt {
  std::string name;
  Index size = 0;
  std::function<double(int)> seconds;                  ///< that so many steps take
  std::function<NeighborStatistics()> neighbors = {};  ///< of ours
  std::string version = noether::version();            ///< of the program
  std::vector<double> rates = {};                      ///< atoms times steps in a second, turn by turn [1/s]

  void take_turn(int steps) { rates.push_back(static_cast<double>(size) * steps / seconds(steps)); }
  Measured rate() const { return Measured(rates); }
  /// [ns]
  Measured time_by_atom() const {
    std::vector<double> times;
    for (const double rate : rates) times.push_back(1e9 / rate);
    return Measured(times);
  }
};

/// One of ours, in processor time on one thread and in wall time on more.
template <class H>
Melt melt(std::string name, ParticleSystem<double> atoms, H hamiltonian, const Scheme& scheme, double step) {
  struct State {
    ParticleSystem<double> atoms;
    Composition<H> integrator;
  };
  const auto state = std::make_shared<State>(State{std::move(atoms), Composition<H>(std::move(hamiltonian), scheme)});
  state->atoms.clock() = Clock<double>::fixed(0, step);
  state->integrator.bind(state->atoms);
  const auto seconds = [state](int steps) {
    const auto work = [&] { static_cast<void>(state->integrator.advance(state->atoms, {.steps = steps})); };
    return thread_count() == 1 ? processor_seconds_of(work) : seconds_of(work);
  };
  const auto neighbors = [state] { return state->integrator.evaluations().neighbors.value_or(NeighborStatistics{}); };
  return {std::move(name), state->atoms.size(), seconds, neighbors};
}

/// Adds the melt of another program, on one core, if it is here, and says so if it is not.
/// @param command  a script of bench/peers: it is sent numbers of steps, and answers with their seconds
inline void add_peer(std::vector<Melt>& peers, const std::string& name, const std::string& command, Index size) {
  const auto program = std::make_shared<PeerProgram>(command);
  if (!program->version()) {
    fmt::print(stderr, "{} is not installed: it is left out of the comparison\n", name);
    return;
  }
  const auto seconds = [program, name](int steps) {
    const auto answer = program->ask(std::to_string(steps));
    if (!answer) throw Error(name + " has ended before its time");
    return std::stod(*answer);
  };
  peers.push_back({name, size, seconds, {}, *program->version()});
}

/// Lets melts and those of other programs take turns: two slices of so many steps each to settle, then 7 that count.
inline void take_turns(std::vector<Melt>& ours, std::vector<Melt>& peers, int steps) {
  const auto each = [&](const auto& body) {
    for (Melt& one : ours) body(one);
    for (Melt& one : peers) body(one);
  };
  each([steps](Melt& one) {
    one.rates.clear();
    one.seconds(2 * steps);
  });
  for (int turn = 0; turn < 7; ++turn) {
    each([steps](Melt& one) { one.take_turn(steps); });
  }
}
inline void take_turns(std::vector<Melt>& ours, int steps) {
  std::vector<Melt> nobody;
  take_turns(ours, nobody, steps);
}

/// Rows of the rate of a melt, one beside each of the others.
inline void add_rate(const Rows& rows, const Melt& melt, const std::vector<Melt>& peers = {}) {
  constexpr auto metric = "atom_steps_per_s", unit = "1/s";
  if (peers.empty()) rows.add(melt.name, metric, melt.rate(), unit, melt.size);
  for (const Melt& peer : peers) {
    rows.add(melt.name, metric, melt.rate(), unit, melt.size, Peer{peer.name, peer.version, peer.rate().median});
  }
}

/// Rows of the search for neighbors of a melt.
inline void add_search(const Rows& rows, const Melt& melt) {
  const NeighborStatistics list = melt.neighbors();
  const auto searches = static_cast<double>(list.searches);
  const auto add = [&](const char* metric, double value, const char* unit) {
    rows.add(melt.name, metric, Measured({value}), unit, melt.size);
  };
  add("search_ns_per_atom", 1e9 * list.search_seconds / searches / static_cast<double>(melt.size), "ns");
  add("steps_per_search", static_cast<double>(list.updates) / searches, "1");
  add("listed_pairs", list.pairs, "1");
  add("skin", list.skin, "sigma");
}

}  // namespace noether::bench
