#include "integrators/methods/stage_arithmetic.hpp"

#include "integrators/methods/collocation_simd.hpp"
#include "numbers/double_double.hpp"

#include <cmath>
#include <type_traits>

namespace noether {

namespace {

template <class Real> StageLanes<Real> product(const StageMatrix<Real>& a, const Real* rates) {
  StageLanes<Real> sum{};
  for (std::size_t j = 0; j < lane_count; ++j) {
    for (std::size_t k = 0; k < lane_count; ++k) sum[k] += a[j][k] * rates[j];
  }
  return sum;
}

/// value + low += high + small, where `high` may be as large as the value.
template <class Real> void add_with_error(Real& value, Real& low, const Real& high, const Real& small) {
  const Real sum = value + high, back = sum - value;
  const Real remainder = ((value - (sum - back)) + (high - back)) + (small + low);
  value = sum + remainder;
  low = remainder - (value - sum);
}

}  // namespace

template <class Real>
void StageArithmetic<Real>::values(const Real* rates, const StageMatrix<Real>& a, const Real* y, const Real* low,
                                   double h, Real* out) const {
  if constexpr (std::is_same_v<Real, double>) {
    collocation_kernels().values({n, rates, y, low, h, 0, 0, terms}, a[0].data(), out);
  } else {
    for (Index m = 0; m < n; ++m) {
      const StageLanes<Real> sum = product(a, rates + lane_count * m);
      for (std::size_t k = 0; k < lane_count; ++k) {
        out[lane_count * m + static_cast<Index>(k)] = y[m] + (Real(h) * sum[k] + low[m]);
      }
    }
  }
}

template <class Real>
void StageArithmetic<Real>::positions(const Real* rates, const StageMatrix<Real>& a, const StageLanes<Real>& c,
                                      const StageLanes<Real>& c_low, const Real* y, const Real* low, const Real* v,
                                      double h, Real* out) const {
  if constexpr (std::is_same_v<Real, double>) {
    const DoubleDouble h2 = DoubleDouble::product(h, h);
    collocation_kernels().positions({n, rates, y, low, h, h2.high, h2.low, terms}, a[0].data(), c.data(), c_low.data(),
                                    v, out);
  } else {
    for (Index m = 0; m < n; ++m) {
      const StageLanes<Real> sum = product(a, rates + lane_count * m);
      const Real hv = Real(h) * v[m];
      for (std::size_t k = 0; k < lane_count; ++k) {
        out[lane_count * m + static_cast<Index>(k)] =
            y[m] + (c[k] * hv + (c_low[k] * hv + Real(h) * Real(h) * sum[k] + low[m]));
      }
    }
  }
}

template <class Real>
void StageArithmetic<Real>::extrapolation(int stages, const StageLanes<Real>& c, const StageLanes<Real>& barycentric,
                                          const Real& ratio, StageMatrix<Real>& w) const {
  if constexpr (std::is_same_v<Real, double>) {
    if (stages == lane_count) {
      return collocation_kernels().extrapolation(c.data(), barycentric.data(), ratio, w[0].data());
    }
  }
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Real x = Real(1) + c[i] * ratio;
    for (std::size_t j = 0; j < static_cast<std::size_t>(stages); ++j) {
      w[j][i] = barycentric[j];
      for (std::size_t m = 0; m < static_cast<std::size_t>(stages); ++m) {
        if (m != j) w[j][i] *= x - c[m];
      }
    }
  }
}

template <class Real>
void StageArithmetic<Real>::combine(const Real* rates, const StageMatrix<Real>& w, Real* out) const {
  if constexpr (std::is_same_v<Real, double>) {
    collocation_kernels().combine({n, rates, nullptr, nullptr, 0, 0, 0}, w[0].data(), out);
  } else {
    for (Index m = 0; m < n; ++m) {
      const StageLanes<Real> sum = product(w, rates + lane_count * m);
      for (std::size_t k = 0; k < lane_count; ++k) out[lane_count * m + static_cast<Index>(k)] = sum[k];
    }
  }
}

