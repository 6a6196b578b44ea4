#include "forces/pairs.hpp"

#include "engine/neighbor_list.hpp"

#include <fmt/format.h>

#include <limits>

namespace noether::detail {

void check_cutoff(double cutoff, std::optional<double> switch_from) {
  if (!(cutoff > 0 && cutoff < 1e100)) refuse_field("cutoff", cutoff, "is no cutoff; a length above 0 is expected");
  if (switch_from && !(*switch_from > 0 && *switch_from < cutoff)) {
    refuse_field("switch_from", *switch_from, fmt::format("does not lie between 0 and the cutoff {}", cutoff));
  }
}

namespace {

std::string called(const ParticleSystem<double>& s, Index i) {
  return s.name(i).empty() ? fmt::format("{}", s.ids()[static_cast<std::size_t>(i)]) : fmt::format("'{}'", s.name(i));
}

/// "particles 'a' and 'b' are 0.65 apart": `i` and the one nearest to it.
std::string nearest_to(const ParticleSystem<double>& s, Index i) {
  Index nearest = i;
  double least = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < s.size(); ++j) {
    if (j == i || (s.topology() != nullptr && s.topology()->is_special(i, j))) continue;
    const double r2 = norm2(s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j])));
    if (r2 < least) least = r2, nearest = j;
  }
  return fmt::format("particles {} and {} are {:.3g} apart", called(s, i), called(s, nearest), std::sqrt(least));
}

Failure overlap_of(Index i, std::string message) {
  return {.kind = Outcome::Kind::overlap, .particle = i, .quantity = "distance", .message = std::move(message)};
}

}  // namespace

Failure overlap(const ParticleSystem<double>& s, Index i, std::string_view force) {
  return overlap_of(i, fmt::format("{}, too close for their {} force", nearest_to(s, i), force));
}

Failure thrown(const ParticleSystem<double>& s, Index i, std::string_view force, double way) {
  return overlap_of(i, fmt::format("{}: their {} force would move {} by {:.3g} in one step, further than a step can "
                                   "follow; begin with [minimize], or take a smaller step",
                                   nearest_to(s, i), force, called(s, i), way));
}

Failure crowded(const ParticleSystem<double>& s, Index i, double range) {
  return overlap_of(i, fmt::format("{}, with more than {} others or images of them in the range {:.6g} of the pair "
                                   "forces, which no neighbor list can hold; take a lower density, or a shorter cutoff",
                                   nearest_to(s, i), NeighborList::most_neighbors, range));
}

}  // namespace noether::detail
