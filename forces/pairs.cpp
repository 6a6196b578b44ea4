#include "forces/pairs.hpp"

#include <fmt/format.h>

#include <limits>

namespace noether::detail {

void check_cutoff(double cutoff, std::optional<double> switch_from) {
  if (!(cutoff > 0 && cutoff < 1e100)) refuse_field("cutoff", cutoff, "is no cutoff; a length above 0 is expected");
  if (switch_from && !(*switch_from > 0 && *switch_from < cutoff)) {
    refuse_field("switch_from", *switch_from, fmt::format("does not lie between 0 and the cutoff {}", cutoff));
  }
}

Failure overlap(const ParticleSystem<double>& s, Index i, std::string_view force) {
  const auto called = [&](Index k) {
    return s.name(k).empty() ? fmt::format("{}", s.ids()[static_cast<std::size_t>(k)]) : fmt::format("'{}'", s.name(k));
  };
  Index nearest = i;
  double least = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < s.size(); ++j) {
    if (j == i || (s.topology() != nullptr && s.topology()->is_special(i, j))) continue;
    const double r2 = norm2(s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j])));
    if (r2 < least) least = r2, nearest = j;
  }
  return {.kind = Outcome::Kind::overlap,
          .particle = i,
          .quantity = "distance",
          .message = fmt::format("particles {} and {} are {:.3g} apart, too close for their {} force", called(i),
                                 called(nearest), std::sqrt(least), force)};
}

}  // namespace noether::detail
