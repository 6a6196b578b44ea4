/// Potentials of pairs in lanes: against 113 bits, against the Lennard-Jones kernels, and where they break.

#include "forces/pair_force.hpp"

#include "engine/simulation.hpp"
#include "forces/check_gradient.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <memory>
#include <optional>

namespace noether {
namespace {

using test::evaluated;
using test::Evaluated;
using test::largest_difference;

/// As a user would write it.
struct TwelveSix {
  double epsilon = 1, sigma = 1;
  double scale() const { return 24 * epsilon / sigma; }
  template <class Real> PairTerms<Real> operator()(const Real& r2) const {
    const Real s2 = Real(sigma * sigma) / r2, s6 = s2 * s2 * s2;
    return {Real(4 * epsilon) * s6 * (s6 - Real(1)), Real(24 * epsilon) * s6 * (Real(2) * s6 - Real(1)) / r2};
  }
};

template <class P> PairForce<P> pair_force(const P& potential, double cutoff, Cutoff style) {
  return {potential, cutoff, style};
}

ParticleSystem<double> two_types(ParticleSystem<double> s) {
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"A", "B"};
  for (Index i = 0; i < s.size(); ++i) topology->types.push_back(i % 3 == 0 ? 1 : 0);
  topology->exclusions = {{0, 1}, {4, 9}};
  topology->scaled_pairs = {{{0, 2}, 0.5}, {{0, 3}, 0.25}};
  s.set_topology(topology);
  return s;
}

/// Lanes against 113 bits. @param scale  of the sums' unit
template <class F> void check_lanes(const F& force, const ParticleSystem<double>& s) {
  const Evaluated lanes = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
  REQUIRE_FALSE(lanes.failure);
  const double largest = std::max(1.0, exact.a.all().cwiseAbs().maxCoeff());
  CHECK(largest_difference(lanes.a, exact.a) < 3e-13 * largest + 60 * force.scale() * 0x1p-47);
  CHECK(std::abs(lanes.energy - exact.energy) < 1e-12 * force.scale() * static_cast<double>(s.size()));
  CHECK((lanes.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-11 * force.scale() * static_cast<double>(s.size()));
}

/// Twelve-six at the distance r, times a switch: its energy and the force that drives the pair apart.
struct SwitchedPair {
  long double energy, force;
};

/// From the polynomials as docs/structures.md writes them, term by term, and their derivatives.
SwitchedPair written_out(Cutoff style, long double r, long double from, long double to) {
  const auto power = [](long double x, int n) {
    long double product = 1;
    for (int k = 0; k < n; ++k) product *= x;
    return product;
  };
  const long double width = to * to - from * from, t = (r * r - from * from) / width;
  const long double energy = 4 / power(r, 12) - 4 / power(r, 6), force = 48 / power(r, 13) - 24 / power(r, 7);
  long double S = 1 - 10 * power(t, 3) + 15 * power(t, 4) - 6 * power(t, 5);
  long double slope = -30 * power(t, 2) + 60 * power(t, 3) - 30 * power(t, 4);
  if (style == Cutoff::switch_c4) {
    S = 1 - 126 * power(t, 5) + 420 * power(t, 6) - 540 * power(t, 7) + 315 * power(t, 8) - 70 * power(t, 9);
    slope = -630 * power(t, 4) + 2520 * power(t, 5) - 3780 * power(t, 6) + 2520 * power(t, 7) - 630 * power(t, 8);
  }
  return {energy * S, force * S - energy * slope * 2 * r / width};
}

/// A pair on the x axis in 113 bits, and in lanes, which sum whole units of 2^-47 of the scale, 24, and of energies
/// four times as large, by the power of two above the cutoff.
template <class F> void check_written_out(const F& force, Cutoff style, double r) {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({16, 16, 16}));
  s.add("", 1, {1, 1, 1}, {0, 0, 0});
  s.add("", 1, {1 + r, 1, 1}, {0, 0, 0});
  const SwitchedPair truth = written_out(style, r, 1.5L, 2.5L);
  const auto error = [](double found, long double right) { return std::abs(static_cast<double>(found - right)); };
  const auto size = [](long double right) { return std::abs(static_cast<double>(right)); };
  const Evaluated exact = evaluated<Quad>(force, s);
  CHECK(error(exact.energy, truth.energy) < 1e-14 * size(truth.energy));
  CHECK(error(exact.a.component(0)[1], truth.force) < 1e-14 * size(truth.force));
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    const Evaluated lanes = evaluated<double>(force, s);
    CHECK(error(lanes.energy, truth.energy) < 24 * 0x1p-45 + 1e-14 * size(truth.energy));
    CHECK(error(lanes.a.component(0)[1], truth.force) < 24 * 0x1p-47 + 1e-14 * size(truth.force));
  }
}

}  // namespace

