#pragma once
/// Constraints inside the flows: free motion that ends on them, and velocities along them.

#include "constraints/constraint_equations.hpp"
#include "constraints/constraint_stages.hpp"
#include "constraints/molecule_lanes.hpp"
#include "engine/saved_state.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace noether {

/// Moves one system along the constraints of a set.
///
///     position stage:  x = x0 + h v - M^-1 G(x0)^T lambda,  g(x) = 0;   v -> v - M^-1 G(x0)^T lambda / h
///     velocity stage:  v -> v - M^-1 G(x)^T mu,             G(x) v = 0
///
/// Molecules held by distances alone are solved side by side in lanes (MoleculeLanes), all others together.
///
/// Free motion between the two stages is RATTLE's. How their equations are solved is that of ConstraintOptions::solver
/// (ConstraintStages); Newton's method takes the start of every run onto the constraints, to rounding. Nothing is
/// carried from step to step but functions of the positions: bits cannot depend on what was solved before.
/// @source Andersen1983, LeimkuhlerSkeel1994
template <class Real> class ConstraintSolver {
 public:
  explicit ConstraintSolver(ConstraintSet set) : equations_(std::move(set)) {}
  ConstraintSolver(const ConstraintSolver& other);
  ConstraintSolver(ConstraintSolver&&) noexcept = default;
  ConstraintSolver& operator=(const ConstraintSolver& other) { return *this = ConstraintSolver(other); }
  ConstraintSolver& operator=(ConstraintSolver&&) noexcept = default;
  ~ConstraintSolver() = default;

  const ConstraintSet& set() const { return equations_.set(); }
  /// The relative violation that is left on purpose; 0: rounding of these numbers.
  double tolerance() const;

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
  const std::optional<Failure>& failure() const { return moving().failure(); }
  void forget_failure() { moving().forget_failure(); }
  /// Chord and Newton steps, or sweeps, so far: of each stage the most that a molecule needed.
  std::int64_t iterations() const { return work().iterations; }
  const ConstraintWork& work() const { return moving().work(); }
  void restore(const ConstraintWork& work) { moving().restore(work); }
  void save_work(SavedState& saved, const std::string& prefix) const;
  void load_work(const SavedState& saved, const std::string& prefix);

 private:
  using Vector = typename ConstraintMatrix<Real>::Vector;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  /// The equations that stages solve: all, or those that are not in lanes.
  ConstraintEquations<Real>& moving() { return others_ ? *others_ : equations_; }
  const ConstraintEquations<Real>& moving() const { return others_ ? *others_ : equations_; }
  /// @throws BadConstraints  for a constraint that the solver is not for
  void check_served(const ParticleSystem<Real>& s) const;
  void lay_out_lanes(const ParticleSystem<Real>& s);
  /// Stages of the molecules in lanes. @return whether all are solved
  bool solve_in_lanes(ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h);
  bool project_in_lanes(ParticleSystem<Real>& s, const Real& h);
  /// One of them by the solver of all cases.
  bool solve_alone(Index molecule, ParticleSystem<Real>& s, VectorColumn<Real>& x, const Real& h);
  bool project_alone(Index molecule, ParticleSystem<Real>& s, const Real& h);
  void check_start(const ParticleSystem<Real>& s);
  void check_independent(const ParticleSystem<Real>& s);
  void start_on_constraints(ParticleSystem<Real>& s);
  double velocity_across(const ParticleSystem<Real>& s) const;
  /// Gradients at the positions of `s`, and what the stages make of them. @return whether they can
  bool prepare(const ParticleSystem<Real>& s);
  /// Multipliers by which accelerations `a` become those of the motion; of a singular set none.
  std::optional<Vector> holding(const ParticleSystem<Real>& s, const VectorColumn<Real>& a);

  ConstraintEquations<Real> equations_;                     ///< all: starts, forces of constraints
  MoleculeLanes lanes_;                                     ///< of doubles alone
  std::unique_ptr<ConstraintEquations<Real>> others_ = {};  ///< null where nothing is in lanes
  std::unique_ptr<ConstraintStages<Real>> stages_;          ///< null before `bind`
  bool prepared_ = false;                                   ///< of the known gradients
};

}  // namespace noether
