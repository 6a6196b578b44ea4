// kill -9 while files are written: whatever was flushed is there, and the run goes on from it.

#include "integrators/wisdom_holman.hpp"
#include "io/digest.hpp"
#include "io/inspect.hpp"
#include "numbers/parallel.hpp"
#include "tests/io/support.hpp"
#include "tests/support/settings.hpp"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#if NOETHER_HDF5

namespace {

/// The call to the system at which process `doomed` is to kill itself, counted from now; 0: it lives.
long fatal_call = 0;
pid_t doomed = 0;  // its children live
/// Whether that call, if it writes, is begun, and torn in its middle, or at the border of a page before.
bool torn = false;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_fatal() { return fatal_call > 0 && doomed == ::getpid() && --fatal_call == 0; }

void die_at(long call) {
  fatal_call = call;
  doomed = ::getpid();
  torn = call % 3 == 0;
}

}  // namespace

// These stand before the C library's own, for noether and for HDF5.
extern "C" ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t at) {
  static auto* const write = next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite");
  if (!is_fatal()) return write(file, bytes, size, at);
  const auto page_end = static_cast<std::size_t>(4096 - at % 4096);
  if (torn) static_cast<void>(write(file, bytes, std::min(size / 2, page_end), at) < 0);
  ::raise(SIGKILL);
  return -1;
}

extern "C" ssize_t write(int file, const void* bytes, std::size_t size) {
  static auto* const write_all = next<ssize_t(int, const void*, std::size_t)>("write");
  if (!is_fatal()) return write_all(file, bytes, size);
  if (torn) static_cast<void>(write_all(file, bytes, size / 2) < 0);
  ::raise(SIGKILL);
  return -1;
}

extern "C" int fsync(int /*file*/) {
  if (is_fatal()) ::raise(SIGKILL);
  return 0;  // what the system has been handed survives a process, and disks are slow
}

extern "C" int rename(const char* from, const char* to) noexcept {
  static auto* const rename_now = next<int(const char*, const char*)>("rename");
  if (is_fatal()) ::raise(SIGKILL);
  return rename_now(from, to);
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  static auto* const truncate = next<int(int, off_t)>("ftruncate");
  if (is_fatal()) ::raise(SIGKILL);
  return truncate(file, size);
}

namespace noether {
namespace {

constexpr std::int64_t steps = 600, steps_between_flushes = 5;

/// An uninterrupted run: what its file holds, and what checkpoints on the way would have kept.
struct Reference {
  explicit Reference(const std::filesystem::path& file) {
    test::WritingRun run(file);
    for (std::int64_t step = 0; step < steps; step += steps_between_flushes) {
      saved.push_back(run.simulation.save());
      CHECK(run.simulation.run(steps_between_flushes).ok());
    }
    run.writer->finish(Outcome{});
    frames = io::read_frames(file);
  }

  std::vector<SavedRun> saved;  ///< every 5 steps
  io::Frames frames;
};

/// A process that goes on with a run, flushes every 5 steps, and tells through a pipe how far the file is good.
class Victim {
 public:
  /// @param dying  called in the process before its first step
  Victim(const std::filesystem::path& file, const Reference& reference, std::int64_t step,
         const std::function<void()>& dying) {
    REQUIRE(::pipe(pipe_) == 0);
    child_ = ::fork();
    REQUIRE(child_ >= 0);
    if (child_ == 0) {
      dying();
      work(file, reference.saved.at(static_cast<std::size_t>(step / steps_between_flushes)), step);
    }
    ::close(pipe_[1]);
  }
  Victim(Victim&&) = default;
  Victim& operator=(Victim&&) = delete;
  ~Victim() = default;

  void kill() const { ::kill(child_, SIGKILL); }

  /// Whether it has come through; how far the file is good for certain.
  std::pair<bool, std::int64_t> end() {
    int status = -1;
    ::waitpid(child_, &status, 0);
    std::int64_t flushed = 0, told = 0;
    while (::read(pipe_[0], &told, sizeof told) == sizeof told) flushed = told;
    ::close(pipe_[0]);
    if (WIFEXITED(status)) CHECK(WEXITSTATUS(status) == 0);
    return {WIFEXITED(status), flushed};
  }

