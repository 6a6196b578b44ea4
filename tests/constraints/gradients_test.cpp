/// Every kind of constraint: gradients, curvatures, what it takes from the start; user's ones by dual numbers.

#include "constraints/angle.hpp"
#include "constraints/rigid_bar.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"

#include <random>

namespace noether {
namespace {

using namespace noether::test;

/// A bead on the parabola z = a x^2 in the plane y = 0, as a user writes it.
struct OnParabola {
  double a = 1;
  static constexpr std::size_t particles = 1;
  template <class Real> std::array<Real, 2> value(const Points<Real, 1>& x) const {
    return {x[0][2] - Real(a) * x[0][0] * x[0][0], x[0][1]};
  }
};

/// The same distance without a gradient of its own.
struct PlainDistance {
  Distance distance;
  static constexpr std::size_t particles = 2;
  template <class Real> Real value(const Points<Real, 2>& x) const { return distance.value(x); }
};

/// Kinds that take only a part from the start: a particle may stand beside them.
template <class C>
constexpr bool constraint_is_general =
    std::is_same_v<C, OnParabola> || std::is_same_v<C, OnCircle> || std::is_same_v<C, OnBar>;

template <class C> void check_derivatives(const C& given) {
  constexpr std::size_t n = C::particles;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int sample = 0; sample < 5; ++sample) {
    Points<Quad, n> x, v;
    Points<double, n> plain;
    for (std::size_t i = 0; i < n; ++i) {
      for (Index k = 0; k < 3; ++k) {
        plain[i][k] = uniform(random);
        x[i][k] = plain[i][k];
        v[i][k] = uniform(random);
      }
    }
    C constraint = given;
    if constexpr (requires { given.at_start(plain); }) constraint = given.at_start(plain);
    const auto at_start = detail::values_of<C, double>(constraint, plain);
    for (const double g : at_start) CHECK((constraint_is_general<C> || std::fabs(g) < 4e-16));
    const Quad d(1e-8);
    const auto moved = [&](std::size_t i, Index k, const Quad& by) {
      Points<Quad, n> y = x;
      y[i][k] += by;
      return detail::values_of<C, Quad>(constraint, y);
    };
    const auto gradients = detail::gradients_of<C, Quad>(constraint, x);
    for (std::size_t e = 0; e < gradients.size(); ++e) {
      for (std::size_t i = 0; i < n; ++i) {
        for (Index k = 0; k < 3; ++k) {
          const Quad slope = (moved(i, k, d)[e] - moved(i, k, -d)[e]) / (Quad(2) * d);
          CHECK(std::fabs(static_cast<double>(slope - gradients[e][i][k])) < 1e-13);
        }
      }
    }
    const auto along = [&](const Quad& t) {
      Points<Quad, n> y = x;
      for (std::size_t i = 0; i < n; ++i) y[i] += t * v[i];
      return detail::values_of<C, Quad>(constraint, y);
    };
    const auto curvatures = detail::curvatures_of<C, Quad>(constraint, x, v);
    const auto here = along(Quad(0)), ahead = along(d), behind = along(-d);
    for (std::size_t e = 0; e < curvatures.size(); ++e) {
      const Quad second = (ahead[e] - Quad(2) * here[e] + behind[e]) / (d * d);
      CHECK(std::fabs(static_cast<double>(second - curvatures[e])) < 1e-12);
    }
  }
}

TEST_CASE("gradients and curvatures of every constraint are those of its value, and the start keeps it",
          "[constraints]") {
  check_derivatives(Distance{});
  check_derivatives(Angle{});
  check_derivatives(Fixed{});
  check_derivatives(OnSphere{{0.3, 0.2, -0.1}});
  check_derivatives(OnPlane{.normal = {1, 2, -2}});
  check_derivatives(OnCylinder{{0.1, 0.2, 0.3}, {1, 1, 0.5}});
  check_derivatives(OnLine{.direction = {0.2, -1, 0.4}});
  check_derivatives(OnCircle{{0, 0, 0}, {0, 0, 1}});
  check_derivatives(OnBar{});
  check_derivatives(OnParabola{0.7});
}

TEST_CASE("a gradient by dual numbers is the one written by hand", "[constraints]") {
  const Points<double, 2> x = {Vec3<double>(0.1, -0.7, 0.4), Vec3<double>(1.3, 0.2, -0.5)};
  const Distance distance = Distance{}.at_start(x);
  const auto by_hand = detail::gradients_of<Distance, double>(distance, x);
  const auto by_dual = detail::gradients_of<PlainDistance, double>(PlainDistance{distance}, x);
  for (std::size_t i = 0; i < 2; ++i) CHECK(by_hand[0][i] == by_dual[0][i]);
}

TEST_CASE("particles stay on every surface and curve, and the work of the constraints is nothing", "[constraints]") {
  const auto check = [](auto constraint) {
    Mechanism m;
    m.particles.add("bead", 1.3, {0.6, -0.4, 0.5}, {0.3, 0.8, -0.2});
    m.constraints.add(m.particles, constraint, {0});
    Simulation<double> sim(m.particles, compose(hamiltonian_of(m, HarmonicField{2.0}), schemes::kahan_li_6_s9), 0.02);
    const auto energy = [&] {
      const ParticleSystem<double>& s = sim.particles();
      return (1.3 * norm2(Vec3<double>(s.velocities()[0])) + 2.0 * norm2(Vec3<double>(s.positions()[0]))) / 2;
    };
    const double before = energy();
    REQUIRE(sim.run(500).ok());
    CHECK(m.constraints.worst(sim.particles()).residual < 8 * 0x1p-53);
    CHECK(std::fabs(energy() - before) < 1e-7 * before);
    CHECK(distance_of_states(sim.particles(), m.particles) > 1e-3);
  };
  check(OnSphere{{0.1, 0, 0}});
  check(OnPlane{.normal = {1, 2, -2}});
  check(OnCylinder{.axis = {1, 1, 0.5}});
  check(OnLine{.direction = {0.2, -1, 0.4}});
  Mechanism wire;
  wire.particles.add("bead", 1, {0.5, 0, 0.25}, {0.4, 0, 0.4});
  wire.constraints.add(wire.particles, OnParabola{}, {0});
  const auto end = run(wire, schemes::kahan_li_6_s9, 0.01, 500);
  CHECK(wire.constraints.worst(end).residual < 4 * 0x1p-53);
  // Speed by height: v^2 / 2 + g z is what it was.
  const double before = 0.16 + g_earth * 0.25;
  const double after = norm2(Vec3<double>(end.velocities()[0])) / 2 + g_earth * end.positions()[0][2];
  CHECK(std::fabs(after - before) < 1e-9);
}

}  // namespace
}  // namespace noether
