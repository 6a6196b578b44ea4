/// Oblateness about the axis of a rigid body: its energy, forces and torque, and what is refused beside bodies.

#include "forces/check_gradient.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {
namespace {

using std::sqrt;

constexpr AxisFrame of_body = AxisFrame::body;

/// What a force does at a moment.
template <class Real> struct Pulls {
  VectorColumn<Real> a, torque;
  Real energy;
};
template <class Real, class F> Pulls<Real> pulls(const F& force, const ParticleSystem<Real>& s) {
  Pulls<Real> e{VectorColumn<Real>(s.size()), VectorColumn<Real>(s.size()), Real(0)};
  ForceSink<Real> sink(e.a, s, {.energy = true});
  sink.set_torques(e.torque);
  force.add_to(sink, s);
  e.energy = sink.potential();
  return e;
}

/// A planet of two equal moments (C - A = 0.1) and mass 2, a rock, a moon and a tracer.
ParticleSystem<double> planet_and_moons() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("planet", 2, {0.4, 0.4, 0.5}),
           {.x = {0.1, -0.2, 0.3}, .orientation = {1, 0.2, -0.3, 0.1}, .angular_velocity = Vec3<double>(0.1, 0.2, 3)});
  s.add("moon", 0.5, {3, -0.4, 0.8}, {0, 0.7, 0});
  add_body(s, body_of_inertia("rock", 0.25, {0.02, 0.03, 0.04}), {.x = {-1, 4, 2}, .orientation = {0.5, 0.1, 0.7, 0}});
  s.add("tracer", 0, {0.4, 0.6, -2}, {0, 0, 0});
  return s;
}

double apart(const Vec3<Quad>& a, const Vec3<Quad>& b) {
  return std::sqrt(static_cast<double>(norm2(Vec3<Quad>(a - b))));
}

}  // namespace

TEST_CASE("the torque of a body's own oblateness is the slope of its energy as the body turns", "[forces][bodies]") {
  const ParticleSystem<double> s = planet_and_moons();
  const Oblateness both{.J2 = 0.05, .J4 = -0.02, .radius = 0.9, .axis = {0.3, -0.2, 2}, .frame = of_body};
  CHECK(gradient_error(both, s) < 1e-20);
  CHECK(gradient_error(Oblateness{.J2 = 0.05, .radius = 0.9, .frame = of_body}, s) < 1e-20);
  CHECK(gradient_error(Oblateness{.J4 = 0.05, .radius = 0.9, .frame = of_body}, s) < 1e-20);
  CHECK_NOTHROW(check_gradient(both, s));
}

TEST_CASE("J2 about a body's axis is gravity of second degree of its moments, J2 = (C - A)/(m R^2)",
          "[forces][bodies]") {
  ParticleSystem<Quad> s = planet_and_moons().as<Quad>();
  s.column<BodyInertia>().set(2, Vec3<Quad>::Zero());  // the rock's own figure is no part of J2
  // Of unit length to the last bit of Quad: either force takes what it lacks in another way.
  auto& q = s.column<BodyOrientation>();
  for (int k = 0; k < 2; ++k) q.set(0, renormalized<Quad>(std::as_const(q)[0]));
  const Vec3<Quad> moments = std::as_const(s).column<BodyInertia>()[0];
  const double radius = 0.5;
  const Quad wanted = (moments[2] - moments[0]) / (std::as_const(s).masses()[0] * Quad(radius) * Quad(radius));
  const auto unit = pulls(Oblateness{.J2 = 1, .radius = radius, .frame = of_body}, s);
  const auto figure = pulls(GravityOfBodies{.point_masses = false}, s);
  CHECK(std::abs(static_cast<double>(wanted * unit.energy / figure.energy - Quad(1))) < 1e-31);
  for (Index i = 0; i < s.size(); ++i) {
    CHECK(apart(wanted * Vec3<Quad>(unit.a[i]), figure.a[i]) < 1e-33);
    CHECK(apart(wanted * Vec3<Quad>(unit.torque[i]), figure.torque[i]) < 1e-33);
  }
  CHECK(std::sqrt(static_cast<double>(norm2(Vec3<Quad>(figure.torque[0])))) > 1e-4);
}

