#include "scene/read_rigid_body.hpp"

#include "engine/given_orbit.hpp"
#include "io/body_sites.hpp"
#include "numbers/suggest.hpp"
#include "scene/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace noether {

namespace {

/// One `[[particles.rigid_body.site]]`.
BodySite read_site(TableReader& reader, const io::SiteTypes& types) {
  reader.expect_only({"name", "place", "mass", "charge", "type"});
  BodySite site{.name = reader.text("name")};
  const auto place = reader.vector("place", "length");
  if (!place) reader.fail(nullptr, "place", fmt::format("{} has no place; give three lengths", reader.what()));
  site.place = column(*place);
  site.mass = reader.quantity("mass", "mass").value_or(0);
  if (site.mass < 0) {
    reader.fail("mass", fmt::format("mass = {} is below 0; 0 or more is expected", to_text(*reader.find("mass"))));
  }
  const std::optional<double> charge = reader.quantity("charge", "charge");
  const std::vector<std::string>& names = types.names;
  if (!reader.has("type") && names.size() > 1) {
    reader.fail(nullptr, "type",
                fmt::format("{} has no type, but there are {} types; give one", reader.what(), names.size()));
  }
  if (reader.has("type")) {
    const std::string type = reader.text("type");
    const auto found = std::find(names.begin(), names.end(), type);
    if (found == names.end()) reader.fail("type", fmt::format("unknown type '{}'{}", type, did_you_mean(type, names)));
    site.type = static_cast<int>(found - names.begin());
  }
  site.charge = charge.value_or(types.charge(site.type));
  return site;
}

SceneValue value_of(const BodySite& site, const UnitSystem& units, const io::SiteTypes& types) {
  SceneValue table = SceneValue::table();
  if (!site.name.empty()) table.put("name", SceneValue::of(site.name));
  SceneValue::Array place;
  for (int k = 0; k < 3; ++k) place.push_back(detail::quantity_value(site.place[k], "length", units));
  table.put("place", SceneValue::of(std::move(place)));
  table.put("mass", detail::quantity_value(site.mass, "mass", units));
  if (site.charge != 0 || !types.names.empty())
    table.put("charge", detail::quantity_value(site.charge, "charge", units));
  if (!types.names.empty()) table.put("type", SceneValue::of(types.names[static_cast<std::size_t>(site.type)]));
  return table;
}

std::vector<BodySite> read_sites(TableReader& body, const std::filesystem::path& folder, const io::SiteTypes& types,
                                 SceneValue& effective) {
  std::vector<BodySite> sites;
  if (body.has("sites")) {
    if (body.has("site")) body.fail("site", "sites come from a file and from tables; give one or the other");
    const std::string file = body.text("sites");
    if (file.empty()) body.fail("sites", "sites = \"\" names no file; give one, such as \"alpha.csv\"");
    sites = io::read_body_sites(folder / file, *body.context().units, types);
    SceneValue::Array list;
    for (const BodySite& site : sites) list.push_back(value_of(site, *body.context().units, types));
    effective.erase("sites");
    effective.put("site", SceneValue::of(std::move(list), body.line("sites")));
    return sites;
  }
  const auto tables = tables_of(body, "site");
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TableReader reader(body.context(), *tables[k], fmt::format("site {} of {}", k + 1, body.what()),
                       fmt::format("{}.site.{}", body.path(), k));
    sites.push_back(read_site(reader, types));
  }
  return sites;
}

/// `fixed_point` and `center`: a top. @throws SceneError
RigidBody read_top(TableReader& body, const std::string& name, double mass) {
  for (const char* other : {"semi_axes", "sites", "site", "linear"}) {
    if (!body.has(other)) continue;
    body.fail(other,
              fmt::format("{} has a fixed point, so its inertia is about that; give inertia and center, and take "
                          "{} out",
                          body.what(), other));
  }
  std::vector<std::string_view> others = {"x", "v", "about"};
  for (const OrbitKey& key : orbit_keys) others.push_back(key.name);
  for (const std::string_view other : others) {
    if (!body.has(other)) continue;
    body.fail(other, fmt::format("{} has a fixed point, where it stays; take {} out", body.what(), other));
  }
  const auto inertia = body.vector("inertia", "mass length^2"), center = body.vector("center", "length");
  if (!inertia || !center) {
    body.fail(nullptr, inertia ? "center" : "inertia",
              fmt::format("{} has a fixed point, but no {}; give the moments of inertia about that point and the "
                          "centre of mass from it, in the principal axes",
                          body.what(), inertia ? "center" : "inertia"));
  }
  return top(name, mass, column(*inertia), column(*center));
}

}  // namespace

