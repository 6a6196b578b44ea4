#include "monitors/radial_distribution.hpp"

#include "neighbors/cell_grid.hpp"
#include "numbers/parallel.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace noether {

namespace {

constexpr std::int64_t most_bins = 100'000;

/// Which particles stand at the first and at the second place of the pairs.
struct Places {
  std::vector<Index> first, second;
  std::vector<Index> molecules;  ///< of each particle, whose pairs with each other do not count; empty: all pairs count
  double pairs = 0;              ///< (i, j) with i != j that count
  bool same = false;             ///< both places are for the same particles
};

/// Whether the structure says which molecules there are: number 0 is none.
bool names_molecules(const Topology& topology) {
  return std::any_of(topology.molecules.begin(), topology.molecules.end(), [](std::int64_t m) { return m != 0; });
}

/// How many of the pairs are of one molecule.
double pairs_of_one_molecule(const Places& places) {
  std::vector<double> seconds(places.molecules.size());
  const auto molecule = [&](Index i) {
    return static_cast<std::size_t>(places.molecules[static_cast<std::size_t>(i)]);
  };
  for (const Index j : places.second) ++seconds[molecule(j)];
  double pairs = 0;
  for (const Index i : places.first) pairs += seconds[molecule(i)] - (places.same ? 1 : 0);
  return pairs;
}

Places places_of(const std::vector<std::string>& types, bool intramolecular, const Topology* topology, Index n) {
  Places places;
  for (Index i = 0; i < n; ++i) {
    const auto is = [&](std::size_t place) {
      return types.empty() || topology->type_names[static_cast<std::size_t>(topology->type(i))] == types[place];
    };
    if (is(0)) places.first.push_back(i);
    if (is(1)) places.second.push_back(i);
  }
  places.same = types.empty() || types[0] == types[1];
  const auto a = static_cast<double>(places.first.size()), b = static_cast<double>(places.second.size());
  places.pairs = a * (places.same ? b - 1 : b);
  if (!intramolecular) {
    places.molecules =
        names_molecules(*topology) ? molecules_by_number(*topology, n) : molecules_by_bonds(*topology, n);
    places.pairs -= pairs_of_one_molecule(places);
  }
  return places;
}

/// Particles and those of their images that are in range of the box, in cells. Coordinates are relative to the middle
/// of the box: on the grid of the box, images too, so that differences are exact.
class Neighborhood {
 public:
  Neighborhood(const Box& box, const std::array<std::vector<double>, 3>& x, const std::vector<Index>& chosen,
               double range) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Index i : chosen) x_[k].push_back(x[k][static_cast<std::size_t>(i)]);
    }
    owner_ = chosen;
    for (int k = 0; k < 3; ++k) add_images(k, box, range);
    const auto count = static_cast<Index>(owner_.size());
    grid_.sort({x_[0].data(), x_[1].data(), x_[2].data()}, count, range);
    for (std::vector<double>& one : x_) one = sorted(one);
    owner_ = sorted(owner_);
  }

  /// Calls `pair(j, r2)` for all particles j behind `last` that may be in range of `x`.
  template <class Pair> void around(const std::array<double, 3>& x, Index last, double range, const Pair& pair) const {
    grid_.near({x, x}, range, [&](Index begin, Index end) {
      for (Index p = begin; p < end; ++p) {
        const auto at = static_cast<std::size_t>(p);
        if (owner_[at] <= last) continue;
        const double dx = x[0] - x_[0][at], dy = x[1] - x_[1][at], dz = x[2] - x_[2][at];
        pair(owner_[at], dx * dx + dy * dy + dz * dz);
      }
    });
  }

 private:
  void add_images(int axis, const Box& box, double range) {
    const double edge = box.edges()[axis], middle = box.on_grid(axis, edge / 2);
    const auto k = static_cast<std::size_t>(axis);
    const std::size_t count = owner_.size();
    for (std::size_t p = 0; p < count; ++p) {
      const double x = x_[k][p];
      for (const double shift : {edge, -edge}) {
        if (x + shift < -middle - range || x + shift > edge - middle + range) continue;
        for (std::vector<double>& one : x_) one.push_back(one[p]);
        x_[k].back() = x + shift;
        owner_.push_back(owner_[p]);
      }
    }
  }

  template <class T> std::vector<T> sorted(const std::vector<T>& all) const {
    std::vector<T> result;
    result.reserve(all.size());
    for (const std::int32_t p : grid_.order()) result.push_back(all[static_cast<std::size_t>(p)]);
    return result;
  }

  std::array<std::vector<double>, 3> x_;
  std::vector<Index> owner_;
  CellGrid grid_;
};

std::string known_types(const Topology* topology, const std::string& type) {
  const std::vector<std::string> names = topology == nullptr ? std::vector<std::string>{} : topology->type_names;
  return names.empty() ? "; the particles have no types" : did_you_mean(type, names);
}

}  // namespace

void RadialDistribution::check() const {
  if (bins < 1 || bins > most_bins) {
    refuse_field("bins", std::to_string(bins),
                 fmt::format("is not a valid number of intervals; 1 to {} is expected", most_bins));
  }
  if (range && !(*range > 0 && std::isfinite(*range))) {
    refuse_field("range", *range, "is not a valid range; a length above 0 is expected");
  }
  if (!types.empty() && types.size() != 2) {
    refuse_field("types", fmt::format("[{}]", fmt::join(types, ", ")),
                 "is not a pair of types; give two types, or none for all pairs");
  }
}

