#pragma once
/// Molecules of all shapes, crowds of them, and a step of these by either solver.

#include "constraints/constraint_solver.hpp"
#include "constraints/distance.hpp"
#include "constraints/elimination.hpp"
#include "tests/support/columns.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace noether::test {

/// Atoms of a molecule about its first one, and what is tied.
struct Molecule {
  std::string name;
  std::vector<double> masses;
  std::vector<Vec3<double>> atoms;
  std::vector<std::pair<Index, Index>> bonds;
};

inline Molecule water() {
  const double angle = 109.47 * M_PI / 180;
  return {"water",
          {15.9994, 1.008, 1.008},
          {{0, 0, 0}, {0.1, 0, 0}, {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0}},
          {{0, 1}, {0, 2}, {1, 2}}};
}

/// Each atom hangs on an earlier one.
inline Molecule tree(int atoms, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Molecule m{"tree", {12}, {{0, 0, 0}}, {}};
  for (int a = 1; a < atoms; ++a) {
    const auto on = static_cast<Index>(random() % static_cast<std::uint64_t>(a));
    const double z = 0.9 * (2 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1),
                 turn = static_cast<double>(random() % 1000);
    const double flat = std::sqrt(1 - z * z);
    m.masses.push_back(random() % 2 == 0 ? 1.008 : 14.027);
    m.atoms.push_back(m.atoms[static_cast<std::size_t>(on)] +
                      0.15 * Vec3<double>(flat * std::cos(turn), flat * std::sin(turn), z));
    m.bonds.emplace_back(on, a);
  }
  return m;
}

/// A new atom on one that is there, some way off.
inline void hang(Molecule& m, Index on, std::mt19937_64& random, double bond = 0.15) {
  const double z = 0.9 * (2 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1),
               turn = static_cast<double>(random() % 1000);
  const double flat = std::sqrt(1 - z * z);
  m.bonds.emplace_back(on, static_cast<Index>(m.atoms.size()));
  m.masses.push_back(random() % 2 == 0 ? 1.008 : 14.027);
  m.atoms.push_back(m.atoms[static_cast<std::size_t>(on)] +
                    bond * Vec3<double>(flat * std::cos(turn), flat * std::sin(turn), z));
}

