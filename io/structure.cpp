#include "io/structure.hpp"

#include "engine/charge.hpp"
#include "io/lammps_script.hpp"
#include "io/structure_parts.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace noether::io {

namespace {

StructureFormat format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  for (const char* known : {".data", ".lmp", ".lammps", ".lmpdat"}) {
    if (extension == known) return StructureFormat::lammps_data;
  }
  if (extension == ".xyz" || extension == ".extxyz") return StructureFormat::extended_xyz;
  if (extension == ".gro") return StructureFormat::gro;
  if (extension == ".msh") return StructureFormat::gmsh;
  if (file.filename().string().starts_with("data.")) return StructureFormat::lammps_data;
  if (extension == ".h5" || extension == ".hdf5") {
    throw Error(fmt::format("'{}' is not a structure; to start from the particles of a run give bodies = \"{}\"",
                            file.filename().string(), file.filename().string()),
                {.key = "structure", .value = file.string()});
  }
  throw Error(fmt::format("'{}' has no supported format; a structure is a .data or .lmp file or data.NAME (LAMMPS), "
                          ".xyz or .extxyz, .gro, or .msh (Gmsh)",
                          file.filename().string()),
              {.key = "structure", .value = file.string()});
}

/// What stands in the text instead of a structure, told of bytes that are no text.
constexpr std::string_view expected_of(StructureFormat format) {
  if (format == StructureFormat::lammps_data) return "a LAMMPS data file";
  if (format == StructureFormat::gmsh) return "a mesh of Gmsh in ASCII";
  return format == StructureFormat::gro ? "a .gro file" : "extended XYZ";
}

void check_special(const std::array<double, 3>& special) {
  for (const double factor : special) {
    if (factor >= 0 && factor <= 1) continue;
    throw Error(fmt::format("special contains {}; factors from 0 to 1 are expected", format_number(factor)),
                {.key = "special"});
  }
}

Box box_of(const Box& of_file, const StructureOptions& options) {
  if (!options.box) return of_file;
  if (options.box->is_periodic() && of_file.is_periodic()) {
    const Vec3<double>& e = of_file.edges();
    throw Error(
        fmt::format("the file has its own box, {} x {} x {}; leave box out, or give box = \"open\" to remove it",
                    format_number(e[0]), format_number(e[1]), format_number(e[2])),
        {.key = "box"});
  }
  return *options.box;
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

void check_masses(const ParticleSystem<double>& s, const Structure& structure, const TextFile& text) {
  const Topology& topology = structure.topology;
  for (Index i = 0; i < s.size(); ++i) {
    if (!std::isnan(s.masses()[i])) continue;
    const auto kind = static_cast<std::size_t>(topology.type(i));
    const std::string& type = topology.type_names[kind];
    const bool has_lines = kind < structure.type_lines.size();  // of LAMMPS data numbers are those of types
    const std::string meant = has_lines ? element_meant_by(type) : "";
    const double weight = standard_atomic_weight(meant);
    const bool known = !std::isnan(weight);
    text.fail(
        has_lines ? structure.type_lines[kind] : 0,
        fmt::format("particles of type '{}' have no mass; give it in [[particles.type]]: name = \"{}\", mass = {}",
                    type, type, known ? fmt::format("\"{} u\" if it is {}", weight, meant) : "..."),
        type);
  }
}

/// Whether positions could be wrapped, and the cells they crossed be counted.
void check_positions(const ParticleSystem<double>& s, const std::filesystem::path& file) {
  constexpr std::int32_t most_cells = 1 << 29;
  for (Index i = 0; i < s.images().size(); ++i) {
    const Vec3<std::int32_t> image = s.images()[i];
    if (Vec3<double>(s.positions()[i]).allFinite() && image.cwiseAbs().maxCoeff() <= most_cells) continue;
    throw SceneError(fmt::format("'{}' is more than 2^29 boxes away from the origin", s.name(i)),
                     {.file = file.string()});
  }
}

}  // namespace

std::string element_meant_by(std::string_view label) {
  int number = 0;
  const auto [end, problem] = std::from_chars(label.data(), label.data() + label.size(), number);
  if (problem == std::errc() && end == label.data() + label.size()) return std::string(symbol_of_element(number));
  const auto is_letter_of_element = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  std::string letters(label.begin(), std::find_if_not(label.begin(), label.end(), is_letter_of_element));
  if (number_of_element(letters) > 0) return letters;
  for (std::size_t k = 0; k < letters.size(); ++k) {
    const auto c = static_cast<unsigned char>(letters[k]);
    letters[k] = static_cast<char>(k == 0 ? std::toupper(c) : std::tolower(c));
  }
  return number_of_element(letters) > 0 ? letters : "";
}

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

bool is_rounding_beside(double number, const Vec3<double>& edges) {
  return std::abs(number) < 1e-10 * edges.cwiseAbs().minCoeff() || number == 0;
}

void note(const StructureOptions& options, std::string what) {
  if (options.notes != nullptr) options.notes->push_back(std::move(what));
}

