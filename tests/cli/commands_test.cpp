// Every command but `run`: what it prints and writes of a small scene and its files.

#include "tests/cli/support.hpp"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

std::string json_output(const ScratchFolder& folder, const std::string& line, const std::string& schema) {
  const std::string json = output(folder, line + " --json");
  INFO(json);
  CHECK(is_json_line(json));
  CHECK(json_member(json, "schema") == "\"noether." + schema + "/1\"");
  return json;
}

TEST_CASE("--version and --help succeed, for the program and each command", "[cli]") {
  const ScratchFolder folder;
  CHECK(output(folder, "--version").starts_with("noether "));
  const std::string help = output(folder, "--help");
  for (const char* name :
       {"run", "evaluate", "explain", "list", "describe", "info", "verify", "convert", "frequencies", "plot", "view"}) {
    CHECK(has(help, std::string("\n  ") + name + " "));
    CHECK(has(output(folder, std::string(name) + " --help"), std::string("Usage: noether ") + name + " "));
  }
}

TEST_CASE("evaluate tells energies, virial and forces of the initial state", "[cli][evaluate]") {
  const SceneFolder folder;
  const std::string json = json_output(folder, "evaluate scene.toml --check --forces forces.csv", "evaluate");
  CHECK(json_member(json, "energy") ==
        R"({"total":-5e-04,"kinetic":5e-04,"potential":-0.001,"terms":{"gravity":-0.001}})");
  CHECK(json_member(json, "virial") == "[[-0.001,0,0],[0,0,0],[0,0,0]]");
  CHECK(json_member(json, "pressure") == "null");
  CHECK(json_member(json, "force_max") == "0.001");
  CHECK(std::stod(json_member(json, "gradient_error")) < 1e-20);
  CHECK(lines_of(read_text(folder / "forces.csv")) ==
        std::vector<std::string>{"id,fx,fy,fz", "0,0.001,0,0", "1,-0.001,0,0"});
  CHECK(json_member(json_output(folder, "evaluate scene.toml", "evaluate"), "gradient_error") == "null");
  CHECK(output(folder, "evaluate scene.toml") ==
        "total energy          -5e-04\n"
        "  kinetic             5e-04\n"
        "  potential           -0.001\n"
        "    gravity           -0.001\n"
        "trace of the virial   -0.001\n"
        "largest force         0.001\n");
  const std::string heavier = output(folder, "evaluate scene.toml --json --set particles.body.Sun.mass=2");
  CHECK(json_member(heavier, "potential") == "-0.002");
}

/// Three atoms in a box of 3, the first two 0.65 apart.
const std::string close_pair = R"(units = "reduced"
[particles]
box = [3, 3, 3]
body = [{ name = "a", mass = 1, x = [1, 1, 1], v = [0, 0, 0] },
        { name = "b", mass = 1, x = [1.65, 1, 1], v = [0, 0, 0] },
        { name = "c", mass = 1, x = [2, 2.4, 2], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 2.5
epsilon = 1
sigma = 1
[integrator]
method = "verlet"
step = 0.005
steps = 200
)";

/// A chain of three in LAMMPS's words; the second bond is longer than any fene bond.
const std::string broken_chain = R"(a chain

3 atoms
2 bonds
1 atom types
1 bond types

0 9 xlo xhi
0 9 ylo yhi
0 9 zlo zhi

Masses

1 1

Bond Coeffs # fene

1 30 1.5 1 1

Atoms # bond

1 1 1 1 1 1
2 1 1 2 1 1
3 1 1 3.6 1 1

Bonds

1 1 1 2
2 1 2 3
)";

const std::string chain_scene = R"(units = "reduced"
[particles]
structure = "chain.data"
file_units = "lj"
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "bonded"
[integrator]
method = "verlet"
step = 0.005
steps = 200
)";

