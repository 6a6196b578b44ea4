// Charges in each other's fields to order 1/c^2, and without induction: where independent integrations have them, and
// what the particles and their field keep.

#include "integrators/systems/darwin.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/systems/lorentz_pairs.hpp"
#include "monitors/field_momentum.hpp"
#include "monitors/momentum_map.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace noether;

namespace {

MethodChoice fixed(const std::string& name) {
  MethodChoice choice = method(name);
  if (choice.info->adaptive) choice.options.adaptive = false;
  return choice;
}

double norm(const Vec3<double>& v) { return std::sqrt(norm2(v)); }

/// Charges of both signs, none near another.
template <class System> System cloud(int n) {
  System all{.masses = {}, .charges = {}, .positions = {}, .velocities = {}, .k = 0.1, .c = 2};
  for (int i = 0; i < n; ++i) {
    all.masses.push_back(1 + 0.1 * (i % 4));
    all.charges.push_back(i % 2 == 0 ? 1 : -1);
    for (const int cell : {i % 3, i / 3 % 3, i / 9})
      all.positions.push_back(1.5 * cell + 0.2 * std::sin(7.0 * i + cell));
    for (int d = 0; d < 3; ++d) all.velocities.push_back(0.3 * std::cos(3.0 * i + d));
  }
  return all;
}

/// The scene of C30.
template <class System> System two_charges(double c) {
  return {.masses = {1, 1},
          .charges = {1, -1},
          .positions = {0.5, 0, 0, -0.5, 0, 0},
          .velocities = {0, 0.6, 0.2, 0.2, -0.6, 0},
          .c = c};
}

/// How far positions and velocities are from `there` after `steps` steps.
double off(const Darwin& system, const char* name, double h, int steps, const std::vector<double>& there) {
  Simulation run(initial_state(system), classical(system, fixed(name)), h);
  REQUIRE(run.run(steps).ok());
  const Index n = system.size();
  const auto& y = run.particles().variables();
  Vector<double> q(n), p(n), v;
  for (Index i = 0; i < n; ++i) {
    q[i] = y[static_cast<std::size_t>(i)];
    p[i] = y[static_cast<std::size_t>(n + i)];
  }
  LagrangianMotion<Darwin, double> motion(system);
  REQUIRE(!motion.velocity(0, q, p, v));
  double worst = 0;
  for (Index i = 0; i < n; ++i) {
    worst = std::max(worst, std::abs(q[i] - there[static_cast<std::size_t>(i)]));
    worst = std::max(worst, std::abs(v[i] - there[static_cast<std::size_t>(n + i)]));
  }
  return worst;
}

}  // namespace

// Euler's and Lagrange's equations of L as printed, differentiated by differences of 1e-14 in 55 digits and
// extrapolated after Gragg, Bulirsch and Stoer with two lengths of steps: they agree to 2e-15, x then v.
TEST_CASE("charges under Darwin's Lagrangian are where extended precision has them", "[darwin]") {
  const Darwin three{.masses = {1, 2, 1.5},
                     .charges = {1, -1, 0.5},
                     .positions = {0, 0, 0, 1, 0.25, 0, -0.5, 1, 0.75},
                     .velocities = {0.25, 0, 0.5, -0.5, 0.25, 0, 0, -0.5, 0.25},
                     .c = 4};
  const std::vector<double> pair_there = {0.49506486277270284,   0.066324197999666004,  0,
                                          -0.49506486277270284,  -0.066324197999666004, 0,
                                          -0.039959282162050164, 0.39862602224998683,   0,
                                          0.039959282162050164,  -0.39862602224998683,  0},
                            three_there = {0.28134235004978614,   0.029434344387609338, 0.20993945592746552,
                                           0.67414307368413862,   0.35118638492673998,  0.014473928555019101,
                                           -0.50228148027354247,  0.76263480383288551,  0.8832103789814324,
                                           0.97982774741250711,   0.23470141388106272,  0.25885755286831691,
                                           -0.85128466954986504,  0.10017562771594124,  0.098067287243629703,
                                           -0.014084141864675874, -0.45113749897450584, 0.28205966777788793};
  for (const char* name : {"galerkin_gauss_4", "gauss_5"}) {
    CAPTURE(name);
    CHECK(off(Darwin{}, name, 0.02, 200, pair_there) < 1e-12);
    CHECK(off(three, name, 0.01, 50, three_there) < 1e-12);
  }
}

