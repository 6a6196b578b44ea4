// A trajectory in which a bit of a number has changed: verify says where.

#include "io/inspect.hpp"
#include "tests/io/support.hpp"

#include <fmt/format.h>

#include <random>

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
  const std::vector<io::MonitorSeries>& monitors() const { return monitors_; }

  std::vector<std::string> damaged() const { return io::verify(folder_ / "run.h5").damaged; }
  /// With one bit of a number flipped, wherever it stands.
  std::vector<std::string> damaged(double number, std::size_t bit) const {
    const std::string wanted(reinterpret_cast<const char*>(&number), sizeof number);
    const std::size_t at = bytes_.find(wanted);
    REQUIRE(at != std::string::npos);
    std::string changed = bytes_;
    char& byte = changed[at + bit / 8];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << bit % 8));
    write_text(folder_ / "run.h5", changed);
    return damaged();
  }

 private:
  ScratchFolder folder_;
  std::string bytes_;
  io::Frames frames_;
  std::vector<io::MonitorSeries> monitors_;
};

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
    CHECK(run.damaged(mass, random() % 52) ==
          std::vector<std::string>{
              "the ids, names, masses, types, bonds or parameters of the particles are not those that were written"});
  }
}

}  // namespace noether::test

#endif
