#include "forces/charge_tiles.hpp"

#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace noether::detail {

namespace {

constexpr Index most_tiles = 64;  // along an axis

/// Where a coordinate is on the mesh; 0 if it was rounded to the face, or is no place of the box at all.
struct AlongAxis {
  const double* x;
  double scale, end;

  double operator()(Index i) const {
    const double u = x[i] * scale;
    return u >= 0 && u < end ? u : 0;
  }
};

/// Shares of the particles that are sorted side by side; there is no use in them for a few.
Index shares_of(Index particles) { return particles < parallel_threshold ? 1 : 16; }

}  // namespace

void ChargeTiles::lay(const std::array<std::int64_t, 3>& points, int reach, Index particles) {
  points_ = points;
  const auto enough = static_cast<Index>(std::sqrt(static_cast<double>(particles)) / 2) + 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Index pairs = std::min({points[axis] / (2 * reach), most_tiles / 2, enough});
    tiles_[axis] = std::max<Index>(1, 2 * pairs);
    tile_at_[axis].resize(static_cast<std::size_t>(points[axis]));
    for (std::int64_t cell = 0; cell < points[axis]; ++cell)
      tile_at_[axis][static_cast<std::size_t>(cell)] = cell * tiles_[axis] / points[axis];
  }
  for (Index& line : tile_at_[0]) line *= tiles_[1];
  const auto all = static_cast<std::size_t>(tiles_[0] * tiles_[1]);
  begins_.assign(all + 1, 0);
  counts_.assign(all * static_cast<std::size_t>(shares_of(particles)), 0);
}

void ChargeTiles::sort(const ParticleSystem<double>& s, const double* charges) {
  const Index n = s.size(), shares = shares_of(n), all = tiles_[0] * tiles_[1];
  const auto along = [&](int axis) {
    const auto end = static_cast<double>(points_[static_cast<std::size_t>(axis)]);
    return AlongAxis{s.positions().component(axis), end / s.box().edges()[axis], end};
  };
  const AlongAxis x = along(0), y = along(1), z = along(2);
  at_.resize(static_cast<std::size_t>(n));
  places_.resize(static_cast<std::size_t>(n));
  counts_.assign(static_cast<std::size_t>(all * shares), 0);
  const auto for_share = [&](const auto& body) {  // each by one thread
    for_blocks(shares * block_size, [&](Index begin, Index /*end*/) {
      const Index share = begin / block_size;
      body(n * share / shares, n * (share + 1) / shares, counts_.data() + share * all, at_.data());
    });
  };
  const Index *const line_at = tile_at_[0].data(), *const tile_at = tile_at_[1].data();
  for_share([&](Index begin, Index end, Index* counts, Index* at) {
    for (Index i = begin; i < end; ++i) {
      at[i] = charges[i] == 0 ? -1 : line_at[static_cast<Index>(x(i))] + tile_at[static_cast<Index>(y(i))];
      if (at[i] >= 0) ++counts[at[i]];
    }
  });
  Index begin = 0;
  for (Index tile = 0; tile < all; ++tile) {
    begins_[static_cast<std::size_t>(tile)] = begin;
    for (Index share = 0; share < shares; ++share) {
      Index& place = counts_[static_cast<std::size_t>(share * all + tile)];
      const Index count = place;
      place = begin;
      begin += count;
    }
  }
  begins_.back() = begin;
  for_share([&](Index from, Index to, Index* next, Index* at) {
    MeshPlace* const places = places_.data();
    for (Index i = from; i < to; ++i) {
      if (at[i] < 0) continue;
      at[i] = next[at[i]]++;
      places[at[i]] = {x(i), y(i), z(i), charges[i]};
    }
  });
  count_together();
}

void ChargeTiles::count_together() {
  const auto [nx, ny] = tiles_;
  most_together_ = 0;
  for (Index x = 0; x < nx; ++x) {
    for (Index y = 0; y < ny; ++y) {  // a tile, and those after it
      Index count = 0;
      for (Index a = 0; a < std::min<Index>(nx, 2); ++a) {
        for (Index b = 0; b < std::min<Index>(ny, 2); ++b) {
          const Index tile = (x + a) % nx * ny + (y + b) % ny, own_count = begin(tile + 1) - begin(tile);
          count += own_count;
        }
      }
      most_together_ = std::max(most_together_, count);
    }
  }
}

}  // namespace noether::detail
