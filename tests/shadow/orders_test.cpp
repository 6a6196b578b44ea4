/// Orders of the shadow Hamiltonian in 113 bits, where it is exact, and what it is at order h^2.

#include "forces/external_fields.hpp"
#include "integrators/classical.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "tests/shadow/support.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>

using namespace noether;

namespace {

/// What Henon and Heiles have beside springs.
struct CubicField {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) {
      const Real x = s.positions()[i][0], y = s.positions()[i][1];
      out.acceleration(i, Vec3<Real>(-Real(2) * x * y, -x * x + y * y, Real(0)));
      if (out.wants_energy()) out.energy(s.masses()[i] * (x * x * y - y * y * y / Real(3)));
    }
  }
};

/// Slopes of log2 of the fluctuation from one step to half of it, for each order.
template <class I>
std::vector<double> slopes(const I& integrator, const ParticleSystem<double>& start, double h, std::int64_t steps) {
  const std::vector<std::int64_t>& orders = test::shadow_orders;
  const auto coarse = test::shadow_of(integrator, start, h, steps, orders);
  const auto fine = test::shadow_of(integrator, start, h / 2, 2 * steps, orders);
  std::vector<double> result;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    result.push_back(std::log2(coarse.fluctuation(k) / fine.fluctuation(k)));
    CAPTURE(integrator.claims().method, integrator.claims().hamiltonian, orders[k], coarse.fluctuation(k), result[k]);
    CHECK(result[k] > 0);
  }
  return result;
}

/// Slopes 4 and 8, and on to at least 20 at order 24: they approach 2k as h goes to 0.
void check_orders(const std::vector<double>& found) {
  CHECK(std::fabs(found[0] - 4) < 0.2);
  CHECK(std::fabs(found[1] - 8) < 0.2);
  for (std::size_t k = 1; k < found.size(); ++k) CHECK(found[k] > found[k - 1] + 2);
  CHECK(found.back() > 20);
}

/// A method of Gauss with steps of one length: the midpoint rule knows no others.
MethodChoice fixed(const std::string& name) {
  return name == "implicit_midpoint" ? method(name) : method(name, {.adaptive = false});
}

}  // namespace

TEST_CASE("the shadow Hamiltonian is flat to its order under compositions of drift and kick", "[shadow]") {
  const auto field = test::kinetic_potential<Quad>(test::HenonHeilesField{});
  for (const Scheme& scheme : {schemes::verlet, schemes::verlet_aba, schemes::yoshida_4, schemes::blanes_moan_s6}) {
    CAPTURE(scheme.name);
    check_orders(slopes(compose(field, scheme), test::henon_heiles_start(), 0.15, 300));
  }
}

TEST_CASE("the shadow Hamiltonian is flat to its order under multiple time steps", "[shadow][respa]") {
  ForceField<Quad> field;
  field.add(HarmonicField{1}).add(AnyForce<Quad>(CubicField{}).in_kick('C'));
  const auto parted = test::kinetic_potential_over(field);
  for (const std::int64_t inner : {2, 3}) {
    CAPTURE(inner);
    check_orders(
        slopes(compose(parted, schemes::respa, {.inner_steps = {inner}}), test::henon_heiles_start(), 0.15, 300));
  }
}

TEST_CASE("the shadow of multiple time steps is nearer to the energy by their order", "[shadow][respa]") {
  // H_h - H = O(h^2): what the energy loses against its shadow falls by 4 when the step halves.
  ForceField<Quad> field;
  field.add(HarmonicField{1}).add(AnyForce<Quad>(CubicField{}).in_kick('C'));
  std::vector<double> lost;
  for (const double h : {0.2, 0.1}) {
    Simulation run(test::henon_heiles_start().as<Quad>(),
                   compose(test::kinetic_potential_over(field), schemes::respa, {.inner_steps = {4}}), h);
    auto& energy = run.every(1, Energy{});
    auto& shadow = run.every(1, ShadowHamiltonian<Quad>(test::shadow_orders));
    REQUIRE(run.run(static_cast<std::int64_t>(std::round(40 / h))).ok());
    lost.push_back(energy.rms());
    CHECK(shadow.fluctuation(shadow.best()) < 1e-8 * energy.rms());
  }
  CHECK(std::fabs(std::log2(lost[0] / lost[1]) - 2) < 0.1);
}

TEST_CASE("the shadow Hamiltonian is flat to its order under Gauss's methods, the midpoint rule among them",
          "[shadow]") {
  const auto field = test::field_of<Quad>(test::HenonHeilesField{});
  for (const char* name : {"implicit_midpoint", "gauss_2"}) {
    CAPTURE(name);
    const auto found = slopes(test::classical_over(field, fixed(name)), test::henon_heiles_start(), 0.15, 300);
    check_orders(found);
  }
}

