/// Coulomb's law in open space: closed forms, lanes against 113 bits, what the topology leaves of a pair.

#include "forces/coulomb.hpp"
#include "forces/check_gradient.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <random>
#include <utility>

namespace noether {
namespace {

/// Charges of both signs anywhere in a ball of open space, some of them 0, one of them on a tracer.
ParticleSystem<double> cloud(Index n) {
  ParticleSystem<double> s(unit_system("molecular"));
  std::mt19937_64 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; };
  for (Index i = 0; i < n; ++i) {
    const Vec3<double> x(uniform(), uniform(), uniform());
    s.add("", i == 5 ? 0.0 : 2.0 + uniform(), std::cbrt(static_cast<double>(n)) / 4 * x, {0, 0, 0});
  }
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < n; ++i) q[i] = i % 11 == 3 ? 0.0 : uniform();
  return s;
}

/// The same with pairs that are left out or scaled, within blocks of the loop and across them.
ParticleSystem<double> bonded_cloud(Index n) {
  ParticleSystem<double> s = cloud(n);
  auto topology = std::make_shared<Topology>();
  topology->exclusions = {{0, 1}, {0, 2}, {1, 2}, {2, n - 1}, {7, 70}};
  topology->scaled_pairs = {{{0, 3}, 0.5}, {{1, 3}, 0.0}, {{4, n - 2}, 0.25}};
  s.set_topology(topology);
  return s;
}

/// U as it stands in books, pair by pair in 113 bits.
Quad energy_of(const ParticleSystem<double>& narrow) {
  const ParticleSystem<Quad> s = narrow.as<Quad>();
  Quad sum(0);
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const Quad part(s.topology() != nullptr ? s.topology()->pair_factor(i, j) : 1);
      const Quad product = Quad(s.units().coulomb_constant) * s.column<Charge>()[i] * s.column<Charge>()[j];
      sum += part * product / sqrt(norm2(Vec3<Quad>(s.positions()[i] - s.positions()[j])));
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("two charges feel Coulomb's law at any distance", "[coulomb]") {
  ParticleSystem<double> s(unit_system("molecular"));
  s.add("Na", 22.99, {0, 0, 0}, {0, 0, 0});
  s.add("Cl", 35.45, {0, 0, 0}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1;
  s.column<Charge>()[1] = -1;
  const double c = s.units().coulomb_constant;
  for (const double r : {1e-6, 0.05, 0.5, 1e6}) {
    s.positions().set(1, {r, 0, 0});
    const test::Evaluated all = test::evaluated<double>(Coulomb{}, s);
    REQUIRE_FALSE(all.failure);
    CHECK(std::abs(all.energy / (-c / r) - 1) <= 4e-16);
    CHECK(std::abs(22.99 * all.a.component(0)[0] / (c / (r * r)) - 1) <= 1e-15);
    CHECK(std::abs(35.45 * all.a.component(0)[1] / (-c / (r * r)) - 1) <= 1e-15);
    CHECK(std::abs(all.virial(0, 0) / all.energy - 1) <= 1e-15);
  }
}

TEST_CASE("a cloud of charges has the energy of its pairs, and lanes give the forces of 113 bits", "[coulomb]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const auto& s : {cloud(9), cloud(130), bonded_cloud(9 + 64), bonded_cloud(300)}) {
      CAPTURE(name(level), s.size());
      const test::Evaluated lanes = test::evaluated<double>(Coulomb{}, s), exact = test::evaluated<Quad>(Coulomb{}, s);
      const double largest = exact.a.all().cwiseAbs().maxCoeff();
      CHECK(test::largest_difference(lanes.a, exact.a) < 1e-13 * largest);
      const double scale = s.units().coulomb_constant * static_cast<double>(s.size());
      CHECK(std::abs(exact.energy - static_cast<double>(energy_of(s))) < 1e-15 * scale);
      CHECK(std::abs(lanes.energy - exact.energy) < 1e-14 * scale);
      CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-14 * scale);
      CHECK(std::abs(lanes.virial.trace() - lanes.energy) < 1e-14 * scale);  // of degree -1
      for (int k = 0; k < 3; ++k) {
        CHECK(lanes.a.component(k)[5] == 0);  // the tracer
        CHECK(lanes.a.component(k)[3] == 0);  // without charge
      }
    }
  }
}

TEST_CASE("Coulomb's force is the gradient of its energy, also over dual numbers and in lanes of stages", "[coulomb]") {
  const ParticleSystem<double> s = bonded_cloud(80);
  CHECK(gradient_error(Coulomb{}, s) < 1e-18);
  const AnyForce<double> force = Coulomb{};
  CHECK(force.has_derivative());
  REQUIRE(force.has_lanes());
  const ParticleSystem<Pack> eight = s.as<Pack>();
  VectorColumn<Pack> a(s.size());
  ForceSink<Pack> out(a, eight, {});
  force.add_to(out, eight);
  const test::AtLevel at(SimdLevel::base);
  const test::Evaluated one = test::evaluated<double>(Coulomb{}, s);
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) REQUIRE(a.component(k)[i].lane[6] == one.a.component(k)[i]);
  }
}

TEST_CASE("bits of Coulomb's law depend on no thread, and not on who asks for energies", "[coulomb][determinism]") {
  const ParticleSystem<double> s = bonded_cloud(500);
  const test::Evaluated first = test::evaluated<double>(Coulomb{}, s);
  for (const int threads : {1, 2, 3, 8}) {
    const test::Threads now(threads);
    const test::Evaluated again = test::evaluated<double>(Coulomb{}, s);
    CHECK(again.a.all() == first.a.all());
    CHECK(again.energy == first.energy);
    CHECK(again.virial == first.virial);
    VectorColumn<double> a(s.size());
    ForceSink<double> forces_only(a, s, {});
    Coulomb{}.add_to(forces_only, s);
    CHECK(a.all() == first.a.all());
  }
}

TEST_CASE("Coulomb's law needs charges, and open space", "[coulomb][messages]") {
  const auto refusal = [](const ParticleSystem<double>& s) {
    return test::refusal_of([&] { AnyForce<double>(Coulomb{}).check(s); });
  };
  CHECK(refusal(cloud(10)).empty());
  CHECK(refusal(test::liquid(1, 0.5, 1)) ==
        "the force 'coulomb' does not support a periodic box; take out the force or the box");
  ParticleSystem<double> neutral;
  neutral.add("one", 1, {0, 0, 0}, {0, 0, 0});
  CHECK(refusal(neutral) ==
        "force 'coulomb' acts between charges, but the particles have none; give charges, or take the force out");
}

}  // namespace noether
