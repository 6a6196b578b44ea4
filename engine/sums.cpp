#include "engine/sums.hpp"

#include <bit>
#include <limits>

namespace noether {

namespace {

constexpr std::uint64_t low_half = 0xFFFFFFFF;

}  // namespace

void ExactDoubleSum::add(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t exponent = (bits >> 52U) & 0x7FFU, fraction = bits & ((std::uint64_t{1} << 52U) - 1);
  if (exponent == 0x7FFU) {
    infinite_ += x;
    return;
  }
  const std::uint64_t whole = exponent == 0 ? fraction : fraction | (std::uint64_t{1} << 52U);
  const std::uint64_t place = exponent == 0 ? 0 : exponent - 1, shift = place % 32;
  const std::uint64_t low = (whole & low_half) << shift, high = (whole >> 32U) << shift;
  const std::int64_t sign = std::signbit(x) ? -1 : 1;
  std::int64_t* digit = digits_.data() + place / 32;
  digit[0] += sign * static_cast<std::int64_t>(low & low_half);
  digit[1] += sign * static_cast<std::int64_t>((low >> 32U) + (high & low_half));
  digit[2] += sign * static_cast<std::int64_t>(high >> 32U);
}

double ExactDoubleSum::rounded() const {
  if (std::isnan(infinite_)) return std::numeric_limits<double>::quiet_NaN();
  if (infinite_ != 0) return infinite_;
  std::array<std::int64_t, std::tuple_size_v<decltype(digits_)>> digits = digits_;
  const auto carry = [&] {
    for (std::size_t k = 0; k + 1 < digits.size(); ++k) {
      digits[k + 1] += digits[k] >> 32;
      digits[k] &= static_cast<std::int64_t>(low_half);
    }
  };
  carry();
  const bool negative = digits.back() < 0;
  if (negative) {
    for (std::int64_t& digit : digits) digit = -digit;
    carry();
  }
  std::size_t top = digits.size();
  while (top > 0 && digits[top - 1] == 0) --top;
  if (top == 0) return 0;
  const auto below = [&](std::size_t k) { return top > k ? static_cast<std::uint64_t>(digits[top - 1 - k]) : 0; };
  // The first 64 bits, the last of which stands for all that follow; halves are told apart from what is above them.
  const int shift = std::countl_zero(static_cast<std::uint32_t>(below(0)));
  const std::uint64_t third = below(2) << static_cast<unsigned>(shift);
  std::uint64_t leading = ((below(0) << 32U) | below(1)) << static_cast<unsigned>(shift) | third >> 32U;
  bool more = (third & low_half) != 0;
  for (std::size_t k = 0; k + 3 < top; ++k) more = more || digits[k] != 0;
  leading |= more ? 1U : 0U;
  const double size = std::ldexp(static_cast<double>(leading), 32 * (static_cast<int>(top) - 2) - 1074 - shift);
  return negative ? -size : size;
}

}  // namespace noether
