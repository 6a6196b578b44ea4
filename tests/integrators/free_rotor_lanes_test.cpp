/// Turns axis by axis in lanes: those of one body after the other, to the bit, at every SIMD level.

#include "integrators/free_rotor.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <random>

namespace noether {
namespace {

struct TurningColumnsOf {
  RowColumn<double, 4> orientation;
  VectorColumn<double> spin, inertia;
};

/// Bodies, bodies in a line, points and bodies that do not turn, every `wild`th so fast that it leaves the lanes.
TurningColumnsOf turning_bodies(Index n, Index wild) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  TurningColumnsOf c{RowColumn<double, 4>(n), VectorColumn<double>(n), VectorColumn<double>(n)};
  for (Index i = 0; i < n; ++i) {
    Quaternion<double> q(normal(generator), normal(generator), normal(generator), normal(generator));
    c.orientation.set(i, q / q.norm());
    const Vec3<double> spin(normal(generator), normal(generator), normal(generator));
    Vec3<double> moments(1 + std::abs(normal(generator)), 1 + std::abs(normal(generator)), 2);
    if (i % 5 == 1) moments[i % 3] = 0;
    if (i % 7 == 2) moments.setZero();
    c.inertia.set(i, moments);
    c.spin.set(i, i % 11 == 3 ? Vec3<double>(Vec3<double>::Zero()) : Vec3<double>((i % wild == 4 ? 50 : 1) * spin));
  }
  return c;
}

}  // namespace

TEST_CASE("bodies turn in lanes as each alone, in every order of axes", "[integrators][lanes][free_rotor]") {
  const double h = 0.1;
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const char* axes : {"xyz", "yzx", "zxy", "xzy", "zyx", "yxz"}) {
      const AxisOrder order = axis_order(axes);
      for (const Index n : {1, 8, 13, 64, 100}) {
        const TurningColumnsOf start = turning_bodies(n, n == 64 ? 1000 : 16);
        RowColumn<double, 4> turned = start.orientation;
        ScalarColumn<double> action((n + 7) / 8 * 8);
        turn_all_by_axes<double>(turned, start.spin, start.inertia, h, order, 0, n, action);
        for (Index i = 0; i < n; ++i) {
          INFO(axes << ", body " << i << " of " << n);
          const Quaternion<double> q = start.orientation[i];
          const Vec3<double> moments = start.inertia[i];
          const Turned<double> alone = turn_by_axes<double>(q, start.spin[i], moments, h, order);
          const bool is_point = moments.norm() == 0;
          CHECK((std::as_const(turned)[i] == (is_point ? q : alone.orientation) && action[i] == alone.action));
        }
      }
    }
  }
}

TEST_CASE("one body of eight without a number leaves the others right", "[integrators][lanes][free_rotor]") {
  TurningColumnsOf c = turning_bodies(8, 1000);
  const TurningColumnsOf start = c;
  c.spin.set(0, Vec3<double>(std::nan(""), 0, 0));
  ScalarColumn<double> action(8);
  const AxisOrder order = axis_order("xyz");
  turn_all_by_axes<double>(c.orientation, c.spin, c.inertia, 0.1, order, 0, 8, action);
  CHECK(std::isnan(std::as_const(c.orientation)[0][0]));
  const Vec3<double> moments = start.inertia[5];
  CHECK(std::as_const(c.orientation)[5] ==
        turn_by_axes<double>(start.orientation[5], start.spin[5], moments, 0.1, order).orientation);
}

}  // namespace noether
