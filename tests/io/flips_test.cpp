// A trajectory in which a bit of a number has changed: verify says where.

#include "io/hdf5_file.hpp"
#include "io/hdf5_walk.hpp"
#include "io/inspect.hpp"
#include "io/repair.hpp"
#include "tests/io/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

#if NOETHER_HDF5

namespace noether::test {
namespace {

/// A finished run, and what verify says when a number of it has changed.
class Finished {
 public:
  Finished() {
    WritingRun run(folder_ / "run.h5");
    REQUIRE(run.simulation.run(60).ok());
    run.writer->finish(Outcome{});
    bytes_ = read_text(folder_ / "run.h5");
    frames_ = io::read_frames(folder_ / "run.h5");
    monitors_ = io::read_monitors(folder_ / "run.h5");
  }
  const io::Frames& frames() const { return frames_; }
  std::filesystem::path file() const { return folder_ / "run.h5"; }
  std::size_t size() const { return bytes_.size(); }
  const std::string& bytes() const { return bytes_; }
  const std::vector<io::MonitorSeries>& monitors() const { return monitors_; }

  std::vector<std::string> damaged() const { return io::verify(folder_ / "run.h5").damaged; }
  /// With one bit of a number flipped, wherever it stands.
  std::vector<std::string> damaged(double number, std::size_t bit) const {
    const std::string wanted(reinterpret_cast<const char*>(&number), sizeof number);
    const std::size_t at = bytes_.find(wanted);
    REQUIRE(at != std::string::npos);
    std::string changed = bytes_;
    flip(changed, at, bit);
    return damaged();
  }
  /// With another value of one byte.
  std::vector<std::string> damaged_to(std::size_t byte, char value) const {
    std::string changed = bytes_;
    changed[byte] = value;
    write_text(folder_ / "run.h5", changed);
    return damaged();
  }
  /// With one bit of the file flipped.
  std::vector<std::string> damaged_at(std::size_t byte, std::size_t bit) const {
    std::string changed = bytes_;
    flip(changed, byte, bit);
    return damaged();
  }

 private:
  void flip(std::string& bytes, std::size_t at, std::size_t bit) const {
    char& byte = bytes[at + bit / 8];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << bit % 8));
    write_text(folder_ / "run.h5", bytes);
  }

  ScratchFolder folder_;
  std::string bytes_;
  io::Frames frames_;
  std::vector<io::MonitorSeries> monitors_;
};

template <class Number> std::string as_bytes(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// All that can be read of a file: each path with its values, each attribute.
void read_all(const io::Hdf5File& file, const std::string& path, std::map<std::string, std::string>& all) {
  for (const std::string& name : file.attributes(path)) all[path + "@" + name] = file.attribute_bytes(path, name);
  if (file.is_group(path)) {
    all[path] = "a group";
    for (const std::string& name : file.children(path)) read_all(file, path + (path == "/" ? "" : "/") + name, all);
    return;
  }
  const io::Hdf5Dataset dataset = file.open(path);
  std::string& values = all[path];
  if (dataset.type() == io::ElementType::real) values = as_bytes(dataset.read_reals());
  if (dataset.type() == io::ElementType::integer) values = as_bytes(dataset.read_integers());
  if (dataset.type() == io::ElementType::text) {
    for (const std::string& one : dataset.read_texts()) values += one + '\n';
  }
}

/// All but whether the run is complete, which verify tells as it stands in the file.
bool is_held(const std::string& what) { return what != "/noether@complete"; }

io::Hdf5Walk walk(const std::string& bytes) {
  std::istringstream file(bytes);
  return io::walk_hdf5(file, bytes.size());
}

bool is_unused(const io::Hdf5Walk& walked, std::size_t byte) {
  return std::any_of(walked.unused.begin(), walked.unused.end(),
                     [&](const io::ByteRange& range) { return range.begin <= byte && byte < range.end; });
}

/// Bytes of the structure that HDF5 1.10 does not look at, or not at all of them: the superblock, the heads of nodes,
/// those of heaps, the beginnings of the headers of objects.
std::vector<std::size_t> structural_bytes(const std::string& bytes) {
  std::vector<std::size_t> found;
  const auto add = [&](std::size_t from, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) found.push_back(from + k);
  };
  add(8, 88);
  const auto add_all = [&](const std::string& mark, std::size_t count) {
    for (std::size_t at = bytes.find(mark); at != std::string::npos; at = bytes.find(mark, at + 1)) add(at, count);
  };
  add_all("TREE", 32);
  add_all("SNOD", 8);
  add_all(std::string("HEAP\0\0\0\0", 8), 32);
  // A header of version 1 with one name and one block, whose first message is that of a group.
  add_all(std::string("\x18\0\0\0\0\0\0\0\x11\0\x10\0\0\0\0\0", 16), 16);
  return found;
}

