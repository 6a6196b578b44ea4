#pragma once
/// The loop of pair forces over the groups of a neighbor list.

#include "engine/exact_sum.hpp"
#include "engine/neighbor_list.hpp"
#include "engine/parallel.hpp"
#include "forces/pair_row.hpp"
#include "forces/pairs.hpp"

#include <array>
#include <atomic>
#include <limits>

namespace noether::detail {

/// What sums of pairs count, powers of two.
struct PairUnits {
  double force, energy;  ///< [mass length/time^2], [energy]; the virial counts the same as the energy
};

/// Sums of a block that depend on no order.
struct PairTotals {
  ExactSum energy;
  std::array<ExactSum, 6> virial;

  PairTotals& operator+=(const PairTotals& other) {
    energy += other.energy;
    for (std::size_t k = 0; k < 6; ++k) virial[k] += other.virial[k];
    return *this;
  }
};

/// The lowest index that any thread names.
class Lowest {
 public:
  void offer(Index i) {
    Index known = lowest_.load();
    while (i < known && !lowest_.compare_exchange_weak(known, i)) {
    }
  }
  Index value() const { return lowest_.load(); }

 private:
  std::atomic<Index> lowest_ = std::numeric_limits<Index>::max();
};

/// Adds what the neighbors of each particle do to it.
/// @param kernel  (group, sums, careful): fills PairSums of a group; asked again with care if a pair is `close`
/// @param force  as messages call it
template <class Kernel>
void add_pair_groups(ForceSink<double>& out, const ParticleSystem<double>& s, const NeighborList& list,
                     const PairUnits& units, std::string_view force, const Kernel& kernel) {
  constexpr Index size = NeighborList::group_size;
  const bool sums = out.wants_energy() || out.wants_virial();
  double* a[3] = {out.accelerations().component(0), out.accelerations().component(1), out.accelerations().component(2)};
  const double* mass = s.masses().data();
  Lowest overlapping;
  const auto block = [&](Index begin, Index end) {
    PairTotals totals;
    PairSums found;
    for (Index g = begin / size; g < end / size; ++g) {
      const NeighborList::Group one = list.group(g);
      if (g + 1 < end / size) {  // so that what the next eight need is there in time
        const std::int32_t* next = one.particles + size;
        for (Index lane = 0; lane < size; ++lane) {
          const std::int32_t i = next[lane];
          __builtin_prefetch(mass + i);
          for (const double* column : a) __builtin_prefetch(column + i, 1);
        }
      }
      const PairGroup group{one.records, one.entries, one.rows};
      kernel(group, found, false);
      if (found.close) {
        kernel(group, found, true);
        for (Index lane = 0; lane < size; ++lane) {
          if (found.strong[lane]) overlapping.offer(one.particles[lane]);
        }
      }
      for (Index lane = 0; lane < size; ++lane) {
        const std::int32_t i = one.particles[lane];
        if (i < 0) continue;
        if (mass[i] != 0) {
          const double scale = units.force / mass[i];
          for (int k = 0; k < 3; ++k) a[k][i] += static_cast<double>(found.force[k][lane]) * scale;
        }
        if (!sums) continue;
        totals.energy += found.energy[lane];
        for (std::size_t k = 0; k < 6; ++k) totals.virial[k] += found.virial[k][lane];
      }
    }
    return totals;
  };
  const Index lanes = list.groups() * size;
  if (sums) {
    const PairTotals totals = reduce(lanes, PairTotals{}, block);
    out.energy(totals.energy.times(units.energy) / 2);
    Mat3<double> w;
    const auto virial = [&](std::size_t k) { return totals.virial[k].times(units.energy) / 2; };
    w << virial(0), virial(3), virial(4), virial(3), virial(1), virial(5), virial(4), virial(5), virial(2);
    out.virial(w);
  } else {
    for_blocks(lanes, [&](Index begin, Index end) { block(begin, end); });
  }
  if (overlapping.value() < s.size()) out.fail(overlap(s, overlapping.value(), force));
}

}  // namespace noether::detail
