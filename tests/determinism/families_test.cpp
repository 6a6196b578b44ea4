/// The same bits whichever way a run is made, for methods on groups, by an action, and over bodies that deform.

#include "engine/bodies.hpp"
#include "forces/hyperelastic.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/lie/linear_rotation.hpp"
#include "integrators/projected.hpp"
#include "integrators/rotating.hpp"
#include "integrators/systems/double_pendulum.hpp"
#include "integrators/systems/polar_kepler.hpp"
#include "integrators/systems/turning_frame.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "scene/block.hpp"
#include "tests/determinism/twins.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/planets.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::check_ways, test::Twin;

/// A liquid of bent bodies of three sites.
ParticleSystem<double> bent_liquid() {
  const ParticleSystem<double> atoms = test::liquid(4, 0.3, 1, 0.1);
  const RigidBody bent = body_of_sites("bent", {{.place = {0, 0, 0}, .mass = 1},
                                                {.place = {0.3, 0.1, 0}, .mass = 0.5},
                                                {.place = {-0.2, 0.3, 0}, .mass = 0.25}});
  ParticleSystem<double> s(atoms.units());
  Bodies bodies;
  for (Index i = 0; i < atoms.size(); ++i) {
    const Vec3<double> x = atoms.positions()[i], v = atoms.velocities()[i];
    add_body(s, bodies, bent,
             {.x = x, .v = v, .orientation = {1, v[1], v[2], v[0]}, .spin = Vec3<double>(0.1 * v[2], 0.2 * v[0], 0.1)});
  }
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  s.set_box(atoms.box());
  return s;
}

/// Bodies stepped on their group, and by the discrete action.
std::vector<Twin> group_twins() {
  const ParticleSystem<double> s = bent_liquid();
  ForceField<double> pairs, on_bodies;
  pairs.add(LennardJonesForce{.cutoff = 2.2, .epsilon = 1.0, .sigma = 0.8});
  on_bodies.add(OnSites<double>(pairs));
  const auto twin = [&](const std::string& name, AnyIntegrator<double> program) {
    return Twin{.name = "a liquid of bodies, " + name,
                .bodies = s,
                .program = std::move(program),
                .step = 0.01,
                .hamiltonian =
                    "[hamiltonian]\ntype='kinetic_potential'\n[[hamiltonian.force]]\ntype='lennard_jones'\n"
                    "cutoff=2.2\nepsilon=1\nsigma=0.8\n",
                .method = name,
                .place =
                    "[particles]\nbox=[9,9,9]\n[[particles.rigid_body]]\nname='replaced too'\nmass=1\n"
                    "inertia=[1,1,1]\nx=[4,0,0]\nv=[0,0,0]\n"};
  };
  std::vector<Twin> twins;
  for (const char* name : {"rkmk_rk4", "crouch_grossman_4", "commutator_free_4"}) {
    twins.push_back(twin(name, lie(on_bodies, method(name))));
  }
  twins.push_back(twin("lie_group_variational",
                       compose(Rotating<AnyHamiltonian<double>>(AnyHamiltonian<double>(KineticPotential(on_bodies)),
                                                                {.rotor = Rotor::variational}),
                               schemes::lie_group_variational)));
  return twins;
}

/// A system of variables by a method, from its own start.
template <class S>
Twin system_twin(const std::string& name, const S& system, AnyIntegrator<double> program, bool energy = true) {
  const std::string type(part_name<S>());
  return {.name = fmt::format("{} by {}", type, name),
          .bodies = initial_state(system),
          .program = std::move(program),
          .step = 0.05,
          .hamiltonian = "[system]\ntype='" + type + "'\n",
          .method = name,
          .particles = "",
          .watched = energy ? "energy" : "variables"};
}

std::vector<Twin> action_twins() {
  std::vector<Twin> twins;
  for (const char* name : {"variational_midpoint", "galerkin_gauss_2", "galerkin_lobatto_4"}) {
    twins.push_back(system_twin(name, PolarKepler{}, variational(PolarKepler{}, method(name))));
    twins.push_back(system_twin(name, DoublePendulum{}, variational(DoublePendulum{}, method(name))));
    twins.push_back(
        {.name = fmt::format("planets by {}", name),
         .bodies = test::outer_planets(),
         .program = test::classical_over(Gravity{.G = test::outer_G}, method(name)),
         .step = 60,
         .hamiltonian = fmt::format(
             "[hamiltonian]\ntype='kinetic_potential'\nG={}\n[[hamiltonian.force]]\ntype='gravity'\n", test::outer_G),
         .method = name});
  }
  Twin held = twins.back();
  held.name += ", projected";
  held.program = projected(held.program, {.onto = {Invariant::energy}});
  held.decorators = "[integrator.projection]\nonto=['energy']\n";
  twins.push_back(std::move(held));
  return twins;
}

std::vector<Twin> frame_twins() {
  std::vector<Twin> twins;
  for (const char* name : {"magnus_2", "magnus_4", "magnus_6", "magnus_cf_4", "rkmk_rk4"}) {
    twins.push_back(system_twin(name, TurningFrame{}, lie(TurningFrame{}, method(name)), false));
  }
  return twins;
}

/// A block that tumbles, by a splitting, and a small one by a method that is exact in its energy.
std::vector<Twin> block_twins() {
  const HyperelasticForce rubber{{.material = ElasticLaw::neo_hookean, .lambda = 1, .mu = 0.8}};
  const auto twin = [](int cells, const std::string& name, AnyIntegrator<double> program) {
    const Block block{.cells = {cells, cells, cells},
                      .size = {1, 1, 1},
                      .density = 1,
                      .stretch = {1.2, 0.9, 1.05},
                      .angular_velocity = {1, 0.3, 2}};
    return Twin{
        .name = fmt::format("a block of {}^3 cells by {}", cells, name),
        .bodies = block.build(),
        .program = std::move(program),
        .step = 0.02,
        .hamiltonian =
            "[hamiltonian]\ntype='kinetic_potential'\n[[hamiltonian.force]]\ntype='hyperelastic'\n"
            "material='neo_hookean'\nlambda=1\nmu=0.8\n",
        .method = name,
        .place = fmt::format("[particles]\ntype='block'\ncells=[{0},{0},{0}]\nsize=[1,1,1]\ndensity=1\n", cells),
        .particles = ""};
  };
  return {twin(7, "verlet", compose(test::kinetic_potential(rubber), schemes::verlet)),
          twin(2, "simo_tarnow_wong", test::classical_over(rubber, method("simo_tarnow_wong")))};
}

void check_all_families(std::size_t stride) {
  for (const auto& twins : {group_twins(), action_twins(), frame_twins(), block_twins()}) {
    for (const Twin& twin : twins) check_ways(twin, stride);
  }
}

TEST_CASE("bits of bodies on groups, of actions and of blocks depend on nothing but the run", "[determinism][matrix]") {
  check_all_families(7);
}

TEST_CASE("bits of bodies on groups, of actions and of blocks depend on nothing but the run, whichever way it is made",
          "[determinism][matrix][nightly]") {
  check_all_families(1);
}

}  // namespace
}  // namespace noether
