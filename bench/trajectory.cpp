/// What files cost: bytes of frames a second, and 10^6 steps of six bodies with a frame every 100 steps and
/// checkpoints, against the bare run.
///
/// Protocol: wall time, since the disk takes part. Bytes: the median of 5 files of 200 MB. Runs: bare and writing in
/// turn, 20 slices each; the median of 5 ratios. The files lie in the folder for temporary files.

#include "bench/planets.hpp"

#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"

#include <filesystem>

using namespace noether;

namespace {

/// A folder that is gone at the end.
struct Scratch {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "noether_bench_trajectory";
  Scratch() { std::filesystem::create_directories(folder); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(folder); }
};

/// Bytes a second of frames of `n` particles at every step of a run that costs nothing.
void measure_bytes(const bench::Rows& rows, const Scratch& scratch, Index n) {
  const std::int64_t frames = 200'000'000 / (48 * n);
  std::vector<double> rates;
  for (int repeat = 0; repeat < 5; ++repeat) {
    ParticleSystem<double> s;
    for (Index i = 0; i < n; ++i) s.add("", 0, {static_cast<double>(i), 0, 0}, {1, 0, 0});
    Simulation run(std::move(s), compose(KineticPotential(Sum<>()), schemes::verlet), 1.0);
    auto& writer = run.every(1, io::TrajectoryWriter{scratch.folder / "run.h5"});
    const double seconds = bench::seconds_of([&] {
      static_cast<void>(run.run(frames));
      writer.flush();
    });
    rates.push_back(static_cast<double>(std::filesystem::file_size(scratch.folder / "run.h5")) / seconds);
  }
  rows.add("frames", "bytes_per_s", bench::Measured(rates), "B/s", n);
}

template <class Make>
void measure_run(const bench::Rows& rows, const Scratch& scratch, const std::string& name, const Make& make) {
  constexpr std::int64_t steps = 1'000'000, slice = steps / 20;
  std::vector<double> ratios;
  for (int repeat = 0; repeat < 5; ++repeat) {
    Simulation<double> bare = make(), writing = make();
    writing.every(100, io::TrajectoryWriter{scratch.folder / "run.h5"});
    writing.every(steps / 2, io::CheckpointWriter{scratch.folder / "checkpoint.h5"});
    double without = 0, with = 0;
    while (bare.step() < steps) {
      without += bench::seconds_of([&] { static_cast<void>(bare.run(slice)); });
      with += bench::seconds_of([&] { static_cast<void>(writing.run(slice)); });
    }
    ratios.push_back(with / without);
  }
  rows.add(name, "writing_over_bare", bench::Measured(ratios), "1", 6);
}

}  // namespace

int main(int count, char** arguments) {
  const bench::Rows rows("trajectory", count, arguments);
  const Scratch scratch;
  set_thread_count(1);
  for (const Index n : {6, 1000, 100'000}) measure_bytes(rows, scratch, n);
  measure_run(rows, scratch, "leapfrog6", bench::leapfrog6);
  measure_run(rows, scratch, "wh6", bench::wh6);
}
