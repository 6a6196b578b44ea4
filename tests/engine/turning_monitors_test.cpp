/// Monitors of rigid bodies against closed values: temperature, spin, obliquity, resonances, orientations, energies.

#include "engine/given_orbit.hpp"
#include "forces/external_fields.hpp"
#include "monitors/spin.hpp"
#include "monitors/temperature.hpp"
#include "monitors/turning.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::turning;

const double half_turn = std::acos(-1.0);

/// The rotation by an angle about an axis of space.
Quaternion<double> turn_about(int axis, double angle) {
  Quaternion<double> q(std::cos(angle / 2), 0, 0, 0);
  q[1 + axis] = std::sin(angle / 2);
  return q;
}
Quaternion<double> turns_in_order(const std::vector<Quaternion<double>>& turns) {
  Quaternion<double> all(1, 0, 0, 0);
  for (const Quaternion<double>& one : turns) all = quaternion_product<double>(all, one);
  return all;
}

RigidBody three_sites() {
  return body_of_sites(
      "triangle",
      {{.place = {0, 0, 0}, .mass = 3}, {.place = {1, 0.5, 0}, .mass = 1}, {.place = {-0.4, 0.7, 0.1}, .mass = 0.5}});
}
RigidBody two_in_line() {
  return body_of_sites("needle", {{.place = {0, 0, 0}, .mass = 2}, {.place = {0.3, 0.4, 1.2}, .mass = 1}}, true);
}

/// Two bodies, a line and a point, all of which fly, and those that can turn.
ParticleSystem<double> bodies_line_and_point() {
  ParticleSystem<double> s(unit_system("reduced"));
  const Quaternion<double> turned(0.5, 0.1, 0.7, -0.2);
  add_body(s, three_sites(), {.v = {0.3, -0.1, 0.2}, .orientation = turned, .spin = Vec3<double>(0.4, -0.2, 0.7)});
  add_body(s, three_sites(), {.x = {5, 0, 0}, .v = {0, 0.4, 0}, .spin = Vec3<double>(-0.1, 0.9, 0.3)});
  add_body(s, two_in_line(), {.x = {0, 5, 0}, .v = {0.1, 0.1, -0.5}, .spin = Vec3<double>(0.8, -0.6, 0)});
  s.add("point", 2, {0, 0, 5}, {-0.2, 0, 0.6});
  return s;
}

/// Twice the kinetic energy of all mass points that the bodies are made of, about a velocity that all have.
double twice_kinetic_of_points(const ParticleSystem<double>& s, const Vec3<double>& drift) {
  const Sites<double> sites(s);
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> rate =
        angular_velocity<double>(s.column<BodyOrientation>()[i], s.column<BodySpin>()[i], s.column<BodyInertia>()[i]);
    for (Index a = sites.first(i); a < sites.first(i + 1); ++a) {
      const Vec3<double> v = s.velocities()[i] + cross<double>(rate, sites.arm(a)) - drift;
      sum += sites.particles().masses()[a] * norm2(v);
    }
  }
  return sum;
}

/// What a monitor sees of particles before the first step.
template <class M> M first_look(const ParticleSystem<double>& s, M monitor, ForceField<double> forces = {}) {
  Simulation sim(s, compose(turning(std::move(forces)), schemes::verlet), 0.1);
  auto& attached = sim.every(1, std::move(monitor));
  REQUIRE(sim.run(0).ok());
  return attached;
}

ForceField<double> weight_of_all() { return test::weight_on_sites(1); }

}  // namespace

TEST_CASE("a temperature counts six freedoms of a body, five of a line, three of a point", "[monitors][turning]") {
  const ParticleSystem<double> s = bodies_line_and_point();
  // In a field from outside all 6 + 6 + 5 + 3 count, else the centre of mass takes three, and its motion is no heat.
  const Temperature in_field = first_look(s, Temperature{}, weight_of_all()), free = first_look(s, Temperature{});
  CHECK(in_field.degrees_of_freedom() == 20);
  CHECK(free.degrees_of_freedom() == 17);
  CHECK(std::abs(in_field.value() / (twice_kinetic_of_points(s, Vec3<double>::Zero()) / 20) - 1) < 1e-14);
  Vec3<double> drift = Vec3<double>::Zero();
  double mass = 0;
  for (Index i = 0; i < s.size(); ++i) {
    drift += s.masses()[i] * Vec3<double>(s.velocities()[i]);
    mass += s.masses()[i];
  }
  CHECK(std::abs(free.value() / (twice_kinetic_of_points(s, drift / mass) / 17) - 1) < 1e-14);
  CHECK(free.report().note == "of 17 degrees of freedom");
}