TEST_CASE("a force that cannot be computed is named by run and evaluate, with exit code 1", "[cli][evaluate]") {
  const SceneFolder pair(close_pair), chain(chain_scene);
  write_text(chain / "chain.data", broken_chain);
  const std::string close = "particles 'a' and 'b' are ", broken = "the bond of 'atom_2' and 'atom_3' is 1.6 long";
  const auto check = [](const ScratchFolder& folder, const std::string& line, const std::string& name,
                        const std::string& message) {
    const ProcessResult text = noether(folder, line);
    std::filesystem::remove_all(folder / "scene.out");
    const ProcessResult json = noether(folder, line + " --json");
    std::filesystem::remove_all(folder / "scene.out");
    INFO(line << "\n" << text.out << text.err << json.out);
    for (const ProcessResult& result : {text, json}) {
      CHECK(result.exit_code == 1);
      CHECK(result.err.starts_with(name + " at step 0: " + message));
      CHECK(line_count(result.err) == 1);
    }
    CHECK(is_json_line(json.out));
    CHECK(json_member(json.out, "outcome") == "\"" + name + "\"");
    return json.out;
  };
  for (const char* x : {"[1,1,1]", "[1.3,1,1]"}) {
    for (const char* more : {"", " --check", " --threads 2"}) {
      const std::string set = std::string(" --set particles.body.b.x=") + x;
      const std::string json = check(pair, "evaluate scene.toml" + set + more, "overlap", close);
      for (const char* key : {"potential", "total", "pressure", "force_max", "gradient_error"}) {
        CHECK(json_member(json, key) == "null");
      }
    }
  }
  check(pair, "run scene.toml --fresh", "overlap", close + "0.65 apart");
  CHECK(noether(pair, "run scene.toml --fresh --set integrator.step=0.0001").exit_code == 0);
  CHECK(std::stod(json_member(output(pair, "evaluate scene.toml --json"), "potential")) > 650);  // as it is
  check(chain, "evaluate scene.toml --check", "overstretch", broken);
  check(chain, "run scene.toml --fresh", "overstretch", broken);
  check(chain, "run scene.toml --fresh --threads 2 --set integrator.method=yoshida_4", "overstretch", broken);
}

TEST_CASE("evaluate tells LAMMPS's pressure, and none where there is none", "[cli][evaluate][oracle]") {
  const SceneFolder folder(chain_scene);
  const std::string melt = std::string(NOETHER_SOURCE_DIR) + "/tests/data/lammps/melt.data";
  const std::string liquid = " --set particles.structure=" + melt +
                             " --set 'hamiltonian.force=[{type=\"lennard_jones\", cutoff=2.5, "
                             "cutoff_style=\"plain\"}]'";
  const std::string json = json_output(folder, "evaluate scene.toml" + liquid, "evaluate");
  CHECK(std::abs(std::stod(json_member(json, "pressure")) + 5.0210762700856) < 1e-10);
  CHECK(has(output(folder, "evaluate scene.toml" + liquid), "\npressure              -5.02107627008"));
  const SceneFolder open;
  CHECK_FALSE(has(output(open, "evaluate scene.toml"), "pressure"));
}

TEST_CASE("explain tells the forces of each kick of multiple time steps and their evaluations, and a run their cost",
          "[cli][explain][respa]") {
  const SceneFolder folder;
  const std::string scene = std::string(NOETHER_SOURCE_DIR) + "/tests/scenes/good/multiple_time_steps.toml";
  const std::string text = output(folder, "explain " + scene);
  INFO(text);
  CHECK(has(text, "\n  4 x A: drifts\n"));
  CHECK(has(text, "\n  6 x B: kicks by bonded, 4 force evaluations\n"));
  CHECK(has(text, "\n  3 x C: kicks by lennard_jones, particle_mesh_ewald (near part), 2 force evaluations\n"));
  CHECK(has(text, "\n  1 x D: kicks by particle_mesh_ewald (waves), 1 force evaluation\n"));
  const std::string report = output(folder, "run " + scene + " --json --cost --out told");
  for (const char* name : {"bonded", "lennard_jones", "particle_mesh_ewald", "particle_mesh_ewald waves"})
    CHECK(has(report, "\"kind\":\"force\",\"name\":\"" + std::string(name) + "\""));
}