void RadialDistribution::check_in(const Box& box, const Topology* topology) const {
  check();
  if (!box.is_periodic()) {
    throw Error(
        "monitor 'radial_distribution' needs a periodic box, because it divides by the density; give the particles a "
        "box");
  }
  const double half = box.edges().minCoeff() / 2;
  if (range && *range > half) {
    refuse_field("range", *range,
                 fmt::format("is beyond half of the shortest edge of the box; at most {} is expected", half));
  }
  for (const std::string& type : types) {
    const auto* names = topology == nullptr ? nullptr : &topology->type_names;
    if (names != nullptr && std::find(names->begin(), names->end(), type) != names->end()) continue;
    throw Error(fmt::format("unknown type '{}' in monitor 'radial_distribution'{}", type, known_types(topology, type)),
                {.key = "types", .value = type});
  }
  if (!intramolecular && (topology == nullptr || (!names_molecules(*topology) && topology->bonds.empty()))) {
    refuse_field("intramolecular", "false",
                 "has no effect, because there are neither molecules nor bonds; take it out");
  }
}

template <class Real> void RadialDistribution::observe(const Snapshot<Real>& now) {
  std::optional<Sites<Real>> sites;  // of rigid bodies: their atoms
  if (has_bodies(now.state())) sites.emplace(now.state());
  const ParticleSystem<Real>& s = sites ? sites->particles() : now.state();
  if (samples_ == 0) {
    reach_ = range.value_or(s.box().edges().minCoeff() / 2);
    counts_.assign(static_cast<std::size_t>(bins), 0);
    unit_ = now.units().is_reduced() ? "" : " " + std::string(now.units().length);
  }
  std::array<std::vector<double>, 3> x;
  for (int k = 0; k < 3; ++k) {
    const double middle = s.box().on_grid(k, s.box().edges()[k] / 2);
    for (Index i = 0; i < s.size(); ++i) {
      x[static_cast<std::size_t>(k)].push_back(static_cast<double>(s.positions().component(k)[i]) - middle);
    }
  }
  count(s.box(), s.topology(), x);
  ++samples_;
}

void RadialDistribution::count(const Box& box, const Topology* topology, const std::array<std::vector<double>, 3>& x) {
  const Places places = places_of(types, intramolecular, topology, static_cast<Index>(x[0].size()));
  const std::vector<Index>& molecules = places.molecules;
  const Neighborhood neighbors(box, x, places.second, reach_);
  const double reach2 = reach_ * reach_, width = reach_ / static_cast<double>(bins);
  for_blocks(static_cast<Index>(places.first.size()), [&](Index begin, Index end) {
    std::vector<std::int64_t> seen(counts_.size());
    for (Index place = begin; place < end; ++place) {
      const Index i = places.first[static_cast<std::size_t>(place)];
      const auto at = static_cast<std::size_t>(i);
      neighbors.around({x[0][at], x[1][at], x[2][at]}, places.same ? i : -1, reach_, [&](Index j, double r2) {
        if (!(r2 < reach2)) return;
        if (!molecules.empty() && molecules[at] == molecules[static_cast<std::size_t>(j)]) return;
        ++seen[std::min(seen.size() - 1, static_cast<std::size_t>(std::sqrt(r2) / width))];
      });
    }
    // Pairs of the same were found from one side. Whole numbers have one sum in any order.
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::int64_t more = places.same ? 2 * seen[k] : seen[k];
      if (more != 0) std::atomic_ref<std::int64_t>(counts_[k]).fetch_add(more, std::memory_order_relaxed);
    }
  });
  expected_ += places.pairs / box.volume();
  centers_ += static_cast<double>(places.first.size());
}

std::vector<double> RadialDistribution::values() const {
  std::vector<double> g(static_cast<std::size_t>(bins), std::numeric_limits<double>::quiet_NaN());
  const double width = reach_ / static_cast<double>(bins);
  for (std::size_t k = 0; k < counts_.size() && expected_ > 0; ++k) {
    const double inner = static_cast<double>(k), cubes = 3 * inner * (inner + 1) + 1;
    const double shell = 4 * std::numbers::pi / 3 * cubes * width * width * width;
    g[k] = static_cast<double>(counts_[k]) / (expected_ * shell);
  }
  return g;
}

std::vector<double> RadialDistribution::coordination() const {
  std::vector<double> neighbors(static_cast<std::size_t>(bins), std::numeric_limits<double>::quiet_NaN());
  std::int64_t within = 0;
  for (std::size_t k = 0; k < counts_.size() && centers_ > 0; ++k) {
    within += counts_[k];
    neighbors[k] = static_cast<double>(within) / centers_;
  }
  return neighbors;
}

std::vector<Series> RadialDistribution::series() const {
  std::vector<double> distances;
  for (std::int64_t k = 0; k < bins; ++k) distances.push_back(distance(k));
  const std::vector<Index> shape{static_cast<Index>(bins)};
  return {{"distance", "length", shape, std::move(distances)},
          {"value", "1", shape, values()},
          {"coordination", "1", shape, coordination()}};
}

MonitorReport RadialDistribution::report() const {
  MonitorReport report;
  report.samples = samples_;
  if (samples_ == 0) return report;
  if (!(expected_ > 0)) {
    report.reason = intramolecular ? "there are no pairs of these types"
                                   : "there are no pairs of these types in different molecules";
    return report;
  }
  const std::vector<double> g = values();
  const auto highest = std::max_element(g.begin(), g.end()) - g.begin();
  report.note = fmt::format("highest g = {:.4g} at r = {:.4g}{}; all {} intervals: see the trajectory file",
                            g[static_cast<std::size_t>(highest)], distance(highest), unit_, bins);
  return report;
}

void RadialDistribution::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  if (samples_ > 0 && counts_.size() != static_cast<std::size_t>(bins)) {
    throw Error(fmt::format("the saved radial_distribution has {} intervals; {} are expected", counts_.size(), bins));
  }
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(RadialDistribution);
#undef NOETHER_COMPILE

}  // namespace noether
