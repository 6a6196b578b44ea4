/// The near parts of charges in lanes: the polynomials against 113 bits, extremes of charges, pairs left out, types of
/// which few act.

#include "engine/charge.hpp"
#include "forces/ewald.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>

namespace noether {
namespace {

struct Screened {
  double energy, force;
};

/// erfc(alpha r)/r and its force over r by a series.
Screened by_series(const ChargeSeries& series, double r2) {
  const double t = r2 * series.scale + series.offset, r = std::sqrt(r2);
  Screened sum{0, 0};
  for (int k = series.energy_terms - 1; k >= 0; --k) sum.energy = sum.energy * t + series.energy[k];
  for (int k = series.force_terms - 1; k >= 0; --k) sum.force = sum.force * t + series.force[k];
  return {sum.energy + 1 / r, sum.force + 1 / (r2 * r)};
}

/// Sites like those of water: of every three one with a Lennard-Jones force and two charges that it balances.
ParticleSystem<double> like_water(ParticleSystem<double> s) {
  auto topology = std::make_shared<Topology>();
  auto& q = s.add_column<Charge>();
  topology->type_names = {"O", "H"};
  topology->pair_kinds = {{1, 1}, {0, 0}};
  for (Index i = 0; i < s.size(); ++i) {
    topology->types.push_back(i % 3 == 0 ? 0 : 1);
    q[i] = i % 3 == 0 ? -0.8 : 0.4;
  }
  topology->exclusions = {{0, 1}, {0, 2}, {1, 2}};
  topology->scaled_pairs = {{{3, 4}, 0.5}};
  s.set_topology(topology);
  return s;
}

}  // namespace

TEST_CASE("the near part as a polynomial is erfc of 113 bits, to the error that is asked", "[near_charges]") {
  for (const double alpha_range : {0.3, 1.0, 2.7, 3.4, 4.8, 5.8}) {
    for (const double error : {0.0, 1e-12, 1e-9, 1e-7, 1e-5}) {
      const double range = 0.9, alpha = alpha_range / range;
      const ChargeSeries& series = detail::screened_series(alpha, range, error);
      REQUIRE(series.energy_terms > 0);
      REQUIRE(series.force_terms > 0);
      const PairTerms<double> largest = detail::smooth_terms(alpha, 0.0);
      double worst_energy = 0, worst_force = 0;
      for (int k = 1; k <= 300; ++k) {
        const double r = range * k / 300;
        const detail::ScreenedCharges near{alpha, range};
        const PairTerms<Quad> exact = near(Quad(r) * Quad(r), Quad(1));
        const Screened ours = by_series(series, r * r);
        // beside what 1/r and 1/r^3 are rounded by
        const double energy = std::abs(ours.energy - static_cast<double>(exact.energy)) - 8e-16 / r;
        const double force = std::abs(ours.force - static_cast<double>(exact.force)) - 12e-16 / (r * r * r);
        worst_energy = std::max(worst_energy, energy / largest.energy);
        worst_force = std::max(worst_force, force / largest.force);
      }
      CAPTURE(alpha_range, error, series.energy_terms, series.force_terms);
      CHECK(worst_energy <= 2e-15);
      CHECK(worst_force <= error + 2e-15);
      if (error >= 1e-12 && series.force_terms > 2) CHECK(worst_force > error / 1000);  // no more terms than needed
    }
  }
  CHECK(detail::screened_series(100, 0.9, 0).energy_terms == 0);  // by no polynomial
}

TEST_CASE("an alpha that no polynomial follows goes through the lanes of any potential", "[near_charges]") {
  const ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(2, 0.5));
  const Ewald force{.cutoff = 2.2, .alpha = 6.5, .kmax = 3};
  const test::Evaluated lanes = test::evaluated<double>(force, s), exact = test::evaluated<Quad>(force, s);
  REQUIRE(detail::screened_series(6.5, 2.2, 0).energy_terms == 0);
  CHECK(test::largest_difference(lanes.a, exact.a) < 2e-12 * std::max(1.0, exact.a.all().cwiseAbs().maxCoeff()));
}

