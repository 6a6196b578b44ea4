// Beside programs that want every core: threads that wait for each other give theirs away, whatever the environment.

#include "tests/cli/support.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace noether::test {
namespace {

/// 864 atoms: enough for a few threads, and so few that they wait for each other thousands of times a second.
const std::string small_liquid = R"(units = "reduced"
[particles]
type = "lattice"
cells = [6, 6, 6]
density = 0.8442
mass = 1
temperature = 1.44
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = 2.5
cutoff_style = "switch_c4"
epsilon = 1
sigma = 1
[integrator]
method = "verlet"
step = 0.005
steps = 500
[[every]]
type = "energy"
steps = 50
)";

/// As many endless loops as there are processors, while this lives.
class BusyLoops {
 public:
  explicit BusyLoops(const ScratchFolder& folder) {
    for (unsigned k = 0; k < std::max(2u, std::thread::hardware_concurrency()); ++k) {
      const std::vector<std::string> endless{"sh", "-c", "while :; do :; done"};
      loops_.push_back(std::make_unique<Process>(endless, folder.path()));
    }
  }

 private:
  std::vector<std::unique_ptr<Process>> loops_;
};

/// The program as it is run from a shell that says nothing about threads.
std::vector<std::string> installed_program(const std::string& line) {
  std::vector<std::string> all{"env", "-u", "OMP_WAIT_POLICY", "-u", "GOMP_SPINCOUNT", "-u", "KMP_BLOCKTIME"};
  for (std::string& word : command(line)) all.push_back(std::move(word));
  return all;
}

/// Runs `together` copies of the liquid at the same time. @return the seconds until all have ended
double seconds_of(int together, int threads) {
  const SceneFolder folder(small_liquid);
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::unique_ptr<Process>> runs;
  for (int k = 0; k < together; ++k) {
    const std::string given = " --threads " + std::to_string(threads) + " --out out-" + std::to_string(k);
    runs.push_back(std::make_unique<Process>(installed_program("run scene.toml --quiet" + given), folder.path()));
  }
  for (const auto& run : runs) {
    const ProcessResult result = run->wait();
    INFO(result.err);
    CHECK(result.exit_code == 0);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How many times longer two threads take than one; the best of three, for others compute here too.
double slowdown(int together) {
  double best = 1e9;
  for (int k = 0; k < 3 && best > 4; ++k) {
    const double one = seconds_of(together, 1);
    best = std::min(best, seconds_of(together, 2) / one);
  }
  return best;
}

}  // namespace

// Teams that wait awake were 30 times slower on two threads than on one; 4 leaves room for any scheduler.
TEST_CASE("beside busy loops two threads are about as fast as one", "[cli][slow]") {
  const ScratchFolder folder;
  const BusyLoops loops(folder);
  CHECK(slowdown(1) <= 4);
}

TEST_CASE("two runs at a time on two threads each are about as fast as on one", "[cli][slow]") {
  CHECK(slowdown(2) <= 4);
}

TEST_CASE("OMP_NUM_THREADS says how many threads a run uses, unless --threads does", "[cli]") {
  const SceneFolder folder(unwritten);
  const auto threads = [&](const std::string& given, const std::string& options) {
    std::vector<std::string> all{"env", "OMP_NUM_THREADS=" + given};
    for (std::string& word : command("run scene.toml --json" + options)) all.push_back(std::move(word));
    return json_member(run_process(all, folder.path()).out, "threads");
  };
  const std::string without = threads("", "");
  CHECK(std::stoi(without) >= 1);
  CHECK(threads("3", "") == "3");
  CHECK(threads("3,2", "") == "3");
  CHECK(threads("3", " --threads 5") == "5");
  for (const std::string wrong : {"0", "-2", "many", "3x"}) CHECK(threads(wrong, "") == without);
}

}  // namespace noether::test
