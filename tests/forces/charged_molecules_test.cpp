/// Charges of molecules of three: forces found by molecules have the bits of those found pair by pair, in mixed
/// precision too.

#include "forces/charged_molecules.hpp"

#include "engine/charge.hpp"
#include "forces/ewald.hpp"
#include "forces/pair_potentials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <memory>
#include <random>

namespace noether {
namespace {

/// Molecules of a middle and two ends, which stand in any order, on a shaken lattice, whose sites move apart. @param
/// length  of a molecule
ParticleSystem<double> molecules(int cells, double shake, double length = 0.4) {
  const ParticleSystem<double> middles = test::liquid(cells, 0.4, 1, shake);
  ParticleSystem<double> s;
  s.set_box(middles.box());
  auto& q = s.add_column<Charge>();
  auto topology = std::make_shared<Topology>();
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; };
  for (Index m = 0; m < middles.size(); ++m) {
    for (int site = 0; site < 3; ++site) {
      const bool middle = site == static_cast<int>(m % 3);
      Vec3<double> from = Vec3<double>::Zero();
      if (!middle) from = length * Vec3<double>(uniform(), uniform(), uniform()).normalized();
      const Vec3<double> v = middles.velocities()[m] + 0.4 * Vec3<double>(uniform(), uniform(), uniform());
      const Index i = s.add("", middle ? 16 : 1, middles.positions()[m] + from, v);
      q[i] = middle ? -0.8 : 0.4;
    }
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
      topology->exclusions.emplace_back(3 * m + a, 3 * m + b);
  }
  s.set_topology(topology);
  return s;
}

/// The same with a scaled pair that is out of range of all forces here: then charges are summed pair by pair.
ParticleSystem<double> one_by_one(ParticleSystem<double> s) {
  auto topology = std::make_shared<Topology>(*s.topology());
  Index furthest = 3;
  const auto distance2 = [&](Index i) {
    return norm2(
        s.box().minimum_image(Vec3<double>(std::as_const(s).positions()[i] - std::as_const(s).positions()[0])));
  };
  for (Index i = 3; i < s.size(); ++i) furthest = distance2(i) > distance2(furthest) ? i : furthest;
  topology->scaled_pairs = {{{0, furthest}, 1}};
  s.set_topology(topology);
  return s;
}

bool by_molecules(Workspace& kept) {
  const auto* known = kept.find<detail::ChargedMolecules>();
  return known != nullptr && known->pairs().list.statistics().searches > 0;
}

/// While particles move. @param steps  of a hundredth
template <class F> void check_bits(const F& force, ParticleSystem<double> s, int steps) {
  ParticleSystem<double> apart = one_by_one(s);
  Workspace kept, other;
  kept.put(NeighborList(1.5, {.verify = true}));
  other.put(NeighborList(1.5));
  for (int n = 0; n < steps; ++n) {
    s.advance_positions(0.01);
    apart.advance_positions(0.01);
    const test::Evaluated found = test::evaluated<double>(force, s, &kept),
                          expected = test::evaluated<double>(force, apart, &other);
    REQUIRE_FALSE(expected.failure);
    REQUIRE_FALSE(found.failure);
    REQUIRE(found.a.all() == expected.a.all());
    REQUIRE(found.energy == expected.energy);
    REQUIRE(found.virial == expected.virial);
    VectorColumn<double> a(s.size());
    ForceSink<double> forces_only(a, s, {}, &kept);
    force.add_to(forces_only, s);
    REQUIRE(a.all() == expected.a.all());
  }
  CHECK(by_molecules(kept));
  CHECK_FALSE(by_molecules(other));
}

const ReactionFieldForce cavity{{.radius = 1.5}}, switched{{.radius = 1.5, .switched_from = 1.2}};
const PairForce<detail::ScreenedCharges> near{{2.0, 1.5}};

template <class F> F in_mixed(F force) {
  force.precision = PairPrecision::mixed;
  return force;
}

}  // namespace

TEST_CASE("charges found by molecules have the bits of those found pair by pair, while molecules move and stretch",
          "[charged_molecules][determinism]") {
  const Ewald sum{.cutoff = 1.5, .alpha = 2.0, .kmax = 2};
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    CAPTURE(name(level));
    check_bits(cavity, molecules(3, 0.1), 12);
    check_bits(switched, molecules(3, 0.1), 3);
    check_bits(sum, molecules(3, 0.1), 3);
    // Both count whole numbers of 2^-26 here: those of the list of all go by the range too, those of molecules do not.
    check_bits(in_mixed(cavity), molecules(3, 0.1), 12);
    check_bits(in_mixed(switched), molecules(3, 0.1), 3);
    check_bits(in_mixed(near), molecules(3, 0.1), 3);
  }
}

TEST_CASE(
    "charges found by molecules in mixed precision have the forces of 113 bits to single precision, and energies "
    "of doubles",
    "[charged_molecules][mixed]") {
  const auto check = [](const auto& force, const ParticleSystem<double>& s) {
    Workspace kept;
    kept.put(NeighborList(1.5));
    const test::Evaluated mixed = test::evaluated<double>(in_mixed(force), s, &kept),
                          doubles = test::evaluated<double>(force, s), exact = test::evaluated<Quad>(force, s);
    REQUIRE_FALSE(mixed.failure);
    CHECK(by_molecules(kept));
    CHECK(mixed.energy == doubles.energy);
    CHECK(mixed.virial == doubles.virial);
    // Each of some 200 pairs is rounded to a unit, and has single precision of the strongest. Their sum has no sign.
    const double strongest = exact.a.all().cwiseAbs().maxCoeff();
    const double unit = std::ldexp(1.0, std::ilogb(100 * 0.64 / (1.5 * 1.5)) + 1 - 26);
    const double error = std::sqrt((mixed.a.all() - exact.a.all()).squaredNorm() / static_cast<double>(s.size()));
    CHECK(test::largest_difference(mixed.a, exact.a) < 30 * unit + 0x1p-21 * strongest);
    CHECK(error < 10 * unit + 0x1p-23 * strongest);
    CHECK(error > 1e-9 * strongest);  // it is not in doubles
  };
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    CAPTURE(name(level));
    check(cavity, molecules(3, 0.1));
    check(switched, molecules(3, 0.1));
    check(near, molecules(3, 0.1));
  }
}

