#pragma once
/// The builder of crystals of two kinds of ions.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// Cubic crystals of two kinds of ions, one of each for one of the other: a Bravais lattice of the first, and the same
/// of the second, shifted along the diagonal of the cell by half or a quarter of it.
enum class IonicLattice : std::uint8_t {
  rock_salt,        ///< fcc, 1/2: sodium chloride; 4 pairs in a cell
  cesium_chloride,  ///< sc, 1/2; 1 pair
  zinc_blende,      ///< fcc, 1/4; 4 pairs
};

template <> struct EnumNames<IonicLattice> {
  static constexpr std::array<std::pair<IonicLattice, std::string_view>, 3> values = {
      {{IonicLattice::rock_salt, "rock_salt"},
       {IonicLattice::cesium_chloride, "cesium_chloride"},
       {IonicLattice::zinc_blende, "zinc_blende"}}};
};

/// A crystal of two kinds of ions in a periodic box of whole cubic cells.
///
/// **Topology.** The kinds are types, with Lennard-Jones parameters where they are given; particles are named Na_1,
/// Cl_1, Na_2, ... after their types.
struct IonicCrystal {
  IonicLattice lattice = IonicLattice::rock_salt;
  std::vector<std::int64_t> cells = {};    ///< three numbers, along x, y and z
  std::vector<std::string> ions = {};      ///< names of the two types
  std::vector<double> masses = {};         ///< of one of each [mass]
  double charge = 1;                       ///< of the first; the second has the opposite one [charge]
  std::optional<double> density = {};      ///< [mass/length^3]
  std::optional<double> constant = {};     ///< edge of the cubic cell [length], instead of the density
  std::vector<double> epsilon = {};        ///< Lennard-Jones, of one of each [energy]
  std::vector<double> sigma = {};          ///< likewise [length]
  std::optional<double> temperature = {};  ///< default: all rest
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<IonicCrystal>(
        "ionic_crystal", "a crystal of two kinds of ions in a periodic box of whole cubic cells",
        formula("rock_salt and zinc_blende have 4 pairs in a cell, cesium_chloride has 1"),
        field<&IonicCrystal::lattice>("lattice", "1", "where the ions stand"),
        field<&IonicCrystal::cells>("cells", "1", "number of cells along x, y and z").required("[4, 4, 4]"),
        field<&IonicCrystal::ions>("ions", "1", "names of the two types").required("[\"Na\", \"Cl\"]"),
        field<&IonicCrystal::masses>("masses", "mass", "of one ion of each type")
            .required("[\"22.99 u\", \"35.45 u\"]"),
        field<&IonicCrystal::charge>("charge", "charge", "of the first type; the second has the opposite one")
            .required("\"1 e\""),
        field<&IonicCrystal::density>("density", "density", "mass per volume"),
        field<&IonicCrystal::constant>("constant", "length", "edge of the cubic cell, instead of the density"),
        field<&IonicCrystal::epsilon>("epsilon", "energy", "Lennard-Jones parameters of the two types; with sigma"),
        field<&IonicCrystal::sigma>("sigma", "length", "Lennard-Jones parameters of the two types"),
        field<&IonicCrystal::temperature>("temperature", "temperature",
                                          "temperature of the velocities; without it they are 0"),
        field<&IonicCrystal::seed>("seed", "1", "seed of the velocities"));
  }
  void check() const;
  /// @throws Error  as `check`
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("molecular")) const;
};

}  // namespace noether
