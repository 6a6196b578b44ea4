#include "forces/sheared_gravity.hpp"

#include "engine/box.hpp"
#include "forces/sheared_gravity_simd.hpp"
#include "numbers/parallel.hpp"

#include <array>
#include <cmath>

namespace noether {

namespace {

constexpr Index most_rows = 64;  ///< of a kernel's call, whose sums stay in the innermost cache

/// What some rows feel, for G = 1.
template <class Real> struct Felt { alignas(64) std::array<Real, most_rows> ax{}, ay{}, az{}, phi{}; };

/// Columns of bodies that pull.
template <class Real> struct PullingBodies {
  const Real *x, *y, *z, *m, *row;
  Index count;
};

/// A difference of two places in [0, edge), in [- edge/2, edge/2): exact, and the same for all images.
Quad nearest(const Quad& d, const Quad& edge) {
  const Quad half = edge / Quad(2);
  const Quad once = d >= half ? Quad(d - edge) : d;
  return once < -half ? Quad(once + edge) : once;
}

void pull(const ShearedCell<Quad>& cell, const VectorColumn<Quad>& places, Index first, Index count,
          const PullingBodies<Quad>& bodies, const Quad& softening, bool, Felt<Quad>& felt) {
  for (Index r = 0; r < count; ++r) {
    const Vec3<Quad> place = places[first + r];
    const auto at = static_cast<std::size_t>(r);
    for (Index j = 0; j < bodies.count; ++j) {
      if (bodies.row[j] == Quad(first + r)) continue;
      const Quad dx = nearest(Quad(bodies.x[j] - place[0]), cell.width),
                 dy = nearest(Quad(bodies.y[j] - place[1]), cell.length),
                 dz = nearest(Quad(bodies.z[j] - place[2]), cell.height);
      for (int across = -1; across <= 1; ++across) {
        const Quad x = dx + Quad(across) * cell.width, slid = dy - cell.slope * x;
        const Quad near = slid - cell.length * detail::nearest_whole(Quad(slid / cell.length));
        for (int along = -1; along <= 1; ++along) {
          const Quad y = near + Quad(along) * cell.length, r2 = x * x + y * y + dz * dz + softening * softening;
          const Quad inverse = Quad(1) / sqrt(r2), pulls = bodies.m[j] * (inverse / r2);
          felt.ax[at] += pulls * x;
          felt.ay[at] += pulls * y;
          felt.az[at] += pulls * dz;
          felt.phi[at] += bodies.m[j] * inverse;
        }
      }
    }
  }
}

void pull(const ShearedCell<double>& cell, const VectorColumn<double>& places, Index first, Index count,
          const PullingBodies<double>& bodies, double softening, bool with_phi, Felt<double>& felt) {
  const ShearedGravityKernels& kernels = sheared_gravity_kernels();
  (with_phi ? kernels.attract_with_phi : kernels.attract)(
      {places.component(0) + first, places.component(1) + first, places.component(2) + first, felt.ax.data(),
       felt.ay.data(), felt.az.data(), felt.phi.data(), first, count},
      {bodies.x, bodies.y, bodies.z, bodies.m, bodies.row, bodies.count},
      {cell.width, cell.length, cell.height, cell.slope, softening * softening});
}

}  // namespace

template <class Real>
void ShearedGravity<Real>::gather(const VectorColumn<Real>& places, const ScalarColumn<Real>& masses) {
  for (std::vector<Real>* column : {&x_, &y_, &z_, &m_, &row_}) column->clear();
  for (Index j = 0; j < masses.size(); ++j) {
    if (masses[j] == Real(0)) continue;
    const Vec3<Real> place = places[j];
    x_.push_back(place[0]);
    y_.push_back(place[1]);
    z_.push_back(place[2]);
    m_.push_back(masses[j]);
    row_.push_back(Real(j));
  }
}

template <class Real>
Real ShearedGravity<Real>::sum(const ShearedCell<Real>& cell, const VectorColumn<Real>& places,
                               const ScalarColumn<Real>& masses, VectorColumn<Real>& a, bool energy) {
  gather(places, masses);
  const PullingBodies<Real> bodies{x_.data(), y_.data(),   z_.data(),
                                   m_.data(), row_.data(), static_cast<Index>(m_.size())};
  const auto block = [&](Index begin, Index end) {
    WideSum<Real> potential;
    for (Index first = begin; first < end; first += most_rows) {
      Felt<Real> felt;
      const Index count = std::min(most_rows, end - first);
      pull(cell, places, first, count, bodies, softening, energy, felt);
      for (Index r = 0; r < count; ++r) {
        const auto at = static_cast<std::size_t>(r);
        a.set(first + r, Vec3<Real>(G * felt.ax[at], G * felt.ay[at], G * felt.az[at]));
        potential -= G / Real(2) * masses[first + r] * felt.phi[at];
      }
    }
    return potential;
  };
  if (energy) return reduce(masses.size(), WideSum<Real>{}, block).value();
  for_blocks(masses.size(), block);
  return Real(0);
}

template class ShearedGravity<double>;
template class ShearedGravity<Quad>;

}  // namespace noether
