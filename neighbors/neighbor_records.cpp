#include "neighbors/neighbor_list.hpp"

#include <bit>
#include <cmath>

namespace noether {

double NeighborList::whole_spacing() const {
  return std::ldexp(1.0, std::ilogb(box_.edges().maxCoeff() / 2 + 2 * range_) - 28);
}

/// Places as whole numbers of a spacing, modulo 2^32. Only those of particles in the box are rounded; where an image or
/// a particle that has crossed the box stands differs from there by rounded edges: places depend on no search.
class NeighborList::WholeNumbers {
 public:
  explicit WholeNumbers(double spacing) : per_length_(1 / spacing) {}

  std::int32_t operator()(double x) const {
    return static_cast<std::int32_t>(std::bit_cast<std::int64_t>(x * per_length_ + magic));
  }
  static std::int32_t sum(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
  }

 private:
  static constexpr double magic = 6755399441055744.0;  // 1.5 x 2^52: leaves whole numbers in the last bits
  double per_length_;
};

/// Shifts by whole edges, those along x first; the one by nothing in the middle.
void NeighborList::number_shifts(const std::array<int, 3>& most) {
  shifts_.clear();
  whole_shifts_.clear();
  const Vec3<double>&edges = box_.edges(), &steps = record_edges_;
  const WholeNumbers whole(keep_whole_ ? whole_spacing() : 1);
  const std::array<std::int32_t, 3> whole_edges = {whole(edges[0]), whole(edges[1]), whole(edges[2])};
  for (int c = -most[2]; c <= most[2]; ++c) {
    for (int b = -most[1]; b <= most[1]; ++b) {
      for (int a = -most[0]; a <= most[0]; ++a) {
        shifts_.emplace_back(a * steps[0], b * steps[1], c * steps[2]);
        if (keep_whole_) whole_shifts_.push_back({a * whole_edges[0], b * whole_edges[1], c * whole_edges[2]});
      }
    }
  }
}

/// Moves all records, and returns the square of the longest way that a particle has gone since the search.
double NeighborList::take_positions(const ParticleSystem<double>& s, Numbers numbers) {
  if (numbers == Numbers::doubles) {
    double* records = records_.data();
    const auto shift = [=, shifts = shifts_.data()](const Ghost& ghost, int k) {
      records[4 * ghost.record + k] = records[4 * ghost.of + k] + shifts[ghost.shift][k];
    };
    if (has_coarse_spacing(0) || has_coarse_spacing(1) || has_coarse_spacing(2)) {
      const auto put = [=, this](std::int32_t r, int k, double place, double edges) {
        records[4 * r + k] = on_spacing(k, place) - (edges > 0 ? record_edges_[k] : edges < 0 ? -record_edges_[k] : 0);
      };
      return move_records(s, put, shift);
    }
    const auto put = [=](std::int32_t r, int k, double place, double edges) { records[4 * r + k] = place - edges; };
    return move_records(s, put, shift);
  }
  const WholeNumbers whole(whole_spacing());
  const std::int32_t edge[3] = {whole(box_.edges()[0]), whole(box_.edges()[1]), whole(box_.edges()[2])};
  std::int32_t* records = whole_records_.data();
  const auto put = [&, records](std::int32_t r, int k, double place, double edges) {
    records[4 * r + k] = WholeNumbers::sum(whole(place), edges > 0 ? -edge[k] : edges < 0 ? edge[k] : 0);
  };
  const auto shift = [=, shifts = whole_shifts_.data()](const Ghost& ghost, int k) {
    records[4 * ghost.record + k] = WholeNumbers::sum(records[4 * ghost.of + k], shifts[ghost.shift][at(k)]);
  };
  return move_records(s, put, shift);
}

/// @param put  (record, axis, place, edges): where a particle is, and the edges of the box that it has crossed
/// @param shift  (ghost, axis): puts an image beside its particle
template <class Put, class Shift>
double NeighborList::move_records(const ParticleSystem<double>& s, const Put& put, const Shift& shift) {
  const VectorColumn<double>& positions = s.positions();
  const Vec3<double> edges = box_.edges(), half = edges / 2, middle = middle_;
  const double *x = positions.component(0), *y = positions.component(1), *z = positions.component(2);
  // A particle that has crossed the box since stays where its neighbors expect it.
  const auto crossed = [](double d, double edge, double limit) { return d > limit ? edge : d < -limit ? -edge : 0.0; };
  // Doubles that are not negative compare as their bits do; what is no number is above all others.
  std::atomic<std::uint64_t> longest{0};
  for_blocks(s.size(), [&](Index begin, Index end) {
    double block = 0;
    for (Index i = begin; i < end; ++i) {
      const double px = x[i] - middle[0], py = y[i] - middle[1], pz = z[i] - middle[2];
      double dx = px - start_[0][at(i)], dy = py - start_[1][at(i)], dz = pz - start_[2][at(i)];
      double cx = 0, cy = 0, cz = 0;
      if (edges[0] > 0) {
        cx = crossed(dx, edges[0], half[0]), cy = crossed(dy, edges[1], half[1]), cz = crossed(dz, edges[2], half[2]);
        dx -= cx, dy -= cy, dz -= cz;
      }
      const double moved2 = dx * dx + dy * dy + dz * dz;
      if (!(moved2 <= block) && block == block) block = moved2;  // what is no number stays
      const std::int32_t r = record_of_[at(i)];
      put(r, 0, px, cx);
      put(r, 1, py, cy);
      put(r, 2, pz, cz);
    }
    std::uint64_t bits = std::bit_cast<std::uint64_t>(block) & ~(std::uint64_t{1} << 63U), known = longest.load();
    while (bits > known && !longest.compare_exchange_weak(known, bits)) {
    }
  });
  for_blocks(static_cast<Index>(ghosts_.size()), [&](Index begin, Index end) {
    for (Index g = begin; g < end; ++g) {
      for (int k = 0; k < 3; ++k) shift(ghosts_[at(g)], k);
    }
  });
  return std::bit_cast<double>(longest.load());
}

}  // namespace noether
