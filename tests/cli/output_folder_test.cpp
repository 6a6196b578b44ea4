// `noether run`: where its files stand, and what becomes of those that stand there already.

#include "scene/output_folder.hpp"
#include "tests/cli/support.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <string>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("a folder in use is refused", "[cli][run][messages]") {
  const SceneFolder folder(unwritten);
  fs::create_directory(folder / "scene.out");
  const int lock = ::open((folder / "scene.out/.lock").c_str(), O_RDWR | O_CREAT, 0600);
  REQUIRE(lock >= 0);
  REQUIRE(::flock(lock, LOCK_EX | LOCK_NB) == 0);
  const ProcessResult result = noether(folder, "run scene.toml");
  ::close(lock);
  CHECK(result.exit_code == 2);
  CHECK(result.err ==
        "scene.out: another run is writing to this folder; wait for it, or give another folder with --out\n");
  CHECK(noether(folder, "run scene.toml --quiet").exit_code == 0);
}

TEST_CASE("a folder that cannot be made exits 3", "[cli][run][messages]") {
  const SceneFolder folder(unwritten);
  const ProcessResult result = noether(folder, "run scene.toml --out scene.toml/out --json");
  CHECK(result.exit_code == 3);
  CHECK(result.err == "scene.toml/out: the output folder cannot be made: Not a directory\n");
  CHECK(result.out ==
        R"({"schema":"noether.error/1","exit_code":3,"file":"scene.toml/out","line":null,"key":null,"value":null,)"
        R"("message":"the output folder cannot be made: Not a directory"})"
        "\n");
}

#if NOETHER_HDF5

TEST_CASE("files stand in NAME.out of the working folder, or where --out says", "[cli][run]") {
  const SceneFolder folder;
  fs::create_directory(folder / "below");
  fs::rename(folder / "scene.toml", folder / "below/scene.toml");
  fs::copy_file(folder / "below/scene.toml", folder / "below/orbit.toml");
  const std::string json = noether(folder, "run below/scene.toml --json").out;
  CHECK(json_member(json, "files") == R"({"trajectory":"below.out/run.h5","checkpoint":"below.out/checkpoint.h5"})");
  const std::string other = noether(folder, "run below/orbit.toml --json").out;
  CHECK(json_member(other, "files") == R"({"trajectory":"orbit.out/run.h5","checkpoint":"orbit.out/checkpoint.h5"})");
  CHECK(noether(folder, "run below/scene.toml --quiet --out deep/er/").exit_code == 0);
  for (const char* out : {"below.out", "orbit.out", "deep/er"}) {
    for (const char* file : {"run.h5", "checkpoint.h5", "checkpoint.previous.h5"}) {
      CHECK(fs::file_size(folder / out / file) > 0);
    }
  }
  CHECK(std::distance(fs::directory_iterator(folder / "below"), {}) == 2);
  CHECK(default_output_folder("below/../kepler/scene.toml") == "kepler.out");
  CHECK(default_output_folder((folder / "scene.toml").string()) == "scene.out");
  CHECK(default_output_folder("scene.toml") == fs::current_path().filename().string() + ".out");
  CHECK(default_output_folder("../a/own.scene") == "own.scene.out");
}

TEST_CASE("a scene in the place of its run is told from the folder that it is in", "[cli][run][messages]") {
  const SceneFolder folder("");
  std::filesystem::create_directory(folder / "orbits");
  write_text(folder / "orbits/scene.toml", two_bodies);
  const auto inside = [&](std::string_view line) { return run_process(command(line), folder / "orbits"); };
  REQUIRE(inside("run scene.toml --quiet").exit_code == 0);
  for (const char* scene : {"scene.toml", "./scene.toml", "../orbits/scene.toml"}) {
    CHECK(has(inside(std::string("info ") + scene).err, "did you mean 'orbits.out/run.h5'?"));
  }
}

