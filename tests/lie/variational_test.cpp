/// The variational rotor: how far a body turns in a step, where no turn is left, what it keeps, what is made of it.

#include "integrators/variational_rotor.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/lie/top_errors.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>

namespace noether {
namespace {

using test::heavy_top, test::turning, test::weight_on_sites;

const RotatingOptions by_action{.rotor = Rotor::variational};

double lgvi_error(const std::string& scheme, double h) {
  return test::heavy_top_error(compose(turning(weight_on_sites(), by_action), *schemes::find(scheme)), h);
}

/// The angle of a step of length `hw` about an axis at the rate 1; NaN where there is no turn.
double principal_turn(int axis, double hw) {
  const Vec3<double> inertia(1.3, 2.1, 0.9);
  Vec3<double> spin = Vec3<double>::Zero();
  spin[axis] = inertia[axis];
  const auto turned = turn_variationally<double>({1, 0, 0, 0}, spin, inertia, hw);
  return turned ? 2 * std::asin(turned->orientation[1 + axis]) : NAN;
}

}  // namespace

TEST_CASE("about a principal axis the discrete body turns by arcsin(h w), and not at all beyond h w = 1", "[lie]") {
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(std::abs(principal_turn(axis, 0.5) - 0.52359877559829887) < 2e-16);
    CHECK(std::abs(principal_turn(axis, 0.9) - 1.119769514998634) < 1e-15);
    CHECK(std::abs(principal_turn(axis, -0.5) + 0.52359877559829887) < 2e-16);
    CHECK(std::abs(principal_turn(axis, 1e-9) - 1e-9) < 1e-24);
    for (const double hw : {1.001, 1.5, 3., 100.}) CHECK(std::isnan(principal_turn(axis, hw)));
  }
}

TEST_CASE("a body that turns too fast for the discrete action ends the run by name", "[lie]") {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("slow", 1, {1, 2, 3}), {.angular_velocity = Vec3<double>(0.1, 0, 0)});
  add_body(s, body_of_inertia("quick", 1, {1, 2, 3}), {.angular_velocity = Vec3<double>(0, 0, 1.001)});
  Simulation sim(s, compose(turning(ForceField<double>{}, by_action), schemes::verlet), 1.0);
  const Outcome outcome = sim.run(10);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message.find("the discrete action has no turn of body 'quick'") != std::string::npos);
  CHECK(outcome.message.find("1.001 rad") != std::string::npos);
}

TEST_CASE("the heavy top of the variational rotor has its errors, J_z to the bit, and orders of compositions",
          "[lie]") {
  CHECK(std::abs(lgvi_error("lie_group_variational", 0.1) / 4.833e-2 - 1) < 0.02);
  CHECK(std::abs(std::log2(lgvi_error("lie_group_variational", 0.05) / lgvi_error("lie_group_variational", 0.025)) -
                 2.011) < 0.02);
  CHECK(std::abs(std::log2(lgvi_error("yoshida_4", 0.025) / lgvi_error("yoshida_4", 0.0125)) - 4) < 0.15);
  Simulation sim(heavy_top(), compose(turning(weight_on_sites(), by_action), schemes::lie_group_variational), 0.1);
  REQUIRE(sim.run(1000).ok());
  CHECK(sim.particles().column<BodySpin>()[0][2] == 0.9);
  CHECK(std::abs(norm_defect<double>(sim.particles().column<BodyOrientation>()[0])) < 1e-15);
}

TEST_CASE("the shadow of the variational rotor is flatter with every order: its turns are those of an action",
          "[lie]") {
  double before[3] = {};
  for (const double h : {0.2, 0.1}) {
    Simulation sim(heavy_top(), compose(turning(weight_on_sites(), by_action), schemes::lie_group_variational), h);
    auto& shadow = sim.every(1, ShadowHamiltonian<double>({4, 8, 12}));
    REQUIRE(sim.run(std::lround(10 / h)).ok());
    CHECK(shadow.verdict().starts_with("kept"));
    CHECK(shadow.fluctuation(1) < 0.1 * shadow.fluctuation(0));
    CHECK(shadow.fluctuation(2) < 0.1 * shadow.fluctuation(1));
    for (std::size_t k = 0; k < 3; ++k) {
      if (before[k] > 0) CHECK(std::log2(before[k] / shadow.fluctuation(k)) > 4 * static_cast<double>(k) + 2.5);
      before[k] = shadow.fluctuation(k);
    }
  }
}

TEST_CASE("bodies in a line and bodies at rest have turns, and steps back undo steps forth", "[lie]") {
  const Quaternion<double> q(std::cos(0.3), std::sin(0.3), 0, 0);
  const Vec3<double> line(1, 1, 0), spin(0.3, 0, 0);  // across the line
  const auto there = turn_variationally<double>(q, spin, line, 0.5);
  REQUIRE(there);
  const auto back = turn_variationally<double>(there->orientation, spin, line, -0.5);
  REQUIRE(back);
  CHECK((back->orientation - q).norm() < 1e-15);
  const auto resting = turn_variationally<double>(q, Vec3<double>::Zero(), {1, 2, 3}, 0.5);
  REQUIRE(resting);
  CHECK(resting->orientation == q);
  CHECK(resting->action == 0);
}

TEST_CASE("the variational scheme refuses other rotors, and tables that need exact turns refuse it", "[lie]") {
  const auto refusal = [](const std::string& scheme, Rotor rotor) {
    try {
      compose(turning(weight_on_sites(), {.rotor = rotor}), *schemes::find(scheme));
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("none");
  };
  CHECK(refusal("lie_group_variational", Rotor::exact) ==
        "scheme 'lie_group_variational' turns bodies by the rotor 'variational', but 'kinetic_potential' has 'exact'; "
        "use 'verlet' with it");
  CHECK(refusal("lie_group_variational", Rotor::variational) == "none");
  CHECK(refusal("yoshida_4", Rotor::variational) == "none");
  CHECK(refusal("srkn14a", Rotor::variational).find("needs exact flows") != std::string::npos);
}

}  // namespace noether
