/// Threads x cadence x program or scene x restart, for schemes, Hamiltonians and forces, at every SIMD level.

#include "engine/bodies.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/linear_drag.hpp"
#include "forces/oblateness.hpp"
#include "forces/on_sites.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/canonical_charges.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/k_symplectic.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/projected.hpp"
#include "integrators/rotating.hpp"
#include "integrators/shearing_sheet.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/determinism/twins.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/energy_projection.hpp"
#include "tests/support/liquid.hpp"
#include "tests/support/mesh_field.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/tops.hpp"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::check_ways, test::Twin;

const std::string soft_scene =
    "[hamiltonian]\ntype='kinetic_potential'\nG=1\n[[hamiltonian.force]]\ntype='gravity'\nsoftening=0.05\n";

template <class H>
Twin cloud_twin(int bodies, const H& hamiltonian, const std::string& scene, const std::string& method) {
  return {.name = fmt::format("{} of {} bodies", method, bodies),
          .bodies = test::cloud(bodies),
          .program = compose(hamiltonian, *schemes::find(method)),
          .step = 0.01,
          .hamiltonian = scene,
          .method = method};
}

std::vector<Twin> gravity_twins() {
  const auto gravity = test::kinetic_potential(Gravity{.G = 1, .softening = 0.05});
  std::vector<Twin> twins;
  for (const char* method : {"verlet", "verlet_aba", "blanes_moan_s6", "srkn11b", "yoshida_8"}) {
    twins.push_back(cloud_twin(530, gravity, soft_scene, method));
  }
  // Around the number of bodies from which on there are lanes.
  for (const int bodies : {7, 15, 16, 17}) twins.push_back(cloud_twin(bodies, gravity, soft_scene, "verlet"));
  return twins;
}

std::vector<Twin> force_twins() {
  const auto forces = test::kinetic_potential(
      Gravity{.G = 1, .softening = 0.05},
      Oblateness{.J2 = 0.01, .J4 = -1e-4, .radius = 0.5, .axis = {0.1, 0, 1}, .G = 1},
      UniformField{.acceleration = {1e-3, 2e-3, 0}}, OscillatingField{.acceleration = {0, 1e-3, 0}, .omega = 3});
  const std::string scene = soft_scene +
                            "[[hamiltonian.force]]\ntype='oblateness'\nJ2=0.01\nJ4=-1e-4\nradius=0.5\naxis=[0.1,0,1]\n"
                            "[[hamiltonian.force]]\ntype='uniform_field'\nacceleration=[1e-3,2e-3,0]\n"
                            "[[hamiltonian.force]]\ntype='oscillating_field'\nacceleration=[0,1e-3,0]\nomega=3\n";
  return {cloud_twin(200, forces, scene, "blanes_moan_s10"),
          cloud_twin(200, test::damped(forces, LinearDrag{.rate = 0.2}),
                     scene + "[[hamiltonian.force]]\ntype='linear_drag'\nrate=0.2\n", "verlet")};
}

/// Multiple time steps of three kicks, with gravity in the slowest one, and in a bath.
std::vector<Twin> nested_twins() {
  const auto in_kick = [](AnyForce<double> force, char letter) { return force.in_kick(letter); };
  const ForceField<double> forces = test::field_of(in_kick(Gravity{.G = 1, .softening = 0.05}, 'E'),
                                                   HarmonicField{.k = 3}, in_kick(HarmonicField{.k = 0.3}, 'C'));
  const std::string scene =
      "[hamiltonian]\ntype='kinetic_potential'\nG=1\n"
      "[[hamiltonian.force]]\ntype='gravity'\nsoftening=0.05\nkick='E'\n"
      "[[hamiltonian.force]]\ntype='harmonic_field'\nk=3\n"
      "[[hamiltonian.force]]\ntype='harmonic_field'\nk=0.3\nkick='C'\n";
  std::vector<Twin> twins;
  for (const bool compensated : {false, true}) {
    const CompositionOptions options{.compensated = compensated, .inner_steps = {3, 2}};
    twins.push_back({.name = "multiple time steps",
                     .bodies = test::cloud(300),
                     .program = compose(test::kinetic_potential_over(forces), schemes::respa, options),
                     .step = 0.02,
                     .hamiltonian = scene,
                     .method = "respa",
                     .options = options});
  }
  Twin warm = twins.front();
  warm.name += " in a bath";
  warm.program = compose(test::in_bath(forces, {.temperature = 0.1, .friction = 1, .seed = 4}), schemes::respa,
                         {.inner_steps = {3, 2}});
  warm.hamiltonian += "[hamiltonian.thermostat]\ntype='langevin'\ntemperature=0.1\nfriction=1\nseed=4\n";
  twins.push_back(std::move(warm));
  return twins;
}

