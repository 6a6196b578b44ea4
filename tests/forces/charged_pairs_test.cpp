/// Pair potentials between charges, and several of them in one loop: closed forms, 113 bits, sums of their parts.

#include "engine/charge.hpp"
#include "forces/check_gradient.hpp"
#include "forces/fused_pair.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/sum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace noether {
namespace {

/// Charges of both signs and many strengths, the whole without charge.
ParticleSystem<double> charged(ParticleSystem<double> s) {
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = (i % 2 == 0 ? 1 : -1) * (0.25 + 0.125 * static_cast<double>(i / 2 % 7));
  return s;
}

using Salt = PairForce<Pair<LennardJonesPair, ReactionField>>;

Salt salt(Cutoff style, double dielectric = 78.3) { return {{{1.0, 1.0}, {2.2, dielectric}}, 2.2, style}; }

/// Lanes against 113 bits. @param scale  a strong force
template <class F> void check_charges_in_lanes(const F& force, const ParticleSystem<double>& s, double scale) {
  const test::Evaluated lanes = test::evaluated<double>(force, s), exact = test::evaluated<Quad>(force, s);
  REQUIRE_FALSE(lanes.failure);
  CHECK(exact.a.all().cwiseAbs().maxCoeff() > 0.005);
  const double largest = std::max(1.0, exact.a.all().cwiseAbs().maxCoeff());
  CHECK(test::largest_difference(lanes.a, exact.a) < 3e-13 * largest + 60 * scale * 0x1p-47);
  CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 * scale * static_cast<double>(s.size()));
  CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-11 * scale * static_cast<double>(s.size()));
}

}  // namespace

TEST_CASE("two charges in a cavity have the energy and the force of the closed form", "[charged_pairs]") {
  ParticleSystem<double> s(unit_system("molecular"));
  s.add("Na", 22.99, {0, 0, 0}, {0, 0, 0});
  s.add("Cl", 35.45, {0.3, 0, 0}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1;
  s.column<Charge>()[1] = -1;
  constexpr double coulomb = 138.935458, radius = 0.9;  // kJ nm / mol / e^2
  for (const std::optional<double> dielectric : {std::optional(1.0), std::optional(78.3), std::optional<double>()}) {
    const double k = dielectric ? (*dielectric - 1) / (2 * *dielectric + 1) : 0.5;
    const auto expected = [&](double r) {
      return -coulomb * (1 / r + k * r * r / (radius * radius * radius) - (1 + k) / radius);
    };
    const test::Evaluated all = test::evaluated<double>(ReactionFieldForce{{radius, dielectric}}, s);
    CHECK(std::abs(all.energy - expected(0.3)) < 1e-8 * std::abs(expected(0.3)));
    const double force = (expected(0.3 + 1e-5) - expected(0.3 - 1e-5)) / 2e-5;  // Na is drawn to Cl
    CHECK(std::abs(22.99 * all.a.component(0)[0] - force) < 1e-7 * force);
    CHECK(std::abs(35.45 * all.a.component(0)[1] + force) < 1e-7 * force);
  }
  // In a conductor nothing jumps at the radius.
  s.positions().set(1, {radius * (1 - 1e-9), 0, 0});
  const test::Evaluated last = test::evaluated<double>(ReactionFieldForce{{radius}}, s);
  CHECK(std::abs(last.energy) < 1e-12);
  CHECK(std::abs(22.99 * last.a.component(0)[0]) < 1e-5);
  s.positions().set(1, {radius, 0, 0});
  CHECK(test::evaluated<double>(ReactionFieldForce{{radius}}, s).energy == 0);
}

TEST_CASE("a switch takes the reaction field to 0 with four derivatives, and leaves it alone where it has not begun",
          "[charged_pairs]") {
  ParticleSystem<double> s(unit_system("molecular"));
  s.add("Na", 22.99, {0, 0, 0}, {0, 0, 0});
  s.add("Cl", 35.45, {0.3, 0, 0}, {0, 0, 0});
  s.add_column<Charge>()[0] = 1;
  s.column<Charge>()[1] = -1;
  constexpr double radius = 0.9, from = 0.8;
  const ReactionFieldForce bare{{radius}}, switched{{.radius = radius, .switched_from = from}};
  const auto at = [&](const ReactionFieldForce& force, double r) {
    s.positions().set(1, {r, 0, 0});
    const test::Evaluated all = test::evaluated<double>(force, s);
    return std::pair<double, double>(all.energy, 22.99 * all.a.component(0)[0]);
  };
  for (const double r : {0.1, 0.3, 0.5, from}) CHECK(at(switched, r) == at(bare, r));
  for (const double r : {0.805, 0.83, 0.86, 0.89}) {
    const double t = (r * r - from * from) / (radius * radius - from * from);
    const double off = 1 + std::pow(t, 5) * (-126 + t * (420 + t * (-540 + t * (315 - 70 * t))));
    CHECK(std::abs(at(switched, r).first - off * at(bare, r).first) < 1e-9);  // grains of a sum
    const double h = 1e-5, slope = (at(switched, r + h).first - at(switched, r - h).first) / (2 * h);
    CHECK(std::abs(at(switched, r).second - slope) < 1e-5);
  }
  // Near its end the bare force falls as the distance to it, the switched one as its fifth power and faster.
  CHECK(std::abs(at(bare, radius - 1e-3).second) > 0.1);
  CHECK(std::abs(at(switched, radius - 1e-3).second) < 1e-5);
}

TEST_CASE("charges in lanes are those of 113 bits, for every end of the range", "[charged_pairs]") {
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    for (const auto& s :
         {charged(test::liquid(3, 0.85, 1, 0.1)), charged(test::with_two_types(test::liquid(3, 0.5, 1, 0.2))),
          charged(test::liquid(1, 0.85, 1, 0.1))}) {
      CAPTURE(name(level), s.size());
      check_charges_in_lanes(ReactionFieldForce{{2.2, 78.3}}, s, 25);
      check_charges_in_lanes(ReactionFieldForce{{2.2, 78.3, 2.0}}, s, 25);
      for (const Cutoff style : test::cutoff_styles) check_charges_in_lanes(salt(style), s, 50);
    }
  }
}

