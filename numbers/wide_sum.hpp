#pragma once
/// Sums that are added up as numbers come, and hardly know in which order.

#include "numbers/select.hpp"
#include "numbers/types.hpp"

#include <array>
#include <type_traits>

namespace noether {

/// Several doubles side by side, as `Pack` is.
template <class Real> concept InLanes = requires(Real x) { x.lane; };

/// A sum that keeps beside it what its rounding leaves out.
///
/// Doubles, and doubles in lanes, have some 106 bits: the value is right to 2^-53 of itself and n 2^-105 of the sum of
/// all sizes. Another order of the terms gives the same bits, unless the sum falls that near to the middle of two
/// doubles. Other number types are added as they are.
/// @cost 7 operations a number
/// @source OgitaRumpOishi2005
template <class Real> class WideSum {
 public:
  WideSum& operator+=(const Real& x) {
    if constexpr (wide) {
      const Real sum = high_ + x, of_x = sum - high_;
      low_ += (high_ - (sum - of_x)) + (x - of_x);
      high_ = sum;
    } else {
      high_ += x;
    }
    return *this;
  }
  WideSum& operator-=(const Real& x) { return *this += -x; }
  WideSum& operator+=(const WideSum& other) {
    *this += other.high_;
    low_ += other.low_;
    return *this;
  }

  /// The sum, rounded; infinite where a term was, and not a number with infinities of both signs.
  Real value() const {
    if constexpr (wide) {
      const Real all = high_ + low_;
      return select(all == all, all, high_);  // beside infinity, rounding errors are no numbers
    } else {
      return high_;
    }
  }

  /// The sum as rounded number by number, and what that left out: 0 in number types that are added as they are.
  /// @throws never
  const Real& high() const { return high_; }
  const Real& low() const { return low_; }

  /// What has been added in one of the lanes. @param k  which  @throws never
  WideSum<double> lane(std::size_t k) const requires InLanes<Real> {
    return {high_.lane[k], low_.lane[k]};
  }
  void set_lane(std::size_t k, const WideSum<double>& sum) requires InLanes<Real> {
    high_.lane[k] = sum.high_;
    low_.lane[k] = sum.low_;
  }

  WideSum() = default;

 private:
  template <class> friend class WideSum;
  static constexpr bool wide = std::is_same_v<Real, double> || InLanes<Real>;
  WideSum(const Real& high, const Real& low) : high_(high), low_(low) {}

  Real high_ = Real(0);
  Real low_ = Real(0);
};

/// The same of 3 x 3 numbers, as a virial tensor is one.
template <class Real> class WideTensor {
 public:
  /// Adds x (x) f.
  void add_outer(const Vec3<Real>& x, const Vec3<Real>& f) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) at(r, c) += x[r] * f[c];
    }
  }
  WideTensor& operator+=(const Mat3<Real>& w) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) at(r, c) += w(r, c);
    }
    return *this;
  }
  WideTensor& operator+=(const WideTensor& other) {
    for (std::size_t k = 0; k < 9; ++k) sums_[k] += other.sums_[k];
    return *this;
  }
  Mat3<Real> value() const {
    Mat3<Real> w;
    for (int k = 0; k < 9; ++k) w(k / 3, k % 3) = sums_[static_cast<std::size_t>(k)].value();
    return w;
  }

  WideTensor<double> lane(std::size_t k) const requires InLanes<Real> {
    WideTensor<double> one;
    for (std::size_t i = 0; i < 9; ++i) one.sums_[i] = sums_[i].lane(k);
    return one;
  }
  void set_lane(std::size_t k, const WideTensor<double>& one) requires InLanes<Real> {
    for (std::size_t i = 0; i < 9; ++i) sums_[i].set_lane(k, one.sums_[i]);
  }

 private:
  template <class> friend class WideTensor;
  WideSum<Real>& at(int r, int c) { return sums_[static_cast<std::size_t>(3 * r + c)]; }

  std::array<WideSum<Real>, 9> sums_;
};

}  // namespace noether
