/// What is known of SHAKE's convergence, claims C16 to C18: by SHAKE as textbooks have it, written out here, and by the
/// solver of scenes, sweep for sweep.

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "numbers/units.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace noether::sweep_claims {
namespace {

using Bond = std::pair<Index, Index>;

struct Molecule {
  std::vector<double> masses;
  std::vector<Vec3<double>> atoms;
  std::vector<Bond> bonds;
};

constexpr double step = 0.002, temperature = 300, force = 500;  // [ps], [K], [kJ/mol/nm]

/// A step of 2 fs at 300 K, forces included. @param sample  other numbers, other velocities
std::vector<Vec3<double>> velocities_of(const Molecule& m, unsigned sample) {
  std::mt19937 random(sample);
  std::normal_distribution<double> normal;
  std::vector<Vec3<double>> v;
  for (const double mass : m.masses) {
    const double thermal = std::sqrt(units::molecular::k_B * temperature / mass), pushed = force / mass * step / 2;
    Vec3<double> sum;
    for (Index k = 0; k < 3; ++k) sum[k] = thermal * normal(random);
    for (Index k = 0; k < 3; ++k) sum[k] += pushed * normal(random);
    v.push_back(sum);
  }
  return v;
}

/// Bonds in turn, each moved onto its length along what it was before (Ryckaert, Ciccotti and Berendsen, 1977).
/// @return sweeps until every |r^2 - d^2| / (2 d^2) is below the tolerance; -1 for none in 2000
int textbook_shake(const Molecule& m, const std::vector<Vec3<double>>& v, double tolerance) {
  std::vector<Vec3<double>> x = m.atoms;
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * v[i];
  for (int sweeps = 0; sweeps <= 2000; ++sweeps) {
    bool settled = true;
    for (const auto& [a, b] : m.bonds) {
      const Vec3<double> before = m.atoms[at(a)] - m.atoms[at(b)], r = x[at(a)] - x[at(b)];
      const double length2 = before.squaredNorm(), violation = (r.squaredNorm() - length2) / 2;
      if (std::abs(violation) <= tolerance * length2) continue;
      settled = false;
      const double pull = violation / (r.dot(before) * (1 / m.masses[at(a)] + 1 / m.masses[at(b)]));
      x[at(a)] -= pull / m.masses[at(a)] * before;
      x[at(b)] += pull / m.masses[at(b)] * before;
    }
    if (settled) return sweeps;
  }
  return -1;
}

/// Sweeps of the position stage of `solver = "rattle"`; -1 if it fails.
std::int64_t rattle_sweeps(const Molecule& m, const std::vector<Vec3<double>>& v, double tolerance) {
  ParticleSystem<double> s(unit_system("molecular"));
  for (std::size_t i = 0; i < m.atoms.size(); ++i) s.add(fmt::format("C{}", i), m.masses[i], m.atoms[i], v[i]);
  ConstraintSet set({.solver = ConstraintMethod::rattle, .tolerance = tolerance, .iterations = 2000});
  for (const auto& [a, b] : m.bonds) set.add(s, Distance{}, {a, b});
  s.phase().opened = true;  // velocities as they are: the same step
  ConstraintSolver<double> solver(set);
  solver.bind(s);
  solver.advance_positions(s, step);
  return solver.failure() ? -1 : solver.iterations();
}

/// The most of six samples, by the textbook and by the solver.
struct Sweeps {
  std::int64_t textbook = 0, solver = 0;
  Sweeps(const Molecule& m, double tolerance) {
    for (unsigned sample = 0; sample < 6; ++sample) {
      const auto v = velocities_of(m, sample);
      const std::int64_t one = textbook_shake(m, v, tolerance), other = rattle_sweeps(m, v, tolerance);
      textbook = textbook < 0 || one < 0 ? -1 : std::max(textbook, one);
      solver = solver < 0 || other < 0 ? -1 : std::max(solver, other);
    }
  }
};

constexpr double carbon = 0.153;  // [nm]

/// A zigzag at 112 degrees.
Molecule chain(int atoms, bool second_neighbours = false) {
  const double half = 112 * M_PI / 360;
  Molecule m;
  for (int i = 0; i < atoms; ++i) {
    m.masses.push_back(12.011);
    m.atoms.emplace_back(i * carbon * std::sin(half), i % 2 * carbon * std::cos(half), 0);
    if (i > 0) m.bonds.emplace_back(i - 1, i);
  }
  for (int i = 0; second_neighbours && i + 2 < atoms; ++i) m.bonds.emplace_back(i, i + 2);
  return m;
}

Molecule water() {
  const double angle = 109.47 * M_PI / 180;
  return {{15.9994, 1.008, 1.008},
          {{0, 0, 0}, {0.1, 0, 0}, {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0}},
          {{0, 1}, {0, 2}, {1, 2}}};
}

/// A chair with tetrahedral angles.
Molecule six_ring(bool second_neighbours) {
  const double radius = carbon * std::sqrt(8.0 / 3) / std::sqrt(3.0);
  const double height = std::sqrt(carbon * carbon - radius * radius) / 2;
  Molecule m;
  for (int i = 0; i < 6; ++i) {
    m.masses.push_back(12.011);
    m.atoms.emplace_back(radius * std::cos(M_PI * i / 3), radius * std::sin(M_PI * i / 3),
                         i % 2 == 0 ? height : -height);
    m.bonds.emplace_back(i, (i + 1) % 6);
  }
  for (int i = 0; second_neighbours && i < 6; ++i) m.bonds.emplace_back(i, (i + 2) % 6);
  return m;
}

/// Planar, with distances of all pairs: ten, where nine fix it.
Molecule stiff_five_ring() {
  Molecule m;
  for (int i = 0; i < 5; ++i) {
    m.masses.push_back(12.011);
    m.atoms.emplace_back(0.13 * std::cos(0.4 * M_PI * i), 0.13 * std::sin(0.4 * M_PI * i), 0);
    m.bonds.emplace_back(i, (i + 1) % 5);
  }
  for (int i = 0; i < 5; ++i) m.bonds.emplace_back(i, (i + 2) % 5);
  return m;
}

/// By what a sweep lowers violations, of the textbook, from the sweeps for two tolerances.
double factor_of_a_sweep(const Molecule& m, double loose, double tight) {
  const auto more = Sweeps(m, tight).textbook - Sweeps(m, loose).textbook;
  return std::pow(tight / loose, 1.0 / static_cast<double>(more));
}

void check_sweeps(const Molecule& m, double tolerance, std::int64_t least, std::int64_t most) {
  const Sweeps sweeps(m, tolerance);
  CAPTURE(tolerance, sweeps.textbook, sweeps.solver);
  CHECK(sweeps.textbook >= least);
  CHECK(sweeps.textbook <= most);
  // The solver takes bonds in its own order.
  CHECK(std::abs(sweeps.solver - sweeps.textbook) <= 1 + sweeps.textbook / 8);
}

TEST_CASE("C16: SHAKE takes 8 sweeps to 1e-7 on a chain of ten carbons, each for a factor of about 0.2",
          "[constraints][claims]") {
  check_sweeps(chain(10), 1e-7, 7, 9);
  check_sweeps(chain(50), 1e-7, 8, 11);
  const double factor = factor_of_a_sweep(chain(10), 1e-4, 1e-12);
  CAPTURE(factor);
  CHECK(factor > 0.14);
  CHECK(factor < 0.23);
}

TEST_CASE("C17: angles cost far more than twice the sweeps: a triangle of water three times those of decane and more",
          "[constraints][claims]") {
  check_sweeps(water(), 1e-4, 10, 14);
  check_sweeps(water(), 1e-8, 30, 36);
  check_sweeps(water(), 1e-12, 50, 58);
  check_sweeps(chain(10), 1e-4, 3, 5);
  check_sweeps(chain(10), 1e-8, 8, 11);
  check_sweeps(chain(10), 1e-12, 13, 17);
  const double triangle = factor_of_a_sweep(water(), 1e-4, 1e-12), open = factor_of_a_sweep(chain(10), 1e-4, 1e-12);
  CAPTURE(triangle, open);
  CHECK(std::log(open) / std::log(triangle) > 3);
  check_sweeps(chain(10, true), 1e-7, 300, 550);
  const Sweeps long_chain(chain(50, true), 1e-7);
  CHECK(long_chain.textbook == -1);
  CHECK(long_chain.solver == -1);
}

TEST_CASE("C18: rings converge in 7 sweeps; with second neighbours in ten times as many, or never where they depend",
          "[constraints][claims]") {
  check_sweeps(six_ring(false), 1e-7, 6, 8);
  check_sweeps(six_ring(true), 1e-7, 40, 75);
  const Molecule five = stiff_five_ring();
  int converged = 0;
  for (unsigned sample = 0; sample < 6; ++sample)
    converged += textbook_shake(five, velocities_of(five, sample), 1e-7) > 0;
  CHECK(converged == 0);
  ParticleSystem<double> s(unit_system("molecular"));
  for (std::size_t i = 0; i < 5; ++i) s.add(fmt::format("C{}", i), 12.011, five.atoms[i], {0, 0, 0});
  ConstraintSet set({.solver = ConstraintMethod::rattle});
  for (const auto& [a, b] : five.bonds) set.add(s, Distance{}, {a, b});
  const std::string refusal = test::refusal_of([&] { ConstraintSolver<double>(set).bind(s); });
  CHECK_THAT(refusal, Catch::Contains("constraints depend on each other") && Catch::Contains("distance of 'C") &&
                          Catch::Contains("take one out"));
}

}  // namespace
}  // namespace noether::sweep_claims