template <class Real> std::uint8_t StageArithmetic<Real>::moved(const Real* q, Real* known) const {
  if constexpr (std::is_same_v<Real, double>) {
    return collocation_kernels().moved(n, q, known);
  } else {
    unsigned stages = 0;
    for (Index at = 0; at < lane_count * n; ++at) {
      if (!(q[at] == known[at])) stages |= 1U << static_cast<unsigned>(at % lane_count);
      known[at] = q[at];
    }
    return static_cast<std::uint8_t>(stages);
  }
}

template <class Real> std::array<Real, 2> StageArithmetic<Real>::take(const Real* fresh, Real* rates) const {
  std::array<Real, 2> most{Real(0), Real(0)};
  if constexpr (std::is_same_v<Real, double>) {
    collocation_kernels().take(n, fresh, rates, &most[0], &most[1]);
  } else {
    using std::abs;
    for (Index k = 0; k < lane_count * n; ++k) {
      const Real change = abs(fresh[k] - rates[k]), size = abs(fresh[k]);
      if (!(change <= most[0])) most[0] = change;
      if (!(size <= most[1])) most[1] = size;
      rates[k] = fresh[k];
    }
  }
  return most;
}

template <class Real>
std::array<Real, 2> StageArithmetic<Real>::take_combined(const Real* rates, const StageMatrix<Real>& w,
                                                         Real* into) const {
  std::array<Real, 2> most{Real(0), Real(0)};
  if constexpr (std::is_same_v<Real, double>) {
    collocation_kernels().take_combined({n, rates, nullptr, nullptr, 0, 0, 0, terms}, w[0].data(), into, &most[0],
                                        &most[1]);
  } else {
    using std::abs;
    for (Index m = 0; m < n; ++m) {
      const StageLanes<Real> sum = product(w, rates + lane_count * m);
      for (std::size_t i = 0; i < static_cast<std::size_t>(terms); ++i) {
        Real& at = into[lane_count * m + static_cast<Index>(i)];
        const Real change = abs(sum[i] - at), size = abs(sum[i]);
        if (!(change <= most[0])) most[0] = change;
        if (!(size <= most[1])) most[1] = size;
        at = sum[i];
      }
    }
  }
  return most;
}

template <class Real>
void StageArithmetic<Real>::coefficient(const Real* rates, const StageLanes<Real>& w, Real* sum, Real* largest) const {
  if constexpr (std::is_same_v<Real, double>) {
    collocation_kernels().coefficient(n, rates, w.data(), sum, largest);
  } else {
    using std::abs;
    for (Index m = 0; m < n; ++m) {
      const Real* rate = rates + lane_count * m;
      sum[m] = largest[m] = Real(0);
      for (std::size_t j = 0; j < lane_count; ++j) {
        sum[m] += w[j] * rate[j];
        if (!(abs(rate[j]) <= largest[m])) largest[m] = abs(rate[j]);
      }
    }
  }
}

template <class Real>
void StageArithmetic<Real>::finish(const Real* rates, const std::array<StageLanes<Real>, 4>& weights, double h, Real* q,
                                   Real* q_low, Real* v, Real* v_low) const {
  if constexpr (std::is_same_v<Real, double>) {
    const DoubleDouble h2 = DoubleDouble::product(h, h);
    collocation_kernels().finish({n, rates, weights[0].data(), weights[1].data(), weights[2].data(), weights[3].data(),
                                  h, h2.high, h2.low, q, q_low, v, v_low});
  } else {
    for (Index m = 0; m < n; ++m) {
      std::array<Real, 4> sums{Real(0), Real(0), Real(0), Real(0)};
      for (std::size_t which = 0; which < 4; ++which) {
        for (std::size_t k = 0; k < lane_count; ++k) {
          sums[which] += weights[which][k] * rates[lane_count * m + static_cast<Index>(k)];
        }
      }
      const Real step(h), step2 = step * step;
      if (q != nullptr) {
        add_with_error(q[m], q_low[m], step * v[m], step2 * sums[2] + (step2 * sums[3] + step * v_low[m]));
      }
      add_with_error(v[m], v_low[m], step * sums[0], step * sums[1]);
    }
  }
}

template struct StageArithmetic<double>;
template struct StageArithmetic<Quad>;

}  // namespace noether