std::vector<Twin> wisdom_holman_twins(Coordinates coordinates) {
  std::string in;
  for (const auto& [value, name] : EnumNames<Coordinates>::values) in = value == coordinates ? name : in;
  const auto hamiltonian = test::wisdom_holman({.G = test::outer_G, .coordinates = coordinates});
  const std::string scene =
      fmt::format("[hamiltonian]\ntype='wisdom_holman'\nG={}\ncoordinates='{}'\n", test::outer_G, in);
  std::vector<Twin> twins;
  for (const char* method : {"verlet_aba", "abah_8_6_4", in == "jacobi" ? "aba_10_6_4" : "abah_10_6_4"}) {
    twins.push_back({.name = fmt::format("{} in {}", method, in),
                     .bodies = test::planets_with_tracers(300),
                     .program = compose(hamiltonian, *schemes::find(method)),
                     .step = 20,
                     .hamiltonian = scene,
                     .method = method});
  }
  return twins;
}

std::vector<Twin> liquid_twins() {
  std::vector<Twin> twins;
  for (const PairPrecision precision : {PairPrecision::full, PairPrecision::mixed}) {
    const LennardJonesForce argon{.cutoff = 2.2, .epsilon = 1.0, .sigma = 1.0, .precision = precision};
    twins.push_back({.name = precision == PairPrecision::full ? "a liquid" : "a liquid in mixed precision",
                     .bodies = test::liquid(5, 0.85, 1, 0.1),
                     .program = compose(test::kinetic_potential(argon), schemes::blanes_moan_s6),
                     .step = 0.01,
                     .hamiltonian = fmt::format("[hamiltonian]\ntype='kinetic_potential'\n[[hamiltonian.force]]\n"
                                                "type='lennard_jones'\ncutoff=2.2\nepsilon=1\nsigma=1\n"
                                                "precision='{}'\n",
                                                precision == PairPrecision::full ? "double" : "mixed"),
                     .method = "blanes_moan_s6",
                     .place = "[particles]\nbox=[9,9,9]\n"});
  }
  return twins;
}

/// Words around the run, and kicks that look along themselves: planets alone, which are in lanes, and with tracers.
std::vector<Twin> corrected_twins() {
  using enum StepKernel;
  std::vector<Twin> twins;
  for (const int tracers : {0, 50}) {
    const CompositionOptions all[] = {{.corrector = 17, .kernel = lazy},
                                      {.corrector = 7, .kernel = modified, .second_corrector = true},
                                      {.compensated = true, .corrector = 11, .kernel = composed},
                                      {.corrector = 5}};
    for (const CompositionOptions& options : all) {
      Twin twin = wisdom_holman_twins(Coordinates::jacobi).front();
      twin.name = fmt::format("{}, {} tracers", options.processing_text(), tracers);
      twin.bodies = test::planets_with_tracers(tracers);
      twin.program = compose(test::wisdom_holman({.G = test::outer_G}), schemes::verlet_aba, options);
      twin.options = options;
      twins.push_back(std::move(twin));
    }
  }
  return twins;
}

/// A decorator with state, around splittings in inertial and in other coordinates: two of five steps are projected.
std::vector<Twin> decorated_twins() {
  const std::string scene = "[[integrator.decorator]]\ntype='energy_projection'\nsteps=2\n";
  std::vector<Twin> twins = {gravity_twins().front(), wisdom_holman_twins(Coordinates::jacobi).front()};
  for (Twin& twin : twins) {
    twin.name += ", decorated";
    twin.program = around(test::EnergyProjection{.steps = 2}, twin.program);
    twin.decorators = scene;
  }
  return twins;
}

