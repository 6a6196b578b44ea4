#include "forces/charged_molecules.hpp"

#include "engine/charge.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace noether::detail {

namespace {

/// How much wider than needed a range is at first, and where it was too narrow once.
constexpr double first_margin = 1.001, later_margin = 1.05;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// For each charge the charges whose pair force with it is excluded; empty where one has other than two.
std::vector<std::array<std::int32_t, 2>> partners_of(const ParticleSystem<double>& s) {
  const auto& q = s.column<Charge>();
  std::vector<std::array<std::int32_t, 2>> partners(at(s.size()), {-1, -1});
  bool two = true;
  const auto add = [&](Index i, Index j) {
    auto& known = partners[at(i)];
    if (known[1] >= 0) two = false;
    known[known[0] < 0 ? 0 : 1] = static_cast<std::int32_t>(j);
  };
  for (const auto& [i, j] : s.topology()->exclusions) {
    if (q[i] == 0 || q[j] == 0) continue;
    add(i, j);
    add(j, i);
  }
  for (Index i = 0; i < s.size(); ++i) two = two && (q[i] == 0 || partners[at(i)][1] >= 0);
  if (!two) partners.clear();
  return partners;
}

}  // namespace

bool ChargedMolecules::find(const ParticleSystem<double>& s) {
  members_ = s.members();
  topology_ = s.shared_topology();
  for (auto& column : particles_) column.clear();
  if (topology_ == nullptr || !topology_->scaled_pairs.empty()) return false;
  const auto& q = s.column<Charge>();
  const auto partners = partners_of(s);
  if (partners.empty()) return false;
  for (Index i = 0; i < s.size(); ++i) {
    const auto [j, k] = partners[at(i)];
    if (q[i] == 0 || i > std::min(j, k)) continue;  // of each three the first
    std::array<std::int32_t, sites> three = {static_cast<std::int32_t>(i), std::min(j, k), std::max(j, k)};
    for (const std::int32_t one : three) {
      for (const std::int32_t other : three) {
        const auto& known = partners[at(one)];
        if (one != other && known[0] != other && known[1] != other) return false;
      }
    }
    // The middle is the one whose charge the two others do not have.
    if (q[three[0]] == q[three[1]]) std::swap(three[0], three[2]);
    if (q[three[0]] == q[three[2]]) std::swap(three[0], three[1]);
    for (std::size_t site = 0; site < sites; ++site) particles_[site].push_back(three[site]);
  }
  if (particles_[0].empty()) return false;
  for (std::size_t site = 0; site < sites; ++site) charges_[site] = q[particles_[site].front()];
  middles_.choose(s, particles_[0]);
  range_ = 0;
  return true;
}

/// Whether the molecules are still those that were found.
bool ChargedMolecules::are_known(const ParticleSystem<double>& s) const {
  if (members_ != s.members() || topology_ != s.shared_topology()) return false;
  const double* const q = s.column<Charge>().data();
  for (std::size_t site = 0; site < sites; ++site) {
    for (const std::int32_t i : particles_[site]) {
      if (q[i] != charges_[site]) return false;
    }
  }
  const auto charged = std::count_if(q, q + s.size(), [](double one) { return one != 0; });
  return charged == static_cast<std::ptrdiff_t>(sites * particles_[0].size());
}

/// Takes where sites are from the middle of their molecule, and returns how far at most.
double ChargedMolecules::measure(const ParticleSystem<double>& s) {
  const auto count = static_cast<Index>(particles_[0].size());
  const Vec3<double> edges = s.box().edges(), half = edges / 2;
  for (auto& site : offsets_) {
    for (auto& axis : site) axis.resize(at(count));
  }
  std::atomic<std::uint64_t> longest{0};  // doubles that are not negative compare as their bits do
  for_blocks(count, [&](Index begin, Index end) {
    double block = 0;
    for (std::size_t site = 1; site < sites; ++site) {
      for (Index m = begin; m < end; ++m) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
          const double* const x = s.positions().component(k);
          const double d = x[particles_[site][at(m)]] - x[particles_[0][at(m)]];
          const double nearest = d > half[k] ? d - edges[k] : d < -half[k] ? d + edges[k] : d;
          offsets_[site - 1][static_cast<std::size_t>(k)][at(m)] = nearest;
          square += nearest * nearest;
        }
        if (square > block || std::isnan(square)) block = square;  // what is no number stays
      }
    }
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(block) & ~(std::uint64_t{1} << 63U);
    std::uint64_t known = longest.load();
    while (bits > known && !longest.compare_exchange_weak(known, bits)) {
    }
  });
  return std::sqrt(std::bit_cast<double>(longest.load()));
}

