#pragma once
/// The bodies of `[[particles.body]]` and `[[particles.rigid_body]]`.

#include "io/body_table.hpp"
#include "scene/reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What tables of bodies do not say themselves.
struct BodyTableOptions {
  io::ElementsAbout elements = io::ElementsAbout::first_body;
  std::optional<io::BodyEpoch> epoch = {};  ///< of the start
  std::filesystem::path folder = {};        ///< of the scene, where files with sites are
};

/// Appends the bodies of tables to those of a file: all of the key that stands first come first. The tables stand in
/// the effective table as they are kept.
/// @throws SceneError
ParticleSystem<double> add_body_tables(TableReader& reader, SceneValue& effective, ParticleSystem<double> s,
                                       BodyTableOptions options, std::vector<std::string>& warnings);

/// Where a body stands in [particles]: the key of the tables of its kind, `body` or `rigid_body`, and its own table.
struct BodyPlace {
  const char* key;
  const SceneValue* table;
};
/// The place of the first body of a name; empty where no table has it.
std::optional<BodyPlace> place_of_body(const SceneValue& particles, std::string_view name);

/// G of the scene [length^3/mass/time^2].
double gravitation(const TableReader& reader);

/// A Julian day and, where it says one, its scale of time: "JD 2451545 TDB"; empty for what is none.
std::optional<io::BodyEpoch> julian_day_of(const SceneValue& value);
std::string text_of(const io::BodyEpoch& epoch);

}  // namespace noether
