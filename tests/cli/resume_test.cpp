// `noether run --resume`: from which checkpoint, to which end, and what it refuses.

#include "io/checkpoint.hpp"
#include "numbers/simd.hpp"
#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("resuming a finished run prints its report again", "[cli][resume]") {
  const SceneFolder folder;
  const std::string first = noether(folder, "run scene.toml --json").out;
  fs::copy_file(folder / "scene.out/run.h5", folder / "before.h5");
  const ProcessResult again = noether(folder, "run scene.toml --json --resume");
  CHECK(again.exit_code == 0);
  CHECK(json_member(again.out, "resumed_from_step") == "100");
  CHECK(json_member(again.out, "wall_s") == json_member(first, "wall_s"));
  check_same_run(again.out, first);
  CHECK(noether(folder, "run scene.toml --resume").out.starts_with("completed at step 100, time 1\n"));
  check_same_content(folder / "scene.out/run.h5", folder / "before.h5");
  CHECK_FALSE(fs::exists(folder / "scene.out.1"));
}

TEST_CASE("a finished run goes on to a later end as one long run", "[cli][resume]") {
  const SceneFolder folder, other;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const ProcessResult longer = noether(folder, "run scene.toml --json --resume --until 3.33");
  CHECK(longer.exit_code == 0);
  CHECK(json_member(longer.out, "resumed_from_step") == "100");
  check_same_run(longer.out, noether(other, "run scene.toml --json --until 3.33").out);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
}

TEST_CASE("an end before the checkpoint is refused", "[cli][resume][messages]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const ProcessResult result = noether(folder, "run scene.toml --resume --until 0.5");
  CHECK(result.exit_code == 2);
  CHECK(result.err ==
        "scene.toml: the end at step 50 lies before the checkpoint at step 100; give a later one, or --fresh\n");
}

TEST_CASE("a changed key is named and refused", "[cli][resume][messages]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  make_unfinished(folder / "scene.out");
  const std::string advice =
      "; a resumed run may change only its end, to a later one: undo this, or start over with --fresh\n";
  const auto refusal = [&](const std::string& set) {
    const ProcessResult result = noether(folder, "run scene.toml --resume " + set);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    REQUIRE(result.err.ends_with(advice));
    return result.err.substr(0, result.err.size() - advice.size());
  };
  CHECK(refusal("--set integrator.step=0.02") == "--set integrator.step=0.02: integrator.step = 0.02 was 0.01");
  CHECK(refusal("--set integrator.method=verlet") ==
        "--set integrator.method=verlet: integrator.method = \"verlet\" was \"yoshida_4\"");
  CHECK(refusal("--set every.trajectory.steps=10") == "--set every.trajectory.steps=10: every.2.steps = 10 was 20");
  CHECK(refusal("--set hamiltonian.force.gravity.softening=0.1") ==
        "--set hamiltonian.force.gravity.softening=0.1: hamiltonian.force.0.softening = 0.1 was 0.0");
  std::string text = two_bodies;
  text.replace(text.find("mass = 0.001"), 12, "mass = 0.002");
  write_text(folder / "scene.toml", text);
  CHECK(refusal("") == "scene.toml:10: particles.body.1.mass = 0.002 was 0.001");
  write_text(folder / "scene.toml", two_bodies + "[[every]]\ntype = \"momentum\"\nsteps = 1\n");
  CHECK(refusal("").find(": every.4.") != std::string::npos);
  write_text(folder / "scene.toml", two_bodies);
  CHECK(noether(folder, "run scene.toml --quiet --resume --set 'title=Another name'").exit_code == 0);
}

TEST_CASE("a run of an earlier version, which looked for escapes at every hundredth step, goes on", "[cli][resume]") {
  std::string adaptive = two_bodies;
  adaptive = adaptive.substr(0, adaptive.find("[integrator]")) +
             "[integrator]\nmethod = \"dop853\"\nuntil = 1\n[[stop]]\ntype = \"escape\"\ndistance = 100\n";
  const SceneFolder folder(adaptive + "steps = 100\n");
  REQUIRE(noether(folder, "run scene.toml --quiet").exit_code == 0);
  write_text(folder / "scene.toml", adaptive);
  const ProcessResult result = noether(folder, "run scene.toml --resume --until 2");
  CHECK(result.exit_code == 0);
  CHECK(has(result.out, "warning: stop.0.steps was 100, the default of an earlier version; from here on it is 1"));
  write_text(folder / "scene.toml", adaptive + "steps = 1\n");
  CHECK(noether(folder, "run scene.toml --resume --until 3").exit_code == 0);
}

TEST_CASE("without any checkpoint --resume starts afresh", "[cli][resume]") {
  const SceneFolder folder;
  const ProcessResult first = noether(folder, "run scene.toml --json --resume");
  CHECK(first.exit_code == 0);
  CHECK(json_member(first.out, "resumed_from_step") == "null");
  fs::remove(folder / "scene.out/checkpoint.h5");
  fs::remove(folder / "scene.out/checkpoint.previous.h5");
  write_text(folder / "scene.out/run.h5", "killed before its first checkpoint");
  const ProcessResult second = noether(folder, "run scene.toml --json --resume");
  CHECK(second.exit_code == 0);
  CHECK(json_member(second.out, "resumed_from_step") == "null");
  check_same_run(second.out, first.out);
}

