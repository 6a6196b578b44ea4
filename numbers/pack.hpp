#pragma once
/// Eight doubles side by side: eight stages of an implicit step, or eight systems of an ensemble, in one number.

#include "numbers/error.hpp"
#include "numbers/select.hpp"
#include "numbers/types.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace noether {

/// What a comparison of packs says, lane by lane.
///
/// As a condition of `if` or `while` it is a bool where all lanes agree. Where they differ there is no one branch to
/// take: it throws, and who asked for eight evaluations makes them one by one (`add_in_lanes`), with the same bits.
/// Write `select(mask, a, b)` to choose in lanes, `any` and `all` to ask for one answer.
struct Mask {
  static constexpr std::size_t lanes = 8;
  std::array<std::int64_t, lanes> lane{};  ///< 1 or 0; as wide as the numbers that they choose

  /// @throws LanesDiffer  where some lanes hold and others do not
  operator bool() const {  // NOLINT: a condition, as that of a number is
    const std::int64_t holding = count();
    if (holding != 0 && holding != lanes) throw LanesDiffer();
    return holding != 0;
  }
  Mask operator!() const {
    return of([&](std::size_t k) { return lane[k] == 0; });
  }
  friend Mask operator&&(const Mask& a, const Mask& b) {
    return of([&](std::size_t k) { return (a.lane[k] & b.lane[k]) != 0; });
  }
  friend Mask operator||(const Mask& a, const Mask& b) {
    return of([&](std::size_t k) { return (a.lane[k] | b.lane[k]) != 0; });
  }

  /// The mask of what `holds(k)` says of each lane.
  template <class Holds> static Mask of(const Holds& holds) {
    Mask result;
    for (std::size_t k = 0; k < lanes; ++k) result.lane[k] = holds(k) ? 1 : 0;
    return result;
  }

  /// In how many lanes it holds.
  std::int64_t count() const {
    std::int64_t holding = 0;
    for (const std::int64_t one : lane) holding += one;
    return holding;
  }
};

inline bool any(const Mask& mask) { return mask.count() != 0; }
inline bool all(const Mask& mask) { return mask.count() == Mask::lanes; }

struct Pack;
/// In each lane `a` where the mask holds there, else `b`. @throws never
Pack select(const Mask& mask, const Pack& a, const Pack& b);

/// A number with eight lanes; every operation goes lane by lane, with the bits of double.
///
/// A plain array with plain loops: right under any compiler and any flags, and turned into vector instructions where
/// there are some. Forces written over the number type run on it unchanged; how they choose says `Mask`.
/// @throws never
struct Pack {
  static constexpr std::size_t lanes = 8;
  std::array<double, lanes> lane;

  Pack() = default;
  template <class T>
    requires std::is_arithmetic_v<T> Pack(T x) {  // NOLINT: the same in all lanes
      lane.fill(static_cast<double>(x));
    }
  static Pack load(const double* from) {
    Pack p;
    for (std::size_t k = 0; k < lanes; ++k) p.lane[k] = from[k];
    return p;
  }
  void store(double* to) const {
    for (std::size_t k = 0; k < lanes; ++k) to[k] = lane[k];
  }

