#include "cli/view_data.hpp"

#include "cli/run_gravity.hpp"
#include "cli/view_paths.hpp"
#include "engine/sums.hpp"
#include "io/inspect.hpp"
#include "io/sandbox.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_reader.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace noether {

namespace {

constexpr std::size_t most_energies = 1200;
/// Numbers of frames that are read at most: more could not stand in a page.
constexpr std::size_t most_coordinates = 15'000'000;

Vec3<double> row_of(const std::vector<double>& rows, std::size_t i) {
  return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
}

/// The mean of rows, weighted by mass; of bodies without mass all alike.
Vec3<double> center_of(const std::vector<double>& rows, const std::vector<double>& masses) {
  const auto n = static_cast<Index>(masses.size());
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  const double total = sum_over<double>(n, [&](Index i) { return masses[at(i)]; });
  Vec3<double> center;
  for (std::size_t k = 0; k < 3; ++k) {
    center[static_cast<Index>(k)] =
        total > 0 ? sum_over<double>(n, [&](Index i) { return masses[at(i)] * rows[3 * at(i) + k]; }) / total
                  : sum_over<double>(n, [&](Index i) { return rows[3 * at(i) + k]; }) / static_cast<double>(n);
  }
  return center;
}

/// Which frames of the file are shown before anybody knows how large the page becomes.
std::vector<std::size_t> chosen_frames(std::size_t all, std::size_t particles, const ViewWish& wish) {
  std::vector<std::size_t> chosen;
  if (wish.every > 0) {
    for (std::size_t k = 0; k < all; k += wish.every) chosen.push_back(k);
  } else {
    chosen = spread_numbers(all, wish.frames > 0 ? std::min(wish.frames, all) : all);
  }
  const std::size_t most = std::max<std::size_t>(most_coordinates / (3 * particles), 2);
  if (chosen.size() <= most) return chosen;
  std::vector<std::size_t> fewer;
  for (const std::size_t k : spread_numbers(chosen.size(), most)) fewer.push_back(chosen[k]);
  return fewer;
}

template <class Value> std::vector<Value> picked(const std::vector<Value>& all, const std::vector<std::size_t>& rows) {
  std::vector<Value> result;
  result.reserve(rows.size());
  for (const std::size_t i : rows) result.push_back(all[i]);
  return result;
}

/// Whether a page can hold the numbers, which are floats there.
bool is_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::abs(x) < 1e38; });
}

bool can_be_shown(const io::Frame& frame) {
  const bool has_room = std::all_of(frame.edges.begin(), frame.edges.end(), [](double edge) { return edge > 0; });
  return has_room && is_finite(frame.edges) && is_finite(frame.positions) && is_finite(frame.velocities);
}

/// A coordinate as a fraction of the edge, in units of 2^-16 and modulo 1.
std::uint16_t fraction_of(double x, double edge) {
  const double fraction = x / edge;
  return static_cast<std::uint16_t>(
      static_cast<std::int64_t>(std::nearbyint((fraction - std::floor(fraction)) * 65536)) & 0xffff);
}

void take_frame(ViewData& data, const io::Frame& frame, const std::vector<std::size_t>& rows,
                const std::vector<double>& masses) {
  ViewFrame taken{.step = frame.step, .time = frame.time};
  if (!frame.edges.empty()) {
    taken.edges = row_of(frame.edges, 0);
    for (const std::size_t i : rows) {
      for (std::size_t k = 0; k < 3; ++k)
        data.fractions.push_back(fraction_of(frame.positions[3 * i + k], frame.edges[k]));
    }
    data.frames.push_back(taken);
    return;
  }
  const bool orbits = data.primary >= 0;
  taken.center =
      orbits ? row_of(frame.positions, static_cast<std::size_t>(data.primary)) : center_of(frame.positions, masses);
  taken.velocity =
      orbits ? row_of(frame.velocities, static_cast<std::size_t>(data.primary)) : center_of(frame.velocities, masses);
  const bool alone = masses.size() == 1;  // relative to itself it would not move
  if (alone || !taken.center.allFinite()) taken.center.setZero();
  if (alone || !taken.velocity.allFinite()) taken.velocity.setZero();
  const bool few = rows.size() <= few_bodies;
  for (const std::size_t i : rows) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Index>(k);
      data.positions.push_back(static_cast<float>(frame.positions[3 * i + k] - taken.center[axis]));
      if (few) data.velocities.push_back(static_cast<float>(frame.velocities[3 * i + k] - taken.velocity[axis]));
    }
  }
  data.frames.push_back(taken);
}

/// The largest sample of each stretch, so that no peak is left out.
ViewEnergy energy_of(const std::vector<io::MonitorSeries>& monitors) {
  ViewEnergy energy;
  const auto found = std::find_if(monitors.begin(), monitors.end(), [](const auto& m) { return m.name == "energy"; });
  if (found == monitors.end()) return energy;
  const auto values = found->quantities.find("relative_error");
  if (values == found->quantities.end()) return energy;
  const std::vector<double>& errors = values->second.second;
  const std::size_t samples = std::min(errors.size(), found->time.size());
  const std::size_t stretch = (samples + most_energies - 1) / most_energies;
  for (std::size_t k = 0; k < samples; k += stretch) {
    const std::size_t end = std::min(k + stretch, samples);
    std::size_t worst = k;
    for (std::size_t j = k; j < end; ++j) {
      if (!(std::abs(errors[j]) <= std::abs(errors[worst])) && std::isfinite(errors[j])) worst = j;
    }
    if (!std::isfinite(errors[worst])) continue;
    energy.time.push_back(found->time[worst]);
    energy.size.push_back(std::abs(errors[worst]));
  }
  return energy;
}

