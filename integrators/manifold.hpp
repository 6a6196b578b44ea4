#pragma once
/// The states on which invariants have given values, and the directions that lead back to them.

#include "engine/equations.hpp"
#include "engine/erasure.hpp"
#include "integrators/projection.hpp"
#include "integrators/vector_field.hpp"

#include <memory>
#include <string>
#include <vector>

namespace noether {

/// Small systems of linear equations, A x = b, by elimination with full pivoting: equations that depend on others are
/// left out, and their unknowns are 0.
/// @cost n^3 / 3 to factorize
template <class Real> class PivotedSolver {
 public:
  void factorize(Matrix<Real> A);
  /// Solves in place.
  void solve(Vector<Real>& b) const;
  /// How many equations do not depend on others.
  Index rank() const { return rank_; }

 private:
  Matrix<Real> lu_;
  std::vector<Index> rows_, columns_;
  Index rank_ = 0;
};

/// { y : g(y) = g(y_0) }, for g among energy, momentum, angular momentum, and further equations.
///
/// All of it is about settled states, y = (x, v) of particles as `Equations` has them, or the variables of a system.
template <class Real> class Manifold {
 public:
  Manifold(ProjectionOptions options, std::vector<std::unique_ptr<Equations<Real>>> own);
  Manifold(const Manifold& other);
  Manifold(Manifold&&) noexcept = default;
  Manifold& operator=(const Manifold& other) { return *this = Manifold(other); }
  Manifold& operator=(Manifold&&) noexcept = default;
  ~Manifold() = default;

  const ProjectionOptions& options() const { return options_; }
  /// @throws SchemeMismatch  for invariants that a run does not have, or that its motion does not keep
  void bind(const ParticleSystem<Real>& s, const IntegratorClaims& claims);
  Index size() const { return size_; }
  /// As messages call an equation.
  std::string name(Index equation) const;
  std::string signature() const;

  /// Where velocities begin in y; of variables their number.
  Index half(Index numbers) const { return particles_ > 0 ? 3 * particles_ : numbers; }
  /// y of particles or variables.
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const;
  /// Puts y into particles or variables; second words are 0 then.
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const;

  /// The values of all equations, and what their errors are small beside, shape (size).
  void values(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Vector<Real>& g, Vector<Real>& scale);
  /// What the values are to be, for a run that begins with values g.
  std::vector<Real> aims(const Vector<Real>& g) const;
  /// dg/dy, shape (y, size).
  void gradients(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Matrix<Real>& G);
  /// D, along which a projection moves a state with these gradients, shape (y, size).
  void directions(const Matrix<Real>& G, Matrix<Real>& D) const;

 private:
  void check(const ParticleSystem<Real>& s, const IntegratorClaims& claims) const;
  void check_particles(const ParticleSystem<Real>& s, const IntegratorClaims& claims) const;
  void check_hamiltonian() const;
  void check_wraps(const ParticleSystem<Real>& s, Equations<Real>& own) const;
  void energy_gradient(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Matrix<Real>& G, Index column);
  void weigh(const Matrix<Real>& G, Matrix<Real>& D) const;

  ProjectionOptions options_;
  std::vector<std::unique_ptr<Equations<Real>>> own_;
  Index size_ = 0, particles_ = 0, variables_ = 0;
  std::vector<Real> masses_;
  VectorColumn<Real> a_;
};

extern template class PivotedSolver<double>;
extern template class PivotedSolver<Quad>;
extern template class Manifold<double>;
extern template class Manifold<Quad>;

}  // namespace noether
