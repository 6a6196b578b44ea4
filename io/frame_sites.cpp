#include "io/frame_sites.hpp"

#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "io/frame_particles.hpp"
#include "io/trajectory_bodies.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_reader.hpp"
#include "io/trajectory_topology.hpp"

#include <algorithm>
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
  const ParticleSystem<double>& sites = sites_.particles();
  shared_.ids.clear(), shared_.names.clear(), shared_.masses.clear(), shared_.types.clear(), shared_.charges.clear();
  const Topology* topology = bodies_.topology();
  for (Index i = 0; i < bodies_.size(); ++i) {
    const BodyKind* kind = bodies_.bodies()->kind(i);
    for (Index a = sites_.first(i); a < sites_.first(i + 1); ++a) {
      const BodySite* site = kind != nullptr ? &kind->sites[static_cast<std::size_t>(a - sites_.first(i))] : nullptr;
      shared_.ids.push_back(a);
      const bool alone = site == nullptr || kind->sites.size() == 1;  // it goes by the name of its body
      shared_.names.push_back(alone || site->name.empty() ? bodies_.name(i) : site->name);
      shared_.masses.push_back(site != nullptr ? site->mass : sites.masses()[a]);
      if (sites.has<Charge>()) shared_.charges.push_back(sites.column<Charge>()[a]);
      if (topology == nullptr || topology->type_names.empty()) continue;
      const auto type = static_cast<std::size_t>(site != nullptr ? site->type : topology->type(i));
      shared_.types.push_back(type < topology->type_names.size() ? topology->type_names[type] : std::to_string(type));
    }
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
  const ParticleSystem<double>& sites = sites_.particles();
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
  for (Index i = 0; i < bodies_.size(); ++i) {
    const Vec3<double> rate = angular_velocity<double>(bodies_.column<BodyOrientation>()[i],
                                                       bodies_.column<BodySpin>()[i], bodies_.column<BodyInertia>()[i]);
    for (Index a = sites_.first(i); a < sites_.first(i + 1); ++a) {
      const Vec3<double> x = sites.positions()[a], v = bodies_.velocities()[i] + cross<double>(rate, sites_.arm(a));
      all.positions.insert(all.positions.end(), x.data(), x.data() + 3);
      all.velocities.insert(all.velocities.end(), v.data(), v.data() + 3);
      if (all.edges.empty()) continue;
      const Vec3<std::int32_t> images = sites.images()[a];
      all.images.insert(all.images.end(), images.data(), images.data() + 3);
    }
  }
  return all;
}

}  // namespace noether::io
