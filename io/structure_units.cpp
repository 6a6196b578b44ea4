// Units of structure files.
#include "io/structure_parts.hpp"
#include "io/xyz_comment.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "numbers/wide_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace noether::io {

namespace {

/// Energies in kJ/mol, exact: the thermochemical calorie, and e N_A of the SI of 2019.
constexpr double kcal_per_mol = units::decimal(4184, -3).rounded();
constexpr double electronvolt =
    (units::decimal(1602176634, -28) * units::decimal(602214076, 15) / units::decimal(1000)).rounded();

constexpr std::string_view name_of(StructureFormat format) {
  if (format == StructureFormat::lammps_data) return "a LAMMPS data file";
  return format == StructureFormat::gro ? "a .gro file" : "an extended XYZ file";
}

/// Refuses units that nobody can convert.
class UnitsCheck {
 public:
  UnitsCheck(StructureFormat format, const StructureOptions& options)
      : format_(format), said_(options.file_units), system_(*options.units) {}

  void check() const {
    check_file_units();
    if (system_.is_reduced()) return check_reduced();
    if (said_ == "lj") {
      refuse("file_units", fmt::format("numbers in lj need units = \"reduced\", not \"{}\"", system_.name));
    }
    if (system_.name != "molecular") {
      refuse("structure",
             fmt::format("a structure needs units = \"molecular\" or \"reduced\", not \"{}\"", system_.name));
    }
    if (is_lammps() && said_.empty()) {
      refuse("file_units", "this LAMMPS data file does not say its units; give file_units = \"real\" or \"metal\"");
    }
  }

 private:
  bool is_lammps() const { return format_ == StructureFormat::lammps_data; }

  void check_file_units() const {
    if (!said_.empty() && said_ != "lj" && said_ != "real" && said_ != "metal") {
      refuse("file_units",
             fmt::format("unknown file_units '{}'{}", said_, did_you_mean(said_, {"lj", "real", "metal"})));
    }
    if (!said_.empty() && format_ == StructureFormat::gro) {
      refuse("file_units",
             fmt::format("file_units = \"{}\" is not for a .gro file, which has fixed units; leave it out", said_));
    }
  }

  void check_reduced() const {
    if (said_ == "lj" || (said_.empty() && is_lammps())) return;
    const std::string_view own = is_lammps()                       ? std::string_view(said_)
                                 : format_ == StructureFormat::gro ? "nm and ps"
                                                                   : "angstrom";
    refuse(said_.empty() ? "structure" : "file_units",
           fmt::format("{} in {} needs units = \"molecular\", not \"reduced\"{}", name_of(format_), own,
                       format_ == StructureFormat::extended_xyz ? "; or give file_units = \"lj\"" : ""));
  }

  [[noreturn]] void refuse(const char* key, const std::string& message) const {
    throw Error(message, {.key = key, .value = said_});
  }

  StructureFormat format_;
  const std::string& said_;
  const UnitSystem& system_;
};

bool is_letter_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The word behind "units = " in the first line of a LAMMPS data file; empty where there is none.
std::string units_of_lammps(const TextFile& text) {
  static constexpr std::string_view mark = "units = ";
  static constexpr std::array<std::string_view, 8> styles = {"lj",  "real",     "metal", "si",
                                                             "cgs", "electron", "micro", "nano"};
  const std::string_view line = text.lines()[0];
  const std::size_t at = line.find(mark);
  if (at == std::string_view::npos || (at > 0 && is_letter_of_word(line[at - 1]))) return "";
  const std::string_view rest = line.substr(at + mark.size());
  const std::string_view units = rest.substr(
      0, static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), is_letter_of_word) - rest.begin()));
  // The line is a comment: what is no unit of LAMMPS is a word like any other.
  const bool style = std::find(styles.begin(), styles.end(), units) != styles.end();
  return style || line.starts_with("LAMMPS") ? std::string(units) : "";
}

