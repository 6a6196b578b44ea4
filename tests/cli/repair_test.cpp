// `noether verify --repair`: what it mends, says and refuses.

#include "io/hdf5_file.hpp"
#include "scene/output_folder.hpp"
#include "tests/cli/support.hpp"
#include "tests/support/damage.hpp"

#include <filesystem>
#include <string>

#if NOETHER_HDF5

namespace noether::test {
namespace {

namespace fs = std::filesystem;

/// Leaves a run as one that was killed after step 80, while it wrote the last of its frames.
void leave_half_a_frame(const SceneFolder& folder) {
  REQUIRE(noether(folder, "run scene.toml --quiet").exit_code == 0);
  make_unfinished(folder / "scene.out");
  const io::Hdf5File file = io::Hdf5File::open_to_append(folder / "scene.out/run.h5");
  file.set_attribute("/noether", "complete", std::int64_t{0});
  io::Hdf5Dataset positions = file.open("/particles/system/position/value");
  positions.resize(positions.rows() - 1);
}

TEST_CASE("a repaired run.h5 is sound, and the run goes on from its checkpoint", "[cli][repair]") {
  const SceneFolder folder, other;
  CHECK(noether(other, "run scene.toml --quiet").exit_code == 0);
  leave_half_a_frame(folder);
  CHECK(output(folder, "verify scene.out/run.h5 --repair") ==
        "scene.out/run.h5: repaired: '/particles/system/velocity/value' cut from 6 rows to 5, the number that all "
        "parts of the frames have\n"
        "scene.out/run.h5: repaired: '/particles/system/position/step' cut from 6 rows to 5, the number that all "
        "parts of the frames have\n"
        "scene.out/run.h5: repaired: '/particles/system/position/time' cut from 6 rows to 5, the number that all "
        "parts of the frames have\n"
        "scene.out/run.h5: repaired: '/noether/digests/frames' cut from 6 rows to 5, the number that all "
        "parts of the frames have\n"
        "scene.out/run.h5: sound, not complete, last step 80\n");
  CHECK(output(folder, "verify scene.out/run.h5") == "scene.out/run.h5: sound, not complete, last step 80\n");
  CHECK(noether(folder, "run scene.toml --quiet --resume").exit_code == 0);
  check_same_content(folder / "scene.out/run.h5", other / "scene.out/run.h5");
}

TEST_CASE("a repair is told as JSON too", "[cli][repair]") {
  const SceneFolder folder;
  leave_half_a_frame(folder);
  const std::string json = output(folder, "verify scene.out/run.h5 --repair --json");
  CHECK(is_json_line(json));
  CHECK(json_member(json, "ok") == "true");
  CHECK(json_member(json, "complete") == "false");
  CHECK(json_member(json, "last_step") == "80");
  CHECK(has(json, "\"damaged\":[]"));
  CHECK(has(json, "\"repaired\":[\"'/particles/system/velocity/value' cut from 6 rows to 5, the number "));
  CHECK(has(output(folder, "verify scene.out/run.h5 --json"), "\"repaired\":[],"));
}

TEST_CASE("a run.h5 that has lost its end is mended, and the file as it was stays beside", "[cli][repair]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const fs::path file = folder / "scene.out/run.h5";
  const std::string whole = read_text(file);
  write_text(file, whole.substr(0, whole.size() - 1));
  CHECK(noether(folder, "verify scene.out/run.h5").exit_code == 3);
  const std::string said = output(folder, "verify scene.out/run.h5 --repair");
  CHECK(has(said, fmt::format("scene.out/run.h5: repaired: the last 1 of {} bytes are missing; the file before the "
                              "repair is kept as 'run.h5.damaged'\n",
                              whole.size())));
  CHECK(has(said, "scene.out/run.h5: sound, not complete, last step "));
  CHECK(read_text(folder / "scene.out/run.h5.damaged").size() == whole.size() - 1);
}

TEST_CASE("what cannot be mended is exit 3, in one line, and is not touched", "[cli][repair][messages]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  damage(folder / "scene.out/checkpoint.h5");
  write_text(folder / "scene.out/run.h5", read_text(folder / "scene.out/run.h5").substr(0, 1000));
  for (const std::string name : {"checkpoint.h5", "run.h5"}) {
    const std::string before = read_text(folder / ("scene.out/" + name));
    const ProcessResult refused = noether(folder, "verify scene.out/" + name + " --repair");
    CHECK(refused.exit_code == 3);
    CHECK(refused.out.empty());
    CHECK(refused.err.starts_with("scene.out/" + name + ": "));
    CHECK(line_count(refused.err) == 1);
    const bool untouched = read_text(folder / ("scene.out/" + name)) == before;
    CHECK(untouched);
  }
}

/// Whether a command ends as the readers of files do.
void check_ends_well(const SceneFolder& folder, const std::string& line) {
  const ProcessResult result = noether(folder, line);
  INFO(line << "\n" << result.out << result.err);
  CHECK((result.exit_code == 0 || result.exit_code == 3));
  CHECK(line_count(result.err) <= 1);
  CHECK((result.exit_code == 0) == result.err.empty());
  if (!result.err.empty()) CHECK(has(result.err, "run.h5"));
}

/// Calls everything that reads a run.h5, or goes on with it, for files that are damaged.
void call_everything(unsigned first, unsigned count) {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
  make_unfinished(folder / "scene.out");
  const std::string good = read_text(folder / "scene.out/run.h5"),
                    checkpoint = read_text(folder / "scene.out/checkpoint.h5");
  for (unsigned number = first; number < first + count; ++number) {
    CAPTURE(number);
    write_text(folder / "scene.out/run.h5", damaged(good, number));
    for (const char* line : {"info scene.out/run.h5", "convert scene.out/run.h5 run.csv", "plot scene.out/run.h5"}) {
      check_ends_well(folder, line);
    }
    if (number % 2 == 0) noether(folder, "verify scene.out/run.h5 --repair");
    const ProcessResult verified = noether(folder, "verify scene.out/run.h5");
    CHECK((verified.exit_code == 0 || verified.exit_code == 3));
    check_ends_well(folder, "run scene.toml --quiet --resume");
    fs::remove_all(folder / "scene.out");
    fs::create_directory(folder / "scene.out");
    write_text(folder / "scene.out/checkpoint.h5", checkpoint);
  }
}

TEST_CASE("every command takes a damaged run.h5, or refuses it in one line", "[cli][damage]") {
  call_everything(1, 10);
}

TEST_CASE("damage that once was taken for a wrong request is an error of the file", "[cli][damage]") {
  call_everything(1227, 1);  // the name of the unit system
  call_everything(1360, 1);
}

TEST_CASE("so it does with hundreds", "[cli][damage][.][nightly]") { call_everything(1000, 120); }

TEST_CASE("what a run is writing is not repaired, and what is not there cannot be", "[cli][repair][messages]") {
  const SceneFolder folder;
  leave_half_a_frame(folder);
  {
    const OutputFolder writing(folder / "scene.out");
    const ProcessResult refused = noether(folder, "verify scene.out/run.h5 --repair");
    CHECK(refused.exit_code == 2);
    CHECK(refused.out.empty());
    CHECK(refused.err == "scene.out: a run is writing to this file; wait for it, then repair\n");
  }
  const ProcessResult missing = noether(folder, "verify nowhere/run.h5 --repair");
  CHECK(missing.exit_code == 3);
  CHECK(missing.err == "nowhere/run.h5: there is no such file\n");
  CHECK_FALSE(fs::exists(folder / "nowhere"));
}

}  // namespace
}  // namespace noether::test

#endif