const std::vector<std::string>& rigid_body_keys() {
  static const std::vector<std::string> keys = {"semi_axes",   "inertia",          "sites",       "site", "linear",
                                                "fixed_point", "center",           "orientation", "axis", "angle",
                                                "spin",        "angular_velocity", "spin_period"};
  return keys;
}

RigidBody read_rigid_body(TableReader& body, const std::string& name, double mass, const std::filesystem::path& folder,
                          const io::SiteTypes& types, SceneValue& effective) {
  try {
    const bool by_sites = body.has("sites") || body.has("site");
    const int ways = (by_sites ? 1 : 0) + (body.has("semi_axes") ? 1 : 0) + (body.has("inertia") ? 1 : 0);
    if (ways != 1) {
      const std::string_view at = body.has("semi_axes") ? "semi_axes" : by_sites ? "sites" : "inertia";
      body.fail(at, fmt::format("{} has {} of semi_axes, inertia and sites; one of them is expected", body.what(),
                                ways == 0 ? "none" : "more than one"));
    }
    if (body.has("fixed_point")) return read_top(body, name, mass);
    if (body.has("center")) {
      body.fail("center", fmt::format("{} has a center, but no fixed_point; give one, or take it out", body.what()));
    }
    if (by_sites) {
      if (body.has("mass")) {
        body.fail("mass", fmt::format("{} has the mass of its sites; take mass out", body.what()));
      }
      for (const char* key : {"charge", "type"}) {
        if (body.has(key)) body.fail(key, fmt::format("{} has sites, each with its {}; take it out", body.what(), key));
      }
      return body_of_sites(name, read_sites(body, folder, types, effective), body.flag("linear", false));
    }
    if (body.has("linear")) {
      body.fail("linear", fmt::format("linear is said of sites, but {} has none; take it out", body.what()));
    }
    if (const auto axes = body.vector("semi_axes", "length")) return ellipsoid(name, mass, column(*axes));
    return body_of_inertia(name, mass, column(*body.vector("inertia", "mass length^2")));
  } catch (const SceneError&) {
    throw;
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    body.refuse(error);
  }
}

BodyState read_turn(TableReader& body) {
  BodyState state;
  const ColumnInfo orientation = column_info<BodyOrientation>();
  if (const auto q = body.row(orientation)) {
    if (body.has("axis") || body.has("angle")) {
      body.fail("orientation", fmt::format("{} has both orientation and axis; give one or the other", body.what()));
    }
    state.orientation = Quaternion<double>((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  } else if (body.has("axis") || body.has("angle")) {
    const auto axis = body.vector("axis", "1");
    const auto angle = body.quantity("angle", "angle");
    if (!axis || !angle) {
      body.fail(nullptr, axis ? "angle" : "axis",
                fmt::format("{} has no {}; give both axis and angle", body.what(), axis ? "angle" : "axis"));
    }
    const Vec3<double> n = column(*axis);
    const double length = std::sqrt(norm2(n));
    if (!(length > 0)) body.fail("axis", "axis has no direction; expected one such as [0, 0, 1]");
    state.orientation = quaternion<double>(std::cos(*angle / 2), n * (std::sin(*angle / 2) / length));
  }
  if (const auto spin = body.vector("spin", "mass length^2/time")) state.spin = column(*spin);
  if (const auto rate = body.vector("angular_velocity", "1/time")) state.angular_velocity = column(*rate);
  state.spin_period = body.quantity("spin_period", "time");
  return state;
}

}  // namespace noether
