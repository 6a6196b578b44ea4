// What watches runs of Lagrangians: energy, shadow, momentum maps; restarts.

#include "monitors/monitors.hpp"
#include "integrators/variational/discrete_lagrangian.hpp"
#include "monitors/momentum_map.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "tests/variational/lagrangians.hpp"

using namespace noether;

namespace {

template <class S> Simulation<double> run_of(const S& system, const char* name, double h) {
  return {initial_state(system), variational(system, method(name)), h};
}

/// A discrete Lagrangian without the symmetry of its system: the potential is taken at a point turned from the middle.
struct Askew {
  template <class Real> Real operator()(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const {
    const Real u = (q1[0] - q0[0]) / h, v = (q1[1] - q0[1]) / h;
    const Real x = (q0[0] + q1[0]) / Real(2) + Real(0.01) * h, y = (q0[1] + q1[1]) / Real(2), r2 = x * x + y * y;
    return h * ((u * u + v * v) / Real(2) - r2 * r2 / Real(4) - r2);
  }
};

}  // namespace

TEST_CASE("the momentum of a symmetry is kept to rounding by every variational method, J- and J+ of each step",
          "[momentum_map]") {
  for (const char* name :
       {"variational_midpoint", "variational_trapezoidal", "galerkin_gauss_4", "galerkin_lobatto_4"}) {
    CAPTURE(name);
    auto run = run_of(test::CentralForce{}, name, 0.1);
    const auto& map = run.every(10, MomentumMap(test::CentralForce{}));
    REQUIRE(run.run(400).ok());
    CHECK(map.report().samples > 70);
    CHECK(map.worst() < 3e-14);
    CHECK(map.worst_step() < 2e-15);
    CHECK(std::abs(map.last() - (1.2 * 0.9 + 0.1 * 0.2)) < 3e-14);
  }
  Simulation<double> askew(initial_state(test::CentralForce{}), variational(test::CentralForce{}, Variational{Askew{}}),
                           0.1);
  const auto& map = askew.every(1, MomentumMap(test::CentralForce{}));
  REQUIRE(askew.run(100).ok());
  CHECK(map.worst_step() > 1e-5);
}

TEST_CASE("a momentum map is refused where there is no symmetry of its name", "[momentum_map]") {
  auto run = run_of(SimplePendulum{}, "galerkin_gauss_2", 0.1);
  CHECK_THROWS_WITH(run.every(1, MomentumMap{}),
                    "monitor 'momentum_map' needs a symmetry, but this system names none; take it out, or give the "
                    "system symmetries()");
  auto orbit = run_of(PolarKepler{}, "galerkin_gauss_2", 0.1);
  CHECK_THROWS_WITH(orbit.every(1, MomentumMap(PolarKepler{}, "rotatoin")),
                    "monitor 'momentum_map' names the symmetry 'rotatoin', which the system does not have; did you "
                    "mean 'rotation'?");
}

TEST_CASE("the shadow serves every variational method over coordinates, a user's L_d too", "[shadow]") {
  const auto verdict = [](auto run) {
    const auto& shadow = run.every(1, ShadowHamiltonian<double>{});
    REQUIRE(run.run(400).ok());
    return shadow.verdict();
  };
  for (const char* name :
       {"variational_midpoint", "variational_trapezoidal", "galerkin_gauss_2", "galerkin_lobatto_4"}) {
    CAPTURE(name);
    const std::string said = verdict(run_of(PolarKepler{}, name, 0.05));
    CAPTURE(said);
    CHECK(said.starts_with("kept"));
  }
  const std::string own = verdict(Simulation<double>(initial_state(test::CentralForce{}),
                                                     variational(test::CentralForce{}, Variational{Askew{}}), 0.02));
  CHECK(own.starts_with("kept"));
}

TEST_CASE("the shadow of the trapezoidal rule over a pendulum is Verlet's to its order", "[shadow]") {
  // H_h = H + h^2 (p^2 U''/12 - U'^2/24) + O(h^4), U = -cos q
  const auto error = [](double h) {
    auto run = run_of(SimplePendulum{}, "variational_trapezoidal", h);
    const auto& shadow = run.every(1, ShadowHamiltonian<double>({4, 8, 12}));
    const double q = 2, p = 0.3, H = p * p / 2 - std::cos(q);
    const double expected = H + h * h * (p * p * std::cos(q) / 12 - std::sin(q) * std::sin(q) / 24);
    REQUIRE(run.run(40).ok());
    return std::abs(shadow.values().back() - expected);
  };
  CHECK(error(0.05) < 1e-5);
  CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - 4) < 0.2);
}

TEST_CASE("the shadow is refused under drag, for driven Lagrangians, and for methods that give no action", "[shadow]") {
  const auto watched = [](auto run) { run.every(1, ShadowHamiltonian<double>{}); };
  CHECK_THROWS_WITH(watched(run_of(SimplePendulum{.damping = 0.1}, "galerkin_gauss_2", 0.1)),
                    "monitor 'shadow_hamiltonian' needs the action of every step: a force of this run is dissipative, "
                    "so its motion has no action");
  CHECK_THROWS_WITH(watched(run_of(test::Shaken{}, "galerkin_gauss_2", 0.1)),
                    "monitor 'shadow_hamiltonian' needs the action of every step: a force of this run depends on time, "
                    "so no energy is conserved, not even the exact one");
  CHECK_THROWS_WITH(watched(run_of(PolarKepler{}, "rk4", 0.1)),
                    "monitor 'shadow_hamiltonian' needs the action of every step: method 'rk4' does not compute it; it "
                    "is not symplectic");
}

TEST_CASE("a saved run of a Lagrangian goes on with the same bits, its monitors with the same figures", "[restart]") {
  for (const char* name : {"variational_midpoint", "galerkin_gauss_3", "galerkin_lobatto_4"}) {
    CAPTURE(name);
    auto whole = run_of(PolarKepler{}, name, 0.05), half = run_of(PolarKepler{}, name, 0.05),
         other = run_of(PolarKepler{}, name, 0.05);
    const auto watch = [](auto& run) -> std::pair<const ShadowHamiltonian<double>*, const MomentumMap*> {
      return {&run.every(1, ShadowHamiltonian<double>{}), &run.every(1, MomentumMap(PolarKepler{}))};
    };
    const auto whole_seen = watch(whole), half_seen = watch(half), other_seen = watch(other);
    REQUIRE(whole.run(100).ok());
    REQUIRE(half.run(37).ok());
    CHECK(half_seen.first->values().size() == 6);
    other.restore(half.save());
    REQUIRE(other.run(63).ok());
    CHECK(whole.particles().variables() == other.particles().variables());
    CHECK(whole_seen.first->values() == other_seen.first->values());
    CHECK(whole_seen.second->worst_step() == other_seen.second->worst_step());
    CHECK(whole.evaluations().force == other.evaluations().force);
  }
}

TEST_CASE("the energy of a Lagrangian stays within the order of its method", "[energy]") {
  const auto worst = [](double h) {
    auto run = run_of(PolarKepler{}, "galerkin_gauss_2", h);
    const auto& energy = run.every(1, Energy{});
    REQUIRE(run.run_until(20).ok());
    return energy.worst();
  };
  CHECK(worst(0.1) < 1e-4);
  CHECK(std::abs(std::log2(worst(0.1) / worst(0.05)) - 4) < 0.3);
}