TEST_CASE("charges of 1e-6 and of 1e3 have the forces of 113 bits, two of them alone too", "[near_charges][extremes]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const double strength : {1e-6, 1e3}) {
      ParticleSystem<double> s(unit_system("reduced"));
      s.set_box(Box::periodic({6, 6, 6}));
      s.add("one", 1, {0.1, 1.5, 5.9}, {0, 0, 0});
      s.add("two", 1, {0.4, 1.2, 0.7}, {0, 0, 0});
      auto& q = s.add_column<Charge>();
      q[0] = strength;
      q[1] = -strength;
      ParticleSystem<double> many = test::with_special_pairs(test::charged_liquid(2, 0.5));
      for (Index i = 0; i < many.size(); ++i) many.column<Charge>()[i] *= strength;
      for (const ParticleSystem<double>* one : {&s, &many}) {
        CAPTURE(name(level), strength, one->size());
        const auto check = [&](const auto& force) {
          const test::Evaluated lanes = test::evaluated<double>(force, *one),
                                exact = test::evaluated<Quad>(force, *one);
          REQUIRE_FALSE(lanes.failure);
          const double largest = exact.a.all().cwiseAbs().maxCoeff();
          CHECK(largest > 0);
          CHECK(test::largest_difference(lanes.a, exact.a) < 2e-12 * largest);
          CHECK(std::abs(lanes.energy - exact.energy) < 1e-11 * largest * static_cast<double>(one->size()));
        };
        check(ReactionFieldForce{{2.0, 78.3}});
        check(ReactionFieldForce{{.radius = 2.0, .switched_from = 1.7}});
        check(Ewald{.cutoff = 2.0, .alpha = 1.4, .kmax = 5});
      }
    }
  }
}

TEST_CASE("two charges in mixed precision are right at any distance, or end the run",
          "[near_charges][mixed][extremes]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const double r : {1.5, 0.9, 0.4, 0.1, 0.02, 0.005, 1e-3, 1e-9, 0.0}) {
      ParticleSystem<double> s(unit_system("reduced"));
      s.set_box(Box::periodic({7, 8, 9}));
      s.add("one", 1, {1, 1, 1}, {0, 0, 0});
      s.add("two", 1, {1 + 0.6 * r, 1 + 0.8 * r, 1}, {0, 0, 0});
      auto& q = s.add_column<Charge>();
      q[0] = 1;
      q[1] = -1;
      ReactionFieldForce force{{2.0}};
      const test::Evaluated exact = test::evaluated<Quad>(force, s);
      force.precision = PairPrecision::mixed;
      const test::Evaluated mixed = test::evaluated<double>(force, s);
      CAPTURE(name(level), r);
      CHECK(mixed.a.all().allFinite());
      CHECK(mixed.failure.has_value() == (r < 0.01));
      if (mixed.failure) continue;
      // places are whole numbers of 2^-28 of half the longest edge and two cutoffs
      const double strongest = exact.a.all().cwiseAbs().maxCoeff(), place = 3 * 8.5 * 0x1p-28 / r;
      CHECK(test::largest_difference(mixed.a, exact.a) < 32 * 0x1p-26 + (8 * 0x1p-24 + place) * strongest);
    }
  }
}

TEST_CASE("charges add up to no force, exactly", "[near_charges]") {
  const ParticleSystem<double> s = test::charged_liquid(4);
  const double unit = std::ldexp(1.0, std::ilogb(100 / (2.0 * 2.0)) + 1 - 47);  // of charges of 1
  test::check_sum_is_zero(test::evaluated<double>(ReactionFieldForce{{2.0}}, s).a, unit);
}