std::size_t frame_of(const StructureOptions& options, std::size_t frames) {
  const auto count = static_cast<std::int64_t>(frames);
  const std::int64_t wanted = options.frame.value_or(0), frame = wanted < 0 ? wanted + count : wanted;
  if (frame >= 0 && frame < count) return static_cast<std::size_t>(frame);
  throw Error(fmt::format("frame = {}, but the file has {} {}: {}, or -1 for the last", wanted, count,
                          count == 1 ? "frame" : "frames", count == 1 ? "0" : fmt::format("0 to {}", count - 1)),
              {.key = "frame"});
}

namespace {

/// What is left of the two forces between particles three bonds apart, where the options say that they are not scaled
/// alike; `special` then leaves nothing of such pairs.
/// @throws Error  at key "special" where particles nearer to each other differ too
std::optional<LammpsScript::EndFactors> ends_of_scene(const StructureOptions& options, std::array<double, 3>& special) {
  if (!options.special_charges || *options.special_charges == special) return {};
  const std::array<double, 3>& charges = *options.special_charges;
  check_special(charges);
  if (charges[0] != special[0] || charges[1] != special[1]) {
    const auto told = [](const std::array<double, 3>& factors) {
      return fmt::format("[{}, {}, {}]", format_number(factors[0]), format_number(factors[1]),
                         format_number(factors[2]));
    };
    throw Error(fmt::format("special keeps {} of lennard_jones and {} of charges; only the third factor may differ",
                            told(special), told(charges)),
                {.key = "special"});
  }
  return LammpsScript::EndFactors{std::exchange(special[2], 0), charges[2]};
}

}  // namespace

ParticleSystem<double> read_structure(const std::filesystem::path& file, const StructureOptions& options) {
  const StructureFormat format = format_of(file);
  if (!options.atom_style.empty() && format != StructureFormat::lammps_data) {
    throw Error(fmt::format("atom_style = \"{}\" is for LAMMPS data files; leave it out", options.atom_style),
                {.key = "atom_style", .value = options.atom_style});
  }
  if (options.frame && (format == StructureFormat::lammps_data || format == StructureFormat::gmsh)) {
    throw Error(fmt::format("{} is one frame; leave frame out",
                            format == StructureFormat::gmsh ? "a mesh" : "a LAMMPS data file"),
                {.key = "frame"});
  }
  if (!options.densities.empty() && format != StructureFormat::gmsh) {
    throw Error("density is for meshes, .msh; the masses of this structure are those of its particles; leave it out",
                {.key = "density"});
  }
  if (!options.coefficients.empty() && format != StructureFormat::lammps_data) {
    throw Error("coefficients are for LAMMPS data files; leave them out", {.key = "coefficients"});
  }
  const TextFile text(file, expected_of(format));
  const LammpsScript script(options);
  const StructureOptions told = with_units_of_file(text, format, script.completed(options));
  const FileUnits units = file_units_of(format, told);
  std::array<double, 3> special = told.special.value_or(std::array<double, 3>{0, 0, 0});
  check_special(special);
  const auto scene_ends = ends_of_scene(told, special);
  Structure structure = format == StructureFormat::lammps_data ? read_lammps_data(text, script, units, told)
                        : format == StructureFormat::gro       ? read_gro(text, units, told)
                        : format == StructureFormat::gmsh      ? read_gmsh(text, told)
                                                               : read_extended_xyz(text, units, told);
  if (structure.pair_style_assumed) {
    note(options,
         "the style of the structure's pair coefficients is not given: they are taken as epsilon and sigma of lj/cut; "
         "if that is right, write it after the section, 'Pair Coeffs # lj/cut'");
  }
  const auto ends = scene_ends ? scene_ends : script.end_factors();
  if (scene_ends && !structure.end_pairs.empty()) {
    throw Error(
        "special keeps other parts of the forces of charges than of others, but the weights of dihedrals in this file "
        "already say what is left between their ends; take one of them out",
        {.key = "special"});
  }
  if (ends && !structure.end_pairs.empty()) {
    text.fail(0,
              "the weights of dihedrals and special_bonds both give the ends of dihedrals a pair force; set the "
              "weights to 0 or take special_bonds out");
  }
  if (!structure.end_pairs.empty() && special[2] != 0) {
    throw Error(fmt::format("special keeps {} of the force between particles three bonds apart, but the weights of "
                            "dihedrals in this file already give that force; 0 is expected there",
                            format_number(special[2])),
                {.key = "special"});
  }
  const Box box = box_of(structure.box, options);
  if (structure.box.is_periodic() && !box.is_periodic()) unwrap(structure);
  ParticleSystem<double> s = particles_of(structure, *options.units);
  Topology& topology = structure.topology;
  const Mixing own = format == StructureFormat::lammps_data ? Mixing::geometric : Mixing::lorentz_berthelot;
  topology.mixing = told.mixing.value_or(structure.mixing.value_or(own));
  set_type_parameters(s, topology, options.types, options.pairs);
  check_masses(s, structure, text);
  check_stated_temperature(text, structure, s, told);
  topology.scale_by_bonds(s.size(), special);
  if (ends) structure.end_pairs = pairs_three_bonds_apart(topology, s.size(), ends->lennard_jones, ends->charges);
  add_end_pairs(text, structure, s, topology);
  s.set_box(box);
  check_positions(s, file);
  count_images(s, structure.images);
  s.set_topology(std::make_shared<const Topology>(std::move(topology)));
  return s;
}

}  // namespace noether::io