/// Projections onto invariants, around a splitting and methods for y' = f: every step is moved.
std::vector<Twin> projected_twins() {
  const std::string onto = "[integrator.projection]\nonto=['energy','angular_momentum']\n";
  std::vector<Twin> twins;
  for (const Twin& twin : {gravity_twins().back(), wisdom_holman_twins(Coordinates::jacobi).front()}) {
    for (const Projection how : {Projection::orthogonal, Projection::symmetric}) {
      Twin one = twin;
      one.name += ", projected, " + choice_name(how);
      one.program = projected(one.program, {.onto = {Invariant::energy, Invariant::angular_momentum}, .how = how});
      one.decorators = onto + "how='" + choice_name(how) + "'\n";
      twins.push_back(std::move(one));
    }
  }
  for (const char* name : {"rk4", "adams_bashforth_4", "stormer_cowell_12", "bdf_3", "implicit_midpoint"}) {
    const auto bare = test::classical_over(Gravity{.G = 1, .softening = 0.05}, method(name));
    twins.push_back({.name = fmt::format("{}, projected", name),
                     .bodies = test::cloud(7),
                     .program = projected(bare, {.onto = {Invariant::energy, Invariant::angular_momentum}}),
                     .step = 0.01,
                     .hamiltonian = soft_scene,
                     .method = name,
                     .decorators = onto});
  }
  return twins;
}

/// A Hamiltonian from outside with an orientation and a spin, under a force from outside with a mesh and a torque.
std::vector<Twin> turning_twins() {
  ParticleSystem<double> bodies = test::cloud(300);
  bodies.add_column<test::Orientation>();
  auto& spin = bodies.add_column<test::Spin>();
  for (Index i = 0; i < bodies.size(); ++i) spin.set(i, {0.1 * static_cast<double>(i % 7), 0.3, -0.2});
  const ForceField<double> field =
      ForceField<double>().add(Gravity{.G = 1, .softening = 0.05}).add(test::MeshField{.strength = 0.5, .period = 1});
  return {{.name = "tops in a field on a mesh",
           .bodies = bodies,
           .program = compose(AnyHamiltonian<double>(test::SpinningTops(0.7, field)), schemes::yoshida_4),
           .step = 0.01,
           .hamiltonian = "[hamiltonian]\ntype='tops'\ninertia=0.7\nG=1\n[[hamiltonian.force]]\ntype='gravity'\n"
                          "softening=0.05\n[[hamiltonian.force]]\ntype='mesh_field'\nstrength=0.5\nperiod=1\n",
           .method = "yoshida_4"}};
}

/// A cloud in a shearing sheet, with and without compensation, and in a box.
std::vector<Twin> sheet_twins() {
  const ShearingSheetOptions frame{.Omega = 0.7, .Omega_z = 1.1};
  std::vector<Twin> twins;
  for (const bool compensated : {false, true}) {
    const CompositionOptions options{.compensated = compensated};
    twins.push_back(
        {.name = compensated ? "a shearing sheet, compensated" : "a shearing sheet",
         .bodies = test::cloud(300),
         .program = compose(ShearingSheet(Gravity{.G = 1, .softening = 0.05}, frame), schemes::aba_8_6_4, options),
         .step = 0.01,
         .hamiltonian = "[hamiltonian]\ntype='shearing_sheet'\nOmega=0.7\nOmega_z=1.1\n"
                        "[[hamiltonian.force]]\ntype='gravity'\nG=1\nsoftening=0.05\n",
         .method = "aba_8_6_4",
         .options = options});
  }
  ParticleSystem<double> boxed = test::cloud(300);
  boxed.set_box(Box::periodic({1.5, 2, 8}));
  twins.push_back({.name = "a shearing sheet in a box",
                   .bodies = boxed,
                   .program = compose(ShearingSheet(Gravity{.G = 1, .softening = 0.05}, frame), schemes::yoshida_4),
                   .step = 0.05,
                   .hamiltonian = "[hamiltonian]\ntype='shearing_sheet'\nOmega=0.7\nOmega_z=1.1\n"
                                  "[[hamiltonian.force]]\ntype='gravity'\nG=1\nsoftening=0.05\n",
                   .method = "yoshida_4",
                   .place = "[particles]\nbox=[1.5,2,8]\n"});
  return twins;
}

