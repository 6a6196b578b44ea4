#include "forces/gravity_stages_simd.hpp"

#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());
constexpr std::ptrdiff_t stages = 8;

/// Body i, its G m, and what it has felt so far, in the lanes of one register.
struct Body {
  Vector x, y, z, mu, ax, ay, az;
};

/// The pull between body i and n bodies from j on, which have felt something before, or not.
template <int n, bool felt>
HWY_INLINE void attract(const BodiesInStages& b, Body& body, std::ptrdiff_t j, std::ptrdiff_t lane, Vector G,
                        Vector soft2) {
  const Lanes d;
  Vector dx[n], dy[n], dz[n], r2[n], cube[n];
  for (int k = 0; k < n; ++k) {
    const std::ptrdiff_t at = (j + k) * stages + lane;
    dx[k] = hn::Sub(hn::Load(d, b.x + at), body.x);
    dy[k] = hn::Sub(hn::Load(d, b.y + at), body.y);
    dz[k] = hn::Sub(hn::Load(d, b.z + at), body.z);
    r2[k] = hn::MulAdd(dx[k], dx[k], hn::MulAdd(dy[k], dy[k], hn::MulAdd(dz[k], dz[k], soft2)));
  }
  reciprocal_cube(d, r2, cube);
  for (int k = 0; k < n; ++k) {
    const std::ptrdiff_t at = (j + k) * stages + lane;
    const Vector pull = hn::Mul(hn::Mul(G, hn::Load(d, b.m + at)), cube[k]), back = hn::Mul(body.mu, cube[k]);
    // Products are rounded before they are added, so that pulls of bodies that mirror each other cancel to the last
    // bit: it costs nothing that can be measured, and keeps motions that are unstable off their plane or axis of
    // symmetry.
    body.ax = hn::Add(body.ax, hn::Mul(pull, dx[k]));
    body.ay = hn::Add(body.ay, hn::Mul(pull, dy[k]));
    body.az = hn::Add(body.az, hn::Mul(pull, dz[k]));
    const auto push = [&](double* a, Vector dr) HWY_ATTR {
      hn::Store(felt ? hn::Sub(hn::Load(d, a + at), hn::Mul(back, dr)) : hn::Neg(hn::Mul(back, dr)), d, a + at);
    };
    push(b.ax, dx[k]);
    push(b.ay, dy[k]);
    push(b.az, dz[k]);
  }
}

/// The same with all bodies from j on: by four, and what is left in one go.
template <int n, bool felt>
HWY_INLINE void attract_from(const BodiesInStages& b, Body& body, std::ptrdiff_t j, std::ptrdiff_t lane, Vector G,
                             Vector soft2) {
  for (; j + n <= b.count; j += n) attract<n, felt>(b, body, j, lane, G, soft2);
  if constexpr (n > 1) attract_from<n - 1, felt>(b, body, j, lane, G, soft2);
}

/// Nobody has felt anything yet.
HWY_INLINE void begin(const BodiesInStages& b, std::ptrdiff_t lane) {
  const Lanes d;
  for (std::ptrdiff_t at = lane; at < b.count * stages; at += stages) {
    hn::Store(hn::Zero(d), d, b.ax + at);
    hn::Store(hn::Zero(d), d, b.ay + at);
    hn::Store(hn::Zero(d), d, b.az + at);
  }
}

void attract_all(const BodiesInStages& bodies, double constant, double softening2) {
  const Lanes d;
  const BodiesInStages b = bodies;
  const Vector G = hn::Set(d, constant), soft2 = hn::Set(d, softening2);
  // A massive first body is felt by all others, who then have no other sums to begin with.
  const bool first_begins = !b.has_sums && b.count > 1 && b.m[0] != 0;
  for (std::ptrdiff_t lane = 0; lane < stages; lane += lanes) {
    if (!b.has_sums && !first_begins) begin(b, lane);
    for (std::ptrdiff_t i = 0; i + 1 < b.count; ++i) {
      const std::ptrdiff_t at = i * stages + lane;
      const bool begins = first_begins && i == 0;
      const auto sum_of = [&](const double* a) HWY_ATTR { return begins ? hn::Zero(d) : hn::Load(d, a + at); };
      Body body{hn::Load(d, b.x + at), hn::Load(d, b.y + at), hn::Load(d, b.z + at), hn::Mul(G, hn::Load(d, b.m + at)),
                sum_of(b.ax),          sum_of(b.ay),          sum_of(b.az)};
      if (begins) {
        attract_from<4, false>(b, body, i + 1, lane, G, soft2);
      } else if (b.m[at] != 0) {
        attract_from<4, true>(b, body, i + 1, lane, G, soft2);
      } else {
        for (std::ptrdiff_t j = i + 1; j < b.count; ++j) {
          if (b.m[j * stages] != 0) attract<1, true>(b, body, j, lane, G, soft2);  // tracers may stand in one place
        }
      }
      hn::Store(body.ax, d, b.ax + at);
      hn::Store(body.ay, d, b.ay + at);
      hn::Store(body.az, d, b.az + at);
    }
  }
}

}  // namespace

extern const AttractInStages attract_in_stages;
const AttractInStages attract_in_stages = attract_all;

}  // namespace noether::NOETHER_SIMD_LEVEL
