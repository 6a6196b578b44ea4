#include "integrators/sheared_box.hpp"

#include "numbers/parallel.hpp"
#include "numbers/simd_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace noether {

namespace {

constexpr Index in_a_row = 64;

/// One edge of the cell and its grid.
struct CellEdge {
  double length, grid, per_grid;
};

/// Changes along one axis as whole numbers of the grid, beside `cells`, the edges that they are longer than.
inline void round_to_grid(const CellEdge& edge, double* __restrict d, double* __restrict cells, Index count) {
  const double per_length = 1 / edge.length;
  for (Index i = 0; i < count; ++i) {
    const double whole = std::floor(d[i] * per_length);
    const double left = std::nearbyint((d[i] - whole * edge.length) * edge.per_grid) * edge.grid;
    // The quotient is rounded: one cell too many or too few is set right here.
    const double borrowed = left < 0 ? edge.length : 0.0, carried = left > edge.length ? edge.length : 0.0;
    cells[i] = whole - (left < 0 ? 1.0 : 0.0) + (left > edge.length ? 1.0 : 0.0);
    d[i] = left + borrowed - carried;
  }
}

/// Places in [0, length) and changes in [0, length], both on the grid.
inline void add_in_cell(const CellEdge& edge, const double* __restrict d, const double* __restrict cells,
                        double* __restrict x, std::int32_t* __restrict image, Index count) {
  for (Index i = 0; i < count; ++i) {
    // Nothing on the way is longer than the edge: that is where the grid ends.
    const bool over = d[i] >= edge.length - x[i];
    x[i] = (over ? x[i] - edge.length : x[i]) + d[i];
    image[i] += static_cast<std::int32_t>(cells[i] + (over ? 1.0 : 0.0));
  }
}

/// What a row of particles is moved by.
struct RowChanges {
  alignas(64) std::array<double, in_a_row> z, v, w, q, dx, dy, dz, cells_x, cells_y, cells_z;
};

struct RowOfParticles {
  std::array<double*, 3> x, v;
  std::array<std::int32_t*, 3> image;
  Index count;
};

/// An epicycle of up to 64 particles. @return false, and nothing has moved, where one goes too far for whole numbers
bool move_row(const Epicycle<double>& epicycle, const std::array<CellEdge, 3>& edges, double slope,
              const RowOfParticles& row) {
  RowChanges c;
  const Index n = row.count;
  for (Index i = 0; i < n; ++i) {
    c.z[i] = row.x[2][i] + edges[2].length * static_cast<double>(row.image[2][i]);
    c.v[i] = row.v[0][i];
    c.w[i] = row.v[1][i];
    c.q[i] = row.v[2][i];
  }
  Epicycle<double>::change_in_shear(epicycle, c.z.data(), c.v.data(), c.w.data(), c.q.data(), c.dx.data(), c.dy.data(),
                                    c.dz.data(), n);
  round_to_grid(edges[0], c.dx.data(), c.cells_x.data(), n);
  for (Index i = 0; i < n; ++i) c.dy[i] += slope * (c.dx[i] + c.cells_x[i] * edges[0].length);
  round_to_grid(edges[1], c.dy.data(), c.cells_y.data(), n);
  round_to_grid(edges[2], c.dz.data(), c.cells_z.data(), n);
  double most = 0;
  for (Index i = 0; i < n; ++i)
    most = std::max(most, std::abs(c.cells_x[i]) + std::abs(c.cells_y[i]) + std::abs(c.cells_z[i]));
  if (!(most < 1e6)) return false;
  add_in_cell(edges[0], c.dx.data(), c.cells_x.data(), row.x[0], row.image[0], n);
  add_in_cell(edges[1], c.dy.data(), c.cells_y.data(), row.x[1], row.image[1], n);
  add_in_cell(edges[2], c.dz.data(), c.cells_z.data(), row.x[2], row.image[2], n);
  std::copy_n(c.v.data(), n, row.v[0]);
  std::copy_n(c.w.data(), n, row.v[1]);
  std::copy_n(c.q.data(), n, row.v[2]);
  return true;
}

std::array<CellEdge, 3> edges_of(const Box& box) {
  std::array<CellEdge, 3> edges{};
  for (int k = 0; k < 3; ++k) edges[static_cast<std::size_t>(k)] = {box.edges()[k], box.spacing(k), 1 / box.spacing(k)};
  return edges;
}

}  // namespace

