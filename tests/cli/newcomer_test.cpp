// The first five minutes of someone new: a scene of five lines, its run, picture and page, and a mistake at each step.
// Every mistake is answered in one line that says what to write instead; nothing that was there is lost.

#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

const std::string five_lines = R"(units = "solar"
hamiltonian = { type = "kinetic_potential", force = [{ type = "gravity" }] }
integrator = { method = "verlet", step = "1 day", until = "10 yr" }
particles.body = [{ name = "Sun", mass = "1 Msun" },
                  { name = "Earth", mass = "3e-6 Msun", a = "1 au", e = 0.0167 }]
)";

struct OrbitFolder : ScratchFolder {
  explicit OrbitFolder(const std::string& scene = five_lines) { write_text(*this / "orbit.toml", scene); }
};

/// A command that must be refused: its exit code, and the one line on stderr.
void check_refused(const ScratchFolder& folder, const std::string& line, int exit_code, const std::string& message) {
  const ProcessResult result = noether(folder, line);
  INFO(line << "\n" << result.out);
  CHECK(result.exit_code == exit_code);
  CHECK(result.err == message + "\n");
  CHECK(result.out.empty());
}

struct Mistake {
  std::string what, by;  ///< in the five lines
  std::string message;   ///< after "orbit.toml:"
};

TEST_CASE("each mistake in a first scene is answered with its line and what to write instead", "[cli][newcomer]") {
  const std::vector<Mistake> mistakes = {
      {"\"solar\"", "\"sloar\"", "1: unknown unit system 'sloar'; did you mean 'solar'?"},
      {"units = \"solar\"\n", "", "1: units are missing; give units = \"solar\", \"molecular\", \"si\" or \"reduced\""},
      {"hamiltonian =", "hamilton =", "2: unknown key 'hamilton'; did you mean 'hamiltonian'?"},
      {"\"gravity\"", "\"newton\"", "2: unknown force 'newton'; did you mean 'gravity'?"},
      {", force = [{ type = \"gravity\" }]", "",
       "2: kinetic_potential has no force, so nothing would move anything; add a [[hamiltonian.force]] table"},
      {"\"verlet\"", "\"leap_frog\"", "3: unknown method 'leap_frog'; did you mean 'verlet'?"},
      {"step = \"1 day\"", "step = 1", "3: step: '1' has no unit; a time is expected, such as '1 day'"},
      {"step = \"1 day\", ", "", "3: [integrator] has no step; give one, such as \"1 day\""},
      {"step = \"1 day\"", "dt = \"1 day\"", "3: unknown key 'dt' in [integrator]; did you mean 'step'?"},
      {"\"1 day\"", "\"1 dya\"", "3: step: unknown unit 'dya' in '1 dya'; did you mean 'day'?"},
      {"\"10 yr\"", "\"10 au\"", "3: until: '10 au' is a length; a time is expected, such as '10 day'"},
      {"until =", "end =", "3: unknown key 'end' in [integrator]; did you mean 'until'?"},
      {"mass = \"1 Msun\"", "m = \"1 Msun\"", "4: unknown key 'm' in body 'Sun'; did you mean 'mass'?"},
      {", mass = \"3e-6 Msun\"", "", "5: body 'Earth' has no mass; give one, or 0 for a tracer"},
      {"a = \"1 au\", e = 0.0167", "x = [1, 0, 0]", "5: x: '1' has no unit; a length is expected, such as '1 au'"},
      {"e = 0.0167", "e = 1.0167",
       "5: e = 1.0167 does not fit a > 0, which means an ellipse; expected 0 <= e < 1, or a < 0 for a hyperbola"},
  };
  for (const Mistake& one : mistakes) {
    const OrbitFolder folder(replaced(five_lines, one.what, one.by));
    INFO(one.what << " -> " << one.by);
    check_refused(folder, "run orbit.toml", 2, "orbit.toml:" + one.message);
    CHECK_FALSE(fs::exists(folder / "orbit.out"));
  }
}

TEST_CASE("a first command is answered, also a wrong one", "[cli][newcomer]") {
  const OrbitFolder folder;
  check_refused(folder, "", 2, "no command is given; see `noether --help`");
  check_refused(folder, "rum orbit.toml", 2, "unknown command 'rum'; did you mean 'run'?");
  check_refused(folder, "orbit.toml", 2, "'orbit.toml' is not a command; did you mean `noether run orbit.toml`?");
  check_refused(folder, "run", 2, "scene is required; see `noether run --help`");
  check_refused(folder, "run obrit.toml", 3,
                "obrit.toml: cannot be read: No such file or directory; did you mean 'orbit.toml'?");
  CHECK(has(output(folder, "--help"), "\n  run "));
  CHECK(has(output(folder, "help run"), "--resume"));
}

