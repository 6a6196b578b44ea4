// The program on scenes with constraints: reports, restarts, failures that end with a good state.

#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

/// The double pendulum of the examples, for two seconds.
struct PendulumFolder : ScratchFolder {
  PendulumFolder() { fs::copy(fs::path(NOETHER_SOURCE_DIR) / "examples" / "double_pendulum" / "scene.toml", path()); }
};
const std::string briefly = " --until '2 s'";

TEST_CASE("a constrained run that was interrupted ends as one that was not", "[cli][resume][constraints]") {
  const PendulumFolder whole, cut;
  const ProcessResult straight = noether(whole, "run scene.toml --json" + briefly);
  CHECK(straight.exit_code == 0);
  CHECK(noether(cut, "run scene.toml --quiet --until '0.77 s'").exit_code == 0);
  const ProcessResult resumed = noether(cut, "run scene.toml --json --resume" + briefly);
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "resumed_from_step") == "77");
  check_same_run(resumed.out, straight.out);
  check_same_content(cut / "scene.out/run.h5", whole / "scene.out/run.h5");
  CHECK(has(straight.out, "\"constraint_residual\":{\"first\":"));
  CHECK(has(straight.out, ",\"constraint\":"));
}

TEST_CASE("a run of molecules across the faces of a box that was interrupted ends as one that was not",
          "[cli][resume][constraints]") {
  const ScratchFolder whole, cut;
  const fs::path tests = fs::path(NOETHER_SOURCE_DIR) / "tests";
  for (const ScratchFolder* folder : {&whole, &cut}) {
    fs::copy(tests / "scenes" / "good" / "rigid_molecules.toml", folder->path() / "scene.toml");
    fs::copy(tests / "data" / "molecules" / "wrapped.data", folder->path());
  }
  const std::string here = " --set particles.structure=wrapped.data";
  const ProcessResult straight = noether(whole, "run scene.toml --json" + here);
  CHECK(straight.exit_code == 0);
  CHECK(noether(cut, "run scene.toml --quiet --until 0.37" + here).exit_code == 0);
  const ProcessResult resumed = noether(cut, "run scene.toml --json --resume" + here);
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "resumed_from_step") == "185");
  check_same_run(resumed.out, straight.out);
  check_same_content(cut / "scene.out/run.h5", whole / "scene.out/run.h5");
}

TEST_CASE("a step too large ends the run by name, at a state that is written and whole", "[cli][constraints]") {
  const PendulumFolder folder;
  const ProcessResult result = noether(folder, "run scene.toml --json --set integrator.step='0.5 s' --until '50 s'");
  CHECK(result.exit_code == 1);
  CHECK(json_member(result.out, "outcome") == "\"constraint_failure\"");
  CHECK(json_member(result.out, "quantity") == "\"constraint\"");
  CHECK(has(result.out, "so the step is too large"));
  const ProcessResult verified = noether(folder, "verify scene.out/checkpoint.h5 --json");
  CHECK(verified.exit_code == 0);
  CHECK(json_member(verified.out, "digest") == json_member(result.out, "digest"));
  // Going on fails again, in the same words.
  const ProcessResult again =
      noether(folder, "run scene.toml --json --resume --set integrator.step='0.5 s' --until '50 s'");
  CHECK(again.exit_code == 1);
  CHECK(json_member(again.out, "message") == json_member(result.out, "message"));
  CHECK(json_member(again.out, "digest") == json_member(result.out, "digest"));
}

TEST_CASE("explain counts constraints and what they leave; describe and list know them", "[cli][constraints]") {
  const PendulumFolder folder;
  const std::string text = output(folder, "explain scene.toml --all");
  CHECK(has(text, "constraint distance, "));
  CHECK(has(text, "equations of constraints solved for positions and for velocities; "));
  CHECK(has(text, "  constraint angle\n"));
  CHECK(has(output(folder, "explain scene.toml --json"), "\"constraints\":"));
  CHECK(has(output(folder, "list constraints"), "rigid_bar"));
  const std::string described = output(folder, "describe distance");
  CHECK(has(described, "distance (constraint): keeps the distance of two particles\n"));
  CHECK(has(described, "belongs in [[hamiltonian.constraint]], with the particles"));
  CHECK(has(described, "@article{RyckaertCiccottiBerendsen1977"));
}

TEST_CASE("explain tells which bonded terms constraints of a structure have taken", "[cli][constraints]") {
  const PendulumFolder folder;
  const std::string scenes = NOETHER_SOURCE_DIR "/tests/scenes/good/";
  const std::string text = output(folder, "explain " + scenes + "hydrogen_bonds.toml");
  CHECK(has(text, "force bonded, without 80 of its 512 terms, which constraints hold\n"));
  CHECK(has(text, "constraint hydrogen_bonds, 80 times\n"));
  CHECK(has(output(folder, "explain " + scenes + "water_flexible.toml"), "force bonded\n"));
}

}  // namespace
}  // namespace noether::test

#endif