/// A liquid of bent bodies of three sites with atoms between them, by both rotors.
std::vector<Twin> rigid_twins() {
  const ParticleSystem<double> atoms = test::liquid(5, 0.3, 1, 0.1);
  const RigidBody bent = body_of_sites("bent", {{.place = {0, 0, 0}, .mass = 1},
                                                {.place = {0.3, 0.1, 0}, .mass = 0.5},
                                                {.place = {-0.2, 0.3, 0}, .mass = 0.25}});
  ParticleSystem<double> s(atoms.units());
  Bodies bodies;
  for (Index i = 0; i < atoms.size(); ++i) {
    const Vec3<double> x = atoms.positions()[i], v = atoms.velocities()[i];
    if (i % 11 == 5) {
      s.add("", 1, x, v);
      continue;
    }
    add_body(s, bodies, bent,
             {.x = x, .v = v, .orientation = {1, v[1], v[2], v[0]}, .spin = Vec3<double>(0.1 * v[2], 0.2 * v[0], 0.1)});
  }
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  s.set_box(atoms.box());
  std::vector<Twin> twins;
  for (const Rotor rotor : {Rotor::exact, Rotor::axes}) {
    ForceField<double> pairs, on_bodies;
    pairs.add(LennardJonesForce{.cutoff = 2.2, .epsilon = 1.0, .sigma = 0.8});
    on_bodies.add(OnSites<double>(pairs));
    const std::string name = rotor == Rotor::exact ? "exact" : "axes";
    twins.push_back({.name = "a liquid of bodies, rotor " + name,
                     .bodies = s,
                     .program = compose(Rotating<AnyHamiltonian<double>>(
                                            AnyHamiltonian<double>(KineticPotential(on_bodies)), {.rotor = rotor}),
                                        schemes::yoshida_4),
                     .step = 0.01,
                     .hamiltonian = "[hamiltonian]\ntype='kinetic_potential'\nrotor='" + name +
                                    "'\n[[hamiltonian.force]]\ntype='lennard_jones'\ncutoff=2.2\nepsilon=1\n"
                                    "sigma=0.8\n",
                     .method = "yoshida_4",
                     .place = "[particles]\nbox=[9,9,9]\n[[particles.rigid_body]]\nname='replaced too'\nmass=1\n"
                              "inertia=[1,1,1]\nx=[4,0,0]\nv=[0,0,0]\n"});
  }
  return twins;
}

/// Methods on states of two words, with tracers and a force beside gravity.
std::vector<Twin> two_word_twins() {
  const Gravity gravity{.G = test::outer_G};
  const OscillatingField wind{.acceleration = {1e-9, 0, 2e-9}, .omega = 0.003};
  const std::string scene = fmt::format(
      "[hamiltonian]\ntype='kinetic_potential'\nG={}\n[[hamiltonian.force]]\ntype='gravity'\n"
      "[[hamiltonian.force]]\ntype='oscillating_field'\nacceleration=[1e-9,0,2e-9]\nomega=0.003\n",
      test::outer_G);
  std::vector<Twin> twins;
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    twins.push_back({.name = name,
                     .bodies = test::planets_with_tracers(7),
                     .program = test::classical_over(test::field_of(gravity, wind), method(name)),
                     .step = 60,
                     .hamiltonian = scene,
                     .method = name});
  }
  return twins;
}

