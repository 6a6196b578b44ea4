#pragma once
/// Constraints inside the flows: free motion that ends on them, and velocities along them.

#include "constraints/constraint_matrix.hpp"
#include "constraints/constraint_set.hpp"
#include "engine/concepts.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Solves the equations of a set for one system.
///
///     position stage:  x = x0 + h v - M^-1 G(x0)^T lambda,  g(x) = 0;   v -> v - M^-1 G(x0)^T lambda / h
///     velocity stage:  v -> v - M^-1 G(x)^T mu,             G(x) v = 0
///
/// In a periodic box constraints see nearest images, and all is solved for what particles move from where they are: the
/// sum, rounded to the grid of the box, is added at the end, and bits do not depend on where the box is cut.
///
/// Free motion between the two stages is RATTLE's. Newton's method takes both to rounding: the matrix G M^-1 G^T that
/// the velocity stage has factorized at x serves the position stage of the next step too, by chord steps, and gives way
/// to fresh matrices G(x) M^-1 G(x0)^T where these converge slowly. Nothing is carried from step to step but these
/// factors, which are functions of the positions: bits cannot depend on what was solved before.
/// @source Andersen1983, LeimkuhlerSkeel1994
template <class Real> class ConstraintSolver {
 public:
  explicit ConstraintSolver(ConstraintSet set) : set_(std::move(set)) {}

  const ConstraintSet& set() const { return set_; }

  /// Takes the particles as they are and, at the start of a run, moves positions and velocities onto the constraints.
  /// @throws BadConstraints  naming the constraint that is violated by more than 1e-6, one of mass 0, constraints that
  ///         depend on each other, sums with compensation, one that reaches half of an edge of a periodic box
  void bind(ParticleSystem<Real>& s);

  /// The position stage of free motion for a time.
  void advance_positions(ParticleSystem<Real>& s, const Real& h);
  /// The velocity stage. @param h  duration of the flow it ends: what a tolerance of velocities is relative to [time]
  void project_velocities(ParticleSystem<Real>& s, const Real& h);
  /// Makes accelerations by forces those of the motion: adds what the constraints do [length/time^2].
  void constrain(const ParticleSystem<Real>& s, VectorColumn<Real>& a);
  /// Sum x (x) f over the forces f by which constraints hold particles against accelerations `a` of all other forces
  /// [energy]: of constraints that keep momentum, where it does not matter from where positions are counted.
  Mat3<Real> virial(const ParticleSystem<Real>& s, const VectorColumn<Real>& a);

  /// Why a stage could not be solved; from then on stages do nothing.
  const std::optional<Failure>& failure() const { return failure_; }
  void forget_failure() { failure_.reset(); }
  /// Chord and Newton steps, or sweeps, so far.
  std::int64_t iterations() const { return iterations_; }
  void restore_iterations(std::int64_t iterations) { iterations_ = iterations; }

 private:
  using Vector = typename ConstraintMatrix<Real>::Vector;
  using Positions = ConstraintPositions<Real>;

  void lay_out(const ParticleSystem<Real>& s);
  void check_reach(const ParticleSystem<Real>& s) const;
  void check_start(const ParticleSystem<Real>& s);
  void check_independent(const ParticleSystem<Real>& s);

  /// Gradients, and their factors, at the positions of `s`. @return whether there are factors
  bool know(const ParticleSystem<Real>& s);
  void gradients(const Positions& x, ConstraintGradients<Real>& out) const;
  void values(const Positions& x);
  void find_floors(const ParticleSystem<Real>& s);
  double worst(Index* equation) const;
  bool settled() const;

  // The column x of a position stage: positions, or in a periodic box what particles have moved from those of `s`.
  VectorColumn<Real> start_of(const ParticleSystem<Real>& s) const;
  Positions seen(const ParticleSystem<Real>& s, const VectorColumn<Real>& x) const;
  void move_to(ParticleSystem<Real>& s, const VectorColumn<Real>& x) const;
  void round_to_grid(const Box& box, VectorColumn<Real>& x) const;

  bool solve_by_newton(const ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h);
  bool iterate(const ParticleSystem<Real>& s, VectorColumn<Real>& x, bool fresh);
  bool follow(const ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h, double* reached);
  bool solve_by_sweeps(const ParticleSystem<Real>& s, VectorColumn<Real>& x);
  void project_by_newton(ParticleSystem<Real>& s);
  bool project_by_sweeps(ParticleSystem<Real>& s, const Real& h);
  void place(const Box& box, VectorColumn<Real>& x) const;
  bool on_this_side(Index* equation) const;
  /// Multipliers by which accelerations `a` become those of the motion; of a singular set none.
  std::optional<Vector> holding(const ParticleSystem<Real>& s, const VectorColumn<Real>& a);
  /// column -= factor M^-1 G^T multipliers.
  void push(VectorColumn<Real>& column, const ConstraintGradients<Real>& g, const Vector& multipliers,
            const Real& factor) const;
  Real along(Index equation, const VectorColumn<Real>& v, const ConstraintGradients<Real>& g) const;
  void fail(const ParticleSystem<Real>& s, Index equation, const std::string& what);

  ConstraintSet set_;
  ConstraintLayout<Real> layout_;
  std::vector<double> scales_;  ///< of each equation
  ConstraintMatrix<Real> matrix_;
  ConstraintGradients<Real> here_, old_,
      new_;                             ///< at the known positions; at the start and the end of a position stage
  std::optional<std::uint64_t> known_;  ///< version of the positions that `here_` and the factors belong to
  Vector g_, lambda_;
  std::vector<double> floors_;       ///< what rounding leaves of abs(g)
  VectorColumn<Real> start_, free_;  ///< before a position stage, and where free motion alone would end
  VectorColumn<Real> moved_;         ///< in a periodic box: from the start of a position stage to its end
  std::vector<Real> sweep_values_;   ///< of one constraint
  std::vector<Vec3<Real>> sweep_gradients_;
  std::optional<Failure> failure_;
  std::int64_t iterations_ = 0;
};

}  // namespace noether
