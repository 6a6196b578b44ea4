/// Lennard-Jones pairs in lanes, at every SIMD level that this processor has: against 113 bits, and bits that depend on
/// nothing but the state.

#include "forces/lennard_jones.hpp"

#include "forces/check_gradient.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <fmt/format.h>

namespace noether {
namespace {

using test::liquid;

using test::all_levels;
using test::evaluated;
using test::Evaluated;
using test::largest_difference;

LennardJonesForce argon(Cutoff style, double cutoff = 2.5) {
  return {.cutoff = cutoff, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0};
}

}  // namespace

TEST_CASE("forces, energy and virial in lanes are those of 113 bits, for every end of the range", "[lennard_jones]") {
  const LennardJonesForce every = argon(test::cutoff_styles[GENERATE(range(0, 8))], 2.2);
  test::for_liquids(every, [](const LennardJonesForce& force, const ParticleSystem<double>& s) {
    const Evaluated lanes = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
    REQUIRE_FALSE(lanes.failure);
    // A unit of 2^-42 for each of about 60 neighbors; energies are summed in units four times as large.
    CHECK(largest_difference(lanes.a, exact.a) < 60 * 0x1p-43);
    CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 * static_cast<double>(s.size()));
    CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-11 * static_cast<double>(s.size()));
  });
}

TEST_CASE("pairs in open space are summed as in a box", "[lennard_jones]") {
  ParticleSystem<double> s = liquid(2, 0.85, 1, 0.1);
  s.set_box(Box::open());
  const LennardJonesForce force = argon(Cutoff::shifted_force);
  const Evaluated lanes = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
  CHECK(largest_difference(lanes.a, exact.a) < 60 * 0x1p-43);
  CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 * 32);
}

TEST_CASE("the forces on all atoms add up to nothing, exactly", "[lennard_jones]") {
  test::check_sum_is_zero(evaluated<double>(argon(Cutoff::switch_c2), liquid(4, 0.85, 1, 0.15)).a, 0x1p-42);
}

TEST_CASE("bits of forces depend on no neighbor list, thread or monitor", "[lennard_jones][determinism]") {
  test::check_bits_of_lists(argon(Cutoff::plain), liquid(5, 0.85, 1, 0.15), 2.5);
}

TEST_CASE("a list that is some steps old gives the bits of a new one", "[lennard_jones][determinism]") {
  test::check_old_lists(argon(Cutoff::plain), liquid(4, 0.85, 1.5, 0.1), 2.5);
}

TEST_CASE("in a box smaller than the range bits depend on no list either, and forces add up to nothing",
          "[lennard_jones][determinism]") {
  // Edges short of a power of two: images lie where doubles have coarser steps than in the box.
  const double edge = GENERATE(3.9, 1.95, 1.3), reaches = GENERATE(0.48, 0.9, 1.2, 1.9);
  const LennardJonesForce force{.cutoff = reaches * edge, .epsilon = 1.0, .sigma = edge / 1.6};
  for (unsigned seed = 1; seed <= 25; ++seed) {
    ParticleSystem<double> s = liquid(1, 4 / std::pow(edge, 3), 1, 0.05 * edge, seed);
    Workspace old;
    const NeighborList& kept = old.put(NeighborList(force.cutoff, {.skin = 0.09 * edge}));
    static_cast<void>(evaluated<double>(force, s, &old));
    s.scale_velocities(0.03 * edge / s.velocities().all().cwiseAbs().maxCoeff());
    s.advance_positions(0.8);  // across faces, and less far than the list lasts
    const Evaluated by_old = evaluated<double>(force, s, &old), by_new = evaluated<double>(force, s);
    REQUIRE_FALSE(by_new.failure);
    REQUIRE(kept.statistics().searches == 1);
    REQUIRE(by_old.a.all() == by_new.a.all());
    REQUIRE(by_old.energy == by_new.energy);
    test::check_sum_is_zero(by_new.a, std::exp2(std::ceil(std::log2(24 / *force.sigma)) - 47));
  }
}

