#include "io/trajectory_sites.hpp"

#include "engine/charge.hpp"
#include "engine/topology.hpp"
#include "io/trajectory_constants.hpp"
#include "io/trajectory_layout.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace noether::io {

SiteConstants site_constants(const ParticleSystem<double>& bodies, const Sites<double>& sites,
                             const std::vector<Index>& order) {
  SiteConstants all;
  const ParticleSystem<double>& s = sites.particles();
  const Topology* topology = bodies.topology();
  const bool typed = topology != nullptr && !(topology->types.empty() && topology->type_names.empty());
  const bool charged = s.has<Charge>();
  for (const Index i : order) {
    const BodyKind* kind = bodies.bodies()->kind(i);
    for (Index a = sites.first(i); a < sites.first(i + 1); ++a) {
      const BodySite* site = kind != nullptr ? &kind->sites[static_cast<std::size_t>(a - sites.first(i))] : nullptr;
      const bool alone = site == nullptr || kind->sites.size() == 1;  // it goes by the name of its body
      all.particles.push_back(i);
      all.names.push_back(alone || site->name.empty() ? bodies.name(i) : site->name);
      all.masses.push_back(site != nullptr ? site->mass : s.masses()[a]);
      if (charged) all.charges.push_back(s.column<Charge>()[a]);
      if (typed) all.types.push_back(site != nullptr ? site->type : topology->type(i));
    }
  }
  return all;
}

void site_rows(const ParticleSystem<double>& bodies, const Sites<double>& sites, const std::vector<Index>& order,
               SiteRows& rows) {
  rows.positions.clear(), rows.velocities.clear(), rows.images.clear();
  const ParticleSystem<double>& s = sites.particles();
  for (const Index i : order) {
    const Vec3<double> rate = angular_velocity<double>(bodies.column<BodyOrientation>()[i],
                                                       bodies.column<BodySpin>()[i], bodies.column<BodyInertia>()[i]);
    for (Index a = sites.first(i); a < sites.first(i + 1); ++a) {
      const Vec3<double> x = s.positions()[a], v = bodies.velocities()[i] + cross<double>(rate, sites.arm(a));
      rows.positions.insert(rows.positions.end(), x.data(), x.data() + 3);
      rows.velocities.insert(rows.velocities.end(), v.data(), v.data() + 3);
      if (!s.box().is_periodic()) continue;
      const Vec3<std::int32_t> images = s.images()[a];
      rows.images.insert(rows.images.end(), images.data(), images.data() + 3);
    }
  }
}

bool has_several_sites(const ParticleSystem<double>& s) {
  const Bodies* bodies = s.bodies();
  return bodies != nullptr && std::any_of(bodies->kinds.begin(), bodies->kinds.end(),
                                          [](const BodyKind& kind) { return kind.sites.size() > 1; });
}

namespace {

void write_site_constants(const Hdf5File& file, const ParticleSystem<double>& state, const SiteConstants& sites) {
  const std::vector<Index> shape{static_cast<Index>(sites.names.size())};
  std::vector<std::int64_t> ids, particles, species;
  for (const std::int64_t i : sites.particles) {
    ids.push_back(static_cast<std::int64_t>(ids.size()));
    particles.push_back(state.ids()[static_cast<std::size_t>(i)]);
  }
  for (const std::int64_t type : sites.types) species.push_back(type + 1);
  file.write(sites_path + "/id", ids, shape);
  file.write(sites_path + "/mass", sites.masses, shape);
  file.write(sites_path + "/name", sites.names);
  file.write(sites_path + "/particle", particles, shape);
  set_unit(file, sites_path + "/mass", "mass", state.units());
  if (!species.empty()) file.write(sites_path + "/species", species, shape);
  if (sites.charges.empty()) return;
  file.write(sites_path + "/charge", sites.charges, shape);
  set_unit(file, sites_path + "/charge", "charge", state.units());
  file.set_attribute(sites_path + "/charge", "type", "effective");
}

}  // namespace

void SiteDatasets::create(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order,
                          const std::function<Index(Index)>& rows_at_once) {
  if (!has_several_sites(state)) {
    throw Error("frames were to have the sites of rigid bodies, but no body has more than one", {.key = "sites"});
  }
  sites_.follow(state, false);
  count_ = sites_->particles().size();
  write_site_constants(file, state, site_constants(state, *sites_, order));
  const Index rows = rows_at_once(3 * count_);
  const auto growing = [&](const std::string& name, ElementType type) {
    const std::string group = sites_path + "/" + name;
    for (const char* one : {"/step", "/time"}) file.link(particles_path + "/position" + one, group + one);
    return file.create_growing(group + "/value", type, {count_, 3}, rows);
  };
  position_ = BufferedDataset<double>(growing("position", ElementType::real));
  velocity_ = BufferedDataset<double>(growing("velocity", ElementType::real));
  set_unit_of_motion(file, sites_path + "/position/value", "length", state.units());
  set_unit_of_motion(file, sites_path + "/velocity/value", "velocity", state.units());
  if (state.box().is_periodic()) image_ = BufferedDataset<std::int64_t>(growing("image", ElementType::integer));
  file.link(particles_path + "/box", sites_path + "/box");
}

void SiteDatasets::open(
    const Hdf5File& file,
    const std::function<Hdf5Dataset(const std::string& path, const std::vector<Index>& row)>& open) {
  if (!file.has(sites_path + "/id")) return;
  count_ = file.open(sites_path + "/id").rows();
  const std::vector<Index> row{count_, 3};
  position_ = BufferedDataset<double>(open(sites_path + "/position/value", row));
  velocity_ = BufferedDataset<double>(open(sites_path + "/velocity/value", row));
  if (file.has(sites_path + "/image/value"))
    image_ = BufferedDataset<std::int64_t>(open(sites_path + "/image/value", row));
}

void SiteDatasets::append(const ParticleSystem<double>& state, const std::vector<Index>& order, SiteRows& rows) {
  if (count_ == 0) return;
  sites_.follow(state, false);
  site_rows(state, *sites_, order, rows);
  if (static_cast<Index>(rows.positions.size()) != 3 * count_) {
    throw Error(fmt::format("the file has {} sites of bodies, but the run now has {}; after an edit write another file",
                            count_, rows.positions.size() / 3));
  }
  position_.append(rows.positions);
  velocity_.append(rows.velocities);
  image_.append(std::vector<std::int64_t>(rows.images.begin(), rows.images.end()));
}

void SiteDatasets::write_out() {
  image_.write_out();
  velocity_.write_out();
  position_.write_out();
}

std::vector<std::string> growing_sites(const Hdf5File& file) {
  std::vector<std::string> paths;
  for (const char* name : {"/image/value", "/position/value", "/velocity/value"}) {
    if (file.has(sites_path + name)) paths.push_back(sites_path + name);
  }
  return paths;
}

}  // namespace noether::io
