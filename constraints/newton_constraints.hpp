#pragma once
/// Constraints solved all at once, to rounding.

#include "constraints/constraint_stages.hpp"

namespace noether {

/// Newton's method for both stages: the matrix G M^-1 G^T that the velocity stage has factorized at x serves the
/// position stage of the next step too, by chord steps, and gives way to fresh matrices G(x) M^-1 G(x0)^T where these
/// converge slowly. Where Newton's method loses its way the solution is followed from that of a step of 0.
/// @cost O(equations) for chains and trees; fresh matrices allocate
template <class Real> class NewtonConstraints final : public ConstraintStages<Real> {
 public:
  explicit NewtonConstraints(const ConstraintEquations<Real>& equations);

  bool prepare(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s) override;
  bool solve_positions(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, VectorColumn<Real>& x,
                       const Real& h) override;
  void project_velocities(ConstraintEquations<Real>& equations, ParticleSystem<Real>& s, const Real& h) override;

 private:
  using Vector = typename ConstraintMatrix<Real>::Vector;

  bool iterate(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, VectorColumn<Real>& x, bool fresh);
  bool follow(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h,
              double* reached);
  /// Fails by the first equation across which velocities are no numbers. @return whether there is one
  bool has_lost(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s) const;
  void place(ConstraintEquations<Real>& equations, const Box& box, VectorColumn<Real>& x) const;

  int passes_ = 2;                 ///< of a velocity stage
  ConstraintGradients<Real> new_;  ///< where a position stage has come to
  VectorColumn<Real> free_;        ///< where free motion alone would end
};

}  // namespace noether