TEST_CASE("explain counts the evaluations of kernels, and kicks of forces that have their letters", "[cli][explain]") {
  const SceneFolder folder;
  for (const std::string letter : {"L", "G"}) {
    const std::string text =
        output(folder, "explain scene.toml --set integrator.method=" + letter + "BAB" + letter +
                           " --set 'hamiltonian.force=[{type=\"gravity\"}, {type=\"harmonic_field\", k=0.1, kick=\"" +
                           letter + "\"}]'");
    INFO(text);
    CHECK(has(text, "\n  1 x " + letter + ": kicks by harmonic_field, 1 force evaluation\n"));
  }
  const auto kernel = [&](const std::string& of, const std::string& coordinates) {
    return output(folder,
                  "explain scene.toml --set hamiltonian.force= --set hamiltonian.type=wisdom_holman --set "
                  "hamiltonian.coordinates=" +
                      coordinates +
                      " --set integrator.method=verlet_aba --set integrator.corrector=17 --set "
                      "integrator.kernel=" +
                      of);
  };
  const std::string plain = kernel("plain", "jacobi"), modified = kernel("modified", "jacobi"),
                    lazy = kernel("lazy", "jacobi");
  INFO(plain << modified << lazy);
  for (const std::string& text : {plain, modified})
    CHECK(has(text, "\n  1 x B: kicks by the interaction, one force evaluation each\n"));
  CHECK((has(modified, ", for kernels, 1 force evaluation\n") ||
         has(modified, ", for kernels, 2 force evaluations\n")));  // of its own, where kicks are in lanes
  CHECK(has(lazy, ", for kernels, 2 force evaluations\n"));
  CHECK(has(plain,
            "\n  corrector = 17: order 2, errors of dt^18 in the first power of the masses and dt^2 in the "
            "second\n"));
  for (const auto& [coordinates, order] : {std::pair("jacobi", 4), std::pair("democratic", 3), std::pair("whds", 2)}) {
    CHECK(has(kernel("composed", coordinates),
              "\n  corrector = 17, kernel = \"composed\": order " + std::to_string(order) + ", errors of dt^18 in "));
  }
}

TEST_CASE("explain says what a method exact in energy keeps, and what does not let it", "[cli][explain]") {
  const SceneFolder folder;
  const auto with = [&](const std::string& method, const std::string& sets = "") {
    return output(folder, "explain scene.toml --set integrator.method=" + method + sets);
  };
  CHECK(has(with("simo_tarnow_wong"), "\nkeeps E, p and L\n"));
  CHECK(has(with("gonzalez"), "\nkeeps E and p; L not, because of the method\n"));
  CHECK(has(with("itoh_abe"), "\nkeeps E; p not, because of the method; L not, because of the method\n"));
  CHECK(has(with("simo_tarnow_wong", " --set hamiltonian.force.0.type=henon_heiles"),
            "\nkeeps E; p not, because of henon_heiles; L not, because of henon_heiles\n"));
  CHECK(has(with("gonzalez", " --set hamiltonian.force.0.type=henon_heiles"),
            "\nkeeps E; p not, because of henon_heiles; L not, because of henon_heiles, the method\n"));
  CHECK(has(with("hbvm_4_2"), "\nkeeps E where it is a polynomial of degree 4 or less\n"));
  CHECK(has(with("hbvm_5_3"), "\nkeeps E where it is a polynomial of degree 3 or less\n"));
  CHECK_FALSE(has(with("hbvm_2_2"), "\nkeeps "));  // every Runge-Kutta method of Gauss keeps those of degree 2
  CHECK_FALSE(has(with("verlet"), "\nkeeps "));
}

TEST_CASE("explain says where numbers are single", "[cli][messages]") {
  const SceneFolder pair(close_pair);
  const std::string line =
      "\nprecision: lennard_jones's forces of pairs are single, right to about 1e-6 of the strongest";
  CHECK(has(output(pair, "explain scene.toml --set hamiltonian.force.0.precision=mixed"), line));
  CHECK_FALSE(has(output(pair, "explain scene.toml --set hamiltonian.force.0.precision=double"), line));
  CHECK_FALSE(has(output(pair, "explain scene.toml"), line));
}

