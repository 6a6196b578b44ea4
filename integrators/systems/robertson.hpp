#pragma once
/// Robertson's kinetics: three substances, rates nine decades apart.

#include "engine/description.hpp"
#include "integrators/vector_field.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Three reactions of A, B and C, the classical stiff problem: A -> B slowly, B + B -> C + B very fast, B + C -> A + C.
///
///     A' = -k1 A + k3 B C,   B' = k1 A - k2 B^2 - k3 B C,   C' = k2 B^2;   A + B + C is kept
/// @source Robertson1966, HairerWanner1996
struct Robertson {
  double k1 = 0.04;  ///< of A -> B [1/time]
  double k2 = 3e7;   ///< of B + B -> C + B [1/time]
  double k3 = 1e4;   ///< of B + C -> A + C [1/time]

  static constexpr auto describe() {
    return part<Robertson>("robertson", "chemical kinetics of three substances, rates nine decades apart",
                           formula("A' = -k1 A + k3 B C,  B' = k1 A - k2 B^2 - k3 B C,  C' = k2 B^2"),
                           source("Robertson1966 HairerWanner1996"), quantities("A, B, C [1]"),
                           field<&Robertson::k1>("k1", "1/time", "rate of A -> B"),
                           field<&Robertson::k2>("k2", "1/time", "rate of B + B -> C + B"),
                           field<&Robertson::k3>("k3", "1/time", "rate of B + C -> A + C"));
  }
  /// @throws Error  for a negative rate
  void check() const {
    for (const auto& [key, rate] : {std::pair{"k1", k1}, std::pair{"k2", k2}, std::pair{"k3", k3}}) {
      if (!(rate >= 0) || !std::isfinite(rate)) refuse_field(key, rate, "is not a valid rate; 0 or more is expected");
    }
  }

  Index size() const { return 3; }
  std::vector<double> start() const { return {1, 0, 0}; }
  std::vector<std::string> names() const { return {"A", "B", "C"}; }

  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    const Real made = Real(k1) * y[0], back = Real(k3) * y[1] * y[2], used = Real(k2) * y[1] * y[1];
    dy[0] = back - made;
    dy[1] = made - back - used;
    dy[2] = used;
  }
};

}  // namespace noether
