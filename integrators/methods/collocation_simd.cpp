#include "integrators/methods/collocation_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Lanes()));
constexpr int registers = 8 / lanes;  ///< that hold eight stages

/// sum_j a_ji F_j of one variable.
HWY_INLINE void product(const double* a, int stages, const double* rates, Vector (&sum)[registers]) {
  const Lanes d;
  for (int r = 0; r < registers; ++r) sum[r] = hn::Zero(d);
  for (int j = 0; j < stages; ++j) {
    const Vector rate = hn::Set(d, rates[j]);
    for (int r = 0; r < registers; ++r) sum[r] = hn::MulAdd(hn::LoadU(d, a + 8 * j + r * lanes), rate, sum[r]);
  }
}

void values(const StageSums& s, const double* a, double* out) {
  const Lanes d;
  const Vector h = hn::Set(d, s.h);
  for (std::ptrdiff_t m = 0; m < s.n; ++m) {
    Vector sum[registers];
    product(a, s.stages, s.rates + 8 * m, sum);
    const Vector y = hn::Set(d, s.y[m]), low = hn::Set(d, s.low[m]);
    for (int r = 0; r < registers; ++r) {
      hn::StoreU(hn::Add(y, hn::MulAdd(h, sum[r], low)), d, out + 8 * m + r * lanes);
    }
  }
}

void positions(const StageSums& s, const double* a, const double* c, const double* c_low, const double* v,
               double* out) {
  const Lanes d;
  const Vector h2 = hn::Set(d, s.h * s.h);
  for (std::ptrdiff_t m = 0; m < s.n; ++m) {
    Vector sum[registers];
    product(a, s.stages, s.rates + 8 * m, sum);
    const Vector y = hn::Set(d, s.y[m]), low = hn::Set(d, s.low[m]), hv = hn::Set(d, s.h * v[m]);
    for (int r = 0; r < registers; ++r) {
      const Vector small = hn::MulAdd(hn::LoadU(d, c_low + r * lanes), hv, hn::MulAdd(h2, sum[r], low));
      hn::StoreU(hn::Add(y, hn::MulAdd(hn::LoadU(d, c + r * lanes), hv, small)), d, out + 8 * m + r * lanes);
    }
  }
}

void combine(const StageSums& s, const double* w, double* out) {
  const Lanes d;
  for (std::ptrdiff_t m = 0; m < s.n; ++m) {
    Vector sum[registers];
    product(w, s.stages, s.rates + 8 * m, sum);
    for (int r = 0; r < registers; ++r) hn::StoreU(sum[r], d, out + 8 * m + r * lanes);
  }
}

void difference(std::ptrdiff_t n, int stages, const double* a, const double* b, double* change, double* size) {
  const Lanes d;
  Vector most[registers], largest[registers], all[registers];
  for (int r = 0; r < registers; ++r) most[r] = largest[r] = all[r] = hn::Zero(d);
  for (std::ptrdiff_t k = 0; k < 8 * n; k += 8) {
    for (int r = 0; r < registers; ++r) {
      const Vector x = hn::LoadU(d, a + k + r * lanes), y = hn::LoadU(d, b + k + r * lanes);
      // At the base level hn::Max would bring a function that objects of all levels share.
      const Vector change_here = hn::Abs(hn::Sub(x, y)), size_here = hn::Abs(x);
      most[r] = hn::IfThenElse(hn::Gt(change_here, most[r]), change_here, most[r]);
      largest[r] = hn::IfThenElse(hn::Gt(size_here, largest[r]), size_here, largest[r]);
      all[r] = hn::Add(all[r], hn::Sub(x, x));  // a maximum may drop what is no number
    }
  }
  double greatest[8], widest[8], sums[8];
  for (int r = 0; r < registers; ++r) {
    hn::StoreU(most[r], d, greatest + r * lanes);
    hn::StoreU(largest[r], d, widest + r * lanes);
    hn::StoreU(all[r], d, sums + r * lanes);
  }
  double sum = 0;
  *change = *size = 0;
  for (int k = 0; k < stages; ++k) {
    *change = greatest[k] > *change ? greatest[k] : *change;
    *size = widest[k] > *size ? widest[k] : *size;
    sum += sums[k];
  }
  *change += sum;
}

/// value + low += high + small, where `high` may be as large as the value.
HWY_INLINE void add_with_error(double& value, double& low, double high, double small) {
  const double sum = value + high, back = sum - value;
  const double rest = ((value - (sum - back)) + (high - back)) + (small + low);
  value = sum + rest;
  low = rest - (value - sum);
}

/// What rounding takes from a product, where the processor can tell.
HWY_INLINE double rounded_off([[maybe_unused]] double a, [[maybe_unused]] double b,
                              [[maybe_unused]] double product_of_both) {
#ifdef __FMA__
  return __builtin_fma(a, b, -product_of_both);
#else
  return 0;
#endif
}

/// sum_k w_k F_k over eight stages, always in the same order.
HWY_INLINE double dot(const double* w, const double* rates) {
  const Lanes d;
  Vector sum = hn::Mul(hn::LoadU(d, w), hn::LoadU(d, rates));
  for (int r = 1; r < registers; ++r) {
    sum = hn::MulAdd(hn::LoadU(d, w + r * lanes), hn::LoadU(d, rates + r * lanes), sum);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void finish(const StepSums& s) {
  const double h = s.h, h2 = h * h;
  for (std::ptrdiff_t m = 0; m < s.n; ++m) {
    const double* rates = s.rates + 8 * m;
    const double slope = dot(s.weights, rates), slope_low = dot(s.weights_low, rates);
    if (s.q != nullptr) {
      const double bend = dot(s.twice, rates), bend_low = dot(s.twice_low, rates), v = s.v[m], hv = h * v;
      add_with_error(s.q[m], s.q_low[m], hv, h2 * bend + (h2 * bend_low + (h * s.v_low[m] + rounded_off(h, v, hv))));
    }
    const double kick = h * slope;
    add_with_error(s.v[m], s.v_low[m], kick, h * slope_low + rounded_off(h, slope, kick));
  }
}

}  // namespace

extern const CollocationKernels collocation_kernels;
const CollocationKernels collocation_kernels{values, positions, combine, difference, finish};

}  // namespace noether::NOETHER_SIMD_LEVEL
