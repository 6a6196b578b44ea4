// Dipole moments against sums that were written down, dielectric constants against springs in a heat bath.

#include "monitors/dipole.hpp"

#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace noether {
namespace {

constexpr double edge = 8;

/// Chains of three with charges 0.5, -1.25, 0.75 and the shape of a hook, as a file without images has them: every
/// particle in the box, chains cut by its faces. The first begins at `corner`.
ParticleSystem<double> hooks(const Vec3<double>& corner, const Box& box = Box::periodic({edge, edge, edge})) {
  ParticleSystem<double> s;
  s.set_box(box);
  auto topology = std::make_shared<Topology>();
  s.add_column<Charge>();
  const double charges[3] = {0.5, -1.25, 0.75};
  const Vec3<double> places[3] = {{0, 0, 0}, {0.5, 0.25, -0.125}, {0.25, 1, 0.5}};
  for (Index m = 0; m < 64; ++m) {
    const double k = static_cast<double>(m);
    for (std::size_t a = 0; a < 3; ++a) {
      const Index i = s.add("", 1, Vec3<double>(corner + Vec3<double>(0.125 * k, 0.75 * k, 3.5 * k) + places[a]),
                            {0.25, -0.5, 0.125 * k});
      s.column<Charge>()[i] = charges[a];
    }
    // The middle is bonded to both, and named last.
    topology->bonds.push_back({{3 * m + 2, 3 * m + 1}, 0});
    topology->bonds.push_back({{3 * m, 3 * m + 1}, 0});
  }
  s.set_topology(topology);
  if (box.is_periodic()) {
    s.wrap();
    s.restore_images(VectorColumn<std::int32_t>(s.size()));
  }
  return s;
}

/// What 64 of them have together, by hand: 0.5 x_0 - 1.25 x_1 + 0.75 x_2.
constexpr double hook_moment[3] = {64 * (-1.25 * 0.5 + 0.75 * 0.25), 64 * (-1.25 * 0.25 + 0.75),
                                   64 * (1.25 * 0.125 + 0.75 * 0.5)};

template <class M, class Real = double> M seen_at_start(const ParticleSystem<Real>& s, const M& asked) {
  Simulation<Real> sim(s, compose(test::kinetic_potential<Real>(), schemes::verlet), 0.25);
  auto& monitor = sim.every(1, asked);
  REQUIRE(sim.run(0).ok());
  return monitor;
}

constexpr double stiffness = 1.5, charge = 0.75, thermal = 2;
constexpr Index springs = 6;

/// Charges that springs of no length hold together, in a bath: each component of their moment is Gaussian, of variance
/// charge^2 kT / stiffness, and the splitting BAOAB samples it exactly at any step.
Simulation<double> dipoles_in_a_bath(std::int64_t seed) {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({30, 40, 50}));
  auto topology = std::make_shared<Topology>();
  s.add_column<Charge>();
  topology->bond_kinds = {{"harmonic", {stiffness, 0}}};
  for (Index m = 0; m < springs; ++m) {
    for (const double sign : {1.0, -1.0}) {
      const Index i = s.add("", 1, {5.0 * static_cast<double>(m), sign, 0}, {0, sign, 1});
      s.column<Charge>()[i] = sign * charge;
    }
    topology->bonds.push_back({{2 * m, 2 * m + 1}, 0});
  }
  s.set_topology(topology);
  return Simulation<double>(
      std::move(s),
      compose(test::in_bath(test::field_of(Bonded{}), {.temperature = thermal, .friction = 1, .seed = seed}),
              word("BAOAB")),
      0.7);
}

DielectricConstant at_kT() {
  DielectricConstant monitor;
  monitor.temperature = thermal;
  return monitor;
}

}  // namespace

