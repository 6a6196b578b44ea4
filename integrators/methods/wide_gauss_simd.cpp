#include "integrators/methods/wide_gauss_simd.hpp"

#include "integrators/double_double_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

/// How numbers of eight stages stand in memory: as doubles, or in two words.
struct InDoubles {
  using Number = Eight;
  static constexpr std::ptrdiff_t size = 8;
  NOETHER_EIGHT_INLINE static Eight load(const double* from) { return load_eight(from); }
  NOETHER_EIGHT_INLINE static Eight load(const double (&words)[2][8]) { return load_eight(words[0]); }
  NOETHER_EIGHT_INLINE static void store(const Eight& a, double* to) { store_eight(a, to); }
  NOETHER_EIGHT_INLINE static Eight one(const double* from, int stage) { return from[stage]; }
  NOETHER_EIGHT_INLINE static Eight one(double high, double /*low*/) { return high; }
};
struct InWords {
  using Number = EightWide;
  static constexpr std::ptrdiff_t size = 16;
  NOETHER_EIGHT_INLINE static EightWide load(const double* from) { return {load_eight(from), load_eight(from + 8)}; }
  NOETHER_EIGHT_INLINE static EightWide load(const double (&words)[2][8]) { return load_wide(words); }
  NOETHER_EIGHT_INLINE static void store(const EightWide& a, double* to) {
    store_eight(a.high, to);
    store_eight(a.low, to + 8);
  }
  NOETHER_EIGHT_INLINE static EightWide one(const double* from, int stage) { return {from[stage], from[8 + stage]}; }
  NOETHER_EIGHT_INLINE static EightWide one(double high, double low) { return {high, low}; }
};

template <class In>
void place_all(const WideGaussWeights& weights, const WideGaussStart& start, double h, const double* rates,
               double* places) {
  using Number = typename In::Number;
  const Number step = In::one(h, 0.0), square = step * step, c = In::load(weights.c);
  for (std::ptrdiff_t k = 0; k < start.n; ++k, rates += In::size, places += In::size) {
    const Number x = In::one(start.x[k], start.x_low[k]), way = step * In::one(start.v[k], start.v_low[k]);
    Number sum = In::load(weights.twice[0]) * In::one(rates, 0);
    for (int j = 1; j < 8; ++j) sum = sum + In::load(weights.twice[j]) * In::one(rates, j);
    In::store(x + (c * way + square * sum), places);
  }
}

/// r^-3 from r^2; in two words by one step of Newton's from doubles.
NOETHER_EIGHT_INLINE Eight inverse_cube(const Eight& r2) { return Eight(1.0) / (r2 * square_root(r2)); }
NOETHER_EIGHT_INLINE EightWide inverse_cube(const EightWide& r2) {
  const Eight rough = inverse_cube(r2.high);
  const EightWide whole = (r2 * r2) * (r2 * exact_product(rough, rough));
  const Eight left = (Eight(1.0) - whole.high) - whole.low;
  return ordered_sum(rough, Eight(0.5) * rough * left);
}

template <class In>
void attract_all(std::ptrdiff_t n, const double* gm, const double* gm_low, const double* places, double* rates) {
  using Number = typename In::Number;
  constexpr std::ptrdiff_t size = In::size;
  const std::ptrdiff_t axis = size * n;
  const Number none = In::one(0.0, 0.0);
  for (std::ptrdiff_t k = 0; k < 3 * axis; k += size) In::store(none, rates + k);
  for (std::ptrdiff_t i = 1; i < n; ++i) {
    const Number mass = In::one(gm[i], gm_low[i]);
    const double* const at = places + size * i;
    const Number x = In::load(at), y = In::load(at + axis), z = In::load(at + 2 * axis);
    Number x_rate = none, y_rate = none, z_rate = none;
    for (std::ptrdiff_t j = 0; j < i; ++j) {
      if (gm[i] == 0 && gm[j] == 0) continue;
      const double* const other = places + size * j;
      double* const rate = rates + size * j;
      const Number dx = In::load(other) - x, dy = In::load(other + axis) - y, dz = In::load(other + 2 * axis) - z;
      const Number cube = inverse_cube((dx * dx + dy * dy) + dz * dz);
      const Number of_i = In::one(gm[j], gm_low[j]) * cube, of_j = mass * cube;
      x_rate = x_rate + of_i * dx;
      y_rate = y_rate + of_i * dy;
      z_rate = z_rate + of_i * dz;
      In::store(In::load(rate) - of_j * dx, rate);
      In::store(In::load(rate + axis) - of_j * dy, rate + axis);
      In::store(In::load(rate + 2 * axis) - of_j * dz, rate + 2 * axis);
    }
    double* const rate = rates + size * i;
    In::store(x_rate, rate);
    In::store(y_rate, rate + axis);
    In::store(z_rate, rate + 2 * axis);
  }
}

}  // namespace

extern const WideGaussKernels wide_gauss_kernels;
const WideGaussKernels wide_gauss_kernels{place_all<InDoubles>, place_all<InWords>, attract_all<InDoubles>,
                                          attract_all<InWords>};

}  // namespace noether::NOETHER_SIMD_LEVEL
