// Units of structure files.
#include "io/structure_parts.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

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
      refuse("file_units", fmt::format("numbers in lj belong to units = \"reduced\", not \"{}\"", system_.name));
    }
    if (system_.name != "molecular") {
      refuse("structure",
             fmt::format("a structure is read in units = \"molecular\" or \"reduced\", not \"{}\"", system_.name));
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
    if (said_ == "lj" ? format_ == StructureFormat::gro : !said_.empty() && !is_lammps()) {
      refuse("file_units", fmt::format("file_units = \"{}\" is not for {}, which has units of its own; leave it out",
                                       said_, name_of(format_)));
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

}  // namespace

FileUnits file_units_of(StructureFormat format, const StructureOptions& options) {
  UnitsCheck(format, options).check();
  if (options.units->is_reduced()) return {};
  constexpr double angstrom = units::molecular::angstrom, femtosecond = units::molecular::fs;
  const double momentum_velocity = std::sqrt(electronvolt);
  if (format == StructureFormat::gro) return {.momentum_velocity = momentum_velocity};
  if (options.file_units == "metal") return {angstrom, angstrom, electronvolt, momentum_velocity};
  return {angstrom, angstrom / femtosecond, kcal_per_mol, momentum_velocity};
}

}  // namespace noether::io
