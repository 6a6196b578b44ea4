#include "forces/secant.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether::detail {

namespace {

std::string called_in(Index i, const std::vector<std::string>& names) {
  const auto k = static_cast<std::size_t>(i);
  return k >= names.size() || names[k].empty() ? fmt::format("particle {}", i) : fmt::format("'{}'", names[k]);
}
std::string pair_told(Index i, Index j, const std::vector<std::string>& names) {
  return i == j ? called_in(i, names) : called_in(i, names) + " and " + called_in(j, names);
}

}  // namespace

Failure no_secant(Index i, Index j, const std::vector<std::string>& names, bool moves) {
  const std::string pair = pair_told(i, j, names);
  return {.kind = Outcome::Kind::solver_failure,
          .particle = i,
          .quantity = "distance",
          .message = moves ? fmt::format("the distance of {} changes by more than the box is long in one step; take a "
                                         "smaller step",
                                         pair)
                           : fmt::format("the nearest image of {} changes within one step, so their force cannot do "
                                         "the work of their energy; take a smaller step, or a larger box",
                                         pair)};
}

Failure too_close(Index i, Index j, const std::vector<std::string>& names, double r2, double closest) {
  return {.kind = Outcome::Kind::overlap,
          .particle = i,
          .quantity = "distance",
          .message = fmt::format("{} are {:.6g} apart, but their potential is defined from {:.6g} on; take a smaller "
                                 "step",
                                 pair_told(i, j, names), std::sqrt(r2), closest)};
}

}  // namespace noether::detail