/// The same molecule with atoms and bonds in any order.
inline Molecule shuffled(const Molecule& m, std::mt19937_64& random) {
  std::vector<Index> place(m.atoms.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  Molecule mixed{m.name, std::vector<double>(place.size()), std::vector<Vec3<double>>(place.size()), m.bonds};
  for (std::size_t a = 0; a < place.size(); ++a) {
    mixed.masses[static_cast<std::size_t>(place[a])] = m.masses[a];
    mixed.atoms[static_cast<std::size_t>(place[a])] = m.atoms[a];
  }
  for (auto& [a, b] : mixed.bonds) {
    a = place[static_cast<std::size_t>(a)], b = place[static_cast<std::size_t>(b)];
    if (random() % 2 == 0) std::swap(a, b);
  }
  std::shuffle(mixed.bonds.begin(), mixed.bonds.end(), random);
  return mixed;
}

/// An unbranched chain.
inline Molecule path(int bonds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Molecule m{"path", {12}, {{0, 0, 0}}, {}};
  for (int a = 0; a < bonds; ++a) hang(m, a, random);
  return shuffled(m, random);
}

/// A tree whose atoms have at most four bonds.
inline Molecule branched(int atoms, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Molecule m{"branched", {12}, {{0, 0, 0}}, {}};
  std::vector<int> bonds{0};
  while (static_cast<int>(m.atoms.size()) < atoms) {
    const auto on = static_cast<std::size_t>(random() % m.atoms.size());
    if (bonds[on] == 4) continue;
    ++bonds[on];
    bonds.push_back(1);
    hang(m, static_cast<Index>(on), random);
  }
  return shuffled(m, random);
}

/// A middle with four atoms, three more on each of these: as many as kernels for trees take.
inline Molecule full_tree() {
  std::mt19937_64 random(1);
  Molecule m{"full", {12}, {{0, 0, 0}}, {}};
  for (int k = 0; k < 4; ++k) hang(m, 0, random);
  for (Index a = 1; a <= 4; ++a) {
    for (int k = 0; k < 3; ++k) hang(m, a, random);
  }
  return m;
}

/// The middle of a star is its first atom.
inline Molecule star(int bonds, double middle = 12) {
  std::mt19937_64 random(static_cast<std::uint64_t>(bonds));
  Molecule m{"star", {middle}, {{0, 0, 0}}, {}};
  for (int k = 0; k < bonds; ++k) hang(m, 0, random);
  return m;
}

/// A ring with an atom on each of its own.
inline Molecule ring(int atoms) {
  Molecule m{"ring", {}, {}, {}};
  for (int a = 0; a < atoms; ++a) {
    const double angle = 2 * M_PI * a / atoms, radius = 0.075 / std::sin(M_PI / atoms);
    const Vec3<double> at(radius * std::cos(angle), radius * std::sin(angle), a % 2 == 0 ? 0.02 : -0.02);
    m.masses.insert(m.masses.end(), {12.011, 1.008});
    m.atoms.insert(m.atoms.end(), {at, at + Vec3<double>(0.01 * a, 0, 0.1)});
    m.bonds.emplace_back(2 * a, (2 * a + 2) % (2 * atoms));
    m.bonds.emplace_back(2 * a, 2 * a + 1);
  }
  return m;
}

/// A zigzag of carbons at 112 degrees, as united atoms.
inline Molecule chain(int bonds) {
  const double half = 112 * M_PI / 360, bond = 0.153;
  Molecule m{"chain", {}, {}, {}};
  for (int i = 0; i <= bonds; ++i) {
    m.masses.push_back(14.027);
    m.atoms.emplace_back(i * bond * std::sin(half), i % 2 * bond * std::cos(half), 0);
    if (i > 0) m.bonds.emplace_back(i - 1, i);
  }
  return m;
}
/// The same with hydrogens.
inline Molecule with_hydrogens(int bonds) {
  Molecule m = chain(bonds);
  std::fill(m.masses.begin(), m.masses.end(), 12.011);
  const auto add = [&](int carbon, const Vec3<double>& r) {
    m.bonds.emplace_back(carbon, static_cast<Index>(m.atoms.size()));
    m.masses.push_back(1.008);
    m.atoms.push_back(m.atoms[static_cast<std::size_t>(carbon)] + r);
  };
  for (int i = 0; i <= bonds; ++i) {
    for (const double up : {0.089, -0.089}) add(i, {0, i % 2 == 0 ? -0.063 : 0.063, up});
  }
  add(0, {-0.0904, 0.061, 0});
  add(bonds, {0.0904, -0.061, 0});
  return m;
}

/// Copies of a molecule, each turned and moved its own way, and what ties them.
struct Crowd {
  ParticleSystem<double> particles{unit_system("molecular")};
  ConstraintSet constraints;

  /// @param edge  of a periodic box, whose faces cut some; 0 in open space
  explicit Crowd(ConstraintOptions options = {}, double edge = 0) : constraints(options) {
    if (edge > 0) particles.set_box(Box::periodic(Vec3<double>(edge, edge, edge)));
  }

  /// @param number  which of its kind it is: the same number is the same molecule
  void add(const Molecule& m, int number, double temperature = 300) {
    std::mt19937_64 random(static_cast<std::uint64_t>(100 + number));
    std::normal_distribution<double> normal(0, 1);
    const double turn = normal(random);
    const Vec3<double> center(0.4 * (number % 7), 0.4 * (number / 7 % 7), 0.4 * (number / 49));
    const Index first = particles.size();
    for (std::size_t a = 0; a < m.atoms.size(); ++a) {
      const Vec3<double>& x = m.atoms[a];
      const double speed = std::sqrt(units::molecular::k_B * temperature / m.masses[a]);
      const double u = normal(random), v = normal(random), w = normal(random);
      particles.add(m.name + std::to_string(number) + "_" + std::to_string(a), m.masses[a],
                    center + Vec3<double>(std::cos(turn) * x[0] - std::sin(turn) * x[1],
                                          std::sin(turn) * x[0] + std::cos(turn) * x[1], x[2]),
                    {speed * u, speed * v, speed * w});
    }
    particles.wrap();
    for (const auto& [a, b] : m.bonds) {
      const double length = (m.atoms[static_cast<std::size_t>(a)] - m.atoms[static_cast<std::size_t>(b)]).norm();
      constraints.add(particles, Distance{.length = length}, {first + a, first + b});
    }
  }
};

/// A position stage and a velocity stage, from particles as they are: the start of a run moves all of them together.
template <class Real>
ParticleSystem<Real> after_step(const Crowd& crowd, double h, std::optional<Failure>* failure = nullptr) {
  ParticleSystem<Real> s = crowd.particles.as<Real>();
  s.phase().opened = true;
  ConstraintSolver<Real> solver(crowd.constraints);
  solver.bind(s);
  solver.advance_positions(s, Real(h));
  solver.project_velocities(s, Real(h));
  if (failure != nullptr) *failure = solver.failure();
  return s;
}

/// Velocities along the constraints, as a run has them: the closed form knows no others.
inline void project_all(Crowd& crowd) {
  ConstraintSolver<double> solver(crowd.constraints);
  crowd.particles.phase().opened = true;
  solver.bind(crowd.particles);
  solver.project_velocities(crowd.particles, 1);
}

/// The largest distance of positions, and of velocities, of a run in doubles from one in 113 bits.
inline std::pair<double, double> errors(const ParticleSystem<double>& s, const ParticleSystem<Quad>& right) {
  double x = 0, v = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<Quad> dx = s.positions()[i].cast<Quad>() - Vec3<Quad>(right.positions()[i]);
    const Vec3<Quad> dv = s.velocities()[i].cast<Quad>() - Vec3<Quad>(right.velocities()[i]);
    x = std::max(x, std::sqrt(static_cast<double>(norm2(dx))));
    v = std::max(v, std::sqrt(static_cast<double>(norm2(dv))));
  }
  return {x, v};
}

/// Of each kind of kernel: rigid triangles, paths, trees with at most four bonds an atom, all others.
inline std::vector<Molecule> all_molecules() {
  return {water(),     tree(2, 3), path(2, 1), path(3, 2),       path(9, 3), path(40, 4),
          star(3),     star(4),    tree(9, 8), branched(14, 1),  star(5),    branched(33, 2),
          tree(32, 2), ring(3),    ring(6),    with_hydrogens(3)};
}

inline std::vector<Elimination::Pair> pairs_of(const Molecule& m) {
  std::vector<Elimination::Pair> pairs;
  for (const auto& [a, b] : m.bonds) pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
  return pairs;
}
inline std::vector<double> inverse_masses_of(const Molecule& m) {
  std::vector<double> inverse(m.masses.size());
  std::transform(m.masses.begin(), m.masses.end(), inverse.begin(), [](double mass) { return 1 / mass; });
  return inverse;
}
inline Elimination elimination(const Molecule& m) { return Elimination(pairs_of(m), inverse_masses_of(m)); }

}  // namespace noether::test
