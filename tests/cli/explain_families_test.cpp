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

/// Two charges in a box.
const std::string charges_scene = R"(units = "reduced"
[particles]
box = [3, 3, 3]
[[particles.body]]
name = "one"
mass = 1
charge = 1
x = [1.2, 1.5, 0.7]
v = [0, 0, 0]
[[particles.body]]
name = "other"
mass = 1
charge = -1
x = [0.2, 0.1, 1]
v = [0, 0, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "particle_mesh_ewald"
cutoff = 1.4
relative_error = 1e-3
[integrator]
method = "verlet"
step = 0.001
steps = 10
)";

/// Two bodies of three and four sites, a point, and a body of known moments that turns 0.05 times in a step.
const std::string bodies_scene = R"(units = "reduced"
[[particles.body]]
name = "point"
mass = 1
[[particles.rigid_body]]
name = "three"
x = [9, 0, 0]
v = [0, 0, 0]
site = [{place = [1, 0, 0], mass = 1}, {place = [0, 1, 0], mass = 1}, {place = [0, 0, 1], mass = 2}]
[[particles.rigid_body]]
name = "four"
x = [0, 9, 0]
v = [0, 0, 0]
site = [{place = [1, 0, 0], mass = 1}, {place = [0, 1, 0], mass = 1}, {place = [0, 0, 1], mass = 2},
  {place = [0, 0, 0], mass = 1}]
[[particles.rigid_body]]
name = "fast"
mass = 1
inertia = [2, 2, 2]
x = [0, 0, 9]
v = [0, 0, 0]
angular_velocity = [0, 0, 3.141592653589793]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity_of_bodies"
degree = "sites"
[integrator]
method = "verlet"
step = 0.1
steps = 100
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

TEST_CASE("explain tells of rigid bodies: their rotor, sites and bytes", "[cli][explain][bodies]") {
  // Of a point and of a body 7 numbers and an id, and of a body 3 moments, 4 numbers of its orientation and 3 of its
  // spin, in columns that all particles have: 18 in all. 3 and 6 pairs of sites are within a body.
  const SceneFolder folder(bodies_scene);
  check_explained(output(folder, "explain scene.toml"),
                  {"\ncolumns: id, position, velocity, mass, inertia, orientation, spin; 144 bytes per particle\n",
                   "\nrigid bodies: 3 of 8 sites; 9 pairs within a body are left out; rotor exact; the fastest turns "
                   "0.05 times in a step\n"});
  check_explained(output(folder, "explain scene.toml --set hamiltonian.rotor=axes"),
                  {" are left out; rotor axes x y z y x; the fastest turns 0.05 times in a step\n"});
  check_explained(output(folder, "explain scene.toml --set hamiltonian.rotor=axes --set hamiltonian.axes=yxz"),
                  {"; rotor axes y x z x y; "});
  check_explained(output(folder, "explain scene.toml --set hamiltonian.rotor=variational"), {"; rotor variational; "});
  const std::string json = output(folder, "explain scene.toml --json");
  CHECK(json_member(json, "bytes_per_particle") == "144");
  CHECK(json_member(json, "rigid_bodies") == R"({"bodies":3,"held":0,"sites":8,"excluded_pairs":9,"rotor":"exact",)"
                                             R"("turns_per_step":0.05})");
  // A top is held by a point, and turns about all of its axes at once: by |(0.3, 0.4, 0.6)| each unit of time.
  check_explained(output(SceneFolder(group_scene), "explain scene.toml --set integrator.method=verlet"),
                  {"\nrigid bodies: 1 of 1 site, 1 held by fixed points; rotor exact; the fastest turns 0.012 times "
                   "in a step\n"});
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

TEST_CASE("explain recommends steps of a sheet by what limits them there", "[cli][explain]") {
  // At the surface of 'large' 2 pi sqrt(0.3^3/1)/20 = 0.0516; without gravity nothing limits a step.
  const SceneFolder folder(read_text(std::string(NOETHER_SOURCE_DIR) + "/study/suite/hard_spheres.toml"));
  check_explained(output(folder, "explain scene.toml"),
                  {"\nstep: 0.002; at most 0.0516 is recommended, a twentieth of a turn about large at its surface; "
                   "10000 steps in all\n"});
  CHECK(json_member(output(folder, "explain scene.toml --json"), "recommended_step").starts_with("0.0516"));
  check_explained(output(folder, "explain scene.toml --set hamiltonian.force.gravity.G=1e-30"),
                  {"; at most 0.0628 is recommended, a hundredth of a turn of the frame; "});
}

TEST_CASE("explain tells the mesh of charges, its errors, and that without charges it costs nothing",
          "[cli][explain]") {
  const SceneFolder folder(charges_scene);
  const std::string json = output(folder, "explain scene.toml --json");
  const std::string mesh = json_member(json, "mesh");
  CHECK(mesh.starts_with(R"({"force":"particle_mesh_ewald","points":[)"));
  CHECK(json_member(mesh, "rounding") == "0");
  const std::string order = json_member(mesh, "order");
  const std::string splines = " points and splines of order " + order + ", 1/r split at alpha = ";
  check_explained(output(folder, "explain scene.toml"),
                  {"\nmesh: ", splines.c_str(), "; root mean square error of forces ",
                   " from the mesh, in the unit of relative_error\n"});
  check_explained(output(folder, "explain scene.toml --set hamiltonian.force.0.precision=mixed"),
                  {" from the mesh and up to ", " from single precision, in the unit of relative_error\n"});
  check_explained(
      output(folder, "explain scene.toml --set particles.body.one.charge=0 --set particles.body.other.charge=0"),
      {"\nmesh: no particle has a charge, and particle_mesh_ewald costs nothing\n"});
}

}  // namespace noether::test
