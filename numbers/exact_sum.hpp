#pragma once
/// Sums of whole numbers that no number of them overflows, as forces of short range count their energy.

#include <cstdint>

namespace noether {

/// A sum of 64-bit whole numbers, exact up to 2^31 of them: it does not depend on their order.
struct ExactSum {
  std::int64_t high = 0, low = 0;  ///< high 2^32 + low

  ExactSum& operator+=(std::int64_t x) {
    low += x & 0xFFFFFFFF;
    high += x >> 32;
    return *this;
  }
  ExactSum& operator+=(const ExactSum& other) {
    low += other.low;
    high += other.high;
    return *this;
  }
  /// The sum times a power of two, rounded.
  double times(double unit) const {
    const std::int64_t carry = low >> 32;
    return (static_cast<double>(high + carry) * 0x1p32 + static_cast<double>(low & 0xFFFFFFFF)) * unit;
  }
};

}  // namespace noether
