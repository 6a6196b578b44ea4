// Ends of pair forces as other programs have them: against their formulas as their manuals print them, OpenMM's
// numbers, and integrals; the reaction field of excluded pairs as in GROMACS.

#include "engine/charge.hpp"
#include "forces/check_gradient.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/pair_potentials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"

#include <cmath>
#include <memory>
#include <numbers>

namespace noether {
namespace {

using test::evaluated;
using test::Evaluated;

/// Argon as OpenMM was given it (tests/data/openmm/make.py), in nm and kJ/mol.
constexpr double sigma = 0.34, epsilon = 0.996, switch_begin = 0.9, switch_end = 1.1;

LennardJonesForce argon(Cutoff style) {
  return {.cutoff = switch_end, .cutoff_style = style, .switch_from = switch_begin, .epsilon = epsilon, .sigma = sigma};
}

struct Found {
  double energy, force;  ///< the force drives the two apart
};

template <class Real, class F> Found pair_at(double r, const F& force, double mass = 1) {
  ParticleSystem<double> s;
  s.add("", mass, {0, 0, 0}, {0, 0, 0});
  s.add("", mass, {r, 0, 0}, {0, 0, 0});
  const Evaluated all = evaluated<Real>(force, s);
  return {all.energy, mass * all.a.component(0)[1]};
}

/// The energy of two charges at a distance r, and the force that drives them apart, from an energy in closed form.
template <class Energy> Found closed(const Energy& energy, double r) {
  const Quad h(1e-9), x(r);
  return {static_cast<double>(energy(x)), static_cast<double>((energy(x - h) - energy(x + h)) / (h + h))};
}

Quad bare(const Quad& r) {
  const Quad s2 = Quad(sigma) * Quad(sigma) / (r * r), s6 = s2 * s2 * s2;
  return Quad(4 * epsilon) * s6 * (s6 - Quad(1));
}

/// OpenMM's manual, "Lennard-Jones interaction", S = 1 - 6 x^5 + 15 x^4 - 10 x^3; GROMACS's potential switch is the
/// same.
Quad switched_by_openmm(const Quad& r) {
  if (r <= Quad(switch_begin)) return bare(r);
  const Quad x = (r - Quad(switch_begin)) / (Quad(switch_end) - Quad(switch_begin));
  return bare(r) * (Quad(1) - Quad(6) * x * x * x * x * x + Quad(15) * x * x * x * x - Quad(10) * x * x * x);
}

/// LAMMPS's manual of pair_style lj/charmm: S = (rc^2 - r^2)^2 (rc^2 + 2 r^2 - 3 rs^2) / (rc^2 - rs^2)^3.
Quad switched_by_charmm(const Quad& r) {
  if (r <= Quad(switch_begin)) return bare(r);
  const Quad c2 = Quad(switch_end) * Quad(switch_end), s2 = Quad(switch_begin) * Quad(switch_begin), r2 = r * r,
             w = c2 - s2;
  return bare(r) * (c2 - r2) * (c2 - r2) * (c2 + Quad(2) * r2 - Quad(3) * s2) / (w * w * w);
}

/// GROMACS's manual, "Modified non-bonded interactions": of r^-a the potential r^-a - A/3 (r - r1)^3 - B/4 (r - r1)^4 -
/// C.
Quad power_by_gromacs(int a, const Quad& r) {
  const auto power = [](const Quad& x, int n) {
    Quad product(1);
    for (int k = 0; k < n; ++k) product *= x;
    return product;
  };
  const Quad alpha(a), rc(switch_end), r1(switch_begin), w = rc - r1;
  const Quad A = -alpha * ((alpha + Quad(4)) * rc - (alpha + Quad(1)) * r1) / (power(rc, a + 2) * w * w);
  const Quad B = alpha * ((alpha + Quad(3)) * rc - (alpha + Quad(1)) * r1) / (power(rc, a + 2) * w * w * w);
  const Quad C = Quad(1) / power(rc, a) - A / Quad(3) * power(w, 3) - B / Quad(4) * power(w, 4);
  const Quad x = r > r1 ? r - r1 : Quad(0);
  return Quad(1) / power(r, a) - A / Quad(3) * power(x, 3) - B / Quad(4) * power(x, 4) - C;
}
Quad forces_switched_by_gromacs(const Quad& r) {
  const Quad s3 = Quad(sigma) * Quad(sigma) * Quad(sigma), s6 = s3 * s3;
  return Quad(4 * epsilon) * (s6 * s6 * power_by_gromacs(12, r) - s6 * power_by_gromacs(6, r));
}

/// int f dr by Simpson's rule.
template <class F> Quad integral(const F& f, double a, double b) {
  constexpr int n = 2000;
  const Quad h = (Quad(b) - Quad(a)) / Quad(n);
  Quad sum = f(Quad(a)) + f(Quad(b));
  for (int k = 1; k < n; ++k) sum += Quad(k % 2 == 1 ? 4 : 2) * f(Quad(a) + Quad(k) * h);
  return sum * h / Quad(3);
}

/// 216 atoms of argon on a lattice, in a box of 2.4 nm.
ParticleSystem<double> lattice() {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({2.4, 2.4, 2.4}));
  for (int k = 0; k < 216; ++k) s.add("", 1, 0.4 * Vec3<double>(k % 6, k / 6 % 6, k / 36), {0, 0, 0});
  return s;
}

/// What a tail adds: its energy, and a third of the trace of its virial.
Found tail_of(LennardJonesForce force, const ParticleSystem<double>& s) {
  const Evaluated without = evaluated<Quad>(force, s);
  force.tail = true;
  const Evaluated with = evaluated<Quad>(force, s);
  return {with.energy - without.energy, (with.virial - without.virial).trace() / 3};
}

/// Three charges in a row, the first two excluded from each other, the first and the last scaled to a half.
ParticleSystem<double> three_charges(const Box& box = Box::open()) {
  ParticleSystem<double> s;
  s.set_box(box);
  s.add("a", 1, {0.1, 0.2, 0.3}, {0, 0, 0});
  s.add("b", 2, {0.4, 0.2, 0.3}, {0, 0, 0});
  s.add("c", 3, {0.4, 0.6, 0.3}, {0, 0, 0});
  auto& q = s.add_column<Charge>();
  q[0] = 1.5;
  q[1] = -0.5;
  q[2] = 0.75;
  auto topology = std::make_shared<Topology>();
  topology->exclusions = {{0, 1}};
  topology->scaled_pairs = {{{0, 2}, 0.5}};
  s.set_topology(topology);
  return s;
}

}  // namespace

