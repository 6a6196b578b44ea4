#include "forces/gravity_simd.hpp"

#include "numbers/reciprocal_sqrt_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

using Lanes = hn::ScalableTag<double>;
using Vector = hn::Vec<Lanes>;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

/// Rows in the lanes of one register, and what they feel.
struct Row {
  Vector x, y, z, number, soft2;
  Vector ax, ay, az, phi;

  Row(const AttractedRows& rows, std::ptrdiff_t i, double softening2) {
    const Lanes d;
    x = hn::LoadU(d, rows.x + i);
    y = hn::LoadU(d, rows.y + i);
    z = hn::LoadU(d, rows.z + i);
    number = hn::Iota(d, static_cast<double>(rows.first + i));
    soft2 = hn::Set(d, softening2);
    ax = ay = az = phi = hn::Zero(d);
  }

  /// Adds the pull of n bodies from j on.
  template <bool among, bool with_phi, int n> HWY_INLINE void feel(const AttractingBodies& bodies, std::ptrdiff_t j) {
    const Lanes d;
    Vector dx[n], dy[n], dz[n], r2[n], u[n];
    for (int k = 0; k < n; ++k) {
      dx[k] = hn::Sub(hn::Set(d, bodies.x[j + k]), x);
      dy[k] = hn::Sub(hn::Set(d, bodies.y[j + k]), y);
      dz[k] = hn::Sub(hn::Set(d, bodies.z[j + k]), z);
      r2[k] = hn::MulAdd(dx[k], dx[k], hn::MulAdd(dy[k], dy[k], hn::MulAdd(dz[k], dz[k], soft2)));
    }
    reciprocal_sqrt(d, r2, u);
    for (int k = 0; k < n; ++k) {
      if constexpr (among) u[k] = hn::IfThenZeroElse(hn::Eq(number, hn::Set(d, bodies.row[j + k])), u[k]);
      const Vector mu = hn::Mul(hn::Set(d, bodies.m[j + k]), u[k]);
      if constexpr (with_phi) phi = hn::Add(phi, mu);
      const Vector pull = hn::Mul(mu, hn::Mul(u[k], u[k]));
      ax = hn::MulAdd(pull, dx[k], ax);
      ay = hn::MulAdd(pull, dy[k], ay);
      az = hn::MulAdd(pull, dz[k], az);
    }
  }

  template <bool with_phi> void add_to(const AttractedRows& rows, std::ptrdiff_t i) const {
    const Lanes d;
    hn::StoreU(hn::Add(hn::LoadU(d, rows.ax + i), ax), d, rows.ax + i);
    hn::StoreU(hn::Add(hn::LoadU(d, rows.ay + i), ay), d, rows.ay + i);
    hn::StoreU(hn::Add(hn::LoadU(d, rows.az + i), az), d, rows.az + i);
    if constexpr (with_phi) hn::StoreU(hn::Add(hn::LoadU(d, rows.phi + i), phi), d, rows.phi + i);
  }
};

template <bool among, bool with_phi>
void attract(const AttractedRows& rows, const AttractingBodies& bodies, std::ptrdiff_t from, std::ptrdiff_t to,
             double softening2) {
  constexpr int together = 8;  // bodies side by side keep the multipliers busy
  const AttractingBodies columns = bodies;
  for (std::ptrdiff_t i = 0; i < rows.count; i += lanes) {
    Row row(rows, i, softening2);
    std::ptrdiff_t j = from;
    for (; j + together <= to; j += together) row.feel<among, with_phi, together>(columns, j);
    for (; j < to; ++j) row.feel<among, with_phi, 1>(columns, j);
    row.add_to<with_phi>(rows, i);
  }
}

}  // namespace

extern const GravityKernels gravity_kernels;
const GravityKernels gravity_kernels{static_cast<int>(lanes), attract<false, false>, attract<false, true>,
                                     attract<true, false>, attract<true, true>};

}  // namespace noether::NOETHER_SIMD_LEVEL
