/// Whether flows are those of their energy: of what the library has, and of what is wrong in one way each.

#include "integrators/check_flows.hpp"

#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <cmath>
#include <string>

namespace noether {
namespace {

/// Around a Hamiltonian of points: its drifts and kicks too long or too short.
class Stretched : public Wrapped<AnyHamiltonian<double>> {
 public:
  Stretched(AnyHamiltonian<double> inside, double drifts, double kicks)
      : Wrapped(std::move(inside)), drifts_(drifts), kicks_(kicks) {}
  void flow(char letter, ParticleSystem<double>& s, const double& h) {
    static_cast<void>(flow_with_action(letter, s, h));
  }
  double flow_with_action(char letter, ParticleSystem<double>& s, const double& h) {
    return Wrapped::flow_with_action(letter, s, h * (letter == 'A' ? drifts_ : kicks_));
  }

 private:
  double drifts_, kicks_;
};

/// Two on a spring to the origin, the second of which moves.
ParticleSystem<double> two_on_springs() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("one", 2, {1, 0.5, 0}, {0, 0, 0});
  s.add("two", 4, {0, 0, -1}, {0.25, 0, 0.5});
  s.add("tracer", 0, {3, 3, 3}, {1, 1, 1});
  return s;
}

std::string stretched_complaint(double drifts, double kicks) {
  return test::refusal_of(
      [&] { check_flows(Stretched(test::kinetic_potential(HarmonicField{.k = 2}), drifts, kicks), two_on_springs()); });
}

}  // namespace

TEST_CASE("flows of the library are those of their energies", "[integrators][check_flows]") {
  CHECK_NOTHROW(check_flows(test::kinetic_potential(Gravity{.G = test::outer_G}), test::outer_planets()));
  CHECK_NOTHROW(check_flows(test::kinetic_potential(HarmonicField{.k = 2}), two_on_springs()));
  // In a periodic box, some across its faces.
  ParticleSystem<double> gas(unit_system("reduced"));
  for (int k = 0; k < 27; ++k)
    gas.add("", 1, {1.2 * (k % 3) + 0.01 * k, 1.2 * (k / 3 % 3), 1.2 * (k / 9) - 0.02 * k}, {0.1 * k, -0.2, 0});
  gas.set_box(Box::periodic({4, 4, 4}));
  CHECK_NOTHROW(
      check_flows(test::kinetic_potential(LennardJonesForce{.cutoff = 1.9, .epsilon = 1.0, .sigma = 1.0}), gas));
  // Bodies that pull each other.
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_inertia("one", 2, {0.3, 0.4, 0.5}),
           {.v = {0.1, 0, 0}, .orientation = {1, 0.2, -0.3, 0.1}, .spin = Vec3<double>(0.1, 0.3, -0.2)});
  add_body(s, body_of_inertia("two", 0.5, {0.02, 0.03, 0.04}),
           {.x = {3, -0.4, 0.8}, .v = {0, 0.7, 0}, .orientation = {0.5, 0.1, 0.7, -0.2}});
  ForceField<double> gravity;
  gravity.add(GravityOfBodies{});
  CHECK_NOTHROW(check_flows(test::turning(std::move(gravity)), s));
}

TEST_CASE("drifts and kicks that are not those of the energy are named", "[integrators][check_flows]") {
  const std::string then = "; check the flows of its letters and the energy it reports";
  CHECK(stretched_complaint(1, 1).empty());
  CHECK(stretched_complaint(1 + 1e-6, 1).empty());  // what differences cannot tell
  CHECK(stretched_complaint(1.5, 1) ==
        "'kinetic_potential' moves 'two' along z by 0.75, where the slope of its energy has 0.5" + then);
  CHECK(stretched_complaint(1, 0.25) ==
        "'kinetic_potential' accelerates 'one' along x by -0.25, where the slope of its energy has -1" + then);
  CHECK(stretched_complaint(1, -1) ==
        "'kinetic_potential' accelerates 'one' along x by 1, where the slope of its energy has -1" + then);
}

TEST_CASE("what no energy tells is refused", "[integrators][check_flows]") {
  const auto refusal = [](const AnyHamiltonian<double>& hamiltonian, const ParticleSystem<double>& s) {
    return test::refusal_of([&] { check_flows(hamiltonian, s); });
  };
  const auto s = two_on_springs();
  CHECK(refusal(test::damped(test::kinetic_potential(HarmonicField{.k = 2}), {.rate = 1}), s) ==
        "the flows of 'damped' cannot be compared with its energy: some of its letters follow no energy");
  CHECK(refusal(test::wisdom_holman({.G = test::outer_G}), test::outer_planets()) ==
        "the flows of 'wisdom_holman' cannot be compared with its energy: it has its own coordinates");
  const test::Mechanism chain = test::hanging_chain(3);
  CHECK(refusal(test::hamiltonian_of(chain), chain.particles) ==
        "the flows of 'kinetic_potential' cannot be compared with its energy: constraints hold its particles");
}

}  // namespace noether
