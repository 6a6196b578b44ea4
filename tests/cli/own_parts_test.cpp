/// A Hamiltonian from outside the library (tests/support/gyration.hpp), with a basic word of five letters, through
/// every command of a program that knows it.

#include "io/inspect.hpp"
#include "tests/cli/support.hpp"

#include <cmath>
#include <complex>
#include <string>

namespace noether::test {
namespace {

/// Two charges in a trap that is the same in all directions of the plane: each turns on two circles.
const std::string trap = R"(title = "Two charges in a trap"
units = "reduced"
[[particles.body]]
name = "one"
mass = 1
x = [1, 0, 0.1]
v = [0, 0.3, 0]
[[particles.body]]
name = "other"
mass = 2
x = [0, 0.5, 0]
v = [0.2, 0, 0]
[hamiltonian]
type = "gyration"
omega = 1.5
[[hamiltonian.force]]
type = "harmonic_field"
k = 0.8
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

/// x + i y of a charge of mass m after time t: z'' = i omega z' - (k / m) z.
std::complex<double> exact(std::complex<double> z, std::complex<double> w, double m, double t) {
  using namespace std::complex_literals;
  const double root = std::sqrt(1.5 * 1.5 / 4 + 0.8 / m), fast = 0.75 + root, slow = 0.75 - root;
  const std::complex<double> a = (w / 1i - slow * z) / (fast - slow), b = z - a;
  return a * std::exp(1i * fast * t) + b * std::exp(1i * slow * t);
}

}  // namespace

TEST_CASE("a Hamiltonian from outside the library is listed, described and explained", "[cli][own_parts]") {
  const SceneFolder folder(trap);
  CHECK(has(own_output(folder, "list hamiltonians"), "gyration           charges that turn about a uniform field"));
  CHECK(has(own_output(folder, "describe gyration"), "gyration (hamiltonian): charges that turn"));
  const std::string explained = own_output(folder, "explain scene.toml");
  CHECK(has(explained, "yoshida_4 over gyration, 2 particles"));
  CHECK(has(explained, "\n  3 x A: drifts\n"));
  CHECK(has(explained, "\n  3 x B: kicks, one force evaluation each\n"));
  CHECK(has(explained, "\n  6 x R: turns of the velocities\n"));
  CHECK(has(noether(folder, "explain scene.toml").err,
            "scene.toml:14: unknown hamiltonian 'gyration'; expected one of: "));
}

#if NOETHER_HDF5
TEST_CASE("its runs are right, the same on any threads and across a restart, and can be verified and drawn",
          "[cli][own_parts]") {
  const SceneFolder folder(trap);
  const std::string digest = json_member(own_output(folder, "run scene.toml --json --out a"), "digest");
  CHECK(json_member(own_output(folder, "run scene.toml --json --out b --threads 2"), "digest") == digest);
  CHECK(json_member(own_output(folder, "run scene.toml --json --out c --set every.0.steps=1"), "digest") == digest);
  own_output(folder, "run scene.toml --quiet --out d --until 6");
  CHECK(json_member(own_output(folder, "run scene.toml --json --out d --resume --until 10"), "digest") == digest);
  CHECK(own(folder, "verify a/run.h5").exit_code == 0);
  own_output(folder, "plot a/run.h5 --out picture.svg");
  own_output(folder, "info a/run.h5");
  own_output(folder, "convert a/run.h5 a.csv");
  CHECK(has(read_text(folder / "a.csv"), "other"));
}

TEST_CASE("its runs come nearer to the closed form by the order of their scheme", "[cli][own_parts]") {
  const SceneFolder folder(trap);
  const auto error_of = [&](const std::string& step, std::int64_t steps) {
    const std::string sets = " --set integrator.step=" + step + " --set integrator.steps=" + std::to_string(steps);
    own_output(folder, "run scene.toml --quiet --out " + step + sets);
    const io::Frames read = io::read_frames(folder / (step + "/run.h5"));
    const auto& end = read.frames.back();
    CHECK(end.step == steps);
    const std::complex<double> one(end.positions[0], end.positions[1]), other(end.positions[3], end.positions[4]);
    return std::abs(one - exact({1, 0}, {0, 0.3}, 1, 10)) + std::abs(other - exact({0, 0.5}, {0.2, 0}, 2, 10));
  };
  const double coarse = error_of("0.04", 250);
  const double fine = error_of("0.02", 500);
  CHECK(fine < 1e-5);
  CHECK(std::abs(std::log2(coarse / fine) - 4) < 0.1);
}

#endif

TEST_CASE("its errors are measured against a truth in 113 bits, by splittings and by methods for y' = f",
          "[cli][own_parts]") {
  const SceneFolder folder(trap);
  const std::string table =
      own_output(folder, "compare scene.toml --methods yoshida_4,verlet,ARBRA,dop853,gauss_4 --steps 0.02,0.01 --json");
  CHECK(has(table, "in quad"));
  for (const char* label : {"yoshida_4", "verlet", "ARBRA", "dop853", "gauss_4"}) {
    CHECK(has(table, "\"" + std::string(label) + "\""));
  }
  CHECK_FALSE(has(table, "diverged"));
  const auto figure = [&](const std::string& line, const std::string& name) {
    return json_member(own_output(folder, "compare scene.toml --json --methods " + line), name);
  };
  CHECK(std::stod(figure("yoshida_4 --steps 0.02", "position_error_max")) < 1e-5);
  // Neither angular momentum nor the centre of mass is kept by the equations, so neither is an error or a frame.
  std::string alone = trap;
  alone.replace(alone.find("type = \"harmonic_field\"\nk = 0.8"), 31, "type = \"gravity\"\nG = 1e-9");
  const SceneFolder apart(alone);
  const std::string errors = own_output(apart, "compare scene.toml --json --methods verlet --steps 0.05");
  CHECK(json_member(errors, "angular_momentum_error_max") == "null");
  CHECK(std::stod(json_member(errors, "position_error_max")) > 1e-6);
}

TEST_CASE("a force that depends on velocities stands beside it: in evaluate, and in the truth", "[cli][own_parts]") {
  std::string heavy = trap;  // whose first charge is the heavier one: post_newtonian is about it
  heavy.replace(heavy.find("mass = 1\n"), 9, "mass = 3\n");
  std::string relative = heavy;
  const std::string fixed = "method = \"yoshida_4\"\nstep = 0.02\nsteps = 500\n";
  relative.replace(relative.find(fixed), fixed.size(), "method = \"dop853\"\nuntil = 2\n");
  relative.replace(relative.find("[integrator]"), 0, "[[hamiltonian.force]]\ntype = \"post_newtonian\"\nc = 5\n");
  const std::string counted = "steps = ", timed = "every = 0.";
  for (auto at = relative.find(counted); at != std::string::npos; at = relative.find(counted, at))
    relative.replace(at, counted.size(), timed);
  // The energy of this force is not known, so that a monitor of it is refused.
  const std::string watched = "[[every]]\ntype = \"energy\"\nevery = 0.10\n";
  CHECK(has(own(SceneFolder(relative), "run scene.toml").err, "monitor 'energy' needs the energy"));
  relative.replace(relative.find(watched), watched.size(), "");
  const SceneFolder folder(relative), without(heavy);
  const auto force_of = [](const SceneFolder& in) {
    return std::stod(json_member(own_output(in, "evaluate scene.toml --json"), "force_max"));
  };
  CHECK(std::abs(force_of(folder) - force_of(without)) > 1e-4);
  const std::string table = own_output(folder, "compare scene.toml --json --methods dop853 --tolerances 1e-10");
  CHECK(has(table, "in quad"));
  CHECK(std::stod(json_member(table, "position_error_max")) < 1e-7);
}

TEST_CASE("its largest stable steps are found, and advice is given", "[cli][own_parts]") {
  const SceneFolder folder(trap);
  // Steps that nobody knows a scale for are tried from small ones on; none of them is called unstable.
  const std::string limits = own_output(folder, "stability scene.toml --methods verlet --steps 2000 --budget 3");
  CHECK(has(limits, "only steps are given"));
  CHECK(has(limits, "bounded until there"));
  CHECK_FALSE(has(limits, "grows by"));
  CHECK(has(own_output(folder, "advise scene.toml --error 1e-6 --methods yoshida_4,verlet"), "yoshida_4"));
  CHECK(has(own_output(folder, "evaluate scene.toml"), "harmonic_field"));
}

TEST_CASE("what it cannot do is refused by name", "[cli][own_parts]") {
  const SceneFolder folder(trap);
  const auto refused = [&](const std::string& sets) { return own(folder, "run scene.toml" + sets).err; };
  CHECK(has(refused(" --set integrator.method=aba_10_6_4"),
            "scheme 'aba_10_6_4' has no letter R, which is a part of 'gyration'; use a composition of its steps ARBRA, "
            "such as 'yoshida_4', or a word with all of its letters"));
  CHECK(has(refused(" --set integrator.method=srkn14a"), "'srkn14a'"));
  CHECK(has(refused(" --set every.0.type=shadow_hamiltonian"), "not canonical maps"));
}

}  // namespace noether::test
