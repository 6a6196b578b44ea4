// Checkpoints: exact, and no damage goes unnoticed.

#include "io/digest.hpp"
#include "io/inspect.hpp"
#include "tests/io/support.hpp"

#include <bit>
#include <chrono>
#include <limits>
#include <thread>

using namespace noether;
using test::error_of;

#if NOETHER_HDF5

namespace {

/// Doubles by their bits, so that NaN equals itself and -0 does not equal 0.
std::vector<std::uint64_t> bits_of(const SavedArray& array) {
  std::vector<std::uint64_t> bits;
  if (const auto* numbers = std::get_if<std::vector<double>>(&array)) {
    for (const double x : *numbers) bits.push_back(std::bit_cast<std::uint64_t>(x));
  }
  return bits;
}

void check_same(const SavedState& a, const SavedState& b) {
  REQUIRE(a.size() == b.size());
  for (const auto& [name, array] : a) {
    INFO(name);
    REQUIRE(b.count(name) == 1);
    REQUIRE(b.at(name).index() == array.index());
    CHECK(bits_of(b.at(name)) == bits_of(array));
    if (array.index() != 0) CHECK(b.at(name) == array);
  }
}

io::Checkpoint made_up() {
  io::Checkpoint c;
  const double infinity = std::numeric_limits<double>::infinity();
  c.run.particles["position"] = std::vector<double>{0.1, -0.0, infinity, std::bit_cast<double>(0x7ff8dead0000beefULL),
                                                    std::numeric_limits<double>::denorm_min()};
  c.run.particles["id"] = std::vector<std::int64_t>{0, -1, std::numeric_limits<std::int64_t>::min()};
  c.run.particles["name"] = std::vector<std::string>{"", "two words", "\xC3\xA9toile", "a/b"};
  c.run.particles["clock/counts"] = std::vector<std::int64_t>{1};
  // Names that no path of HDF5 can say as they are, or that would get into each other's way.
  c.run.parts["energy_2"] = {{"a", std::vector<double>{1}},     {"a/b", std::vector<double>{2}},
                             {"/a", std::vector<double>{3}},    {"a//b", std::vector<double>{4}},
                             {"", std::vector<double>{5}},      {".", std::vector<double>{6}},
                             {"c/../d", std::vector<double>{7}}};
  c.run.parts["empty"] = {};
  c.run.parts["nothing"] = {{"numbers", std::vector<double>{}},
                            {"counts", std::vector<std::int64_t>{}},
                            {"texts", std::vector<std::string>{}}};
  c.scene_toml = "title = \"x\"\n";
  c.digest = "sha256:0";
  c.simd = "avx2";
  c.outcome = "completed";
  c.step = std::int64_t{1} << 60;
  c.time = 0.1 + 0.2;
  return c;
}

/// A run of 40 steps that leaves a checkpoint at step 30 and one before it.
std::string checkpoint_of_a_run(const test::ScratchFolder& folder) {
  test::WritingRun run(folder / "run.h5");
  run.simulation.every(15, io::CheckpointWriter(folder / "checkpoint.h5", "title = \"x\"\n"));
  REQUIRE(run.simulation.run(40).ok());
  test::WritingRun other(folder / "other.h5");
  REQUIRE(other.simulation.run(30).ok());
  return io::digest(other.simulation.particles());
}

}  // namespace

TEST_CASE("a checkpoint gives back what was put in, bit for bit", "[checkpoint]") {
  const test::ScratchFolder folder;
  const io::Checkpoint a = made_up();
  io::write_checkpoint(folder / "checkpoint.h5", a);
  const io::Checkpoint b = io::read_checkpoint(folder / "checkpoint.h5");
  check_same(a.run.particles, b.run.particles);
  REQUIRE(a.run.parts.size() == b.run.parts.size());
  for (const auto& [name, state] : a.run.parts) check_same(state, b.run.parts.at(name));
  CHECK(b.scene_toml == a.scene_toml);
  CHECK(b.digest == a.digest);
  CHECK(b.simd == a.simd);
  CHECK(b.outcome == a.outcome);
  CHECK(b.step == a.step);
  CHECK(b.time == a.time);
}

