#include "engine/hermite.hpp"

#include "numbers/real.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

namespace noether {
namespace {

/// A point on a tilted ellipse with a third frequency: smooth, and no polynomial.
template <class Real> Motion<Real> curve(const Real& t) {
  using std::cos;
  using std::sin;
  const Real w(1.5);
  return {{cos(t), Real(0.5) * sin(t), sin(w * t)},
          {-sin(t), Real(0.5) * cos(t), w * cos(w * t)},
          {-cos(t), Real(-0.5) * sin(t), -w * w * sin(w * t)}};
}

Quad error_in_the_middle(const Quad& h) {
  const Hermite<Quad> path(curve(Quad(0.3)), curve(Quad(0.3) + h), h);
  const Vec3<Quad> exact = curve(Quad(0.3) + Quad(0.4) * h).x;
  return sqrt(norm2(path.position(Quad(0.4)) - exact));
}

/// Free motion past the origin, nearest at (0, 1, 0) when t = 2.
Motion<double> passing(double t) { return {{3 * (t - 2), 1, 0}, {3, 0, 0}, {0, 0, 0}}; }

}  // namespace

TEST_CASE("the Hermite polynomial meets both ends", "[hermite]") {
  const Quad h(0.7);
  const Motion<Quad> begin = curve(Quad(0.1)), end = curve(Quad(0.1) + h);
  const Hermite<Quad> path(begin, end, h);
  CHECK(norm2(path.position(Quad(0)) - begin.x) == Quad(0));
  CHECK(norm2(path.position(Quad(1)) - end.x) < Quad(1e-64));
  CHECK(norm2(path.slope(Quad(0)) - h * begin.v) == Quad(0));
  CHECK(norm2(path.slope(Quad(1)) - h * end.v) < Quad(1e-64));
}

TEST_CASE("the error of the Hermite polynomial is of order 6", "[hermite]") {
  double order = 0;
  for (const double h : {0.1, 0.05, 0.025}) {
    order = std::log2(static_cast<double>(error_in_the_middle(Quad(2 * h)) / error_in_the_middle(Quad(h))));
  }
  CHECK(std::abs(order - 6) < 0.05);
}

TEST_CASE("the nearest point of a passage inside the interval is found", "[hermite]") {
  const auto nearest = Hermite<double>(passing(0), passing(8), 8).nearest();
  CHECK(std::abs(nearest.distance2 - 1) <= 4 * std::numeric_limits<double>::epsilon());
  CHECK(std::abs(nearest.at - 0.25) <= 4 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("a body that only comes nearer or only leaves is nearest at an end", "[hermite]") {
  CHECK(Hermite<double>(passing(0), passing(1), 1).nearest().at == 1);
  CHECK(Hermite<double>(passing(3), passing(4), 1).nearest().at == 0);
}

TEST_CASE("time may run backwards along the polynomial", "[hermite]") {
  const auto nearest = Hermite<double>(passing(8), passing(0), -8).nearest();
  CHECK(std::abs(nearest.at - 0.75) <= 4 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("a passage in an interval too long for its motion is told to be unresolved", "[hermite]") {
  // Most of a turn on a unit circle, seen from a point a little inside: what lies between is a guess.
  const auto circle = [](double t) {
    return Motion<double>{
        {std::cos(t) - 0.9, std::sin(t), 0}, {-std::sin(t), std::cos(t), 0}, {-std::cos(t), -std::sin(t), 0}};
  };
  CHECK(Hermite<double>(circle(-0.1), circle(0.2), 0.3).nearest().resolved);
  CHECK(!Hermite<double>(circle(-2.0), circle(2.5), 4.5).nearest().resolved);
}

TEST_CASE("a place where polynomials of degree 3 and 5 agree by chance does not resolve a passage", "[hermite]") {
  // Off a straight line at y = 1e-3 by u^2 (1 - u)^2 (u - 1/2), which vanishes where the line is nearest.
  const Motion<double> begin{{-1, 1e-3, 0}, {2, 0, 0}, {0, -1, 0}}, end{{1, 1e-3, 0}, {2, 0, 0}, {0, 1, 0}};
  const auto nearest = Hermite<double>(begin, end, 1).nearest();
  CHECK(std::abs(nearest.at - 0.5) < 1e-4);
  CHECK(!nearest.resolved);
}

TEST_CASE("what may not come within a distance never does", "[hermite]") {
  const Hermite<double> path(passing(0), passing(8), 8);
  CHECK(path.may_come_within(1.0));
  CHECK(path.may_come_within(0.999));  // a bound, not the distance
  CHECK(!Hermite<double>(passing(0), passing(1), 1).may_come_within(1.0));
  CHECK(Hermite<double>(passing(0), passing(1), 1).may_come_within(3.2));
}

}  // namespace noether