/// Charges in fields: kicks of every kind, with threads, and with the low words that fast ones have.
std::vector<Twin> charged_twins() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add_column<Charge>();
  for (Index i = 0; i < 300; ++i) {
    const double k = static_cast<double>(i);
    s.add(fmt::format("charge {}", i), 1 + 0.1 * static_cast<double>(i % 7),
          {1.05 + 0.001 * k, 0.1 * std::sin(k), 0.05 * std::cos(k)},
          {0.01 * std::cos(k), 0.02, 0.01 * std::sin(3 * k)});
    s.column<Charge>()[i] = i % 3 == 0 ? -1 : 1;
  }
  std::vector<Twin> twins;
  ForceField<double> both;
  both.add(InField(Tokamak{.B0 = 1, .R0 = 1, .safety = 2}));
  both.add(InField(UniformElectromagnetic{.E = {0.01, 0, 0.02}, .B = {0, 0, 0.1}}));
  const auto add_twin = [&](const std::string& name, AnyIntegrator<double> program, const std::string& keys,
                            std::string_view method) {
    twins.push_back(
        {.name = "charges, " + name,
         .bodies = s,
         .program = std::move(program),
         .step = 0.1,
         .hamiltonian = "[hamiltonian]\ntype='charged_particles'\n" + keys +
                        "[[hamiltonian.field]]\ntype='tokamak'\nB0=1\nR0=1\nsafety=2\n"
                        "[[hamiltonian.field]]\ntype='uniform_electromagnetic'\nE=[0.01,0,0.02]\nB=[0,0,0.1]\n",
         .method = std::string(method),
         .place = "[[particles.body]]\nname='replaced too'\nmass=1\ncharge=1\nx=[1,0,0]\nv=[0,0,0]\n"});
  };
  const auto add = [&](const std::string& name, const ChargedParticlesOptions& options, const std::string& keys,
                       const Scheme& scheme) {
    add_twin(name, compose(ChargedParticles<ForceField<double>>(both, options), scheme), keys, scheme.name);
  };
  ForceField<double> forces;
  forces.add(InField(Tokamak{.B0 = 1, .R0 = 1, .safety = 2}));
  twins.push_back({.name = "charges, one direction after the other",
                   .bodies = s,
                   .program = compose(KSymplectic<ForceField<double>>(forces), schemes::yoshida_4),
                   .step = 0.1,
                   .hamiltonian = "[hamiltonian]\ntype='k_symplectic'\n"
                                  "[[hamiltonian.field]]\ntype='tokamak'\nB0=1\nR0=1\nsafety=2\n",
                   .method = "yoshida_4",
                   .place = "[[particles.body]]\nname='replaced too'\nmass=1\ncharge=1\nx=[1,0,0]\nv=[0,0,0]\n"});
  add("the exact helix", {}, "", schemes::blanes_moan_s6);
  add("Boris", {.rotation = Rotation::boris}, "rotation='boris'\n", schemes::yoshida_4);
  add("cycles", {.rotation = Rotation::hyper_boris, .cycles = 3, .gyrophase_order = 4},
      "rotation='hyper_boris'\ncycles=3\ngyrophase_order=4\n", schemes::verlet_aba);
  add("fast ones", {.relativistic = Relativistic::higuera_cary, .c = 0.1}, "relativistic='higuera_cary'\nc=0.1\n",
      schemes::yoshida_4);
  add_twin("by momenta", canonical_charges(both, method("gauss_2")), "canonical=true\n", "gauss_2");
  add_twin("by momenta in two copies", canonical_charges(both, method("tao_2")), "", "tao_2");
  return twins;
}

/// Methods exact in energy, which serve neither tracers, all of them, nor forces that depend on time.
std::vector<Twin> exact_energy_twins() {
  std::vector<Twin> twins;
  for (const char* name : {"simo_tarnow_wong", "gonzalez", "itoh_abe_symmetric", "avf_4", "hbvm_4_2"}) {
    twins.push_back(
        {.name = name,
         .bodies = test::outer_planets(),
         .program = test::classical_over(test::field_of(Gravity{.G = test::outer_G}), method(name)),
         .step = 60,
         .hamiltonian = fmt::format(
             "[hamiltonian]\ntype='kinetic_potential'\nG={}\n[[hamiltonian.force]]\ntype='gravity'\n", test::outer_G),
         .method = name});
  }
  return twins;
}

void check_all_twins(std::size_t stride) {
  for (const auto& twins :
       {gravity_twins(), force_twins(), nested_twins(), liquid_twins(), decorated_twins(), projected_twins(),
        turning_twins(), sheet_twins(), rigid_twins(), two_word_twins(), charged_twins(), exact_energy_twins(),
        corrected_twins(), wisdom_holman_twins(Coordinates::jacobi), wisdom_holman_twins(Coordinates::democratic),
        wisdom_holman_twins(Coordinates::whds), wisdom_holman_twins(Coordinates::barycentric)}) {
    for (const Twin& twin : twins) check_ways(twin, stride);
  }
}

// 7 leads through all threads, and with each through other cadences, assemblies and restarts.
TEST_CASE("bits depend on nothing but the run", "[determinism][matrix]") { check_all_twins(7); }

TEST_CASE("bits depend on nothing but the run, whichever way it is made", "[determinism][matrix][nightly]") {
  check_all_twins(1);
}

}  // namespace
}  // namespace noether
