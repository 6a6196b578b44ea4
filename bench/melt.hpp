#pragma once
/// Melts that benchmarks drive by themselves, and LAMMPS on the same.

#include "bench/support.hpp"
#include "engine/neighbor_options.hpp"
#include "engine/particle_system.hpp"
#include "integrators/composition.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace noether::bench {

struct Melt {
  std::string name;
  std::function<void(int)> run;  ///< so many steps
  std::function<NeighborStatistics()> neighbors;
  Index size = 0;
  std::vector<double> rates = {};  ///< [1/s]

  /// Atoms times steps in a second: of processor time on one thread, of wall time on more.
  double rate(int steps) {
    const auto work = [&] { run(steps); };
    return static_cast<double>(size) * steps / (thread_count() == 1 ? processor_seconds_of(work) : seconds_of(work));
  }
};

template <class H>
Melt melt(std::string name, ParticleSystem<double> atoms, H hamiltonian, const Scheme& scheme, double step) {
  struct State {
    ParticleSystem<double> atoms;
    Composition<H> integrator;
  };
  const auto state = std::make_shared<State>(State{std::move(atoms), Composition<H>(std::move(hamiltonian), scheme)});
  state->atoms.clock() = Clock<double>::fixed(0, step);
  state->integrator.bind(state->atoms);
  return {std::move(name),
          [state](int steps) { static_cast<void>(state->integrator.advance(state->atoms, {.steps = steps})); },
          [state] { return state->integrator.evaluations().neighbors.value_or(NeighborStatistics{}); },
          state->atoms.size()};
}

/// Lets melts take turns: 200 steps each to settle, then 7 slices of so many.
inline void take_turns(std::vector<Melt>& melts, int steps) {
  for (Melt& one : melts) {
    one.rates.clear();
    one.run(200);
  }
  for (int repeat = 0; repeat < 7; ++repeat) {
    for (Melt& one : melts) one.rates.push_back(one.rate(steps));
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

/// What a peer's script of bench/peers prints: version, and seconds of 100 steps; nothing where the peer is absent.
inline std::optional<Peer> peer(const std::string& name, const std::string& script, Index atoms) {
  std::istringstream words(
      output_of(fmt::format("OMP_NUM_THREADS=1 python3 '{}/bench/peers/{}", NOETHER_SOURCE_DIR, script)));
  std::string version;
  double seconds = 0;
  if (!(words >> version >> seconds)) return {};
  return Peer{name, version, static_cast<double>(atoms) * 100 / seconds};
}

/// LAMMPS in processor time of one core. @param melt  arguments of bench/peers/lammps_melt.py
inline std::optional<Peer> lammps(const std::string& name, const std::string& melt, Index atoms) {
  return peer(name, "lammps_melt.py' " + melt, atoms);
}

/// GROMACS in wall time of one core. @param program  gmx_d, or gmx for mixed precision
inline std::optional<Peer> gromacs(const std::string& program, Index atoms) {
  return peer(program, "gromacs_melt.py' " + program, atoms);
}

}  // namespace noether::bench
