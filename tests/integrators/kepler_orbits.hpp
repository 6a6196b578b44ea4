#pragma once
/// Orbits in closed form, and errors of Kepler arcs in units of what rounding the inputs would do.

#include "integrators/kepler.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace noether::kepler_test {

inline constexpr double unit = 0x1p-53;        // rounding of a double
inline constexpr double quad_unit = 0x1p-113;  // and of a Quad
inline constexpr double few = 20;              // roundings
inline constexpr Quad two_pi = 6.28318530717958647692528676655900576839_q;

template <class Real> struct State { Vec3<Real> x, v; };
using Doubles = State<double>;
using Quads = State<Quad>;

inline Quads widen(const Doubles& s) { return {s.x.cast<Quad>(), s.v.cast<Quad>()}; }
inline Doubles narrow(const Quads& s) {
  Doubles d;
  for (int k = 0; k < 3; ++k) {
    d.x[k] = static_cast<double>(s.x[k]);
    d.v[k] = static_cast<double>(s.v[k]);
  }
  return d;
}

template <class Real> Real length(const Vec3<Real>& a) {
  using std::sqrt;
  return sqrt(norm2(a));
}

/// After one arc; fails the test unless it converged.
template <class Real> State<Real> advanced(const State<Real>& s, Real mu, Real h) {
  const KeplerArc<Real> arc = kepler_arc(s.x, s.v, mu, h);
  REQUIRE(arc.status == KeplerStatus::converged);
  return {s.x + arc.dx, s.v + arc.dv};
}

/// The same numbers on every machine.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double from, double to) {
    return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

/// Turns a plane orbit (positions and velocities in x, y) in space.
struct Turn {
  Vec3<Quad> p, q;
  explicit Turn(Random& random) {
    const Quad node(random(0, 6)), inclination(random(0, 3)), pericenter(random(0, 6));
    const Quad cn = cos(node), sn = sin(node), ci = cos(inclination), si = sin(inclination);
    const Quad cp = cos(pericenter), sp = sin(pericenter);
    p = Vec3<Quad>(cn * cp - sn * sp * ci, sn * cp + cn * sp * ci, sp * si);
    q = Vec3<Quad>(-cn * sp - sn * cp * ci, -sn * sp + cn * cp * ci, cp * si);
  }
  Quads operator()(Quad x, Quad y, Quad vx, Quad vy) const { return {x * p + y * q, vx * p + vy * q}; }
};

/// Ellipse with semi-major axis a at eccentric anomaly E; e = 1 is the straight line, a cycloid in time.
inline Quads on_ellipse(const Turn& turn, Quad mu, Quad a, Quad e, Quad anomaly) {
  const Quad b = sqrt((Quad(1) - e) * (Quad(1) + e)), c = cos(anomaly), s = sin(anomaly), half = sin(anomaly / Quad(2));
  const Quad fall = Quad(2) * half * half;  // 1 - cos E, without cancellation near the center
  const Quad speed = sqrt(mu / a) / ((Quad(1) - e) + e * fall);
  return turn(a * ((Quad(1) - e) - fall), a * b * s, -speed * s, speed * b * c);
}
inline Quad ellipse_time(Quad mu, Quad a, Quad e, Quad anomaly) {
  return sqrt(a * a * a / mu) * (anomaly - e * sin(anomaly));
}

/// Hyperbola with |a| and hyperbolic anomaly H.
inline Quads on_hyperbola(const Turn& turn, Quad mu, Quad a, Quad e, Quad anomaly) {
  const Quad b = sqrt((e - Quad(1)) * (e + Quad(1))), c = cosh(anomaly), s = sinh(anomaly),
             half = sinh(anomaly / Quad(2));
  const Quad rise = Quad(2) * half * half;  // cosh H - 1
  const Quad speed = sqrt(mu / a) / ((e - Quad(1)) + e * rise);
  return turn(a * ((e - Quad(1)) - rise), a * b * s, -speed * s, speed * b * c);
}
inline Quad hyperbola_time(Quad mu, Quad a, Quad e, Quad anomaly) {
  return sqrt(a * a * a / mu) * (e * sinh(anomaly) - anomaly);
}

/// Parabola with pericenter q at t = tangent of half the true anomaly (Barker).
inline Quads on_parabola(const Turn& turn, Quad mu, Quad q, Quad t) {
  const Quad speed = sqrt(Quad(2) * mu / q) / (Quad(1) + t * t);
  return turn(q * (Quad(1) - t * t), Quad(2) * q * t, -speed * t, speed);
}
inline Quad parabola_time(Quad mu, Quad q, Quad t) {
  return sqrt(Quad(2) * q * q * q / mu) * (t + t * t * t / Quad(3));
}