TEST_CASE("pairs that are strong are summed to the same grid as all others", "[lennard_jones]") {
  // From the range of the quick sums to beyond it: 24/r (2/r^12 - 1/r^6) is 2^9 at r = 0.824.
  for (const double r : {0.9, 0.86, 0.83, 0.8, 0.7, 0.6, 0.5}) {
    CAPTURE(r);
    ParticleSystem<double> s;
    s.add("a", 1, {0, 0, 0}, {0, 0, 0});
    s.add("b", 1, {r * 0.6, r * 0.8, 0}, {0, 0, 0});
    s.add("c", 1, {1.1, -0.4, 0.3}, {0, 0, 0});
    const Evaluated lanes = evaluated<double>(argon(Cutoff::plain), s),
                    exact = evaluated<Quad>(argon(Cutoff::plain), s);
    REQUIRE_FALSE(lanes.failure);
    const double strongest = exact.a.all().cwiseAbs().maxCoeff();
    CHECK(largest_difference(lanes.a, exact.a) < 2 * 0x1p-42 + 4e-15 * strongest);
    CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 + 4e-15 * std::abs(exact.energy));
  }
}

TEST_CASE("atoms on top of each other are named, and nothing becomes infinite", "[lennard_jones][extremes]") {
  for (const double r : {0.0, 1e-100, 1e-30, 1e-3, 0.05}) {
    ParticleSystem<double> s;
    s.add("helium", 1, {0, 0, 0}, {0, 0, 0});
    s.add("neon", 1, {r, 0, 0}, {0, 0, 0});
    s.add("argon", 1, {5, 0, 0}, {0, 0, 0});
    const Evaluated all = evaluated<double>(argon(Cutoff::shifted_force), s);
    REQUIRE(all.failure);
    CHECK(all.failure->kind == Outcome::Kind::overlap);
    CHECK(all.failure->particle == 0);
    CHECK(all.failure->message == fmt::format("particles 'helium' and 'neon' are {:.3g} apart, too close for their "
                                              "Lennard-Jones force",
                                              r));
    CHECK(all.a.all().allFinite());
  }
}

TEST_CASE("each end of the range has the derivatives that it promises", "[lennard_jones]") {
  // Jumps at the cutoff and where the switch begins, of the energy and its first derivatives by differences in 113
  // bits.
  const auto row_of = [](Cutoff style) {
    LennardJonesForce force = argon(style);
    ParticleSystem<double> s = liquid(1, 0.5, 1);
    static_cast<void>(evaluated<Quad>(force, s));
    return std::pair(force.table->rows[0], force.table->style);
  };
  const auto jumps = [&](Cutoff style, double at) {
    const auto [row, kind] = row_of(style);
    const Quad h = Quad(1e-7);
    const auto energy = [&, row = row, kind = kind](const Quad& r) {
      return r < Quad(2.5) ? detail::lennard_jones_terms<Quad>(r * r, row, kind).energy : Quad(0);
    };
    // Derivatives from both sides by differences of first order.
    int continuous = 0;
    for (int n = 0; n <= 5; ++n) {
      Quad right(0), left(0), binomial(1);
      for (int k = 0; k <= n; ++k) {
        const Quad sign((n - k) % 2 == 0 ? 1 : -1);
        right += sign * binomial * energy(Quad(at) + Quad(k) * h);
        left += sign * Quad(n % 2 == 0 ? 1 : -1) * binomial * energy(Quad(at) - Quad(1e-25) - Quad(k) * h);
        binomial = binomial * Quad(n - k) / Quad(k + 1);
      }
      for (int k = 0; k < n; ++k) {
        right /= h;
        left /= h;
      }
      if (abs(right - left) > Quad(n < 4 ? 0.02 : 1.0)) break;
      continuous = n + 1;
    }
    return continuous - 1;  // derivatives that do not jump; -1: the value itself does
  };
  CHECK(jumps(Cutoff::shifted, 2.5) == 0);
  CHECK(jumps(Cutoff::shifted_force, 2.5) == 1);
  CHECK(jumps(Cutoff::switch_c2, 2.5) == 2);
  CHECK(jumps(Cutoff::switch_c2, 2.25) == 2);
  CHECK(jumps(Cutoff::switch_c4, 2.5) == 4);
  CHECK(jumps(Cutoff::switch_c4, 2.25) == 4);
}

TEST_CASE("Lennard-Jones forces are the gradients of their energies, for every end of the range", "[lennard_jones]") {
  const ParticleSystem<double> s = liquid(2, 0.85, 1, 0.1);  // in 113 bits, with images
  for (const Cutoff style : test::cutoff_styles) {
    CAPTURE(static_cast<int>(style));
    LennardJonesForce by_types = argon(style, 1.6);
    CHECK(gradient_error(by_types, s) < 1e-12);
    by_types.epsilon = by_types.sigma = std::nullopt;
    CHECK(gradient_error(by_types, test::with_two_types(s)) < 1e-12);
  }
}

