/// Rigid bodies at the extremes: needles and discs in fields, spins of any size, partners 1e20 times lighter, bodies
/// that touch: right to the rounding of the angle, or a named outcome.

#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <cmath>
#include <vector>

namespace noether {
namespace {

using test::turning;

ForceField<double> pull(Figure degree = Figure::second_degree) {
  ForceField<double> forces;
  forces.add(GravityOfBodies{.degree = degree});
  return forces;
}

}  // namespace

TEST_CASE("a body that is 1e20 times lighter turns as in a given field", "[extremes][bodies]") {
  // Gravity-gradient libration about the radial axis, small angles in the plane of a circular orbit:
  // frequency n sqrt(3 (B - A)/C).
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("planet", 1, {1e-30, 1e-30, 1e-30}), {});
  const double m = 1e-20, scale = m * 1e-10, angle = 1e-3;
  add_body(s, body_of_inertia("moon", m, scale * Vec3<double>(0.9, 1, 1)),
           {.x = {1, 0, 0},
            .v = {0, 1, 0},
            .orientation = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
            .angular_velocity = Vec3<double>(0, 0, 1)});
  const double period = 2 * std::acos(-1.0) / std::sqrt(0.3);
  const int steps = 400;
  Simulation sim(s, compose(turning(pull()), *schemes::find("srkn14a")), period / steps);
  auto& energy = sim.every(1, Energy{});
  REQUIRE(sim.run(steps).ok());
  CHECK(energy.worst() < 1e-14);
  const Vec3<double> axis = test::matrix_of(sim.particles(), 1).col(0), at = sim.particles().positions()[1];
  const double off = std::atan2(at[0] * axis[1] - at[1] * axis[0], dot(at, axis));
  CHECK(std::abs(off - angle) < 1e-8);  // frequencies change by angle^2/16
}

TEST_CASE("bodies that touch end the run, and say who", "[extremes][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  std::vector<BodySite> sites(3);
  sites[0] = {.place = {1, 0, 0}, .mass = 1};
  sites[1] = {.place = {-1, 0, 0}, .mass = 1};
  sites[2] = {.place = {0, 1, 0}, .mass = 1};
  add_body(s, body_of_sites("a", sites), {});
  add_body(s, body_of_sites("b", sites), {.x = {2, 0, 0}});  // a site of each in one place
  Simulation sim(s, compose(turning(pull(Figure::sites)), schemes::verlet), 0.01);
  const Outcome outcome = sim.run(10);
  CHECK_FALSE(outcome.ok());
  CHECK_THAT(to_text(outcome), Catch::Contains("of a is not finite"));
}

TEST_CASE("a spin of any size neither loses nor gains", "[extremes][bodies]") {
  for (const double size : {1e-150, 1e-8, 1., 1e8, 1e140}) {
    CAPTURE(size);
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("body", 1, {1.3, 2.1, 0.9}), {.spin = size * Vec3<double>(1, 0.2, -0.5)});
    Simulation sim(s, compose(turning(ForceField<double>{}), schemes::verlet), 0.1 / size);
    REQUIRE(sim.run(1000).ok());
    const auto& now = sim.particles();
    const double before = turning_energy_of(s), after = turning_energy_of(now);
    CHECK(std::abs(after / before - 1) < 1e-14);
    CHECK(now.column<BodySpin>()[0] == s.column<BodySpin>()[0]);
  }
}

TEST_CASE("a needle and a disc in a field keep their energy", "[extremes][bodies]") {
  struct Shape {
    Vec3<double> inertia, weight;  // the needle's weight lies on its axis: beside it, it would spin up without bound
    double step;                   // where the error has the order of the scheme, and is above rounding
  };
  for (const auto& [inertia, weight, step] :
       {Shape{{1e-6, 1, 1.0000001}, {0.2, 0, 0}, 0.2}, Shape{{1, 1, 1.999999}, {0.2, 0, 0.1}, 0.1}}) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, top("top", 1, inertia, weight), {.angular_velocity = Vec3<double>(3, 0.3, 2)});
    const auto error = [&](double h) {
      Simulation sim(s, compose(turning(test::weight_on_sites()), *schemes::find("srkn6b")), h);
      auto& energy = sim.every(1, Energy{});
      REQUIRE(sim.run(std::lround(20 / h)).ok());
      return energy.worst();
    };
    CHECK(error(0.05) < 1e-9);
    CHECK(std::abs(std::log2(error(step) / error(step / 2)) - 4) < 0.4);
  }
}

}  // namespace noether
