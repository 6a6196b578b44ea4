#include "scene/read_force.hpp"

#include "engine/bodies.hpp"
#include "scene/read_tied.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace noether {

namespace {

TiedParticles read_tied(TableReader& reader, const Parts::ForceKind& kind, const ParticleSystem<double>* s,
                        SceneValue& effective) {
  if (s == nullptr) {
    reader.fail(nullptr, "",
                fmt::format("force '{}' ties particles, which it finds by their names; give the particles with it",
                            kind.info.name));
  }
  TiedParticles all = TiedReader(reader, kind.particles, *s).read(effective);
  for (std::vector<Index> particles : all) {
    std::sort(particles.begin(), particles.end());
    const auto twice = std::adjacent_find(particles.begin(), particles.end());
    if (twice == particles.end()) continue;
    reader.fail("pairs", fmt::format("force '{}' ties '{}' to itself", kind.info.name, s->name(*twice)));
  }
  return all;
}

/// The types whose pairs a force acts between; empty: all pairs.
std::set<std::string> types_between(const SceneValue& force) {
  std::set<std::string> types;
  for (const char* key : {"first", "second"}) {
    const SceneValue* value = force.find(key);
    const std::string* name = value != nullptr ? value->get<std::string>() : nullptr;
    if (name != nullptr && !name->empty()) types.insert(*name);
  }
  return types;
}

}  // namespace

SceneForce read_force(TableReader& reader, const Parts::ForceKind& kind, const ParticleSystem<double>* s,
                      SceneValue& effective) {
  reader.find("type");
  effective.put("type", SceneValue::of(kind.info.name, reader.line("type")));
  TiedParticles tied;
  if (kind.particles > 0) tied = read_tied(reader, kind, s, effective);
  const std::string kick = reader.text("kick", "B");
  if (reader.has("kick")) effective.put("kick", SceneValue::of(kick, reader.line("kick")));
  SceneForce force = kind.read(reader, tied);
  reader.finish();
  for (auto& [key, value] : *force.effective.get<SceneValue::Table>()) effective.put(key, value);
  force.effective = effective;
  return force;
}

void set_kick(TableReader& reader, SceneForce& force) {
  if (!reader.has("kick")) return;
  const std::string kick = reader.text("kick");
  if (force.letter) {
    reader.fail("kick", fmt::format("{} is a separate letter, not part of any kick; take the key out", force.name));
  }
  if (kick.size() != 1 || kick[0] < 'B' || kick[0] > 'Z') {
    reader.fail("kick",
                fmt::format("kick = \"{}\" is not a letter of a kick; a letter from B to Z is expected, such as "
                            "\"C\"",
                            kick));
  }
  try {
    force.force.in_kick(kick[0]);
  } catch (const Error& error) {
    reader.refuse(error);
  }
}

void check_force_beside(const TableReader& reader, const Parts::ForceKind& kind, const SceneForce& force,
                        const SceneHamiltonian& made, const Parts& parts) {
  const auto is_it = [&](const SceneForce& other) { return other.name == kind.info.name; };
  if (std::any_of(made.splitting.own.begin(), made.splitting.own.end(), is_it)) {
    reader.fail("type", fmt::format("{} already includes {}; take this force out, or use {}", made.splitting.name,
                                    kind.info.name, parts.hamiltonians().front().info.name));
  }
  const bool attracts = std::any_of(made.splitting.own.begin(), made.splitting.own.end(),
                                    [](const SceneForce& other) { return other.force.claims().kepler; });
  const bool has_key = !kind.masses_key.empty();
  if (has_key && attracts && force.force.claims().kepler) {
    reader.fail("type", fmt::format("{} already attracts the masses, so {} would attract them twice; give {} = false",
                                    made.splitting.name, kind.info.name, kind.masses_key));
  }
  if (has_key && !attracts && !force.force.claims().kepler && reader.table().find(kind.masses_key) != nullptr) {
    reader.fail(kind.masses_key, fmt::format("{} = false leaves out the attraction of the masses, which {} does not "
                                             "have; take it out",
                                             kind.masses_key, made.splitting.name));
  }
  // Forces of several names that must not stand twice for one reason are one effect.
  const auto has_its_effect = [&](const SceneForce& other) {
    return std::any_of(parts.forces().begin(), parts.forces().end(), [&](const Parts::ForceKind& known) {
      return known.info.name == other.name && known.only_once == kind.only_once;
    });
  };
  const auto same = std::find_if(made.forces.begin(), made.forces.end(), has_its_effect);
  if (!kind.only_once.empty() && same != made.forces.end()) {
    const std::string who = is_it(*same) ? kind.info.name + " appears twice in the scene"
                                         : fmt::format("{} and {} are one effect", same->name, kind.info.name);
    const std::string_view mark = kind.only_once.starts_with("so ") ? "," : ";";
    reader.fail("type", fmt::format("{}{} {}", who, mark, kind.only_once));
  }
  if (!(force.force.claims().range > 0)) return;
  const std::set<std::string> types = types_between(reader.table());
  for (const SceneForce& other : made.forces) {
    const std::set<std::string> theirs = types_between(other.effective);
    if (!is_it(other) || !(types.empty() || theirs.empty() || types == theirs)) continue;
    const std::set<std::string>& twice = types.empty() ? theirs : types;
    reader.fail(
        "type",
        fmt::format(
            "{} appears twice in the scene, so {} would count twice; take one of them out", kind.info.name,
            twice.empty() ? "every pair" : fmt::format("pairs of '{}' and '{}'", *twice.begin(), *twice.rbegin())));
  }
}

bool sums_images_of(const SceneSplitting& splitting, const SceneForce& force, const ParticleSystem<double>& particles) {
  if (!particles.box().is_periodic() || force.force.claims().periodic || force.letter) return false;
  try {
    ParticleSystem<double> s = particles;
    splitting.make(ForceField<double>().add(force.force)).bind(s);
  } catch (const Error&) {
    return false;
  }
  return true;
}

void check_force_on_bodies(const TableReader& reader, const Parts::ForceKind& kind, const SceneForce& force,
                           const SceneHamiltonian& made, const ParticleSystem<double>& s) {
  const ForceClaims claims = force.force.claims();
  if (claims.turning_figures && s.size() > 0 && !is_sphere(s, 0)) {
    for (const SceneForce& other : made.forces) {
      if (!other.force.claims().turning_figures) continue;
      reader.fail("type", fmt::format("{} and {} both have the second degree of the figure of '{}', whose moments of "
                                      "inertia differ, so it would act twice; take that of one of them out",
                                      other.name, kind.info.name, s.name(0)));
    }
  }
  if (claims.on_bodies) return;
  if (force.letter) {
    reader.fail("type", fmt::format("{} slows the velocities of points alone, but some particles are rigid bodies; "
                                    "take it out",
                                    kind.info.name));
  }
  if (kind.particles > 0) {
    reader.fail("type", fmt::format("{} ties particles, and cannot tie the sites of rigid bodies; take it out",
                                    kind.info.name));
  }
}

}  // namespace noether
