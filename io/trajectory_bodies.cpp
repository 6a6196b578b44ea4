#include "io/trajectory_bodies.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace noether::io {

namespace {

[[noreturn]] void refuse_bodies(const Hdf5File& file, const std::string& what) {
  throw FileError("damaged: " + what, {.file = file.name()});
}

std::vector<std::int64_t> integers(const Hdf5File& file, const std::string& name, std::size_t count) {
  std::vector<std::int64_t> values = file.open(bodies_path + "/" + name).read_integers();
  if (values.size() == count) return values;
  refuse_bodies(file, fmt::format("'{}' has {} entries where there are {}", name, values.size(), count));
}

std::vector<double> reals(const Hdf5File& file, const std::string& name, std::size_t count) {
  std::vector<double> values = file.open(bodies_path + "/" + name).read_reals();
  const bool finite = std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  if (values.size() == count && finite) return values;
  refuse_bodies(file, finite ? fmt::format("'{}' has {} entries where there are {}", name, values.size(), count)
                             : fmt::format("'{}' contains a value that is not finite", name));
}

}  // namespace

void write_rigid_bodies(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order) {
  const Bodies* bodies = state.bodies();
  if (bodies == nullptr) return;
  std::vector<std::int64_t> kind_of, held, kinds, types;
  std::vector<double> places, masses, charges;
  std::vector<std::string> names;
  for (const Index i : order) {
    const BodyKind* kind = bodies->kind(i);
    kind_of.push_back(kind == nullptr ? -1 : kind - bodies->kinds.data());
  }
  for (std::size_t k = 0; k < bodies->kinds.size(); ++k) {
    held.push_back(bodies->kinds[k].held ? 1 : 0);
    for (const BodySite& site : bodies->kinds[k].sites) {
      kinds.push_back(static_cast<std::int64_t>(k));
      places.insert(places.end(), site.place.data(), site.place.data() + 3);
      masses.push_back(site.mass);
      charges.push_back(site.charge);
      types.push_back(site.type);
      names.push_back(site.name);
    }
  }
  const auto sites = static_cast<Index>(kinds.size());
  file.write(bodies_path + "/kind", kind_of, {state.size()});
  file.write(bodies_path + "/held", held, {static_cast<Index>(held.size())});
  file.write(bodies_path + "/site_kind", kinds, {sites});
  file.write(bodies_path + "/site_place", places, {sites, 3});
  file.write(bodies_path + "/site_mass", masses, {sites});
  file.write(bodies_path + "/site_charge", charges, {sites});
  file.write(bodies_path + "/site_type", types, {sites});
  file.write(bodies_path + "/site_name", names);
}

std::shared_ptr<const Bodies> read_rigid_bodies(const Hdf5File& file, const std::vector<Index>& order) {
  if (!file.has(bodies_path + "/kind")) return nullptr;
  Bodies bodies;
  const std::vector<std::int64_t> kind_of = integers(file, "kind", order.size());
  const std::vector<std::int64_t> held = file.open(bodies_path + "/held").read_integers();
  const std::vector<std::int64_t> kinds = file.open(bodies_path + "/site_kind").read_integers();
  const std::size_t sites = kinds.size();
  const std::vector<double> places = reals(file, "site_place", 3 * sites), masses = reals(file, "site_mass", sites),
                            charges = reals(file, "site_charge", sites);
  const std::vector<std::int64_t> types = integers(file, "site_type", sites);
  const std::vector<std::string> names = file.open(bodies_path + "/site_name").read_texts();
  if (names.size() != sites) refuse_bodies(file, "sites of bodies and their names differ in number");
  const auto known = [&](std::int64_t kind, std::int64_t least) {
    if (kind >= least && kind < static_cast<std::int64_t>(held.size())) return kind;
    refuse_bodies(file, fmt::format("a body is of kind {} where there are {}", kind, held.size()));
  };
  for (const std::int64_t one : held) bodies.kinds.push_back({.sites = {}, .held = one != 0});
  for (std::size_t k = 0; k < sites; ++k) {
    if (!(masses[k] >= 0)) refuse_bodies(file, fmt::format("a site has the mass {}", masses[k]));
    if (types[k] < 0 || types[k] > 1 << 20) refuse_bodies(file, fmt::format("a site is of type {}", types[k]));
    bodies.kinds[static_cast<std::size_t>(known(kinds[k], 0))].sites.push_back(
        {.place = {places[3 * k], places[3 * k + 1], places[3 * k + 2]},
         .mass = masses[k],
         .charge = charges[k],
         .type = static_cast<int>(types[k]),
         .name = names[k]});
  }
  for (const Index row : order)
    bodies.kind_of.push_back(static_cast<int>(known(kind_of[static_cast<std::size_t>(row)], -1)));
  return std::make_shared<const Bodies>(std::move(bodies));
}

}  // namespace noether::io
