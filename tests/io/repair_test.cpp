// What a dead run or a damaged disk leaves is mended, and never crashes anything.

#include "io/repair.hpp"

#include "io/digest.hpp"
#include "io/hdf5_file.hpp"
#include "io/sandbox.hpp"
#include "tests/io/support.hpp"
#include "tests/support/damage.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <limits>

#if NOETHER_HDF5

#if defined(__SANITIZE_ADDRESS__)
/// HDF5 1.10 forgets some bytes on its way out of damaged files; read by the leak sanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#endif

namespace noether {
namespace {

const std::string position = "/particles/system/position/value", velocity = "/particles/system/velocity/value";

/// A run of 60 steps, 13 frames, and what a checkpoint at step 30 would have kept. It is complete if `outcome` says so.
SavedRun half_of_a_run(const std::filesystem::path& file, bool complete) {
  test::WritingRun run(file);
  REQUIRE(run.simulation.run(30).ok());
  const SavedRun saved = run.simulation.save();
  REQUIRE(run.simulation.run(30).ok());
  if (complete) run.writer->finish(Outcome{});
  return saved;
}

bool same_frame(const io::Frame& a, const io::Frame& b) {
  return a.step == b.step && a.time == b.time && a.positions == b.positions && a.velocities == b.velocities;
}

void resize(const std::filesystem::path& file, const std::string& path, Index rows) {
  io::Hdf5File::open_to_append(file).open(path).resize(rows);
}

/// Puts a row that is not finite at the end of the velocities, all else at the end being sound.
void spoil_last_velocity(const std::filesystem::path& file) {
  const io::Hdf5File opened = io::Hdf5File::open_to_append(file);
  io::Hdf5Dataset dataset = opened.open(velocity);
  const Index rows = dataset.rows();
  dataset.resize(rows - 1);
  dataset.append(std::vector<double>(18, std::numeric_limits<double>::quiet_NaN()));
}

/// Goes on with a run to step 60 and compares its file with that of a run that was never interrupted.
void check_resumes(const std::filesystem::path& file, const SavedRun& saved, const std::filesystem::path& whole) {
  test::WritingRun run(file);
  run.simulation.restore(saved);
  REQUIRE(run.simulation.run(30).ok());
  run.writer->finish(Outcome{});
  test::check_same_content(file, whole);
}

/// Whether a call ends well, or by an error of the file, in one line; anything else fails the test.
template <class Call> bool taken(const Call& call) {
  try {
    call();
    return true;
  } catch (const FileError& error) {
    CHECK(std::string(error.what()).find("run.h5: ") != std::string::npos);
  } catch (const std::exception& error) {
    FAIL_CHECK(error.what());
  }
  return false;
}

/// Goes on with a file for a few steps; nobody knows whether it is sound.
void try_to_resume(const std::filesystem::path& file, const SavedRun& saved) {
  taken([&] {
    test::WritingRun run(file);
    run.simulation.restore(saved);
    const bool ok = run.simulation.run(5).ok();
    CHECK(ok);
    run.writer->finish(Outcome{});
  });
}

/// What verify calls sound is taken by all that read.
void check_readers(const std::filesystem::path& file) {
  const bool sound = io::verify(file).damaged.empty();
  CHECK((taken([&] { io::info(file); }) || !sound));
  CHECK((taken([&] { io::read_monitors(file); }) || !sound));
  CHECK((taken([&] { io::read_frames(file); }) || !sound));
}

/// Does with damaged files what users may do with them: with each one thing, or everything.
void survive(unsigned first, unsigned count, bool everything) {
  const test::ScratchFolder folder;
  const SavedRun saved = half_of_a_run(folder / "good.h5", true);
  const std::string good = test::read_text(folder / "good.h5");
  const std::filesystem::path file = folder / "run.h5";
  int refused = 0;
  const std::vector<std::function<void()>> deeds{
      [&] { refused += io::verify(file).damaged.empty() ? 0 : 1; },
      [&] { check_readers(file); },
      [&] { taken([&] { io::convert(file, folder / "run.csv"); }); },
      [&] { taken([&] { io::repair(file); }); },
      [&] { try_to_resume(file, saved); },
  };
  for (unsigned number = first; number < first + count; ++number) {
    CAPTURE(number);
    test::write_text(file, test::damaged(good, number));
    for (std::size_t k = 0; k < deeds.size(); ++k) {
      if (everything || number % deeds.size() == k) deeds[k]();
    }
    std::filesystem::remove(folder / "run.h5.damaged");
  }
  CHECK(refused > 0);
}

/// A checkpoint of any content, with a hash that fits.
void write_hashed(const std::filesystem::path& file, const io::Hdf5File& content) {
  content.make_group("/noether");
  content.set_attribute("/noether", "complete", std::int64_t{1});
  const std::string bytes = content.to_bytes();
  test::write_text(file, bytes + "sha256:" + io::sha256(bytes) + "\n");
}

}  // namespace

TEST_CASE("rows that a dead run has left are cut off, and the run goes on as if nothing had been", "[repair]") {
  const test::ScratchFolder folder;
  const SavedRun saved = half_of_a_run(folder / "run.h5", false);
  half_of_a_run(folder / "whole.h5", true);
  for (const std::string name : {"/particles/system/position/value", "/noether/monitors/energy/step"}) {
    resize(folder / "run.h5", name, 12);
  }
  const io::Repair done = io::repair(folder / "run.h5");
  CHECK(
      done.repaired ==
      std::vector<std::string>{
          "'/particles/system/velocity/value' cut from 13 rows to 12, the number that all parts of the frames have",
          "'/particles/system/position/step' cut from 13 rows to 12, the number that all parts of the frames have",
          "'/particles/system/position/time' cut from 13 rows to 12, the number that all parts of the frames have",
          "'/noether/digests/frames' cut from 13 rows to 12, the number that all parts of the frames have",
          "'/noether/monitors/energy/kinetic' cut from 21 rows to 12, the number that all parts of monitor 'energy' "
          "have",
          "'/noether/monitors/energy/potential' cut from 21 rows to 12, the number that all parts of monitor 'energy' "
          "have",
          "'/noether/monitors/energy/relative_error' cut from 21 rows to 12, the number that all parts of monitor "
          "'energy' have",
          "'/noether/monitors/energy/time' cut from 21 rows to 12, the number that all parts of monitor 'energy' have",
          "'/noether/monitors/energy/total' cut from 21 rows to 12, the number that all parts of monitor 'energy' have",
          "'/noether/digests/monitors/energy' cut from 21 rows to 12, the number that all parts of monitor 'energy' "
          "have"});
  CHECK(done.info.damaged.empty());
  CHECK(done.info.frames == 12);
  CHECK(done.info.last_step == 55);
  CHECK_FALSE(std::filesystem::exists(folder / "run.h5.damaged"));
  const std::string once = test::read_text(folder / "run.h5");
  CHECK(io::repair(folder / "run.h5").repaired.empty());
  const bool untouched = test::read_text(folder / "run.h5") == once;
  CHECK(untouched);
  check_resumes(folder / "run.h5", saved, folder / "whole.h5");
}

TEST_CASE("a file that has lost its end keeps every frame that is whole, and the file as it was stays", "[repair]") {
  const test::ScratchFolder folder;
  {
    test::WritingRun run(folder / "whole.h5", test::planets_with_tracers(506));
    REQUIRE(run.simulation.run(500).ok());
    run.writer->finish(Outcome{});
  }
  const std::string good = test::read_text(folder / "whole.h5");
  const io::Frames whole = io::read_frames(folder / "whole.h5");
  const std::filesystem::path file = folder / "run.h5", kept = folder / "run.h5.damaged";
  constexpr int parts = 10;
  std::size_t most = 0;
  for (int part = 1; part < parts; ++part) {
    const std::string left = good.substr(0, good.size() * static_cast<std::size_t>(part) / parts);
    test::write_text(file, left);
    const io::Repair done = io::repair(file);
    const bool mended = done.info.damaged.empty();
    CAPTURE(part, done.repaired, done.info.damaged);
    CHECK(done.repaired.empty() == !mended);
    CHECK_FALSE(std::filesystem::exists(folder / "run.h5.repaired"));
    CHECK(std::filesystem::exists(kept) == mended);
    const bool untouched = test::read_text(mended ? kept : file) == left;
    CHECK(untouched);
    CHECK((mended || most == 0));  // what is enough with less is enough with more
    if (!mended) continue;
    const io::Frames frames = io::read_frames(file);
    CHECK(frames.frames.size() >= most);
    most = frames.frames.size();
    CHECK(most > whole.frames.size() * static_cast<std::size_t>(part - 2) / parts);
    CHECK(most < whole.frames.size());
    const bool same = std::equal(frames.frames.begin(), frames.frames.end(), whole.frames.begin(), same_frame);
    CHECK(same);
    std::filesystem::remove(kept);
  }
  CHECK(most > 60);
}

TEST_CASE("a file of an earlier repair is never replaced", "[repair][messages]") {
  const test::ScratchFolder folder;
  half_of_a_run(folder / "run.h5", true);
  const std::string good = test::read_text(folder / "run.h5");
  test::write_text(folder / "run.h5", good.substr(0, good.size() - 1));
  test::write_text(folder / "run.h5.damaged", "precious");
  CHECK(test::error_of([&] { io::repair(folder / "run.h5"); }) ==
        (folder / "run.h5.damaged").string() +
            ": a copy from an earlier repair is in the way; move or remove it, then repair again");
  CHECK(test::read_text(folder / "run.h5.damaged") == "precious");
}

TEST_CASE("what is no matter of lengths is named and not touched", "[repair]") {
  const test::ScratchFolder folder;
  half_of_a_run(folder / "run.h5", true);
  spoil_last_velocity(folder / "run.h5");
  test::write_text(folder / "text.h5", "no file of HDF5");
  test::write_text(folder / "checkpoint.h5", "half of a checkpoint");
  test::write_text(folder / "empty.h5", "");
  for (const char* name : {"run.h5", "text.h5", "checkpoint.h5", "empty.h5"}) {
    const std::string before = test::read_text(folder / name);
    const io::Repair left = io::repair(folder / name);
    CHECK(left.repaired.empty());
    CHECK(left.info.damaged.size() == 1);
    const bool untouched = test::read_text(folder / name) == before;
    CHECK(untouched);
  }
  CHECK(io::repair(folder / "run.h5").info.damaged.at(0) == "frame 12 at step 60 is not finite");
  CHECK_THROWS_AS(io::repair(folder / "nothing.h5"), FileError);
}

TEST_CASE("a dataset that claims terabytes is an error of the file", "[damage][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "large.h5").string();
  const io::Hdf5File content = io::Hdf5File::create_in_memory(file);
  content.create_growing("/state/x", io::ElementType::real, {}, 512).resize(Index{1} << 40U);
  write_hashed(file, content);
  const std::string message = ": damaged: '/state/x' of shape (1099511627776) would be larger than the file";
  CHECK(test::error_of([&] { io::read_checkpoint(file); }) == file + message);
  CHECK(test::error_of([&] { io::Hdf5File::open_to_read(file).open("/state/x"); }) == file + message);

  half_of_a_run(folder / "run.h5", false);
  resize(folder / "run.h5", position, Index{1} << 40U);
  CHECK(test::error_of([&] { io::info(folder / "run.h5"); }) ==
        (folder / "run.h5").string() + ": damaged: '" + position +
            "' of shape (1099511627776, 6, 3) would be larger than the file");
}

TEST_CASE("groups of a checkpoint that stand within themselves are an error of the file", "[damage][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "circle.h5").string();
  const io::Hdf5File content = io::Hdf5File::create_in_memory(file);
  content.make_group("/state/a");
  content.link("/state", "/state/a/b");
  write_hashed(file, content);
  CHECK(test::error_of([&] { io::read_checkpoint(file); }) ==
        file + ": damaged: the groups below '/state' are nested more than 64 levels deep");
  CHECK(io::verify(file).damaged.size() == 1);
}

TEST_CASE("a child that tries a file holds nothing else of its parent's open: locks end with the parent", "[damage]") {
  const test::ScratchFolder folder;
  test::write_text(folder / "file", "bytes");
  test::write_text(folder / "lock", "");
  const int held = ::open((folder / "lock").c_str(), O_RDONLY | O_CLOEXEC);
  struct stat file {};
  REQUIRE(::fstat(held, &file) == 0);
  CHECK_NOTHROW(io::try_in_child(folder / "file", [&] {
    struct stat now {};
    if (::fstat(held, &now) == 0 && now.st_ino == file.st_ino) throw FileError("the child has it too");
  }));
  ::close(held);
  CHECK_THROWS_AS(io::try_in_child(folder / "file", [] { throw FileError("told to the parent"); }), FileError);
}

TEST_CASE("whatever bytes of a trajectory are changed, nothing that reads it or goes on with it crashes",
          "[repair][damage]") {
  survive(1, 200, false);
}

TEST_CASE("the same for hundreds of changed files", "[repair][damage][.][nightly]") { survive(1000, 600, true); }

}  // namespace noether

#endif
