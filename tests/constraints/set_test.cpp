#include "constraints/angle.hpp"
#include "constraints/rigid_bar.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/damped.hpp"
#include "monitors/temperature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/refusal.hpp"

namespace noether {
namespace {

using namespace noether::test;

ParticleSystem<double> particles_at(const std::vector<Vec3<double>>& places) {
  ParticleSystem<double> s;
  for (std::size_t k = 0; k < places.size(); ++k) {
    s.add(std::string(1, static_cast<char>('a' + static_cast<int>(k))), 1, places[k], {0, 0, 0});
  }
  return s;
}

/// What binding an integrator to particles says of their constraints; empty if it is content.
std::string refusal(ParticleSystem<double> s, const ConstraintSet& set) {
  try {
    ConstraintSolver<double>(set).bind(s);
  } catch (const BadConstraints& error) {
    return error.message();
  }
  return "";
}

TEST_CASE("a constraint is refused where it is added: tracers, one particle twice, none, no length",
          "[constraints][refusal]") {
  auto s = particles_at({{0, 0, 0}, {1, 0, 0}});
  s.add("dust", 0, {2, 0, 0}, {0, 0, 0});
  ConstraintSet set;
  CHECK(refusal_of([&] {
          set.add(s, Distance{}, {0, 2});
        }) == "distance ties 'dust', a tracer of mass 0, which no force can hold; give it a mass");
  CHECK(refusal_of([&] {
          set.add(s, Distance{}, {1, 1});
        }) == "distance ties 'b' to itself; different particles are expected");
  CHECK(refusal_of([&] { set.add(s, Distance{}, {0, 7}); }) == "distance names particle 7, but there are 3");
  CHECK(refusal_of([&] {
          set.add(s, Distance{0}, {0, 1});
        }) == "length = 0 is not a valid length of a bar; a length above 0 is expected");
  CHECK(refusal_of([&] { set.add(s, Distance{-1}, {0, 1}); }) != "");
  CHECK(refusal_of([&] { set.add(particles_at({{1, 1, 1}, {1, 1, 1}}), Distance{}, {0, 1}); }) != "");
  CHECK(refusal_of([&] { set.add(s, Angle{4}, {0, 1, 0}); }) != "");
  CHECK(refusal_of([&] {
          set.add(s, OnPlane{.normal = {0, 0, 0}}, {0});
        }) == "normal = [0, 0, 0] has no direction; a vector other than 0 is expected");
  CHECK(refusal_of([&] { add_rigid_bar(set, s, {0}); }) == "a rigid bar ties 2 or more particles, not 1");
  CHECK(set.empty());
}

TEST_CASE("a start that violates a constraint names the worst one; a printed table's digits are moved into place",
          "[constraints][refusal]") {
  const auto s = particles_at({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  ConstraintSet set;
  set.add(s, Distance{1.001}, {0, 1}).add(s, Distance{1.2}, {1, 2});
  CHECK(refusal(s, set) ==
        "distance of 'b' and 'c' is violated at the start, by 0.167 of its scale; only up to 1e-06 is corrected");
  ConstraintSet near;
  near.add(s, Distance{1 + 3e-8}, {0, 1});
  auto moved = s;
  ConstraintSolver<double>(near).bind(moved);
  CHECK(near.worst(moved).residual < 4 * 0x1p-53);
  // Both ends by the same way, as their masses are equal.
  CHECK(std::fabs(moved.positions()[0][0] + 1.5e-8) < 1e-15);
  CHECK(std::fabs(moved.positions()[1][0] - 1 - 1.5e-8) < 1e-15);
}

TEST_CASE("constraints that depend on each other are found at the start and named", "[constraints][refusal]") {
  const auto line = particles_at({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  SECTION("the same bar twice") {
    ConstraintSet set;
    set.add(line, Distance{}, {0, 1}).add(line, Distance{}, {0, 1});
    CHECK(refusal(line, set) == "constraints depend on each other: distance of 'a' and 'b'; take one out");
  }
  SECTION("three bars between particles in line") {
    ConstraintSet set;
    set.add(line, Distance{}, {0, 1}).add(line, Distance{}, {1, 2}).add(line, Distance{}, {0, 2});
    const std::string message = refusal(line, set);
    CHECK(message.starts_with("constraints depend on each other: "));
    CHECK(message.find("distance of 'a' and 'c'") != std::string::npos);
  }
  SECTION("an angle of particles in line has no gradient") {
    ConstraintSet set;
    set.add(line, Distance{}, {0, 1}).add(line, Distance{}, {1, 2});
    CHECK(refusal_of([&] {
            set.add(line, Angle{}, {0, 1, 2});
          }) != "");  // 180 degrees is no angle that forces can keep
    auto bent = line;
    bent.positions().set(2, {1 + std::sqrt(0.5), std::sqrt(0.5), 0});
    ConstraintSet kept;
    kept.add(bent, Distance{}, {0, 1}).add(bent, Distance{}, {1, 2}).add(bent, Angle{}, {0, 1, 2});
    CHECK(refusal(bent, kept) == "");
  }
  SECTION("a flat ring of five with all distances") {
    std::vector<Vec3<double>> places;
    for (int k = 0; k < 5; ++k) places.emplace_back(std::cos(0.4 * M_PI * k), std::sin(0.4 * M_PI * k), 0);
    const auto ring = particles_at(places);
    ConstraintSet set;
    for (Index i = 0; i < 5; ++i) set.add(ring, Distance{}, {i, (i + 1) % 5}).add(ring, Distance{}, {i, (i + 2) % 5});
    CHECK(refusal(ring, set).starts_with("constraints depend on each other: "));
  }
  SECTION("fixed ends of a bar") {
    ConstraintSet set;
    set.add(line, Fixed{}, {0}).add(line, Fixed{}, {1}).add(line, Distance{}, {0, 1});
    CHECK(refusal(line, set).find("fixed of 'a'") != std::string::npos);
  }
  SECTION("thousands of them: one is named at least") {
    ConstraintSet set;
    std::vector<Vec3<double>> places;
    ParticleSystem<double> many;
    for (Index i = 0; i < 2000; ++i) many.add(std::to_string(i), 1, {0.5 * static_cast<double>(i), 0, 0}, {0, 0, 0});
    for (Index i = 0; i + 1 < 2000; ++i) set.add(many, Distance{}, {i, i + 1});
    set.add(many, Distance{}, {700, 702});
    CHECK(refusal(many, set).starts_with("constraints depend on each other: distance of '70"));
  }
}

TEST_CASE("a rigid bar holds particles in line, which distances cannot", "[constraints]") {
  ParticleSystem<double> s;
  s.add("left", 16, {-1.1, 0, 0}, {0.1, 0.3, 0});
  s.add("carbon", 12, {0.2, 0, 0}, {0, -0.4, 0.2});
  s.add("right", 16, {1.2, 0, 0}, {-0.1, 0.2, -0.3});
  ConstraintSet bar;
  add_rigid_bar(bar, s, {0, 1, 2});
  CHECK(bar.equations() == 4);
  Simulation<double> sim(s, compose(kinetic_potential_over(field_of(Gravity{.G = 0.2}), bar), schemes::verlet), 0.05);
  REQUIRE(sim.run(2000).ok());
  CHECK(bar.worst(sim.particles()).residual < 16 * 0x1p-53);
  const Vec3<double> a = sim.particles().positions()[0], b = sim.particles().positions()[1],
                     c = sim.particles().positions()[2];
  CHECK(std::fabs(std::sqrt(norm2(Vec3<double>(c - a))) - 2.3) < 1e-14);
  CHECK(std::fabs(std::sqrt(norm2(Vec3<double>(b - a))) - 1.3) < 1e-14);
  auto askew = s;
  askew.positions().set(1, {0.2, 0.01, 0});
  ConstraintSet wrong;
  add_rigid_bar(wrong, askew, {0, 1, 2});
  CHECK(refusal(askew, wrong).starts_with("on_bar of 'left', 'carbon' and 'right' is violated at the start"));
}

TEST_CASE("schemes that need exact drifts are refused by name, and so are sums with compensation",
          "[constraints][refusal]") {
  const Mechanism pendulum = double_pendulum();
  for (const Scheme* scheme : schemes::all()) {
    INFO(scheme->name);
    const bool composed = scheme->exact.find('A') == std::string_view::npos;
    const std::string message = refusal_of([&] { compose(hamiltonian_of(pendulum), *scheme); });
    if (composed) CHECK(message == "");
    if (!composed) {
      CHECK(message.starts_with("scheme '" + std::string(scheme->name) +
                                "' needs exact flows, but part A of 'kinetic_potential' with constraints"));
    }
  }
  CHECK(refusal_of([&] { compose(hamiltonian_of(pendulum), word("ABA")); }) != "");
  CHECK(refusal_of([&] { compose(hamiltonian_of(pendulum), word("BAB")); }) == "");
  CHECK(refusal_of([&] {
          Simulation<double> sim(pendulum.particles,
                                 compose(hamiltonian_of(pendulum), schemes::verlet, {.compensated = true}), 0.01);
        }).find("compensated") != std::string::npos);
}

TEST_CASE("velocities are projected along the constraints at the start, by the least change of kinetic energy",
          "[constraints]") {
  const Mechanism chain = free_chain(5);
  auto s = chain.particles;
  const auto before = s;
  ConstraintSolver<double>(chain.constraints).bind(s);
  CHECK(velocity_across(chain.constraints, before) > 0.1);
  CHECK(velocity_across(chain.constraints, s) < 4 * 0x1p-53);
  // The change is across every velocity along the constraints: T(before) = T(after) + T(change).
  double all = 0, kept = 0, change = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const double m = s.masses()[i];
    const Vec3<double> v0 = before.velocities()[i], v1 = std::as_const(s).velocities()[i];
    all += m * norm2(v0);
    kept += m * norm2(v1);
    change += m * norm2(Vec3<double>(v0 - v1));
  }
  CHECK(std::fabs(all - kept - change) < 1e-15);
  CHECK(change > 0.01);
  auto again = s;
  ConstraintSolver<double>(chain.constraints).bind(again);
  CHECK(distance_of_states(again, s) == 0);
}

TEST_CASE("temperature counts the degrees of freedom that are left", "[constraints][temperature]") {
  const Mechanism chain = free_chain(5);
  const auto temperature_of = [](auto integrator, const ParticleSystem<double>& s) {
    Simulation<double> sim(s, std::move(integrator), 0.01);
    auto& temperature = sim.every(1, Temperature{});
    REQUIRE(sim.run(1).ok());
    return std::pair{temperature.degrees_of_freedom(), temperature.report().first.value()};
  };
  // 5 particles, 4 bars, and no external force: 15 - 4 - 3.
  const auto [free, T] = temperature_of(
      compose(kinetic_potential_over(field_of(Gravity{}), chain.constraints), schemes::verlet), chain.particles);
  CHECK(free == 8);
  auto s = chain.particles;
  ConstraintSolver<double>(chain.constraints).bind(s);
  Vec3<double> momentum = Vec3<double>::Zero();
  double twice = 0, mass = 0;
  for (Index i = 0; i < 5; ++i) {
    momentum += s.masses()[i] * s.velocities()[i];
    twice += s.masses()[i] * norm2(Vec3<double>(s.velocities()[i]));
    mass += s.masses()[i];
  }
  CHECK(std::fabs(T - (twice - norm2(momentum) / mass) / 8) < 1e-15);
  // Under its weight momentum is not kept, and its motion counts; so does a tracer's not.
  auto with_dust = chain.particles;
  with_dust.add("dust", 0, {9, 9, 9}, {5, 5, 5});
  CHECK(temperature_of(compose(kinetic_potential_over(field_of(weight), chain.constraints), schemes::verlet), with_dust)
            .first == 11);
  CHECK(temperature_of(compose(kinetic_potential(Gravity{}), schemes::verlet), with_dust).first == 12);
  CHECK(
      temperature_of(compose(hamiltonian_of(double_pendulum()), schemes::verlet), double_pendulum().particles).first ==
      4);
}

TEST_CASE("constraints stay with their particles when others are taken out of a run", "[constraints][set]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("free", 1, Vec3<double>(9, 9, 9), Vec3<double>::Zero());
  s.add("a", 1, Vec3<double>(0, 0, 0), Vec3<double>(0, 1, 0));
  s.add("b", 1, Vec3<double>(1, 0, 0), Vec3<double>(0, -1, 0));
  ConstraintSet bar;
  bar.add(s, Distance{}, {1, 2});
  Simulation sim(s, compose(KineticPotential(UniformField{{0, 0, -1}}, bar), schemes::verlet), 0.01);
  REQUIRE(sim.run(20).ok());
  sim.edit([](ParticleSystem<double>& all) { all.remove(0); });
  REQUIRE(sim.run(20).ok());
  const auto& x = sim.particles().positions();
  CHECK(std::abs(std::sqrt(norm2(Vec3<double>(x[1] - x[0]))) - 1) < 1e-13);
  CHECK_THROWS_WITH(sim.edit([](ParticleSystem<double>& all) { all.remove(0); }),
                    Catch::Contains("the particle with id 1 is tied"));
}

TEST_CASE("a run goes on with the same constraints only", "[constraints][restart]") {
  const Mechanism one = hanging_chain(4), other = hanging_chain(4, {.solver = ConstraintMethod::rattle});
  Simulation<double> sim(one.particles, compose(hamiltonian_of(one), schemes::verlet), 0.01);
  REQUIRE(sim.run(10).ok());
  Simulation<double> with_sweeps(other.particles, compose(hamiltonian_of(other), schemes::verlet), 0.01);
  CHECK(refusal_of([&] { with_sweeps.restore(sim.save()); }).find("solver = 1") != std::string::npos);
  Mechanism longer = hanging_chain(4);
  longer.constraints.add(longer.particles, Distance{}, {0, 2});
  Simulation<double> stiffer(longer.particles, compose(hamiltonian_of(longer), schemes::verlet), 0.01);
  CHECK(refusal_of([&] { stiffer.restore(sim.save()); }) != "");
}

}  // namespace
}  // namespace noether