TEST_CASE("pairs end as the manuals of OpenMM, GROMACS, CHARMM and LAMMPS print it", "[pair_force][cutoff]") {
  for (const double r : {0.33, 0.5, 0.875, 0.90625, 0.9375, 1.0, 1.0625, 1.09375}) {
    CAPTURE(r);
    const auto check = [&](Cutoff style, const auto& energy) {
      CAPTURE(static_cast<int>(style));
      const Found expected = closed(energy, r);
      const Found exact = pair_at<Quad>(r, argon(style)), lanes = pair_at<double>(r, argon(style));
      const Found own =
          pair_at<double>(r, PairForce<LennardJonesPair>{{epsilon, sigma}, switch_end, style, switch_begin});
      // The shift of a force switch, 0.004, is a double.
      CHECK(std::abs(exact.energy - expected.energy) < 1e-13 * std::abs(expected.energy) + 0.004 * 0x1p-52);
      CHECK(std::abs(exact.force - expected.force) < 1e-13 * std::abs(expected.force));
      // Lanes count units of 2^-47 of 24 epsilon/sigma = 70, energies of the cutoff's power of two times as much.
      for (const Found& one : {lanes, own}) {
        CHECK(std::abs(one.energy - expected.energy) < 4e-12 + 1e-13 * std::abs(expected.energy));
        CHECK(std::abs(one.force - expected.force) < 4e-12 + 1e-13 * std::abs(expected.force));
      }
    };
    check(Cutoff::potential_switch, switched_by_openmm);
    check(Cutoff::charmm_switch, switched_by_charmm);
    check(Cutoff::force_switch, forces_switched_by_gromacs);
    check(Cutoff::shifted,
          [](const Quad& x) { return bare(x) - bare(Quad(switch_end)); });  // GROMACS's potential shift
  }
}

