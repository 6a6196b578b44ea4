#include "scene/read_structure.hpp"

#include "io/structure.hpp"
#include "scene/particle_keys.hpp"

#include <string_view>

namespace noether {

namespace {

/// A text that goes into the effective scene where it is given.
std::string kept_text(TableReader& reader, std::string_view key, SceneValue& effective) {
  if (const SceneValue* value = reader.find(key)) effective.put(std::string(key), *value);
  return reader.text(key);
}

}  // namespace

ParticleSystem<double> read_structure_particles(TableReader& reader, const std::filesystem::path& folder,
                                                SceneValue& effective) {
  reader.expect_only({"structure", "structure_sha256", "file_units", "special", "exclusions", "atom_style", "mixing",
                      "box", "type", "pair", "temperature", "seed", "frame"});
  io::StructureOptions options;
  options.units = reader.context().units;
  const auto read = [&](const std::filesystem::path& file) {
    try {
      return io::read_structure(file, options);
    } catch (const SceneError&) {
      throw;
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      refuse_particle_key(reader, error);
    }
  };
  SceneValue keys = SceneValue::table();
  options.file_units = kept_text(reader, "file_units", keys);
  options.atom_style = kept_text(reader, "atom_style", keys);
  options.special = read_special(reader, keys);
  options.mixing = read_mixing(reader, keys);
  options.box = read_box(reader, keys);
  options.types = read_types(reader, keys);
  options.pairs = read_pairs(reader, keys);
  ParticleSystem<double> s =
      particles_in_file(reader, "structure", folder, "water.data", "a structure", effective, read);
  for (auto& [key, value] : *keys.get<SceneValue::Table>()) effective.put(key, std::move(value));
  read_temperature(reader, s, effective);
  return s;
}

}  // namespace noether