TEST_CASE("a damaged newest checkpoint gives way to the one before", "[cli][resume]") {
  const SceneFolder folder, other;
  const std::string first = noether(folder, "run scene.toml --json").out;
  CHECK(noether(other, "run scene.toml --quiet").exit_code == 0);
  damage(folder / "scene.out/checkpoint.h5");
  const ProcessResult resumed = noether(folder, "run scene.toml --json --resume");
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "resumed_from_step") == "80");
  check_same_run(resumed.out, first);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
}

TEST_CASE("only damaged checkpoints exit 3, named, with the way out", "[cli][resume][messages]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  damage(folder / "scene.out/checkpoint.h5");
  write_text(folder / "scene.out/checkpoint.previous.h5", "nothing of value");
  const ProcessResult result = noether(folder, "run scene.toml --resume");
  INFO(result.err);
  CHECK(result.exit_code == 3);
  CHECK(line_count(result.err) == 1);
  CHECK(result.err.starts_with("scene.out: no valid checkpoint to resume from ("));
  CHECK(result.err.find("scene.out/checkpoint.h5: ") != std::string::npos);
  CHECK(result.err.find("scene.out/checkpoint.previous.h5: ") != std::string::npos);
  CHECK(result.err.ends_with("; start over with --fresh\n"));
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 2);
  CHECK(noether(folder, "run scene.toml --quiet --fresh").exit_code == 0);
}

TEST_CASE("a run goes on at the SIMD level it began with", "[cli][resume][messages]") {
  const SceneFolder folder;
  const ProcessResult base = noether(folder, "run scene.toml --json --simd base");
  CHECK(base.exit_code == 0);
  CHECK(json_member(base.out, "simd") == "\"base\"");
  make_unfinished(folder / "scene.out");
  if (has_simd_level(SimdLevel::avx2)) {
    const ProcessResult other = noether(folder, "run scene.toml --resume --simd avx2");
    CHECK(other.exit_code == 2);
    CHECK(other.err ==
          "scene.toml: the run was made at SIMD level 'base', not 'avx2'; leave --simd out, or give --fresh\n");
  }
  const ProcessResult resumed = noether(folder, "run scene.toml --resume --json");
  CHECK(resumed.exit_code == 0);
  CHECK(json_member(resumed.out, "simd") == "\"base\"");
  CHECK(json_member(resumed.out, "digest") == json_member(base.out, "digest"));
}

TEST_CASE("a SIMD level that the processor lacks is refused", "[cli][run][messages]") {
  if (has_simd_level(SimdLevel::avx512)) {
    WARN("skipped: this processor has every level");
    return;
  }
  const SceneFolder folder;
  const ProcessResult result = noether(folder, "run scene.toml --simd avx512");
  CHECK(result.exit_code == 2);
  CHECK(result.err == "SIMD level 'avx512' is not supported by this processor; its highest is '" +
                          std::string(name(simd_level())) + "'\n");
}

TEST_CASE("a run begun before correctors and kernels existed goes on, for scenes without them are stored as before",
          "[cli][resume]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const std::string stored = io::read_checkpoint(folder / "scene.out/checkpoint.h5").scene_toml;
  CHECK(has(stored, "compensated"));
  for (const char* key : {"corrector", "kernel"}) CHECK_FALSE(has(stored, key));
  const std::string plain =
      " --set integrator.corrector=0 --set integrator.kernel=plain --set integrator.second_corrector=false";
  const ProcessResult on = noether(folder, "run scene.toml --json --resume --set integrator.steps=200" + plain);
  INFO(on.err);
  CHECK(on.exit_code == 0);
  CHECK(json_member(on.out, "time") == "2");
}

TEST_CASE("a run begun when particles had an absolute tolerance by default goes on, and says so",
          "[cli][resume][messages]") {
  std::string scene = two_bodies;
  const std::string fixed = "method = \"yoshida_4\"\nstep = 0.01\nsteps = 100\n";
  scene.replace(scene.find(fixed), fixed.size(), "method = \"dop853\"\nuntil = 1\n");
  const auto begun_with = [&](const SceneFolder& folder, const std::string& line) {
    CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
    const fs::path file = folder / "scene.out/checkpoint.h5";
    io::Checkpoint checkpoint = io::read_checkpoint(file);
    const std::string head = "[integrator]\n";
    const std::size_t at = checkpoint.scene_toml.find(head);
    REQUIRE(at != std::string::npos);
    REQUIRE_FALSE(has(checkpoint.scene_toml, "atol"));
    checkpoint.scene_toml.insert(at + head.size(), line);
    io::write_checkpoint(file, checkpoint);
    return noether(folder, "run scene.toml --json --resume --until 2");
  };
  const SceneFolder folder, other;
  write_text(folder / "scene.toml", scene);
  write_text(other / "scene.toml", scene);
  const ProcessResult on = begun_with(folder, "atol = 1e-09\n");
  INFO(on.err);
  CHECK(on.exit_code == 0);
  CHECK(json_member(on.out, "time") == "2");
  CHECK(has(on.out,
            "the run was begun with integrator.atol = 1e-09, the default of an earlier version; from here on "
            "errors of particles are measured in a different way, without it (docs/theory/adaptive_steps.md)"));
  CHECK_FALSE(has(noether(folder, "run scene.toml --json --resume --until 3").out, "earlier version"));
  const ProcessResult refused = begun_with(other, "atol = 1e-07\n");
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "integrator.atol = 1e-07 is missing now; a resumed run may change only its end"));
}

}  // namespace
}  // namespace noether::test

#endif
