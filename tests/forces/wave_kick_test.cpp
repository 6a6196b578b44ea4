/// Sums over a lattice of charges whose waves have kicks of their own: both parts are the whole, what is excluded is
/// with the waves, and cost is told apart.

#include "engine/simulation.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "numbers/cost_book.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <string>

namespace noether {
namespace {

using Catch::Matchers::Contains;

/// What the kicks of one letter, or all of them (0), do to particles.
struct Pull {
  VectorColumn<double> a;
  double energy;
  Mat3<double> virial;
};
Pull part_of(const AnyForce<double>& force, const ParticleSystem<double>& s, char letter) {
  Pull part{VectorColumn<double>(s.size()), 0, {}};
  ForceSink<double> sink(part.a, s, {.energy = true, .virial = true});
  if (letter != 0) sink.set_kick_letter(letter);
  force.add_to(sink, s);
  part.energy = sink.potential();
  part.virial = sink.virial();
  return part;
}

void check_parts(const AnyForce<double>& parted, const AnyForce<double>& together, const ParticleSystem<double>& s) {
  CHECK(parted.claims().kicks == "BC");
  const Pull whole = part_of(together, s, 0), all = part_of(parted, s, 0);
  CHECK(whole.a.all() == all.a.all());
  CHECK(whole.energy == all.energy);
  Pull near = part_of(parted, s, 'B');
  const Pull waves = part_of(parted, s, 'C');
  CHECK(near.a.all().norm() > 0.1 * whole.a.all().norm());
  CHECK(waves.a.all().norm() > 0.001 * whole.a.all().norm());
  near.a.add_scaled(1, waves.a);
  CHECK((near.a.all() - whole.a.all()).norm() < 1e-14 * whole.a.all().norm());
  CHECK(std::abs(near.energy + waves.energy - whole.energy) < 1e-13 * std::abs(near.energy));
  CHECK((near.virial + waves.virial - whole.virial).norm() < 1e-13 * near.virial.norm());
}

/// Two charges at a distance, a pair that the topology excludes or not, in a large box.
ParticleSystem<double> bond(double r, bool excluded) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({8, 8, 8}));
  s.add("plus", 1, {4 + r, 4, 4}, {0, 0, 0});
  s.add("minus", 1, {4, 4, 4}, {0, 0, 0});
  auto& q = s.add_column<Charge>();
  q[0] = 1;
  q[1] = -1;
  auto topology = std::make_shared<Topology>();
  if (excluded) topology->exclusions = {{0, 1}};
  s.set_topology(topology);
  return s;
}

}  // namespace

TEST_CASE("near part and waves in kicks of their own are the whole sum", "[ewald][mesh][respa]") {
  const auto s = test::with_special_pairs(test::charged_liquid(2, 0.5));
  check_parts(Ewald{.cutoff = 2, .wave_kick = "C"}, Ewald{.cutoff = 2}, s);
  check_parts(ParticleMeshEwald{.cutoff = 2, .wave_kick = "C"}, ParticleMeshEwald{.cutoff = 2}, s);
  AnyForce<double> both_slow = ParticleMeshEwald{.cutoff = 2, .wave_kick = "D"};
  both_slow.in_kick('C');
  CHECK(both_slow.claims().kicks == "CD");
  CHECK(part_of(both_slow, s, 'C').a.all() ==
        part_of(ParticleMeshEwald{.cutoff = 2, .wave_kick = "C"}, s, 'B').a.all());
  CHECK(both_slow.in_quad()->claims().kicks == "CD");
}