TEST_CASE("Darwin's charges keep energy, momentum and angular momentum with their field, not alone", "[darwin][slow]") {
  for (const int n : {2, 3, 20}) {
    CAPTURE(n);
    const auto system = cloud<Darwin>(n);
    Simulation run(initial_state(system), classical(system, method("galerkin_gauss_2")), 0.05);
    Energy& energy = run.every(1, Energy());
    FieldMomentum& shared = run.every(1, FieldMomentum(system));
    std::vector<MomentumMap*> maps;
    for (const Symmetry& one : system.symmetries()) maps.push_back(&run.every(1, MomentumMap(system, one.name)));
    REQUIRE(run.run(n == 20 ? 2 : 100).ok());
    CHECK(energy.worst() < 1e-7);
    for (const MomentumMap* map : maps) CHECK(map->worst() < 2e-13);
    CHECK(shared.worst() < 2e-13);
    CHECK(shared.worst_of_particles() > 1e-5);
    // p = dL/dv has both.
    const MomentumShares last = shared.last();
    Vec3<double> sum(0, 0, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
      sum += of_charge(run.particles().variables(), static_cast<std::size_t>(n) + i);
    CHECK(norm(Vec3<double>(last.particles + last.field - sum)) < 1e-13);
  }
}

// C30, and the places from a program of its own with RK4 in steps of 5e-4.
TEST_CASE("charges in instantaneous fields keep their energy, and lose angular momentum as 1/c^2", "[lorentz]") {
  const std::array<std::array<double, 2>, 3> rows = {{{5, 0.255}, {10, 0.0599}, {20, 0.0149}}};
  for (const auto& [c, lost] : rows) {
    CAPTURE(c);
    const auto system = two_charges<LorentzPairs>(c);
    Simulation run(initial_state(system), classical(system, fixed("gauss_4")), 0.05);
    Energy& energy = run.every(1, Energy());
    FieldMomentum& shared = run.every(1, FieldMomentum(system));
    REQUIRE(run.run(0).ok());
    const Vec3<double> start = {0, -0.1, 0.6};
    double worst = 0;
    for (int n = 0; n < 400; ++n) {
      REQUIRE(run.run(1).ok());
      worst = std::max(worst, norm(Vec3<double>(shared.last().particles_about - start)) / norm(start));
    }
    CHECK(std::abs(worst / lost - 1) < 5e-3);
    CHECK(energy.worst() < 1e-10);
    CHECK(shared.worst_of_particles() > lost / 4);
    if (c != 5) continue;
    const double there[] = {1.415402777033,    0.486538131811, 2.089257409481, 2.155724512007,
                            0.625457298253,    2.114194622293, 0.472928463850, -0.679864143987,
                            -0.00570132284736, -0.32223866084, 0.783520276561, 0.223788672696};
    for (std::size_t i = 0; i < 12; ++i) CHECK(std::abs(run.particles().variables()[i] - there[i]) < 1e-9);
  }
}

// B = k e v x n/(c^2 r^2) by hand: a charge at rest feels none, and two abreast attract as much less as v^2/c^2.
TEST_CASE("forces of Biot and Savart between two charges are not opposite", "[lorentz]") {
  const auto acceleration = [](const LorentzPairs& system) {
    LagrangianMotion<LorentzPairs, double> motion(system);
    Vector<double> y(12), dy;
    const std::vector<double> start = system.start();
    for (Index i = 0; i < 12; ++i) y[i] = start[static_cast<std::size_t>(i)];
    motion.rate(0, y, dy);
    return dy;
  };
  LorentzPairs abreast{.positions = {0, 0, 0, 0, 2, 0}, .velocities = {0.5, 0, 0, 0.5, 0, 0}, .c = 2};
  const Vector<double> even = acceleration(abreast);
  CHECK(std::abs(even[7] - 0.25 * (1 - 0.25 / 4)) < 1e-15);
  CHECK(std::abs(even[10] + 0.25 * (1 - 0.25 / 4)) < 1e-15);
  // One moves along the pair and makes no field there, the other across it and makes one.
  const LorentzPairs askew{.positions = {0, 0, 0, 0, 2, 0}, .velocities = {0, 0.5, 0, 0.5, 0, 0}, .c = 2};
  const Vector<double> uneven = acceleration(askew);
  CHECK(std::abs(uneven[6] - 0.25 * 0.25 / 4) < 1e-15);
  CHECK(std::abs(uneven[9]) < 1e-15);
}

TEST_CASE("charges that are no pairs of Darwin's or Lorentz's are refused", "[darwin]") {
  const auto refusal = [](const auto& system) {
    try {
      system.check();
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("nothing");
  };
  CHECK(refusal(Darwin{}) == "nothing");
  CHECK(refusal(LorentzPairs{}) == "nothing");
  CHECK_THAT(refusal(Darwin{.charges = {1}}), Catch::Contains("charges = a list of 1 does not fit 2 masses"));
  CHECK_THAT(refusal(Darwin{.c = 0}), Catch::Contains("c = 0 is not a valid speed of light"));
  CHECK_THAT(refusal(Darwin{.c = 0.4}), Catch::Contains("velocities = 0.4 of charge 1 is not below c = 0.4"));
  CHECK_THAT(refusal(LorentzPairs{.c = 0.1}), Catch::Contains("is not below c = 0.1; slower charges are expected"));
  Simulation run(initial_state(Darwin{}), classical(Darwin{}, method("galerkin_gauss_2")), 0.1);
  CHECK_THROWS_WITH(run.every(1, FieldMomentum{}),
                    "monitor 'field_momentum' needs a system that has momentum_sharing(), such as 'darwin' or "
                    "'lorentz_pairs'; take it out, or use 'momentum_map'");
  const auto bound = [](const char* name) {
    Simulation(initial_state(LorentzPairs{}), classical(LorentzPairs{}, method(name)), 0.1);
  };
  CHECK_THROWS_WITH(bound("hbvm_4_2"), Catch::Contains("system 'lorentz_pairs' has a force beside its Lagrangian"));
  CHECK_THROWS_WITH(bound("gonzalez"), Catch::Contains("system 'lorentz_pairs' has a force beside its Lagrangian"));
  CHECK_THROWS_AS(bound("semiexplicit_2"), SchemeMismatch);
  CHECK_THROWS_AS(bound("weber_implicit"), SchemeMismatch);
  const auto claims =
      Simulation(initial_state(LorentzPairs{}), classical(LorentzPairs{}, method("gauss_1")), 0.1).claims();
  CHECK_FALSE(claims.symplectic);
  CHECK_FALSE(claims.dissipative);
}

TEST_CASE("what charges and their field have goes on over a restart", "[darwin][restart]") {
  const auto make = [] {
    return Simulation(initial_state(Darwin{}), classical(Darwin{}, method("galerkin_gauss_2")), 0.1);
  };
  auto whole = make(), first = make(), second = make();
  FieldMomentum& all = whole.every(1, FieldMomentum(Darwin{}));
  first.every(1, FieldMomentum(Darwin{}));
  FieldMomentum& rest = second.every(1, FieldMomentum(Darwin{}));
  REQUIRE(whole.run(20).ok());
  REQUIRE(first.run(9).ok());
  second.restore(first.save());
  REQUIRE(second.run(11).ok());
  CHECK(all.worst() == rest.worst());
  CHECK(all.worst_of_particles() == rest.worst_of_particles());
  CHECK(all.last().field == rest.last().field);
}