TEST_CASE("equal checkpoints are equal files, byte for byte, whenever they are written", "[checkpoint][slow]") {
  const test::ScratchFolder folder;
  io::write_checkpoint(folder / "a.h5", made_up());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts whole seconds
  io::write_checkpoint(folder / "b.h5", made_up());
  const bool equal = test::read_text(folder / "a.h5") == test::read_text(folder / "b.h5");
  CHECK(equal);
}

TEST_CASE("a run restored from a checkpoint ends where the uninterrupted one does", "[checkpoint][restart]") {
  const test::ScratchFolder folder;
  const std::string digest_at_30 = checkpoint_of_a_run(folder);
  const io::FoundCheckpoint found = io::newest_checkpoint(folder.path());
  REQUIRE(found.checkpoint);
  CHECK(found.damaged.empty());
  CHECK(found.checkpoint->step == 30);
  CHECK(found.checkpoint->time == 30 * 40.0);
  CHECK(found.checkpoint->digest == digest_at_30);
  CHECK(found.checkpoint->outcome.empty());

  test::WritingRun resumed(folder / "run.h5"), whole(folder / "whole.h5");
  resumed.simulation.every(15, io::CheckpointWriter(folder / "checkpoint.h5"));
  resumed.simulation.restore(found.checkpoint->run);
  REQUIRE(resumed.simulation.run(70).ok());
  REQUIRE(whole.simulation.run(100).ok());
  CHECK(io::digest(resumed.simulation.particles()) == io::digest(whole.simulation.particles()));
  CHECK(resumed.energy->report().rms == whole.energy->report().rms);
  CHECK(io::newest_checkpoint(folder.path()).checkpoint->step == 90);
}

TEST_CASE("h5py opens a checkpoint, and hashlib finds its hash", "[checkpoint]") {
  const test::ScratchFolder folder;
  const std::string digest = checkpoint_of_a_run(folder);
  test::python_output("read_checkpoint.py", {(folder / "checkpoint.h5").string(), "30", digest});
}

TEST_CASE("every flipped byte is noticed", "[checkpoint]") {
  const test::ScratchFolder folder;
  checkpoint_of_a_run(folder);
  const std::filesystem::path file = folder / "checkpoint.h5";
  const std::string bytes = test::read_text(file);
  // Every byte of the last line, and bytes all over the rest, by a stride that is prime to everything.
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < 73; ++k) places.push_back(bytes.size() - 1 - k);
  for (std::size_t k = 0; k < 1500; ++k) places.push_back(k * 104'729 % bytes.size());
  std::size_t unnoticed = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::string damaged = bytes;
    damaged[places[k]] = static_cast<char>(damaged[places[k]] ^ (1 << (k % 8)));
    test::write_text(file, damaged);
    const std::string message = error_of([&] { io::read_checkpoint(file); });
    unnoticed += message.starts_with(file.string() + ": damaged") ? 0 : 1;
  }
  CHECK(unnoticed == 0);
  test::write_text(file, bytes);
  CHECK(error_of([&] { io::read_checkpoint(file); }).empty());
}

TEST_CASE("every truncation and every added byte is noticed", "[checkpoint]") {
  const test::ScratchFolder folder;
  checkpoint_of_a_run(folder);
  const std::filesystem::path file = folder / "checkpoint.h5";
  const std::string bytes = test::read_text(file);
  std::size_t unnoticed = 0;
  for (std::size_t k = 0; k < 500; ++k) {
    test::write_text(file, bytes.substr(0, k < 100 ? k : bytes.size() - 1 - (k - 100) * (k - 100) % bytes.size()));
    unnoticed += error_of([&] { io::read_checkpoint(file); }).starts_with(file.string() + ": damaged") ? 0 : 1;
  }
  test::write_text(file, bytes + "\n");
  unnoticed += error_of([&] { io::read_checkpoint(file); }).empty() ? 1 : 0;
  CHECK(unnoticed == 0);
}