TEST_CASE("potentials in one loop are the sum of potentials in loops of their own", "[charged_pairs]") {
  const auto s = charged(test::with_two_types(test::liquid(4, 0.85, 1, 0.1)));
  const auto check = [&](const auto& fused, const auto& apart) {
    const test::Evaluated one = test::evaluated<double>(fused, s), other = test::evaluated<double>(apart, s);
    CHECK(test::largest_difference(one.a, other.a) < 1e-10);
    CHECK(std::abs(one.energy - other.energy) < 1e-9);
    CHECK((one.virial - other.virial).cwiseAbs().maxCoeff() < 1e-9);
  };
  const LennardJonesPair atoms{1, 1};
  for (const Cutoff style : test::cutoff_styles) {
    // These act on all that is within the range, and so on the reaction field.
    const bool of_the_sum = detail::is_switched(style) && style != Cutoff::force_switch;
    if (style == Cutoff::shifted_force || of_the_sum) continue;
    check(salt(style), Sum(PairForce<LennardJonesPair>{atoms, 2.2, style}, ReactionFieldForce{{2.2, 78.3}}));
  }
  // The end of a range of its own is an end in company too.
  const MorsePair well{1.7, 4.5, 1.15};
  check(PairForce<Pair<Wca, MorsePair>>{{Wca{1.3, 1.05}, well}, 2.0, Cutoff::shifted_force},
        Sum(WcaForce{{1.3, 1.05}}, MorseForce{well, 2.0, Cutoff::shifted_force}));
  check(PairForce<Pair<Wca, ReactionField>>{{Wca{1.3, 1.05}, ReactionField{2.2}}},
        Sum(WcaForce{{1.3, 1.05}}, ReactionFieldForce{{2.2}}));
  STATIC_REQUIRE(PairForce<Pair<Wca, ReactionField>>::ends_by_itself);
  STATIC_REQUIRE_FALSE(Salt::ends_by_itself);
}

TEST_CASE("forces between charges are the gradients of their energies", "[charged_pairs]") {
  const auto s = charged(test::liquid(1, 0.6, 1, 0.05));
  CHECK(gradient_error(ReactionFieldForce{{2.2}}, s) < 1e-12);
  CHECK(gradient_error(ReactionFieldForce{{2.2, 78.3, 1.9}}, s) < 1e-12);
  for (const Cutoff style : {Cutoff::shifted_force, Cutoff::switch_c2, Cutoff::switch_c4}) {
    CHECK(gradient_error(salt(style), s) < 1e-12);
  }
}

TEST_CASE("bits of charged pairs depend on no neighbor list, thread or monitor", "[charged_pairs][determinism]") {
  test::check_bits_of_lists(salt(Cutoff::shifted), charged(test::liquid(5, 0.85, 1, 0.15)), 2.2);
  test::check_old_lists(salt(Cutoff::shifted), charged(test::liquid(4, 0.85, 1, 0.1)), 2.2);
}

TEST_CASE("charged pairs that make no sense are refused by name", "[charged_pairs][messages]") {
  const auto refusal = [](const auto& force, const ParticleSystem<double>& s) {
    return test::refusal_of([&] { check_force(force, s); });
  };
  const auto neutral = test::liquid(1, 0.5, 1);
  CHECK(refusal(ReactionFieldForce{{2.0}}, charged(neutral)).empty());
  CHECK(
      refusal(ReactionFieldForce{{2.0}}, neutral) ==
      "force 'reaction_field' acts between charges, but the particles have none; give charges, or take the force out");
  CHECK(refusal(ReactionFieldForce{{0}}, charged(neutral)) ==
        "cutoff = 0 is not a valid length; a length above 0 is expected");
  CHECK(refusal(ReactionFieldForce{{2, 0.5}}, charged(neutral)) ==
        "dielectric = 0.5 is not a valid relative permittivity; 1 or more is expected");
  CHECK(refusal(ReactionFieldForce{{2, {}, 2.5}}, charged(neutral)) ==
        "switch_from = 2.5 does not lie between 0 and the cutoff 2");
  CHECK(refusal(Salt{{{0, 1}, {2}}, 2}, charged(neutral)) ==
        "epsilon = 0 is not a valid strength; an energy above 0 is expected");
  // All of them 0: nothing acts, and nothing is divided by.
  auto none = neutral;
  none.add_column<Charge>();
  const test::Evaluated nothing = test::evaluated<double>(ReactionFieldForce{{2.0}}, none);
  CHECK(nothing.energy == 0);
  CHECK(nothing.a.all().cwiseAbs().maxCoeff() == 0);
  // One on top of another ends the run.
  auto both = charged(neutral);
  both.positions().set(1, both.positions()[0]);
  const auto failure = test::evaluated<double>(ReactionFieldForce{{2.0}}, both).failure;
  REQUIRE(failure);
  CHECK(failure->kind == Outcome::Kind::overlap);
}

}  // namespace noether
