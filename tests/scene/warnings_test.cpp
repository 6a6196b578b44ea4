// What a scene is warned of before it runs: bonds that no step follows, cutoffs that a file means otherwise.

#include "scene/warnings.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// Two atoms of mass 1 and a bond of stiffness 2 `k`, in LAMMPS's convention k (r - r_0)^2.
std::string diatomic(const std::string& bond, const std::string& pair) {
  return fmt::format(
      "two\n\n2 atoms\n1 atom types\n1 bonds\n1 bond types\n0 20 xlo xhi\n0 20 ylo yhi\n0 20 zlo zhi\n\nMasses\n\n1 "
      "1\n\n"
      "Pair Coeffs # lj/cut\n\n1 {}\n\nBond Coeffs # {}\n\nAtoms # bond\n\n1 1 1 5 5 5\n2 1 1 6.1 5 5\n\nBonds\n\n1 1 "
      "1 2\n",
      pair, bond);
}

/// Warnings of the pair by a method with step 0.01, so that h omega = 0.01 sqrt(2 U'').
std::vector<std::string> warnings(const std::string& bond, const std::string& integrator, const std::string& more = "",
                                  const std::string& pair = "1 1") {
  const ScratchFolder folder;
  write_text(folder / "two.data", diatomic(bond, pair));
  return warnings_of(read_scene(
      "units = 'reduced'\n[particles]\nstructure = 'two.data'\n[hamiltonian]\ntype = 'kinetic_potential'\n"
      "[[hamiltonian.force]]\ntype = 'bonded'\n[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = 2.5\n" +
          more + "[integrator]\nsteps = 10\n" + integrator,
      folder / "scene.toml"));
}

/// k in LAMMPS's convention with which step 0.01 has a given h omega.
std::string harmonic(double z) { return fmt::format("harmonic\n\n1 {:.17g} 1.1", z * z / 0.01 / 0.01 / 4); }

const std::string verlet = "method = 'verlet'\nstep = 0.01\n";

TEST_CASE("bodies whose moments of inertia differ are warned of where attraction does not turn them",
          "[scene][warnings]") {
  const auto of = [](const std::string& body, const std::string& hamiltonian) {
    return warnings_of(
        read_scene("units = 'reduced'\n[[particles.rigid_body]]\nname = 'planet'\nmass = 1\n" + body +
                       "\n[[particles.body]]\nname = 'moon'\nmass = 0.01\na = 3\n[hamiltonian]\ntype = " + hamiltonian +
                       "\n[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 10\n",
                   "scene.toml"));
  };
  const std::string flat = "inertia = [0.3, 0.3, 0.4]", sphere = "inertia = [0.4, 0.4, 0.4]";
  const std::string plain = "'kinetic_potential'\n", force = "[[hamiltonian.force]]\ntype = ";
  const std::string told =
      " attracts 'planet' at its centre and does not turn it, though its moments of inertia differ; ";
  CHECK(of(flat, plain + force + "'gravity'") == std::vector<std::string>{"gravity" + told + "use gravity_of_bodies"});
  CHECK(of(flat, "'wisdom_holman'") ==
        std::vector<std::string>{"wisdom_holman" + told + "add gravity_of_bodies with point_masses = false"});
  const std::string figure = force + "'oblateness'\nradius = 1\nframe = 'body'\n";
  CHECK(of(flat, "'wisdom_holman'\n" + figure + "J4 = -0.01").size() == 1);
  for (const std::string& turns :
       {plain + force + "'gravity_of_bodies'",
        "'wisdom_holman'\n" + force + "'gravity_of_bodies'\npoint_masses = false",
        plain + force + "'gravity'\n" + figure + "J2 = 0.1", "'wisdom_holman'\n" + figure + "J2 = 0.1",
        plain + force + "'gravity_of_bodies'\n" + figure + "J4 = -0.01"}) {
    CAPTURE(turns);
    CHECK(of(flat, turns).empty());
  }
  CHECK(of(sphere, "'wisdom_holman'").empty());
  CHECK(of(sphere, plain + force + "'gravity'").empty());
  // Of a body that its moments do not turn, J2 is no second figure.
  CHECK(of(sphere, plain + force + "'gravity_of_bodies'\n" + figure + "J2 = 0.1").empty());
  CHECK(of(flat, plain).empty());  // it turns freely
}