TEST_CASE("a damaged checkpoint gives way to the one before, and only damaged ones are told", "[checkpoint]") {
  const test::ScratchFolder folder;
  CHECK_FALSE(io::newest_checkpoint(folder.path()).checkpoint);
  CHECK(io::newest_checkpoint(folder.path()).damaged.empty());
  CHECK_FALSE(io::newest_checkpoint(folder / "missing").checkpoint);

  checkpoint_of_a_run(folder);
  const std::string newest = (folder / "checkpoint.h5").string(), before = (folder / "checkpoint.previous.h5").string();
  CHECK(io::read_checkpoint(before).step == 15);
  std::string bytes = test::read_text(newest);
  bytes[bytes.size() / 2] ^= 1;
  test::write_text(newest, bytes);
  io::FoundCheckpoint found = io::newest_checkpoint(folder.path());
  REQUIRE(found.checkpoint);
  CHECK(found.checkpoint->step == 15);
  CHECK(found.damaged ==
        std::vector<std::string>{newest + ": damaged: its contents do not match the SHA-256 at its end"});

  test::write_text(before, "");
  found = io::newest_checkpoint(folder.path());
  CHECK_FALSE(found.checkpoint);
  REQUIRE(found.damaged.size() == 2);
  CHECK(found.damaged[1] ==
        before + ": damaged, or not a checkpoint: the line 'sha256:...' at the end of its 0 bytes is missing");
}

TEST_CASE("a process killed between the two renames leaves a valid checkpoint", "[checkpoint]") {
  const test::ScratchFolder folder;
  checkpoint_of_a_run(folder);
  // The newest was damaged when it was renamed, and the one that replaces it has not got its name yet.
  test::write_text(folder / "checkpoint.previous.h5", "damaged");
  std::filesystem::rename(folder / "checkpoint.h5", folder / "checkpoint.h5.new");
  const io::FoundCheckpoint found = io::newest_checkpoint(folder.path());
  REQUIRE(found.checkpoint);
  CHECK(found.checkpoint->step == 30);
  CHECK(found.damaged.size() == 1);
  // Half of a file beside is no damage.
  test::write_text(folder / "checkpoint.h5.new", "half");
  CHECK(io::newest_checkpoint(folder.path()).damaged.size() == 1);
}

TEST_CASE("a checkpoint that cannot be written is an error, and the old one stays", "[checkpoint][messages]") {
  const test::ScratchFolder folder;
  test::write_text(folder / "file", "");
  const std::string file = (folder / "file/checkpoint.h5").string();
  CHECK(error_of([&] { io::write_checkpoint(file, made_up()); }) == file + ".new: cannot be written: Not a directory");
  CHECK_THROWS_AS(io::read_checkpoint(folder / "none.h5"), FileError);
  CHECK(error_of([&] { io::read_checkpoint(folder / "none.h5"); }) ==
        (folder / "none.h5").string() + ": cannot be read: No such file or directory");
}

TEST_CASE("checkpoints of any name have a generation before", "[checkpoint]") {
  CHECK(io::previous_checkpoint("out/checkpoint.h5") == "out/checkpoint.previous.h5");
  CHECK(io::previous_checkpoint("state.h5") == "state.previous.h5");
  const test::ScratchFolder folder;
  io::write_checkpoint(folder / "state.h5", made_up());
  io::write_checkpoint(folder / "state.h5", made_up());
  CHECK(std::filesystem::exists(folder / "state.previous.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "state.h5.new"));
}

#else

TEST_CASE("a build without HDF5 writes and reads no checkpoint, and says why", "[checkpoint][messages]") {
  const test::ScratchFolder folder;
  const std::string file = (folder / "checkpoint.h5").string();
  CHECK(error_of([&] { io::write_checkpoint(file, {}); }) ==
        file + ": this build has no HDF5: configure with -DNOETHER_HDF5=ON, or use the preset release");
}

#endif
