#include "scene/constrained.hpp"

#include <optional>
#include <utility>

namespace noether {

namespace {

/// Constraints, for the minimizer.
class AlongConstraints final : public MinimizeAlong {
 public:
  explicit AlongConstraints(ConstraintSet set) : solver_(std::move(set)) {}
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

Minimized minimize(ParticleSystem<double>& s, const AnyForce<double>& forces, ConstraintSet constraints,
                   const MinimizeOptions& options) {
  AlongConstraints along(std::move(constraints));
  return minimize(s, forces, options, &along);
}

template class KineticPotential<ForceField<double>, double, ConstraintSet>;
template struct detail::HamiltonianModel<Constrained>;

}  // namespace noether