TEST_CASE("scaled pairs are found by all threads, and add up to the same bits", "[pair_force]") {
  ParticleSystem<double> s = test::liquid(6, 0.85, 1, 0.05);
  auto topology = std::make_shared<Topology>();
  for (Index i = 0; i + 2 < s.size(); ++i) {
    topology->scaled_pairs.push_back({{i, i + 1}, 0.5});
    topology->scaled_pairs.push_back({{i, i + 2}, 0.25});
  }
  s.set_topology(topology);
  const auto check = [&](const auto& force) {
    std::optional<Evaluated> one;
    for (const int threads : {1, 2, 3, 8}) {
      const test::Threads now(threads);
      CAPTURE(threads);
      const Evaluated found = evaluated<double>(force, s);
      REQUIRE_FALSE(found.failure);
      if (!one) one = found;
      CHECK(largest_difference(found.a, one->a) == 0);
      CHECK(found.energy == one->energy);
      CHECK(found.virial == one->virial);
    }
    check_lanes(force, s);
  };
  check(pair_force(TwelveSix{}, 2.5, Cutoff::shifted_force));
  struct WithScale : LennardJonesForce {
    double scale() const { return 24; }
  };
  WithScale argon;
  argon.cutoff = 2.5;
  argon.epsilon = argon.sigma = 1.0;
  check(argon);
}

TEST_CASE("switches are the polynomials in r^2 that are written down, in energy and force", "[pair_force]") {
  for (const Cutoff style : {Cutoff::switch_c2, Cutoff::switch_c4}) {
    for (int k = 1; k <= 10; ++k) {
      const double r = 1.5 + k * 93 / 1024.0;  // exact, and so is its place on the grid of the box
      CAPTURE(static_cast<int>(style), r);
      const LennardJonesForce built_in{
          .cutoff = 2.5, .cutoff_style = style, .switch_from = 1.5, .epsilon = 1.0, .sigma = 1.0};
      check_written_out(built_in, style, r);
      check_written_out(PairForce<TwelveSix>{TwelveSix{}, 2.5, style, 1.5}, style, r);
    }
  }
}

TEST_CASE("pairs of any potential in lanes are those of 113 bits, for every end of the range", "[pair_force]") {
  const Cutoff style =
      GENERATE(Cutoff::plain, Cutoff::shifted, Cutoff::shifted_force, Cutoff::switch_c2, Cutoff::switch_c4,
               Cutoff::potential_switch, Cutoff::charmm_switch, Cutoff::force_switch);
  for (const SimdLevel level : test::all_levels()) {
    const test::AtLevel at(level);
    CAPTURE(name(level), static_cast<int>(style));
    for (const auto& s :
         {test::liquid(3, 0.85, 1, 0.1), two_types(test::liquid(3, 0.6, 1, 0.1)), test::liquid(1, 0.85, 1, 0.1)}) {
      check_lanes(pair_force(TwelveSix{}, 2.2, style), s);
      check_lanes(pair_force(MorsePair{1.7, 4.5, 1.15}, 2.0, style), s);
      check_lanes(pair_force(Buckingham{2500, 0.18, 3.1}, 2.1, style), s);
      check_lanes(WcaForce{{1.3, 1.05}}, s);
      if (s.topology() == nullptr) continue;
      MorseForce some = pair_force(MorsePair{1.7, 4.5, 1.15}, 2.0, style);
      some.first = "B";
      some.second = "A";
      check_lanes(some, s);
    }
  }
}

