#pragma once
/// Liquids of rigid molecules in periodic boxes, the same every time.

#include "constraints/constraint_solver.hpp"
#include "constraints/rigid_bar.hpp"
#include "forces/lennard_jones.hpp"
#include "tests/support/mechanisms.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace noether::test {

/// Rigid molecules and who is in which of them.
struct MolecularLiquid : Mechanism {
  std::vector<std::vector<Index>> molecules;
};

/// Lennard-Jones sites of size 1 with a smooth end; those of one molecule do not feel each other.
inline const LennardJonesForce sites{
    .cutoff = 2.2, .cutoff_style = Cutoff::switch_c4, .switch_from = 1.4, .epsilon = 1.0, .sigma = 1.0};

/// per_edge^3 molecules on a cubic lattice, each turned its own way: dumbbells, triangles and bars of three in turn,
/// with random velocities and no momentum. Those at the faces lie across them.
inline MolecularLiquid molecular_liquid(int per_edge, double edge, ConstraintOptions options = {}, double speed = 1) {
  MolecularLiquid m{{ParticleSystem<double>(), ConstraintSet(options)}, {}};
  ParticleSystem<double>& s = m.particles;
  s.set_box(Box::periodic(Vec3<double>::Constant(edge)));
  std::mt19937_64 random(3);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; };
  const std::vector<Vec3<double>> shapes[3] = {{{-0.3, 0, 0}, {0.3, 0, 0}},
                                               {{0, 0, 0}, {0.5, 0.1, 0}, {-0.2, 0.4, 0.1}},
                                               {{-0.4, 0, 0}, {0.1, 0, 0}, {0.4, 0, 0}}};
  const double masses[3] = {1, 0.5, 2};
  auto topology = std::make_shared<Topology>();
  Vec3<double> momentum = Vec3<double>::Zero();
  double mass = 0;
  for (int cell = 0; cell < per_edge * per_edge * per_edge; ++cell) {
    const Vec3<double> lattice(cell % per_edge, cell / per_edge % per_edge, cell / per_edge / per_edge);
    const Eigen::Quaternion<double> turned =
        Eigen::Quaternion<double>(uniform(), uniform(), uniform(), uniform()).normalized();
    std::vector<Index> molecule;
    for (std::size_t k = 0; k < shapes[cell % 3].size(); ++k) {
      const Vec3<double> x = lattice * (edge / per_edge) + turned * shapes[cell % 3][k];
      const Vec3<double> v = speed * Vec3<double>(uniform(), uniform(), uniform());
      molecule.push_back(s.add(std::to_string(s.size()), masses[k], x, v));
      momentum += masses[k] * v;
      mass += masses[k];
    }
    for (std::size_t a = 0; a < molecule.size(); ++a) {
      for (std::size_t b = a + 1; b < molecule.size(); ++b) {
        topology->exclusions.emplace_back(molecule[a], molecule[b]);
        if (cell % 3 != 2) m.constraints.add(s, Distance{}, {molecule[a], molecule[b]});
      }
    }
    if (cell % 3 == 2) add_rigid_bar(m.constraints, s, molecule);
    m.molecules.push_back(std::move(molecule));
  }
  for (Index i = 0; i < s.size(); ++i) s.velocities().add(i, -momentum / mass);
  s.set_topology(std::move(topology));
  return m;
}

/// The same particles, all of them moved aside: the box is cut elsewhere.
inline MolecularLiquid cut_elsewhere(MolecularLiquid m, const Vec3<double>& aside) {
  for (Index i = 0; i < m.particles.size(); ++i) m.particles.shift(i, aside, Vec3<double>::Zero());
  m.particles.moved();
  return m;
}

/// The same particles as a file without images has them: every atom in the cell, molecules cut by its faces.
inline MolecularLiquid without_images(MolecularLiquid m) {
  m.particles.restore_images(VectorColumn<std::int32_t>(m.particles.size()));
  return m;
}

/// Largest difference of a velocity, or of a position by the nearest image, of particles moved `aside` and of others.
inline double difference(const ParticleSystem<double>& moved, const ParticleSystem<double>& s,
                         const Vec3<double>& aside) {
  double worst = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = moved.positions()[i] - s.positions()[i];
    const Vec3<double> apart = s.box().minimum_image(Vec3<double>(x - aside));
    worst = std::max({worst, apart.cwiseAbs().maxCoeff(),
                      Vec3<double>(moved.velocities()[i] - s.velocities()[i]).cwiseAbs().maxCoeff()});
  }
  return worst;
}

}  // namespace noether::test
