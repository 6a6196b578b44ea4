#include "forces/check_gradient.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/oblateness.hpp"
#include "forces/sum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <utility>

namespace noether {
namespace {

using namespace noether::test;

template <class Real, class F>
VectorColumn<Real> accelerations(const F& force, const ParticleSystem<Real>& s, Request wanted = {}) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, wanted);
  force.add_to(sink, s);
  return a;
}

template <class Real, class F> Real potential(const F& force, const ParticleSystem<Real>& s) {
  VectorColumn<Real> a(s.size());
  ForceSink<Real> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}

template <class F> Mat3<Quad> virial(const F& force, const ParticleSystem<Quad>& s) {
  VectorColumn<Quad> a(s.size());
  ForceSink<Quad> sink(a, s, {.virial = true});
  force.add_to(sink, s);
  return sink.virial();
}

double apart(const Quad& a, const Quad& b) { return std::fabs(static_cast<double>((a - b) / b)); }

const Oblateness tilted{.J2 = 0.016, .J4 = -0.0009, .radius = 0.4, .axis = {0.3, -0.5, 2.0}, .G = 1.0};

TEST_CASE("the fields are minus the gradients of their energies", "[fields]") {
  auto s = four_bodies();
  s.clock() = Clock<double>::fixed(0.3, 0.1, 4);
  CHECK(gradient_error(UniformField{{0.1, -0.4, 2}}, s) < 1e-20);
  CHECK(gradient_error(HenonHeiles{.omega = 0.7, .length = 3}, s) < 1e-20);
  CHECK(gradient_error(OscillatingField{{0.1, -0.4, 2}, 1.5, 0.2}, s) < 1e-20);
  CHECK(gradient_error(HarmonicField{2.5}, s) < 1e-20);
  CHECK(gradient_error(tilted, s) < 1e-20);
  CHECK(gradient_error(Oblateness{.J2 = 0.02, .radius = 1, .G = 1.0}, s) < 1e-20);
  CHECK(gradient_error(Oblateness{.J4 = 0.02, .radius = 1, .G = 1.0}, s) < 1e-20);
}

/// A spring without its minus.
struct Repulsive {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    HarmonicField{2.5}.add_to(out, s);
    for (Index i = 0; i < s.size(); ++i) out.force(i, Real(5) * s.positions()[i]);
  }
};

TEST_CASE("a force that is no gradient, or no number, is found out", "[fields]") {
  CHECK_THROWS_AS(check_gradient(Repulsive{}, four_bodies()), Error);
  CHECK_NOTHROW(check_gradient(HarmonicField{2.5}, four_bodies()));
  CHECK_THROWS_AS(check_gradient(HarmonicField{NAN}, four_bodies()), Error);
}

/// A primary and one body of mass 1 at distance r along a direction.
ParticleSystem<Quad> at(const Quad& r, const Vec3<Quad>& direction) {
  ParticleSystem<Quad> s;
  s.add("primary", 3, Vec3<Quad>(1, 2, 3), Vec3<Quad>::Zero());
  s.add("satellite", 1, Vec3<Quad>(1, 2, 3) + r / sqrt(norm2(direction)) * direction, Vec3<Quad>::Zero());
  return s;
}

TEST_CASE("the oblate field on the axis and on the equator is that of the closed form", "[fields]") {
  const Vec3<Quad> axis(0.3, -0.5, 2.0), across(Vec3<Quad>(0.5, 0.3, 0.0));
  const Quad r(1.75), R(0.4), mu(3), J2(0.016), J4(-0.0009);
  const Quad k2 = J2 * R * R / (r * r), k4 = J4 * R * R * R * R / (r * r * r * r);
  // P2(1) = P4(1) = 1, P2(0) = -1/2, P4(0) = 3/8; the force along r is the derivative of r^-3 and r^-5.
  CHECK(apart(potential(tilted, at(r, axis)), mu / r * (k2 + k4)) < 1e-30);
  CHECK(apart(potential(tilted, at(r, across)), mu / r * (-k2 / 2 + 3 * k4 / 8)) < 1e-30);
  const auto pole = accelerations(tilted, at(r, axis)), equator = accelerations(tilted, at(r, across));
  const Quad pole_pull = mu / (r * r) * (3 * k2 + 5 * k4), equator_pull = mu / (r * r) * (-3 * k2 / 2 + 15 * k4 / 8);
  CHECK(apart(dot(std::as_const(pole)[1], axis) / sqrt(norm2(axis)), pole_pull) < 1e-30);
  CHECK(apart(dot(std::as_const(equator)[1], across) / sqrt(norm2(across)), equator_pull) < 1e-30);
  CHECK(norm2(cross(std::as_const(pole)[1], axis)) < Quad(1e-60));
  CHECK(norm2(cross(std::as_const(equator)[1], across)) < Quad(1e-60));
}

TEST_CASE("an oblate primary feels the reaction: momentum is kept, and the axis may have any length", "[fields]") {
  const auto s = four_bodies().as<Quad>();
  const auto a = accelerations(tilted, s);
  Vec3<Quad> force = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) force += s.masses()[i] * a[i];
  CHECK(std::sqrt(static_cast<double>(norm2(force))) < 1e-34);
  Oblateness longer = tilted;
  for (double& c : longer.axis) c *= 8;
  CHECK((accelerations(longer, s).all() == a.all()));
}