TEST_CASE("J4 about a body's axis has the energy and torque of its Legendre polynomial", "[forces][bodies]") {
  // The axis is turned by t about y; a moon on the x axis, c = sin t: U = m (G m_0/r) J4 (R/r)^4 P4(c) and its slope.
  const Quad r(1.75), R(0.5), m(0.5), m0(2), J4(-0.125);
  const Quad size = m * m0 / r * J4 * R * R * R * R / (r * r * r * r);
  for (const double tan : {0., 0.25, -0.5, 1., 3.}) {  // of t/2
    ParticleSystem<Quad> s(unit_system("reduced"));
    {
      ParticleSystem<double> start(unit_system("reduced"));
      add_body(start, body_of_inertia("planet", 2, {0.4, 0.4, 0.5}));
      start.add("moon", 0.5, {1.75, 0, 0}, {0, 0, 0});
      s = start.as<Quad>();
    }
    const Quad t(tan), w = Quad(1) / sqrt(Quad(1) + t * t);
    s.column<BodyOrientation>().set(0, Quaternion<Quad>(w, Quad(0), w * t, Quad(0)));
    const Quad c = Quad(2) * t / (Quad(1) + t * t), along = (Quad(1) - t * t) / (Quad(1) + t * t);  // sin t, cos t
    const auto found = pulls(Oblateness{.J4 = -0.125, .radius = 0.5, .frame = of_body}, s);
    const Quad c2 = c * c, p4 = (Quad(35) * c2 * c2 - Quad(30) * c2 + Quad(3)) / Quad(8),
               slope = (Quad(140) * c2 - Quad(60)) * c / Quad(8) * along;  // of P4 by t
    CAPTURE(tan);
    CHECK(std::abs(static_cast<double>(found.energy - size * p4)) < 1e-33);
    CHECK(apart(found.torque[0], Vec3<Quad>(Quad(0), -size * slope, Quad(0))) < 1e-33);
    CHECK(apart(found.torque[1], Vec3<Quad>::Zero()) == 0);
  }
}

TEST_CASE("forces about a body's axis are opposite to the bit, and its torque is that of their couple",
          "[forces][bodies]") {
  ParticleSystem<double> s = planet_and_moons();
  const Oblateness flat{.J2 = 0.05, .J4 = -0.02, .radius = 0.9, .axis = {0.3, -0.2, 2}, .frame = of_body};
  const auto all = pulls(flat, s);
  Vec3<double> couple = all.torque[0], moment = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> d = s.positions()[i] - s.positions()[0], f = s.masses()[i] * Vec3<double>(all.a[i]);
    couple += cross<double>(d, f);
    moment += cross<double>(d, f).cwiseAbs();
    CHECK((i == 0 || all.torque[i] == Vec3<double>::Zero()));
  }
  CHECK(couple.norm() < 1e-15 * moment.norm());
  CHECK(Vec3<double>(all.a[3]).norm() > 1e-4);  // the tracer feels it
  // Of one moon alone, whose mass is a power of two as that of the planet: no rounding but that of the forces.
  s = ParticleSystem<double>(unit_system("reduced"));
  add_body(s, body_of_inertia("planet", 2, {0.4, 0.4, 0.5}), {.orientation = {1, 0.2, -0.3, 0.1}});
  s.add("moon", 0.5, {3, -0.4, 0.8}, {0, 0, 0});
  const auto one = pulls(flat, s);
  CHECK(2 * Vec3<double>(one.a[0]) == -0.5 * Vec3<double>(one.a[1]));
}

