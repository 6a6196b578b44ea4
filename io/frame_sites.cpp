#include "io/frame_sites.hpp"

#include "engine/topology.hpp"
#include "io/frame_particles.hpp"
#include "io/trajectory_bodies.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_reader.hpp"
#include "io/trajectory_sites.hpp"
#include "io/trajectory_topology.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace noether::io {

bool FrameSites::are_in(const TrajectoryReader& reader) {
  const Hdf5File& file = reader.file();
  const auto& moving = reader.shared().columns;
  if (!moving.contains(std::string(BodyOrientation::name)) || !moving.contains(std::string(BodySpin::name)))
    return false;
  if (!file.has(bodies_path + "/site_kind")) {
    if (constants_differ(file))
      throw FileError("damaged: what rigid bodies are made of differs from what was written", {.file = file.name()});
    return false;
  }
  const std::vector<std::int64_t> kinds = file.open(bodies_path + "/site_kind").read_integers();
  return std::adjacent_find(kinds.begin(), kinds.end()) != kinds.end();
}

FrameSites::FrameSites(const TrajectoryReader& reader, const std::filesystem::path& file)
    : bodies_(read_frame_particles(file, {.frame = 0}).particles),
      order_(read_order(reader.file(), bodies_.size())),
      sites_(bodies_, false),
      shared_(reader.shared()) {
  all_.resize(static_cast<std::size_t>(bodies_.size()));
  std::iota(all_.begin(), all_.end(), Index{0});
  SiteConstants constants = site_constants(bodies_, sites_, all_);
  shared_.ids.resize(constants.names.size());
  std::iota(shared_.ids.begin(), shared_.ids.end(), std::int64_t{0});
  shared_.names = std::move(constants.names);
  shared_.masses = std::move(constants.masses);
  shared_.charges = std::move(constants.charges);
  shared_.types.clear();
  for (const std::int64_t one : constants.types) {
    const std::vector<std::string>& names = bodies_.topology()->type_names;
    const auto type = static_cast<std::size_t>(one);
    shared_.types.push_back(type < names.size() ? names[type] : std::to_string(type));
  }
}

Frame FrameSites::frame(const Frame& of_bodies) {
  const auto take = [&](const std::vector<double>& from, auto& to) {
    const auto width = static_cast<std::size_t>(to.width);
    for (Index i = 0; i < bodies_.size(); ++i) {
      const auto row = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
      for (std::size_t k = 0; k < width; ++k) to.component(static_cast<int>(k))[i] = from.at(width * row + k);
    }
  };
  take(of_bodies.positions, bodies_.positions());
  take(of_bodies.velocities, bodies_.velocities());
  take(of_bodies.columns.at(std::string(BodyOrientation::name)), bodies_.column<BodyOrientation>());
  take(of_bodies.columns.at(std::string(BodySpin::name)), bodies_.column<BodySpin>());
  for (Index i = 0; i < bodies_.images().size(); ++i) {
    const auto row = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
    for (std::size_t k = 0; k < 3; ++k)
      bodies_.images().component(static_cast<int>(k))[i] = of_bodies.images.at(3 * row + k);
  }
  sites_.follow(bodies_);

  Frame all{.step = of_bodies.step, .time = of_bodies.time, .positions = {}, .velocities = {}};
  all.edges = of_bodies.edges;
  for (const auto& [name, column] : shared_.columns) {  // of the body of each site
    const auto width = static_cast<std::size_t>(column.first);
    std::vector<double>& values = all.columns[name];
    for (Index i = 0; i < bodies_.size(); ++i) {
      const auto row = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
      const auto from = of_bodies.columns.at(name).begin() + static_cast<std::ptrdiff_t>(width * row);
      for (Index a = sites_.first(i); a < sites_.first(i + 1); ++a)
        values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(width));
    }
  }
  SiteRows rows;
  site_rows(bodies_, sites_, all_, rows);
  all.positions = std::move(rows.positions);
  all.velocities = std::move(rows.velocities);
  all.images = std::move(rows.images);
  return all;
}

}  // namespace noether::io
