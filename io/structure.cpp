#include "io/structure.hpp"

#include "engine/charge.hpp"
#include "io/structure_parts.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace noether::io {

namespace {

StructureFormat format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".data" || extension == ".lmp") return StructureFormat::lammps_data;
  if (extension == ".xyz" || extension == ".extxyz") return StructureFormat::extended_xyz;
  if (extension == ".gro") return StructureFormat::gro;
  throw Error(fmt::format("'{}' is of no kind that is read; a structure is a .data or .lmp file (LAMMPS), .xyz or "
                          ".extxyz, or .gro",
                          file.filename().string()),
              {.key = "structure", .value = file.string()});
}

/// What stands in the text instead of a structure, told of bytes that are no text.
constexpr std::string_view expected_of(StructureFormat format) {
  if (format == StructureFormat::lammps_data) return "a LAMMPS data file";
  return format == StructureFormat::gro ? "a .gro file" : "extended XYZ";
}

void check_special(const std::array<double, 3>& special) {
  for (const double factor : special) {
    if (factor >= 0 && factor <= 1) continue;
    throw Error(fmt::format("special holds {}; factors from 0 to 1 are expected", format_number(factor)),
                {.key = "special"});
  }
}

Box box_of(const Box& of_file, const StructureOptions& options) {
  if (!options.box) return of_file;
  if (options.box->is_periodic() && of_file.is_periodic()) {
    const Vec3<double>& e = of_file.edges();
    throw Error(fmt::format("the file has a box of its own, {} x {} x {}; leave box out, or give box = \"open\" to "
                            "take it away",
                            format_number(e[0]), format_number(e[1]), format_number(e[2])),
                {.key = "box"});
  }
  return *options.box;
}

/// Options with the units that LAMMPS writes into the first line of its data files, "..., units = real".
StructureOptions with_units_of_file(const TextFile& text, StructureFormat format, StructureOptions options) {
  static constexpr std::string_view mark = "units = ";
  if (format != StructureFormat::lammps_data || text.lines().empty()) return options;
  const std::string& line = text.lines()[0];
  const std::size_t at = line.find(mark);
  if (!line.starts_with("LAMMPS") || at == std::string::npos) return options;
  const std::string units(trimmed(std::string_view(line).substr(at + mark.size())));
  if (units != "lj" && units != "real" && units != "metal") {
    text.fail(1, fmt::format("the file is in units {}; lj, real and metal are read", units), units);
  }
  if (!options.file_units.empty() && options.file_units != units) {
    text.fail(
        1,
        fmt::format("the file says units = {}, file_units says '{}'; take file_units out", units, options.file_units),
        units);
  }
  options.file_units = units;
  return options;
}

/// Positions of particles that a file gives by cells of a box that is taken away.
void unwrap(Structure& structure) {
  if (structure.images.empty()) return;
  for (std::size_t i = 0; i < structure.x.size(); ++i) {
    for (int k = 0; k < 3; ++k) structure.x[i][k] += structure.images[i][k] * structure.box.edges()[k];
  }
  structure.images.clear();
}

/// Adds the images of a file to those that wrapping has counted.
void count_images(ParticleSystem<double>& s, const std::vector<Vec3<std::int32_t>>& images) {
  if (images.empty()) return;
  VectorColumn<std::int32_t> sums = s.images();
  for (std::size_t i = 0; i < images.size(); ++i) sums.add(static_cast<Index>(i), images[i]);
  s.restore_images(std::move(sums));
}

ParticleSystem<double> particles_of(const Structure& structure, const UnitSystem& units) {
  ParticleSystem<double> s(units);
  for (std::size_t i = 0; i < structure.x.size(); ++i) {
    s.add(structure.names[i], structure.masses[i], structure.x[i], structure.v[i]);
  }
  s.trim();
  s.restore_ids(structure.ids);
  if (!structure.charges.empty()) {
    auto& charges = s.add_column<Charge>();
    std::copy(structure.charges.begin(), structure.charges.end(), charges.data());
  }
  return s;
}