#if NOETHER_HDF5

/// The five lines, run.
struct OrbitRun : OrbitFolder {
  OrbitRun() {
    const ProcessResult run = noether(*this, "run orbit.toml");
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    REQUIRE(run.err ==
            "note: orbit.toml:3: until = \"10 yr\" is 3652.5 steps of \"1 day\"; the run ends at the first whole step "
            "after it, \"3653 day\" (3653 steps)\n");
    for (const char* line : {"completed at step 3653, time 3653 day\n", "\nenergy: worst 4.97e-06,",
                             "\nwrote orbit.out/run.h5\n", "\nwrote orbit.out/checkpoint.h5\n"}) {
      REQUIRE(has(run.out, line));
    }
  }
};

TEST_CASE("five lines make a run, a picture and a page", "[cli][newcomer]") {
  const OrbitRun folder;
  const std::string info = output(folder, "info orbit.out/run.h5");
  CHECK(has(info, "trajectory, complete\n  2 particles, step "));
  CHECK(has(info, "\n  energy: "));
  check_refused(folder, "info orbit.out", 3, "orbit.out: this is not a regular file; did you mean 'orbit.out/run.h5'?");
  check_refused(folder, "view orbit.out", 3, "orbit.out: this is not a regular file; did you mean 'orbit.out/run.h5'?");
  for (const char* command : {"info orbit.toml", "view orbit.toml", "verify orbit.toml"}) {
    check_refused(folder, command, 3,
                  "orbit.toml: this is a scene, and a file of a run is expected; did you mean 'orbit.out/run.h5'?");
  }
  check_refused(
      folder, "run orbit.out/run.h5", 2,
      "orbit.out/run.h5: this is an HDF5 file, and a scene is expected; `noether info orbit.out/run.h5` tells "
      "what is in it");
  check_refused(folder, "view orbit.out/run.h5 --frames 0", 2,
                "--frames: '0' is not a valid number of frames; give one from 1; see `noether view --help`");
  CHECK(output(folder, "view orbit.out/run.h5 --out orbit.html") == "orbit.html\n");
  CHECK(has(read_text(folder / "orbit.html"), "Earth"));
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: the picture is left out");
    return;
  }
  check_refused(folder, "plot orbit.out", 3, "orbit.out: this is not a regular file; did you mean 'orbit.out/run.h5'?");
  CHECK(output(folder, "plot orbit.out/run.h5 --out orbit.svg") == "orbit.svg\n");
  CHECK(has(read_text(folder / "orbit.svg"), "Earth"));
}

TEST_CASE("a first run goes on, and none is lost", "[cli][newcomer]") {
  const OrbitRun folder;
  const std::string file = read_text(folder / "orbit.out/run.h5");
  const ProcessResult longer = noether(folder, "run orbit.toml --resume --until '20 yr'");
  CHECK(longer.exit_code == 0);
  CHECK(longer.err.empty());
  CHECK(has(longer.out, "completed at step 7305, time 7305 day\nresumed from step 3653\n"));
  const ProcessResult other = noether(folder, "run orbit.toml --resume --set integrator.step='2 day'");
  CHECK(other.exit_code == 2);
  CHECK(has(other.err,
            "\n--set integrator.step=2 day: integrator.step = \"2 day\" was \"1 day\"; a resumed run may "
            "change only its end, to a later one: undo this, or start over with --fresh\n"));
  const ProcessResult again = noether(folder, "run orbit.toml");
  CHECK(again.exit_code == 0);
  CHECK(has(again.err, "note: the finished run in orbit.out was moved to orbit.out.1\n"));
  CHECK(read_text(folder / "orbit.out/run.h5").size() == file.size());
  CHECK(has(output(folder, "info orbit.out.1/checkpoint.h5"), "step 7305"));
  for (const char* which : {"orbit.out", "orbit.out.1"}) {
    CHECK(has(output(folder, "verify " + std::string(which) + "/run.h5"), "sound"));
  }
}

#endif

}  // namespace
}  // namespace noether::test
