#pragma once
/// Particles on surfaces and curves that stand still.

#include "constraints/constraint.hpp"
#include "constraints/constraint_group.hpp"
#include "engine/description.hpp"

#include <array>
#include <optional>

namespace noether {

namespace detail {
template <class Real> Vec3<Real> vector_of(const std::array<double, 3>& v) {
  return Vec3<Real>(Real(v[0]), Real(v[1]), Real(v[2]));
}
inline double length_of(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
inline void check_direction(std::string_view key, const std::array<double, 3>& v) {
  if (!(length_of(v) > 0)) refuse_field(key, v, "has no direction; a vector other than 0 is expected");
}
inline void check_radius(const std::optional<double>& radius) {
  if (radius && !(*radius > 0)) refuse_field("radius", *radius, "is not a valid radius; a length above 0 is expected");
}
/// The part of x across a direction; `axis` of any length.
template <class Real> Vec3<Real> across(const Vec3<Real>& x, const std::array<double, 3>& axis) {
  const Vec3<Real> n = vector_of<Real>(axis);
  return x - n * (dot(n, x) / norm2(n));
}
}  // namespace detail

/// A particle stays where it is.
///
///     g = x - p
struct Fixed {
  std::optional<std::array<double, 3>> point = {};  ///< p; as at the start unless given [length]

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<Fixed>("fixed", "keeps a particle where it is", formula("x = p"),
                       field<&Fixed::point>("point", "length", "p; default: as at the start"));
  }
  Fixed at_start(const Points<double, 1>& x) const {
    return point ? *this : Fixed{std::array{x[0][0], x[0][1], x[0][2]}};
  }
  template <class Real> std::array<Real, 3> value(const Points<Real, 1>& x) const {
    return {x[0][0] - Real((*point)[0]), x[0][1] - Real((*point)[1]), x[0][2] - Real((*point)[2])};
  }
};

/// A particle stays at a distance from a point: on a sphere, or at the end of a rod that hangs there.
///
///     g = (|x - c|^2 - R^2) / 2
struct OnSphere {
  std::array<double, 3> center{};     ///< c [length]
  std::optional<double> radius = {};  ///< R; as at the start unless given [length]

  static constexpr std::size_t particles = 1;
  static constexpr Drawn drawn = Drawn::rod;
  static constexpr auto describe() {
    return part<OnSphere>("on_sphere", "keeps a particle on a sphere, or at the end of a rod from a point",
                          formula("|x - center| = radius"), field<&OnSphere::center>("center", "length"),
                          field<&OnSphere::radius>("radius", "length", "default: as at the start"));
  }
  /// @throws Error  for a radius that is not above 0
  void check() const { detail::check_radius(radius); }
  OnSphere at_start(const Points<double, 1>& x) const {
    return radius ? *this : OnSphere{center, std::sqrt(norm2(Vec3<double>(x[0] - detail::vector_of<double>(center))))};
  }
  template <class Real> Real value(const Points<Real, 1>& x) const {
    const Vec3<Real> r = x[0] - detail::vector_of<Real>(center);
    return (norm2(r) - Real(*radius) * Real(*radius)) / Real(2);
  }
  double scale() const { return *radius * *radius; }
  double residual(double g) const { return std::abs(std::sqrt(std::max(0.0, 1 + 2 * g / scale())) - 1); }
  bool keeps_angular_momentum() const { return center == std::array<double, 3>{}; }
};

/// A particle stays in a plane.
///
///     g = n . (x - p) / |n|
struct OnPlane {
  std::optional<std::array<double, 3>> point = {};  ///< p; where the particle starts unless given [length]
  std::array<double, 3> normal{0, 0, 1};            ///< n

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<OnPlane>("on_plane", "keeps a particle in a plane", formula("normal . (x - point) = 0"),
                         field<&OnPlane::point>("point", "length", "default: where the particle starts"),
                         field<&OnPlane::normal>("normal", "1"));
  }
  /// @throws Error  for a normal of length 0
  void check() const { detail::check_direction("normal", normal); }
  OnPlane at_start(const Points<double, 1>& x) const {
    return point ? *this : OnPlane{std::array{x[0][0], x[0][1], x[0][2]}, normal};
  }
  template <class Real> Real value(const Points<Real, 1>& x) const {
    using std::sqrt;
    const Vec3<Real> n = detail::vector_of<Real>(normal);
    return dot(n, Vec3<Real>(x[0] - detail::vector_of<Real>(*point))) / sqrt(norm2(n));
  }
};

