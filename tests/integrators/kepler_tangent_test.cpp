/// The derivative of Kepler arcs against differences of arcs in 113 bits.

#include "integrators/kepler_tangent.hpp"
#include "tests/integrators/kepler_orbits.hpp"

using namespace noether;
using namespace noether::kepler_test;

namespace {

/// An arc as it starts, in doubles.
struct Start {
  Doubles state;
  double mu, h;
};

KeplerTangent tangent_of(const Start& a) {
  return {a.state.x, a.state.v, a.mu, a.h, kepler_arc(a.state.x, a.state.v, a.mu, a.h).s};
}

/// The change of the end for a change of the start, by central differences in 113 bits.
KeplerChange difference(const Start& a, const KeplerChange& change) {
  const Quad delta(0x1p-36);
  const auto end = [&](const Quad& by) {
    const Quads s{a.state.x.cast<Quad>() + by * change.x.cast<Quad>(),
                  a.state.v.cast<Quad>() + by * change.v.cast<Quad>()};
    return advanced(s, Quad(a.mu), Quad(a.h));
  };
  const Quads up = end(delta), down = end(-delta);
  const auto slope = [&](const Vec3<Quad>& x1, const Vec3<Quad>& x0) {
    const Vec3<Quad> d = (x1 - x0) / (Quad(2) * delta);
    return Vec3<double>(static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2]));
  };
  return {slope(up.x, down.x), slope(up.v, down.v)};
}

double size_of(const KeplerChange& c) { return std::sqrt(norm2(c.x) + norm2(c.v)); }
double distance(const KeplerChange& a, const KeplerChange& b) {
  return size_of({Vec3<double>(a.x - b.x), Vec3<double>(a.v - b.v)});
}
KeplerChange some_change(Random& random) {
  const auto three = [&] { return Vec3<double>(random(-1, 1), random(-1, 1), random(-1, 1)); };
  return {three(), three()};
}

/// Ellipses and hyperbolas with mu, a and h near 1, so that positions and velocities weigh alike.
Start some_start(Random& random, int kind) {
  const Turn turn(random);
  const Quad mu(random(0.5, 2)), a(random(0.7, 1.4));
  const double h = random(-3, 3);
  if (kind == 0) return {narrow(on_ellipse(turn, mu, a, Quad(random(0, 0.7)), Quad(random(0, 6.3)))), double(mu), h};
  if (kind == 1) return {narrow(on_parabola(turn, mu, a, Quad(random(-1, 1)))), double(mu), h};
  return {narrow(on_hyperbola(turn, mu, a, Quad(random(1.2, 3)), Quad(random(-2, 2)))), double(mu), h};
}

}  // namespace

TEST_CASE("the tangent of an arc is its derivative by the start", "[kepler]") {
  Random random(21);
  for (int n = 0; n < 300; ++n) {
    const Start a = some_start(random, n % 3);
    const KeplerTangent tangent = tangent_of(a);
    const KeplerChange change = some_change(random), right = difference(a, change);
    const KeplerChange found{tangent.position(change), tangent.velocity(change)};
    CAPTURE(n, a.h, distance(found, right), size_of(right));
    CHECK(distance(found, right) < 2e-13 * (1 + size_of(right)) * (1 + size_of(right)));
  }
}

TEST_CASE("a change of the start is found for every change of velocity at the end", "[kepler]") {
  Random random(22);
  for (int n = 0; n < 300; ++n) {
    const Start a = some_start(random, n % 3);
    const KeplerTangent tangent = tangent_of(a);
    const Vec3<double> kick = some_change(random).v;
    const KeplerChange start = tangent.start_of(kick);
    const KeplerChange end{tangent.position(start), tangent.velocity(start)};
    CAPTURE(n, a.h, distance(end, {Vec3<double>::Zero(), kick}), size_of(start));
    CHECK(distance(end, {Vec3<double>::Zero(), kick}) < 2e-13 * (1 + size_of(start)) * (1 + size_of(start)));
  }
}

TEST_CASE("an arc of no time changes nothing", "[kepler]") {
  const Start a{{{1, 0.2, 0}, {0.1, 1, 0.3}}, 1, 0};
  const KeplerTangent tangent(a.state.x, a.state.v, a.mu, 0, 0);
  const KeplerChange change{{1, 2, 3}, {4, 5, 6}};
  CHECK(tangent.position(change) == change.x);
  CHECK(tangent.velocity(change) == change.v);
  CHECK(tangent.start_of(change.v).v == change.v);
}