const double* ChargedMolecules::records() {
  const NeighborList& list = middles_.list();
  const std::vector<std::int32_t>& molecules = list.particles_of_records();
  const auto count = static_cast<Index>(molecules.size());
  const double* const from = list.records();
  records_.resize(4 * sites * (molecules.size() + 1));
  double* const to = records_.data();
  for_blocks(count + 1, [&](Index begin, Index end) {  // of nobody's too
    for (Index r = begin; r < end; ++r) {
      for (Index k = 0; k < 4; ++k) {
        const double middle = k < 3 ? from[4 * r + k] : 0;
        double* const record = to + 4 * static_cast<Index>(sites) * r + k;
        record[0] = middle;
        for (std::size_t site = 1; site < sites; ++site) {
          const bool somebody = r < count && k < 3;
          record[4 * site] = middle + (somebody ? offsets_[site - 1][at(k)][at(molecules[at(r)])] : 0);
        }
      }
    }
  });
  return to;
}

double ChargedMolecules::whole_spacing(const Box& box) {
  return std::ldexp(1.0, std::ilogb(box.edges().maxCoeff()) - 28);
}

/// Each particle in the box is rounded to a whole number; where it stands outside of it differs from there by rounded
/// edges. So places depend on no list. The furthest image of a list is 2.7 edges from the middle of the box, and
/// nobody's record at least 4.
const std::int32_t* ChargedMolecules::whole_records(const ParticleSystem<double>& s) {
  constexpr auto size = static_cast<Index>(4 * sites);
  const Box& box = s.box();
  const double per_length = 1 / whole_spacing(box);
  const auto whole = [=](double x) { return static_cast<std::int32_t>(std::lrint(x * per_length)); };
  Vec3<double> middle, edges = box.edges();
  std::array<std::uint32_t, 3> edge{};
  for (int k = 0; k < 3; ++k) {
    middle[k] = box.on_grid(k, std::floor(edges[k] / box.spacing(k) / 2) * box.spacing(k));
    edge[at(k)] = static_cast<std::uint32_t>(whole(edges[k]));
  }
  whole_sites_.resize(at(size) * particles_[0].size());
  for_blocks(static_cast<Index>(particles_[0].size()), [&](Index begin, Index end) {
    for (Index k = 0; k < 3; ++k) {
      const double* const x = s.positions().component(static_cast<int>(k));
      const double half = edges[k] / 2;
      for (Index m = begin; m < end; ++m) {
        const double own = x[particles_[0][at(m)]];
        for (std::size_t site = 0; site < sites; ++site) {
          const double there = x[particles_[site][at(m)]], d = there - own;
          const auto place = static_cast<std::uint32_t>(whole(there - middle[k]));
          whole_sites_[at(size * m + k) + 4 * site] = static_cast<std::int32_t>(d > half    ? place - edge[at(k)]
                                                                                : d < -half ? place + edge[at(k)]
                                                                                            : place);
        }
      }
    }
  });
  const NeighborList& list = middles_.list();
  const std::vector<std::int32_t>& molecules = list.particles_of_records();
  const double* const from = list.records();
  whole_records_.resize(at(size) * (molecules.size() + 1));
  std::int32_t* const to = whole_records_.data();
  const auto count = static_cast<Index>(molecules.size());
  for_blocks(count, [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) {
      const std::int32_t m = molecules[at(r)];
      for (Index k = 0; k < 3; ++k) {
        const double in_box = s.positions().component(static_cast<int>(k))[particles_[0][at(m)]] - middle[k];
        const auto crossed = static_cast<std::int32_t>(std::lrint((from[4 * r + k] - in_box) / edges[k]));
        const std::uint32_t shift = static_cast<std::uint32_t>(crossed) * edge[at(k)];
        for (Index site = 0; site < static_cast<Index>(sites); ++site) {
          const Index place = k + 4 * site;
          to[size * r + place] =
              static_cast<std::int32_t>(static_cast<std::uint32_t>(whole_sites_[at(size * m + place)]) + shift);
        }
      }
    }
  });
  std::fill_n(to + size * count, size, std::numeric_limits<std::int32_t>::min());
  return to;
}

bool ChargedMolecules::update(const ParticleSystem<double>& s, double range, NeighborList* shared) {
  if (!s.box().is_periodic()) return false;
  if (members_ == s.members() && topology_ == s.shared_topology() && particles_[0].empty()) return false;
  if (!are_known(s) && !(find(s) && are_known(s))) {
    particles_ = {};
    return false;
  }
  const Vec3<double> edges = s.box().edges();
  // Rounding to whole numbers, and distances in single precision, bring pairs nearer by less than that.
  const double rounding = 8 * whole_spacing(s.box()) + 0x1p-20 * range;
  const double needed = range + rounding + 2 * measure(s);
  for (int k = 0; k < 3; ++k) {
    // Nobody meets an image of itself, and the list need not round to a coarser grid than that of the box.
    const bool exact = std::ldexp(s.box().spacing(k), 53) > edges[k] / 2 + 1.5 * needed;
    if (!(edges[k] > 1.4 * needed && exact)) return false;
  }
  if (!(needed <= range_)) range_ = needed * (range_ == 0 ? first_margin : later_margin);
  middles_.update(s, range_, shared);
  return true;
}

ListedPairs ChargedMolecules::pairs() const {
  return {.list = middles_.list(),
          .sites = sites,
          .indices = {particles_[0].data(), particles_[1].data(), particles_[2].data()}};
}

}  // namespace noether::detail
