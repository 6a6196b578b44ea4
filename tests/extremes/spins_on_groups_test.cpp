/// Methods on groups at the extremes: bodies at rest beside quick ones, lines, clustered moments, spins of any size.

#include "integrators/lie/body_motion.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <cmath>

namespace noether {
namespace {

/// A still body, a ball, one that is nearly a ball, a line, and one whose spin is 1e12 times less than theirs.
ParticleSystem<double> bodies_of_all_spins() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("still", 1, {1, 2, 2.5}), {});
  add_body(s, body_of_inertia("ball", 1, {1, 1, 1}), {.x = {10, 0, 0}, .angular_velocity = Vec3<double>(0, 0, 3)});
  add_body(s, body_of_inertia("nearly a ball", 1, {1, 1 + 1e-12, 1 + 2e-12}),
           {.x = {20, 0, 0}, .angular_velocity = Vec3<double>(0.3, -0.2, 2.9)});
  add_body(s, body_of_inertia("line", 1, {1, 1, 0}), {.x = {30, 0, 0}, .angular_velocity = Vec3<double>(0.5, -0.7, 0)});
  add_body(s, body_of_inertia("slow", 1, {1, 2, 2.5}),
           {.x = {40, 0, 0}, .angular_velocity = Vec3<double>(1e-12, 1e-13, 0)});
  s.add("point", 1, {50, 0, 0}, {0, 0, 0});
  return s;
}

}  // namespace

TEST_CASE("on their group bodies of all spins turn beside each other, and what rests stays", "[extremes][lie]") {
  for (const char* name : {"rkmk_dop853", "rkmk_dormand_prince_5"}) {
    for (const SpinAxes axes : {SpinAxes::body, SpinAxes::space}) {
      CAPTURE(name);
      const MethodOptions options{.rtol = 1e-10, .spin_axes = axes};
      const ParticleSystem<double> start = bodies_of_all_spins();
      Simulation sim(start, lie(ForceField<double>{}, method(name, options)));
      REQUIRE(sim.run_until(20).ok());
      CHECK(sim.step() < 4000);
      const ParticleSystem<double>& s = sim.particles();
      for (const Index i : {Index(0), Index(5)}) {
        CHECK(s.column<BodyOrientation>()[i] == start.column<BodyOrientation>()[i]);
        CHECK(s.column<BodySpin>()[i] == Vec3<double>(0, 0, 0));
      }
      // The ball turns evenly; whole turns and the rest are one quaternion but for its sign.
      CHECK(std::abs(std::abs(s.column<BodyOrientation>()[1][0]) - std::abs(std::cos(30.))) < 1e-7);
      for (Index i = 1; i < 5; ++i) {
        const Vec3<double> before = start.column<BodySpin>()[i], after = s.column<BodySpin>()[i];
        CHECK((after - before).norm() <= 1e-8 * before.norm());
      }
    }
  }
}

TEST_CASE("on their group spins of any size neither lose nor gain", "[extremes][lie]") {
  for (const double size : {1e-140, 1e-8, 1., 1e8, 1e140}) {
    CAPTURE(size);
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("body", 1, {1.3, 2.1, 0.9}), {.spin = size * Vec3<double>(1, 0.2, -0.5)});
    const MethodOptions options{.spin_axes = SpinAxes::space};
    Simulation sim(s, lie(ForceField<double>{}, method("rkmk_rk4", options)), 0.05 / size);
    REQUIRE(sim.run(200).ok());
    CHECK(sim.particles().column<BodySpin>()[0] == s.column<BodySpin>()[0]);
    CHECK(std::abs(norm_defect<double>(sim.particles().column<BodyOrientation>()[0])) < 1e-15);
    CHECK(std::abs(turning_energy_of(sim.particles()) / turning_energy_of(s) - 1) < 1e-4);
  }
}

}  // namespace noether
