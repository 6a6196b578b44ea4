// g(r): against a count of all pairs, a lattice's shells, an ideal gas, and what must not change it.

#include "monitors/radial_distribution.hpp"

#include "engine/simulation.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace noether {
namespace {

Simulation<double> still(const ParticleSystem<double>& s) {
  return Simulation<double>(s, compose(test::kinetic_potential(), schemes::verlet), 0.005);
}

RadialDistribution observed(const ParticleSystem<double>& s, const RadialDistribution& asked) {
  auto sim = still(s);
  auto& g = sim.every(1, asked);
  REQUIRE(sim.run(0).ok());
  return g;
}

/// Pairs by interval, each from both sides, by asking all of them.
std::vector<std::int64_t> all_pairs(const ParticleSystem<double>& s, double range, std::int64_t bins, int a = -1,
                                    int b = -1) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(bins));
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < s.size(); ++j) {
      if (i == j || (a >= 0 && (s.topology()->type(i) != a || s.topology()->type(j) != b))) continue;
      const Vec3<double> d = s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j]));
      const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      if (r2 < range * range) ++counts[static_cast<std::size_t>(std::sqrt(r2) / (range / static_cast<double>(bins)))];
    }
  }
  return counts;
}

/// Particles anywhere in a box of unequal edges; every third of another type.
ParticleSystem<double> mixed_gas(Index n) {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({3, 4.5, 6.7}));
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"A", "B"};
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  for (Index i = 0; i < n; ++i) {
    s.add("", 1, {3 * uniform(), 4.5 * uniform(), 6.7 * uniform()}, {0, 0, 0});
    topology->types.push_back(i % 3 == 0 ? 1 : 0);
  }
  s.set_topology(topology);
  return s;
}

}  // namespace

TEST_CASE("pairs in cells are the pairs of all with all, one by one", "[radial_distribution]") {
  const ParticleSystem<double> s = mixed_gas(400);
  for (const double range : {0.3, 0.9, 1.5}) {
    for (const std::int64_t bins : {1, 50, 3000}) {
      CAPTURE(range, bins);
      CHECK(observed(s, RadialDistribution(bins, range)).counts() == all_pairs(s, range, bins));
    }
  }
  CHECK(observed(s, RadialDistribution(40)).counts() == all_pairs(s, 1.5, 40));
  CHECK(observed(s, RadialDistribution(40, {}, {"A", "B"})).counts() == all_pairs(s, 1.5, 40, 0, 1));
  CHECK(observed(s, RadialDistribution(40, {}, {"B", "B"})).counts() == all_pairs(s, 1.5, 40, 1, 1));
  const ParticleSystem<double> liquid = test::liquid(4, 0.8442, 1, 0.1);
  CHECK(observed(liquid, RadialDistribution(100, 2.5)).counts() == all_pairs(liquid, 2.5, 100));
}

TEST_CASE("a lattice has its shells, and their numbers of neighbors", "[radial_distribution]") {
  // Face-centred: 12 neighbors at 1/sqrt(2) of the cell's edge, 6 at 1, 24 at sqrt(3/2), 12 at sqrt(2).
  const ParticleSystem<double> s = test::liquid(4, 4, 1);
  const RadialDistribution g = observed(s, RadialDistribution(150, 1.5));
  std::vector<std::int64_t> expected(150);
  const double n = 256;
  for (const auto& [distance, neighbors] : {std::pair{std::sqrt(0.5), 12}, std::pair{1.00001, 6},
                                            std::pair{std::sqrt(1.5), 24}, std::pair{std::sqrt(2.0), 12}}) {
    expected[static_cast<std::size_t>(distance * 100)] += neighbors * 256;
  }
  // A distance of exactly 1 may be rounded to either side of its boundary.
  std::vector<std::int64_t> found = g.counts();
  found[100] += std::exchange(found[99], 0);
  CHECK(found == expected);
  CHECK(g.coordination()[80] == 12);
  CHECK(g.coordination()[110] == 18);
  CHECK(g.coordination()[149] == 54);
  // g = n_k / (N (N - 1) / V times the volume of the shell), with N / V = 4.
  const double shell = 4 * std::numbers::pi / 3 * (std::pow(0.71, 3) - std::pow(0.70, 3));
  CHECK(std::abs(g.values()[70] / (12 / (4 * (n - 1) / n * shell)) - 1) < 1e-13);
  CHECK(g.distance(70) == 0.705);
}

