// Minimization: to known minima, from overlaps too, with the same bits on any number of threads.

#include "integrators/minimize.hpp"
#include "forces/bonded.hpp"
#include "forces/external_fields.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/linear_drag.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

/// Every pair by 4 (r^-12 - r^-6), as a user would write it.
struct Argon {
  static ForceClaims claims() { return {.periodic = true}; }
  std::string name() const { return "argon"; }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 1; i < s.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
        const Real q = Real(1) / norm2(d), q3 = q * q * q;
        out.pair(i, j, Real(24) * q * q3 * (Real(2) * q3 - Real(1)) * d);
        out.energy(Real(4) * q3 * (q3 - Real(1)));
      }
    }
  }
};

double energy_of(const AnyForce<double>& force, const ParticleSystem<double>& s) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true});
  force.add_to(sink, s);
  return sink.potential();
}

ParticleSystem<double> placed(const std::vector<Vec3<double>>& x) {
  ParticleSystem<double> s;
  for (std::size_t i = 0; i < x.size(); ++i) {
    s.add("p" + std::to_string(i), 1 + 0.5 * static_cast<double>(i % 3), x[i], {0.25, 0, 0});
  }
  return s;
}

TEST_CASE("two atoms part from any overlap to the minimum of their potential", "[minimize]") {
  for (const double r : {3.0, 1.2, 1.0, 0.5, 1e-2, 1e-6, 1e-12, 1e-20}) {
    CAPTURE(r);
    auto s = placed({{0, 0, 0}, {r, 0, 0}});
    const Minimized done = minimize(s, Argon{}, {.max_force = 1e-10, .max_displacement = 0.1});
    CHECK(done.converged());
    CHECK(done.force <= 1e-10);
    const Vec3<double> d = s.positions()[1] - s.positions()[0];
    // U'' = 57.1 there.
    CHECK(std::abs(std::sqrt(norm2(d)) - std::pow(2.0, 1.0 / 6)) < 1e-10 / 57 + 1e-15);
    CHECK(s.velocities()[1] == Vec3<double>(0.25, 0, 0));
  }
}

TEST_CASE("two atoms in all but one place part by themselves, and no time step overflows on the way", "[minimize]") {
  for (const double r : {0.5, 1e-2, 1e-3, 1e-6}) {
    CAPTURE(r);
    auto s = placed({{0, 0, 0}, {r, 0, 0}});
    const LennardJonesForce force{.cutoff = 2.5, .epsilon = 1.0, .sigma = 1.0};
    const Minimized done = minimize(s, force, {.max_force = 1e-4});
    CHECK(done.converged());
    CHECK(done.steps < 2000);
    const Vec3<double> d = s.positions()[1] - s.positions()[0];
    CHECK(std::abs(std::sqrt(norm2(d)) - 1.12) < 0.01);  // the shifted force moves the minimum by 0.003
    // Of a force that tells no range each step is a part of the overlap: it comes to an end or says that it does not.
    auto slow = placed({{0, 0, 0}, {r, 0, 0}});
    const Minimized other = minimize(slow, Argon{}, {.max_force = 1e-4, .steps = 20'000});
    CHECK(slow.positions()[1].allFinite());
    CHECK((!other.converged() || std::abs(std::sqrt(norm2(Vec3<double>(slow.positions()[1] - slow.positions()[0]))) -
                                          std::pow(2.0, 1.0 / 6)) < 1e-4));
  }
}

TEST_CASE("thirteen atoms near the corners of an icosahedron come to the known energy", "[minimize]") {
  const double g = (1 + std::sqrt(5.0)) / 2, scale = 0.62;
  std::vector<Vec3<double>> x = {{0.02, -0.03, 0.01}};
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      x.emplace_back(scale * 0 + 0.03 * a, scale * a, scale * b);
      x.emplace_back(scale * a, scale * b + 0.04, 0);
      x.emplace_back(scale * b, 0, scale * a - 0.02 * b);
    }
  }
  auto s = placed(x);
  CHECK(minimize(s, Argon{}, {.max_force = 1e-9}).converged());
  CHECK(std::abs(energy_of(Argon{}, s) + 44.326801) < 1e-6);
}

/// 64 atoms on a lattice of a periodic box; every fifth one sits almost on its neighbor.
ParticleSystem<double> bad_start() {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({4.8, 4.8, 4.8}));
  for (int i = 0; i < 64; ++i) {
    Vec3<double> x(1.2 * (i % 4), 1.2 * (i / 4 % 4), 1.2 * (i / 16));
    if (i % 5 == 4) x[0] += -1.2 + 1e-4 * i;
    s.add("", 1, x, {0, 0, 0});
  }
  return s;
}

