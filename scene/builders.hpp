#pragma once
/// Builders of initial conditions: crystals, liquids, melts of chains, and velocities of a temperature.
///
///     ParticleSystem<double> s = Lattice{.cells = {10, 10, 10}, .density = 0.8442, .mass = 1}.build();
///     set_temperature(s, 1.44, 42);
///
/// What is random is a function of the seed and the number of the particle.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"
#include "scene/lattice_kind.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace noether {

/// Gives every particle with mass a velocity of the Maxwell-Boltzmann distribution, replacing the one it has; then
/// takes the velocity of the centre of mass off all, and scales, so that momentum is 0 and
///
///     2 K / (3 N - 3) = k_B T
///
/// both to rounding. Tracers rest. Constraints are not known here: they take their part away when a run begins.
/// @param temperature  [temperature], 0 or more
/// @throws Error  for a negative temperature, or a positive one of fewer than two particles with mass
/// @cost O(n)
/// @source Allen2017
void set_temperature(ParticleSystem<double>& s, double temperature, std::uint64_t seed);

/// A crystal in a periodic box of whole cells, particles of one type.
struct Lattice {
  LatticeKind lattice = LatticeKind::face_centered;
  std::vector<std::int64_t> cells = {};            ///< three numbers, along x, y and z
  std::optional<double> density = {};              ///< [mass/length^3]
  std::optional<double> constant = {};             ///< edge of the cubic cell [length], instead of the density
  double mass = 0;                                 ///< of a particle [mass]
  std::optional<double> epsilon = {}, sigma = {};  ///< Lennard-Jones; both or none
  std::optional<double> temperature = {};          ///< default: all rest
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<Lattice>(
        "lattice", "a crystal in a periodic box of whole cubic cells",
        formula("sc, bcc and fcc have 1, 2 and 4 particles in a cell"),
        field<&Lattice::lattice>("lattice", "1", "the Bravais lattice"),
        field<&Lattice::cells>("cells", "1", "number of cells along x, y and z").required("[10, 10, 10]"),
        field<&Lattice::density>("density", "density", "mass per volume"),
        field<&Lattice::constant>("constant", "length", "edge of the cubic cell, instead of the density"),
        field<&Lattice::mass>("mass", "mass", "mass of a particle").required("\"39.948 u\""),
        field<&Lattice::epsilon>("epsilon", "energy", "Lennard-Jones parameter of all particles"),
        field<&Lattice::sigma>("sigma", "length", "Lennard-Jones parameter of all particles"),
        field<&Lattice::temperature>("temperature", "temperature",
                                     "temperature of the velocities; without it they are 0"),
        field<&Lattice::seed>("seed", "1", "seed of the velocities"));
  }
  void check() const;
  /// @throws Error  as `check`
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("reduced")) const;
};

/// A disordered start of a liquid in a cubic periodic box: particles on sites of the smallest fcc lattice that has room
/// for them, vacancies drawn by lot, each particle displaced by a vector drawn from a ball.
///
/// No two particles come nearer than (1 - 2 displacement) times the distance of sites, at any density; at liquid
/// temperatures the order is gone after a few hundred steps. Insertion at random would not end at the densities of
/// liquids.
struct Liquid {
  std::int64_t particles = 0;
  double density = 0;         ///< [mass/length^3]
  double mass = 0;            ///< of a particle [mass]
  double displacement = 0.1;  ///< radius of the ball, in distances of neighboring sites, below 1/2
  std::optional<double> epsilon = {}, sigma = {};
  std::optional<double> temperature = {};
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<Liquid>("liquid", "a disordered start in a cubic periodic box, without overlaps",
                        field<&Liquid::particles>("particles", "1", "number of particles").required("1000"),
                        field<&Liquid::density>("density", "density", "mass per volume").required("\"1.374 g/cm^3\""),
                        field<&Liquid::mass>("mass", "mass", "mass of a particle").required("\"39.948 u\""),
                        field<&Liquid::displacement>(
                            "displacement", "1", "largest displacement from a site, in distances of neighboring sites"),
                        field<&Liquid::epsilon>("epsilon", "energy", "Lennard-Jones parameter of all particles"),
                        field<&Liquid::sigma>("sigma", "length", "Lennard-Jones parameter of all particles"),
                        field<&Liquid::temperature>("temperature", "temperature",
                                                    "temperature of the velocities; without it they are 0"),
                        field<&Liquid::seed>("seed", "1", "seed of positions and velocities"));
  }
  void check() const;
  /// @throws Error  as `check`
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("reduced")) const;
};

/// A melt of bead-spring chains of Kremer and Grest: random walks in a cubic periodic box that do not fold back, a bead
/// and the next but one at least 1.02 sigma apart.
///
/// Chains know nothing of each other: overlaps are for the minimizer, or for a first run that limits displacements.
/// Bonds are `fene` with k = 30 epsilon/sigma^2, longest 1.5 sigma; bonded pairs have no other pair force; where
/// bending is not 0, angles are `cosine`. Chains are molecules 1, 2, ...
struct PolymerChains {
  std::int64_t chains = 0, beads = 0;
  double density = 0;         ///< [mass/length^3]
  double mass = 0;            ///< of a bead [mass]
  double bond_length = 0.97;  ///< [sigma]
  double epsilon = 1, sigma = 1;
  double bending = 0;  ///< k of k (1 + cos theta) [energy]
  std::optional<double> temperature = {};
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<PolymerChains>(
        "polymer_chains", "a melt of bead-spring chains as random walks that do not fold back",
        formula("|b_i| = bond_length sigma, |b_i + b_(i+1)| >= 1.02 sigma"), source("KremerGrest1990"),
        field<&PolymerChains::chains>("chains", "1", "number of chains").required("100"),
        field<&PolymerChains::beads>("beads", "1", "number of beads in each chain").required("50"),
        field<&PolymerChains::density>("density", "density", "mass per volume").required("0.85"),
        field<&PolymerChains::mass>("mass", "mass", "mass of a bead").required("1"),
        field<&PolymerChains::bond_length>("bond_length", "1", "bond length, in sigma"),
        field<&PolymerChains::epsilon>("epsilon", "energy", "Lennard-Jones parameter of beads and bonds"),
        field<&PolymerChains::sigma>("sigma", "length", "Lennard-Jones parameter of beads and bonds"),
        field<&PolymerChains::bending>("bending", "energy", "k of angles k (1 + cos theta); 0: chains are flexible"),
        field<&PolymerChains::temperature>("temperature", "temperature",
                                           "temperature of the velocities; without it they are 0"),
        field<&PolymerChains::seed>("seed", "1", "seed of walks and velocities"));
  }
  void check() const;
  /// @throws Error  as `check`
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("reduced")) const;
};

}  // namespace noether