TEST_CASE("charges in mixed precision have the forces of 113 bits to single precision, and energies of doubles",
          "[near_charges][mixed]") {
  const auto check = [](auto force, const ParticleSystem<double>& s, double scale) {
    const test::Evaluated doubles = test::evaluated<double>(force, s);
    force.precision = PairPrecision::mixed;
    const test::Evaluated mixed = test::evaluated<double>(force, s);
    REQUIRE_FALSE(mixed.failure);
    const double found = test::largest_difference(mixed.a, doubles.a);
    // Half a unit of 2^-26 for each of about 60 neighbors, and roundings of 2^-24 of forces as strong as the scale.
    CHECK(found < 30 * scale * 0x1p-26 + 8 * 0x1p-24 * scale);
    CHECK(found > 1e-9 * scale);  // doubles would be nearer
    CHECK(mixed.energy == doubles.energy);
    CHECK(mixed.virial == doubles.virial);
  };
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const double strength : {1e-6, 1.0, 1e3}) {
      for (ParticleSystem<double> s :
           {test::charged_liquid(3), test::with_special_pairs(test::charged_liquid(2, 0.5)), test::charged_liquid(1)}) {
        for (Index i = 0; i < s.size(); ++i) s.column<Charge>()[i] *= strength;
        CAPTURE(name(level), strength, s.size());
        const double scale = 100 * strength * strength * 2.25 / 4;
        check(ReactionFieldForce{{2.0, 78.3}}, s, scale);
        check(ReactionFieldForce{{.radius = 2.0, .switched_from = 1.7}}, s, scale);
        check(PairForce<detail::ScreenedCharges>{{1.4, 2.0}}, s, scale);
      }
    }
  }
  ReactionFieldForce open{{2.0}};
  open.precision = PairPrecision::mixed;
  ParticleSystem<double> s = test::charged_liquid(2);
  s.set_box(Box::open());
  CHECK_THROWS_WITH(open.check(s),
                    "reaction_field: precision = \"mixed\" needs a periodic box, but there is none; add a box or leave "
                    "precision out");
}

TEST_CASE("bits of charges in mixed precision depend on no list and no thread, and their forces add up to nothing",
          "[near_charges][mixed][determinism]") {
  ReactionFieldForce force{{.radius = 2.0, .switched_from = 1.7}};
  force.precision = PairPrecision::mixed;
  const ParticleSystem<double> s = test::charged_liquid(5);
  test::check_bits_of_lists(force, s, 2.0);
  test::check_sum_is_zero(test::evaluated<double>(force, s).a, std::ldexp(1.0, std::ilogb(100 / (2.0 * 2.0)) + 1 - 26));
  test::check_old_lists(force, test::charged_liquid(4), 2.0);
  ParticleMeshEwald mesh{.cutoff = 1.4, .relative_error = 1e-3};
  const test::Evaluated doubles = test::evaluated<double>(mesh, s);
  mesh.precision = PairPrecision::mixed;
  test::check_bits_of_lists(mesh, s, 1.4);
  const double found = test::largest_difference(test::evaluated<double>(mesh, s).a, doubles.a);
  CHECK(found > 0);
  CHECK(found < 1e-5);
}

TEST_CASE("where few types have a Lennard-Jones force, sums are those of 113 bits and depend on no list",
          "[near_charges][determinism]") {
  const LennardJonesForce atoms{.cutoff = 2.0, .cutoff_style = Cutoff::switch_c4};
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    CAPTURE(name(level));
    const ParticleSystem<double> s = like_water(test::liquid(3, 0.85, 1, 0.1));
    const Sum both(atoms, ReactionFieldForce{{2.0}});
    const test::Evaluated lanes = test::evaluated<double>(both, s), exact = test::evaluated<Quad>(both, s);
    REQUIRE_FALSE(lanes.failure);
    CHECK(test::largest_difference(lanes.a, exact.a) < 1e-10);
    CHECK(std::abs(lanes.energy - exact.energy) < 1e-9);
    CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-8);
  }
  // Some pairs are so close that sums take more care, at once when they were so before.
  const ParticleSystem<double> shaken = like_water(test::liquid(5, 0.85, 1, 0.22));
  test::check_bits_of_lists(atoms, shaken, 2.0);
  Workspace kept;
  kept.put(NeighborList(2.0, {.skin = 0.2}));
  const test::Evaluated first = test::evaluated<double>(atoms, shaken, &kept),
                        again = test::evaluated<double>(atoms, shaken, &kept);
  CHECK(first.a.all() == again.a.all());
  CHECK(first.energy == again.energy);
  test::check_old_lists(atoms, like_water(test::liquid(4, 0.85, 1, 0.1)), 2.0);
}

}  // namespace noether