TEST_CASE("Kepler arcs about a body that is not the heaviest are warned of", "[scene][warnings]") {
  const auto with = [](const std::string& more, const std::string& first) {
    const std::string body = "[[particles.body]]\n";
    const std::string sun = body + "name = 'Sun'\nmass = 1\nx = [0, 0, 0]\nv = [0, 0, 0]\n";
    const std::string earth = body + "name = 'Earth'\nmass = 3e-6\nx = [1, 0, 0]\nv = [0, 1, 0]\n";
    return warnings_of(
        read_scene("units = 'reduced'\n" + (first == "Sun" ? sun + earth : earth + sun) + more, "scene.toml"));
  };
  const auto of = [&](const std::string& hamiltonian, const std::string& first, const std::string& second) {
    return with("[hamiltonian]\ntype = '" + hamiltonian +
                    "'\n[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 10\n" + second,
                first);
  };
  CHECK(of("wisdom_holman", "Sun", "").empty());
  CHECK(of("wisdom_holman", "Earth", "") ==
        std::vector<std::string>{"'Earth' comes first, so the Kepler arcs of wisdom_holman go round it, but 'Sun' has "
                                 "3.33e+05 times its mass; put 'Sun' first"});
  for (const std::string name : {"gr_potential", "post_newtonian"}) {
    const std::string classical =
        "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n"
        "[[hamiltonian.force]]\ntype = '" +
        name +
        "'\nc = 1e4\n[integrator]\nmethod = "
        "'gauss_radau_15'\nuntil = 1\n";
    CHECK(with(classical, "Sun").empty());
    CHECK(with(classical, "Earth") ==
          std::vector<std::string>{"'Earth' comes first, so " + name +
                                   " is about it, but 'Sun' has 3.33e+05 times its mass; put 'Sun' first"});
  }
}

TEST_CASE("elements about a first body that is not the heaviest above are warned of", "[scene][warnings]") {
  const std::string earth = "[[particles.body]]\nname = 'Earth'\nmass = 3e-6\n";
  const std::string sun = "[[particles.body]]\nname = 'Sun'\nmass = 1\nx = [1, 0, 0]\nv = [0, 1, 0]\n";
  const std::string moon = "[[particles.body]]\nname = 'Moon'\nmass = 4e-8\na = 0.0026\n";
  const auto of = [](const std::string& particles) {
    return warnings_of(read_scene("units = 'reduced'\n[particles]\n" + particles +
                                      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
                                      "'gravity'\n[integrator]\nmethod = 'gauss_8'\nuntil = 1\n",
                                  "scene.toml"));
  };
  const auto told = [](const std::string& body) {
    return std::vector<std::string>{"the elements of '" + body +
                                    "' are about 'Earth', which comes first, but 'Sun' has 3.33e+05 times its mass; "
                                    "put 'Sun' first, or say what they are about: about = \"Sun\" or \"Earth\""};
  };
  const std::string jupiter = "[[particles.body]]\nname = 'Jupiter'\nmass = 1e-3\na = 5.2\n";
  CHECK(of(earth + sun + jupiter) == told("Jupiter"));
  CHECK(of(earth + sun + jupiter + "about = 'Sun'\n").empty());
  CHECK(of(earth + sun + moon + "about = 'Earth'\n").empty());
  CHECK(of(earth + moon + sun).empty());
  CHECK(of("elements = 'jacobi'\n" + earth + sun + jupiter).empty());
  CHECK(of(sun + earth + "a = 1\n" + jupiter).empty());
  const ScratchFolder folder;
  const auto of_table = [&](const std::string& table) {
    write_text(folder / "b.csv", table);
    return of("bodies = '" + (folder / "b.csv").string() + "'\n");
  };
  CHECK(of_table("name,mass,a,e,inc,Omega,omega,M\nEarth,3e-6,,,,,,\nSun,1,1,0,0,0,0,0\nJupiter,1e-3,5.2,0,0,0,0,0\n"
                 "Saturn,3e-4,9.5,0,0,0,0,0\n") == told("Jupiter"));
  CHECK(of_table("name,mass,a,e,inc,Omega,omega,M,about\nEarth,3e-6,,,,,,,\nSun,1,1,0,0,0,0,0,\n"
                 "Jupiter,1e-3,5.2,0,0,0,0,0,Sun\n")
            .empty());
  // Bodies of the scene behind those of a file.
  write_text(folder / "b.csv", "name,mass,x,y,z,vx,vy,vz\nEarth,3e-6,0,0,0,0,0,0\nSun,1,1,0,0,0,1,0\n");
  CHECK(of("bodies = '" + (folder / "b.csv").string() + "'\n" + jupiter) == told("Jupiter"));
}

