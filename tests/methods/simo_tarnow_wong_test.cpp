/// The method of Simo, Tarnow and Wong: what it keeps, to rounding, of which forces, and which root it takes.

#include "forces/bonded.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/springs.hpp"
#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace noether;
using namespace noether::test;

namespace {

Vec3<double> whole_momentum(const ParticleSystem<double>& s) {
  Vec3<double> sum = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * Vec3<double>(s.velocities()[i]);
  return sum;
}
Vec3<double> whole_angular_momentum(const ParticleSystem<double>& s) {
  Vec3<double> sum = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i)
    sum += s.masses()[i] * cross(Vec3<double>(s.positions()[i]), Vec3<double>(s.velocities()[i]));
  return sum;
}

/// The energy in 113 bits: kernels of pairs sum energies on a grid, which is coarser than what is measured.
double energy_of(const ForceField<double>& forces, const ParticleSystem<double>& s) {
  const ParticleSystem<Quad> wide = s.as<Quad>();
  VectorColumn<Quad> a(s.size());
  Quad energy = kinetic_energy(wide);
  for (const AnyForce<double>& term : forces.terms()) {
    const AnyForce<Quad> force = *term.in_quad();
    ForceSink<Quad> sink(a, wide, {.energy = true});
    force.add_to(sink, wide);
    energy += sink.potential();
  }
  return static_cast<double>(energy);
}

/// Largest changes over a run: of the energy relative to it, of the momentum and the angular momentum relative to the
/// sums of their parts; and why it ended early.
struct Lost {
  double energy = 0, momentum = 0, angular_momentum = 0;
  std::string failure = {};
  std::int64_t steps = 0;
};

Lost lost_over(const ForceField<double>& forces, Classical<double>& integrator, ParticleSystem<double>& s, double h,
               std::int64_t steps) {
  s.clock() = Clock<double>::fixed(0, h);
  integrator.bind(s);
  double parts = 0, turning = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const double p = s.masses()[i] * std::sqrt(norm2(s.velocities()[i]));
    parts += p;
    turning += p * std::sqrt(norm2(s.positions()[i]));
  }
  const double energy = energy_of(forces, s);
  const Vec3<double> momentum = whole_momentum(s), angular = whole_angular_momentum(s);
  Lost lost;
  for (; lost.steps < steps; ++lost.steps) {
    const Advance made = integrator.advance(s, {.steps = 1});
    if (made.failure != nullptr) {
      lost.failure = made.failure->message;
      break;
    }
    const auto keep = [](double& most, double value) { most = std::max(most, value); };
    keep(lost.energy, std::abs(energy_of(forces, s) / energy - 1));
    keep(lost.momentum, std::sqrt(norm2(Vec3<double>(whole_momentum(s) - momentum))) / parts);
    keep(lost.angular_momentum, std::sqrt(norm2(Vec3<double>(whole_angular_momentum(s) - angular))) / turning);
  }
  return lost;
}

/// Three masses, each tied to each by a spring of length 1; where they are at t = 4.
ParticleSystem<double> three_masses() {
  ParticleSystem<double> s;
  s.add("a", 1, {1.02, 0, 0}, {0, 1, 0});
  s.add("b", 1.5, {0, 0.3, 0}, {0.5, 0, 0});
  s.add("c", 2, {-0.1, -0.8, 0}, {-0.2, -0.3, 0});
  return s;
}
HarmonicBond three_springs(double k = 50) { return {.k = k, .length = 1, .tied = {{0, 1}, {1, 2}, {0, 2}}}; }

double error_of_three_masses(const ParticleSystem<double>& s) {
  constexpr double exact[3][2] = {{0.74177187414044648532, 0.53904862794849378658},
                                  {-0.2136574906604143128, 0.19603574291904928649},
                                  {0.89935718092508749193, -0.1915511211635338581}};
  double worst = 0;
  for (Index i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) worst = std::max(worst, std::abs(s.positions()[i][k] - exact[i][k]));
  }
  return worst;
}

/// Six masses along a helix.
ParticleSystem<double> helix() {
  ParticleSystem<double> s(unit_system("reduced"));
  for (int k = 0; k < 6; ++k) {
    s.add("p" + std::to_string(k), 1 + 0.5 * k, {1.2 * std::cos(1.3 * k), 1.2 * std::sin(1.3 * k), 0.6 * k},
          {0.3 * std::sin(2.0 * k), 0.2 * std::cos(3.0 * k), 0.1 * k});
  }
  return s;
}
/// The same, bonded along its way.
ParticleSystem<double> bonded_helix() {
  ParticleSystem<double> s = helix();
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {60, 1.3}}};
  topology->angle_kinds = {{"harmonic", {20, 1.9}}};
  topology->dihedral_kinds = {{"periodic", {2.5, 3, 1}}};
  for (Index k = 0; k + 1 < 6; ++k) topology->bonds.push_back({{k, k + 1}, 0});
  for (Index k = 0; k + 2 < 6; ++k) topology->angles.push_back({{k, k + 1, k + 2}, 0});
  for (Index k = 0; k + 3 < 6; ++k) topology->dihedrals.push_back({{k, k + 1, k + 2, k + 3}, 0});
  s.set_topology(topology);
  return s;
}