/// How far relative changes of the inputs by one unit move the end, in units: x by r, v by v, mu and h by themselves.
struct Condition {
  double x = 0, v = 0;
};
inline Condition condition(const Quads& s, Quad mu, Quad h) {
  const Quad step(0x1p-50);
  const KeplerArc<Quad> middle = kepler_arc(s.x, s.v, mu, h);
  const Vec3<Quad> zero = Vec3<Quad>::Zero();
  Condition sum;
  const auto add = [&](const Vec3<Quad>& dx, const Vec3<Quad>& dv, Quad by_mu, Quad by_h) {
    const KeplerArc<Quad> arc = kepler_arc<Quad>(s.x + step * dx, s.v + step * dv, mu + step * by_mu, h + step * by_h);
    sum.x += static_cast<double>(length<Quad>(arc.dx - middle.dx + step * dx) / step);
    sum.v += static_cast<double>(length<Quad>(arc.dv - middle.dv + step * dv) / step);
  };
  const Vec3<Quad> normal = cross(s.x, s.v);
  const Vec3<Quad> across_x = length(normal) > Quad(0) ? Vec3<Quad>(cross(normal, s.x) / length(normal)) : zero;
  const Vec3<Quad> across_v = length(normal) > Quad(0) ? Vec3<Quad>(cross(normal, s.v) / length(normal)) : zero;
  add(s.x, zero, Quad(0), Quad(0));
  add(across_x, zero, Quad(0), Quad(0));
  add(zero, s.v, Quad(0), Quad(0));
  add(zero, across_v, Quad(0), Quad(0));
  add(zero, zero, mu, Quad(0));
  add(zero, zero, Quad(0), h);
  return sum;
}

/// |a - b| in roundings of the inputs.
inline double roundings(const Quads& a, const Quads& b, const Condition& c, double rounding) {
  const auto ratio = [&](Quad error, double scale) {
    return error == Quad(0) ? 0 : static_cast<double>(error) / (rounding * scale);
  };
  return std::max(ratio(length<Quad>(a.x - b.x), c.x), ratio(length<Quad>(a.v - b.v), c.v));
}

/// Error of the double arc against the Quad one, in roundings of the inputs.
inline double error_by_condition(const Doubles& s, double mu, double h, int* iterations = nullptr) {
  const KeplerArc<double> arc = kepler_arc(s.x, s.v, mu, h);
  const Quads w = widen(s);
  const KeplerArc<Quad> truth = kepler_arc(w.x, w.v, Quad(mu), Quad(h));
  REQUIRE(arc.status == KeplerStatus::converged);
  REQUIRE(truth.status == KeplerStatus::converged);
  if (iterations) *iterations = std::max(*iterations, arc.iterations);
  const Quads rough{arc.dx.cast<Quad>(), arc.dv.cast<Quad>()}, right{truth.dx, truth.dv};
  return roundings(rough, right, condition(w, Quad(mu), Quad(h)), unit);
}

/// e from 0 to 1000 by way of nearly parabolic, anywhere on the orbit, h of either sign from 1e-6 to 1000 periods.
struct Case {
  Doubles state;
  double mu, h, e;
};
inline Case random_case(Random& random) {
  Case c;
  const int kind = static_cast<int>(random(0, 6));
  const double closeness = std::pow(10.0, random(-15, 0));
  c.e = kind == 0   ? random(0, 1)
        : kind == 1 ? 1 - closeness
        : kind == 2 ? 1 + closeness
        : kind == 3 ? std::pow(10.0, random(0, 3))
                    : random(0, 0.5);
  const Quad a(std::pow(10.0, random(-2, 2))), mu(std::pow(10.0, random(-2, 2))), e(c.e);
  const Turn turn(random);
  const Quads s =
      c.e < 1 ? on_ellipse(turn, mu, a, e, Quad(random(0, 6.3))) : on_hyperbola(turn, mu, a, e, Quad(random(-6, 6)));
  c.state = narrow(s);
  c.mu = static_cast<double>(mu);
  c.h = static_cast<double>(two_pi * sqrt(a * a * a / mu)) * std::pow(10.0, random(-6, 3)) *
        (random(0, 1) < 0.5 ? -1 : 1);
  return c;
}

}  // namespace noether::kepler_test
