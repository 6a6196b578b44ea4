#pragma once
/// Eight doubles side by side: eight stages of an implicit step, or eight systems of an ensemble, in one number.

#include "engine/types.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace noether {

/// A number with eight lanes; every operation goes lane by lane, with the bits of double.
///
/// A plain array with plain loops: right under any compiler and any flags, and turned into vector instructions where
/// there are some. Forces written over the number type run on it unchanged, as long as they do not branch on values:
/// comparisons hold if they hold in every lane.
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
    return each([](double a) { return -a; });
  }
  Pack operator+() const { return *this; }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }
  Pack& operator/=(const Pack& b) { return *this = *this / b; }
  friend Pack operator+(const Pack& a, const Pack& b) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = a.lane[k] + b.lane[k];
    return c;
  }
  friend Pack operator-(const Pack& a, const Pack& b) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = a.lane[k] - b.lane[k];
    return c;
  }
  friend Pack operator*(const Pack& a, const Pack& b) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = a.lane[k] * b.lane[k];
    return c;
  }
  friend Pack operator/(const Pack& a, const Pack& b) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = a.lane[k] / b.lane[k];
    return c;
  }
  friend bool operator==(const Pack& a, const Pack& b) { return a.lane == b.lane; }
  friend bool operator<(const Pack& a, const Pack& b) {
    return all(a, b, [](double x, double y) { return x < y; });
  }
  friend bool operator>(const Pack& a, const Pack& b) { return b < a; }
  friend bool operator<=(const Pack& a, const Pack& b) {
    return all(a, b, [](double x, double y) { return x <= y; });
  }
  friend bool operator>=(const Pack& a, const Pack& b) { return b <= a; }

  friend Pack sqrt(const Pack& a) {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = std::sqrt(a.lane[k]);
    return c;
  }
  friend Pack sin(const Pack& a) {
    return a.each([](double x) { return std::sin(x); });
  }
  friend Pack cos(const Pack& a) {
    return a.each([](double x) { return std::cos(x); });
  }
  friend Pack exp(const Pack& a) {
    return a.each([](double x) { return std::exp(x); });
  }
  friend Pack log(const Pack& a) {
    return a.each([](double x) { return std::log(x); });
  }
  friend Pack abs(const Pack& a) {
    return a.each([](double x) { return std::abs(x); });
  }
  friend Pack pow(const Pack& a, double p) {
    return a.each([p](double x) { return std::pow(x, p); });
  }
  friend bool isfinite(const Pack& a) {
    bool finite = true;
    for (const double x : a.lane) finite = finite && std::isfinite(x);
    return finite;
  }

 private:
  template <class Function> Pack each(const Function& f) const {
    Pack c;
    for (std::size_t k = 0; k < lanes; ++k) c.lane[k] = f(lane[k]);
    return c;
  }
  template <class Holds> static bool all(const Pack& a, const Pack& b, const Holds& holds) {
    bool every = true;
    for (std::size_t k = 0; k < lanes; ++k) every = every && holds(a.lane[k], b.lane[k]);
    return every;
  }
};

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