TEST_CASE("LAMMPS's lattice of in.lj has LAMMPS's energy and pressure", "[lennard_jones][oracle]") {
  // Printed by LAMMPS for bench/in.lj at step 0: E_pair -6.7733681, P -5.0197073 at T 1.44, N = 32000.
  const ParticleSystem<double> s = liquid(20, 0.8442, 1.44);
  const Evaluated all = evaluated<double>(argon(Cutoff::plain), s);
  const auto n = static_cast<double>(s.size());
  CHECK(fmt::format("{:.7f}", all.energy / n) == "-6.7733681");
  const double pressure = 0.8442 * 1.44 * (n - 1) / n + all.virial.trace() / 3 / s.box().volume();
  CHECK(fmt::format("{:.7f}", pressure) == "-5.0197073");
}

TEST_CASE("tail corrections are the integrals beyond the cutoff", "[lennard_jones]") {
  // Per particle at density 0.8442: U -0.4520 and P -0.7621 for a cutoff of 2.5, -0.2618 and -0.4419 for 3.
  for (const auto& [cutoff, energy, pressure] :
       {std::tuple(2.5, -0.4520, -0.7621), std::tuple(3.0, -0.2618, -0.4419)}) {
    const ParticleSystem<double> s = liquid(4, 0.8442, 1);
    LennardJonesForce force = argon(Cutoff::plain, cutoff);
    const Evaluated without = evaluated<double>(force, s);
    force.tail = true;
    const Evaluated with = evaluated<double>(force, s);
    CHECK(std::abs((with.energy - without.energy) / static_cast<double>(s.size()) - energy) < 5e-5);
    CHECK(std::abs((with.virial - without.virial).trace() / 3 / s.box().volume() - pressure) < 1e-4);
    CHECK(largest_difference(with.a, without.a) == 0);
  }
}

TEST_CASE("tails of two types are closed integrals under either mixing", "[lennard_jones]") {
  for (const Mixing mixing : {Mixing::lorentz_berthelot, Mixing::geometric}) {
    ParticleSystem<double> s = liquid(3, 0.6, 1);
    auto topology = std::make_shared<Topology>();
    for (Index i = 0; i < s.size(); ++i) topology->types.push_back(i % 3 == 0 ? 1 : 0);
    topology->pair_kinds = {{1, 1}, {0.49, 1.44}};
    topology->mixing = mixing;
    s.set_topology(topology);
    const Quad rc = 2.5, volume = s.box().volume(), pi = Quad(4) * atan2(Quad(1), Quad(1));
    Quad energy = 0, virial = 0;
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        const Quad members = Quad(a == 0 ? 72 : 36) * Quad(b == 0 ? 72 : 36);
        // sqrt(0.49) = 0.7; the mean of 1 and 1.44, and the root of their product.
        const Quad epsilon = a + b == 0 ? Quad(1) : a + b == 2 ? Quad(0.49) : sqrt(Quad(0.49));
        const Quad mixed = mixing == Mixing::geometric ? sqrt(Quad(1.44)) : (Quad(1) + Quad(1.44)) / Quad(2);
        const Quad sigma = a + b == 0 ? Quad(1) : a + b == 2 ? Quad(1.44) : mixed;
        const Quad s3 = sigma * sigma * sigma, s6 = s3 * s3, c3 = rc * rc * rc, c9 = c3 * c3 * c3;
        // 2 pi N_a N_b / V of the integrals from rc on of r^2 U and of r^3 F, F = - dU/dr.
        const Quad factor = Quad(2) * pi * members / volume * Quad(4) * epsilon * s6;
        energy += factor * (s6 / (Quad(9) * c9) - Quad(1) / (Quad(3) * c3));
        virial += factor * (Quad(12) * s6 / (Quad(9) * c9) - Quad(6) / (Quad(3) * c3));
      }
    }
    LennardJonesForce force{.cutoff = 2.5, .cutoff_style = Cutoff::plain};
    CAPTURE(static_cast<int>(mixing));
    const Evaluated cut = evaluated<Quad>(force, s);
    force.tail = true;
    const Evaluated whole = evaluated<Quad>(force, s), lanes = evaluated<double>(force, s);
    CHECK(std::abs((whole.energy - cut.energy) / static_cast<double>(energy) - 1) < 1e-12);
    CHECK(std::abs((whole.virial - cut.virial).trace() / static_cast<double>(virial) - 1) < 1e-12);
    // On a lattice all pairs of a distance are rounded to whole units the same way.
    CHECK(std::abs(lanes.energy - whole.energy) < 1e-11 * static_cast<double>(s.size()));
    CHECK(std::abs((lanes.virial - whole.virial).trace()) < 1e-11 * static_cast<double>(s.size()));
  }
}