  Pack operator-() const {
    return each(*this, [](double x) { return -x; });
  }
  Pack operator+() const { return *this; }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }
  Pack& operator/=(const Pack& b) { return *this = *this / b; }
  friend Pack operator+(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return x + y; });
  }
  friend Pack operator-(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return x - y; });
  }
  friend Pack operator*(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return x * y; });
  }
  friend Pack operator/(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return x / y; });
  }

  friend Mask operator==(const Pack& a, const Pack& b) {
    return where(a, b, [](double x, double y) { return x == y; });
  }
  friend Mask operator!=(const Pack& a, const Pack& b) {
    return where(a, b, [](double x, double y) { return x != y; });
  }
  friend Mask operator<(const Pack& a, const Pack& b) {
    return where(a, b, [](double x, double y) { return x < y; });
  }
  friend Mask operator<=(const Pack& a, const Pack& b) {
    return where(a, b, [](double x, double y) { return x <= y; });
  }
  friend Mask operator>(const Pack& a, const Pack& b) { return b < a; }
  friend Mask operator>=(const Pack& a, const Pack& b) { return b <= a; }
  friend Mask isfinite(const Pack& a) {
    return Mask::of([&](std::size_t k) { return std::isfinite(a.lane[k]); });
  }
  friend Mask isnan(const Pack& a) {
    return Mask::of([&](std::size_t k) { return std::isnan(a.lane[k]); });
  }

  friend Pack sqrt(const Pack& a) {
    return each(a, [](double x) { return std::sqrt(x); });
  }
  friend Pack cbrt(const Pack& a) {
    return each(a, [](double x) { return std::cbrt(x); });
  }
  friend Pack sin(const Pack& a) {
    return each(a, [](double x) { return std::sin(x); });
  }
  friend Pack cos(const Pack& a) {
    return each(a, [](double x) { return std::cos(x); });
  }
  friend Pack tan(const Pack& a) {
    return each(a, [](double x) { return std::tan(x); });
  }
  friend Pack asin(const Pack& a) {
    return each(a, [](double x) { return std::asin(x); });
  }
  friend Pack acos(const Pack& a) {
    return each(a, [](double x) { return std::acos(x); });
  }
  friend Pack atan(const Pack& a) {
    return each(a, [](double x) { return std::atan(x); });
  }
  friend Pack sinh(const Pack& a) {
    return each(a, [](double x) { return std::sinh(x); });
  }
  friend Pack cosh(const Pack& a) {
    return each(a, [](double x) { return std::cosh(x); });
  }
  friend Pack tanh(const Pack& a) {
    return each(a, [](double x) { return std::tanh(x); });
  }
  friend Pack asinh(const Pack& a) {
    return each(a, [](double x) { return std::asinh(x); });
  }
  friend Pack acosh(const Pack& a) {
    return each(a, [](double x) { return std::acosh(x); });
  }
  friend Pack atanh(const Pack& a) {
    return each(a, [](double x) { return std::atanh(x); });
  }
  friend Pack exp(const Pack& a) {
    return each(a, [](double x) { return std::exp(x); });
  }
  friend Pack expm1(const Pack& a) {
    return each(a, [](double x) { return std::expm1(x); });
  }
  friend Pack log(const Pack& a) {
    return each(a, [](double x) { return std::log(x); });
  }
  friend Pack log1p(const Pack& a) {
    return each(a, [](double x) { return std::log1p(x); });
  }
  friend Pack erf(const Pack& a) {
    return each(a, [](double x) { return std::erf(x); });
  }
  friend Pack erfc(const Pack& a) {
    return each(a, [](double x) { return std::erfc(x); });
  }
  friend Pack floor(const Pack& a) {
    return each(a, [](double x) { return std::floor(x); });
  }
  friend Pack ceil(const Pack& a) {
    return each(a, [](double x) { return std::ceil(x); });
  }
  friend Pack round(const Pack& a) {
    return each(a, [](double x) { return std::round(x); });
  }
  friend Pack abs(const Pack& a) {
    return each(a, [](double x) { return std::abs(x); });
  }
  friend Pack fabs(const Pack& a) { return abs(a); }
  friend Pack atan2(const Pack& a, const Pack& b) {
    return each(a, b, [](double y, double x) { return std::atan2(y, x); });
  }
  friend Pack hypot(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return std::hypot(x, y); });
  }
  friend Pack fmod(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return std::fmod(x, y); });
  }
  friend Pack pow(const Pack& a, const Pack& b) {
    return each(a, b, [](double x, double y) { return std::pow(x, y); });
  }
  friend Pack pow(const Pack& a, double p) {
    return each(a, [p](double x) { return std::pow(x, p); });
  }
  friend Pack min(const Pack& a, const Pack& b) { return select(b < a, b, a); }
  friend Pack max(const Pack& a, const Pack& b) { return select(a < b, b, a); }

 private:
  template <class Function> static Pack each(const Pack& a, const Function& f) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = f(a.lane[k]);
    return c;
  }
  template <class Function> static Pack each(const Pack& a, const Pack& b, const Function& f) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = f(a.lane[k], b.lane[k]);
    return c;
  }
  template <class Holds> static Mask where(const Pack& a, const Pack& b, const Holds& holds) {
    return Mask::of([&](std::size_t k) { return holds(a.lane[k], b.lane[k]); });
  }
};

inline Pack select(const Mask& mask, const Pack& a, const Pack& b) {
  Pack c;
  for (std::size_t k = 0; k < Pack::lanes; ++k) c.lane[k] = mask.lane[k] != 0 ? a.lane[k] : b.lane[k];
  return c;
}

/// Copies packs by the widest registers there are: who reads a pack whole would wait for one that was written in parts.
/// @throws never
void copy_packs(const double* from, double* to, std::size_t packs);
/// Sets packs to 0 likewise. @throws never
void set_to_zero(Pack* packs, std::size_t count);

}  // namespace noether

namespace Eigen {
template <> struct NumTraits<noether::Pack> : NumTraits<double> {
  using Real = noether::Pack;
  using NonInteger = noether::Pack;
  using Nested = noether::Pack;
  enum {
    RequireInitialization = 1,
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    ReadCost = 8,
    AddCost = 8,
    MulCost = 8
  };
};
}  // namespace Eigen
