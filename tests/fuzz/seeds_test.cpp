// The seeds of the fuzz targets, and every input that once was a finding, go through the readers in every build.

#include "tests/fuzz/targets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scene_table.hpp"

namespace noether::test {
namespace {

/// Gives a target every file of a folder of seeds; fails if there is none.
template <class Target> void take_all(const std::string& folder, const Target& target) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(NOETHER_SOURCE_DIR "/tests/" + folder)) {
    if (!entry.is_regular_file()) continue;
    INFO(entry.path().string());
    CHECK_NOTHROW(target(read_text(entry.path())));
    ++count;
  }
  CHECK(count > 0);
}

TEST_CASE("what once broke the reader of quantities does not", "[fuzz]") {
  take_all("fuzz/seeds/quantity", take_quantity);
}

TEST_CASE("what once broke the reader of tables of bodies does not", "[fuzz]") {
  take_all("fuzz/seeds/csv_bodies", take_bodies);
  take_all("fuzz/seeds/horizons", take_bodies);
  take_all("data/horizons", take_bodies);
}

TEST_CASE("what once broke the reader of sites of bodies does not", "[fuzz]") {
  take_all("fuzz/seeds/body_sites", take_body_sites);
}

TEST_CASE("what once broke the readers of structures does not", "[fuzz]") {
  take_all("fuzz/seeds/structure", take_structure);
  take_all("data/lammps", take_structure);
}

TEST_CASE("what once broke the reader of scenes does not", "[fuzz]") {
  take_all("fuzz/seeds/scene", take_scene);
  take_all("scenes/good", take_scene);
  const ScratchFolder folder;
  for (const auto& file : write_scene_table(folder.path()).bad) {
    INFO(file.filename().string());
    CHECK_NOTHROW(take_scene(read_text(file)));
  }
}

TEST_CASE("what once broke the walk through HDF5 files does not", "[fuzz]") {
  take_all("fuzz/seeds/hdf5", take_hdf5);
  for (const auto& entry : std::filesystem::directory_iterator(NOETHER_SOURCE_DIR "/tests/fuzz/seeds/hdf5")) {
    const std::string bytes = read_text(entry.path());
    for (std::size_t size = 0; size < bytes.size(); size += 41) CHECK_NOTHROW(take_hdf5(bytes.substr(0, size)));
  }
}

#if NOETHER_HDF5
TEST_CASE("what once broke the reader of checkpoints does not", "[fuzz]") {
  take_all("fuzz/seeds/checkpoint_state", take_checkpoint_state);
  const std::string content = sample_checkpoint_content();
  CHECK_NOTHROW(take_checkpoint(content));
  CHECK_NOTHROW(take_checkpoint_content(content));
  CHECK_NOTHROW(take_checkpoint_content(content.substr(0, content.size() / 2)));
  CHECK_NOTHROW(take_checkpoint_content(""));
}
#endif

TEST_CASE("a property that does not hold is no refusal", "[fuzz]") {
  CHECK_THROWS_AS(accepted([] { require(false, "nothing holds"); }), Broken);
  CHECK_THROWS_AS(accepted([] { throw LogicError("a contract"); }), Broken);
  CHECK_THROWS_AS(accepted([] { std::vector<int>().at(0); }), std::out_of_range);
  CHECK_FALSE(accepted([] { throw FileError("no such file"); }));
}

}  // namespace
}  // namespace noether::test
