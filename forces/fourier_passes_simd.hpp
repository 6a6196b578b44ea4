#pragma once
/// How a Fourier transform goes, for those who prepare one and for code in lanes.

#include <cstddef>

namespace noether {

/// Lines of numbers that a Fourier transform takes side by side; rows of a mesh are padded to a multiple of it.
inline constexpr std::ptrdiff_t fourier_lines = 8;

/// A Fourier transform of one length: a pass for each factor, 2, 3, 4, 5 or 7.
template <class T> struct FourierPasses {
  const int* factors;
  int count;
  const T* turns;  ///< of each pass exp(2 pi i b k / (own length)), shape (k from 1, b from 1, 2)
};

}  // namespace noether
