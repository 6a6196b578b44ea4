// `noether ensemble` and `noether merge`: what they say, their exit codes, and what they leave when they are killed.

#include "numbers/random.hpp"
#include "tests/cli/support.hpp"
#include "tests/ensemble/support.hpp"

#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <string>

namespace noether::test {
namespace {

const std::string vary = " --vary particles.body.c.a=1.2:1.8:5 --vary particles.body.c.e=0:1.05:4";

TEST_CASE("ensemble writes a table and says what has become of its members, failed ones included", "[cli][ensemble]") {
  const SceneFolder folder(planets());
  const std::string text = output(folder, "ensemble scene.toml" + vary);
  INFO(text);
  CHECK(text.starts_with("20 members: "));
  CHECK(has(text, "5 refused"));
  CHECK(has(text, "refused: --set particles.body.c.e=1.05: "));
  CHECK(has(text, "wrote scene.ensemble.h5\nsha256:"));
  const std::string again = output(folder, "ensemble scene.toml --json" + vary);
  CHECK(is_json_line(again));
  CHECK(json_member(again, "schema") == "\"noether.ensemble/1\"");
  CHECK(json_member(again, "done_before") == "20");
  CHECK(has(text, json_member(again, "digest").substr(1, 71)));
  const std::string info = output(folder, "info scene.ensemble.h5 --json");
  CHECK(is_json_line(info));
  CHECK(json_member(info, "kind") == "\"ensemble\"");
  for (const char* key : {"members", "outcomes", "digest"}) CHECK(json_member(info, key) == json_member(again, key));
  CHECK(has(output(folder, "info scene.ensemble.h5"), "  5 refused\n"));
}

TEST_CASE("what of the scene is taken otherwise than written is told once, not once a member", "[cli][ensemble]") {
  const SceneFolder folder(replaced(planets(), "steps = 200", "until = 10.03"));
  const ProcessResult result = noether(folder, "ensemble scene.toml" + vary);
  CHECK(result.exit_code == 0);
  CHECK(line_count(result.err) == 1);
  CHECK(has(result.err, "is 100.3 steps of 0.1"));
}

TEST_CASE("shards are those that are asked for, or those of mpirun, mpiexec and srun", "[cli][ensemble]") {
  const SceneFolder folder(planets());
  output(folder, "ensemble scene.toml --out whole.h5" + vary);
  output(folder, "ensemble scene.toml --out map.h5 --shard 0/3" + vary);
  const auto launched = [&](const std::string& variables, int shard) {
    const ProcessResult result =
        run_process({"/bin/sh", "-c",
                     fmt::format("env {} {} ensemble scene.toml --out map.h5 {}", variables, NOETHER_PROGRAM, vary)},
                    folder.path());
    INFO(result.err);
    CHECK(result.exit_code == 0);
    CHECK(has(result.err, fmt::format("says that this is shard {} of ", shard)));
  };
  launched("OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=3", 1);
  launched("SLURM_PROCID=2 SLURM_NTASKS=3", 2);
  CHECK(
      has(output(folder, "merge map.h5.0-of-3 map.h5.1-of-3 map.h5.2-of-3 --out map.h5"), "20 members of 3 shards\n"));
  CHECK(read_text(folder / "map.h5") == read_text(folder / "whole.h5"));
  launched("PMI_RANK=1 PMI_SIZE=2", 1);
  const ProcessResult missing = noether(folder, "merge map.h5.1-of-2 --out map.h5");
  CHECK(missing.exit_code == 2);
  CHECK(missing.err == "of 2 shards 0 is missing; run it first, by --shard 0/2\n");
}

TEST_CASE("two processes of Open MPI's mpirun and of MPICH's, where they are installed, make two shards",
          "[cli][ensemble][slow]") {
  const SceneFolder folder(planets());
  const auto shell = [&](const std::string& line) {
    // The variables let Open MPI start two processes on one processor, as any user; MPICH asks for neither.
    return run_process({"/bin/sh", "-c",
                        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                        "OMPI_MCA_rmaps_base_oversubscribe=1 " +
                            line},
                       folder.path());
  };
  output(folder, "ensemble scene.toml --out whole.h5" + vary);
  for (const std::string launcher : {"mpirun.openmpi", "mpirun.mpich"}) {
    if (shell("command -v " + launcher).exit_code != 0) {
      WARN(launcher << " is not installed: two shards by it are left out");
      continue;
    }
    const std::string map = launcher + ".h5";
    const ProcessResult made = shell(
        fmt::format("{} -n 2 {} ensemble scene.toml --out {} --threads 1{}", launcher, NOETHER_PROGRAM, map, vary));
    INFO(made.out << made.err);
    REQUIRE(made.exit_code == 0);
    CHECK(has(made.err, "says that this is shard 1 of 2"));
    output(folder, fmt::format("merge {0}.0-of-2 {0}.1-of-2 --out {0}", map));
    CHECK(read_text(folder / map) == read_text(folder / "whole.h5"));
  }
}

TEST_CASE("what an ensemble cannot be made of is refused in one line", "[cli][ensemble]") {
  const SceneFolder folder(planets());
  const auto refused = [&](const std::string& arguments, const std::string& why, int code = 2) {
    const ProcessResult result = noether(folder, "ensemble scene.toml " + arguments);
    INFO(arguments << "\n" << result.out << result.err);
    CHECK(result.exit_code == code);
    CHECK(line_count(result.err) == 1);
    CHECK(has(result.err, why));
  };
  refused("--vary particles.body.d.a=1:2:3", "--vary particles.body.d.a=1:2:3: there is no 'd' in the scene");
  refused("--vary particles.body.c.aa=1:2:3", "unknown key 'aa' in body 'c'; did you mean 'a'?");
  refused("--vary a=1:2:3", "did you mean 'particles.body.b.a' or 'particles.body.c.a'?");
  refused("--vary particles.body.c.name=1:2:3", "particles.body.c.name = \"c\" is a text, which cannot vary");
  refused("--vary particles.body.c.a=1:2", "a grid has a number of points");
  refused("--vary particles.body.c.a=1:2:3 --shard 5/4", "there is no shard 5 of 4; they are 0/4 to 3/4");
  refused("--vary particles.body.c.a=1:2:3 --shard 1", "--shard 1 is not valid; k/N is expected, such as 0/4");
  refused("--vary particles.body.c.a=1:2:3 --members x", "--members x is not valid; a whole number is expected");
  refused("--vary particles.body.c.a=1:2:3 --out scene.toml", "scene.toml: the file is there already");
  refused("--vary particles.body.c.a=1:2:3 --out none/such/", "this is a folder, and a file is expected");
  refused("--vary particles.body.c.a=1:2:3 --out scene.toml/map.h5", "scene.toml", 3);
  refused("", "nothing varies; give --vary KEY=a:b:n");
}

TEST_CASE("1000 members over four shards that are killed at random end in the bytes of one process",
          "[cli][ensemble][slow]") {
  const SceneFolder folder(planets("type = \"wisdom_holman\"", "verlet_aba", 5'000));
  const std::string all = " --vary particles.body.c.a=1.5:1.8:40 --vary particles.body.c.e=0:0.1:25";
  output(folder, "ensemble scene.toml --out whole.h5" + all);
  Philox random(47);
  int killed = 0;
  std::string files;
  for (int shard = 0; shard < 4; ++shard) {
    const std::string name = fmt::format("map.h5.{}-of-4", shard);
    const std::string line = fmt::format("ensemble scene.toml --out map.h5 --shard {}/4", shard) + all;
    const std::filesystem::path file = folder / name, rows = folder / (name + ".rows");
    files += " " + name;
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::uintmax_t before = std::filesystem::exists(rows) ? std::filesystem::file_size(rows) : 0;
      const auto more = static_cast<std::uintmax_t>(500 + 30'000 * random.uniform());  // of some 90'000 bytes
      Process one(command(line), folder.path());
      wait_until([&] {
        std::error_code gone;
        const std::uintmax_t now = std::filesystem::file_size(rows, gone);
        return std::filesystem::exists(file) || (!gone && now > before + more);
      });
      one.signal(SIGKILL);
      killed += one.wait().exit_code == 128 + SIGKILL ? 1 : 0;
    }
    output(folder, line);
    CHECK_FALSE(std::filesystem::exists(rows));
  }
  CHECK(killed > 0);
  output(folder, "merge" + files + " --out map.h5");
  CHECK(read_text(folder / "map.h5") == read_text(folder / "whole.h5"));
}

}  // namespace
}  // namespace noether::test