TEST_CASE("in mixed precision whatever finds molecules gives the same bits, and their forces add up to nothing",
          "[charged_molecules][mixed][determinism]") {
  const ParticleSystem<double> s = molecules(4, 0.1);
  test::check_bits_of_lists(in_mixed(cavity), s, 1.5);
  test::check_old_lists(in_mixed(cavity), molecules(3, 0.1), 1.5);
  const double unit = std::ldexp(1.0, std::ilogb(100 * 0.64 / (1.5 * 1.5)) + 1 - 26);  // of charges of 0.8
  VectorColumn<double> forces = test::evaluated<double>(in_mixed(cavity), s).a;
  for (Index i = 0; i < s.size(); ++i) forces.set(i, s.masses()[i] * std::as_const(forces)[i]);
  test::check_sum_is_zero(forces, unit);
}

TEST_CASE("sites on top of each other are summed with care by molecules too", "[charged_molecules][determinism]") {
  ParticleSystem<double> s = molecules(3, 0.1);
  const auto put_on = [&](const Vec3<double>& from) {  // site 40 of its molecule there, beside site 0 and as fast
    const Vec3<double> x = std::as_const(s).positions()[0], v = std::as_const(s).velocities()[0];
    const Vec3<double> by = x + from - std::as_const(s).positions()[40];
    for (Index i = 39; i < 42; ++i) s.positions().add(i, by), s.velocities().set(i, v);
    s.wrap();
  };
  put_on({0.03, 0.01, 0});
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    check_bits(cavity, s, 1);
    check_bits(in_mixed(cavity), s, 1);
  }
  // And a pair too strong for any sum names its particles in the system.
  put_on(Vec3<double>::Zero());
  for (const ReactionFieldForce& force : {cavity, in_mixed(cavity)}) {
    const test::Evaluated found = test::evaluated<double>(force, s),
                          expected = test::evaluated<double>(force, one_by_one(s));
    REQUIRE(found.failure);
    REQUIRE(expected.failure);
    CHECK(found.failure->message == expected.failure->message);
  }
}

TEST_CASE("charges found by molecules are those of 113 bits, and depend on no list and no thread",
          "[charged_molecules][determinism]") {
  const ParticleSystem<double> s = molecules(4, 0.1);
  const test::Evaluated lanes = test::evaluated<double>(cavity, s), exact = test::evaluated<Quad>(cavity, s);
  CHECK(test::largest_difference(lanes.a, exact.a) < 1e-11);
  CHECK(std::abs(lanes.energy - exact.energy) < 1e-10);
  CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-10);
  test::check_bits_of_lists(cavity, s, 1.5);
}

TEST_CASE("charges that are in no such molecules, or in a box that is too small for them, are found pair by pair",
          "[charged_molecules]") {
  const auto check = [](const ParticleSystem<double>& s) {
    Workspace kept;
    kept.put(NeighborList(1.5));
    const test::Evaluated found = test::evaluated<double>(cavity, s, &kept), exact = test::evaluated<Quad>(cavity, s);
    REQUIRE_FALSE(found.failure);
    CHECK(test::largest_difference(found.a, exact.a) < 1e-11);
    CHECK_FALSE(by_molecules(kept));
    if (!s.box().is_periodic()) return;
    const test::Evaluated mixed = test::evaluated<double>(in_mixed(cavity), s, &kept);
    CHECK(test::largest_difference(mixed.a, exact.a) < 1e-6 * (100 + exact.a.all().cwiseAbs().maxCoeff()));
    CHECK_FALSE(by_molecules(kept));
  };
  ParticleSystem<double> other = molecules(3, 0.1);
  other.column<Charge>()[4] = 0.3;  // of another kind
  check(other);
  ParticleSystem<double> ion = molecules(3, 0.1);
  const Vec3<double> away(0.3, 0.3, 0.6);
  ion.column<Charge>()[ion.add("", 1, away, Vec3<double>::Zero())] = 1;
  check(ion);
  ParticleSystem<double> bonded = molecules(3, 0.1);
  auto topology = std::make_shared<Topology>(*bonded.topology());
  topology->exclusions.insert(topology->exclusions.begin() + 2, {0, 5});  // two molecules that are one
  bonded.set_topology(topology);
  check(bonded);
  check(molecules(1, 0.1));
  ParticleSystem<double> open = molecules(2, 0.1);
  open.set_box(Box::open());
  check(open);

  // Charges that become others are found anew; those without a charge are nobody.
  ParticleSystem<double> s = molecules(3, 0.1);
  Workspace kept;
  kept.put(NeighborList(1.5));
  static_cast<void>(test::evaluated<double>(cavity, s, &kept));
  REQUIRE(by_molecules(kept));
  for (Index i = 0; i < s.size(); ++i) s.column<Charge>()[i] *= 1.5;
  CHECK(test::evaluated<double>(cavity, s, &kept).a.all() == test::evaluated<double>(cavity, one_by_one(s)).a.all());
  CHECK(by_molecules(kept));
}

}  // namespace noether