TEST_CASE("the shadow of Gauss's method is nearer to the energy by its order", "[shadow]") {
  // H_h - H = O(h^4): what the energy loses against its shadow falls by 16 when the step halves.
  const auto field = test::field_of<Quad>(test::HenonHeilesField{});
  std::vector<double> lost;
  for (const double h : {0.2, 0.1}) {
    Simulation run(test::henon_heiles_start().as<Quad>(), test::classical_over(field, fixed("gauss_2")), h);
    auto& energy = run.every(1, Energy{});
    auto& shadow = run.every(1, ShadowHamiltonian<Quad>(test::shadow_orders));
    REQUIRE(run.run(static_cast<std::int64_t>(std::round(40 / h))).ok());
    lost.push_back(energy.rms());
    CHECK(shadow.fluctuation(shadow.best()) < 1e-10 * energy.rms());
  }
  CHECK(std::fabs(std::log2(lost[0] / lost[1]) - 4) < 0.2);
}

TEST_CASE("the shadow Hamiltonian is flat to its order under Wisdom-Holman in all coordinates", "[shadow]") {
  const auto start = test::planets(1e-3);
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    const auto planets = test::wisdom_holman<Quad>({.G = 1, .coordinates = coordinates});
    for (const Scheme& scheme : {schemes::verlet_aba, schemes::abah_10_6_4}) {
      CAPTURE(scheme.name, static_cast<int>(coordinates));
      check_orders(slopes(compose(planets, scheme), start, 0.15, 120));
    }
  }
}

TEST_CASE("a quadratic Hamiltonian has an exact shadow, to every order alike", "[shadow]") {
  const auto start = test::particle_in_plane(1, 0.2, 0, 0.7);
  const auto spring = test::kinetic_potential<Quad>(HarmonicField{.k = 1});
  const auto shadow = test::shadow_of(compose(spring, schemes::verlet), start, 0.9, 200, test::shadow_orders);
  for (std::size_t k = 0; k < test::shadow_orders.size(); ++k) CHECK(shadow.fluctuation(k) < 1e-29);
}

TEST_CASE("Verlet's shadow is the Hamiltonian and the known terms of order h^2", "[shadow]") {
  // H + h^2 (p U'' p / 12 - |grad U|^2 / 24) for kick, drift, kick, at the middle of the window.
  const auto start = test::henon_heiles_start();
  const auto field = test::kinetic_potential<Quad>(test::HenonHeilesField{});
  std::vector<double> errors;
  for (const double h : {0.04, 0.02}) {
    const auto to_middle = static_cast<std::int64_t>(std::round(0.8 / h));
    const auto shadow = test::shadow_of(compose(field, schemes::verlet), start, h, to_middle + 6, {24});
    const auto middle = test::run(field, schemes::verlet, start.as<Quad>(), h, to_middle);
    const test::PhasePoint<Quad> at = test::motion_of(middle);
    const Quad x = at.x[0], y = at.x[1], u = at.v[0], v = at.v[1];
    const Quad energy = (u * u + v * v + x * x + y * y) / Quad(2) + x * x * y - y * y * y / Quad(3);
    const Quad ux = x + Quad(2) * x * y, uy = y + x * x - y * y;
    const Quad curvature = u * u * (Quad(1) + Quad(2) * y) + Quad(4) * u * v * x + v * v * (Quad(1) - Quad(2) * y);
    const Quad expanded = energy + Quad(h * h) * (curvature / Quad(12) - (ux * ux + uy * uy) / Quad(24));
    errors.push_back(std::fabs(static_cast<double>(shadow.values()[0] - expanded)));
  }
  CHECK(errors[0] < 1e-6);
  CHECK(std::fabs(std::log2(errors[0] / errors[1]) - 4) < 0.05);
}

TEST_CASE("in doubles the shadow is five orders of magnitude flatter than the energy", "[shadow]") {
  const auto field = test::kinetic_potential(test::HenonHeilesField{});
  Simulation simulation(test::henon_heiles_start(), compose(field, schemes::verlet), 0.1);
  auto& shadow = simulation.every(1, ShadowHamiltonian<>());
  auto& energy = simulation.every(1, Energy{});
  REQUIRE(simulation.run(10'000).ok());
  CHECK(energy.rms() > 1e5 * shadow.fluctuation(shadow.best()));
  CHECK(shadow.fluctuation(shadow.best()) < 1e-14);
  CHECK_THAT(shadow.verdict(), Catch::Matchers::StartsWith("kept to rounding: order "));
}