void check_masses(const ParticleSystem<double>& s, const Topology& topology, const std::filesystem::path& file) {
  for (Index i = 0; i < s.size(); ++i) {
    if (!std::isnan(s.masses()[i])) continue;
    const std::string& type = topology.type_names[static_cast<std::size_t>(topology.type(i))];
    throw SceneError(fmt::format("particles of type '{}' have no mass; give it in [[particles.type]]: name = \"{}\", "
                                 "mass = ...",
                                 type, type),
                     {.file = file.string(), .value = type});
  }
}

/// Whether positions could be wrapped, and the cells they crossed be counted.
void check_positions(const ParticleSystem<double>& s, const std::filesystem::path& file) {
  constexpr std::int32_t most_cells = 1 << 29;
  for (Index i = 0; i < s.images().size(); ++i) {
    const Vec3<std::int32_t> image = s.images()[i];
    if (Vec3<double>(s.positions()[i]).allFinite() && image.cwiseAbs().maxCoeff() <= most_cells) continue;
    throw SceneError(fmt::format("'{}' stands more than 2^29 boxes away from the origin", s.name(i)),
                     {.file = file.string()});
  }
}

}  // namespace

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const std::size_t end = std::min(line.find('#'), line.size());
  for (std::size_t at = 0; at < end;) {
    if (is_blank(line[at])) {
      ++at;
      continue;
    }
    const std::size_t first = at;
    while (at < end && !is_blank(line[at])) ++at;
    words.push_back(line.substr(first, at - first));
  }
}

std::int64_t whole_number_in(const TextFile& text, std::size_t line, std::string_view word, std::string_view what,
                             std::int64_t least, std::int64_t most) {
  std::int64_t number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (problem == std::errc() && end == word.data() + word.size() && number >= least && number <= most) return number;
  const std::string range = most == std::numeric_limits<std::int64_t>::max() ? fmt::format("{} or more", least)
                                                                             : fmt::format("{} to {}", least, most);
  text.fail(line, fmt::format("{} is '{}'; a whole number is expected, {}", what, word, range), std::string(word));
}

Box box_in(const TextFile& text, std::size_t line, const Vec3<double>& edges) {
  try {
    return Box::periodic(edges);
  } catch (const Error& error) {
    text.fail(line, error.message());
  }
}

ParticleSystem<double> read_structure(const std::filesystem::path& file, const StructureOptions& options) {
  const StructureFormat format = format_of(file);
  check_special(options.special);
  if (!options.atom_style.empty() && format != StructureFormat::lammps_data) {
    throw Error(fmt::format("atom_style = \"{}\" is for LAMMPS data files; leave it out", options.atom_style),
                {.key = "atom_style", .value = options.atom_style});
  }
  const TextFile text(file, expected_of(format));
  const FileUnits units = file_units_of(format, with_units_of_file(text, format, options));
  Structure structure = format == StructureFormat::lammps_data ? read_lammps_data(text, units, options)
                        : format == StructureFormat::gro       ? read_gro(text, units)
                                                               : read_extended_xyz(text, units);
  const Box box = box_of(structure.box, options);
  if (structure.box.is_periodic() && !box.is_periodic()) unwrap(structure);
  ParticleSystem<double> s = particles_of(structure, *options.units);
  Topology& topology = structure.topology;
  topology.mixing =
      options.mixing.value_or(format == StructureFormat::lammps_data ? Mixing::geometric : Mixing::lorentz_berthelot);
  set_type_parameters(s, topology, options.types, options.pairs);
  check_masses(s, topology, file);
  topology.scale_by_bonds(s.size(), options.special);
  s.set_box(box);
  check_positions(s, file);
  count_images(s, structure.images);
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  return s;
}

}  // namespace noether::io
