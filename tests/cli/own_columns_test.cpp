/// A Hamiltonian from outside the library with an orientation and a spin (tests/support/tops.hpp), under a force from
/// outside with a mesh in its workspace and a torque (tests/support/mesh_field.hpp), through every command.

#include "engine/charge.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "io/digest.hpp"
#include "io/inspect.hpp"
#include "tests/cli/support.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/mesh_field.hpp"

#include <cmath>
#include <string>

namespace noether::test {
namespace {

/// Two bodies in a wave of the field: they swing along x, and their axes about z.
const std::string wave = R"(title = "Two tops in a wave"
units = "reduced"
[[particles.body]]
name = "one"
mass = 1
x = [0.3, 0, 0]
v = [0.5, 0.1, 0]
orientation = [0.8, 0.6, 0, 0]
spin = [0.1, 0.2, 1.5]
[[particles.body]]
name = "other"
mass = 2
x = [2.2, 1, 0]
v = [-0.3, 0, 0]
spin = [0, 0.4, 0]
[hamiltonian]
type = "tops"
inertia = 0.7
[[hamiltonian.force]]
type = "mesh_field"
strength = 0.5
[integrator]
method = "yoshida_4"
step = 0.02
steps = 500
[[every]]
type = "energy"
steps = 10
[[every]]
type = "trajectory"
steps = 50
[[every]]
type = "checkpoint"
steps = 100
)";

}  // namespace

TEST_CASE("parts from outside with columns of their own are listed, described and explained", "[cli][own_columns]") {
  const SceneFolder folder(wave);
  CHECK(has(own_output(folder, "list hamiltonians"), "tops"));
  CHECK(has(own_output(folder, "describe mesh_field"), "mesh_field (force): a field along z"));
  const std::string explained = own_output(folder, "explain scene.toml");
  CHECK(has(explained, "yoshida_4 over tops, 2 particles"));
  CHECK(has(explained, "columns: id, position, velocity, mass, orientation, spin; 120 bytes per particle"));
  CHECK(has(explained, "\n  3 x A: flights and turns\n"));
  CHECK(has(explained, "\n  3 x B: kicks and torques, one force evaluation each\n"));
}

#if NOETHER_HDF5
TEST_CASE("runs that move columns have the same bits on any threads, at any cadence and across a restart",
          "[cli][own_columns]") {
  const SceneFolder folder(wave);
  const std::string digest = own_digest(folder, "a");
  CHECK(own_digest(folder, "b --threads 2") == digest);
  CHECK(own_digest(folder, "c --set every.0.steps=1 --set every.1.steps=3") == digest);
  own_output(folder, "run scene.toml --quiet --out d --until 6");
  CHECK(own_digest(folder, "d --resume --until 10") == digest);
  CHECK(json_member(own_output(folder, "info --json d/run.h5"), "digest") == digest);
  CHECK(json_member(own_output(folder, "info --json d/checkpoint.h5"), "digest") == digest);
  CHECK(own(folder, "verify d/run.h5").exit_code == 0);
  // Turned otherwise at the start, it is another run.
  CHECK(own_digest(folder, "e --set particles.body.1.orientation=[0.6,0,0.8,0]") != digest);
}

TEST_CASE("frames hold the columns that move, and what is drawn and written from them does too", "[cli][own_columns]") {
  const SceneFolder folder(wave);
  own_output(folder, "run scene.toml --quiet --out a");
  const io::Frames read = io::read_frames(folder / "a/run.h5");
  REQUIRE(read.columns.size() == 2);
  CHECK(read.columns.at("orientation").first == 4);
  CHECK(read.columns.at("spin").first == 3);
  REQUIRE(read.frames.size() == 11);
  CHECK(read.frames.front().columns.at("orientation") == std::vector<double>{0.8, 0.6, 0, 0, 1, 0, 0, 0});
  for (const io::Frame& frame : read.frames) {
    const std::vector<double>& q = frame.columns.at("orientation");
    for (const std::size_t i : {0U, 4U}) {
      CHECK(std::abs(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3] - 1) < 1e-13);
    }
    // The field is along z, so nothing turns a body about z.
    CHECK(std::abs(frame.columns.at("spin")[2] - 1.5) < 1e-14);
  }
  own_output(folder, "convert a/run.h5 a.csv");
  CHECK(
      has(read_text(folder / "a.csv"), "vx,vy,vz,orientation[0],orientation[1],orientation[2],orientation[3],spin[0]"));
  own_output(folder, "convert a/run.h5 a.xyz");
  CHECK(has(read_text(folder / "a.xyz"), "Properties=species:S:1:pos:R:3:vel:R:3:orientation:R:4:spin:R:3 Time=0"));
  own_output(folder, "plot a/run.h5 --out picture.svg");
}

TEST_CASE("frames whose columns only have the names of those of rigid bodies start runs and scenes as points do",
          "[cli][own_columns]") {
  const SceneFolder folder(wave);
  own_output(folder, "run scene.toml --quiet --out a");
  own_output(folder, "convert a/run.h5 again.h5 --bodies");
  const std::string head = wave.substr(0, wave.find("[[particles.body]]"));
  const std::string rest = wave.substr(wave.find("[hamiltonian]"));
  for (const std::string from : {"a/run.h5", "again.h5"}) {
    test::write_text(folder / "next.toml", head + "[particles]\nbodies = '" + from + "'\n" + rest);
    own_output(folder, "run next.toml --quiet --out b --fresh");
    CHECK(json_member(own_output(folder, "info --json b/run.h5"), "particles") == "2");
  }
}
#endif