TEST_CASE("small boxes, bonds and neighbors are spoken of", "[cli][messages]") {
  const SceneFolder pair(close_pair), chain(chain_scene);
  write_text(chain / "chain.data", broken_chain);
  CHECK(has(output(pair, "explain scene.toml"),
            "\nbox: an edge of 3 is smaller than twice the range 2.5 of the pair forces; all images in range count"));
  const std::string forces = " --set 'hamiltonian.force=[{type=\"lennard_jones\", cutoff=2.5, epsilon=1, sigma=1}]'";
  const std::string text = output(chain, "run scene.toml --fresh" + forces);
  CHECK(has(text, "\nwarning: the structure has 2 bonded terms that nothing acts on: there is no force 'bonded'\n"));
  CHECK(has(text, " s of it in searches for neighbors, with 1 sort into cells in "));
  const std::string json = output(chain, "run scene.toml --out again --json" + forces);
  CHECK(json_member(json_member(json, "neighbors"), "sorts") == "1");
  CHECK(std::stod(json_member(json_member(json, "neighbors"), "sort_seconds")) > 0);
  CHECK(has(json, "\"warnings\":[\"the structure has 2 bonded terms"));
  const auto refused = [&](const std::string& set) {
    const ProcessResult result = noether(pair, "run scene.toml --fresh " + set);
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(has(refused("--set hamiltonian.neighbors.skin=1e99"), "skin=1e99: skin = 1e+99 reaches so far beyond the box"));
  CHECK(has(refused("--set hamiltonian.force.0.cutoff=250"),
            "scene.toml:3: the box of 3 x 3 x 3 is so small compared with"));
}

TEST_CASE("what a LAMMPS data file leaves out is asked for, at the force that wants it", "[cli][messages]") {
  const SceneFolder folder(chain_scene);
  const std::string coefficients = "Bond Coeffs # fene\n\n1 30 1.5 1 1\n";
  std::string without = broken_chain;
  write_text(folder / "chain.data", without.erase(without.find(coefficients), coefficients.size()));
  const auto refused = [&](const std::string& line) {
    const ProcessResult result = noether(folder, line);
    CHECK(result.exit_code == 2);
    return result.err;
  };
  for (const char* command : {"run", "evaluate", "explain"}) {
    CHECK(refused(command + std::string(" scene.toml")) ==
          "scene.toml:8: there is a bond, but no parameters for its kind; give the parameters of each kind in section "
          "'Bond Coeffs' of "
          "the structure \"chain.data\"\n");
  }
  const std::string liquid = " --set 'hamiltonian.force=[{type=\"lennard_jones\", cutoff=2.5}]'";
  CHECK(has(refused("run scene.toml" + liquid),
            "lennard_jones: the particles have no Lennard-Jones parameters; give epsilon and sigma here, or types "
            "that have them"));
  CHECK(noether(folder, "evaluate scene.toml" + liquid + " --set 'particles.type=[{name=1, epsilon=1, sigma=1}]'")
            .exit_code == 0);
}

TEST_CASE("charges that no force looks at are warned of", "[cli][messages]") {
  const SceneFolder pair(close_pair);
  const std::string run = "run scene.toml --fresh --set integrator.step=0.0001 --set particles.body.a.charge=";
  const std::string warning = "\nwarning: the particles have charges that no force uses\n";
  const std::string field = " --set 'hamiltonian.force.1={type=\"reaction_field\", cutoff=1}'";
  CHECK(has(output(pair, run + "0.5"), warning));
  CHECK(
      has(output(pair, run + "0.5 --json --out b"), R"("warnings":["the particles have charges that no force uses"])"));
  CHECK_FALSE(has(output(pair, run + "0 --out c"), "warning"));
  CHECK_FALSE(has(output(pair, run + "0.5 --out d" + field), "warning"));
  CHECK(has(output(pair, run + "0 --out e" + field),
            "\nwarning: no particle has a charge for the force 'reaction_field'; give a body a charge\n"));
}

TEST_CASE("exclusions that no force leaves out are warned of", "[cli][messages]") {
  const SceneFolder pair(close_pair);
  const std::string run = "run scene.toml --fresh --set integrator.step=0.0001 --set 'particles.exclusions=[[0, 1]]'";
  const std::string springs =
      " --set 'hamiltonian.force=[{type=\"harmonic_bond\", pairs=[[\"a\",\"c\"]], k=1, length=1}]'";
  CHECK(has(output(pair, run + springs),
            "\nwarning: exclusions have no effect: no force of this scene leaves pairs out; forces that do are "
            "lennard_jones, wca, "
            "morse, buckingham, reaction_field, coulomb, ewald, particle_mesh_ewald\n"));
  CHECK_FALSE(has(output(pair, run + " --out b"), "warning"));
}

TEST_CASE("forces are written with all their digits", "[cli][evaluate]") {
  const SceneFolder folder;
  output(folder, "evaluate scene.toml --forces forces.csv --set particles.body.Planet.mass=0.1");
  CHECK(lines_of(read_text(folder / "forces.csv")).at(1) == "0,0.10000000000000001,0,0");
}

TEST_CASE("explain tells what is in and what is left out", "[cli][explain]") {
  const SceneFolder folder;
  const std::string text = output(folder, "explain scene.toml --all");
  for (const char* line :
       {"Two bodies: yoshida_4 over kinetic_potential, 2 particles\nstep: 0.01; at most ", "\n  force gravity\n",
        "\n  monitor energy, every 10 steps\n", "\n  writer trajectory, every 20 steps\n",
        "\n  writer checkpoint, every 40 steps\n", "\n  monitor momentum\n", "\n  stop escape\n",
        "\n  3 x B: kicks, one force evaluation each\n", "\nSIMD level: "}) {
    INFO(line << "\n" << text);
    CHECK(has(text, line));
  }
  CHECK(text.find("\nleft out:\n") < text.find("\n  monitor momentum\n"));
  CHECK(text.find("\n  monitor energy") < text.find("\nleft out:\n"));
  CHECK(text.find("\neach step:\n") < text.find("\nin:\n"));
  const std::string brief = output(folder, "explain scene.toml");
  CHECK_FALSE(has(brief, "\n  monitor momentum\n"));
  CHECK(has(brief, " monitors, 2 stops; --all names them\n"));
  CHECK(has(output(folder, "explain scene.toml --set integrator.steps=1"), "; 1 step in all\n"));
  const std::string json = json_output(folder, "explain scene.toml", "explain");
  CHECK(json_member(json, "flows_per_step") == R"({"A":3,"B":3})");
  CHECK(json_member(json, "bytes_per_particle") == "64");
  // A twentieth of the time a circle through the pericenter would take at the speed there.
  const double mu = 1.001, a = 1 / (2 - 1 / mu), q = 2 * a - 1;
  const double step = 2 * M_PI * std::sqrt(q * q * q / (mu * (2 - q / a))) / 20;
  CHECK(std::abs(std::stod(json_member(json, "recommended_step")) - step) < 1e-14);
}

TEST_CASE("list knows every kind of part", "[cli][list]") {
  const ScratchFolder folder;
  const std::string methods = output(folder, "list methods");
  for (const char* name : {"verlet", "yoshida_4", "aba_10_6_4", "srkn14a", "symplectic_euler_a"}) {
    CHECK(has(methods, std::string("\n") + name + " "));
  }
  CHECK(has(output(folder, "list forces"), "\ngravity "));
  CHECK(has(output(folder, "list monitors"), "\nangular_momentum "));
  CHECK(has(output(folder, "list monitors"), "\ntrajectory "));
  CHECK(has(output(folder, "list units"), "\nau "));
  for (const char* what : {"methods", "forces", "constraints", "systems", "monitors", "builders", "units"}) {
    const std::string json = json_output(folder, std::string("list ") + what, "list");
    CHECK(json_member(json, "list") == "\"" + std::string(what) + "\"");
    CHECK(json_member(json, "items").front() == '[');
    CHECK_FALSE(output(folder, std::string("list ") + what).empty());
  }
}

TEST_CASE("describe tells formula, order, fields and source", "[cli][describe]") {
  const ScratchFolder folder;
  const std::string method = output(folder, "describe yoshida_4");
  CHECK(has(method, "\n  order 4, 3 kicks per step, symmetric\n"));
  CHECK(has(method, "\n@article{"));
  const std::string json = json_output(folder, "describe aba_10_6_4", "describe");
  CHECK(json_member(json, "kind") == "\"method\"");
  CHECK(json_member(json, "near_integrable_orders") == "[10,6,4]");
  CHECK(has(json, "\"bibtex\":\"@"));
  CHECK(json_member(output(folder, "describe forest_ruth --json"), "name") == "\"yoshida_4\"");

  const std::string force = output(folder, "describe gravity");
  CHECK(has(force, "G m_i m_j / sqrt(r_ij^2 + softening^2)"));
  CHECK(has(force, "\n  softening "));
  CHECK(has(force, "\n@book{Newton1687,"));
  CHECK(json_member(json_output(folder, "describe gravity", "describe"), "kind") == "\"force\"");
  const std::string newmark = output(folder, "describe newmark"), dop853 = output(folder, "describe dop853");
  CHECK(has(newmark, "\n  beta           number [1], default 0.25: weight of the new acceleration in the positions"));
  CHECK(has(newmark, "\n  jacobian       choice [1], one of dense, sparse, matrix_free: how df/dy is stored; "));
  CHECK_FALSE(has(newmark, "\n  rtol "));
  CHECK(json_member(json_output(folder, "describe newmark", "describe"), "options") ==
        R"(["beta","gamma","jacobian"])");
  CHECK(has(dop853, "\n  adaptive       flag [1], default true: false: steps of one length\n"));
  CHECK(has(dop853, "\n  rtol           number [1], default 1e-06: relative tolerance\n"));
  CHECK_FALSE(has(output(folder, "describe bdf"), "\n  adaptive "));
  CHECK(has(method, "\n  compensated    flag [1], default false: keeps the rounding errors of sums"));
  CHECK(output(folder, "describe energy").starts_with("energy (monitor): "));
  CHECK(json_member(json_output(folder, "describe elements", "describe"), "kind") == "\"monitor\"");
  CHECK(json_member(json_output(folder, "describe trajectory", "describe"), "kind") == "\"writer\"");
  CHECK(json_member(json_output(folder, "describe wisdom_holman", "describe"), "kind") == "\"hamiltonian\"");
  CHECK(has(json_output(folder, "describe kyr", "describe"), R"("solar":365250)"));
}

TEST_CASE("describe says of a method what it serves, as it claims itself", "[cli][describe]") {
  const ScratchFolder folder;
  const auto says = [&](const std::string& name, const std::string& line, const std::string& equation) {
    INFO(name);
    CHECK(has(output(folder, "describe " + name), "\n  for " + equation + ": it supports " + line + "\n"));
    CHECK(json_member(json_output(folder, "describe " + name, "describe"), "serves") == "\"" + equation + "\"");
  };
  for (const char* name : {"rk4", "gauss_8", "adams_bashforth_3", "rodas_5p"}) {
    says(name, "all forces, also those that depend on velocities", "y' = f(t, y)");
  }
  for (const char* name : {"stormer_cowell_12", "stormer_cowell_13", "stormer_cowell_14", "dprkn_12"}) {
    says(name, "forces that depend on positions and time, but not on velocities, and no first-order system",
         "q'' = a(t, q)");
  }
  says("encke_gauss_8", "gravity without softening, and beside it forces that depend on positions and time",
       "gravity of point masses");
  says("simo_tarnow_wong", "forces that know their secants", "q'' = -M^-1 grad U(q)");
  says("gonzalez", "forces of an energy of positions alone, and Hamiltonian systems", "y' = J grad H(y)");
  says("boris_sdc", "all forces that do not depend on velocities, and magnetic fields, but no first-order system",
       "q'' = a(t, q) + q' x rate(t, q)");
  says("newmark", "all forces, also those that depend on velocities, but no first-order system", "q'' = a(t, q, q')");
}

TEST_CASE("list and describe tell orders, evaluations and limits as docs/methods.md does", "[cli][list][describe]") {
  const ScratchFolder folder;
  const std::string list = output(folder, "list methods"), json = output(folder, "list methods --json");
  // The columns of the list, a blank between them.
  const auto row = [&](const std::string& name) {
    const std::size_t begin = list.find("\n" + name + " ") + 1;
    std::string cells;
    for (const char c : list.substr(begin, list.find('\n', begin) - begin)) {
      if (c != ' ' || cells.back() != ' ') cells += c;
    }
    return cells;
  };
  CHECK(list.starts_with("name "));
  CHECK(row("rk4").starts_with("rk4 4 runge-kutta 4 2.828 "));
  CHECK(row("euler").starts_with("euler 1 runge-kutta 1 never "));
  CHECK(row("gauss_8") == "gauss_8 16 collocation iterates always");
  CHECK(row("gauss_radau_15").starts_with("gauss_radau_15 15 collocation iterates 1.361 "));
  CHECK(
      row("gragg_bulirsch_stoer").starts_with("gragg_bulirsch_stoer varies, to 16, in Quad to 24 extrapolation - - "));
  CHECK(row("adams_pece").starts_with("adams_pece 4, to 12 multistep 2 never "));
  CHECK(row("bdf").starts_with("bdf varies, to 5 multistep - - "));
  CHECK(row("trapezoidal").starts_with("trapezoidal 2 implicit iterates always "));
  CHECK(has(json, R"({"name":"rk4","order":4,"class":"runge-kutta","evaluations":4,"stability_limit":2.8284)"));
  CHECK(has(json, R"("class":"collocation","evaluations":null,"stability_limit":"always",)"));
  CHECK(has(json, R"({"name":"verlet","order":2,"class":"general","evaluations":1,"stability_limit":2,)"));
  const std::string gbs = output(folder, "describe gragg_bulirsch_stoer");
  CHECK(has(gbs, "\n  order varies, to 16, in Quad to 24, chooses its steps, "));
  CHECK(json_member(json_output(folder, "describe gbs", "describe"), "order_in_quad") == "24");
  CHECK(has(read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "docs/methods.md"),
            "\n| gragg_bulirsch_stoer | varies, to 16, in Quad to 24 ("));
  CHECK(has(output(folder, "describe rk4"), "\n  4 evaluations per step of given length\n"));
}