/// Changes bytes anywhere in a file. Each change is found, or is of a byte that nobody reads, or changes nothing that
/// can be read and is held.
void flip_anywhere(std::uint64_t seed, int rounds) {
  const Finished run;
  const io::Hdf5Walk walked = walk(run.bytes());
  REQUIRE_FALSE(walked.fault);
  std::map<std::string, std::string> before;
  read_all(io::Hdf5File::open_to_read(run.file()), "/", before);
  std::mt19937_64 random(seed);
  int found = 0, harmless = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::size_t byte = random() % run.size();
    const auto other = static_cast<char>(static_cast<unsigned char>(run.bytes()[byte]) ^ (1 + random() % 255));
    CAPTURE(round, byte, static_cast<int>(other));
    if (!run.damaged_to(byte, other).empty()) {
      CHECK_FALSE(is_unused(walked, byte));
      ++found;
      continue;
    }
    std::map<std::string, std::string> after;
    read_all(io::Hdf5File::open_to_read(run.file()), "/", after);
    std::vector<std::string> changed;
    for (const auto& [what, value] : before) {
      const auto now = after.find(what);
      if ((now == after.end() || now->second != value) && is_held(what)) changed.push_back(what);
    }
    for (const auto& [what, value] : after) {
      if (before.count(what) == 0 && is_held(what)) changed.push_back(what);
    }
    CHECK(changed == std::vector<std::string>{});
    ++harmless;
  }
  CHECK(found > 0);
  CHECK(harmless > 0);
}

std::string of_frame(const io::Frames& frames, std::size_t k) {
  return fmt::format("frame {} at step {} does not have the digest that was written with it", k, frames.frames[k].step);
}

}  // namespace

TEST_CASE("any bit of a frame that has changed is found, and the frame is named", "[inspect][flips]") {
  const Finished run;
  REQUIRE(run.damaged().empty());
  std::mt19937_64 random(1);
  const io::Frames& frames = run.frames();
  for (int round = 0; round < 100; ++round) {
    const std::size_t k = random() % frames.frames.size(), i = random() % 18, bit = random() % 52;
    CAPTURE(k, i, bit);
    const io::Frame& frame = frames.frames[k];
    CHECK(run.damaged(round % 2 == 0 ? frame.positions[i] : frame.velocities[i], bit) ==
          std::vector<std::string>{of_frame(frames, k)});
  }
  // Not to be a number at all is worse.
  CHECK(run.damaged(frames.frames[3].velocities[5], 62).size() == 1);
}

TEST_CASE("any bit of a sample, or of what particles have once, is found", "[inspect][flips]") {
  const Finished run;
  std::mt19937_64 random(2);
  for (const io::MonitorSeries& monitor : run.monitors()) {
    const auto& [name, content] = *std::next(monitor.quantities.begin(), 1);
    for (int round = 0; round < 20; ++round) {
      const std::size_t k = random() % monitor.step.size(), numbers = content.second.size() / monitor.step.size();
      CAPTURE(monitor.name, name, k);
      const double number = content.second[k * numbers];
      if (number == 0) continue;
      const std::vector<std::string> damaged = run.damaged(number, random() % 52);
      REQUIRE(damaged.size() == 1);
      CHECK(damaged[0].starts_with(fmt::format("monitor {}: sample ", monitor.name)));
      CHECK(damaged[0].ends_with(" does not have the digest that was written with it"));
    }
  }
  for (const double mass : run.frames().masses) {
    CHECK(
        run.damaged(mass, random() % 52) ==
        std::vector<std::string>{
            "the ids, names, masses, types, bonds or parameters of the particles differ from those that were written"});
  }
}

