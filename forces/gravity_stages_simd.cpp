#include "forces/gravity_stages_simd.hpp"

#include "engine/reciprocal_sqrt_simd.hpp"

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

/// The pull between body i and n bodies from j on.
template <int n>
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
    body.ax = hn::MulAdd(pull, dx[k], body.ax);
    body.ay = hn::MulAdd(pull, dy[k], body.ay);
    body.az = hn::MulAdd(pull, dz[k], body.az);
    hn::Store(hn::NegMulAdd(back, dx[k], hn::Load(d, b.ax + at)), d, b.ax + at);
    hn::Store(hn::NegMulAdd(back, dy[k], hn::Load(d, b.ay + at)), d, b.ay + at);
    hn::Store(hn::NegMulAdd(back, dz[k], hn::Load(d, b.az + at)), d, b.az + at);
  }
}

/// The same with all bodies from j on: by four, and what is left in one go.
template <int n>
HWY_INLINE void attract_from(const BodiesInStages& b, Body& body, std::ptrdiff_t j, std::ptrdiff_t lane, Vector G,
                             Vector soft2) {
  for (; j + n <= b.count; j += n) attract<n>(b, body, j, lane, G, soft2);
  if constexpr (n > 1) attract_from<n - 1>(b, body, j, lane, G, soft2);
}

void attract_all(const BodiesInStages& bodies, double constant, double softening2) {
  const Lanes d;
  const BodiesInStages b = bodies;
  const Vector G = hn::Set(d, constant), soft2 = hn::Set(d, softening2);
  for (std::ptrdiff_t lane = 0; lane < stages; lane += lanes) {
    for (std::ptrdiff_t i = 0; i + 1 < b.count; ++i) {
      const std::ptrdiff_t at = i * stages + lane;
      Body body{
          hn::Load(d, b.x + at),  hn::Load(d, b.y + at),  hn::Load(d, b.z + at), hn::Mul(G, hn::Load(d, b.m + at)),
          hn::Load(d, b.ax + at), hn::Load(d, b.ay + at), hn::Load(d, b.az + at)};
      if (b.m[at] != 0) {
        attract_from<4>(b, body, i + 1, lane, G, soft2);
      } else {
        for (std::ptrdiff_t j = i + 1; j < b.count; ++j) {
          if (b.m[j * stages] != 0) attract<1>(b, body, j, lane, G, soft2);  // tracers may stand in one place
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