TEST_CASE("a top that a point holds has three freedoms, a tracer beside it none", "[monitors][turning]") {
  ParticleSystem<double> s = test::heavy_top();  // I = (2, 1, 2/3), spin (0.6, -0.4, 0.9), not turned yet
  s.add("tracer", 0, {4, 0, 0}, {1, 0, 0});
  for (const bool field : {false, true}) {
    const Temperature found = first_look(s, Temperature{}, field ? weight_of_all() : ForceField<double>{});
    CHECK(found.degrees_of_freedom() == 3);
    CHECK(std::abs(found.value() - (0.36 / 2 + 0.16 + 0.81 * 1.5) / 3) < 1e-15);
  }
}

TEST_CASE("the spin monitor tells spin, rate and energy as the principal axes have them", "[monitors][turning]") {
  // A quarter turn about z: the body's x is the y of space, its y the - x.
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("point", 1, {3, 0, 0}, {0, 0, 0});
  add_body(s, body_of_inertia("body", 1, {0.5, 1.25, 1.5}),
           {.orientation = turn_about(2, half_turn / 2), .spin = Vec3<double>(0.5, 0.25, 0.75)});
  const Spin spin = first_look(s, Spin{});  // the first that turns
  const auto near = [](const std::array<double, 3>& found, const Vec3<double>& wanted) {
    return std::abs(found[0] - wanted[0]) + std::abs(found[1] - wanted[1]) + std::abs(found[2] - wanted[2]) < 1e-15;
  };
  CHECK(near(spin.value(), {0.5, 0.25, 0.75}));
  CHECK(near(spin.in_body(), {0.25, -0.5, 0.75}));
  CHECK(near(spin.rate(), {0.5, -0.4, 0.5}));
  CHECK(std::abs(spin.energy() - (0.0625 + 0.1 + 0.1875)) < 1e-15);
  CHECK(std::abs(*spin.report().rms - std::sqrt(0.25 + 0.16 + 0.25)) < 1e-15);
  CHECK(spin.report().note.starts_with("rate of 'body'; its orientation is a unit quaternion within "));
  CHECK(std::abs(spin.defect()) < 3e-16);
  CHECK(spin.worst_defect() == std::abs(spin.defect()));
}

TEST_CASE("obliquity and the angle of a resonance follow from an orbit that is known", "[monitors][turning]") {
  // Inclined and eccentric, with mean anomaly 0.7; the long axis goes ahead of the pericenter by an angle, the spin
  // leans by 0.4 from the normal.
  const double inc = 0.3, node = 1.1, pericenter = 2.2, anomaly = 0.7, lean = 0.4;
  const auto [x, v] =
      state_of_orbit({.a = 1.5, .e = 0.25, .inc = inc, .Omega = node, .omega = pericenter, .M = anomaly}, 1.25 * 2);
  const auto moon = [&, &at = x, &moves = v](const Vec3<double>& inertia, const Quaternion<double>& own, double ahead) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("far", 0.5, {100, 0, 0}, {0, 0, 0});
    s.add("planet", 1.5, {1, 2, 3}, {0.1, 0, 0});
    const Quaternion<double> plane =
        turns_in_order({turn_about(2, node), turn_about(0, inc), turn_about(2, pericenter)});
    const Mat3<double> axes = rotation_matrix<double>(plane);
    add_body(s, body_of_inertia("moon", 1, inertia),
             {.x = at + Vec3<double>(1, 2, 3),
              .v = moves + Vec3<double>(0.1, 0, 0),
              .orientation = turns_in_order({plane, turn_about(2, ahead), own}),
              .spin = 0.01 * (std::cos(lean) * axes.col(2) + std::sin(lean) * axes.col(1))});
    return s;
  };
  const Vec3<double> long_in_x(0.2, 0.3, 0.4), long_in_z(0.3, 0.4, 0.2);
  const Quaternion<double> none(1, 0, 0, 0);
  Spin spin;
  spin.about = "planet";
  spin.G = 1;
  struct Resonance {
    std::vector<std::int64_t> of;
    double ahead, angle;
  };
  for (const auto& [of, ahead, angle] : {Resonance{{1, 1}, 0.9, 0.2}, Resonance{{3, 2}, 0.9, 0.9 - 1.05},
                                         Resonance{{3, 2}, 0.9 + half_turn, 0.9 - 1.05},  // it has no front
                                         Resonance{{2, 1}, -0.6, -2 + half_turn}, Resonance{{1, 2}, 1.9, 1.55},
                                         Resonance{{1, 2}, 2, 1.65 - half_turn}}) {
    spin.resonance = of;
    CAPTURE(of[0], of[1], ahead);
    // mu = G (1.5 + 1) is that of the orbit.
    const Spin by_x = first_look(moon(long_in_x, none, ahead), spin);
    CHECK(std::abs(by_x.angle() - angle) < 5e-15);
    CHECK(std::abs(by_x.obliquity() - lean) < 2e-15);
    // The third axis of the body, turned into the place of its first.
    const Spin by_z = first_look(moon(long_in_z, turn_about(1, half_turn / 2), ahead), spin);
    CHECK(std::abs(by_z.angle() - angle) < 5e-15);
  }
  spin.about = "";  // round the first other one it goes on no ellipse: there is a plane, and no pericenter
  const Spin far = first_look(moon(long_in_x, none, 0), spin);
  CHECK(std::isfinite(far.obliquity()));
  CHECK(std::isnan(far.angle()));
  CHECK(std::isnan(first_look(test::heavy_top(), Spin{}).obliquity()));  // alone
}