TEST_CASE("an ideal gas has g = 1, for pairs of one type, of two, and of all", "[radial_distribution]") {
  const ParticleSystem<double> s = mixed_gas(3000);
  for (const std::vector<std::string>& types :
       {std::vector<std::string>{}, std::vector<std::string>{"A", "B"}, std::vector<std::string>{"B", "B"}}) {
    const RadialDistribution g = observed(s, RadialDistribution(5, {}, types));
    for (std::size_t k = 1; k < 5; ++k) {
      CAPTURE(k, types.size());
      // Counts scatter by their roots; pairs from both sides are the same pairs.
      CHECK(std::abs(g.values()[k] - 1) < 4 * std::sqrt(2 / static_cast<double>(g.counts()[k])));
    }
  }
}

TEST_CASE("each type of a crystal has its own shells, and those of all types add up to the total",
          "[radial_distribution]") {
  // Rock salt, 1 apart: 6 of the other type at 1 and 8 at sqrt(3); 12 of the same at sqrt(2), 6 at 2.
  ParticleSystem<double> s;
  s.set_box(Box::periodic({6, 6, 6}));
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"Na", "Cl"};
  for (int k = 0; k < 216; ++k) {
    const int x = k % 6, y = k / 6 % 6, z = k / 36;
    s.add("", 1, {1.0 * x, 1.0 * y, 1.0 * z}, {0, 0, 0});
    topology->types.push_back((x + y + z) % 2);
  }
  s.set_topology(topology);
  const auto counts = [&](const std::vector<std::string>& types) {
    return observed(s, RadialDistribution(21, 2.1, types)).counts();
  };
  const auto all = counts({}), same = counts({"Na", "Na"}), chlorine = counts({"Cl", "Cl"}),
             other = counts({"Na", "Cl"});
  std::vector<std::int64_t> of_same(21), of_other(21);
  of_same[14] = 12 * 108;
  of_same[20] = 6 * 108;
  of_other[10] = 6 * 108;
  of_other[17] = 8 * 108;
  CHECK(same == of_same);
  CHECK(chlorine == of_same);
  CHECK(other == of_other);
  CHECK(counts({"Cl", "Na"}) == of_other);
  for (std::size_t k = 0; k < 21; ++k) CHECK(all[k] == same[k] + chlorine[k] + 2 * other[k]);
  // Of g the sum is weighted by pairs.
  const auto g = [&](const std::vector<std::string>& types) {
    return observed(s, RadialDistribution(21, 2.1, types)).values();
  };
  const double total = 216 * 215, pairs = 108 * 107, mixed = 108 * 108;
  for (const std::size_t k : {std::size_t(10), std::size_t(14)}) {
    const double sum = (pairs * (g({"Na", "Na"})[k] + g({"Cl", "Cl"})[k]) + 2 * mixed * g({"Na", "Cl"})[k]) / total;
    CHECK(std::abs(g({})[k] / sum - 1) < 1e-14);
  }
}

TEST_CASE("pairs of one molecule can be left out, and then count nowhere", "[radial_distribution]") {
  // An ideal gas of bent molecules B A A, 0.4 from atom to atom.
  ParticleSystem<double> s = mixed_gas(3000);
  auto bonded = std::make_shared<Topology>(*s.topology()), named = std::make_shared<Topology>(*s.topology());
  for (Index i = 0; i < 3000; i += 3) {
    const Vec3<double> first = s.positions()[i];
    s.positions().set(i + 1, Vec3<double>(first + Vec3<double>(0.4, 0, 0)));
    s.positions().set(i + 2, Vec3<double>(first + Vec3<double>(0.4, 0.24, 0.32)));
    bonded->bonds.push_back({{i, i + 1}, 0});
    bonded->bonds.push_back({{i + 2, i + 1}, 0});
    for (int k = 0; k < 3; ++k) named->molecules.push_back(i + 7);
  }
  s.wrap();
  std::vector<std::int64_t> alone(3000);
  for (const auto& topology : {bonded, named}) {
    s.set_topology(topology);
    for (const std::vector<std::string>& types :
         {std::vector<std::string>{}, std::vector<std::string>{"A", "B"}, std::vector<std::string>{"A", "A"}}) {
      const RadialDistribution all = observed(s, RadialDistribution(15, 1.5, types));
      const RadialDistribution between = observed(s, RadialDistribution(15, 1.5, types, false));
      // 0.4 twice, and the root of 0.4^2 + 0.24^2 + 0.32^2 once; bonds may be rounded to either side of 0.4.
      const std::int64_t bonds = types.empty() ? 4000 : 1000 * (types[1] == "B" ? 1 : 2);
      const std::int64_t ends = types.size() == 2 && types[1] == "A" ? 0 : types.empty() ? 2000 : 1000;
      CAPTURE(types.size(), bonds, ends);
      CHECK(all.counts()[3] + all.counts()[4] - between.counts()[3] - between.counts()[4] == bonds);
      CHECK(all.counts()[5] + all.counts()[6] + all.counts()[7] - between.counts()[5] - between.counts()[6] -
                between.counts()[7] ==
            ends);
      for (const std::size_t k : {0U, 1U, 2U, 8U, 9U, 10U, 14U}) CHECK(all.counts()[k] == between.counts()[k]);
      for (std::size_t k = 2; k < 15; ++k) {
        // Pairs of the same two molecules are at similar distances: up to nine are one event.
        CHECK(std::abs(between.values()[k] - 1) < 4 * std::sqrt(18 / static_cast<double>(between.counts()[k])));
      }
    }
  }
  // Molecule 0 is none.
  auto nobody = std::make_shared<Topology>(*named);
  nobody->molecules = alone;
  nobody->molecules.back() = 7;
  s.set_topology(nobody);
  CHECK(observed(s, RadialDistribution(15, 1.5, {}, false)).counts() ==
        observed(s, RadialDistribution(15, 1.5)).counts());
}

