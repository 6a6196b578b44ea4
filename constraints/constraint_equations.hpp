#pragma once
/// The equations of constraints, laid out for one system: what all solvers of them share.

#include "constraints/constraint_matrix.hpp"
#include "constraints/constraint_set.hpp"
#include "engine/concepts.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// The equations of a set: their layout, values, gradients and floors of rounding, and why a stage has failed.
///
/// In a periodic box constraints see nearest images, and all is solved for what particles move from where they are: the
/// sum, rounded to the grid of the box, is added at the end, and bits do not depend on where the box is cut.
template <class Real> class ConstraintEquations {
 public:
  using Vector = typename ConstraintMatrix<Real>::Vector;
  using Positions = ConstraintPositions<Real>;
  static constexpr double unit_roundoff = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;

  explicit ConstraintEquations(ConstraintSet set) : set_(std::move(set)) {}

  const ConstraintSet& set() const { return set_; }
  const ConstraintOptions& options() const { return set_.options(); }

  /// Takes the particles as they are, and forgets failures and everything known of others.
  /// @throws BadConstraints  naming a particle that is not there or has no mass, a scale that is not above 0, a
  ///         constraint that reaches half of an edge of a periodic box
  void lay_out(const ParticleSystem<Real>& s);
  Index size() const { return layout_.equations(); }
  const ConstraintLayout<Real>& layout() const { return layout_; }
  /// Of all particles [mass].
  const ScalarColumn<Real>& masses() const { return masses_; }
  /// What |g| is small beside. @param e  an equation
  double scale(Index e) const { return scales_[at(e)]; }
  /// What rounding leaves of |g|, as found last.
  double floor(Index e) const { return floors_[at(e)]; }

  /// Finds the gradients at the positions of `s` unless they are known. @return whether they were not
  bool know(const ParticleSystem<Real>& s);
  /// G at the known positions, and at the start of a position stage.
  const ConstraintGradients<Real>& gradients() const { return here_; }
  const ConstraintGradients<Real>& start_gradients() const { return old_; }
  void find_gradients(const Positions& x, ConstraintGradients<Real>& out) const;
  /// G M^-1 G^T, and its factors where somebody has asked for them since gradients were found.
  ConstraintMatrix<Real>& matrix() { return matrix_; }

  /// g, as found last.
  Vector& values() { return g_; }
  void find_values(const Positions& x);
  void find_floors(const ParticleSystem<Real>& s);
  /// Largest |g| / scale, and whose it is.
  double worst(Index* equation) const;
  /// Whether every |g| is what rounding leaves.
  bool settled() const;

  /// Lambda of the position stage solved last.
  Vector& multipliers() { return lambda_; }
  /// column -= factor M^-1 G^T multipliers.
  void push(VectorColumn<Real>& column, const ConstraintGradients<Real>& g, const Vector& multipliers,
            const Real& factor) const;
  /// An element of G v.
  Real along(Index equation, const VectorColumn<Real>& v, const ConstraintGradients<Real>& g) const {
    Real sum(0);
    for (Index a = layout_.first[at(equation)]; a < layout_.first[at(equation) + 1]; ++a) {
      sum += dot(g[at(a)], v[layout_.particle[at(a)]]);
    }
    return sum;
  }

  /// What constraints see of a column x of a position stage: positions, or in a periodic box what particles have moved
  /// from those of `s`.
  Positions seen(const ParticleSystem<Real>& s, const VectorColumn<Real>& x) const {
    return s.box().is_periodic() ? Positions(s, &x) : Positions(x);
  }
  /// That column before free motion.
  const VectorColumn<Real>& start() const { return start_; }
  /// What is solved for is what will be stored.
  void round_to_grid(const Box& box, VectorColumn<Real>& x) const;
  void move_to(ParticleSystem<Real>& s, const VectorColumn<Real>& x) const;

  /// Begins a position stage. @return the column x where free motion ends
  VectorColumn<Real>& move_freely(ParticleSystem<Real>& s, const Real& h);
  /// Ends one that is solved: positions, velocities, and gradients there.
  void arrive(ParticleSystem<Real>& s, const VectorColumn<Real>& x, const Real& h);
  /// Ends one that is not.
  void turn_back(ParticleSystem<Real>& s);
  /// Takes the known positions for the start of a position stage.
  void start_here() { old_ = here_; }
  /// Whether the solution goes on from that of a step of 0: then G(x) M^-1 G(x0)^T > 0 for each equation by itself.
  bool on_this_side(Index* equation) const;

  const std::optional<Failure>& failure() const { return failure_; }
  void fail(const ParticleSystem<Real>& s, Index equation, const std::string& what);
  void fail(const Failure& failure) { failure_ = failure; }
  void forget_failure() { failure_.reset(); }
  /// What solvers have done so far.
  const ConstraintWork& work() const { return work_; }
  void count_iteration() { ++work_.iterations; }
  void count_iterations(std::int64_t more) { work_.iterations += more; }
  /// Whether those whose stages do not see violations are to look now: about once in 64 stages, and not at all where
  /// others are measured anyway.
  bool looks() const { return work_.iterations > 64 * work_.measured; }
  /// Notes how far the iterations of a position stage reduced its largest violation; it does not count them. What is
  /// left as 0 is below rounding.
  void measure(double before, double after, std::int64_t iterations);
  void restore(const ConstraintWork& work) { work_ = work; }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  void find_ties();
  void check_reach(const ParticleSystem<Real>& s) const;

  ConstraintSet set_;
  ConstraintLayout<Real> layout_;
  /// The entries of the layout by particle, with the equation of each: those of particle i of `tied_`, ascending, are
  /// [first_tie_[i], first_tie_[i + 1]).
  std::vector<Index> tied_, first_tie_, tie_entry_, tie_equation_;
  ScalarColumn<Real> masses_;
  std::vector<double> scales_, floors_;  ///< of each equation
  ConstraintMatrix<Real> matrix_;
  ConstraintGradients<Real> here_, old_;
  std::optional<std::uint64_t> known_;  ///< version of the positions that `here_` and the factors belong to
  Vector g_, lambda_;
  VectorColumn<Real> start_;  ///< before a position stage
  VectorColumn<Real> moved_;  ///< in a periodic box: from the start of a position stage to its end
  std::optional<Failure> failure_;
  ConstraintWork work_;
};

}  // namespace noether