TEST_CASE("the defect of orientations is the largest of all, however it came to be", "[monitors][turning]") {
  ParticleSystem<double> s = bodies_line_and_point();
  s.column<BodyOrientation>().set(1, Quaternion<double>(1 + 0x1p-20, 0, 0, 0));  // 2^-19 + 2^-40
  s.column<BodyOrientation>().set(0, Quaternion<double>(0, 1 - 0x1p-21, 0, 0));  // - 2^-20 + 2^-42
  const OrientationDefect defect = first_look(s, OrientationDefect{});
  CHECK(defect.value() == 0x1p-19 + 0x1p-40);
  CHECK(defect.worst() == defect.value());
  CHECK(*defect.report().worst == defect.value());
  CHECK_FALSE(defect.report().slope.has_value());
}

TEST_CASE("energies of turns and of centres are told apart", "[monitors][turning]") {
  const ParticleSystem<double> s = bodies_line_and_point();
  const TurningEnergy energy = first_look(s, TurningEnergy{});
  double centers = 0;
  for (Index i = 0; i < s.size(); ++i) centers += s.masses()[i] * norm2(Vec3<double>(s.velocities()[i])) / 2;
  CHECK(std::abs(energy.of_centers() - centers) < 1e-15);
  CHECK(std::abs(energy.value() + centers - twice_kinetic_of_points(s, Vec3<double>::Zero()) / 2) < 1e-14);
  ParticleSystem<double> points(unit_system("reduced"));
  points.add("point", 1, {0, 0, 0}, {0, 0, 0});
  CHECK_THROWS_WITH(TurningEnergy{}.check(points),
                    "there are no rigid bodies, so nothing turns; take this monitor out");
  CHECK_THROWS_WITH(OrientationDefect{}.check(points),
                    "there are no rigid bodies, so nothing turns; take this monitor out");
}

TEST_CASE("a spin that nobody can watch is refused by name", "[monitors][turning]") {
  const auto refusal = [](const ParticleSystem<double>& s, const Spin& spin) {
    try {
      first_look(s, spin);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("none");
  };
  const auto with = [](std::string body, std::string round, std::vector<std::int64_t> resonance) {
    Spin spin(std::move(body));
    spin.about = std::move(round);
    spin.resonance = std::move(resonance);
    return spin;
  };
  const ParticleSystem<double> s = bodies_line_and_point();
  CHECK(refusal(s, with("needle", "point", {3, 2})) == "none");
  CHECK(refusal(s, with("point", "", {1, 1})) ==
        "body = \"point\" is a point, which does not turn; give the name of a rigid body");
  CHECK(refusal(s, with("neddle", "", {1, 1})) == "body = \"neddle\" is not a particle; did you mean 'needle'?");
  CHECK(refusal(s, with("needle", "pint", {1, 1})) ==
        "about = \"pint\" is not another particle; did you mean 'point'?");
  CHECK(refusal(s, with("needle", "", {4, 3})) ==
        "resonance = [4, 3] is not a valid resonance; two whole numbers such as [3, 2], the second 1 or 2, are "
        "expected");
}

}  // namespace noether