TEST_CASE("a bit of an attribute that never changes is found", "[inspect][flips]") {
  const Finished run;
  const std::string bytes = read_text(run.file());
  REQUIRE(io::Hdf5File::open_to_read(run.file()).text_attribute("/noether", "units") == "solar");
  const std::size_t at = bytes.find("solar");
  REQUIRE(at != std::string::npos);
  CHECK_FALSE(run.damaged_at(at, 1).empty());
  const std::size_t name = bytes.find("noether_unit");
  REQUIRE(name != std::string::npos);
  CHECK_FALSE(run.damaged_at(name + 3, 0).empty());
}

TEST_CASE("a bit of the scene, of the attributes of monitors or of the name of a digest is found", "[inspect][flips]") {
  const Finished run;
  const std::string bytes = read_text(run.file());
  // What verify says where a byte of a text is changed; HDF5 may leave copies of it in space that is not used any more.
  const auto said = [&](const std::string& text, std::size_t byte) {
    std::set<std::vector<std::string>> told;
    for (std::size_t at = bytes.find(text); at != std::string::npos; at = bytes.find(text, at + 1))
      told.insert(run.damaged_at(at + byte, 0));
    told.erase(std::vector<std::string>{});
    return told;
  };
  const auto one = [](const std::string& message) {
    return std::set<std::vector<std::string>>{std::vector<std::string>{message}};
  };
  CHECK(said("outer planets", 0) == one("the scene differs from the one that was written"));
  CHECK(said("scene_sha256", 1) == one("there is no digest of the scene, which every such file has"));
  CHECK(said("complete", 0) == one("it does not say whether it is complete, as every such file does"));
  CHECK(said("constants_sha256", 4) ==
        one("there is no digest of the constant data of the particles, which every such file has"));
  const io::MonitorSeries& monitor = run.monitors().front();
  REQUIRE(monitor.scale);
  const std::set<std::vector<std::string>> found = {run.damaged(*monitor.scale, 20)};
  CHECK(found == one(fmt::format("monitor {}: its units or other attributes differ from those that were written",
                                 monitor.name)));
}

TEST_CASE("a byte of the structure that has changed is found, also where HDF5 does not look", "[inspect][flips]") {
  const Finished run;
  const io::Hdf5Walk walked = walk(run.bytes());
  REQUIRE_FALSE(walked.fault);
  std::mt19937_64 random(5);
  std::vector<std::size_t> held;
  for (const std::size_t byte : structural_bytes(run.bytes())) {
    if (!is_unused(walked, byte)) held.push_back(byte);
  }
  REQUIRE(held.size() > 1000);
  for (const std::size_t byte : held) {
    std::string changed = run.bytes();
    for (const unsigned change : {1U, 1U << random() % 8, 255U}) {
      changed[byte] = static_cast<char>(static_cast<unsigned char>(run.bytes()[byte]) ^ change);
      CAPTURE(byte, change);
      // The signature and the version are what HDF5 looks at first.
      CHECK((walk(changed).fault || byte <= 8));
    }
  }
  for (int round = 0; round < 40; ++round) {
    const std::size_t byte = held[random() % held.size()];
    CAPTURE(byte);
    CHECK(run.damaged_at(byte, random() % 8).size() == 1);
  }
}

TEST_CASE("verify says where the structure is damaged, and repair leaves such a file alone", "[inspect][flips]") {
  const Finished run;
  const std::size_t tree = run.bytes().find("TREE");
  REQUIRE(tree != std::string::npos);
  const std::vector<std::string> expected = {fmt::format(
      "the structure of the file is damaged at byte {}: a node of the tree of '/' has a left neighbor at byte "
      "18446744073709551614 instead of none",
      tree + 8)};
  CHECK(run.damaged_at(tree + 8, 0) == expected);
  const std::string before = read_text(run.file());
  const io::Repair repaired = io::repair(run.file());
  CHECK(repaired.info.damaged == expected);
  CHECK(repaired.repaired.empty());
  CHECK(read_text(run.file()) == before);
}

