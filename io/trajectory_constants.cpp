#include "io/trajectory_constants.hpp"

#include "io/trajectory_bodies.hpp"
#include "io/trajectory_digest.hpp"
#include "io/trajectory_layout.hpp"
#include "io/trajectory_topology.hpp"
#include "numbers/quantity.hpp"
#include "numbers/simd.hpp"
#include "numbers/version.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <type_traits>

namespace noether::io {

namespace {

/// A factor of a unit in H5MD's words: "m", "s-1", "m+2".
std::string factor_word(std::string_view symbol, int power) {
  return power == 1 ? std::string(symbol) : fmt::format("{}{:+d}", symbol, power);
}

/// A column that does not move stands once in the file, as masses do: shape (n), or (n, width).
void write_parameter(const Hdf5File& file, const Columns<double>::Column& column, const std::vector<Index>& order,
                     const UnitSystem& units) {
  const std::string path = particles_path + "/" + column.info.name;
  std::vector<Index> shape{static_cast<Index>(order.size())};
  if (column.info.width > 1) shape.push_back(column.info.width);
  column.visit([&](const auto& values) {
    std::vector<std::decay_t<decltype(values.component(0)[0])>> numbers;
    for (const Index i : order) {
      for (int k = 0; k < values.width; ++k) numbers.push_back(values.component(k)[i]);
    }
    file.write(path, numbers, shape);
  });
  file.set_attribute(path, "noether_unit", unit_in_words(column.info.dimension, units));
  file.set_attribute(path, dimension_attribute, column.info.dimension);
  const std::string unit = h5md_unit(column.info.dimension, units);
  if (!unit.empty()) file.set_variable_text(path, "unit", unit);
  if (column.info.name == "charge") file.set_attribute(path, "type", "effective");
}

}  // namespace

std::string h5md_unit(std::string_view dimension, const UnitSystem& units) {
  if (units.name != "molecular" && units.name != "si") return "";
  if (dimension == "angle") return "rad";
  Dimension d;
  try {
    d = parse_dimension(dimension);
  } catch (const Error&) {
    return "";  // words that are no dimension, or one for each of several columns
  }
  std::string words;
  for (const auto& [symbol, power] :
       {std::pair(units.mass, d.mass), std::pair(units.charge, d.charge), std::pair(units.temperature, d.temperature),
        std::pair(units.length, d.length), std::pair(units.time, d.time)}) {
    if (power == 0) continue;
    if (!words.empty()) words += ' ';
    words += factor_word(symbol, power);
  }
  return words;
}

void set_unit(const Hdf5File& file, const std::string& path, std::string_view dimension, const UnitSystem& units) {
  const std::string unit = h5md_unit(dimension, units);
  if (unit.empty()) {
    file.set_attribute(path, "noether_unit", unit_in_words(std::string(dimension), units));
  } else {
    file.set_variable_text(path, "unit", unit);
  }
}

void set_unit_of_motion(const Hdf5File& file, const std::string& path, std::string_view dimension,
                        const UnitSystem& units) {
  if (h5md_unit(dimension, units) == "m") {
    file.set_attribute(path, "noether_unit", "m");
  } else {
    set_unit(file, path, dimension, units);
  }
}

void write_header(const Hdf5File& file, const UnitSystem& units, const std::string& scene_toml) {
  file.make_group("/h5md/author");
  file.make_group("/h5md/creator");
  file.set_attribute("/h5md", "version", std::vector<std::int64_t>{1, 1});
  file.set_attribute("/h5md/author", "name", "noether");
  file.set_attribute("/h5md/creator", "name", "noether");
  file.set_attribute("/h5md/creator", "version", version());
  if (!h5md_unit("time", units).empty()) {
    file.make_group("/h5md/modules/units");
    file.set_attribute("/h5md/modules/units", "version", std::vector<std::int64_t>{1, 0});
    file.set_attribute("/h5md/modules/units", "system", "SI");
  }
  file.make_group(monitors_path);
  file.set_attribute("/noether", "version", version());
  file.set_attribute("/noether", "commit", commit());
  file.set_attribute("/noether", "simd", std::string(name(simd_level())));
  file.set_attribute("/noether", "units", std::string(units.name));
  file.set_attribute("/noether", "complete", std::int64_t{0});
  write_scene(file, scene_toml);
}

void write_constants(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order) {
  std::vector<std::int64_t> ids;
  std::vector<double> masses;
  std::vector<std::string> names;
  for (const Index i : order) {
    ids.push_back(state.ids()[static_cast<std::size_t>(i)]);
    masses.push_back(state.masses()[i]);
    names.push_back(state.name(i));
  }
  const std::vector<Index> shape{state.size()};
  file.write(particles_path + "/id", ids, shape);
  file.write(particles_path + "/mass", masses, shape);
  file.write(particles_path + "/name", names);
  set_unit(file, particles_path + "/mass", "mass", state.units());
  file.make_group(particles_path + "/box");
  file.set_attribute(particles_path + "/box", "dimension", std::int64_t{3});
  file.set_attribute(particles_path + "/box", "boundary",
                     std::vector<std::string>(3, state.box().is_periodic() ? "periodic" : "none"));
  for (const auto& column : state.columns()) {
    if (!column.info.moves()) write_parameter(file, column, order, state.units());
  }
  write_topology(file, state, order);
  write_rigid_bodies(file, state, order);
}

}  // namespace noether::io
