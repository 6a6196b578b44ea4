#include "cli/plot_frames.hpp"

#include "cli/run_gravity.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_reader.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace noether {

namespace {

bool is_finite(const io::Frame& frame) {
  const auto finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  return finite(frame.positions) && finite(frame.velocities) && finite(frame.variables);
}

}  // namespace

PlotFrames::PlotFrames(io::Frames what_they_share, std::vector<double> their_times, Read read_frame)
    : shared(std::move(what_they_share)),
      times(std::move(their_times)),
      numbers(times.size()),
      primary(primary_of(shared.masses)),
      read(std::move(read_frame)) {
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  periodic = !times.empty() && !read(0).edges.empty();
}

PlotFrames::PlotFrames(io::Frames all) {
  const auto frames = std::make_shared<const std::vector<io::Frame>>(std::exchange(all.frames, {}));
  std::vector<double> their_times;
  for (const io::Frame& frame : *frames) their_times.push_back(frame.time);
  *this = PlotFrames(std::move(all), std::move(their_times), [frames](std::size_t k) { return frames->at(k); });
}

FramesInFile open_frames(const std::filesystem::path& file) {
  struct Looked {
    io::Frames shared;
    std::vector<double> times;
    std::vector<std::size_t> numbers;
    std::size_t all = 0;
  };
  // A damaged file is read as a whole by a child process first; frames that are read again later do no more.
  Looked looked = io::try_first(file, [&] {
    const io::TrajectoryReader reader(file);
    Looked found{reader.shared(), {}, {}, static_cast<std::size_t>(reader.frames())};
    for (std::size_t k = 0; k < found.all; ++k) {
      const io::Frame frame = reader.frame(static_cast<Index>(k));
      if (!is_finite(frame)) continue;
      found.times.push_back(frame.time);
      found.numbers.push_back(k);
    }
    return found;
  });
  const auto reader = std::make_shared<std::optional<io::TrajectoryReader>>();
  const auto read = [reader, file, numbers = looked.numbers](std::size_t k) {
    if (!*reader) reader->emplace(file);
    return (*reader)->frame(static_cast<Index>(numbers.at(k)));
  };
  FramesInFile result{PlotFrames(std::move(looked.shared), std::move(looked.times), read), looked.all};
  result.frames.numbers = std::move(looked.numbers);
  result.frames.close = [reader] { reader->reset(); };
  result.frames.close_file();
  return result;
}

KeptFrames kept_frames(const PlotFrames& all, std::size_t most, std::size_t shown) {
  KeptFrames kept{all.shared, 0};
  const std::size_t stride = std::max<std::size_t>(1, (all.size() + most - 1) / std::max<std::size_t>(most, 1));
  for (std::size_t k = shown % stride; k < all.size(); k += stride) {
    if (k == shown) kept.shown = kept.frames.frames.size();
    kept.frames.frames.push_back(all.frame(k));
  }
  return kept;
}

std::size_t most_frames_of_paths(std::size_t bodies) {
  constexpr std::size_t most = 20'000, most_places = 1'200'000;
  return std::clamp<std::size_t>(most_places / std::max<std::size_t>(bodies, 1), 1, most);
}

}  // namespace noether
