#pragma once
/// The loop of pair forces over the groups of a neighbor list.

#include "forces/pair_row.hpp"
#include "forces/pairs.hpp"
#include "neighbors/neighbor_list.hpp"
#include "neighbors/neighbor_selection.hpp"
#include "numbers/exact_sum.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace noether::detail {

/// What sums of pairs count, powers of two.
struct PairUnits {
  double force, energy;  ///< [mass length/time^2], [energy]; the virial counts the same as the energy
};

/// A stronger pair is more than sums take, of whole units.
inline constexpr double strongest_pair = 0x1p61;

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

/// Which groups had pairs too close for quick sums when they were last summed: they are summed with care at once.
/// Either gives the same sums.
struct CloseGroups {
  std::vector<std::uint8_t> last_time;
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

/// The groups that a loop goes over: those of a list, or of a selection from it.
struct ListedPairs {
  const NeighborList& list;
  const NeighborSelection* selection = nullptr;  ///< of the list, up to date; null: all of it
  /// How many particles of the system each of the list stands for, and their indices in the order of the list; null:
  /// the list is one of the system.
  std::size_t sites = 1;
  std::array<const std::int32_t*, 3> indices = {};

  Index groups() const { return selection != nullptr ? selection->groups() : list.groups(); }
  NeighborList::Group group(Index g) const { return selection != nullptr ? selection->group(list, g) : list.group(g); }
  /// In the system, of a particle of the list, which is not -1.
  Index index(std::size_t site, Index i) const { return indices[site] != nullptr ? indices[site][i] : i; }
};

/// Whether a particle of a group has a neighbor so near that a kick moves it by more than their distance bears.
/// @param way2  square of what it is moved by, a h^2 [length^2]
inline bool is_thrown(const ParticleSystem<double>& s, const ListedPairs& pairs, const NeighborList::Group& group,
                      Index lane, std::size_t site, double way2) {
  const std::vector<std::int32_t>& particles = pairs.list.particles_of_records();
  const Index own = group.particles[lane], i = pairs.index(site, own);
  double least2 = std::numeric_limits<double>::infinity();
  for (Index row = 0; row < group.rows; ++row) {
    const auto record = static_cast<std::size_t>(group.entries[NeighborList::group_size * row + lane] / 4);
    if (record >= particles.size() || particles[record] == own) continue;  // nobody, or an image of itself
    for (std::size_t other = 0; other < pairs.sites; ++other) {
      const Vec3<double> d = s.positions()[i] - s.positions()[pairs.index(other, particles[record])];
      least2 = std::min(least2, norm2(s.box().minimum_image(d)));
    }
  }
  const double part = s.clock().step() == 0 ? thrown_at_start : thrown_later;
  return way2 > part * part * least2;
}

/// Asks a kernel, with care if a pair is close, and at once if one was so the last time. @return whether one is
template <class Kernel>
bool sum_group(const Kernel& kernel, const PairGroup& group, PairSums& found, std::uint8_t& was_close) {
  kernel(group, found, was_close != 0);
  if (found.close && was_close == 0) kernel(group, found, true);
  was_close = found.close ? 1 : 0;
  return found.close;
}

/// Adds what the neighbors of each particle do to it.
/// @param kernel  (group, sums, careful): fills PairSums of a group, one for each site; the first tells whether a pair
///   is `close`
/// @param limits  those that `kernel` knows, and what messages call the force
template <class Kernel>
void add_pair_groups(ForceSink<double>& out, const ParticleSystem<double>& s, const ListedPairs& pairs,
                     const PairUnits& units, const PairLimits& limits, const Kernel& kernel) {
  const NeighborList& list = pairs.list;
  if (list.crowded() >= 0) return out.fail(detail::crowded(s, pairs.index(0, list.crowded()), list.range()));
  constexpr Index size = NeighborList::group_size;
  const Index groups = pairs.groups();
  std::vector<std::uint8_t>& were_close = out.workspace().get<CloseGroups>().last_time;
  were_close.resize(static_cast<std::size_t>(groups));
  const bool sums = out.wants_energy() || out.wants_virial();
  double* a[3] = {out.accelerations().component(0), out.accelerations().component(1), out.accelerations().component(2)};
  const double* mass = s.masses().data();
  // Accelerations that move a particle so far in a kick that somebody is to look closer.
  const double range = out.neighbors() != nullptr ? out.neighbors()->range() : limits.range;
  const double kick2 = out.kick() * out.kick(), far = thrown_of_range * range / kick2, far2 = far * far;
  Lowest overlapping, thrown;
  const auto take = [&](const NeighborList::Group& one, std::size_t site, const PairSums& found, PairTotals& totals) {
    for (Index lane = 0; lane < size; ++lane) {
      if (one.particles[lane] < 0) continue;
      const Index i = pairs.index(site, one.particles[lane]);
      if (mass[i] != 0) {
        const double scale = units.force / mass[i];
        double square = 0;
        for (int k = 0; k < 3; ++k) {
          const double by = static_cast<double>(found.force[k][lane]) * scale;
          a[k][i] += by;
          square += by * by;
        }
        if (square > far2 && is_thrown(s, pairs, one, lane, site, square * kick2 * kick2)) thrown.offer(i);
      }
      if (!sums) continue;
      totals.energy += found.energy[lane];
      for (std::size_t k = 0; k < 6; ++k) totals.virial[k] += found.virial[k][lane];
    }
  };
  const auto block = [&](Index begin, Index end) {
    PairTotals totals;
    std::array<PairSums, 3> found;
    for (Index g = begin / size; g < end / size; ++g) {
      const NeighborList::Group one = pairs.group(g);
      if (g + 1 < end / size) {  // so that what the next eight need is there in time
        const std::int32_t* next = one.particles + size;
        for (Index lane = 0; lane < size; ++lane) {
          if (next[lane] < 0) continue;
          const Index i = pairs.index(0, next[lane]);
          __builtin_prefetch(mass + i);
          for (const double* column : a) __builtin_prefetch(column + i, 1);
        }
      }
      const PairGroup group{one.records, one.entries, one.rows};
      const bool close = sum_group(kernel, group, found[0], were_close[static_cast<std::size_t>(g)]);
      for (std::size_t site = 0; site < pairs.sites; ++site) {
        for (Index lane = 0; lane < size && close; ++lane) {
          if (found[site].strong[lane]) overlapping.offer(pairs.index(site, one.particles[lane]));
        }
        take(one, site, found[site], totals);
      }
    }
    return totals;
  };
  const Index lanes = groups * size;
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
  if (overlapping.value() < s.size()) {
    out.fail(overlap(s, overlapping.value(), limits.force, help_of_close_pairs(out.kick(), limits.nearest)));
  }
  if (thrown.value() < s.size()) {
    const Index i = thrown.value();
    const double way = std::sqrt(norm2(std::as_const(out.accelerations())[i])) * kick2;
    out.fail(detail::thrown(s, i, limits.force, way));
  }
}

}  // namespace noether::detail