template <class Real> void ShearedBox<Real>::begin(const ParticleSystem<Real>& s, const SheetRates& rates) {
  rates_ = rates;
  pulls_ = false;
  a_ = VectorColumn<Real>(s.size());
}

template <class Real> void ShearedBox<Real>::take(const ParticleSystem<Real>& s, const ForceClaims& force) {
  if (!force.kepler || pulls_) {
    throw Error(
        "in the box of a shearing sheet images slide, which gravity alone knows of the forces; take the others out, or "
        "the box");
  }
  pulls_ = true;
  gravity_.G = Real(force.G.value_or(s.units().G));
  gravity_.softening = Real(force.softening);
}

template <class Real> ShearedCell<Real> ShearedBox<Real>::cell(const ParticleSystem<Real>& s, const Real& time) const {
  const Vec3<double>& edges = s.box().edges();
  return {Real(edges[0]), Real(edges[1]), Real(edges[2]), slope(time)};
}

template <class Real> void ShearedBox<Real>::open(ParticleSystem<Real>& s) const {
  const Real slope = this->slope(s.time()), drift = Real(1.5) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Real x = std::as_const(s).positions()[i][0], never_wrapped = s.unwrapped(i)[0];
    s.shift(i, Vec3<Real>(Real(0), slope * x, Real(0)), Vec3<Real>(Real(0), drift * never_wrapped, Real(0)));
  }
  s.moved();
  s.phase().coordinates = unsheared;
}

template <class Real> void ShearedBox<Real>::close(ParticleSystem<Real>& s) const {
  const Real slope = this->slope(s.time()), drift = Real(1.5) * Real(rates_.Omega);
  for (Index i = 0; i < s.size(); ++i) {
    const Real x = std::as_const(s).positions()[i][0], never_wrapped = s.unwrapped(i)[0];
    s.shift(i, Vec3<Real>(Real(0), -slope * x, Real(0)), Vec3<Real>(Real(0), -drift * never_wrapped, Real(0)));
  }
  s.moved();
  s.phase().coordinates = 0;
}

template <class Real>
void ShearedBox<Real>::move(ParticleSystem<Real>& s, const Epicycle<Real>& epicycle, const Real& end) const {
  const Real slope = this->slope(end);
  auto &x = s.positions(), &v = s.velocities();
  auto& image = s.images();
  const auto one_by_one = [&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      // The middle of the layer is z = 0, which is a corner of the cell.
      auto change = epicycle.change_in_shear(s.unwrapped(i)[2], std::as_const(s).velocities()[i]);
      if constexpr (std::is_same_v<Real, double>) change.x[0] = s.box().on_grid(0, change.x[0]);
      change.x[1] += slope * change.x[0];
      s.shift(i, change.x, change.v);
    }
  };
  for_blocks(s.size(), [&](Index begin, Index end_of_block) {
    if constexpr (std::is_same_v<Real, double>) {
      if (!epicycle.turns()) {
        const auto edges = edges_of(s.box());
        const auto loop = simd_loop<move_row>();
        for (Index first = begin; first < end_of_block; first += in_a_row) {
          const Index count = std::min(in_a_row, end_of_block - first);
          const RowOfParticles row{{x.component(0) + first, x.component(1) + first, x.component(2) + first},
                                   {v.component(0) + first, v.component(1) + first, v.component(2) + first},
                                   {image.component(0) + first, image.component(1) + first, image.component(2) + first},
                                   count};
          if (!loop(epicycle, edges, slope, row)) one_by_one(first, first + count);
        }
        return;
      }
    }
    one_by_one(begin, end_of_block);
  });
  s.moved();
}

template <class Real> void ShearedBox<Real>::kick(ParticleSystem<Real>& s, const Real& h) {
  if (!pulls_) return;
  gravity_.sum(cell(s, s.time()), std::as_const(s).positions(), s.masses(), a_, false);
  s.advance_velocities(h, a_);
}

template <class Real> Real ShearedBox<Real>::settled_sum(const ParticleSystem<Real>& s, bool energy) {
  if (!pulls_) {
    a_.set_zero();
    return Real(0);
  }
  ParticleSystem<Real> there = s;
  open(there);
  return gravity_.sum(cell(there, there.time()), std::as_const(there).positions(), there.masses(), a_, energy);
}

template <class Real> void ShearedBox<Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  settled_sum(s, false);
  a = a_;
}

template class ShearedBox<double>;
template class ShearedBox<Quad>;

}  // namespace noether
