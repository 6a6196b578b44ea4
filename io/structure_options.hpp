#pragma once
/// What the reader of a structure file is told beside the file.

#include "engine/box.hpp"
#include "engine/type_parameters.hpp"
#include "numbers/units.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace noether::io {

/// What a structure file does not say itself.
struct StructureOptions {
  const UnitSystem* units = &unit_system("molecular");  ///< the unit system of the particles
  /// "lj" (in the reduced system), "real" or "metal" (in the molecular one): the units of a LAMMPS data file that does
  /// not say them in its first line, as LAMMPS itself does, and of the velocities of extended XYZ; of a mesh the
  /// unit of length. Empty: what the file says, and the unit of the system for a mesh.
  std::string file_units = {};
  std::string atom_style = {};  ///< of a LAMMPS data file without it: atomic, charge, bond, angle, molecular or full
  /// Factors of the pair forces of particles one, two and three bonds apart; empty: those of `special_bonds` in
  /// `coefficients`, or else 0.
  std::optional<std::array<double, 3>> special = {};
  /// Those of the forces of charges, where they are others: the third alone may differ, and both forces of particles
  /// three bonds apart are then terms of the force `bonded`, without a cutoff.
  std::optional<std::array<double, 3>> special_charges = {};
  std::optional<Mixing> mixing = {};       ///< default: geometric for LAMMPS data, as there, and else lorentz_berthelot
  std::vector<TypeParameters> types = {};  ///< given in addition to those of the file, or instead
  std::vector<PairParameters> pairs = {};
  /// For a file that has none; `Box::open()` takes the box of a file away.
  std::optional<Box> box = {};
  std::optional<std::int64_t> frame = {};  ///< of XYZ and .gro, from 0; -1 is the last. Needed where there are several
  /// Input scripts of LAMMPS with the coefficients that a data file leaves to them, in their order.
  std::vector<std::filesystem::path> coefficients = {};
  /// Of the regions of a mesh by their names, that of all others by "" [mass/length^3].
  std::map<std::string, double> densities = {};
  /// Where it is given, what the file holds and nobody reads is told here, a line each.
  std::vector<std::string>* notes = nullptr;
};

}  // namespace noether::io
