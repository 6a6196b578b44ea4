#include "forces/sheared_gravity_simd.hpp"

#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

using Lanes = hn::ScalableTag<double>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

Vector set(double x) { return hn::Set(Lanes(), x); }

/// A difference of two places in [0, edge), in [- edge/2, edge/2): exact, and the same for all images.
HWY_INLINE Vector nearest(Vector d, double edge) {
  const Vector half = set(edge / 2);
  d = hn::IfThenElse(hn::Ge(d, half), hn::Sub(d, set(edge)), d);
  return hn::IfThenElse(hn::Lt(d, hn::Neg(half)), hn::Add(d, set(edge)), d);
}

template <bool with_phi>
void attract(const AttractedRows& rows, const AttractingBodies& bodies, const SlidingCell& cell) {
  const Lanes d;
  const double per_length = 1 / cell.length;
  for (std::ptrdiff_t i = 0; i < rows.count; i += lanes) {
    const Vector x = hn::LoadU(d, rows.x + i), y = hn::LoadU(d, rows.y + i), z = hn::LoadU(d, rows.z + i),
                 number = hn::Iota(d, static_cast<double>(rows.first + i));
    Vector ax = hn::Zero(d), ay = ax, az = ax, phi = ax;
    for (std::ptrdiff_t j = 0; j < bodies.count; ++j) {
      const Vector dx = nearest(hn::Sub(set(bodies.x[j]), x), cell.width),
                   dy = nearest(hn::Sub(set(bodies.y[j]), y), cell.length),
                   dz = nearest(hn::Sub(set(bodies.z[j]), z), cell.height);
      const Vector z2 = hn::MulAdd(dz, dz, set(cell.softening2));
      // Three columns of images, each of which has slid as a whole, and in each the nearest image and both beside it.
      Vector across[3], along[9], r2[9], u[9];
      for (int a = 0; a < 3; ++a) {
        across[a] = hn::Add(dx, set((a - 1) * cell.width));
        const Vector slid = hn::NegMulAdd(set(cell.slope), across[a], dy),
                     plane2 = hn::MulAdd(across[a], across[a], z2),
                     near = hn::NegMulAdd(set(cell.length), hn::Round(hn::Mul(slid, set(per_length))), slid);
        for (int b = 0; b < 3; ++b) {
          const int k = 3 * a + b;
          along[k] = hn::Add(near, set((b - 1) * cell.length));
          r2[k] = hn::MulAdd(along[k], along[k], plane2);
        }
      }
      reciprocal_sqrt(d, r2, u);
      Vector of_x = hn::Zero(d), of_y = of_x, sum = of_x, inverse = of_x;
      for (int a = 0; a < 3; ++a) {
        Vector column = hn::Zero(d);
        for (int b = 0; b < 3; ++b) {
          const int k = 3 * a + b;
          const Vector cube = hn::Mul(u[k], hn::Mul(u[k], u[k]));
          column = hn::Add(column, cube);
          of_y = hn::MulAdd(cube, along[k], of_y);
          if constexpr (with_phi) inverse = hn::Add(inverse, u[k]);
        }
        of_x = hn::MulAdd(column, across[a], of_x);
        sum = hn::Add(sum, column);
      }
      const auto itself = hn::Eq(number, set(bodies.row[j]));
      const Vector m = set(bodies.m[j]);
      const auto felt = [&](Vector pull, Vector sums) { return hn::MulAdd(m, hn::IfThenZeroElse(itself, pull), sums); };
      ax = felt(of_x, ax);
      ay = felt(of_y, ay);
      az = felt(hn::Mul(sum, dz), az);
      if constexpr (with_phi) phi = felt(inverse, phi);
    }
    hn::StoreU(ax, d, rows.ax + i);
    hn::StoreU(ay, d, rows.ay + i);
    hn::StoreU(az, d, rows.az + i);
    if constexpr (with_phi) hn::StoreU(phi, d, rows.phi + i);
  }
}

}  // namespace

extern const ShearedGravityKernels sheared_gravity_kernels;
const ShearedGravityKernels sheared_gravity_kernels{attract<false>, attract<true>};

}  // namespace noether::NOETHER_SIMD_LEVEL
