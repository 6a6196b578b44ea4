/// Lennard-Jones forces in mixed precision, at every SIMD level that this processor has: against 113 bits, and as free
/// of lists and threads as those in doubles.

#include "forces/lennard_jones.hpp"

#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <span>

namespace noether {
namespace {

using test::all_levels;
using test::Evaluated;
using test::evaluated;
using test::largest_difference;
using test::liquid;

/// A whole number of forces for epsilon = sigma = 1: 2^-21 of 32, the power of two above 24.
constexpr double force_unit = 0x1p-16;

LennardJonesForce mixed_argon(Cutoff style, double cutoff = 2.5) {
  LennardJonesForce force{.cutoff = cutoff, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0};
  force.precision = PairPrecision::mixed;
  return force;
}

/// Lengths times 1e-10, energies times 1e-21: what atoms measure in SI units.
ParticleSystem<double> small(const ParticleSystem<double>& s) {
  ParticleSystem<double> smaller;
  smaller.set_box(Box::periodic(1e-10 * s.box().edges()));
  for (Index i = 0; i < s.size(); ++i) smaller.add("", 1, 1e-10 * Vec3<double>(s.positions()[i]), Vec3<double>::Zero());
  return smaller;
}

}  // namespace

TEST_CASE("forces of mixed precision are those of 113 bits to single precision", "[lennard_jones][mixed]") {
  const LennardJonesForce every = mixed_argon(test::cutoff_styles[GENERATE(range(0, 5))], 2.2);
  test::for_liquids(every, [](const LennardJonesForce& force, const ParticleSystem<double>& s) {
    const Evaluated mixed = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
    REQUIRE_FALSE(mixed.failure);
    // Half a unit for each of about 60 neighbors, and a few roundings of 2^-24 of forces up to 100.
    const double found = largest_difference(mixed.a, exact.a);
    CHECK(found < 30 * force_unit + 8 * 0x1p-24 * 100);
    CHECK(found > 1e-9);  // doubles would be nearer
    LennardJonesForce full = force;
    full.precision = PairPrecision::full;
    const Evaluated doubles = evaluated<double>(full, s);
    CHECK(mixed.energy == doubles.energy);
    CHECK(mixed.virial == doubles.virial);
  });
}

TEST_CASE("mixed precision knows no scale: SI units leave single precision nowhere", "[lennard_jones][mixed]") {
  const ParticleSystem<double> s = small(liquid(3, 0.85, 1, 0.1));
  for (const Cutoff style : std::span(test::cutoff_styles).first(5)) {
    LennardJonesForce force{.cutoff = 2.2e-10, .cutoff_style = style, .epsilon = 1e-21, .sigma = 1e-10};
    force.precision = PairPrecision::mixed;
    const Evaluated mixed = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
    CHECK(largest_difference(mixed.a, exact.a) < 1e-11 * (60 * force_unit + 8 * 0x1p-24 * 100));
  }
}

TEST_CASE("the forces of mixed precision add up to nothing, exactly", "[lennard_jones][mixed]") {
  for (const double shake : {0.15, 0.3}) {  // of the second some pairs are strong
    const Evaluated all = evaluated<double>(mixed_argon(Cutoff::switch_c2), liquid(4, 0.85, 1, shake));
    REQUIRE_FALSE(all.failure);
    test::check_sum_is_zero(all.a, force_unit);
  }
}

TEST_CASE("bits of mixed precision depend on no neighbor list, thread or monitor", "[lennard_jones][mixed]") {
  test::check_bits_of_lists(mixed_argon(Cutoff::plain), liquid(5, 0.85, 1, 0.15), 2.5);
}

TEST_CASE("a list that is some steps old gives the bits of a new one in mixed precision", "[lennard_jones][mixed]") {
  test::check_old_lists(mixed_argon(Cutoff::plain), liquid(4, 0.8371, 1.5, 0.1), 2.5);  // edges are no round numbers
}

TEST_CASE("a force in doubles and one in mixed precision share a list", "[lennard_jones][mixed]") {
  const ParticleSystem<double> s = liquid(4, 0.85, 1, 0.1);
  LennardJonesForce doubles = mixed_argon(Cutoff::plain);
  doubles.precision = PairPrecision::full;
  Workspace list;
  list.put(NeighborList(2.5, {}));
  const Evaluated full = evaluated<double>(doubles, s, &list),
                  mixed = evaluated<double>(mixed_argon(Cutoff::plain), s, &list);
  CHECK(full.a.all() == evaluated<double>(doubles, s).a.all());
  CHECK(mixed.a.all() == evaluated<double>(mixed_argon(Cutoff::plain), s).a.all());
}

TEST_CASE("strong pairs in mixed precision are right to single precision", "[lennard_jones][mixed]") {
  for (const double r : {0.9, 0.86, 0.83, 0.8, 0.7, 0.6, 0.55}) {
    CAPTURE(r);
    ParticleSystem<double> s;
    s.set_box(Box::periodic({11, 12, 13}));
    s.add("a", 1, {1, 1, 1}, {0, 0, 0});
    s.add("b", 1, {1 + r * 0.6, 1 + r * 0.8, 1}, {0, 0, 0});
    s.add("c", 1, {2.1, 0.6, 1.3}, {0, 0, 0});
    const Evaluated mixed = evaluated<double>(mixed_argon(Cutoff::plain), s),
                    exact = evaluated<Quad>(mixed_argon(Cutoff::plain), s);
    REQUIRE_FALSE(mixed.failure);
    const double strongest = exact.a.all().cwiseAbs().maxCoeff();
    CHECK(largest_difference(mixed.a, exact.a) < 2 * force_unit + 16 * 0x1p-24 * strongest);
  }
}

TEST_CASE("atoms on top of each other are named in mixed precision too", "[lennard_jones][mixed][extremes]") {
  for (const double r : {0.0, 1e-100, 1e-30, 1e-3, 0.05}) {
    ParticleSystem<double> s;
    s.set_box(Box::periodic({20, 20, 20}));
    s.add("helium", 1, {0, 0, 0}, {0, 0, 0});
    s.add("neon", 1, {r, 0, 0}, {0, 0, 0});
    s.add("argon", 1, {5, 0, 0}, {0, 0, 0});
    for (const SimdLevel level : all_levels()) {
      const test::AtLevel at(level);
      const Evaluated all = evaluated<double>(mixed_argon(Cutoff::shifted_force), s);
      REQUIRE(all.failure);
      CHECK(all.failure->kind == Outcome::Kind::overlap);
      CHECK(all.failure->particle == 0);
      CHECK(all.a.all().allFinite());
    }
  }
}

TEST_CASE("no skin is too wide for mixed precision", "[lennard_jones][mixed]") {
  const ParticleSystem<double> s = liquid(3, 0.85, 1, 0.1);
  const LennardJonesForce force = mixed_argon(Cutoff::plain, 2.2);
  for (const double skin : {1.0, 2.5, 20.0}) {
    Workspace wide;
    wide.put(NeighborList(2.2, {.skin = skin, .verify = true}));
    CHECK(evaluated<double>(force, s, &wide).a.all() == evaluated<double>(force, s).a.all());
  }
}

TEST_CASE("mixed precision is refused where places have no box", "[lennard_jones][mixed]") {
  ParticleSystem<double> s = liquid(3, 0.85, 1);
  s.set_box(Box::open());
  CHECK_THROWS_WITH(
      mixed_argon(Cutoff::plain, 2.2).check(s),
      "lennard_jones: precision = \"mixed\" needs a periodic box, but there is none; add a box or leave precision out");
}

}  // namespace noether