/// A particle stays on a cylinder.
///
///     g = (|r - (n . r) n|^2 - R^2) / 2,   r = x - p, n along the axis
struct OnCylinder {
  std::array<double, 3> point{};  ///< p, on the axis [length]
  std::array<double, 3> axis{0, 0, 1};
  std::optional<double> radius = {};  ///< R; as at the start unless given [length]

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<OnCylinder>("on_cylinder", "keeps a particle at a distance from an axis",
                            formula("|r - (n . r) n| = radius,  r = x - point, n along the axis"),
                            field<&OnCylinder::point>("point", "length", "a point on the axis"),
                            field<&OnCylinder::axis>("axis", "1"),
                            field<&OnCylinder::radius>("radius", "length", "default: as at the start"));
  }
  /// @throws Error  for an axis of length 0, a radius that is not above 0
  void check() const {
    detail::check_direction("axis", axis);
    detail::check_radius(radius);
  }
  OnCylinder at_start(const Points<double, 1>& x) const {
    if (radius) return *this;
    const Vec3<double> r = detail::across<double>(x[0] - detail::vector_of<double>(point), axis);
    return OnCylinder{point, axis, std::sqrt(norm2(r))};
  }
  template <class Real> Real value(const Points<Real, 1>& x) const {
    const Vec3<Real> r = detail::across<Real>(x[0] - detail::vector_of<Real>(point), axis);
    return (norm2(r) - Real(*radius) * Real(*radius)) / Real(2);
  }
  double scale() const { return *radius * *radius; }
  double residual(double g) const { return std::abs(std::sqrt(std::max(0.0, 1 + 2 * g / scale())) - 1); }
};

/// A particle stays on a circle: in a plane through its centre, at a distance.
struct OnCircle {
  std::array<double, 3> center{};  ///< [length]
  std::array<double, 3> normal{0, 0, 1};
  std::optional<double> radius = {};  ///< as at the start unless given [length]

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<OnCircle>("on_circle", "keeps a particle on a circle",
                          formula("normal . (x - center) = 0, |x - center| = radius"),
                          field<&OnCircle::center>("center", "length"), field<&OnCircle::normal>("normal", "1"),
                          field<&OnCircle::radius>("radius", "length", "default: as at the start"));
  }
  /// @throws Error  for a normal of length 0, a radius that is not above 0
  void check() const {
    detail::check_direction("normal", normal);
    detail::check_radius(radius);
  }
  OnCircle at_start(const Points<double, 1>& x) const {
    return OnCircle{center, normal, OnSphere{center, radius}.at_start(x).radius};
  }
  template <class Real> std::array<Real, 2> value(const Points<Real, 1>& x) const {
    const Real plane = OnPlane{center, normal}.value(x);
    return {plane * Real(*radius), OnSphere{center, radius}.value(x)};
  }
  double scale() const { return *radius * *radius; }
};

/// A particle stays on a straight line.
///
///     g = two components of x - p across the direction
struct OnLine {
  std::optional<std::array<double, 3>> point = {};  ///< p; where the particle starts unless given [length]
  std::array<double, 3> direction{0, 0, 1};

  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<OnLine>("on_line", "keeps a particle on a straight line", formula("x - point is along the direction"),
                        field<&OnLine::point>("point", "length", "default: where the particle starts"),
                        field<&OnLine::direction>("direction", "1"));
  }
  /// @throws Error  for a direction of length 0
  void check() const { detail::check_direction("direction", direction); }
  OnLine at_start(const Points<double, 1>& x) const {
    return point ? *this : OnLine{std::array{x[0][0], x[0][1], x[0][2]}, direction};
  }
  template <class Real> std::array<Real, 2> value(const Points<Real, 1>& x) const {
    const Vec3<Real> r = x[0] - detail::vector_of<Real>(*point);
    const auto [u, w] = normals();
    return {dot(detail::vector_of<Real>(u), r), dot(detail::vector_of<Real>(w), r)};
  }

 private:
  /// Two directions across the line: away from the axis that is most across it, and across both.
  std::array<std::array<double, 3>, 2> normals() const {
    const double length = detail::length_of(direction);
    const Vec3<double> n(direction[0] / length, direction[1] / length, direction[2] / length);
    Index least = 0;
    n.cwiseAbs().minCoeff(&least);
    Vec3<double> u = cross<double>(n, Vec3<double>::Unit(least));
    u /= std::sqrt(norm2(u));
    const Vec3<double> w = cross<double>(n, u);
    return {{{u[0], u[1], u[2]}, {w[0], w[1], w[2]}}};
  }
};

extern template class ConstraintsOf<Fixed>;       // compiled once, in surfaces.cpp
extern template class ConstraintsOf<OnSphere>;    // compiled once, in surfaces.cpp
extern template class ConstraintsOf<OnPlane>;     // compiled once, in surfaces.cpp
extern template class ConstraintsOf<OnCylinder>;  // compiled once, in surfaces.cpp
extern template class ConstraintsOf<OnCircle>;    // compiled once, in surfaces.cpp
extern template class ConstraintsOf<OnLine>;      // compiled once, in surfaces.cpp

}  // namespace noether
