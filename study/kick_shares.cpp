#include "study/kick_shares.hpp"

#include "integrators/force_motion.hpp"
#include "study/spectrum.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace noether {

namespace {

constexpr Index most_with_modes = 64;

/// M^-1/2 U'' M^-1/2 of some forces, shape (3 n, 3 n).
Matrix<double> hessian_of(const ForceField<double>& forces, const ParticleSystem<double>& s, double t) {
  ForceMotion<ForceField<double>, double> motion(forces);
  motion.bind(s);
  Vector<double> y, unit = Vector<double>::Zero(3 * s.size()), column(3 * s.size());
  motion.gather(s, y);
  const std::vector<double> masses(s.masses().data(), s.masses().data() + s.size());
  const Operator product = weighted_hessian(motion, t, y, masses);
  Matrix<double> hessian(unit.size(), unit.size());
  for (Index j = 0; j < unit.size(); ++j) {
    unit[j] = 1;
    product(unit, column);
    hessian.col(j) = column;
    unit[j] = 0;
  }
  return Matrix<double>((hessian + hessian.transpose()) / 2);
}

}  // namespace

std::map<char, double> kick_shares(const Scene& scene) {
  const SceneHamiltonian& hamiltonian = scene.hamiltonian;
  const bool plain = hamiltonian.splitting.only_forces && hamiltonian.splitting.own.empty() &&
                     hamiltonian.constraints.empty() && !hamiltonian.rotating;
  if (!plain || scene.particles.size() == 0 || scene.particles.size() > most_with_modes) return {};
  std::map<char, ForceField<double>> fields;
  for (const SceneForce& force : hamiltonian.forces) {
    const std::string kicks = force.force.claims().kicks;
    if (force.letter) continue;
    if (kicks.size() != 1) return {};
    fields[kicks.front()].add(force.force);
  }
  std::map<char, Matrix<double>> parts;
  const Index n = 3 * scene.particles.size();
  Matrix<double> all = Matrix<double>::Zero(n, n);
  for (const auto& [letter, field] : fields) {
    all += parts.emplace(letter, hessian_of(field, scene.particles, scene.integrator.start)).first->second;
  }
  if (!all.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Matrix<double>> solver(all);
  const double fastest = solver.eigenvalues()[n - 1];
  if (!(fastest > 0)) return {};
  const Vector<double> mode = solver.eigenvectors().col(n - 1);
  std::map<char, double> shares;
  for (const auto& [letter, part] : parts) {
    const Vector<double> pulled = part * mode;
    const double share = mode.dot(pulled) / fastest;
    if ((pulled - share * fastest * mode).norm() > 1e-6 * fastest) return {};
    shares[letter] = share;
  }
  return shares;
}

}  // namespace noether