TEST_CASE("the waves of an excluded pair are the field of its images, and change little with its bond",
          "[ewald][mesh][respa]") {
  // A dipole p in a cubic lattice within a conductor feels the field 4 pi p / 3 V of all others (Lorentz), to (r/L)^2.
  const AnyForce<double> sums[] = {Ewald{.cutoff = 2, .relative_error = 1e-9, .wave_kick = "C"},
                                   ParticleMeshEwald{.cutoff = 2, .relative_error = 1e-6, .wave_kick = "C"}};
  for (const AnyForce<double>& sum : sums) {
    CAPTURE(sum.name());
    const auto pull = [&](double r, bool excluded) { return part_of(sum, bond(r, excluded), 'C').a[0][0]; };
    CHECK(std::abs(pull(0.3, true) / (4 * M_PI / 3 * 0.3 / 512) - 1) < 0.02);
    const double stretched = pull(0.33, true) - pull(0.3, true), alone = pull(0.33, false) - pull(0.3, false);
    CHECK(std::abs(alone) > 100 * std::abs(stretched));
    const Pull near = part_of(sum, bond(0.3, true), 'B');
    CHECK(near.a.all().norm() == 0);
  }
}

TEST_CASE("a mesh seldom kicked goes its way to second order, and on after any step", "[mesh][respa]") {
  const ParticleMeshEwald sum{.cutoff = 2, .relative_error = 1e-6, .wave_kick = "C"};
  const auto run_of = [&](double h, std::int64_t inner) {
    return Simulation(test::charged_liquid(2),
                      compose(test::kinetic_potential(sum), schemes::respa, {.inner_steps = {inner}}), h);
  };
  const auto end = [&](double h) {
    auto run = run_of(h, 2);
    REQUIRE(run.run(std::lround(0.04 / h)).ok());
    return run.particles();
  };
  const auto apart = [](const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
    return (a.velocities().all() - b.velocities().all()).norm();
  };
  const auto coarse = end(0.004), middle = end(0.002), fine = end(0.001);
  CHECK(std::abs(std::log2(apart(coarse, middle) / apart(middle, fine)) - 2) < 0.2);
  auto first = run_of(0.002, 2), second = run_of(0.002, 2);
  REQUIRE(first.run(7).ok());
  second.restore(first.save());
  REQUIRE(second.run(13).ok());
  CHECK(test::same_bits(second.particles(), middle));
}

TEST_CASE("cost is told of the waves and of the near part", "[mesh][cost_book]") {
  const auto s = test::charged_liquid(2);
  for (const bool mesh : {true, false}) {
    ForceField<double> field;
    if (mesh) {
      field.add(ParticleMeshEwald{.cutoff = 2});
    } else {
      field.add(Ewald{.cutoff = 2});
    }
    const std::string name = field.terms().front().name();
    VectorColumn<double> a(s.size());
    const CostBook book;
    ForceSink<double> sink(a, s, {});
    field.add_to(sink, s);
    double near = 0, waves = 0;
    for (const CostBook::Entry& entry : book.entries()) {
      if (entry.kind == "force" && entry.name == name) near = entry.seconds;
      if (entry.kind == "force" && entry.name == name + " waves") waves = entry.seconds;
    }
    CAPTURE(name, near, waves);
    CHECK(near > 0);
    CHECK(waves > 0);
  }
}

TEST_CASE("waves are refused in kicks that are not slower than those of the near part", "[ewald][mesh][respa]") {
  const auto s = test::charged_liquid(1);
  for (const char* letter : {"B", "A", "c", "CD", ""}) {
    CAPTURE(letter);
    CHECK_THROWS_WITH((ParticleMeshEwald{.cutoff = 2, .wave_kick = letter}.check(s)),
                      Contains("wave_kick = \"" + std::string(letter) + "\" is not a letter of slow kicks"));
    CHECK_THROWS_WITH((Ewald{.cutoff = 2, .wave_kick = letter}.check(s)), Contains("is not a letter of slow kicks"));
  }
  AnyForce<double> sum = ParticleMeshEwald{.cutoff = 2, .wave_kick = "C"};
  CHECK_THROWS_WITH(sum.in_kick('C'),
                    "kick = \"C\" is already that of another part of particle_mesh_ewald; take one of the two out");
}

}  // namespace noether
