#include "scene/read_structure.hpp"

#include "io/digest.hpp"
#include "io/files.hpp"
#include "io/structure.hpp"
#include "scene/particle_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace noether {

namespace {

/// A text that goes into the effective scene where it is given.
std::string kept_text(TableReader& reader, std::string_view key, SceneValue& effective) {
  if (const SceneValue* value = reader.find(key)) effective.put(std::string(key), *value);
  return reader.text(key);
}

/// `coefficients`: one file or a list of them, with the hash of all of them one behind the other.
std::vector<std::filesystem::path> read_coefficients(TableReader& reader, const std::filesystem::path& folder,
                                                     SceneValue& effective) {
  static constexpr std::string_view key = "coefficients", hash_key = "coefficients_sha256";
  const SceneValue* value = reader.find(key);
  if (value == nullptr) {
    if (reader.has(hash_key)) reader.fail(hash_key, "there are no coefficients for this hash; take it out");
    return {};
  }
  const auto* list = value->get<SceneValue::Array>();
  std::vector<std::filesystem::path> files;
  std::string bytes;
  const SceneValue::Array names = list != nullptr ? *list : SceneValue::Array{*value};
  for (std::size_t k = 0; k < std::max<std::size_t>(names.size(), 1); ++k) {
    const std::string* name = names.empty() ? nullptr : names[k].get<std::string>();
    if (name == nullptr || name->empty()) {
      reader.fail(key,
                  fmt::format("coefficients = {} names no file; give one, such as \"system.in.settings\", or a list",
                              to_text(*value)));
    }
    files.push_back(folder / *name);
    try {
      bytes += io::read_bytes(files.back());
    } catch (const FileError& error) {
      throw FileError(error.what(), {.file = reader.context().source.file,
                                     .line = reader.line(key),
                                     .key = reader.path_of(key),
                                     .value = files.back().string()});
    }
  }
  const std::string hash = io::sha256(bytes);
  if (reader.text(hash_key, hash) != hash) {
    reader.fail(hash_key, fmt::format("the coefficients differ from those this scene was run with: their hash is now "
                                      "{}; take the key out to use the new ones",
                                      hash));
  }
  effective.put(std::string(key), *value);
  effective.put(std::string(hash_key), SceneValue::of(hash, reader.line(key)));
  return files;
}

/// `density = "7.8 g/cm^3"` of a mesh, or a table of those of its regions.
std::map<std::string, double> read_densities(TableReader& reader, SceneValue& effective) {
  const SceneValue* value = reader.find("density");
  if (value == nullptr) return {};
  effective.put("density", *value);
  const auto checked = [&](const SceneValue& one) {
    const double density = reader.number(one, "density", "density");
    if (!(density > 0)) {
      reader.fail(&one, "density",
                  fmt::format("density = {} is not above 0; a density above 0 is expected", to_text(one)));
    }
    return density;
  };
  const auto* regions = value->get<SceneValue::Table>();
  if (regions == nullptr) return {{"", checked(*value)}};
  std::map<std::string, double> densities;
  for (const auto& [region, density] : *regions) densities[region] = checked(density);
  return densities;
}

}  // namespace

ParticleSystem<double> read_structure_particles(TableReader& reader, const std::filesystem::path& folder,
                                                SceneValue& effective, std::vector<std::string>& notes) {
  reader.expect_only({"structure", "structure_sha256", "file_units", "special", "exclusions", "atom_style", "mixing",
                      "box", "type", "pair", "special_pair", "temperature", "seed", "frame", "coefficients",
                      "coefficients_sha256", "molecules", "density"});
  io::StructureOptions options;
  options.units = reader.context().units;
  options.notes = &notes;
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
  options.densities = read_densities(reader, keys);
  options.coefficients = read_coefficients(reader, folder, keys);
  // What the scene does not say, the coefficients may.
  if (reader.has("special") || options.coefficients.empty()) {
    const SpecialFactors special = read_special(reader, keys);
    options.special = special.pairs;
    options.special_charges = special.charges;
  }
  options.mixing = read_mixing(reader, keys);
  options.box = read_box(reader, keys);
  options.types = read_types(reader, keys);
  options.pairs = read_pairs(reader, keys);
  if (has_frame_number(reader)) options.frame = reader.integer("frame");
  ParticleSystem<double> s =
      particles_in_file(reader, "structure", folder, "water.data", "a structure", effective, read);
  for (auto& [key, value] : *keys.get<SceneValue::Table>()) effective.put(key, std::move(value));
  read_temperature(reader, s, effective);
  return s;
}

}  // namespace noether