TEMPLATE_TEST_CASE("the dipole moment is that of whole molecules, wherever the box is cut", "[dipole]", double, Quad) {
  using Real = TestType;
  for (const Vec3<double>& corner :
       {Vec3<double>(0, 0, 0), Vec3<double>(7.75, 7.875, 7.5), Vec3<double>(-40, 3, 900)}) {
    const auto now = seen_at_start<DipoleMoment, Real>(hooks(corner).as<Real>(), {}).value();
    for (std::size_t k = 0; k < 3; ++k) CHECK(now[k] == hook_moment[k]);  // all of it is whole eighths
  }
  // Without bonds each particle is where its image says: nothing here was ever wrapped, so the faces show.
  ParticleSystem<double> loose = hooks({7.75, 7.875, 7.5});
  loose.set_topology(std::make_shared<const Topology>());
  CHECK(seen_at_start(loose, DipoleMoment{}).value()[0] != hook_moment[0]);
  CHECK(seen_at_start(hooks({1, 2, 3}, Box::open()), DipoleMoment{}).value()[1] == hook_moment[1]);
}

TEST_CASE("the dipole moment of moving charges follows them through the faces of the box", "[dipole]") {
  // Free flight: M grows by sum q v t = t (0, 0, 0) for the hooks, whose charges add up to 0, and by q v t for one
  // more.
  ParticleSystem<double> s = hooks({0, 0, 0});
  const Index ion = s.add("ion", 1, {1, 2, 3}, {2, -4, 8});
  s.column<Charge>()[ion] = 2;
  Simulation<double> sim(s, compose(test::kinetic_potential(), schemes::verlet), 0.25);
  auto& monitor = sim.every(1, DipoleMoment{});
  REQUIRE(sim.run(40).ok());
  const double t = 10;
  CHECK(monitor.value()[0] == hook_moment[0] + 2 * (1 + 2 * t));
  CHECK(monitor.value()[1] == hook_moment[1] + 2 * (2 - 4 * t));
  CHECK(monitor.value()[2] == hook_moment[2] + 2 * (3 + 8 * t));
  CHECK(monitor.report().samples == 41);
  CHECK(monitor.series()[0].shape == std::vector<Index>{3});
  CHECK(*monitor.report().last == monitor.series()[1].values[0]);
}

TEST_CASE("a moment of 1 e nm is 48.0320471 debyes", "[dipole]") {
  // 1.602176634e-19 C times 1e-9 m over 1e-21/299792458 C m: 48.03204712570263 (CODATA 2018, exact).
  ParticleSystem<double> s(unit_system("molecular"));
  s.add_column<Charge>();
  s.add("plus", 1, {1, 0, 0}, {0, 0, 0});
  s.add("minus", 1, {0, 0, 0}, {0, 0, 0});
  s.column<Charge>()[0] = 1;
  s.column<Charge>()[1] = -1;
  CHECK(seen_at_start(s, DipoleMoment{}).report().note == "of |M|: mean 1 e nm, which is 48.032 D");
}

TEST_CASE("the dielectric constant of springs is the one of their polarizability, within bars that are right",
          "[dipole]") {
  // <M^2> - <M>^2 = 3 n q^2 kT/k, so epsilon = 1 + 4 pi n q^2/(k V) in units where C = 1, at any temperature.
  const double exact = 1 + 4 * std::numbers::pi * static_cast<double>(springs) * charge * charge / stiffness / 60000;
  constexpr int runs = 24;
  double squares = 0, mean = 0, worst = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    auto sim = dipoles_in_a_bath(seed);
    REQUIRE(sim.run(50).ok());
    auto& monitor = sim.every(1, at_kT());
    REQUIRE(sim.run(3000).ok());
    REQUIRE(monitor.error().has_value());
    const double z = (monitor.value() - exact) / *monitor.error();
    squares += z * z / runs;
    mean += (monitor.value() - exact) / (exact - 1) / runs;
    worst = std::max(worst, *monitor.error() / (exact - 1));
  }
  CAPTURE(squares, mean, worst);
  CHECK(worst < 0.08);   // the bars say something
  CHECK(squares > 0.5);  // and what they say: z^2 is 1 on the average, give or take sqrt(2/24)
  CHECK(squares < 2.0);  //
  CHECK(std::abs(mean) < 4 * worst / std::sqrt(runs));
}