TEST_CASE("a switched pair has OpenMM's energy and force", "[pair_force][cutoff][oracle]") {
  // tests/data/openmm/make.py, OpenMM 8.6.1, platform Reference, in doubles.
  const struct {
    double r, energy, force;
  } openmm[] = {
      {0.5, -0.354945330758315, -3.79203132891136},        {0.875, -0.0136661770944584, -0.0933872508613062},
      {0.9375, -0.00860323681606988, -0.0864210708050527}, {1.0, -0.00307249664667009, -0.0760157695050731},
      {1.0625, -0.000208399395334726, -0.016051818495667}, {1.09375, -1.04534395123979e-06, -0.000499479287216351}};
  for (const auto& one : openmm) {
    CAPTURE(one.r);
    const Found found = pair_at<Quad>(one.r, argon(Cutoff::potential_switch));
    CHECK(std::abs(found.energy - one.energy) < 1e-13 * std::abs(one.energy) + 1e-16);
    CHECK(std::abs(found.force - one.force) < 1e-13 * std::abs(one.force) + 1e-16);
  }
}

TEST_CASE("the tail of a switch has what the switch takes away, by energy and virial", "[lennard_jones][cutoff]") {
  const ParticleSystem<double> s = lattice();
  const double pairs = 2 * std::numbers::pi * 216 * 216 / s.box().volume();
  const auto beyond = [](const Quad& c) {  // int_c^inf bare r^2 dr, closed
    const Quad s3 = Quad(sigma) * Quad(sigma) * Quad(sigma), s6 = s3 * s3, c3 = c * c * c;
    return Quad(4 * epsilon) * (s6 * s6 / (Quad(9) * c3 * c3 * c3) - s6 / (Quad(3) * c3));
  };
  const auto check = [&](Cutoff style, const auto& energy, double begin) {
    CAPTURE(static_cast<int>(style), begin);
    const Quad inside = integral([&](const Quad& r) { return (bare(r) - energy(r)) * r * r; }, begin, switch_end);
    const double expected = pairs * static_cast<double>(beyond(Quad(switch_end)) + inside);
    LennardJonesForce force = argon(style);
    force.switch_from = begin;
    const Found found = tail_of(force, s);
    CHECK(std::abs(found.energy - expected) < 1e-11 * std::abs(expected));
    CHECK(std::abs(found.force - expected) < 1e-11 * std::abs(expected));  // W = 3 E, without a jump at the cutoff
  };
  check(Cutoff::potential_switch, switched_by_openmm, switch_begin);
  check(Cutoff::charmm_switch, switched_by_charmm, switch_begin);
  for (const double begin : {0.3, 0.8, 1.09}) {
    const auto t_of = [begin](const Quad& r) {
      return (r * r - Quad(begin) * Quad(begin)) / (Quad(switch_end) * Quad(switch_end) - Quad(begin) * Quad(begin));
    };
    check(
        Cutoff::switch_c2,
        [&](const Quad& r) {
          const Quad t = t_of(r);
          return bare(r) * (Quad(1) - t * t * t * (Quad(10) - Quad(15) * t + Quad(6) * t * t));
        },
        begin);
  }
  // OpenMM's own correction, of a plain cutoff and of a switched one (make.py): printed in doubles as a difference;
  // that of the switch is 1.5e-10 of itself off the integral above.
  CHECK(
      std::abs(
          tail_of({.cutoff = switch_end, .cutoff_style = Cutoff::plain, .epsilon = epsilon, .sigma = sigma}, s).energy +
          32.6754000780955) < 1e-10);
  CHECK(std::abs(tail_of(argon(Cutoff::potential_switch), s).energy + 43.8557286783441) < 1e-8);
}

