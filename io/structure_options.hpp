#pragma once
/// What the reader of a structure file is told beside the file.

#include "engine/box.hpp"
#include "engine/type_parameters.hpp"
#include "numbers/units.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What a structure file does not say itself.
struct StructureOptions {
  const UnitSystem* units = &unit_system("molecular");  ///< the unit system of the particles
  /// "lj" (in the reduced system), "real" or "metal" (in the molecular one): the units of a LAMMPS data file that does
  /// not say them in its first line, as LAMMPS itself does; extended XYZ may be in "lj" too. Empty: what the file says.
  std::string file_units = {};
  std::string atom_style = {};  ///< of a LAMMPS data file without it: atomic, charge, bond, angle, molecular or full
  /// Factors of the pair forces of particles one, two and three bonds apart.
  std::array<double, 3> special = {0, 0, 0};
  std::optional<Mixing> mixing = {};       ///< default: geometric for LAMMPS data, as there, and else lorentz_berthelot
  std::vector<TypeParameters> types = {};  ///< given in addition to those of the file, or instead
  std::vector<PairParameters> pairs = {};
  /// For a file that has none; `Box::open()` takes the box of a file away.
  std::optional<Box> box = {};
};

}  // namespace noether::io