TEST_CASE("an axis of a body that is turned as the axis in space gives the same field", "[forces][bodies]") {
  const ParticleSystem<double> s = planet_and_moons();
  const Vec3<double> n = to_space<double>(matrix_of(s), Vec3<double>(0, 0, 1));
  ParticleSystem<double> points(unit_system("reduced"));
  for (Index i = 0; i < s.size(); ++i) points.add(s.name(i), s.masses()[i], s.positions()[i], Vec3<double>::Zero());
  const auto turning = pulls(Oblateness{.J2 = 0.05, .J4 = -0.02, .radius = 0.9, .frame = of_body}, s);
  const auto fixed = pulls(Oblateness{.J2 = 0.05, .J4 = -0.02, .radius = 0.9, .axis = {n[0], n[1], n[2]}}, points);
  CHECK(std::abs(turning.energy / fixed.energy - 1) < 1e-14);
  for (Index i = 0; i < s.size(); ++i)
    CHECK(Vec3<double>(turning.a[i] - fixed.a[i]).norm() < 1e-15 * Vec3<double>(fixed.a[i]).norm());
  CHECK(Vec3<double>(fixed.torque[0]) == Vec3<double>::Zero());
}

TEST_CASE("what the axis of an oblate body claims follows from its frame", "[forces][bodies]") {
  const Oblateness fixed{.J2 = 0.1, .radius = 1}, turning{.J2 = 0.1, .radius = 1, .frame = of_body};
  CHECK_FALSE(fixed.claims().keeps_angular_momentum);
  CHECK_FALSE(fixed.claims().on_bodies);
  CHECK(turning.claims().keeps_angular_momentum);
  CHECK(turning.claims().keeps_momentum);
  CHECK(turning.claims().on_bodies);
  CHECK(has_secant<double>(fixed));
  CHECK_FALSE(has_secant<double>(turning));
  // What is saved of an axis in space is what it was before there were others.
  CHECK(detail::signature_of(fixed) == "oblateness(J2 = 0.1, J4 = 0, radius = 1, axis = [0, 0, 1], G = default)");
  CHECK(detail::signature_of(turning) ==
        "oblateness(J2 = 0.1, J4 = 0, radius = 1, axis = [0, 0, 1], frame = 1, G = default)");
}

TEST_CASE("an axis that gives a body no torque, and one of what is no body, are refused", "[forces][bodies]") {
  const Oblateness fixed{.J2 = 0.1, .radius = 1}, turning{.J2 = 0.1, .radius = 1, .frame = of_body};
  const std::string no_torque =
      "oblateness has an axis that is fixed in space, which gives 'planet' no torque, but that is a rigid body, which "
      "turns; give frame = \"body\", or a plain body";
  const auto refusal = [](const auto& force, const ParticleSystem<double>& s) {
    return refusal_of([&] { check_force(force, s); });
  };
  const ParticleSystem<double> s = planet_and_moons();
  CHECK(refusal(turning, s) == "");
  CHECK(refusal(fixed, s) == no_torque);
  CHECK(refusal(OnSites<double>(ForceField<double>().add(UniformField{}).add(fixed)), s) == no_torque);
  // Beside a plain planet a rock is a point to it.
  ParticleSystem<double> point(unit_system("reduced"));
  point.add("planet", 2, {0, 0, 0}, {0, 0, 0});
  add_body(point, body_of_inertia("rock", 0.25, {0.02, 0.03, 0.04}), {.x = {-1, 4, 2}});
  CHECK(refusal(fixed, point) == "");
  CHECK(refusal(OnSites<double>(ForceField<double>().add(fixed)), point) == "");
  const std::string wants = "; make it a rigid body of three moments of inertia, or take frame out";
  CHECK(refusal(turning, point) == "frame = \"body\" turns the axis with 'planet', which is a point" + wants);
  ParticleSystem<double> plain(unit_system("reduced"));
  plain.add("planet", 2, {0, 0, 0}, {0, 0, 0});
  CHECK(refusal(turning, plain) == "frame = \"body\" turns the axis with 'planet', which is a point" + wants);
  ParticleSystem<double> needle(unit_system("reduced"));
  add_body(needle, body_of_inertia("needle", 2, {0.4, 0.4, 0}));
  CHECK(refusal(turning, needle) == "frame = \"body\" turns the axis with 'needle', which is a line" + wants);
  CHECK(refusal(turning, heavy_top()) ==
        "oblateness about the axis of a body moves bodies, but a fixed point holds one of them; take one of the two "
        "out");
}

}  // namespace noether::test