/// A particle on a spring of length 1 to the origin.
Lost spring_of_claim(double k, double stretch, std::int64_t steps = 2000) {
  ParticleSystem<double> s = particle_in_plane(1 + stretch, 0, 0, 1);
  const ForceField<double> spring = field_of(Tether{.k = k, .length = 1, .tied = {{0}}});
  auto integrator = classical_over(spring, method("simo_tarnow_wong"));
  return lost_over(spring, integrator, s, 0.05, steps);
}

/// Particles on the corners of cubes, tied along their edges, turning and sheared.
ParticleSystem<double> lattice(int m) {
  ParticleSystem<double> s(unit_system("reduced"));
  for (int a = 0; a < m; ++a) {
    for (int b = 0; b < m; ++b) {
      for (int c = 0; c < m; ++c) s.add("", 1, {1.0 * a, 1.0 * b, 1.0 * c}, {-0.1 * b, 0.1 * a + 0.01 * c, 0.02 * b});
    }
  }
  return s;
}
HarmonicBond lattice_springs(int m, double k) {
  std::vector<std::array<Index, 2>> tied;
  const auto at = [m](int a, int b, int c) { return Index((a * m + b) * m + c); };
  for (int a = 0; a < m; ++a) {
    for (int b = 0; b < m; ++b) {
      for (int c = 0; c < m; ++c) {
        if (a + 1 < m) tied.push_back({at(a, b, c), at(a + 1, b, c)});
        if (b + 1 < m) tied.push_back({at(a, b, c), at(a, b + 1, c)});
        if (c + 1 < m) tied.push_back({at(a, b, c), at(a, b, c + 1)});
      }
    }
  }
  return {.k = k, .length = 1, .tied = Tied<2>(tied)};
}

}  // namespace

TEST_CASE("three masses on springs keep energy and angular momentum to rounding, with the errors of the oracle",
          "[simo_tarnow_wong]") {
  const auto by = [](double h, JacobianForm form) {
    const ForceField<double> springs = field_of(three_springs());
    auto integrator = classical_over(springs, method("simo_tarnow_wong", {.jacobian = form}));
    ParticleSystem<double> s = three_masses();
    const Lost lost = lost_over(springs, integrator, s, h, std::lround(4 / h));
    CHECK(lost.energy < 1e-14);
    CHECK(lost.angular_momentum < 1e-14);
    CHECK(lost.momentum < 1e-14);
    return error_of_three_masses(s);
  };
  const double coarse = by(0.025, JacobianForm::dense), fine = by(0.0125, JacobianForm::dense);
  CHECK(std::abs(coarse - 2.345e-2) < 1e-5);
  CHECK(std::abs(fine - 5.948e-3) < 1e-6);
  CHECK(std::abs(std::log2(coarse / fine) - 1.98) < 0.01);
  CHECK(std::abs(by(0.025, JacobianForm::matrix_free) - coarse) < 1e-12);
  CHECK(std::abs(by(0.025, JacobianForm::sparse) - coarse) < 1e-12);
}

TEST_CASE("a stiff spring keeps energy and angular momentum where Newmark's method loses them", "[simo_tarnow_wong]") {
  const Lost soft = spring_of_claim(100, 0.02), stiff = spring_of_claim(1e4, 0.02);
  CHECK(soft.energy < 3e-13);
  CHECK(soft.angular_momentum < 2e-13);
  CHECK(stiff.energy < 1e-12);
  CHECK(stiff.angular_momentum < 2e-13);
}

TEST_CASE("the root that continues the step is taken at h omega = 50, and where it ends the run ends by name",
          "[simo_tarnow_wong]") {
  const Lost lost = spring_of_claim(1e6, 0.02, 500);
  CHECK(lost.failure.empty());
  CHECK(lost.energy < 1e-11);
  CHECK(lost.angular_momentum < 1e-12);
  // Other roots of the same energy stand far outside, or inside, of where the spring can be.
  ParticleSystem<double> s = particle_in_plane(1.02, 0, 0, 1);
  auto integrator = classical_over(Tether{.k = 1e6, .length = 1, .tied = {{0}}}, method("simo_tarnow_wong"));
  s.clock() = Clock<double>::fixed(0, 0.05);
  integrator.bind(s);
  for (int n = 0; n < 100; ++n) {
    REQUIRE(integrator.advance(s, {.steps = 1}).failure == nullptr);
    CHECK(std::abs(std::sqrt(norm2(s.positions()[0])) - 1) < 0.0201);
  }
  const Lost beyond = spring_of_claim(1e8, 0.02);
  CHECK(beyond.steps < 2000);
  CHECK_THAT(beyond.failure, Catch::Contains("have no solution that continues the motion beyond") &&
                                 Catch::Contains("take a smaller step"));
  CHECK(beyond.energy < 1e-10);
}

