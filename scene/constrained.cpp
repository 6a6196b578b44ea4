#include "scene/constrained.hpp"

#include <optional>
#include <utility>

namespace noether {

namespace {

/// Constraints, for the minimizer: to rounding, whatever a run leaves of them, since runs begin on them.
class AlongConstraints final : public MinimizeAlong {
 public:
  explicit AlongConstraints(const ConstraintSet& set)
      : solver_(set.options().end() == SolverEnd::rounding ? set : set.solved_by({})) {}
  void bind(ParticleSystem<double>& s) override { solver_.bind(s); }
  void advance_positions(ParticleSystem<double>& s, double h) override { solver_.advance_positions(s, h); }
  void project_velocities(ParticleSystem<double>& s, double h) override { solver_.project_velocities(s, h); }
  void constrain(const ParticleSystem<double>& s, VectorColumn<double>& a) override { solver_.constrain(s, a); }
  std::optional<Failure> take_failure() override {
    std::optional<Failure> failure = solver_.failure();
    solver_.forget_failure();
    return failure;
  }

 private:
  ConstraintSolver<double> solver_;
};

}  // namespace

Minimized minimize(ParticleSystem<double>& s, const AnyForce<double>& forces, const ConstraintSet& constraints,
                   const MinimizeOptions& options) {
  AlongConstraints along(constraints);
  return minimize(s, forces, options, &along);
}

template class KineticPotential<ForceField<double>, double, ConstraintSet>;
template struct detail::HamiltonianModel<Constrained>;

}  // namespace noether
