// Dihedral angles: against angles that were built, the Boltzmann distribution of a torsion, and what must not change
// it.

#include "monitors/dihedrals.hpp"

#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

constexpr double pi = std::numbers::pi;

/// Four particles with this dihedral angle: the last is turned about the axis from the second to the third.
std::array<Vec3<double>, 4> built(double phi) {
  return {Vec3<double>(0.9, 0, -0.4), Vec3<double>(0, 0, 0), Vec3<double>(0, 0, 1.1),
          Vec3<double>(0.8 * std::cos(phi), 0.8 * std::sin(phi), 1.5)};
}

/// A rotation about (1, 1, 1) by 120 degrees and then about z by the angle of (3, 4, 5): rounds little.
Vec3<double> turned(const Vec3<double>& x) {
  const Vec3<double> y(x[2], x[0], x[1]);
  return {0.6 * y[0] - 0.8 * y[1], 0.8 * y[0] + 0.6 * y[1], y[2]};
}

/// Molecules of four with these angles, bonded by nothing but the names of their dihedrals; types a b b c.
ParticleSystem<double> molecules(const std::vector<double>& angles, const Box& box = Box::open()) {
  ParticleSystem<double> s;
  s.set_box(box);
  auto topology = std::make_shared<Topology>();
  topology->type_names = {"a", "b", "c"};
  topology->dihedral_kinds = {{"periodic", {1, 3, 0}}, {"periodic", {2, 1, 0}}, {"one_four", {0.4, 1.2, -0.7}}};
  for (const double phi : angles) {
    const auto at = static_cast<double>(s.size() / 4);
    for (const Vec3<double>& x : built(phi)) {
      const Index i = s.size() % 4;
      topology->types.push_back(i == 0 ? 0 : i < 3 ? 1 : 2);
      s.add("p" + std::to_string(s.size()), 1, turned(x) + Vec3<double>(0.7 * at, 3 + 0.1 * at, 5.9), {0, 0, 0});
    }
    const Index i = s.size() - 4;
    // Two terms on the same four, one from the other end, and one of their ends only.
    topology->dihedrals.push_back({{i, i + 1, i + 2, i + 3}, 0});
    topology->dihedrals.push_back({{i + 3, i + 2, i + 1, i}, 1});
    topology->dihedrals.push_back({{i, i + 1, i + 2, i + 3}, 2});
  }
  s.set_topology(topology);
  return s;
}

Dihedrals observed(const ParticleSystem<double>& s, const Dihedrals& asked) {
  Simulation<double> sim(s, compose(test::kinetic_potential(), schemes::verlet), 0.01);
  auto& monitor = sim.every(1, asked);
  REQUIRE(sim.run(0).ok());
  return monitor;
}

constexpr double torsion_barrier = 0.8, asymmetry = 0.5, asymmetry_phase = 1.0, torsion_kT = 1.0;
double torsion(double phi) {
  return torsion_barrier * (1 + std::cos(3 * phi)) + asymmetry * (1 + std::cos(phi - asymmetry_phase));
}

/// Molecules with springs for bonds and angles and that torsion, which feel nothing of each other.
Simulation<double> in_a_bath(Index count) {
  ParticleSystem<double> s;
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {60, 1}}};
  topology->angle_kinds = {{"harmonic", {20, 1.9}}};
  topology->dihedral_kinds = {{"periodic", {torsion_barrier, 3, 0}}, {"periodic", {asymmetry, 1, asymmetry_phase}}};
  for (Index m = 0; m < count; ++m) {
    for (const Vec3<double>& x : built(2.0 * pi * static_cast<double>(m) / static_cast<double>(count) - pi)) {
      s.add("", 1, x, {0, 0, 0});
    }
    const Index i = 4 * m;
    for (Index k = 0; k < 3; ++k) topology->bonds.push_back({{i + k, i + k + 1}, 0});
    for (Index k = 0; k < 2; ++k) topology->angles.push_back({{i + k, i + k + 1, i + k + 2}, 0});
    for (int type = 0; type < 2; ++type) topology->dihedrals.push_back({{i, i + 1, i + 2, i + 3}, type});
  }
  s.set_topology(topology);
  return Simulation<double>(
      std::move(s),
      compose(test::in_bath(test::field_of(Bonded{}), {.temperature = torsion_kT, .friction = 1, .seed = 5}),
              word("BAOAB")),
      0.04);
}

/// The part of the Boltzmann distribution of the torsion between two angles: that of phi alone, since neither the
/// springs nor the volume element r^2 dr sin(theta) dtheta dphi of each particle couple to phi.
double boltzmann(double from, double to) {
  const auto integral = [](double a, double b) {
    constexpr int n = 4000;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += std::exp(-torsion(a + (b - a) * (k + 0.5) / n) / torsion_kT);
    return sum * (b - a) / n;
  };
  return integral(from, to) / integral(-pi, pi);
}

}  // namespace

