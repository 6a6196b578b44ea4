// Runs from another time than 0, output at the times of a list, and two runs compared frame by frame.

#include "io/inspect.hpp"
#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>
#include <vector>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

std::vector<double> times_of(const fs::path& file) {
  std::vector<double> times;
  for (const io::Frame& frame : io::read_frames(file).frames) times.push_back(frame.time);
  return times;
}

const std::string listed = "run scene.toml --quiet --set 'every.trajectory.times=[0.25, 0.26, 0.8, 1]' ";

TEST_CASE("frames stand at the times of a list and nowhere else, with the bits of a run with a cadence",
          "[cli][times]") {
  const SceneFolder folder;
  CHECK(noether(folder, listed + "--out listed").exit_code == 0);
  CHECK(noether(folder, "run scene.toml --quiet --out every --set every.trajectory.steps=1").exit_code == 0);
  CHECK(times_of(folder / "listed/run.h5") == std::vector<double>{0.25, 0.26, 0.8, 1});
  CHECK(output(folder, "verify listed/run.h5") == "listed/run.h5: sound and complete, last step 100\n");
  const std::string compared = output(folder, "verify listed/run.h5 --against every/run.h5");
  CHECK(
      compared.starts_with("listed/run.h5 and every/run.h5: identical bit for bit wherever both have data\n"
                           "  frames: 4 compared, 4 of them equal; 97 only in the second\n"
                           "  angular_momentum: 15 compared, 15 of them equal\n"
                           "  energy: 11 compared, 11 of them equal\n"
                           "  scenes differ first in the lines 'times = [0.25, 0.26, 0.8, 1]' and 'steps = 1'\n"));
}

TEST_CASE("a run is resumed in the middle of its lists", "[cli][times][resume]") {
  const SceneFolder whole, folder;
  CHECK(noether(whole, listed).exit_code == 0);
  CHECK(noether(folder, listed).exit_code == 0);
  make_unfinished(folder / "scene.out");
  CHECK(noether(folder, listed + "--resume").exit_code == 0);
  check_same_content(folder / "scene.out/run.h5", whole / "scene.out/run.h5");
  // The last checkpoint but one is of step 80: nothing of the list has been seen before it, here.
  const std::string late = "run scene.toml --quiet --set 'every.trajectory.times=[0.9, 0.95]' --out late ";
  CHECK(noether(whole, late).exit_code == 0);
  CHECK(noether(folder, late).exit_code == 0);
  make_unfinished(folder / "late");
  CHECK(noether(folder, late + "--resume").exit_code == 0);
  check_same_content(folder / "late/run.h5", whole / "late/run.h5");
  CHECK(times_of(folder / "late/run.h5") == std::vector<double>{90 * 0.01, 95 * 0.01});
  make_unfinished(folder / "late");
  const ProcessResult other =
      noether(folder, "run scene.toml --set 'every.trajectory.times=[0.9]' --out late --resume");
  CHECK(other.exit_code == 2);
  CHECK(other.err.starts_with("--set every.trajectory.times=[0.9]: every.2.times = [0.9] was [0.9, 0.95]; "));
}

TEST_CASE("a monitor that begins later has the samples of one that does not, from then on", "[cli][times]") {
  const SceneFolder late, whole, cut;
  const std::string after = "run scene.toml --quiet --set every.energy.after=0.55 --set every.trajectory.after=0.3 ";
  CHECK(noether(late, after).exit_code == 0);
  CHECK(noether(whole, "run scene.toml --quiet").exit_code == 0);
  const auto samples = [](const fs::path& file, std::size_t monitor) { return io::read_monitors(file)[monitor]; };
  const io::MonitorSeries one = samples(late / "scene.out/run.h5", 1), all = samples(whole / "scene.out/run.h5", 1);
  REQUIRE(one.name == "energy");
  CHECK(one.step == std::vector<std::int64_t>{60, 70, 80, 90, 100});
  const std::vector<double>&some = one.quantities.at("total").second, &every = all.quantities.at("total").second;
  const std::size_t numbers = some.size() / 5;
  REQUIRE(every.size() == 11 * numbers);
  for (std::size_t k = 0; k < some.size(); ++k) CHECK(some[k] == every[6 * numbers + k]);
  CHECK(times_of(late / "scene.out/run.h5") == std::vector<double>{0.4, 0.6, 0.8, 1});
  CHECK(output(late, "verify scene.out/run.h5") == "scene.out/run.h5: sound and complete, last step 100\n");
  // Errors are relative to the first look, so samples differ; frames are those of the other run.
  CHECK(noether(late, "verify scene.out/run.h5 --against " + (whole / "scene.out/run.h5").string())
            .out.find("4 of them equal") != std::string::npos);
  for (const std::string until : {"0.2", "0.7"}) {
    fs::remove_all(cut / "scene.out");
    CHECK(noether(cut, after + "--until " + until).exit_code == (until == "0.2" ? 2 : 0));
    if (until == "0.2") continue;
    CHECK(noether(cut, after + "--resume").exit_code == 0);
    check_same_content(cut / "scene.out/run.h5", late / "scene.out/run.h5");
  }
  make_unfinished(late / "scene.out");
  CHECK(noether(late, after + "--resume").exit_code == 0);
  check_same_content(cut / "scene.out/run.h5", late / "scene.out/run.h5");
  CHECK(output(late, "explain scene.toml --set every.energy.after=0.55")
            .find("monitor energy, every 10 steps, not before 0.55\n") != std::string::npos);
  const ProcessResult beyond = noether(late, "run scene.toml --set every.energy.after=0.95");
  CHECK(beyond.exit_code == 0);  // the end is a sample
  const ProcessResult never = noether(late, "run scene.toml --set every.energy.after=2");
  CHECK(never.exit_code == 2);
  CHECK(never.err.find("after = 2 is beyond the end of the run at 1, so there would be no sample; give an earlier "
                       "time") != std::string::npos);
}

