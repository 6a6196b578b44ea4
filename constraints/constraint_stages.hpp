#pragma once
/// What a solver of constraints is.

#include "constraints/constraint_equations.hpp"

namespace noether {

/// One way to solve the equations of constraints, for one system: made from equations that are laid out, for which it
/// sizes its arrays, so that stages allocate nothing.
///
/// A solver is called once for all constraints, never for each. It keeps nothing from step to step but what `prepare`
/// makes of the positions: copies are made anew, and bits cannot depend on what was solved before.
template <class Real> class ConstraintStages {
 public:
  virtual ~ConstraintStages() = default;

  /// Makes what it needs of `equations.gradients()`, those where the particles of `s` are: a factorisation, or nothing.
  /// It is called before a stage that finds gradients it has not seen; of the two stages that meet at these positions
  /// the first finds them.
  /// @return false if it cannot, and has said why by `equations.fail`
  virtual bool prepare(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s) = 0;

  /// The position stage: takes the column `x` from where free motion ends to x - M^-1 G0^T lambda with g(x) = 0, and
  /// leaves lambda in `equations.multipliers()`. G0 is `equations.start_gradients()`, which `prepare` has seen.
  /// @param x  see ConstraintEquations::seen  @param h  duration of the free motion [time]
  /// @return false if there is no solution, or it is not found, and has said why by `equations.fail`
  virtual bool solve_positions(ConstraintEquations<Real>& equations, const ParticleSystem<Real>& s,
                               VectorColumn<Real>& x, const Real& h) = 0;

  /// The velocity stage: takes from velocities M^-1 G^T mu, so that G v = 0, with G of `equations.gradients()`; says by
  /// `equations.fail` why if it cannot. @param h  what a tolerance of velocities is relative to [time]
  virtual void project_velocities(ConstraintEquations<Real>& equations, ParticleSystem<Real>& s, const Real& h) = 0;
};

}  // namespace noether
