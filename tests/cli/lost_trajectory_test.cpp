// A run.h5 that is cut short, damaged or gone beside a sound checkpoint: the run goes on, and says what became of it.
// And the frame at a stop, and frames that new scenes start from, as the program has them.

#include "tests/cli/support.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

/// A run that was killed after the checkpoint of step 80, and what it should come to.
struct KilledRun {
  KilledRun() {
    whole = output(folder, "run scene.toml --json");
    make_unfinished(folder / "scene.out");
  }
  fs::path file() const { return folder / "scene.out/run.h5"; }

  SceneFolder folder;
  std::string whole;
};

/// Cuts the last `bytes` bytes off.
void shorten(const fs::path& file, std::size_t bytes) { fs::resize_file(file, fs::file_size(file) - bytes); }

}  // namespace

TEST_CASE("a run goes on beside a run.h5 that was cut short, wherever, and keeps what there is",
          "[cli][resume][lost]") {
  const auto whole_size = static_cast<std::size_t>(fs::file_size(KilledRun().file()));
  for (const std::size_t bytes : {std::size_t{1}, whole_size / 3, whole_size - 1000, whole_size}) {
    CAPTURE(bytes);
    const KilledRun run;
    shorten(run.file(), bytes);
    const std::string kept = read_text(run.file());
    const std::string resumed = output(run.folder, "run scene.toml --json --resume");
    check_same_run(resumed, run.whole);  // the report, monitors and all, is that of the run that was never cut
    CHECK(json_member(resumed, "resumed_from_step") == "80");
    CHECK(has(resumed,
              "; a new one begins at step 80, and the old one is scene.out/run.h5.damaged: 'noether verify "
              "--repair scene.out/run.h5.damaged' repairs it if only frames or samples are missing"));
    const bool untouched = read_text(run.folder / "scene.out/run.h5.damaged") == kept;
    CHECK(untouched);
    CHECK(output(run.folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
    CHECK(json_member(output(run.folder, "info scene.out/run.h5 --json"), "frames") == "1");
  }
}

TEST_CASE("what is whole of a run.h5 that was set aside comes back by the command that was named",
          "[cli][resume][repair][lost]") {
  const KilledRun run;
  shorten(run.file(), 1);
  const std::string said = output(run.folder, "run scene.toml --resume");
  CHECK(has(said, "\nwarning: scene.out/run.h5: "));
  CHECK(has(output(run.folder, "verify --repair scene.out/run.h5.damaged"), "scene.out/run.h5.damaged: sound, not "));
  CHECK(std::stoi(json_member(output(run.folder, "info scene.out/run.h5.damaged --json"), "frames")) >= 4);
}

TEST_CASE("a run.h5 of fewer frames than the checkpoint counts on, or none at all, does not end a run",
          "[cli][resume][lost]") {
  const KilledRun other;
  const SceneFolder shorter;
  CHECK(noether(shorter, "run scene.toml --quiet --until 0.3").exit_code == 0);
  fs::copy_file(shorter / "scene.out/run.h5", other.file(), fs::copy_options::overwrite_existing);
  const std::string resumed = output(other.folder, "run scene.toml --json --resume");
  check_same_run(resumed, other.whole);
  CHECK(has(resumed, "rows where the saved run expects "));

  const KilledRun gone;
  fs::remove(gone.file());
  const std::string anew = output(gone.folder, "run scene.toml --json --resume");
  check_same_run(anew, gone.whole);
  CHECK(has(anew, "the trajectory that the saved run continues is missing"));
  CHECK(has(anew, "; a new one begins at step 80\""));
  CHECK(output(gone.folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
}

TEST_CASE("a run that is killed again before its next checkpoint writes nothing twice", "[cli][resume][lost]") {
  const KilledRun run;
  fs::remove(run.file());
  check_same_run(output(run.folder, "run scene.toml --json --resume"), run.whole);
  for (int kill = 0; kill < 2; ++kill) {  // each falls back by one generation of checkpoints
    make_unfinished(run.folder / "scene.out");
    const std::string again = output(run.folder, "run scene.toml --json --resume");
    check_same_run(again, run.whole);
    CHECK(json_member(again, "resumed_from_step") == "80");
    CHECK(json_member(again, "warnings").empty());
    CHECK(json_member(output(run.folder, "info scene.out/run.h5 --json"), "frames") == "1");
    CHECK(output(run.folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
  }
  CHECK_FALSE(fs::exists(run.folder / "scene.out/run.h5.damaged"));
}

TEST_CASE("a run that writes samples alone goes on with a new run.h5 too", "[cli][resume][lost]") {
  std::string text = two_bodies;
  const std::string frames = "[[every]]\ntype = \"trajectory\"\nsteps = 20\n";
  text.erase(text.find(frames), frames.size());
  const SceneFolder folder(text);
  const std::string whole = output(folder, "run scene.toml --json");
  make_unfinished(folder / "scene.out");
  fs::remove(folder / "scene.out/run.h5");
  check_same_run(output(folder, "run scene.toml --json --resume"), whole);
  CHECK(output(folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
  CHECK(has(output(folder, "info scene.out/run.h5"), "energy: 2 samples of "));  // of steps 90 and 100
}

TEST_CASE("a finished run with a damaged run.h5 prints its report, and names the way", "[cli][resume][lost]") {
  const SceneFolder folder;
  const std::string whole = output(folder, "run scene.toml --json");
  shorten(folder / "scene.out/run.h5", 1);
  const std::string again = output(folder, "run scene.toml --json --resume");
  check_same_run(again, whole);
  CHECK(has(again,
            "; the run is finished: 'noether verify --repair scene.out/run.h5' repairs it if only frames or samples "
            "are missing\""));
  CHECK(has(output(folder, "verify --repair scene.out/run.h5"), "scene.out/run.h5: sound, not complete"));
}

TEST_CASE("the state at a stop is the last frame, and that of a run that fails", "[cli][run][last_frame]") {
  std::string text = two_bodies;
  text.replace(text.find("v = [0, 1, 0]"), 13, "v = [9, 0, 0]");
  const SceneFolder folder(text + "[[stop]]\ntype = \"escape\"\ndistance = 2\nsteps = 5\n");
  const std::string stopped = output(folder, "run scene.toml --json");
  CHECK(json_member(stopped, "outcome") == "\"stopped\"");
  CHECK(json_member(stopped, "step") == "15");  // frames are due every 20 steps
  const std::string info = output(folder, "info scene.out/run.h5 --json");
  CHECK(json_member(info, "frames") == "2");
  CHECK(json_member(info, "last_step") == "15");
  CHECK(json_member(info, "digest") == json_member(stopped, "digest"));

  // A method that chooses its steps, looked at when the run ends: from the apocenter of a = 1, e = 1/2 to its
  // pericenter.
  std::string falling = two_bodies.substr(0, two_bodies.find("[[every]]"));
  for (const auto& [old, by] : {std::pair("mass = 0.001", "mass = 0"), std::pair("x = [1, 0, 0]", "x = [1.5, 0, 0]"),
                                std::pair("v = [0, 1, 0]", "v = [0, 0.5773502691896257, 0]"),
                                std::pair("yoshida_4", "dop853"), std::pair("step = 0.01\nsteps = 100", "until = 3")})
    falling.replace(falling.find(old), std::string(old).size(), by);
  for (const std::string every : {"3", "0.7"}) {
    CAPTURE(every);
    const SceneFolder last(falling + "[[every]]\ntype = \"trajectory\"\nevery = " + every +
                           "\n[[stop]]\ntype = \"collision\"\ndistance = 0.6\n");
    const std::string report = output(last, "run scene.toml --json");
    CHECK(json_member(report, "outcome") == "\"stopped\"");
    CHECK(json_member(output(last, "info scene.out/run.h5 --json"), "digest") == json_member(report, "digest"));
    CHECK(json_member(output(last, "run scene.toml --json --resume"), "digest") == json_member(report, "digest"));
  }

  const SceneFolder failing(exploding + "[[every]]\ntype = \"trajectory\"\nsteps = 1000\n");
  const ProcessResult failed = noether(failing, "run scene.toml --json");
  CHECK(failed.exit_code == 1);
  const std::string left = output(failing, "info scene.out/run.h5 --json");
  CHECK(json_member(left, "frames") == "2");
  CHECK(json_member(left, "digest") == json_member(failed.out, "digest"));
  CHECK(output(failing, "verify scene.out/run.h5").starts_with("scene.out/run.h5: sound, not complete, last step "));
}

TEST_CASE("a run that was killed before it stopped has the same last frame", "[cli][resume][last_frame]") {
  std::string text = two_bodies;
  text.replace(text.find("v = [0, 1, 0]"), 13, "v = [2, 0, 0]");
  text += "[[stop]]\ntype = \"escape\"\ndistance = 1.9\nsteps = 1\n";
  const SceneFolder folder(text), other(text);
  const std::string whole = output(folder, "run scene.toml --json");
  CHECK(json_member(whole, "outcome") == "\"stopped\"");
  CHECK(std::stoi(json_member(whole, "step")) % 20 != 0);
  output(other, "run scene.toml --json");
  make_unfinished(other / "scene.out");
  const std::string resumed = output(other, "run scene.toml --json --resume");
  CHECK(json_member(resumed, "resumed_from_step") == "40");
  CHECK(json_member(resumed, "digest") == json_member(whole, "digest"));
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
}

TEST_CASE("a new scene starts from a frame, by the run.h5 itself or by what convert --bodies makes of it",
          "[cli][bodies]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --json");
  const std::string rest = two_bodies.substr(two_bodies.find("[hamiltonian]"));
  const auto start = [&](const std::string& particles) {
    write_text(folder / "next.toml", "units = \"reduced\"\n[particles]\n" + particles + rest);
    output(folder, "run next.toml --quiet");
    output(folder, "convert next.out/run.h5 next.csv");
    const std::vector<std::string> lines = lines_of(read_text(folder / "next.csv"));
    fs::remove_all(folder / "next.out");
    return lines.at(1) + "\n" + lines.at(2);
  };
  const std::string from_frame = start("bodies = \"scene.out/run.h5\"\nframe = 3\n");
  output(folder, "convert scene.out/run.h5 all.csv");
  const std::vector<std::string> all = lines_of(read_text(folder / "all.csv"));
  // Frame 3 is of step 60; the new run begins at step 0 and time 0.
  CHECK(from_frame ==
        "0,0" + all.at(7).substr(all.at(7).find(",0,Sun")) + "\n0,0" + all.at(8).substr(all.at(8).find(",1,Planet")));
  for (const std::string name : {"start.csv", "start.h5"}) {
    CHECK(output(folder, "convert scene.out/run.h5 " + name + " --bodies --frame 3").empty());
    CHECK(start("bodies = \"" + name + "\"\n") == from_frame);
  }
  CHECK(start("bodies = \"scene.out/run.h5\"\n") == start("bodies = \"scene.out/run.h5\"\nframe = 5\n"));
  CHECK(output(folder, "convert scene.out/run.h5 start.h5 --bodies --json") ==
        "{\"schema\":\"noether.convert/1\",\"frames\":1,\"file\":\"start.h5\"}\n");
}

TEST_CASE("frames that are not there are exit 2 with their range", "[cli][bodies][messages]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --json");
  const ProcessResult converted = noether(folder, "convert scene.out/run.h5 start.csv --bodies --frame 6");
  CHECK(converted.exit_code == 2);
  CHECK(converted.err == "scene.out/run.h5: frame = 6, but 'run.h5' has 6 frames: 0 to 5, or -1 for the last\n");
  CHECK_FALSE(fs::exists(folder / "start.csv"));
  const ProcessResult alone = noether(folder, "convert scene.out/run.h5 start.csv --frame 6");
  CHECK(alone.exit_code == 2);
  CHECK(has(alone.err, "--bodies"));
}

TEST_CASE("a run that began with the last frame of one that has gone on since names the frame",
          "[cli][resume][bodies]") {
  const SceneFolder folder;
  output(folder, "run scene.toml --json");
  write_text(folder / "next.toml", "units = \"reduced\"\n[particles]\nbodies = \"scene.out/run.h5\"\n" +
                                       two_bodies.substr(two_bodies.find("[hamiltonian]")));
  const std::string whole = output(folder, "run next.toml --json");
  output(folder, "run scene.toml --json --resume --until 1.4");
  make_unfinished(folder / "next.out");
  const ProcessResult refused = noether(folder, "run next.toml --resume");
  CHECK(refused.exit_code == 2);
  CHECK(line_count(refused.err) == 1);
  CHECK(has(refused.err,
            "the run began with frame 5 of \"scene.out/run.h5\", but this would be frame 7; give frame = 5 "
            "in [particles], or start over with --fresh\n"));
  check_same_run(output(folder, "run next.toml --json --resume --set particles.frame=5"), whole);
}

}  // namespace noether::test

#endif
