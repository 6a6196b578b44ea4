#pragma once
/// Fourier transforms of lines side by side, one in each lane; for `*_simd.cpp` alone.

#include "forces/fourier_passes_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class T> using FourierTag = hn::CappedTag<T, static_cast<std::size_t>(fourier_lines)>;
template <class T> using FourierVector = hn::Vec<FourierTag<T>>;
/// Lines in one register.
template <class T> constexpr std::ptrdiff_t lines_at_once = hn::MaxLanes(FourierTag<T>());

template <class T> struct ComplexLanes { FourierVector<T> re, im; };

/// Numbers of lines side by side, in memory: number k of all lines is at re + k stride and im + k stride.
template <class T> struct FourierLines {
  T *re, *im;
  std::ptrdiff_t stride;

  HWY_INLINE ComplexLanes<T> get(std::ptrdiff_t k) const {
    const FourierTag<T> d;
    return {hn::LoadU(d, re + k * stride), hn::LoadU(d, im + k * stride)};
  }
  HWY_INLINE void put(std::ptrdiff_t k, const ComplexLanes<T>& z) const {
    const FourierTag<T> d;
    hn::StoreU(z.re, d, re + k * stride);
    hn::StoreU(z.im, d, im + k * stride);
  }
  /// The same with real and imaginary parts exchanged: a transform of these is one back.
  FourierLines exchanged() const { return {im, re, stride}; }
};

/// Lines of a buffer of their own.
template <class T> FourierLines<T> buffered(T* buffer) {
  return {buffer, buffer + lines_at_once<T>, 2 * lines_at_once<T>};
}

/// cos and sin of 2 pi k / radix.
template <int radix> struct Circle;
template <> struct Circle<3> { static constexpr double cosine[2] = {1, -0.5}, sine[2] = {0, 0.86602540378443864676}; };
template <> struct Circle<5> {
  static constexpr double cosine[3] = {1, 0.30901699437494742410, -0.80901699437494742410};
  static constexpr double sine[3] = {0, 0.95105651629515357212, 0.58778525229247312917};
};
template <> struct Circle<7> {
  static constexpr double cosine[4] = {1, 0.62348980185873353053, -0.22252093395631440429, -0.90096886790241912624};
  static constexpr double sine[4] = {0, 0.78183148246802980871, 0.97492791218182360702, 0.43388373911755812048};
};

