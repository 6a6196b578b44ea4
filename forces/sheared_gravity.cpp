#include "forces/sheared_gravity.hpp"

#include "engine/box.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd_loop.hpp"

#include <cmath>
#include <type_traits>

namespace noether {

namespace {

/// A body that pulls, and the row among the particles that is itself.
template <class Real> struct PullingBody {
  Real x, y, z, m;
  Index row;
};

template <class Real> struct PulledRows {
  const Real *x, *y, *z;
  Real *ax, *ay, *az, *phi;
  Index first, count;
};

/// The nearest whole number, in lanes of doubles too.
template <class Real> inline Real whole_near(const Real& x) {
  if constexpr (std::is_same_v<Real, double>) {
    constexpr double shift = 6755399441055744.0;  // 1.5 2^52: beyond it doubles are whole
    return (x + shift) - shift;
  } else {
    return detail::nearest_whole(x);
  }
}

/// A difference of two places in [0, edge), in [- edge/2, edge/2): exact, and the same for all images.
template <class Real> inline Real nearest(const Real& d, const Real& edge) {
  const Real half = edge / Real(2);
  const Real once = d >= half ? Real(d - edge) : d;
  return once < -half ? Real(once + edge) : once;
}

template <class Real>
void pull_rows(const ShearedCell<Real>& cell, const PullingBody<Real>& body, Real softening2,
               const PulledRows<Real>& rows) {
  using std::sqrt;
  const Real per_length = Real(1) / cell.length;
  for (Index r = 0; r < rows.count; ++r) {
    const Real dx = nearest(Real(body.x - rows.x[r]), cell.width), dy = nearest(Real(body.y - rows.y[r]), cell.length),
               dz = nearest(Real(body.z - rows.z[r]), cell.height);
    const bool own = rows.first + r == body.row;
    const Real z2 = dz * dz + softening2 + (own ? Real(1) : Real(0)), m = own ? Real(0) : body.m;
    Real fx(0), fy(0), sum(0), phi(0);
    for (int across = -1; across <= 1; ++across) {
      const Real x = dx + Real(across) * cell.width, slid = dy - cell.slope * x;
      const Real near = slid - cell.length * whole_near(Real(slid * per_length));
      for (int along = -1; along <= 1; ++along) {
        const Real y = near + Real(along) * cell.length, r2 = x * x + y * y + z2;
        const Real inverse = Real(1) / sqrt(r2), cube = inverse / r2;
        fx += cube * x;
        fy += cube * y;
        sum += cube;
        phi += inverse;
      }
    }
    rows.ax[r] += m * fx;
    rows.ay[r] += m * fy;
    rows.az[r] += m * sum * dz;
    rows.phi[r] += m * phi;
  }
}

template <class Real> auto pulling_loop() {
  if constexpr (std::is_same_v<Real, double>) {
    return simd_loop<pull_rows<double>>();
  } else {
    return pull_rows<Real>;
  }
}

}  // namespace

template <class Real>
Real ShearedGravity<Real>::sum(const ShearedCell<Real>& cell, const VectorColumn<Real>& places,
                               const ScalarColumn<Real>& masses, VectorColumn<Real>& a, bool energy) {
  massive_.clear();
  for (Index j = 0; j < masses.size(); ++j) {
    if (masses[j] != Real(0)) massive_.push_back(j);
  }
  const Real softening2 = softening * softening;
  const auto pull = pulling_loop<Real>();
  const auto block = [&](Index begin, Index end) {
    // A few rows at a time, whose sums stay in registers and the innermost cache.
    constexpr Index most = 64;
    WideSum<Real> potential;
    for (Index first = begin; first < end; first += most) {
      alignas(64) Real ax[most]{}, ay[most]{}, az[most]{}, phi[most]{};
      const Index count = std::min(most, end - first);
      const PulledRows<Real> rows{places.component(0) + first,
                                  places.component(1) + first,
                                  places.component(2) + first,
                                  ax,
                                  ay,
                                  az,
                                  phi,
                                  first,
                                  count};
      for (const Index j : massive_) {
        const Vec3<Real> place = places[j];
        pull(cell, {place[0], place[1], place[2], masses[j], j}, softening2, rows);
      }
      for (Index r = 0; r < count; ++r) {
        a.set(first + r, Vec3<Real>(G * ax[r], G * ay[r], G * az[r]));
        potential -= G / Real(2) * masses[first + r] * phi[r];
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