TEST_CASE("a dataset of a complete file that has lost its tree is damage, and repair does not cut the others",
          "[inspect][flips]") {
  const Finished run;
  int tried = 0;
  for (std::size_t tree = run.bytes().find("TREE\1"); tree != std::string::npos;
       tree = run.bytes().find("TREE\1", tree + 1)) {
    std::string pointer(8, '\0'), changed = run.bytes();
    for (std::size_t k = 0; k < 8; ++k) pointer[k] = static_cast<char>(tree >> 8 * k & 255);
    const std::size_t at = run.bytes().find(pointer);
    REQUIRE(at != std::string::npos);
    changed.replace(at, 8, 8, '\xff');
    write_text(run.file(), changed);
    CHECK_FALSE(run.damaged().empty());
    CHECK(io::repair(run.file()).repaired.empty());
    CHECK(read_text(run.file()) == changed);
    ++tried;
  }
  CHECK(tried > 5);
}

TEST_CASE("trees of several levels are walked, also as a killed writer leaves them", "[inspect][flips]") {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "rows.h5";
  io::Hdf5File::create(file).take_name();
  const io::Hdf5File hdf5 = io::Hdf5File::open_to_append(file);
  hdf5.make_group("/noether");  // files of others are not judged
  io::Hdf5Dataset rows = hdf5.create_growing("/particles/rows", io::ElementType::real, {}, 4);
  std::vector<double> written;
  // A chunk has four rows, and a node 64 chunks.
  const auto append = [&](std::size_t chunks) {
    std::vector<double> more(4 * chunks);
    std::iota(more.begin(), more.end(), static_cast<double>(written.size()));
    rows.append(more);
    hdf5.flush();
    written.insert(written.end(), more.begin(), more.end());
    return read_text(file);
  };
  const auto nodes = [](const std::string& bytes) {
    std::vector<std::size_t> found;
    for (std::size_t at = bytes.find("TREE"); at != std::string::npos; at = bytes.find("TREE", at + 1)) {
      if (bytes[at + 4] == 1) found.push_back(at);
    }
    return found;
  };
  const auto level = [&](const std::string& bytes) {
    int most = 0;
    for (const std::size_t at : nodes(bytes)) most = std::max<int>(most, bytes[at + 5]);
    return most;
  };
  std::string before = append(80), after = before;
  REQUIRE(level(before) == 1);
  for (const bool lower : {true, false}) {
    CAPTURE(lower);
    // Until a node is divided. Its writer is killed after it wrote the node above, and before it wrote this one.
    for (std::size_t count = nodes(before).size(); nodes(after).size() == count;) {
      before = after;
      after = append(1);
      CHECK(walk(after).fault.value_or(io::Hdf5Fault{}).what == "");
    }
    std::string torn = after;
    constexpr std::size_t size = 24 + 64 * 32 + 24;
    int restored = 0;
    for (const std::size_t at : nodes(before)) {
      if (before[at + 5] != 0 || before.compare(at, size, after, at, size) == 0) continue;
      torn.replace(at, size, before, at, size);
      ++restored;
    }
    CHECK(restored == 1);
    CHECK(walk(torn).fault.value_or(io::Hdf5Fault{}).what == "");
    write_text(folder / "torn.h5", torn);
    CHECK(io::Hdf5File::open_to_read(folder / "torn.h5").open("/particles/rows").read_reals() == written);
    before = after = append(4200);
    CHECK(level(after) == 2);
    CHECK(walk(after).fault.value_or(io::Hdf5Fault{}).what == "");
  }
  // A neighbor that is none of its own.
  std::string changed = after;
  changed[nodes(after).back() + 8] ^= 1;
  CHECK(walk(changed).fault);
}

TEST_CASE("a bit that flips anywhere is found, or nothing that is held has changed", "[inspect][flips]") {
  flip_anywhere(3, 200);
}

TEST_CASE("so it is with thousands", "[inspect][flips][.][nightly]") { flip_anywhere(4, 3000); }

}  // namespace noether::test

#endif