/// x_b = sum_a exp(-2 pi i a b / radix) x_a
template <int radix, class T> HWY_INLINE void butterfly(ComplexLanes<T> (&x)[radix]) {
  const FourierTag<T> d;
  if constexpr (radix == 2) {
    const ComplexLanes<T> a = x[0], b = x[1];
    x[0] = {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
    x[1] = {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
  } else if constexpr (radix == 4) {
    const ComplexLanes<T> a{hn::Add(x[0].re, x[2].re), hn::Add(x[0].im, x[2].im)};
    const ComplexLanes<T> b{hn::Sub(x[0].re, x[2].re), hn::Sub(x[0].im, x[2].im)};
    const ComplexLanes<T> c{hn::Add(x[1].re, x[3].re), hn::Add(x[1].im, x[3].im)};
    const ComplexLanes<T> e{hn::Sub(x[1].re, x[3].re), hn::Sub(x[1].im, x[3].im)};
    x[0] = {hn::Add(a.re, c.re), hn::Add(a.im, c.im)};
    x[1] = {hn::Add(b.re, e.im), hn::Sub(b.im, e.re)};
    x[2] = {hn::Sub(a.re, c.re), hn::Sub(a.im, c.im)};
    x[3] = {hn::Sub(b.re, e.im), hn::Add(b.im, e.re)};
  } else {
    constexpr int half = radix / 2;
    ComplexLanes<T> sum[half + 1], difference[half + 1];
    for (int j = 1; j <= half; ++j) {
      sum[j] = {hn::Add(x[j].re, x[radix - j].re), hn::Add(x[j].im, x[radix - j].im)};
      difference[j] = {hn::Sub(x[j].re, x[radix - j].re), hn::Sub(x[j].im, x[radix - j].im)};
    }
    const ComplexLanes<T> first = x[0];
    for (int j = 1; j <= half; ++j) x[0] = {hn::Add(x[0].re, sum[j].re), hn::Add(x[0].im, sum[j].im)};
    for (int b = 1; b <= half; ++b) {
      ComplexLanes<T> even = first, odd;
      for (int j = 1; j <= half; ++j) {
        const int turn = b * j % radix, folded = turn > half ? radix - turn : turn;
        const auto cosine = hn::Set(d, static_cast<T>(Circle<radix>::cosine[folded]));
        const auto sine =
            hn::Set(d, static_cast<T>(turn > half ? -Circle<radix>::sine[folded] : Circle<radix>::sine[folded]));
        even = {hn::MulAdd(cosine, sum[j].re, even.re), hn::MulAdd(cosine, sum[j].im, even.im)};
        if (j == 1) {
          odd = {hn::Mul(sine, difference[j].re), hn::Mul(sine, difference[j].im)};
        } else {
          odd = {hn::MulAdd(sine, difference[j].re, odd.re), hn::MulAdd(sine, difference[j].im, odd.im)};
        }
      }
      x[b] = {hn::Add(even.re, odd.im), hn::Sub(even.im, odd.re)};
      x[radix - b] = {hn::Sub(even.re, odd.im), hn::Add(even.im, odd.re)};
    }
  }
}

/// One pass: `parts` groups of `length` times radix numbers become radix times as many of `length`.
template <int radix, class T, class From>
HWY_NOINLINE void pass(const From& from, const FourierLines<T>& to, std::ptrdiff_t length, std::ptrdiff_t parts,
                       const T* turns) {
  const FourierTag<T> d;
  for (std::ptrdiff_t k = 0; k < parts; ++k) {
    const T* turn = turns;
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      ComplexLanes<T> x[radix];
      for (int b = 0; b < radix; ++b) x[b] = from.get(i + length * (b + radix * k));
      butterfly<radix, T>(x);
      to.put(i + length * k, x[0]);
      if (i == 0) {
        for (int b = 1; b < radix; ++b) to.put(length * (k + parts * b), x[b]);
        continue;
      }
      for (int b = 1; b < radix; ++b, turn += 2) {
        const auto cosine = hn::Set(d, turn[0]), sine = hn::Set(d, turn[1]);
        to.put(i + length * (k + parts * b), {hn::MulAdd(x[b].re, cosine, hn::Mul(x[b].im, sine)),
                                              hn::NegMulAdd(x[b].re, sine, hn::Mul(x[b].im, cosine))});
      }
    }
  }
}

template <class T, class From>
void pass(int radix, const From& from, const FourierLines<T>& to, std::ptrdiff_t length, std::ptrdiff_t parts,
          const T* turns) {
  switch (radix) {
    case 2:
      return pass<2, T>(from, to, length, parts, turns);
    case 3:
      return pass<3, T>(from, to, length, parts, turns);
    case 4:
      return pass<4, T>(from, to, length, parts, turns);
    case 5:
      return pass<5, T>(from, to, length, parts, turns);
    default:
      return pass<7, T>(from, to, length, parts, turns);
  }
}

/// to_k = sum_j exp(-2 pi i j k / n) from_j; `to` may be the memory of `from`.
/// @param room  for 4 lines_at_once<T> n numbers, none of them of `from` or `to`
template <class T, class From>
void fourier(const FourierPasses<T>& passes, std::ptrdiff_t n, const From& from, const FourierLines<T>& to, T* room) {
  const FourierLines<T> buffers[2] = {buffered<T>(room), buffered<T>(room + 2 * lines_at_once<T> * n)};
  const T* turns = passes.turns;
  std::ptrdiff_t parts = 1;
  for (int k = 0; k < passes.count; ++k) {
    const int radix = passes.factors[k];
    const std::ptrdiff_t length = n / (parts * radix);
    const FourierLines<T>& target = k + 1 == passes.count ? to : buffers[k % 2];
    if (k == 0) {
      pass<T, From>(radix, from, target, length, parts, turns);
    } else {
      pass<T, FourierLines<T>>(radix, buffers[(k + 1) % 2], target, length, parts, turns);
    }
    turns += 2 * (length - 1) * (radix - 1);
    parts *= radix;
  }
}

}  // namespace
}  // namespace noether::NOETHER_SIMD_LEVEL