TEST_CASE("a tracer feels the oblate field and gives nothing back", "[fields]") {
  ParticleSystem<double> s;
  s.add("primary", 3, {0, 0, 0}, {0, 0, 0});
  s.add("tracer", 0, {1, 1, 1}, {0, 0, 0});
  const auto a = accelerations(tilted, s);
  CHECK((a[0] == Vec3<double>::Zero()));
  CHECK(a[1].norm() > 0);
  CHECK(potential(tilted, s) == 0);
}

TEST_CASE("virials are sums of x and f for every force", "[fields]") {
  const auto s = four_bodies().as<Quad>();
  const UniformField uniform{{0.1, -0.4, 2}};
  const HarmonicField spring{2.5};
  const auto check = [&](const auto& force) {
    Mat3<Quad> sum = Mat3<Quad>::Zero();
    const auto a = accelerations(force, s);
    for (Index i = 0; i < s.size(); ++i) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) sum(r, c) += s.positions()[i][r] * s.masses()[i] * a[i][c];
      }
    }
    const Mat3<Quad> got = virial(force, s);
    for (int k = 0; k < 9; ++k) CHECK(std::fabs(static_cast<double>(got(k / 3, k % 3) - sum(k / 3, k % 3))) < 1e-31);
  };
  check(uniform);
  check(spring);
  check(tilted);
  check(Gravity{.G = 1.0});
  check(Sum(Gravity{.G = 1.0}, spring, uniform, tilted));
  // Degree 2: the trace is -2 U.
  CHECK(apart(virial(spring, s).trace(), -2 * potential(spring, s)) < 1e-31);
}

TEST_CASE("an oscillating field follows the clock of the stage", "[fields]") {
  auto s = particle_in_plane(1, 0, 0, 0).as<Quad>();
  const OscillatingField field{{2, 0, 0}, 3, 0.5};
  s.clock() = Clock<Quad>::fixed(1, 0.25, 2);
  s.clock().set_fraction(Quad(1) / Quad(3));
  const Quad t = Quad(1) + (Quad(2) + Quad(1) / Quad(3)) * Quad(0.25);
  CHECK(accelerations(field, s)[0][0] == cos(Quad(3) * t + Quad(0.5)) * Quad(2));
  CHECK(OscillatingField::claims().time_dependent);
}

TEST_CASE("a harmonic field leaves tracers alone", "[fields]") {
  ParticleSystem<double> s;
  s.add("tracer", 0, {1, 2, 3}, {0, 0, 0});
  s.add("body", 2, {1, 2, 3}, {0, 0, 0});
  const auto a = accelerations(HarmonicField{3}, s);
  CHECK((a[0] == Vec3<double>::Zero()));
  CHECK((a[1] == Vec3<double>(-1.5, -3, -4.5)));
  CHECK(potential(HarmonicField{3}, s) == 21);
}

TEST_CASE("forces added at compile time and at run time give the same bits", "[fields][determinism]") {
  const auto s = four_bodies();
  const UniformField uniform{{0.1, -0.4, 2}};
  const Sum fixed(Gravity{.G = 1.0}, tilted, uniform, HarmonicField{2.5});
  ForceField<double> free;
  free.add(Gravity{.G = 1.0}).add(tilted).add(uniform).add(HarmonicField{2.5});
  CHECK((accelerations(fixed, s).all() == accelerations(free, s).all()));
  CHECK(potential(fixed, s) == potential(free, s));
  CHECK((accelerations(fixed, s).all() == accelerations(fixed, s, {.energy = true, .virial = true}).all()));
  CHECK(free.terms().size() == 4);
}

TEST_CASE("a sum claims what all its terms can and any of them is", "[fields]") {
  CHECK_FALSE(Sum(Gravity{}, HarmonicField{}).claims().time_dependent);
  CHECK(Sum(Gravity{}, OscillatingField{}).claims().time_dependent);
  CHECK(ForceField<double>{}.add(OscillatingField{}).add(Gravity{}).claims().time_dependent);
  CHECK(Sum(Gravity{}, HarmonicField{}).claims().energy);
}

TEST_CASE("forces in double are those in Quad, rounded", "[fields]") {
  const auto s = four_bodies();
  const UniformField uniform{{0.1, -0.4, 2}};
  const Sum all(Gravity{.G = 1.0}, tilted, uniform, HarmonicField{2.5});
  const auto a = accelerations(all, s);
  const auto exact = accelerations(all, s.as<Quad>());
  for (Index i = 0; i < s.size(); ++i) {
    const double scale = std::sqrt(static_cast<double>(norm2(exact[i])));
    for (int k = 0; k < 3; ++k) {
      CHECK(std::fabs(static_cast<double>(Quad(a[i][k]) - exact[i][k])) < 16 * 0x1p-53 * scale);
    }
  }
  CHECK(apart(Quad(potential(all, s)), potential(all, s.as<Quad>())) < 32 * 0x1p-53);
}

}  // namespace
}  // namespace noether
