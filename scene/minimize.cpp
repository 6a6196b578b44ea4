#include "scene/minimize.hpp"

#include "constraints/constraint_solver.hpp"
#include "scene/fields.hpp"

#include <fmt/format.h>

namespace noether {

SceneValue read_minimize(const SceneContext& context, const SceneValue& table, Scene& scene) {
  TableReader reader(context, table, "[minimize]", "minimize");
  if (table.get<SceneValue::Table>() == nullptr) reader.wrong_kind(table, "minimize", "a table");
  MinimizeOptions options;
  read_part(reader, options);
  if (!scene.hamiltonian.splitting.claims().inertial) {
    reader.fail(
        nullptr, "",
        fmt::format("planets of {} have no minimum to move to; take [minimize] out", scene.hamiltonian.splitting.name));
  }
  if (!scene.hamiltonian.splitting.only_forces) {
    reader.fail(nullptr, "",
                fmt::format("{} is more than forces, so a minimum of their energy is not at rest; take [minimize] out",
                            scene.hamiltonian.splitting.name));
  }
  for (const SceneForce& force : scene.hamiltonian.terms()) {
    if (!force.force.claims().time_dependent) continue;
    reader.fail(
        nullptr, "",
        fmt::format("force '{}' depends on time, so there is no minimum to move to; take [minimize] out", force.name));
  }
  scene.minimize = options;
  SceneValue effective = SceneValue::table();
  put_fields(reader, options, effective);
  return effective;
}

namespace {

/// The constraints of a scene, for the minimizer.
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

Minimized minimize_start(Scene& scene) {
  ForceField<double> forces;
  for (const SceneForce& force : scene.hamiltonian.terms()) forces.add(force.force);  // drag has no part in a minimum
  if (scene.hamiltonian.constraints.empty()) return minimize(scene.particles, forces, *scene.minimize);
  AlongConstraints along(constraints_of(scene, scene.hamiltonian.constraints.size()));
  return minimize(scene.particles, forces, *scene.minimize, &along);
}

}  // namespace noether