TEST_CASE("whatever is listed can be described", "[cli][describe][slow]") {
  const ScratchFolder folder;
  for (const char* what : {"methods", "forces", "monitors", "units"}) {
    const std::vector<std::string> lines = lines_of(output(folder, std::string("list ") + what));
    REQUIRE(lines.size() > 3);
    for (std::size_t k = 1; k < lines.size(); ++k) {
      const std::string name = lines[k].substr(0, lines[k].find("  "));
      json_output(folder, "describe " + name, "describe");
    }
  }
}

#if NOETHER_HDF5

TEST_CASE("info and verify read the files of a run", "[cli][info]") {
  const SceneFolder folder;
  const std::string run = output(folder, "run scene.toml --json");
  for (const char* file : {"run.h5", "checkpoint.h5"}) {
    INFO(file);
    const std::string path = std::string("scene.out/") + file;
    const std::string info = json_output(folder, "info " + path, "info");
    CHECK(json_member(info, "digest") == json_member(run, "digest"));
    CHECK(json_member(info, "last_step") == "100");
    CHECK(json_member(info, "particles") == "2");
    CHECK(has(output(folder, "info " + path), json_member(run, "digest").substr(1, 71)));
    const std::string verified = json_output(folder, "verify " + path, "verify");
    CHECK(json_member(verified, "ok") == "true");
    CHECK(json_member(verified, "complete") == "true");
    CHECK(json_member(verified, "damaged") == "[]");
    CHECK(json_member(verified, "last_step") == "100");
    CHECK(json_member(verified, "digest") == json_member(run, "digest"));
  }
  const std::string info = json_output(folder, "info scene.out/run.h5", "info");
  CHECK(json_member(info, "kind") == "\"trajectory\"");
  CHECK(json_member(info, "frames") == "6");
  CHECK(has(info, R"({"name":"energy","quantities":["kinetic","potential","relative_error","total"],"samples":11})"));
  CHECK(output(folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
  const std::string checkpoint = json_output(folder, "info scene.out/checkpoint.previous.h5", "info");
  CHECK(json_member(checkpoint, "kind") == "\"checkpoint\"");
  CHECK(json_member(checkpoint, "last_step") == "80");
  CHECK(json_member(checkpoint, "outcome") == "null");
}

TEST_CASE("verify tells damage on stderr, or in its JSON", "[cli][verify]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  damage(folder / "scene.out/checkpoint.h5");
  const ProcessResult text = noether(folder, "verify scene.out/checkpoint.h5");
  CHECK(text.exit_code == 3);
  CHECK(text.out.empty());
  CHECK(text.err.starts_with("scene.out/checkpoint.h5: "));
  const ProcessResult json = noether(folder, "verify scene.out/checkpoint.h5 --json");
  CHECK(json.exit_code == 3);
  CHECK(is_json_line(json.out));
  CHECK(json_member(json.out, "ok") == "false");
  CHECK(json_member(json.out, "damaged").size() > 4);
}

TEST_CASE("convert writes extended XYZ and CSV", "[cli][convert]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --quiet");
  CHECK(output(folder, "convert scene.out/run.h5 frames.xyz").empty());
  const std::vector<std::string> xyz = lines_of(read_text(folder / "frames.xyz"));
  REQUIRE(xyz.size() == 6 * 4);
  CHECK(xyz[0] == "2");
  CHECK(has(xyz[1], "Properties=species:S:1:pos:R:3:vel:R:3 "));
  CHECK(xyz[3] == "Planet 1 0 0 0 1 0");
  CHECK(has(xyz[21], "Time=1 "));
  CHECK(output(folder, "convert scene.out/run.h5 frames.csv").empty());
  const ProcessResult open = noether(folder, "convert scene.out/run.h5 unwrapped.csv --unwrapped");
  CHECK(open.exit_code == 2);
  CHECK(has(open.err, "cannot unwrap the positions of 'scene.out/run.h5': its frames have no periodic box"));
  const std::string json = json_output(folder, "convert scene.out/run.h5 again.csv", "convert");
  CHECK(json_member(json, "frames") == "6");
  CHECK(read_text(folder / "again.csv") == read_text(folder / "frames.csv"));
  const std::vector<std::string> csv = lines_of(read_text(folder / "frames.csv"));
  REQUIRE(csv.size() == 1 + 6 * 2);
  CHECK(csv[0] == "step,time,id,name,x,y,z,vx,vy,vz");
  CHECK(csv[2] == "0,0,1,Planet,1,0,0,0,1,0");
  CHECK(csv[11].starts_with("100,1,0,Sun,"));
}

TEST_CASE("plot draws PNG and SVG", "[cli][plot][slow]") {
  const SceneFolder folder;
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: nothing is drawn");
    return;
  }
  output(folder, "run scene.toml --quiet");
  CHECK(output(folder, "plot scene.out/run.h5") == "scene.out/run.svg\n");
  CHECK(has(read_text(folder / "scene.out/run.svg").substr(0, 300), "<svg"));
  CHECK(output(folder, "plot scene.out/run.h5 --out picture.png") == "picture.png\n");
  CHECK(json_member(json_output(folder, "plot scene.out/run.h5 --out b.svg", "plot"), "file") == "\"b.svg\"");
  const std::string png = read_text(folder / "picture.png");
  CHECK(png.size() > 5000);
  CHECK(png.substr(1, 3) == "PNG");
}

TEST_CASE("plot shows energy, shadow energies by order and momenta on one page", "[cli][plot][slow]") {
  const SceneFolder folder(two_bodies +
                           "[[every]]\ntype = \"shadow_hamiltonian\"\nsteps = 1\norders = [4, 12]\n[[every]]\ntype = "
                           "\"momentum\"\nsteps = 5\n");
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: nothing is drawn");
    return;
  }
  output(folder, "run scene.toml --quiet");
  output(folder, "plot scene.out/run.h5");
  const std::string picture = read_text(folder / "scene.out/run.svg");
  for (const char* text :
       {"Energy: relative error, worst ", "Shadow Hamiltonian: relative change, worst ", " of order 12", ">order 4<",
        ">order 12<", "Momentum: relative error", "Angular momentum: relative error"}) {
    CAPTURE(text);
    CHECK(has(picture, text));
  }
}

#endif

}  // namespace
}  // namespace noether::test