TEST_CASE("forces of pair potentials are the gradients of their energies", "[pair_force]") {
  const ParticleSystem<double> s = test::liquid(1, 0.6, 1, 0.05);
  for (const Cutoff style : {Cutoff::shifted, Cutoff::shifted_force, Cutoff::switch_c2, Cutoff::switch_c4,
                             Cutoff::potential_switch, Cutoff::charmm_switch, Cutoff::force_switch}) {
    CAPTURE(static_cast<int>(style));
    CHECK(gradient_error(pair_force(MorsePair{1.7, 4.5, 1.15}, 2.0, style), s) < 1e-12);
    CHECK(gradient_error(pair_force(Buckingham{2500, 0.18, 3.1}, 2.1, style), s) < 1e-12);
  }
  CHECK(gradient_error(WcaForce{{1.3, 1.3}}, s) < 1e-12);
}

TEST_CASE("twelve-six written by a user is Lennard-Jones", "[pair_force]") {
  const ParticleSystem<double> s = test::liquid(4, 0.85, 1, 0.1);
  for (const Cutoff style : {Cutoff::plain, Cutoff::shifted_force, Cutoff::switch_c4, Cutoff::force_switch}) {
    const Evaluated own = evaluated<double>(pair_force(TwelveSix{}, 2.5, style), s);
    const Evaluated built_in =
        evaluated<double>(LennardJonesForce{.cutoff = 2.5, .cutoff_style = style, .epsilon = 1.0, .sigma = 1.0}, s);
    CHECK(largest_difference(own.a, built_in.a) < 1e-10);
    CHECK(std::abs(own.energy - built_in.energy) < 1e-9);
    CHECK((own.virial - built_in.virial).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("bits of pair potentials depend on no neighbor list, thread or monitor", "[pair_force][determinism]") {
  test::check_bits_of_lists(pair_force(MorsePair{1.7, 4.5, 1.15}, 2.5, Cutoff::shifted_force),
                            test::liquid(5, 0.85, 1, 0.15), 2.5);
}

TEST_CASE("a list that is some steps old gives pairs of two types the bits of a new one", "[pair_force][determinism]") {
  auto force = pair_force(MorsePair{1.7, 4.5, 1.15}, 2.5, Cutoff::shifted_force);
  force.first = "A";
  force.second = "B";
  test::check_old_lists(force, two_types(test::liquid(4, 0.85, 1.5, 0.1)), 2.5);
}

TEST_CASE("strong pairs are summed with care, and the strongest end the run by name", "[pair_force][extremes]") {
  ParticleSystem<double> s = test::liquid(2, 0.8, 1);
  const Vec3<double> x = s.positions()[3];
  s.add("", 1, x + Vec3<double>(0.5, 0, 0), {0, 0, 0});  // 2^14 times the scale
  const auto force = pair_force(TwelveSix{}, 1.9, Cutoff::shifted_force);
  const Evaluated lanes = evaluated<double>(force, s), exact = evaluated<Quad>(force, s);
  CHECK_FALSE(lanes.failure);
  CHECK(largest_difference(lanes.a, exact.a) < 1e-14 * exact.a.all().cwiseAbs().maxCoeff());
  s.add("", 1, x + Vec3<double>(0, 1e-3, 0), {0, 0, 0});
  const Evaluated strong = evaluated<double>(force, s);
  REQUIRE(strong.failure);
  CHECK(strong.failure->kind == Outcome::Kind::overlap);
  CHECK(strong.failure->message == "particles 3 and 33 are 0.001 apart, too close for their pair force");
  s.add("", 1, x, {0, 0, 0});
  CHECK(evaluated<double>(force, s).failure);

  // Exactly on top of each other, whoever comes after them in the list.
  for (Index i = 1; i < 32; ++i) {
    ParticleSystem<double> two = test::liquid(2, 0.8, 1);
    two.positions().set(i, two.positions()[0]);
    const auto failure = evaluated<double>(force, two).failure;
    REQUIRE(failure);
    CHECK(failure->kind == Outcome::Kind::overlap);
  }
}

TEST_CASE("Buckingham's catastrophe is caught at the top of its barrier", "[pair_force][extremes]") {
  const Buckingham helium{2500, 0.18, 3.1};
  const double top = helium.nearest();
  CHECK(std::abs(helium(top * top).force) < 1e-9 * helium.scale());
  CHECK(helium(0.99 * top * 0.99 * top).force < 0);  // falls in
  CHECK(helium(1.01 * top * 1.01 * top).force > 0);
  ParticleSystem<double> s;
  s.set_box(Box::periodic({9, 9, 9}));
  s.add("He", 1, {1, 1, 1}, {4, 0, 0});
  s.add("other", 1, {3, 1, 1}, {0, 0, 0});
  Simulation<double> slow(
      s, Composition(test::kinetic_potential(pair_force(helium, 2.1, Cutoff::shifted_force)), schemes::verlet), 1e-3);
  CHECK(slow.run(5000).ok());
  s.velocities().set(0, {400, 0, 0});
  const auto fall = [&](bool watched) {
    Simulation<double> fast(
        s, Composition(test::kinetic_potential(pair_force(helium, 2.1, Cutoff::shifted_force)), schemes::verlet), 1e-5);
    if (watched) fast.every(1, Energy{});
    return fast.run(5000);
  };
  const Outcome outcome = fall(false);
  CHECK(outcome.kind == Outcome::Kind::overlap);
  // 2 - top at a speed of 400 and 1e-5 a step, a little less as they slow down: the step does not depend on who looks.
  CHECK(std::abs(static_cast<double>(outcome.step) - (2 - top) / 400e-5) < 3);
  CHECK(fall(true).step == outcome.step);
}

TEST_CASE("the exponential of pair potentials is within an ulp", "[pair_force]") {
  for (double x = -700; x < 700; x += 0.37) {
    const Quad exact = exp(Quad(x));
    const auto rounded = static_cast<double>(exact);
    CHECK(abs(Quad(pair_exp(x)) - exact) <= Quad(std::nextafter(rounded, 1e308) - rounded));
  }
}

TEST_CASE("pair potentials that make no sense are refused", "[pair_force][messages]") {
  const auto refusal = [](const auto& force, const ParticleSystem<double>& s = two_types(test::liquid(1, 0.5, 1))) {
    return test::refusal_of([&] { check_force(force, s); });
  };
  MorseForce morse = pair_force(MorsePair{1, 2, 1}, 2.0, Cutoff::plain);
  CHECK(refusal(morse).empty());
  morse.first = "A";
  CHECK(refusal(morse) == "first = \"A\" is given alone; give both first and second, or neither");
  morse.second = "C";
  CHECK(refusal(morse) == "second = \"C\" is not a type of the particles; expected one of: A, B");
  CHECK(refusal(morse, test::liquid(1, 0.5, 1)) == "first = \"A\" is not a type of the particles; they have no types");
  CHECK(refusal(pair_force(MorsePair{1, 2, 1}, 0, Cutoff::plain)) ==
        "cutoff = 0 is not a valid cutoff; a length above 0 is expected");
  CHECK(refusal(pair_force(MorsePair{-1, 2, 1}, 2, Cutoff::plain)) ==
        "depth = -1 is not a valid depth of a well; an energy above 0 is expected");
  CHECK(refusal(pair_force(Buckingham{100, 0.1, 5}, 2, Cutoff::plain)) ==
        "C = 5 is so strong that these pairs attract at every distance; less than 125.162 A rho^6 is needed for a "
        "barrier");
  CHECK(refusal(pair_force(Buckingham{100, 0.1, 125.17e-4}, 2, Cutoff::plain)).find("C = 0.012517 is so") == 0);
  CHECK(refusal(pair_force(Buckingham{100, 0.1, 125.16e-4}, 2, Cutoff::plain)).empty());
  for (const Cutoff style : {Cutoff::plain, Cutoff::shifted, Cutoff::shifted_force}) {
    morse = pair_force(MorsePair{1, 2, 1}, 2.0, style);
    morse.switch_from = 1.5;
    CHECK(refusal(morse) ==
          "switch_from = 1.5 is for a switched cutoff only; take it out, or add cutoff_style = \"switch_c2\" or "
          "\"switch_c4\"");
  }
  morse.cutoff_style = Cutoff::switch_c2;
  CHECK(refusal(morse).empty());
  CHECK(refusal(WcaForce{{1, 0}}) == "sigma = 0 is not a valid length; a length above 0 is expected");
}

}  // namespace noether
