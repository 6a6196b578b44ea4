// kill -9 while run.h5 is written: whatever was flushed is there, and the run goes on from it.

#include "io/inspect.hpp"
#include "tests/io/support.hpp"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <random>
#include <thread>

#if NOETHER_HDF5

namespace {

/// The write at which this process is to kill itself, counted from now; 0: it lives.
long fatal_write = 0;
/// Whether that write is begun, and torn at the border of a page.
bool torn = false;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_fatal() { return fatal_write > 0 && --fatal_write == 0; }

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

/// What a killed run has left: frames of the reference, none missing that was flushed.
void check_frames(const std::filesystem::path& file, const Reference& reference, std::int64_t flushed) {
  CHECK(io::verify(file).damaged.empty());
  const io::Frames left = io::read_frames(file);
  REQUIRE(static_cast<std::int64_t>(left.frames.size()) >= flushed / 5 + 1);
  for (std::size_t k = 0; k < left.frames.size(); ++k) {
    const bool same = left.frames[k].step == reference.frames.frames[k].step &&
                      left.frames[k].positions == reference.frames.frames[k].positions &&
                      left.frames[k].velocities == reference.frames.frames[k].velocities;
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
    if (good > 0) check_frames(file, reference, good);
    if (!through) ++deaths;
    if (!through) continue;
    const test::PythonResult equal =
        test::run_python("compare_files.py", (folder / "whole.h5").string() + " " + file.string());
    INFO(equal.output);
    CHECK((equal.status == 0 || equal.status == 77));
    std::filesystem::remove(file);
    good = 0;
    ++ends;
  }
}

/// Deaths before a chosen write; of every third, half of the write is done.
void die_at_writes(int deaths) {
  std::mt19937 random(20261121);
  std::uniform_int_distribution<long> writes(1, 200);
  die_often(deaths, [&](const std::filesystem::path& file, const Reference& reference, std::int64_t step) {
    const long fatal = writes(random);
    return Victim(file, reference, step, [fatal] {
      fatal_write = fatal;
      torn = fatal % 3 == 0;
    });
  });
}

void die_at_moments(int deaths) {
  std::mt19937 random(20261121);
  std::uniform_int_distribution<int> microseconds(0, 60'000);  // a whole run takes about as long
  die_often(deaths, [&](const std::filesystem::path& file, const Reference& reference, std::int64_t step) {
    Victim victim(file, reference, step, [] {});
    std::this_thread::sleep_for(std::chrono::microseconds(microseconds(random)));
    victim.kill();
    return victim;
  });
}

}  // namespace

TEST_CASE("a run that dies before or within any write goes on, and its file is that of a run that never died",
          "[trajectory][kill]") {
  die_at_writes(100);
}

TEST_CASE("so does a run killed at any moment", "[trajectory][kill]") { die_at_moments(20); }

TEST_CASE("the same for thousands of deaths", "[trajectory][kill][.][nightly]") {
  die_at_writes(2000);
  die_at_moments(500);
}

}  // namespace noether

#endif