TEST_CASE("a list whose times all come later leaves a whole file from the first step on", "[cli][times]") {
  const SceneFolder folder;
  const std::string never = "run scene.toml --set 'every.trajectory.times=[7]' --json";
  const ProcessResult run = noether(folder, never);
  CHECK(run.exit_code == 0);
  CHECK(json_member(run.out, "warnings") ==
        "[\"1 of 1 time of 'trajectory' lies after the end at 1, so it does not sample then\"]");
  const io::FileInfo info = io::verify(folder / "scene.out/run.h5");
  CHECK(info.damaged == std::vector<std::string>{});
  CHECK(info.frames == 0);
  CHECK(info.complete);
  CHECK(output(folder, "info scene.out/run.h5").find("0 frames") != std::string::npos);
  CHECK(noether(folder, "run scene.toml --quiet --set 'every.trajectory.times=[7]' --until 7 --resume").exit_code == 0);
  CHECK(times_of(folder / "scene.out/run.h5") == std::vector<double>{7});
}

TEST_CASE("a run from another time is the same run with another clock", "[cli][times]") {
  const SceneFolder folder;
  const std::string moved = "run scene.toml --set integrator.start_time=1024 --out moved --json ";
  const std::string report = output(folder, moved);
  CHECK(json_member(report, "time") == "1025");
  CHECK(json_member(report, "start_time") == "1024");
  CHECK(json_member(report, "step") == "100");
  CHECK(json_member(output(folder, "run scene.toml --json --out bare"), "start_time").empty());
  const ProcessResult by_step = noether(folder, "verify moved/run.h5 --against bare/run.h5 --by step --json");
  CHECK(by_step.exit_code == 0);
  CHECK(json_member(by_step.out, "ok") == "true");
  CHECK(json_member(by_step.out, "compared") == "6");
  const ProcessResult by_time = noether(folder, "verify moved/run.h5 --against bare/run.h5");
  CHECK(by_time.exit_code == 3);
  CHECK(
      by_time.out.starts_with("moved/run.h5 and bare/run.h5: the two have nothing in common to compare\n"
                              "  frames: 0 compared, 0 of them equal; 6 only in the first; 6 only in the second\n"));
  make_unfinished(folder / "moved");
  check_same_run(output(folder, moved + "--resume"), report);
  make_unfinished(folder / "moved");
  const ProcessResult elsewhere =
      noether(folder, "run scene.toml --set integrator.start_time=1000 --out moved --resume");
  CHECK(elsewhere.exit_code == 2);
  CHECK(elsewhere.err.starts_with("--set integrator.start_time=1000: integrator.start_time = 1000 was 1024; "));
  CHECK(output(folder, "run scene.toml --set integrator.start_time=1024 --until 1024.5 --out half")
            .starts_with("completed at step 50, time 1024.5\nbegun at time 1024\n"));
}

TEST_CASE("verify names the first frame, sample and number in which two runs differ", "[cli][times]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet --out a").exit_code == 0);
  CHECK(noether(folder, "run scene.toml --quiet --out b").exit_code == 0);
  CHECK(noether(folder, "run scene.toml --quiet --out c --set particles.body.Planet.v=[0,1,1e-12]").exit_code == 0);
  CHECK(output(folder, "verify a/run.h5 --against b/run.h5")
            .starts_with("a/run.h5 and b/run.h5: identical bit for bit wherever both have data\n"
                         "  frames: 6 compared, 6 of them equal\n"));
  const ProcessResult differ = noether(folder, "verify a/run.h5 --against c/run.h5");
  CHECK(differ.exit_code == 3);
  CHECK(differ.out.starts_with("a/run.h5 and c/run.h5: they differ\n  frames: 6 compared, 0 of them equal\n"));
  CHECK(differ.err.find("a/run.h5: frames differ first from c/run.h5 at step 0, time 0: velocity/value, ") !=
        std::string::npos);
  CHECK(differ.err.find("z of particle 1 'Planet'") != std::string::npos);
  const ProcessResult json = noether(folder, "verify a/run.h5 --against c/run.h5 --json");
  CHECK(json.exit_code == 3);
  CHECK(is_json_line(json.out));
  CHECK(json_member(json.out, "ok") == "false");
  CHECK(json_member(json.out, "against") == "\"c/run.h5\"");
  CHECK(json_member(output(folder, "verify a/run.h5 --against b/run.h5 --json"), "ok") == "true");
  const ProcessResult checkpoint = noether(folder, "verify a/run.h5 --against b/checkpoint.h5");
  CHECK(checkpoint.exit_code == 2);
  CHECK(checkpoint.err.starts_with(
      "b/checkpoint.h5 is a checkpoint, which contains one moment only; compare two run.h5"));
  CHECK(noether(folder, "verify a/run.h5 --against nothing.h5").exit_code == 3);
  CHECK(noether(folder, "verify a/run.h5 --by step").exit_code == 2);
  write_text(folder / "b/run.h5", read_text(folder / "b/run.h5").substr(0, 5000));
  CHECK(noether(folder, "verify a/run.h5 --against b/run.h5").exit_code == 3);
}

}  // namespace
}  // namespace noether::test

#endif
