#include "forces/pairs.hpp"

#include "neighbors/neighbor_list.hpp"

#include <fmt/format.h>

#include <limits>

namespace noether::detail {

void check_cutoff(double cutoff, Cutoff style, std::optional<double> switch_from) {
  if (!(cutoff > 0 && cutoff < 1e100))
    refuse_field("cutoff", cutoff, "is not a valid cutoff; a length above 0 is expected");
  if (switch_from && !(*switch_from > 0 && *switch_from < cutoff)) {
    refuse_field("switch_from", *switch_from, fmt::format("does not lie between 0 and the cutoff {}", cutoff));
  }
  if (switch_from && !is_switched(style)) {
    refuse_field("switch_from", *switch_from,
                 "is for a switched cutoff only; take it out, or add cutoff_style = \"switch_c2\" or \"switch_c4\"");
  }
}

namespace {

std::string called(const ParticleSystem<double>& s, Index i) {
  return s.name(i).empty() ? fmt::format("{}", s.ids()[static_cast<std::size_t>(i)]) : fmt::format("'{}'", s.name(i));
}

/// "particles 'a' and 'b' are 0.65 apart".
std::string apart(const ParticleSystem<double>& s, Index i, Index j, double r2) {
  return fmt::format("particles {} and {} are {:.3g} apart", called(s, i), called(s, j), std::sqrt(r2));
}

/// The same of `i` and the one nearest to it.
std::string nearest_to(const ParticleSystem<double>& s, Index i) {
  Index nearest = i;
  double least = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < s.size(); ++j) {
    if (j == i || (s.topology() != nullptr && s.topology()->is_special(i, j))) continue;
    const double r2 = norm2(s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j])));
    if (r2 < least) least = r2, nearest = j;
  }
  return apart(s, i, nearest, least);
}

Failure overlap_of(Index i, std::string message) {
  return {.kind = Outcome::Kind::overlap, .particle = i, .quantity = "distance", .message = std::move(message)};
}

constexpr std::string_view help = "; start with [minimize], or take a smaller step";

std::string too_close(const std::string& pair, std::string_view force, std::string_view what_helps) {
  return fmt::format("{}, too close for their {} force{}", pair, force, what_helps);
}

/// @param moved  a particle @param way  of it [length]
std::string too_far(const std::string& pair, std::string_view force, const std::string& moved, double way) {
  return fmt::format("{}: their {} force would move {} by {:.3g} in one step, further than a step can follow{}", pair,
                     force, moved, way, help);
}

}  // namespace

std::string_view help_of_close_pairs(double kick, double nearest) { return kick > 0 && nearest == 0 ? help : ""; }

Failure overlap(const ParticleSystem<double>& s, Index i, std::string_view force, std::string_view what_helps) {
  return overlap_of(i, too_close(nearest_to(s, i), force, what_helps));
}

Failure thrown(const ParticleSystem<double>& s, Index i, std::string_view force, double way) {
  return overlap_of(i, too_far(nearest_to(s, i), force, called(s, i), way));
}

bool look_closer(ForceSink<double>& out, const ParticleSystem<double>& s, const PairForceOn& pair,
                 const PairLimits& limits) {
  const auto& [i, j, r2, f] = pair;
  const double size = std::abs(f[0]) + std::abs(f[1]) + std::abs(f[2]);  // as sums see it: no number stays none
  if (out.failure()) return std::isfinite(size);
  if (!(size < limits.strongest && r2 >= limits.nearest * limits.nearest)) {
    const std::string_view what_helps = help_of_close_pairs(out.kick(), limits.nearest);
    out.fail(overlap_of(i, too_close(apart(s, i, j, r2), limits.force, what_helps)));
    return std::isfinite(size);
  }
  const double part = s.clock().step() == 0 ? thrown_at_start : thrown_later;
  const double far = std::max(thrown_of_range * limits.range, part * std::sqrt(r2));
  for (const Index moved : {i, j}) {
    const double m = s.masses()[moved], way = m == 0 ? 0 : std::sqrt(norm2(f)) * out.kick() * out.kick() / m;
    if (!(way > far) || out.failure()) continue;
    out.fail(overlap_of(moved, too_far(apart(s, i, j, r2), limits.force, called(s, moved), way)));
  }
  return true;
}

Failure crowded(const ParticleSystem<double>& s, Index i, double range) {
  return overlap_of(i, fmt::format("{}, with more than {} others or images of them in the range {:.6g} of the pair "
                                   "forces, which no neighbor list can hold; take a lower density, or a shorter cutoff",
                                   nearest_to(s, i), NeighborList::most_neighbors, range));
}

}  // namespace noether::detail