TEST_CASE("g(r) is averaged over the samples, and goes on from a saved run bit for bit",
          "[radial_distribution][restart]") {
  const auto make = [] {
    return Simulation<double>(
        test::liquid(3, 0.8442, 1.44),
        compose(test::kinetic_potential(LennardJonesForce{.cutoff = 1.5, .epsilon = 1.0, .sigma = 1.0}),
                schemes::verlet),
        0.005);
  };
  const RadialDistribution asked(30);
  auto whole = make(), first = make(), second = make();
  auto& g = whole.every(10, asked);
  first.every(10, asked);
  auto& again = second.every(10, asked);
  REQUIRE(whole.run(60).ok());
  REQUIRE(first.run(30).ok());
  second.restore(first.save());
  REQUIRE(second.run(30).ok());
  CHECK(g.report().samples == 7);
  CHECK(again.report().samples == 7);
  CHECK(g.values() == again.values());
  CHECK(g.counts() == again.counts());
  CHECK(g.report().note == again.report().note);
  CHECK(g.series()[1].values == g.values());
  CHECK(g.series()[1].shape == std::vector<Index>{30});
  // Seven looks count seven times the pairs of one: about 4 pi r^3 / 3 times the density for each particle.
  const RadialDistribution one = observed(test::liquid(3, 0.8442, 1.44), asked);
  CHECK(std::abs(g.coordination()[29] / one.coordination()[29] - 1) < 0.1);
}

TEST_CASE("g(r) depends on no number of threads", "[radial_distribution][determinism]") {
  const ParticleSystem<double> s = mixed_gas(3000);
  const auto counts = [&](int threads) {
    const test::Threads with(threads);
    return observed(s, RadialDistribution(100)).counts();
  };
  CHECK(counts(1) == counts(3));
}

TEST_CASE("g(r) is refused where it makes no sense", "[radial_distribution][messages]") {
  const ParticleSystem<double> s = mixed_gas(9);
  const auto refusal = [](const ParticleSystem<double>& particles, const RadialDistribution& asked) {
    return test::refusal_of([&] { still(particles).every(1, asked); });
  };
  CHECK(refusal(s, RadialDistribution(200, 1.5)).empty());
  CHECK(refusal(s, RadialDistribution(200, 1.6)) ==
        "range = 1.6 is beyond half of the shortest edge of the box; at most 1.5 is expected");
  CHECK(refusal(s, RadialDistribution(200, -1.0)) == "range = -1 is not a valid range; a length above 0 is expected");
  CHECK(refusal(s, RadialDistribution(0)) == "bins = 0 is not a valid number of intervals; 1 to 100000 is expected");
  CHECK(refusal(s, RadialDistribution(200, {}, {"A"})) ==
        "types = [A] is not a pair of types; give two types, or none for all pairs");
  CHECK(refusal(s, RadialDistribution(200, {}, {"A", "C"})).find("unknown type 'C' in monitor 'radial_distribution'") ==
        0);
  CHECK(refusal(s, RadialDistribution(200, {}, {}, false)) ==
        "intramolecular = false has no effect, because there are neither molecules nor bonds; take it out");
  ParticleSystem<double> open = s;
  open.set_box(Box::open());
  CHECK(refusal(open, {}) ==
        "monitor 'radial_distribution' needs a periodic box, because it divides by the density; give the particles a "
        "box");
}

}  // namespace noether
