#pragma once
/// A fixed distance of two particles.

#include "constraints/constraint.hpp"
#include "constraints/constraint_group.hpp"
#include "engine/description.hpp"

#include <cmath>
#include <optional>

namespace noether {

/// Two particles stay at a distance: a bond, a link of a chain.
///
///     g = (|x_1 - x_2|^2 - d^2) / 2
///
/// The halved square has the gradient r, -r: no root, and no division, in the innermost loop.
/// @source RyckaertCiccottiBerendsen1977
struct Distance {
  std::optional<double> length = {};  ///< d; as at the start unless given [length]

  static constexpr std::size_t particles = 2;
  static constexpr bool keeps_momentum = true, keeps_angular_momentum = true;
  static constexpr Drawn drawn = Drawn::link;
  static constexpr auto describe() {
    return part<Distance>("distance", "keeps the distance of two particles", formula("|x_1 - x_2| = d"),
                          source("RyckaertCiccottiBerendsen1977"),
                          field<&Distance::length>("length", "length", "d; default: as at the start"));
  }

  /// @throws Error  for a length that is not above 0
  void check() const {
    if (length && !(*length > 0))
      refuse_field("length", *length, "is not a valid length of a bar; a length above 0 is expected");
  }
  Distance at_start(const Points<double, 2>& x) const {
    return length ? *this : Distance{std::sqrt(norm2(Vec3<double>(x[0] - x[1])))};
  }

  template <class Real> Real value(const Points<Real, 2>& x) const {
    const Vec3<Real> r = x[0] - x[1];
    return (norm2(r) - Real(*length) * Real(*length)) / Real(2);
  }
  template <class Real> std::array<Points<Real, 2>, 1> gradient(const Points<Real, 2>& x) const {
    const Vec3<Real> r = x[0] - x[1];
    return {{{r, -r}}};
  }
  double scale() const { return *length * *length; }
  double reach() const { return *length; }
  /// | |r| - d | / d.
  double residual(double g) const { return std::abs(std::sqrt(std::max(0.0, 1 + 2 * g / scale())) - 1); }
};

extern template class ConstraintsOf<Distance>;  // compiled once, in distance.cpp

}  // namespace noether