/// Everything but the caption, the energy and how bodies move.
ViewData read_frames_to_view(const std::filesystem::path& file, const SceneValue& scene, const ViewWish& wish,
                             const Parts& parts) {
  const io::TrajectoryReader reader(file);
  const io::Frames& shared = reader.shared();
  ViewData data;
  data.length_unit = shared.length_unit == "1" ? "" : shared.length_unit;
  data.frames_in_file = static_cast<std::size_t>(reader.frames());
  data.particles_in_file = shared.ids.size();
  const std::size_t shown = std::min(data.particles_in_file, most_viewed_particles);
  const std::vector<std::size_t> rows = spread_numbers(data.particles_in_file, shown);
  data.names = picked(shared.names, rows);
  data.masses = picked(shared.masses, rows);
  if (!shared.types.empty()) data.types = picked(shared.types, rows);
  data.links = read_links(reader.file(), scene, parts, io::known_units(shared.units, file), shared, rows);

  const bool periodic = reader.file().has(io::image_path + "/value");
  if (!periodic && shown <= few_bodies && may_have_gravity(scene, parts)) {
    if (const auto primary = primary_of(data.masses)) data.primary = static_cast<std::int64_t>(*primary);
  }
  if (data.primary >= 0) {
    const double G = constant_of_gravity(scene, io::known_units(shared.units, file).G);
    for (const double mass : data.masses)
      data.mu.push_back(G * (data.masses[static_cast<std::size_t>(data.primary)] + mass));
  }
  for (const std::size_t k : chosen_frames(data.frames_in_file, shown, wish)) {
    const io::Frame frame = reader.frame(static_cast<Index>(k));
    if (can_be_shown(frame)) {
      take_frame(data, frame, rows, shared.masses);
    } else {
      ++data.failed_frames;
    }
  }
  if (data.frames.empty()) {
    throw Error("there is no frame to view: in each of them a number is not finite");
  }
  return data;
}

/// @throws Error  for files that hold nothing a page could play
void check_for_view(const io::FileInfo& about, const std::string& file) {
  if (about.kind != "trajectory") {
    throw Error(fmt::format("{} is a {}, which holds one moment; view the run.h5 beside it", file, about.kind));
  }
  if (about.variables > 0) {
    throw Error(fmt::format(
        "{} is the run of a [system], which has no particles; `noether plot {}` draws its variables", file, file));
  }
  if (about.frames == 0) {
    throw Error(fmt::format("{} has no frames to view; add [[every]] with type = \"trajectory\" to the scene", file));
  }
  if (about.particles == 0) throw Error(fmt::format("{} has no particles to view", file));
}

}  // namespace

std::vector<std::size_t> spread_numbers(std::size_t all, std::size_t count) {
  std::vector<std::size_t> numbers;
  if (count == 1 && all > 0) return {all - 1};
  for (std::size_t k = 0; k < count; ++k) numbers.push_back((2 * k * (all - 1) + (count - 1)) / (2 * (count - 1)));
  return numbers;
}

ViewData with_frames(const ViewData& data, std::size_t frames) {
  ViewData fewer = data;
  fewer.frames.clear(), fewer.fractions.clear(), fewer.positions.clear(), fewer.velocities.clear();
  const auto row = static_cast<std::ptrdiff_t>(3 * data.particles());
  const auto copy = [row](const auto& from, auto& to, std::size_t k) {
    if (from.empty()) return;
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(k) * row;
    to.insert(to.end(), begin, begin + row);
  };
  for (const std::size_t k : spread_numbers(data.frames.size(), frames)) {
    fewer.frames.push_back(data.frames[k]);
    copy(data.fractions, fewer.fractions, k);
    copy(data.positions, fewer.positions, k);
    copy(data.velocities, fewer.velocities, k);
  }
  choose_paths(fewer);
  return fewer;
}

ViewData read_view_data(const std::filesystem::path& file, const ViewWish& wish, const Parts& parts) {
  const io::FileInfo about = io::info(file);
  check_for_view(about, file.string());
  const SceneValue scene = scene_in_file(about.scene_toml, file);
  ViewData data = io::try_first(file, [&] { return read_frames_to_view(file, scene, wish, parts); });
  const auto [first, last] = std::pair(data.frames.front().time, data.frames.back().time);
  data.caption = caption_of(scene, file, about.time_unit, shown_time(first, last), parts);
  const auto drawn = [](const std::string& monitor, const std::string& quantity) {
    return monitor == "energy" && quantity == "relative_error";
  };
  data.energy = energy_of(io::read_monitors(file, {.wanted = drawn}));
  choose_paths(data);
  return data;
}

}  // namespace noether