TEST_CASE("dihedral angles are those that were built, by sign and to rounding", "[dihedrals]") {
  std::vector<std::vector<std::string>> names;
  std::vector<double> angles;
  for (int degrees = -179; degrees <= 180; ++degrees) {
    const auto first = 4 * angles.size();
    names.push_back({});
    for (std::size_t k = 0; k < 4; ++k) names.back().push_back("p" + std::to_string(first + k));
    angles.push_back(degrees * pi / 180);
  }
  // In open space, and cut by all faces of a box. Positions in the box are rounded to its grid.
  for (const Box& box : {Box::open(), Box::periodic({5.3, 6.1, 6.0})}) {
    const ParticleSystem<double> s = molecules(angles, box);
    const std::vector<double> found = observed(s, Dihedrals(36, {}, names)).named_angles();
    REQUIRE(found.size() == angles.size());
    double worst = 0;
    for (std::size_t k = 0; k < angles.size(); ++k) worst = std::max(worst, std::abs(found[k] - angles[k]));
    // Positions of up to 255 in open space have lost 8 digits of two.
    CHECK(worst < (box.is_periodic() ? 4e-14 : 2e-13));
  }
  // Far ends exactly opposite: +180, never -180, from both sides.
  for (const double y : {0.0, -0.0}) {
    CHECK(detail::dihedral_angle({1, y, 0}, {0, 0, -1}, {-1, 0, 0}) == pi);
    CHECK(detail::dihedral_angle({1, 0, 0}, {0, 0, -1}, {-1, y, 0}) == pi);
  }
  // IUPAC: seen from the second particle to the third (here up along z), x to y is clockwise.
  CHECK(detail::dihedral_angle({1, 0, 0}, {0, 0, -1}, {0, 1, 0}) == pi / 2);
  CHECK(detail::dihedral_angle({1, 0, 0}, {0, 0, -1}, {0, -1, 0}) == -pi / 2);
  CHECK(std::isnan(detail::dihedral_angle({0, 0, 1}, {0, 0, -1}, {0, 1, 0})));
}

TEST_CASE("the histogram has every dihedral of the topology once, in intervals closed above", "[dihedrals]") {
  // In twelve intervals of 30 degrees; 180 is in the last. All angles in the middle of one but that.
  const std::vector<double> degrees = {15, 15, 75, -75, -75, -75, 165, -165, 180};
  std::vector<double> angles;
  for (const double one : degrees) angles.push_back(one * pi / 180);
  const Dihedrals all = observed(molecules(angles), Dihedrals(12));
  CHECK(all.size() == 9);
  CHECK(all.counts() == std::vector<std::int64_t>{1, 0, 0, 3, 0, 0, 2, 0, 1, 0, 0, 2});
  CHECK(all.fractions() == std::array<double, 3>{3.0 / 9, 3.0 / 9, 3.0 / 9});
  CHECK(std::abs(all.angle(8) - 75 * pi / 180) < 1e-15);
  double integral = 0;
  for (const double one : all.density()) integral += one * (2 * pi / 12);
  CHECK(std::abs(integral - 1) < 1e-14);
  CHECK(std::isnan(all.fraction_errors()[0]));
  CHECK(all.report().note ==
        "trans 0.3333, gauche+ 0.3333, gauche- 0.3333 of 9 angles; all 12 intervals: see the trajectory file");
  CHECK(all.series()[1].values == all.density());
  // By types in either direction, and by names.
  CHECK(observed(molecules(angles), Dihedrals(12, {"a", "b", "b", "c"})).counts() == all.counts());
  CHECK(observed(molecules(angles), Dihedrals(12, {"c", "b", "b", "a"})).counts() == all.counts());
  const Dihedrals named = observed(molecules(angles), Dihedrals(12, {}, {{"p8", "p9", "p10", "p11"}}));
  CHECK(named.size() == 1);
  CHECK(std::abs(named.named_angles()[0] - 75 * pi / 180) < 1e-14);
  CHECK(named.series().back().name == "now");
}

TEST_CASE("a torsion in a bath has the Boltzmann distribution", "[dihedrals]") {
  constexpr std::int64_t bins = 12;
  auto sim = in_a_bath(60);
  auto& monitor = sim.every(10, Dihedrals(bins));
  REQUIRE(sim.run(40'000).ok());
  const std::array<double, 3> fractions = monitor.fractions(), errors = monitor.fraction_errors();
  const std::array<double, 3> exact = {boltzmann(2 * pi / 3, pi) + boltzmann(-pi, -2 * pi / 3),
                                       boltzmann(0, 2 * pi / 3), boltzmann(-2 * pi / 3, 0)};
  CHECK(std::abs(exact[1] - exact[2]) > 0.1);  // signs matter
  double independent = 1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k, fractions[k], exact[k], errors[k]);
    CHECK(errors[k] < 0.01);
    CHECK(std::abs(fractions[k] - exact[k]) < 4 * errors[k]);
    independent = std::min(independent, exact[k] * (1 - exact[k]) / (errors[k] * errors[k]));
  }
  const double width = 2 * pi / static_cast<double>(bins);
  for (std::int64_t k = 0; k < bins; ++k) {
    const double expected = boltzmann(monitor.angle(k) - width / 2, monitor.angle(k) + width / 2);
    CAPTURE(k, expected);
    CHECK(std::abs(monitor.density()[static_cast<std::size_t>(k)] * width - expected) <
          4 * std::sqrt(expected / independent));
  }
}

