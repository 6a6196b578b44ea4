// Trajectories as text, extended XYZ and CSV, and frames as bodies of new scenes.
#include "engine/bodies.hpp"
#include "io/csv_columns.hpp"
#include "io/files.hpp"
#include "io/frame_particles.hpp"
#include "io/frame_sites.hpp"
#include "io/inspect.hpp"
#include "io/sandbox.hpp"
#include "io/structure_parts.hpp"
#include "io/trajectory.hpp"
#include "io/trajectory_reader.hpp"
#include "io/vtu.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>

namespace noether::io {

namespace {

using Write = void (*)(const Frames& shared, const Frame&, fmt::memory_buffer&);

/// A name as one word of a column.
std::string word_of(const std::string& name) {
  std::string word = name.empty() ? "X" : name;
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t' || c == '"'; }, '_');
  return word;
}

std::string quoted_field(const std::string& name) {
  if (name.find_first_of(",\"# ") == std::string::npos) return name;
  std::string field = "\"";
  for (const char c : name) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

/// The element that a name begins with: "O" of "O_17", as structures name their atoms.
std::string element_of(const std::string& name) {
  const std::size_t mark = name.rfind('_');
  if (mark == std::string::npos || mark == 0 || mark + 1 == name.size()) return word_of(name);
  return name.find_first_not_of("0123456789", mark + 1) == std::string::npos ? word_of(name.substr(0, mark))
                                                                             : word_of(name);
}

/// What XYZ calls the species of row i.
std::string species_of(const Frames& shared, std::size_t i) {
  return shared.types.empty() ? element_of(shared.names[i]) : word_of(shared.types[i]);
}

/// Lattice and pbc; `length` is the file's unit of length.
std::string cell_of(const Frame& frame, double length) {
  if (frame.edges.empty()) return "pbc=\"F F F\"";
  return fmt::format("Lattice=\"{:.17g} 0 0 0 {:.17g} 0 0 0 {:.17g}\" pbc=\"T T T\"", frame.edges[0] / length,
                     frame.edges[1] / length, frame.edges[2] / length);
}

/// Other columns that move, as properties of extended XYZ: ":orientation:R:4".
std::string properties_of(const Frames& shared) {
  std::string text;
  for (const auto& [name, column] : shared.columns) text += fmt::format(":{}:R:{}", word_of(name), column.first);
  return text;
}

/// Their numbers for particle `i`, each after `mark`.
void write_columns(const Frames& shared, const Frame& frame, std::size_t i, char mark, fmt::memory_buffer& out) {
  for (const auto& [name, column] : shared.columns) {
    const auto width = static_cast<std::size_t>(column.first);
    for (std::size_t k = 0; k < width; ++k) {
      fmt::format_to(std::back_inserter(out), "{}{:.17g}", mark, frame.columns.at(name).at(width * i + k));
    }
  }
}

/// A molecular run, in the units that `read_structure` expects of such a file: those of ASE.
void write_molecular_xyz(const Frames& shared, const Frame& frame, fmt::memory_buffer& out) {
  const FileUnits ase = file_units_of(StructureFormat::extended_xyz, {});
  const auto into = std::back_inserter(out);
  const bool charged = !shared.charges.empty();
  fmt::format_to(into,
                 "{}\nProperties=species:S:1:pos:R:3:masses:R:1:momenta:R:3{}{} Time={:.17g} Step={} {} time_unit=ps\n",
                 shared.ids.size(), charged ? ":initial_charges:R:1" : "", properties_of(shared), frame.time,
                 frame.step, cell_of(frame, ase.length));
  for (std::size_t i = 0; i < shared.ids.size(); ++i) {
    const double *x = &frame.positions[3 * i], *v = &frame.velocities[3 * i], m = shared.masses[i];
    const double p = m / ase.momentum_velocity;
    fmt::format_to(into, "{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", species_of(shared, i),
                   x[0] / ase.length, x[1] / ase.length, x[2] / ase.length, m, p * v[0], p * v[1], p * v[2]);
    if (charged) fmt::format_to(into, " {:.17g}", shared.charges[i]);
    write_columns(shared, frame, i, ' ', out);
    out.push_back('\n');
  }
}

/// Runs in other units keep them, and the comment says which they are.
void write_own_xyz(const Frames& shared, const Frame& frame, fmt::memory_buffer& out) {
  const auto into = std::back_inserter(out);
  fmt::format_to(into, "{}\nProperties=species:S:1:pos:R:3:vel:R:3{} Time={:.17g} Step={} {} units={}",
                 shared.ids.size(), properties_of(shared), frame.time, frame.step, cell_of(frame, 1), shared.units);
  if (shared.units != "reduced") {
    fmt::format_to(into, " length_unit={} velocity_unit={} time_unit={}", shared.length_unit, shared.velocity_unit,
                   shared.time_unit);
  }
  out.push_back('\n');
  for (std::size_t i = 0; i < shared.ids.size(); ++i) {
    const double *x = &frame.positions[3 * i], *v = &frame.velocities[3 * i];
    fmt::format_to(into, "{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}",
                   shared.types.empty() ? word_of(shared.names[i]) : species_of(shared, i), x[0], x[1], x[2], v[0],
                   v[1], v[2]);
    write_columns(shared, frame, i, ' ', out);
    out.push_back('\n');
  }
}

/// Extended XYZ, the format of ASE and OVITO: a count, one line of keys, one line per particle.
void write_xyz(const Frames& shared, const Frame& frame, fmt::memory_buffer& out) {
  (shared.units == "molecular" ? write_molecular_xyz : write_own_xyz)(shared, frame, out);
}

void write_csv(const Frames& shared, const Frame& frame, fmt::memory_buffer& out) {
  for (std::size_t i = 0; i < shared.ids.size(); ++i) {
    const double *x = &frame.positions[3 * i], *v = &frame.velocities[3 * i];
    fmt::format_to(std::back_inserter(out), "{},{:.17g},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}",
                   frame.step, frame.time, shared.ids[i], quoted_field(shared.names[i]), x[0], x[1], x[2], v[0], v[1],
                   v[2]);
    write_columns(shared, frame, i, ',', out);
    out.push_back('\n');
  }
}

/// A row for each frame, a column for each variable.
void write_system(const Frames& /*shared*/, const Frame& frame, fmt::memory_buffer& out) {
  fmt::format_to(std::back_inserter(out), "{},{:.17g}", frame.step, frame.time);
  for (const double y : frame.variables) fmt::format_to(std::back_inserter(out), ",{:.17g}", y);
  out.push_back('\n');
}

/// The frame with its particles where they would be if the box had never taken them in.
Frame unwrapped(Frame frame) {
  for (std::size_t k = 0; k < frame.positions.size(); ++k) frame.positions[k] += frame.images[k] * frame.edges[k % 3];
  return frame;
}

std::string system_head(const Frames& shared) {
  const bool unit = !shared.time_unit.empty() && shared.time_unit != "1";
  std::string head = unit ? fmt::format("step,time [{}]", shared.time_unit) : "step,time";
  for (const std::string& name : shared.variable_names) head += fmt::format(",{}", quoted_field(name));
  return head.append("\n");
}

/// Units stand in brackets; the reduced system has none.
std::string csv_head(const Frames& shared) {
  if (!shared.variable_names.empty()) return system_head(shared);
  const auto unit = [](const std::string& symbol) {
    return symbol.empty() || symbol == "1" ? "" : " [" + symbol + "]";
  };
  const std::string length = unit(shared.length_unit), velocity = unit(shared.velocity_unit);
  std::string head =
      fmt::format("step,time{0},id,name,x{1},y{1},z{1},vx{2},vy{2},vz{2}", unit(shared.time_unit), length, velocity);
  for (const auto& [name, column] : shared.columns) {
    const ColumnInfo info{.name = name, .dimension = "", .width = static_cast<int>(column.first)};
    for (const std::string& one : names_of(info)) head += fmt::format(",{}{}", one, unit(column.second));
  }
  return head.append("\n");
}

/// What of these particles a table of bodies has no column for; empty: nothing.
std::string beyond_a_table(const ParticleSystem<double>& s) {
  if (s.box().is_periodic()) return "a periodic box";
  if (s.topology() != nullptr) return "types or bonds";
  if (s.bodies() != nullptr) return "rigid bodies";
  try {
    for (const ColumnInfo& column : s.columns().infos()) headings_of(column, s.units());
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

/// 17 digits are read back to the bit, and units are those of the run, so that nothing is converted.
void write_body_table(const ParticleSystem<double>& s, std::ofstream& target) {
  const UnitSystem& units = s.units();
  const auto in = [&](const Dimension& dimension) {
    return units.is_reduced() ? std::string() : fmt::format(" [{}]", unit_of(dimension, units));
  };
  target << fmt::format("id,name,mass{0},x{1},y{1},z{1},vx{2},vy{2},vz{2}", in(dimensions::mass),
                        in(dimensions::length), in(dimensions::velocity));
  for (const auto& column : s.columns())
    target << "," << fmt::format("{}", fmt::join(headings_of(column.info, units), ","));
  target << "\n";
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    target << fmt::format("{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}",
                          s.ids()[static_cast<std::size_t>(i)], quoted_field(s.name(i)), s.masses()[i], x[0], x[1],
                          x[2], v[0], v[1], v[2]);
    for (const auto& column : s.columns()) {
      column.visit([&](const auto& values) {
        for (int k = 0; k < column.info.width; ++k)
          target << fmt::format(",{:.17g}", static_cast<double>(values.component(k)[i]));
      });
    }
    target << "\n";
  }
}

void convert_to_bodies(const std::filesystem::path& file, const std::filesystem::path& out,
                       const ConvertOptions& options) {
  const bool table = out.extension() == ".csv";
  if (!table && out.extension() != ".h5") {
    throw Error(fmt::format("cannot write bodies to '{}': give a name that ends in .h5, or in .csv if there are no "
                            "types, bonds, rigid bodies or box",
                            out.string()),
                {.value = out.extension().string()});
  }
  if (options.unwrapped) throw Error("--bodies keeps the particles in their box; leave out --unwrapped");
  const FrameParticles start = read_frame_particles(file, {.frame = options.frame});
  if (start.lost_bodies) {
    throw Error(fmt::format("'{}' has rigid bodies, and is from a version that did not store what they are made "
                            "of; start from its scene",
                            file.string()),
                {.value = file.string()});
  }
  const std::string beyond = table ? beyond_a_table(start.particles) : "";
  if (!beyond.empty()) {
    throw Error(fmt::format("cannot write bodies to '{}': a table cannot store {}; give a name that ends in .h5",
                            out.string(), beyond),
                {.value = out.extension().string()});
  }
  if (table) {
    write_text_file(out, [&](std::ofstream& target) { write_body_table(start.particles, target); });
  } else {
    write_one_frame(out, start.particles, start.step, start.time, {.scene_toml = start.scene_toml});
  }
}

}  // namespace

Index convert(const std::filesystem::path& file, const std::filesystem::path& out, const ConvertOptions& options) {
  std::error_code none;
  if (std::filesystem::equivalent(file, out, none)) {
    throw Error(fmt::format("'{}' would overwrite itself; give another name", out.string()), {.value = out.string()});
  }
  if (options.bodies) {
    convert_to_bodies(file, out, options);
    return 1;
  }
  const std::string extension = out.extension().string();
  if (extension == ".h5") {
    throw Error(fmt::format("cannot convert to '{}': give --bodies to write one frame for a new scene, or a name that "
                            "ends in .xyz, .csv or .vtu for all frames",
                            out.string()),
                {.value = extension});
  }
  if (extension != ".xyz" && extension != ".csv" && extension != ".vtu") {
    throw Error(fmt::format("cannot convert to '{}': unknown extension '{}'{}", out.string(), extension,
                            did_you_mean(extension, {".xyz", ".csv", ".vtu"})),
                {.value = extension});
  }
  try_in_child(file, [&] {
    const TrajectoryReader reader(file);
    static_cast<void>(FrameSites::are_in(reader));
    for (Index k = 0; k < reader.frames(); ++k) reader.frame(k);
  });
  const TrajectoryReader reader(file);
  if (reader.frames() == 0) throw FileError("there are no frames to convert", {.file = file.string()});
  const bool of_system = !reader.shared().variable_names.empty();
  if (of_system && extension != ".csv") {
    throw Error(fmt::format("cannot convert to '{}': a first-order system has no particles; give a name that ends in "
                            ".csv",
                            out.string()),
                {.value = extension});
  }
  if (options.unwrapped && reader.frame(0).images.empty()) {
    throw Error(fmt::format(
        "cannot unwrap the positions of '{}': its frames have no periodic box; leave out --unwrapped", file.string()));
  }
  if (extension == ".vtu") {
    if (options.unwrapped) throw Error("a .vtu shows particles in their box; leave out --unwrapped");
    return write_vtu(reader, out);
  }
  const Write write = of_system ? write_system : extension == ".csv" ? write_csv : write_xyz;
  std::optional<FrameSites> sites;  // pictures show atoms; tables keep orientations and spins
  if (extension == ".xyz" && FrameSites::are_in(reader)) sites.emplace(reader, file);
  write_text_file(out, [&](std::ofstream& target) {
    if (extension == ".csv") target << csv_head(reader.shared());
    for (Index k = 0; k < reader.frames() && target; ++k) {
      fmt::memory_buffer text;
      const Frame frame = sites ? sites->frame(reader.frame(k)) : reader.frame(k);
      write(sites ? sites->shared() : reader.shared(), options.unwrapped ? unwrapped(frame) : frame, text);
      target.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
  });
  return reader.frames();
}

}  // namespace noether::io