 private:
  [[noreturn]] void work(const std::filesystem::path& file, const SavedRun& saved, std::int64_t step) const {
    try {
      test::WritingRun run(file);
      run.simulation.restore(saved);
      while (step < steps) {
        if (!run.simulation.run(steps_between_flushes).ok()) ::_exit(1);
        run.writer->flush();
        step += steps_between_flushes;
        if (::write(pipe_[1], &step, sizeof step) != sizeof step) ::_exit(1);
      }
      run.writer->finish(Outcome{});
      ::_exit(0);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      ::_exit(1);
    }
  }

  int pipe_[2] = {-1, -1};
  pid_t child_ = -1;
};

/// What a killed run has left: frames of a run that was never killed, and not fewer than so many.
void check_frames(const std::filesystem::path& file, const io::Frames& whole, std::int64_t at_least) {
  CHECK(io::verify(file).damaged == std::vector<std::string>{});
  const io::Frames left = io::read_frames(file);
  REQUIRE(static_cast<std::int64_t>(left.frames.size()) >= at_least);
  for (std::size_t k = 0; k < left.frames.size(); ++k) {
    const io::Frame &one = left.frames[k], &other = whole.frames.at(k);
    const bool same = one.step == other.step && one.positions == other.positions &&
                      one.velocities == other.velocities && one.variables == other.variables;
    if (!same) FAIL_CHECK("frame " << k << " is not that of an uninterrupted run");
  }
}

/// Lets one run die again and again until it is through, then begins anew, until there were so many deaths.
void die_often(int wanted,
               const std::function<Victim(const std::filesystem::path&, const Reference&, std::int64_t)>& next) {
  const test::ScratchFolder folder;
  const Reference reference(folder / "whole.h5");
  const std::filesystem::path file = folder / "run.h5";
  int deaths = 0, ends = 0;
  std::int64_t good = 0;  // last step of which the file is known to hold everything
  while (deaths < wanted || ends == 0) {
    good = std::min(good, steps - steps_between_flushes);  // the next begins by cutting the file back to this step
    const auto [through, flushed] = next(file, reference, good).end();
    CAPTURE(deaths, good, flushed);
    good = std::max(good, flushed);
    if (good > 0) check_frames(file, reference.frames, good / 5 + 1);
    if (!through) ++deaths;
    if (!through) continue;
    if (ends++ % 5 == 0) test::check_same_content(file, folder / "whole.h5");
    std::filesystem::remove(file);
    good = 0;
  }
}

/// Deaths before a chosen write; of every third, half of the write is done.
void die_at_writes(int deaths) {
  std::mt19937 random(20261121);
  std::uniform_int_distribution<long> writes(1, 200);
  die_often(deaths, [&](const std::filesystem::path& file, const Reference& reference, std::int64_t step) {
    const long fatal = writes(random);
    return Victim(file, reference, step, [fatal] { die_at(fatal); });
  });
}

/// Microseconds that a run from its first step takes here, and one that goes on from a file.
long duration_of_runs(const std::filesystem::path& file, const Reference& reference) {
  const auto begin = std::chrono::steady_clock::now();
  for (const std::int64_t step : {std::int64_t{0}, steps_between_flushes}) Victim(file, reference, step, [] {}).end();
  const auto took = std::chrono::steady_clock::now() - begin;
  std::filesystem::remove(file);
  return static_cast<long>(std::chrono::duration_cast<std::chrono::microseconds>(took).count());
}

void die_at_moments(int deaths) {
  std::mt19937 random(20261121);
  std::optional<std::uniform_int_distribution<long>> moment;
  die_often(deaths, [&](const std::filesystem::path& file, const Reference& reference, std::int64_t step) {
    if (!moment) moment.emplace(0, duration_of_runs(file, reference));
    Victim victim(file, reference, step, [] {});
    std::this_thread::sleep_for(std::chrono::microseconds((*moment)(random)));
    victim.kill();
    return victim;
  });
}

/// Goes on from the newest checkpoint of a folder to the end, or begins, as `noether run --resume` does.
template <class Run>
void go_on(Run&& run, const std::filesystem::path& folder, std::int64_t end, std::int64_t between_checkpoints) {
  run.simulation.every(between_checkpoints, io::CheckpointWriter(folder / "checkpoint.h5"));
  const io::FoundCheckpoint found = io::newest_checkpoint(folder);
  if (found.checkpoint) run.simulation.restore(found.checkpoint->run);
  const Outcome outcome = run.simulation.run(end - run.simulation.step());
  if (!outcome.ok()) throw FileError("the run fails");
  run.writer->flush();
  io::Checkpoint last;
  last.run = run.simulation.save();
  last.step = run.simulation.step();
  last.digest = io::digest(run.simulation.particles());
  io::write_checkpoint(folder / "checkpoint.h5", last);
  run.writer->finish(outcome);
}

/// A run with checkpoints into a folder, from wherever it was; frames every 5 steps.
using WholeRun = std::function<void(const std::filesystem::path& folder)>;

const WholeRun small = [](const auto& folder) { go_on(test::WritingRun(folder / "run.h5"), folder, 60, 7); };
const WholeRun large = [](const auto& folder) {
  go_on(test::WritingRun(folder / "run.h5", test::planets_with_tracers(20'000)), folder, 12, 3);
};
/// Frames at times of a list, the first of which comes after a checkpoint: the file is there before it has any frame.
struct LateRun {
  explicit LateRun(const std::filesystem::path& file)
      : simulation(test::outer_planets(),
                   compose(test::kinetic_potential(Gravity{.G = test::outer_G}), schemes::verlet), 40.0),
        writer(&simulation.at_times({10 * 40.0, 20 * 40.0, 40 * 40.0},
                                    io::TrajectoryWriter(file, {.scene_toml = "title = \"l\"\n"}))) {}

  Simulation<double> simulation;
  io::TrajectoryWriter* writer;
};

/// Words around the run, of which frames and checkpoints stand in the middle, and kicks along themselves.
const WholeRun corrected = [](const auto& folder) {
  go_on(test::WritingRun(folder / "run.h5", test::outer_planets(),
                         compose(test::wisdom_holman({.G = test::outer_G}), schemes::verlet_aba,
                                 {.corrector = 17, .kernel = StepKernel::lazy})),
        folder, 60, 7);
};
const WholeRun late = [](const auto& folder) { go_on(LateRun(folder / "run.h5"), folder, 60, 7); };
const WholeRun of_system = [](const auto& folder) { go_on(test::LorenzRun(folder / "run.h5"), folder, 60, 7); };

/// A process that dies at its call number `fatal` to the system, if it makes so many. @return whether it came through
bool survives(const WholeRun& run, const std::filesystem::path& folder, long fatal, bool within = false) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    die_at(fatal);
    torn = torn || within;
    try {
      run(folder);
      ::_exit(0);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      ::_exit(1);
    }
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) CHECK(WEXITSTATUS(status) == 0);
  return WIFEXITED(status);
}

/// Every file that is there is sound, and run.h5 has all that the newest checkpoint counts on.
/// @return the digest of the newest checkpoint
std::string check_files(const std::filesystem::path& folder, const io::Frames& whole) {
  const std::filesystem::path file = folder / "run.h5";
  const io::FoundCheckpoint found = io::newest_checkpoint(folder);
  CHECK(found.damaged.empty());
  const std::int64_t frames = found.checkpoint ? found.checkpoint->step / 5 + 1 : 0;
  if (frames > 0 || std::filesystem::exists(file)) check_frames(file, whole, frames);
  return found.checkpoint ? found.checkpoint->digest : "";
}

/// Lets runs die in the middle of one of their calls to the system, each in another one, and go on to the end.
void die_within_each_write(const WholeRun& run) {
  const test::ScratchFolder reference, scratch;
  const test::Threads one(1);  // a process that has threads cannot be copied with them
  run(reference.path());
  const io::Frames whole = io::read_frames(reference / "run.h5");
  bool through = false;
  for (long fatal = 1; !through; ++fatal) {
    CAPTURE(fatal);
    const std::filesystem::path folder = scratch / std::to_string(fatal);
    std::filesystem::create_directory(folder);
    through = survives(run, folder, fatal, true);
    if (std::filesystem::exists(folder / "run.h5")) check_frames(folder / "run.h5", whole, 0);
    if (!through && fatal % 4 == 0) {
      CHECK(survives(run, folder, 0));
      test::check_same_content(folder / "run.h5", reference / "run.h5");
    }
    std::filesystem::remove_all(folder);
  }
}

/// Lets a run die from its first call to its last, again and again, until it is through; then begins anew, until there
/// were so many deaths.
void die_anywhere(const WholeRun& run, int wanted) {
  const test::ScratchFolder reference, scratch;
  constexpr long never = 1'000'000'000;
  const test::Threads one(1);  // a process that has threads cannot be copied with them
  die_at(never);
  run(reference.path());
  const long calls = never - std::exchange(fatal_call, 0);
  const io::Frames whole = io::read_frames(reference / "run.h5");
  const std::string digest = check_files(reference.path(), whole);
  std::mt19937 random(20261122);
  std::uniform_int_distribution<long> any(1, calls);
  int deaths = 0;
  for (int chain = 0; deaths < wanted; ++chain) {
    const std::filesystem::path folder = scratch / std::to_string(chain);
    std::filesystem::create_directory(folder);
    long fatal = any(random);
    for (; !survives(run, folder, fatal); fatal = any(random)) {
      CAPTURE(deaths++, fatal);
      check_files(folder, whole);
    }
    CHECK(check_files(folder, whole) == digest);
    if (chain % 5 == 0) test::check_same_content(folder / "run.h5", reference / "run.h5");
    std::filesystem::remove_all(folder);
  }
}

}  // namespace

TEST_CASE("a run that dies before or within any write goes on, and its file is that of a run that never died",
          "[trajectory][kill]") {
  die_at_writes(100);
}

TEST_CASE("a run that dies at any of its first writes to a file that it goes on with leaves what the file held",
          "[trajectory][kill]") {
  const test::ScratchFolder folder;
  const Reference reference(folder / "whole.h5");
  constexpr std::int64_t step = steps / 2;
  {
    test::WritingRun run(folder / "half.h5");
    REQUIRE(run.simulation.run(step).ok());
    run.writer->flush();
  }
  for (const bool half : {false, true}) {
    for (long fatal = 1; fatal <= 40; ++fatal) {
      CAPTURE(half, fatal);
      const std::filesystem::path file = folder / "run.h5";
      std::filesystem::copy_file(folder / "half.h5", file, std::filesystem::copy_options::overwrite_existing);
      Victim victim(file, reference, step, [&] {
        die_at(fatal);
        torn = half;
      });
      CHECK_FALSE(victim.end().first);
      check_frames(file, reference.frames, step / steps_between_flushes + 1);
    }
  }
}

TEST_CASE("so does a run killed at any moment", "[trajectory][kill]") { die_at_moments(20); }

TEST_CASE("a run that dies between its first call and its last, checkpoints among them, ends as one that never died",
          "[trajectory][checkpoint][kill]") {
  die_anywhere(small, 12);
}

TEST_CASE("a run that dies within any of its writes leaves frames of a run that never died, and no others",
          "[trajectory][checkpoint][kill][slow]") {
  die_within_each_write(small);
  die_within_each_write(late);
}

TEST_CASE("so does a run of a system", "[trajectory][checkpoint][kill][system]") { die_anywhere(of_system, 12); }

TEST_CASE("so does a run with a corrector and a kernel", "[trajectory][checkpoint][kill]") {
  die_anywhere(corrected, 6);
}

TEST_CASE("the same for hundreds of deaths, and for a large run", "[trajectory][kill][.][nightly]") {
  die_at_writes(500);
  die_at_moments(100);
  die_anywhere(small, 150);
  die_anywhere(of_system, 150);
  die_anywhere(corrected, 60);
  die_anywhere(large, 30);
  die_within_each_write(of_system);
}

}  // namespace noether

#endif