TEST_CASE("the fluctuation counts about the mean of the moment", "[dipole]") {
  // Two looks at M = (3, 0, 4) m and M = (3, 0, -4) m with m of one hook's z: the mean is (3, 0, 0) m, <M^2> = 25 m^2.
  ParticleSystem<double> s;
  s.set_box(Box::periodic({10, 10, 20}));
  s.add_column<Charge>();
  s.add("plus", 1, {3, 0, 4}, {0, 0, -8});
  s.add("minus", 1, {0, 0, 0}, {0, 0, 0});
  s.column<Charge>()[0] = 1;
  s.column<Charge>()[1] = -1;
  auto topology = std::make_shared<Topology>();
  topology->bonds = {{{0, 1}, 0}};
  s.set_topology(topology);
  Simulation<double> sim(s, compose(test::kinetic_potential(), schemes::verlet), 1);
  auto& monitor = sim.every(1, at_kT());
  REQUIRE(sim.run(1).ok());
  CHECK(monitor.samples() == 2);
  CHECK(monitor.mean() == std::array<double, 3>{3, 0, 0});
  CHECK(std::abs(monitor.value() - (1 + 4 * std::numbers::pi * 16 / (3 * 2000 * thermal))) < 1e-15);
  CHECK_FALSE(monitor.error());
  CHECK(monitor.report().reason == "the error takes 20 looks");
}

TEST_CASE("the dielectric constant goes on from a saved run bit for bit", "[dipole][restart]") {
  auto whole = dipoles_in_a_bath(3), first = dipoles_in_a_bath(3), second = dipoles_in_a_bath(3);
  auto &all = whole.every(2, at_kT()), &later = second.every(2, at_kT());
  first.every(2, at_kT());
  auto &moments = whole.every(3, DipoleMoment{}), &later_moments = second.every(3, DipoleMoment{});
  first.every(3, DipoleMoment{});
  REQUIRE(whole.run(300).ok());
  REQUIRE(first.run(150).ok());
  second.restore(first.save());
  REQUIRE(second.run(150).ok());
  CHECK(all.samples() == 151);
  CHECK(all.value() == later.value());
  REQUIRE(all.error().has_value());
  CHECK(*all.error() == later.error());
  CHECK(all.report().note == later.report().note);
  CHECK(moments.report().note == later_moments.report().note);
}

TEST_CASE("dipole monitors do not depend on threads", "[dipole][determinism]") {
  const ParticleSystem<double> s = hooks({0.1, 0.2, 0.3});
  const auto value = [&](int threads) {
    const test::Threads with(threads);
    return seen_at_start(s, DipoleMoment{}).value();
  };
  CHECK(value(1) == value(3));
}

TEST_CASE("dipole monitors are refused where they mean nothing", "[dipole][messages]") {
  const auto refusal = [](const ParticleSystem<double>& s, const auto& asked) {
    return test::refusal_of([&] { seen_at_start(s, asked); });
  };
  ParticleSystem<double> none;
  none.add("a", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(refusal(none, DipoleMoment{}) ==
        "monitor 'dipole_moment' watches charges, but the particles have none; give charges, or take the monitor out");
  CHECK(refusal(none, at_kT()) ==
        "monitor 'dielectric_constant' watches charges, but the particles have none; give charges, or take the monitor "
        "out");
  CHECK(refusal(hooks({0, 0, 0}), DielectricConstant{}) ==
        "temperature = 0 is not a valid temperature; one above 0 is expected");
  CHECK(refusal(hooks({0, 0, 0}, Box::open()), at_kT()) ==
        "monitor 'dielectric_constant' needs a periodic box, because it divides by the volume; give the particles a "
        "box");
  ParticleSystem<double> salty = hooks({0, 0, 0});
  salty.column<Charge>()[salty.add("ion", 1, {1, 1, 1}, {0, 0, 0})] = 2;
  CHECK(refusal(salty, at_kT()) ==
        "monitor 'dielectric_constant' watches neutral molecules, but that of particle 'ion' has a charge of 2; bonds "
        "say which particles are a molecule");
  CHECK(refusal(hooks({0, 0, 0}), at_kT()).empty());
}

}  // namespace noether