TEST_CASE("a pair force may stand in a scene for each pair of types, and once for each", "[scene][messages]") {
  const ScratchFolder folder;
  write_text(folder / "two.data",
             "two\n\n2 atoms\n2 atom types\n0 20 xlo xhi\n0 20 ylo yhi\n0 20 zlo zhi\n\nMasses\n\n1 1\n2 1\n\nAtoms # "
             "atomic\n\n1 1 5 5 5\n2 2 6.1 5 5\n");
  const auto refused = [&](const std::string& first, const std::string& second) {
    const auto wca = [](const std::string& types) {
      return "[[hamiltonian.force]]\ntype = 'wca'\nepsilon = 1\nsigma = 1\n" + types;
    };
    try {
      read_scene("units = 'reduced'\n[particles]\nstructure = 'two.data'\n[hamiltonian]\ntype = 'kinetic_potential'\n" +
                     wca(first) + wca(second) + "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1\n",
                 folder / "scene.toml");
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  CHECK(refused("first = '1'\nsecond = '1'\n", "first = '1'\nsecond = '2'\n").empty());
  CHECK(refused("first = '2'\nsecond = '1'\n", "first = '1'\nsecond = '2'\n") ==
        "wca appears twice in the scene, so pairs of '1' and '2' would count twice; take one of them out");
  CHECK(refused("first = '2'\nsecond = '2'\n", "") ==
        "wca appears twice in the scene, so pairs of '2' and '2' would count twice; take one of them out");
  CHECK(refused("", "") == "wca appears twice in the scene, so every pair would count twice; take one of them out");
}

TEST_CASE("particles without mass that no force can move are warned of", "[scene][warnings]") {
  const auto of = [](double mass, const std::string& force) {
    const auto body = [](const std::string& name, double m, int x) {
      return fmt::format("[[particles.body]]\nname = '{}'\nmass = {}\nx = [{}, 0, 0]\nv = [0, 0, 0]\n", name, m, x);
    };
    return warnings_of(read_scene("units = 'reduced'\n[particles]\nbox = [9, 9, 9]\n" + body("A", 1, 0) +
                                      body("ghost", mass, 1) + body("B", mass, 2) +
                                      "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\n" + force +
                                      "[integrator]\nmethod = 'verlet'\nstep = 0.001\nsteps = 1\n",
                                  "scene.toml"));
  };
  const std::string argon = "type = 'lennard_jones'\ncutoff = 2.5\nepsilon = 1\nsigma = 1\n";
  CHECK(of(1, argon).empty());
  CHECK(of(0, argon) ==
        std::vector<std::string>{"2 particles of mass 0, such as 'ghost', are not moved by any force of this scene, "
                                 "because forces between molecules act on masses only; give masses"});
  CHECK(of(0, "type = 'uniform_field'\nacceleration = [0, 0, -1]\n").empty());
}

TEST_CASE("a bond that the step cannot follow is warned of, from the limit of the method on", "[scene][warnings]") {
  CHECK(warnings(harmonic(1.99), verlet).empty());
  const auto told = warnings(harmonic(2.01), verlet);
  REQUIRE(told.size() == 1);
  CHECK(told[0] ==
        "the bond of 'atom_1' and 'atom_2' oscillates with h omega = 2.01, which 'verlet' cannot keep bounded; take a "
        "step below 0.01, or constraints");
  struct Case {
    std::string method;
    double limit;
  };
  // Words have no table: the limit of BAB is 2, that of ABABA, with drifts of a third, the square root of 6.
  for (const Case& one : {Case{"yoshida_4", 1.573}, Case{"mclachlan_s4", 3.03}, Case{"rk4", 2.8284}, Case{"BAB", 2},
                          Case{"ABABA", 2.4495}, Case{"heun", 0}}) {
    const std::string integrator = "method = '" + one.method + "'\nstep = 0.01\n";
    CAPTURE(one.method);
    CHECK(warnings(harmonic(one.limit + 0.02), integrator).size() == 1);
    if (one.limit > 0) CHECK(warnings(harmonic(one.limit - 0.02), integrator).empty());
  }
  // Nothing is said where nothing is unstable, and where the method chooses its steps.
  CHECK(warnings(harmonic(50), "method = 'backward_euler'\nstep = 0.01\n").empty());
  CHECK(warnings(harmonic(50), "method = 'dop853'\n").empty());
}

TEST_CASE("breaking bonds are as stiff as at rest, baths take nothing away, constraints do", "[scene][warnings]") {
  // depth a^2 = 1e4 is U'' = 2e4: h omega = 2.
  const auto morse = [](double depth) { return fmt::format("morse\n\n1 {:.17g} 4 1.1", depth / 16); };
  CHECK(warnings(morse(0.98e4), verlet).empty());
  CHECK(warnings(morse(1.02e4), verlet).size() == 1);
  const std::string bath = "[hamiltonian.thermostat]\ntype = 'langevin'\ntemperature = 1\nfriction = 1\n";
  CHECK(warnings(harmonic(2.01), "method = 'BAOAB'\nstep = 0.01\n", bath).size() == 1);
  CHECK(warnings(harmonic(1.99), "method = 'BAOAB'\nstep = 0.01\n", bath).empty());
  const std::string rods = "[[hamiltonian.constraint]]\ntype = 'distance'\npairs = 'bonds'\n";
  CHECK(warnings(harmonic(5), verlet, rods).empty());
}

TEST_CASE("a cutoff in the structure that is not that of the force is warned of", "[scene][warnings]") {
  CHECK(warnings(harmonic(0.1), verlet, "", "1 1 2.5").empty());
  const auto told = warnings(harmonic(0.1), verlet, "", "1 1 3");
  REQUIRE(told.size() == 1);
  CHECK(told[0] ==
        "the structure's pairs have a cutoff of 3, but the force lennard_jones has one of 2.5, which is used");
}

}  // namespace
}  // namespace noether::test
