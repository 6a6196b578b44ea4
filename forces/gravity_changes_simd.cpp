#include "forces/gravity_changes_simd.hpp"

#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());
constexpr std::ptrdiff_t systems = 8;

struct Three {
  Vector x, y, z;
};
HWY_INLINE Three load(const double* x, const double* y, const double* z, std::ptrdiff_t at) {
  const Lanes d;
  return {hn::Load(d, x + at), hn::Load(d, y + at), hn::Load(d, z + at)};
}
HWY_INLINE Three difference(const Three& a, const Three& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// G m a of two bodies at distance d, apart by u more: a = u/r^3 - 3 (d . u) d/r^5.
HWY_INLINE Three pull_between(const Three& apart, const Three& u, Vector soft2) {
  const Lanes d;
  const Vector r2[1] = {
      hn::MulAdd(apart.x, apart.x, hn::MulAdd(apart.y, apart.y, hn::MulAdd(apart.z, apart.z, soft2)))};
  Vector inverse[1];
  reciprocal_sqrt(d, r2, inverse);
  const Vector square = hn::Mul(inverse[0], inverse[0]), cube = hn::Mul(square, inverse[0]);
  const Vector along = hn::MulAdd(apart.x, u.x, hn::MulAdd(apart.y, u.y, hn::Mul(apart.z, u.z)));
  const Vector stretch = hn::Mul(hn::Mul(hn::Set(d, 3.0), square), hn::Mul(cube, along));
  return {hn::MulSub(cube, u.x, hn::Mul(stretch, apart.x)), hn::MulSub(cube, u.y, hn::Mul(stretch, apart.y)),
          hn::MulSub(cube, u.z, hn::Mul(stretch, apart.z))};
}

void attract_all(const ChangesOfBodies& bodies, double constant, double softening2) {
  const Lanes d;
  const ChangesOfBodies b = bodies;
  const Vector G = hn::Set(d, constant), soft2 = hn::Set(d, softening2);
  for (std::ptrdiff_t lane = 0; lane < systems; lane += lanes) {
    for (std::ptrdiff_t i = 0; i + 1 < b.count; ++i) {
      const std::ptrdiff_t at = i * systems + lane;
      const Three x = load(b.x, b.y, b.z, at), u = load(b.ux, b.uy, b.uz, at);
      const Vector mu = hn::Mul(G, hn::Load(d, b.m + at));
      Three felt = load(b.ax, b.ay, b.az, at);
      const bool massive = b.m[i * systems] != 0;
      for (std::ptrdiff_t j = i + 1; j < b.count; ++j) {
        if (!massive && b.m[j * systems] == 0) continue;  // tracers may stand in one place
        const std::ptrdiff_t to = j * systems + lane;
        const Three a =
            pull_between(difference(load(b.x, b.y, b.z, to), x), difference(load(b.ux, b.uy, b.uz, to), u), soft2);
        const Vector other = hn::Mul(G, hn::Load(d, b.m + to));
        felt = {hn::MulAdd(other, a.x, felt.x), hn::MulAdd(other, a.y, felt.y), hn::MulAdd(other, a.z, felt.z)};
        hn::Store(hn::NegMulAdd(mu, a.x, hn::Load(d, b.ax + to)), d, b.ax + to);
        hn::Store(hn::NegMulAdd(mu, a.y, hn::Load(d, b.ay + to)), d, b.ay + to);
        hn::Store(hn::NegMulAdd(mu, a.z, hn::Load(d, b.az + to)), d, b.az + to);
      }
      hn::Store(felt.x, d, b.ax + at);
      hn::Store(felt.y, d, b.ay + at);
      hn::Store(felt.z, d, b.az + at);
    }
  }
}

}  // namespace

extern const AttractChanges attract_changes;
const AttractChanges attract_changes = attract_all;

}  // namespace noether::NOETHER_SIMD_LEVEL
