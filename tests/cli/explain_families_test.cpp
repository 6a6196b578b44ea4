// What `explain` tells of methods on groups and over actions: exponentials, commutators, Jacobians, the shadow.

#include "tests/cli/support.hpp"

#include <string>

namespace noether::test {
namespace {

const std::string group_scene = R"(units = "reduced"
[[particles.rigid_body]]
name = "top"
mass = 1
inertia = [2, 1, 1.5]
fixed_point = [0, 0, 0]
center = [0.2, 0.3, 0.5]
spin = [0.6, -0.4, 0.9]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "uniform_field"
acceleration = [0, 0, -1]
[integrator]
method = "rkmk_rk4"
step = 0.1
steps = 100
)";

const std::string action_scene = R"(units = "reduced"
[system]
type = "polar_kepler"
[integrator]
method = "variational_midpoint"
step = 0.05
steps = 400
)";

void check_explained(const std::string& text, std::initializer_list<const char*> lines) {
  for (const char* line : lines) {
    INFO(line << "\n" << text);
    CHECK(has(text, line));
  }
}

}  // namespace

TEST_CASE("explain tells what a step on a group takes, and who can watch it", "[cli][explain][lie]") {
  const SceneFolder folder(group_scene);
  check_explained(
      output(folder, "explain scene.toml"),
      {"\n  4 evaluations, 4 exponentials and 6 commutators a step on a group; commutators could be reduced to "
       "2; 2 nested commutators in dexp^-1 of a stage\n",
       "; rotor exponentials on SO(3), spins in axes of the body; ",
       "\nmonitor 'shadow_hamiltonian' cannot watch: methods on groups have no action; "
       "'lie_group_variational' has one\n"});
  check_explained(output(folder, "explain scene.toml --set integrator.dexp_terms=4"),
                  {"; 4 nested commutators in dexp^-1 of a stage\n"});
  check_explained(output(folder, "explain scene.toml --set integrator.method=commutator_free_4"),
                  {"\n  4 evaluations, 5 exponentials and 0 commutators a step on a group\n"});
  check_explained(output(folder, "explain scene.toml --set integrator.method=lie_group_variational"),
                  {"; rotor variational; ", "\nmonitor 'shadow_hamiltonian' can watch: every step has its action\n"});
  CHECK(has(output(folder, "describe rkmk_dop853"), "; 6 nested commutators in dexp^-1 of a stage\n"));
}

TEST_CASE("explain tells what a step over an action takes, and who can watch it", "[cli][explain][variational]") {
  const SceneFolder folder(action_scene);
  check_explained(output(folder, "explain scene.toml"),
                  {" of all rates and 1 of their Jacobian, on the average of the first steps\n",
                   "\nmonitor 'shadow_hamiltonian' can watch: every step has its action\n"});
  check_explained(
      output(folder, "explain scene.toml --set integrator.method=rk4"),
      {"\n  4 evaluations of all rates, on the average of the first steps\n",
       "\nmonitor 'shadow_hamiltonian' cannot watch: method 'rk4' does not compute it; it is not symplectic\n"});
  check_explained(
      output(folder, "explain scene.toml --set system.type=pendulum --set system.damping=0.1"),
      {"\nmonitor 'shadow_hamiltonian' cannot watch: a force of this run is dissipative, so its motion has no "
       "action\n"});
  CHECK_FALSE(has(output(folder, "explain scene.toml --set system.type=lorenz --set integrator.method=rk4"), "shadow"));
}

}  // namespace noether::test