TEST_CASE("a flipped bit in any column that moves changes the digest", "[cli][own_columns]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("a", 1, Vec3<double>(1, 2, 3), Vec3<double>::Zero());
  const std::string points = io::digest(s);
  s.add_column<Charge>()[0] = 1;
  CHECK(io::digest(s) == points);  // parameters are no state
  s.add_column<Orientation>();
  s.add_column<Spin>();
  const std::string whole = io::digest(s);
  CHECK(whole != points);
  for (int k = 0; k < 4; ++k) {
    ParticleSystem<double> other = s;
    double& x = other.column<Orientation>().component(k)[0];
    x = std::nextafter(x, 2);
    CHECK(io::digest(other) != whole);
  }
}

TEST_CASE("tops keep their energy to the order of the scheme, over the basic word ABA", "[cli][own_columns]") {
  const auto drift = [](double dt) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add("a", 1, Vec3<double>(0.3, 0, 0), Vec3<double>(0.5, 0.1, 0));
    s.add_column<Orientation>().set(0, {0.8, 0.6, 0, 0});
    s.add_column<Spin>().set(0, {0.1, 0.2, 1.5});
    auto integrator = compose(SpinningTops(0.7, MeshField{.strength = 0.5}), schemes::yoshida_4);
    Simulation sim(s, integrator, dt);
    integrator.bind(s);
    const double start = integrator.energy(s).total();
    double worst = 0;
    for (int k = 0; k < 20; ++k) {
      CHECK(sim.run(static_cast<std::int64_t>(std::lround(0.4 / dt))).ok());
      worst = std::max(worst, std::abs(integrator.energy(sim.particles()).total() - start));
    }
    return worst;
  };
  const double coarse = drift(0.1), fine = drift(0.05);
  CHECK(fine < 1e-4);
  CHECK(std::abs(std::log2(coarse / fine) - 4) < 0.4);
}

TEST_CASE("a body that nothing holds turns about its spin by the closed form", "[cli][own_columns]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("a", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  s.add_column<Orientation>();
  s.add_column<Spin>().set(0, {0, 0, 1.4});
  Simulation sim(s, compose(SpinningTops(0.7, Sum<>()), schemes::verlet), 0.25);
  REQUIRE(sim.run(40).ok());  // omega = 2, t = 10
  const Quaternion<double> q = sim.particles().column<Orientation>()[0];
  CHECK(std::abs(q[0] - std::cos(10.0)) < 1e-14);
  CHECK(std::abs(q[3] - std::sin(10.0)) < 1e-14);
}

TEST_CASE("errors of tops are measured against their own splitting in 113 bits", "[cli][own_columns][nightly]") {
  const SceneFolder folder(wave);
  const std::string table =
      own_output(folder, "compare scene.toml --methods yoshida_4,verlet --steps 0.02,0.01 --until 4 --json");
  CHECK(has(table, "sofroniou_spaletta_10_s35 in quad"));
  CHECK_FALSE(has(table, "diverged"));
  const auto order_of = [&](const std::string& method) {
    const std::string before = "\"method\":\"" + method + "\",\"order\":";
    const std::size_t at = table.find(before);
    REQUIRE(at != std::string::npos);
    return std::stod(table.substr(at + before.size()));
  };
  CHECK(std::abs(order_of("verlet") - 2) < 0.1);
  CHECK(std::abs(order_of("yoshida_4") - 4.3) < 0.7);  // third derivatives of the mesh have jumps
}

TEST_CASE("limits, advice and energies of tops are told", "[cli][own_columns]") {
  const SceneFolder folder(wave);
  CHECK(
      has(own_output(folder, "stability scene.toml --methods verlet --steps 2000 --budget 3"), "only steps are given"));
  CHECK(has(own_output(folder, "advise scene.toml --error 1e-6 --methods yoshida_4,verlet"), "cheapest: yoshida_4"));
  const std::string energies = own_output(folder, "evaluate scene.toml");
  CHECK(has(energies, "mesh_field"));
}

TEST_CASE("what cannot move columns refuses them by name", "[cli][own_columns]") {
  const SceneFolder folder(wave);
  const auto refused = [&](const std::string& sets) { return own(folder, "run scene.toml" + sets).err; };
  CHECK(has(refused(" --set integrator.method=dop853 --set integrator.steps=10"),
            "'tops' moves more than positions and velocities, so methods for y' = f cannot step it"));
  CHECK(has(refused(" --set particles.body.0.orientation=[1,0,0]"), "orientation = [1, 0, 0] is not a list of 4"));
  CHECK(has(refused(" --set particles.body.0.orientatoin=[1,0,0,0]"), "did you mean 'orientation'?"));
  CHECK(has(refused(" --set hamiltonian.type=kinetic_potential"), "orientation"));
  CHECK(has(refused(" --set every.0.type=shadow_hamiltonian"), "are not a motion of positions and momenta"));
  CHECK(has(refused(" --set hamiltonian.force.0.kick=C"),
            "force 'mesh_field' is in the kick C, but 'tops' has only B; take its kick out"));
}

}  // namespace noether::test
