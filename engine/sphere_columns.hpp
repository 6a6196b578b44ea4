#pragma once
/// The columns of spheres: their radii, and what is counted where they touch.

#include "engine/columns.hpp"

#include <string_view>

namespace noether {

/// The radius of a body, shape (n) [length]; a column that particles have only where a part looks at it.
struct BodyRadius {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "radius", dimension = "length";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

/// How often a sphere has touched another one, shape (n).
struct ContactCount {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "contacts", dimension = "1";
  static constexpr ColumnRole role = ColumnRole::momentum;
};

/// Half of what each contact of a sphere has carried outwards: the momentum along y that the outer sphere got times
/// the distance of the two along x, shape (n).
struct ContactTransport {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "contact_transport", dimension = "mass length^2/time";
  static constexpr ColumnRole role = ColumnRole::momentum;
};

/// Half of the energy that each contact of a sphere has cost, shape (n).
struct ContactHeat {
  template <class Real> using type = ScalarColumn<Real>;
  static constexpr std::string_view name = "contact_heat", dimension = "energy";
  static constexpr ColumnRole role = ColumnRole::momentum;
};

}  // namespace noether