/// The value of "units" in the comment of XYZ, as a name of `file_units`; empty where it says nothing new.
std::string units_of_xyz(const TextFile& text) {
  if (text.lines().size() < 2) return "";
  const XyzComment comment(text, 2);
  const std::string* said = comment.find("units");
  if (said == nullptr || *said == "angstrom" || *said == "Angstrom") return "";
  return *said == "reduced" ? "lj" : *said;
}

/// The sum of m v^2. @throws never
double twice_kinetic_energy(const ParticleSystem<double>& s) {
  WideSum<double> sum;
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * Vec3<double>(s.velocities()[i]).squaredNorm();
  return sum.value();
}

}  // namespace

StructureOptions with_units_of_file(const TextFile& text, StructureFormat format, StructureOptions options) {
  if (format == StructureFormat::gro || format == StructureFormat::gmsh || text.lines().empty()) return options;
  const bool lammps = format == StructureFormat::lammps_data;
  const std::string units = lammps ? units_of_lammps(text) : units_of_xyz(text);
  const std::size_t line = lammps ? 1 : 2;
  if (units.empty()) return options;
  if (units != "lj" && units != "real" && units != "metal") {
    text.fail(line, fmt::format("the file is in units {}; only lj, real and metal are supported", units), units);
  }
  if (!options.file_units.empty() && options.file_units != units) {
    text.fail(line,
              fmt::format("the file says units = {}, but file_units says '{}'; take file_units out", units,
                          options.file_units),
              units);
  }
  options.file_units = units;
  return options;
}

void check_stated_temperature(const TextFile& text, const Structure& structure, const ParticleSystem<double>& s,
                              const StructureOptions& options) {
  if (s.size() < 2 || !(structure.temperature || structure.velocity_units_assumed)) return;
  const double n = static_cast<double>(s.size()), k_B = options.units->k_B, energy = twice_kinetic_energy(s);
  const double found = energy / (3 * n - 3) / k_B;
  if (!structure.temperature) {
    if (found < 1e4) return;
    return note(options, fmt::format("the structure's velocities, taken as angstrom/fs, give a temperature of {:.3g} "
                                     "K; give file_units if they are in other units",
                                     found));
  }
  const auto& [stated_here, line, of_momenta] = *structure.temperature;
  const double stated = stated_here;  // lambdas of some compilers see no part of a structure
  if (energy == 0) return;
  const auto fits = [&](double factor) {
    const double degrees = energy * factor * factor / (k_B * stated) / n;
    return degrees > 0.1 && degrees < 3.1;
  };
  if (fits(1)) return;
  const bool metal = options.file_units == "metal";
  std::string remedy = "give the file_units of the program that wrote the file";
  if (of_momenta) remedy = "momenta are expected in sqrt(eV u), as ASE writes them";
  if (!of_momenta && !options.units->is_reduced() && fits(metal ? 1e3 : 1e-3)) {
    remedy = fmt::format("give file_units = \"{}\"", metal ? "real" : "metal");
  }
  text.fail(line, fmt::format("Temperature={}, but the {} make {:.4g}; {}", format_number(stated),
                              of_momenta ? "momenta" : "velocities", found, remedy));
}

FileUnits file_units_of(StructureFormat format, const StructureOptions& options) {
  if (format == StructureFormat::gmsh) return {};  // it has lengths alone, and reads their unit itself
  UnitsCheck(format, options).check();
  if (options.units->is_reduced()) return {};
  constexpr double angstrom = units::molecular::angstrom, femtosecond = units::molecular::fs;
  const double momentum_velocity = std::sqrt(electronvolt);
  if (format == StructureFormat::gro) return {.momentum_velocity = momentum_velocity};
  if (options.file_units == "metal") return {angstrom, angstrom, electronvolt, momentum_velocity};
  return {angstrom, angstrom / femtosecond, kcal_per_mol, momentum_velocity};
}

}  // namespace noether::io