TEST_CASE("with a tail the energy of a switched liquid hardly depends on where the switch begins",
          "[lennard_jones][cutoff]") {
  // Where g(r) is 1: far out.
  ParticleSystem<double> s = test::liquid(6, 0.8442, 1, 0.1);
  const auto energy = [&](double begin, bool tail) {
    const LennardJonesForce force{.cutoff = 4,
                                  .cutoff_style = Cutoff::switch_c4,
                                  .switch_from = begin,
                                  .tail = tail,
                                  .epsilon = 1.0,
                                  .sigma = 1.0};
    return evaluated<double>(force, s).energy / static_cast<double>(s.size());
  };
  CHECK(std::abs(energy(2.5, false) - energy(3.9, false)) > 0.05);
  CHECK(std::abs(energy(2.5, true) - energy(3.9, true)) < 0.01);
}

TEST_CASE("the reaction field answers to excluded pairs and to each charge, as in GROMACS", "[charged_pairs][cutoff]") {
  // GROMACS's manual, "Coulomb interaction with reaction field": V = f q_i q_j (1/r + k_rf r^2 - c_rf), of excluded
  // pairs without the 1/r, and -c_rf f q_i^2 / 2 for each atom; of a scaled pair here 1/r alone is scaled.
  const ParticleSystem<double> s = three_charges();
  constexpr double radius = 0.9, dielectric = 78;
  const double k = (dielectric - 1) / (2 * dielectric + 1) / (radius * radius * radius),
               c = 1 / radius + k * radius * radius;
  const auto answer = [&](double product, double r) { return product * (k * r * r - c); };
  const double expected = 1.5 * -0.5 * 0 + answer(1.5 * -0.5, 0.3) + 0.5 * 1.5 * 0.75 / 0.5 + answer(1.5 * 0.75, 0.5) +
                          -0.5 * 0.75 / 0.4 + answer(-0.5 * 0.75, 0.4) - c / 2 * (1.5 * 1.5 + 0.5 * 0.5 + 0.75 * 0.75);
  const ReactionFieldForce force{{.radius = radius, .dielectric = dielectric, .answers_excluded = true}};
  const Evaluated exact = evaluated<Quad>(force, s), lanes = evaluated<double>(force, s);
  CHECK(std::abs(exact.energy - expected) < 1e-14);
  CHECK(std::abs(lanes.energy - expected) < 1e-11);
  CHECK(test::largest_difference(exact.a, lanes.a) < 1e-11);
  CHECK((exact.virial - lanes.virial).cwiseAbs().maxCoeff() < 1e-11);
  // Without it: what there was before.
  const double plain =
      0.5 * (1.5 * 0.75 / 0.5 + answer(1.5 * 0.75, 0.5)) + -0.5 * 0.75 / 0.4 + answer(-0.5 * 0.75, 0.4);
  CHECK(std::abs(evaluated<Quad>(ReactionFieldForce{{radius, dielectric}}, s).energy - plain) < 1e-14);
}

TEST_CASE("forces between excluded charges in a reaction field are the gradient of their energy",
          "[charged_pairs][cutoff]") {
  for (const Box& box : {Box::open(), Box::periodic({2, 2, 2}), Box::periodic({1.4, 1.5, 1.6})}) {
    for (const std::optional<double> begin : {std::optional<double>(), std::optional(0.25)}) {
      const ReactionFieldForce force{
          {.radius = 0.9, .dielectric = 10, .switched_from = begin, .answers_excluded = true}};
      CHECK(gradient_error(force, three_charges(box)) < 1e-12);
    }
  }
}

TEST_CASE("bits of a reaction field with its answers depend on no list and no thread", "[charged_pairs][determinism]") {
  ParticleSystem<double> s = test::with_two_types(test::liquid(5, 0.85, 1, 0.15));
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < s.size(); ++i) q[i] = i % 2 == 0 ? 0.7 : -0.7;
  test::check_bits_of_lists(ReactionFieldForce{{.radius = 2.5, .answers_excluded = true}}, s, 2.5);
  for (const Cutoff style : {Cutoff::potential_switch, Cutoff::force_switch}) {
    test::check_bits_of_lists(LennardJonesForce{.cutoff = 2.5, .cutoff_style = style}, s, 2.5);
  }
}

}  // namespace noether