TEST_CASE("gravity, pairs, bonds, springs, angles and dihedrals keep energy, momentum and angular momentum to rounding",
          "[simo_tarnow_wong]") {
  const auto check = [](const ForceField<double>& forces, ParticleSystem<double> s, double h) {
    INFO(forces.terms().front().name());
    const ParticleSystem<double> start = s;
    auto integrator = classical_over(forces, method("simo_tarnow_wong"));
    const Lost lost = lost_over(forces, integrator, s, h, 60);
    CHECK(lost.failure.empty());
    CHECK(lost.energy < 2e-14);
    CHECK(lost.momentum < 1e-14);
    CHECK(lost.angular_momentum < 1e-14);
    CHECK(integrator.claims().energy_exact);
    CHECK((integrator.claims().keeps_momentum && integrator.claims().keeps_angular_momentum));
    CHECK(distance(s, start) > 0.1);
    // The midpoint rule, of the same order, loses the energy there.
    auto midpoint = classical_over(forces, method("implicit_midpoint"));
    ParticleSystem<double> other = start;
    CHECK(lost_over(forces, midpoint, other, h, 60).energy > 1e-10);
  };
  check(field_of(Gravity{.G = 1, .softening = 0.2}), helix(), 0.05);
  check(field_of(MorseForce{{.depth = 1, .a = 1.5, .length = 1}, 20, Cutoff::plain}), helix(), 0.05);
  check(field_of(three_springs()), helix(), 0.05);
  check(field_of(Bonded{}), bonded_helix(), 0.05);
  check(field_of(Gravity{.G = 0.3}, Bonded{}), bonded_helix(), 0.02);
}

TEST_CASE("in a field without symmetry the energy is kept, and nothing else is claimed", "[simo_tarnow_wong]") {
  const ForceField<double> well = field_of(HenonHeiles{});
  auto integrator = classical_over(well, method("simo_tarnow_wong"));
  ParticleSystem<double> s = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  const Lost lost = lost_over(well, integrator, s, 0.5, 200);
  CHECK(lost.energy < 1e-14);
  CHECK(lost.angular_momentum > 1e-3);
  CHECK_FALSE((integrator.claims().keeps_momentum || integrator.claims().keeps_angular_momentum));
}

TEST_CASE("thousands of unknowns need no matrix, and few evaluations where springs are stiff", "[simo_tarnow_wong]") {
  const int m = 12;  // 5184 unknowns, h omega up to 7
  const ForceField<double> springs = field_of(lattice_springs(m, 400));
  auto integrator = classical_over(springs, method("simo_tarnow_wong"));
  ParticleSystem<double> s = lattice(m);
  const Lost lost = lost_over(springs, integrator, s, 0.1, 5);
  CHECK(lost.failure.empty());
  CHECK(lost.energy < 1e-13);
  CHECK(lost.angular_momentum < 1e-13);
  CHECK(integrator.evaluations().force < 5 * 200);
}

TEST_CASE("the method of Simo, Tarnow and Wong refuses what it cannot keep", "[simo_tarnow_wong]") {
  const auto refusal = [](const ForceField<double>& forces) -> std::string {
    auto integrator = classical_over(forces, method("simo_tarnow_wong"));
    ParticleSystem<double> s = particle_in_plane(1, 0, 0, 1);
    s.clock() = Clock<double>::fixed(0, 0.1);
    try {
      integrator.bind(s);
    } catch (const SchemeMismatch& error) {
      return error.message();
    }
    return "";
  };
  CHECK_THAT(refusal(field_of(HarmonicField{1}, OscillatingField{{1, 0, 0}, 2, 0})),
             Catch::Contains("depends on time"));
  CHECK_THAT(refusal(field_of(DragForce{{.rate = 0.1}})), Catch::Contains("'simo_tarnow_wong'"));
  // A force whose energy is known, but not its secants.
  CHECK(refusal(field_of(HenonHeilesField{}, HarmonicField{1})) ==
        "method 'simo_tarnow_wong' needs secants of every force, but 'henon_heiles' has none; use 'gonzalez', which "
        "keeps the energy without");
  CHECK_THROWS_WITH(
      classical_over(HarmonicField{1}, method("simo_tarnow_wong", {.adaptive = true})),
      Catch::Contains("method 'simo_tarnow_wong' has no error estimate, so its steps cannot be adaptive"));
  auto sparse = classical_over(HenonHeiles{}, method("simo_tarnow_wong", {.jacobian = JacobianForm::sparse}));
  ParticleSystem<double> s = particle_in_plane(1, 0, 0, 1);
  CHECK_THROWS_WITH(sparse.bind(s),
                    Catch::Contains("jacobian = \"sparse\" needs derivatives of the secants of every force, but "
                                    "'henon_heiles' has none; use jacobian = \"matrix_free\" or \"dense\""));
}
