#pragma once
/// Sums over particles that come out the same in any order.

#include "numbers/parallel.hpp"
#include "numbers/wide_sum.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace noether {

/// The exact sum of doubles of any sizes, up to 2^30 of them: it does not depend on their order.
/// @cost some 20 operations of whole numbers for each
class ExactDoubleSum {
 public:
  void add(double x);
  /// The sum, rounded once; not a number if one of the numbers was none, or with infinities of both signs.
  /// @throws never
  double rounded() const;

 private:
  std::array<std::int64_t, 67> digits_{};  ///< to the base 2^32, carries not taken; the first counts 2^-1074
  double infinite_ = 0;                    ///< sum of what was not finite
};

namespace detail {

/// A wide sum, and the sum of all sizes, which tells how good it is.
struct JudgedSum {
  WideSum<double> sum;
  double sizes = 0;

  void add(double x) {
    sum += x;
    sizes += std::abs(x);
  }
  JudgedSum& operator+=(const JudgedSum& other) {
    sum += other.sum;
    sizes += other.sizes;
    return *this;
  }
  /// The exact sum of `n` numbers that were added in blocks, rounded; empty where the digits do not tell.
  std::optional<double> rounded(Index n) const {
    const double additions = static_cast<double>(block_size + n / block_size);
    const double doubt = sizes * (additions * additions * 0x1p-104);
    const double least = sum.high() + (sum.low() - doubt), most = sum.high() + (sum.low() + doubt);
    if (!(least == most)) return {};
    return most;
  }
};

/// Several sums of a block of particles.
template <class Sum, std::size_t count> struct BlockSums {
  std::array<Sum, count> of;

  BlockSums& operator+=(const BlockSums& other) {
    for (std::size_t k = 0; k < count; ++k) of[k] += other.of[k];
    return *this;
  }
};

}  // namespace detail

/// Several sums over [0, n): those of the numbers that `terms(i)` gives as a `std::array<Real, count>`.
///
/// Of doubles each is the exact sum, rounded once, so that the order of particles never matters, nor how they are
/// shared out. Other numbers are added in fixed blocks, in the order of particles. Sums that enter a trajectory, as
/// those of forces, keep rules of their own.
/// @param terms  may be asked twice, and by several threads; must not throw
/// @cost 9 operations for each number; a pass of `ExactDoubleSum` over what cancels to less than its own rounding
/// @throws never
template <class Real, std::size_t count, class Terms> std::array<Real, count> sums_over(Index n, const Terms& terms) {
  std::array<Real, count> result;
  if constexpr (std::is_same_v<Real, double>) {
    using Sums = detail::BlockSums<detail::JudgedSum, count>;
    const Sums all = reduce(n, Sums{}, [&](Index begin, Index end) {
      Sums block{};
      for (Index i = begin; i < end; ++i) {
        const std::array<double, count> row = terms(i);
        for (std::size_t k = 0; k < count; ++k) block.of[k].add(row[k]);
      }
      return block;
    });
    for (std::size_t k = 0; k < count; ++k) {
      if (const auto sure = all.of[k].rounded(n)) {
        result[k] = *sure;
        continue;
      }
      ExactDoubleSum exact;
      for (Index i = 0; i < n; ++i) exact.add(terms(i)[k]);
      result[k] = exact.rounded();
    }
  } else {
    using Sums = detail::BlockSums<Real, count>;
    Sums zero;
    zero.of.fill(Real(0));
    result = reduce(n, zero, [&](Index begin, Index end) {
               Sums block = zero;
               for (Index i = begin; i < end; ++i) block += Sums{terms(i)};
               return block;
             }).of;
  }
  return result;
}

/// The sum of `term(i)` over [0, n), as `sums_over` has it.
template <class Real, class Term> Real sum_over(Index n, const Term& term) {
  return sums_over<Real, 1>(n, [&](Index i) { return std::array<Real, 1>{term(i)}; })[0];
}

}  // namespace noether