TEST_CASE("a box with overlaps of forces up to 1e30 relaxes, on any number of threads to the same bits", "[minimize]") {
  auto one = bad_start();
  VectorColumn<double> a(one.size());
  ForceSink<double> sink(a, one, {});
  Argon{}.add_to(sink, one);
  double largest = 0;
  for (Index i = 0; i < one.size(); ++i) largest = std::max(largest, norm2(std::as_const(a)[i]));
  CHECK(largest > 1e60);
  const Minimized done = minimize(one, Argon{}, {.max_force = 1e-3});
  CHECK(done.converged());
  CHECK(done.steps < 2000);
  CHECK(energy_of(Argon{}, one) < -200);
  for (const int threads : {1, 3}) {
    const test::Threads some(threads);
    auto other = bad_start();
    CHECK(minimize(other, Argon{}, {.max_force = 1e-3}).steps == done.steps);
    CHECK(test::same_bits(one, other));
  }
}

TEST_CASE("a crooked chain of stiff bonds and soft angles is stretched to zero energy", "[minimize]") {
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {1e3, 1}}};
  topology->angle_kinds = {{"harmonic", {1, 3.141592653589793}}};
  std::vector<Vec3<double>> x;
  for (Index i = 0; i < 12; ++i) {
    const auto k = static_cast<double>(i);
    x.emplace_back(0.8 * k, 0.3 * std::sin(3 * k), 0.4 * std::cos(2 * k));
    if (i > 0) topology->bonds.push_back({{i - 1, i}, 0});
    if (i > 1) topology->angles.push_back({{i - 2, i - 1, i}, 0});
  }
  auto s = placed(x);
  s.set_topology(topology);
  CHECK(minimize(s, Bonded{}, {.max_force = 1e-6, .steps = 5000}).converged());
  CHECK(energy_of(Bonded{}, s) < 1e-8);
  const Vec3<double> ends = s.positions()[11] - s.positions()[0];
  CHECK(std::abs(std::sqrt(norm2(ends)) - 11) < 1e-4);
}

TEST_CASE("a bond that would be overstretched on the way is not: the step is taken back", "[minimize]") {
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"fene", {30, 1.5, 1, 1}}};
  topology->bonds = {{{0, 1}, 0}, {{1, 2}, 0}};
  auto s = placed({{0, 0, 0}, {1e-3, 0, 0}, {1.4999, 0, 0}});
  s.set_topology(topology);
  CHECK(minimize(s, Bonded{}, {.max_force = 1e-8, .max_displacement = 1}).converged());
  for (const Index i : {1, 2}) {
    const Vec3<double> d = s.positions()[i] - s.positions()[i - 1];
    CHECK(std::abs(std::sqrt(norm2(d)) - 0.9609) < 1e-3);  // where the spring and the repulsion are balanced
  }
  auto broken = placed({{0, 0, 0}, {1.6, 0, 0}, {2.5, 0, 0}});
  broken.set_topology(topology);
  const Minimized done = minimize(broken, Bonded{}, {.max_force = 1e-8});
  REQUIRE(done.failure.has_value());
  CHECK(done.failure->kind == Outcome::Kind::overstretch);
}

TEST_CASE("a minimization that cannot come to its end says why", "[minimize]") {
  auto s = placed({{0, 0, 0}, {1.3, 0, 0}});
  const Minimized few = minimize(s, Argon{}, {.max_force = 1e-10, .steps = 3});
  REQUIRE_FALSE(few.converged());
  CHECK(few.steps == 3);
  CHECK(few.failure->kind == Outcome::Kind::solver_failure);
  CHECK(few.failure->message.find("after 3 steps of the minimization, above max_force = 1e-10; give more steps") !=
        std::string::npos);
  auto same = placed({{1, 1, 1}, {1, 1, 1}});
  CHECK(minimize(same, Argon{}, {.max_force = 1}).failure->message ==
        "the force on 'p0' is not finite; move it away from its neighbors");
  CHECK(minimize(s, HarmonicField{.k = 0}, {.max_force = 1}).steps == 1);
  CHECK_THROWS_AS(minimize(s, Argon{}, {.max_force = 0}), Error);
  CHECK_THROWS_AS(minimize(s, Argon{}, {.max_force = 1, .steps = 0}), Error);
  CHECK_THROWS_AS(minimize(s, DragForce{{.rate = 1}}, {.max_force = 1}), Error);
  CHECK_THROWS_AS(minimize(s, OscillatingField{}, {.max_force = 1}), Error);
}

TEST_CASE("tracers stay where they are, and forces may be assembled", "[minimize]") {
  auto s = placed({{1, 2, 3}, {-1, 0.5, 2}});
  s.add("dust", 0, {5, 5, 5}, {0, 0, 0});
  ForceField<double> forces;
  forces.add(HarmonicField{.k = 2}).add(HarmonicBond{.k = 1, .length = 0, .tied = {{0, 1}}});
  CHECK(minimize(s, forces, {.max_force = 1e-9}).converged());
  CHECK(norm2(s.positions()[0]) < 1e-18);
  CHECK(s.positions()[2] == Vec3<double>(5, 5, 5));
}

}  // namespace
}  // namespace noether