TEST_CASE("pairs of types that do not act change no bit of those that do, by old lists too", "[lennard_jones]") {
  // As in water: one particle in three acts, on its like alone; and two types that act by one row, as by many.
  for (const bool mixed : {false, true}) {
    for (const std::vector<PairKind>& kinds :
         {std::vector<PairKind>{{1, 1}, {0, 1}, {0, 0.5}}, std::vector<PairKind>{{1, 1}, {0, 1}, {1, 1}},
          std::vector<PairKind>{{1, 1}, {0, 1}, {0.5, 1.1}}}) {
      CAPTURE(mixed, kinds.back().epsilon);
      ParticleSystem<double> s = liquid(4, 0.85, 1.5, 0.1), acting;
      acting.set_box(s.box());
      auto topology = std::make_shared<Topology>(), alone = std::make_shared<Topology>();
      topology->pair_kinds = alone->pair_kinds = kinds;
      std::vector<Index> which;
      for (Index i = 0; i < s.size(); ++i) {
        const auto type = static_cast<std::size_t>(i % 3);
        topology->types.push_back(i % 3);
        if (kinds[type].epsilon == 0) continue;
        alone->types.push_back(i % 3);
        which.push_back(i);
        acting.add("", 1, s.positions()[i], s.velocities()[i]);
      }
      s.set_topology(topology);
      acting.set_topology(alone);
      const LennardJonesForce force{.cutoff = 2.5,
                                    .cutoff_style = Cutoff::switch_c4,
                                    .precision = mixed ? PairPrecision::mixed : PairPrecision::full};
      Workspace list;
      list.put(NeighborList(2.5, {.skin = 0.2}));
      for (int n = 0; n < 20; ++n) {
        s.advance_positions(0.01);
        acting.advance_positions(0.01);
        const Evaluated all = evaluated<double>(force, s, &list), those = evaluated<double>(force, acting);
        REQUIRE(all.energy == those.energy);
        REQUIRE(all.virial == those.virial);
        Index k = 0;
        for (const Index i : which) REQUIRE(all.a[i] == those.a[k++]);
        for (Index i = 1; i < s.size(); i += 3) REQUIRE(norm2(all.a[i]) == 0);
      }
    }
  }
}

TEST_CASE("what a Lennard-Jones force cannot do is refused by name", "[lennard_jones]") {
  const ParticleSystem<double> s = liquid(1, 0.5, 1);
  const LennardJonesForce by_types{.cutoff = 2.5};
  CHECK_THROWS_WITH(
      by_types.check(s),
      "lennard_jones: the particles have no Lennard-Jones parameters; give epsilon and sigma here, or types "
      "that have them");
  LennardJonesForce open_tail = argon(Cutoff::plain);
  open_tail.tail = true;
  ParticleSystem<double> open = s;
  open.set_box(Box::open());
  CHECK_THROWS_WITH(open_tail.check(open),
                    "lennard_jones: tail = true is for a liquid without end, so it needs a periodic box; add a box or "
                    "leave tail out");
  for (const Cutoff style : {Cutoff::shifted, Cutoff::shifted_force, Cutoff::force_switch}) {
    open_tail.cutoff_style = style;
    CHECK_THROWS_WITH(open_tail.check(), Catch::Contains("is for a plain cutoff or a switch of the energy only"));
  }
  LennardJonesForce mixed = argon(Cutoff::force_switch);
  mixed.precision = PairPrecision::mixed;
  CHECK_THROWS_WITH(mixed.check(),
                    "precision = \"mixed\" does not support cutoff_style = \"force_switch\"; leave precision out, or "
                    "take \"switch_c2\" or \"switch_c4\"");
  CHECK_THROWS_WITH((LennardJonesForce{.cutoff = 2.5, .epsilon = 1.0}.check()),
                    Catch::Contains("is given alone; give both epsilon and sigma, or neither"));
  CHECK_THROWS_WITH((LennardJonesForce{.cutoff = -1, .epsilon = 1.0, .sigma = 1.0}.check()),
                    Catch::Contains("is not a valid cutoff; a length above 0 is expected"));
}

}  // namespace noether