TEST_CASE("dihedral angles depend neither on the order of particles nor on threads", "[dihedrals][determinism]") {
  std::vector<double> angles;
  for (int k = 0; k < 500; ++k) angles.push_back(std::remainder(0.7 * k, 2 * pi));
  const ParticleSystem<double> s = molecules(angles, Box::periodic({5.3, 6.1, 6.0}));
  // The same particles from the last to the first, terms as they were.
  ParticleSystem<double> back;
  back.set_box(s.box());
  auto topology = std::make_shared<Topology>(*s.topology());
  for (Index i = s.size() - 1; i >= 0; --i) back.add(s.name(i), 1, s.positions()[i], {0, 0, 0});
  std::reverse(topology->types.begin(), topology->types.end());
  for (auto& term : topology->dihedrals) {
    for (Index& i : term.particles) i = s.size() - 1 - i;
  }
  back.set_topology(topology);
  const auto counts = [&](const ParticleSystem<double>& of, int threads) {
    const test::Threads with(threads);
    return observed(of, Dihedrals(720)).counts();
  };
  CHECK(counts(s, 1) == counts(s, 3));
  CHECK(counts(s, 1) == counts(back, 2));
}

TEST_CASE("dihedral angles go on from a saved run bit for bit", "[dihedrals][restart]") {
  auto whole = in_a_bath(5), first = in_a_bath(5), second = in_a_bath(5);
  const Dihedrals asked(24);
  auto& all = whole.every(2, asked);
  first.every(2, asked);
  auto& later = second.every(2, asked);
  REQUIRE(whole.run(120).ok());
  REQUIRE(first.run(60).ok());
  second.restore(first.save());
  REQUIRE(second.run(60).ok());
  CHECK(all.report().samples == 61);
  CHECK(all.counts() == later.counts());
  CHECK(all.fraction_errors() == later.fraction_errors());
  CHECK(all.report().note == later.report().note);
  auto other = in_a_bath(5);
  other.every(2, Dihedrals(25));
  CHECK(test::refusal_of([&] { other.restore(first.save()); }) ==
        "the saved dihedrals are of 24 intervals and 0 named angles; 25 and 0 are expected");
}

TEST_CASE("dihedral angles are refused where there are none", "[dihedrals][messages]") {
  const auto refusal = [](const ParticleSystem<double>& s, const Dihedrals& asked) {
    return test::refusal_of([&] { observed(s, asked); });
  };
  const ParticleSystem<double> s = molecules({1.0});
  ParticleSystem<double> loose;
  for (int k = 0; k < 4; ++k) loose.add("q" + std::to_string(k), 1, Vec3<double>(k, 0.1 * k * k, 0), {0, 0, 0});
  CHECK(refusal(s, Dihedrals(0)) == "bins = 0 is not a valid number of intervals; 1 to 100000 is expected");
  CHECK(refusal(s, Dihedrals(9, {"a", "b"})) ==
        "types = [a, b] are not the types of four particles; give four types, or none for all dihedrals");
  CHECK(refusal(s, Dihedrals(9, {"a", "b", "b", "x"})).find("unknown type 'x' in monitor 'dihedrals'") == 0);
  CHECK(refusal(s, Dihedrals(9, {"a", "a", "b", "c"})) ==
        "types = [a, a, b, c] are the types of no dihedral of the structure; types such as [a, b, b, c] are expected");
  CHECK(refusal(s, Dihedrals(9, {}, {{"p0", "p1", "p2"}})).find("quadruples = [[p0, p1, p2]] does not name four") == 0);
  CHECK(refusal(s, Dihedrals(9, {}, {{"p0", "p1", "p2", "p9"}})).find("unknown particle 'p9' in monitor") == 0);
  CHECK(refusal(s, Dihedrals(9, {"a", "b", "b", "c"}, {{"p0", "p1", "p2", "p3"}})) ==
        "types and quadruples are both given in monitor 'dihedrals'; give only one of them");
  CHECK(refusal(loose, {}) ==
        "monitor 'dihedrals' finds no dihedrals, because the structure has none; name the particles, such as "
        "quadruples = [[\"a\", \"b\", \"c\", \"d\"]]");
  CHECK(refusal(loose, Dihedrals(9, {}, {{"q0", "q1", "q2", "q3"}})).empty());
  // Three in line are no angle, and said so.
  ParticleSystem<double> line;
  for (int k = 0; k < 4; ++k) line.add("q" + std::to_string(k), 1, {1.0 * k, 0, 0}, {0, 0, 0});
  const Dihedrals none = observed(line, Dihedrals(9, {}, {{"q0", "q1", "q2", "q3"}}));
  CHECK(none.report().reason == "three particles of every dihedral are in line, so there is no angle");
  CHECK(std::isnan(none.named_angles()[0]));
}

}  // namespace noether
