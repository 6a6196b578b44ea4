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

void ChargeTiles::lay(const std::array<std::int64_t, 3>& points, int reach, Index charges) {
  points_ = points;
  const auto enough = static_cast<Index>(std::sqrt(static_cast<double>(charges)) / 2) + 1;
  const auto divide = [](std::vector<Index>& at, std::int64_t cells, Index parts) {
    at.resize(static_cast<std::size_t>(cells));
    for (std::int64_t cell = 0; cell < cells; ++cell) at[static_cast<std::size_t>(cell)] = cell * parts / cells;
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    tiles_[axis] = std::max<Index>(1, 2 * std::min({points[axis] / (2 * reach), most_tiles / 2, enough}));
    divide(tile_at_[axis], points[axis], tiles_[axis]);
  }
  for (Index& line : tile_at_[0]) line *= tiles_[1];
  layers_ = std::max<Index>(1, std::min({points[2] / reach, most_tiles, 2 * enough}));
  divide(layer_at_, points[2], layers_);
  const auto all = static_cast<std::size_t>(tiles_[0] * tiles_[1]);
  begins_.assign(all + 1, 0);
  counts_.assign(all * static_cast<std::size_t>(shares_of(charges)), 0);
  together_.assign(all * static_cast<std::size_t>(layers_), 0);
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
  Index* const together = together_.data();
  for_blocks(nx * ny * block_size, [&](Index task, Index /*end*/) {  // in a layer of a tile and in the one above it
    const Index tile = task / block_size;
    Index* const counts = together + tile * layers_;
    std::fill_n(counts, layers_, Index(0));
    for (Index k = begin(tile); k < begin(tile + 1); ++k)
      ++counts[layer_at_[static_cast<std::size_t>(places_[static_cast<std::size_t>(k)].z)]];
    if (layers_ == 1) return;
    const Index first = counts[0];
    for (Index layer = 0; layer < layers_; ++layer) {
      const Index above_count = layer + 1 < layers_ ? counts[layer + 1] : first;
      counts[layer] += above_count;
    }
  });
  most_together_ = 0;
  for (Index x = 0; x < nx; ++x) {
    for (Index y = 0; y < ny; ++y) {
      const Index next_x = (x + 1) % nx, next_y = (y + 1) % ny, in_x = nx > 1 ? 1 : 0, in_y = ny > 1 ? 1 : 0;
      const auto layers_of = [&](Index tile) { return together + tile * layers_; };
      const Index *const here = layers_of(x * ny + y), *const beside = layers_of(x * ny + next_y);
      const Index *const behind = layers_of(next_x * ny + y), *const across = layers_of(next_x * ny + next_y);
      for (Index layer = 0; layer < layers_; ++layer) {
        const Index both = behind[layer] + in_y * across[layer];
        most_together_ = std::max(most_together_, here[layer] + in_y * beside[layer] + in_x * both);
      }
    }
  }
}

}  // namespace noether::detail