TEST_CASE("a finished run is moved away, also one that was stopped or diverged", "[cli][run]") {
  const SceneFolder folder(exploding);
  CHECK(noether(folder, "run scene.toml").exit_code == 1);
  write_text(folder / "scene.toml", two_bodies);
  const std::string first = noether(folder, "run scene.toml --json").out;
  CHECK(noether(folder, "run scene.toml --quiet --until 2").exit_code == 0);
  CHECK(noether(folder, "run scene.toml --quiet --fresh").exit_code == 0);
  CHECK(noether(folder, "info scene.out.1/checkpoint.h5").out.find("of a run that is diverged") != std::string::npos);
  CHECK(noether(folder, "info scene.out.2/run.h5 --json").out.find(json_member(first, "digest")) != std::string::npos);
  CHECK(json_member(noether(folder, "info scene.out.3/run.h5 --json").out, "last_step") == "200");
  CHECK(json_member(noether(folder, "info scene.out/run.h5 --json").out, "last_step") == "100");
}

TEST_CASE("that a finished run was moved is told in one line, unless nothing is to be said", "[cli][run][messages]") {
  const SceneFolder folder;
  CHECK(noether(folder, "run scene.toml").err.empty());
  const std::string moved = "note: the finished run in scene.out was moved to scene.out.";
  CHECK(noether(folder, "run scene.toml").err == moved + "1\n");
  const ProcessResult json = noether(folder, "run scene.toml --json");
  CHECK(json.err == moved + "2\n");
  CHECK(has(json.out, R"("notes":["the finished run in scene.out was moved to scene.out.2"])"));
  CHECK(noether(folder, "run scene.toml --quiet").err.empty());
  CHECK(fs::exists(folder / "scene.out.3/run.h5"));
  const std::string absolute = (folder / "b").string();
  CHECK(noether(folder, "run scene.toml --quiet --out " + absolute).exit_code == 0);
  CHECK(noether(folder, "run scene.toml --out " + absolute).err ==
        "note: the finished run in " + absolute + " was moved to " + absolute + ".1\n");
}

TEST_CASE("an unfinished run is kept until --fresh discards it", "[cli][run][messages]") {
  const SceneFolder folder;
  REQUIRE(noether(folder, "run scene.toml --quiet").exit_code == 0);
  make_unfinished(folder / "scene.out");
  const std::string before = read_text(folder / "scene.out/run.h5");
  const ProcessResult refused = noether(folder, "run scene.toml");
  CHECK(refused.exit_code == 2);
  CHECK(refused.out.empty());
  CHECK(
      refused.err ==
      "scene.out: there is an unfinished run here at step 80; continue it with --resume, or start over with --fresh\n");
  CHECK(read_text(folder / "scene.out/run.h5") == before);
  const ProcessResult fresh = noether(folder, "run scene.toml --fresh --json");
  CHECK(fresh.exit_code == 0);
  CHECK(json_member(fresh.out, "resumed_from_step") == "null");
  CHECK_FALSE(fs::exists(folder / "scene.out.1"));
}

TEST_CASE("a full disk exits 3 and names the file", "[cli][run][messages]") {
  const SceneFolder folder;
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit small{200'000, before.rlim_max};  // stands for a full disk, in this process and those it starts
  ::setrlimit(RLIMIT_FSIZE, &small);
  const ProcessResult result = noether(folder, "run scene.toml --set every.trajectory.steps=1 --until 1000 --json");
  ::setrlimit(RLIMIT_FSIZE, &before);
  CHECK(result.exit_code == 3);
  CHECK(result.err.starts_with("scene.out/run.h5: cannot write "));
  CHECK(result.err.ends_with(": File too large\n"));
  CHECK(is_json_line(result.out));
  CHECK(json_member(result.out, "file") == "\"scene.out/run.h5\"");
  CHECK(noether(folder, "run scene.toml --fresh --quiet").exit_code == 0);
}

#else

TEST_CASE("a scene that asks for files is refused where there can be none", "[cli][run][messages]") {
  const SceneFolder folder;
  const ProcessResult result = noether(folder, "run scene.toml");
  CHECK(result.exit_code == 3);
  CHECK(result.err.find("this build has no HDF5") != std::string::npos);
}

#endif

}  // namespace
}  // namespace noether::test
