#include "neighbors/neighbor_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

/// By the positions of the particles alone: how often an image of each stands near each, and how often it is listed.
void NeighborList::verify(const ParticleSystem<double>& s) const {
  const bool found_now = age_ == 0;  // then rows hold all that they are ever to hold
  const double reach = found_now ? shell_radius(shells - 1) : range_;
  const auto is_near = [&](double x, double y, double z) { return x * x + y * y + z * z < reach * reach; };
  const auto images_near = [&](const Vec3<double>& d) {
    double from[3] = {0, 0, 0}, to[3] = {0, 0, 0};
    for (int k = 0; k < 3 && box_.is_periodic(); ++k) {
      from[k] = std::ceil((-reach - d[k]) / box_.edges()[k]);
      to[k] = std::floor((reach - d[k]) / box_.edges()[k]);
    }
    int count = 0;
    for (double a = from[0]; a <= to[0]; ++a) {
      for (double b = from[1]; b <= to[1]; ++b) {
        for (double c = from[2]; c <= to[2]; ++c) {
          const Vec3<double>& edges = box_.edges();
          count += is_near(d[0] + a * edges[0], d[1] + b * edges[1], d[2] + c * edges[2]) ? 1 : 0;
        }
      }
    }
    return count;
  };
  Index seen = 0;
  std::vector<int> listed(at(s.size()));
  std::vector<Index> last(source_.size(), -1);  // whose list a record was seen in
  for (Index g = 0; g < groups(); ++g) {
    Group one = group(g);
    if (found_now) one.rows = row_begin_[at(g)].rows[shells - 1];
    for (Index lane = 0; lane < group_size; ++lane) {
      const std::int32_t i = one.particles[lane], own = one.records[lane] / 4;
      if (i < 0) continue;
      ++seen;
      std::fill(listed.begin(), listed.end(), 0);
      for (Index row = 0; row < one.rows; ++row) {
        const Index other = one.entries[group_size * row + lane] / 4;
        if (other == static_cast<Index>(source_.size())) continue;  // nobody
        const auto along = [&](std::size_t k) { return coordinate(own, k) - coordinate(other, k); };
        if (!is_near(along(0), along(1), along(2))) continue;
        if (std::exchange(last[at(other)], i) == i) {
          throw LogicError(fmt::format("the neighbor list of particle {} holds particle {} or one image of it twice",
                                       s.ids()[at(i)], s.ids()[at(source_[at(other)])]));
        }
        ++listed[at(source_[at(other)])];
      }
      for (Index j = 0; j < s.size(); ++j) {
        const Vec3<double> d = s.positions()[i] - s.positions()[j];
        const bool excluded = !excluded_.empty() && std::find(excluded_.begin() + excluded_begin_[at(i)],
                                                              excluded_.begin() + excluded_begin_[at(i + 1)],
                                                              j) != excluded_.begin() + excluded_begin_[at(i + 1)];
        const int wanted = excluded ? 0 : images_near(d) - (i == j && is_near(d[0], d[1], d[2]) ? 1 : 0);
        if (listed[at(j)] == wanted) continue;
        throw LogicError(
            fmt::format("the neighbor list holds particle {} or images of it {} times up to {} from "
                        "particle {}, instead of {} times",
                        s.ids()[at(j)], listed[at(j)], reach, s.ids()[at(i)], wanted));
      }
    }
  }
  if (seen != s.size()) throw LogicError(fmt::format("the neighbor list holds {} of {} particles", seen, s.size()));
}

}  // namespace noether
