#pragma once
/// The builder of boxes of water.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace noether {

/// Water of three sites.
///
///     model             O-H [nm]  H-O-H     q_H [e]   sigma [nm]     epsilon [kJ/mol]
///     spce              0.1       109.47    0.4238    0.316555789    0.65016944
///     tip3p             0.09572   104.52    0.417     0.315061       0.636386
///     spc_fw            0.1012    113.24    0.41      0.3165492      0.6502995
///     tip3p_flexible    0.09572   104.52    0.417     0.315061       0.636386
///
/// The first two are rigid: they were made for constraints. Bonds and angles of all are `harmonic`. Constants of
/// `spc_fw` are its own, 443153.4 kJ/mol/nm^2 and 317.5656 kJ/mol/rad^2; those of `tip3p_flexible` are CHARMM's for the
/// same molecule, 376560 and 460.24 (450 kcal/mol/A^2 and 55 kcal/mol/rad^2 without a factor 1/2), with hydrogens that
/// have no Lennard-Jones parameters, as those of `tip3p` have none. Constants of the others, for who lets them move,
/// are those of GROMACS's files: 345000 and 383 for `spce`, 502416 and 628.02 for `tip3p`. Lennard-Jones parameters of
/// `spce` are as NIST has them in its reference calculations.
/// @source BerendsenGrigeraStraatsma1987, JorgensenChandrasekhar1983, WuTepperVoth2006, MacKerell1998
enum class WaterModel : std::uint8_t { spce, tip3p, spc_fw, tip3p_flexible };

template <> struct EnumNames<WaterModel> {
  static constexpr std::array<std::pair<WaterModel, std::string_view>, 4> values = {
      {{WaterModel::spce, "spce"},
       {WaterModel::tip3p, "tip3p"},
       {WaterModel::spc_fw, "spc_fw"},
       {WaterModel::tip3p_flexible, "tip3p_flexible"}}};
};

/// Water in a cubic periodic box: oxygens on sites of the cubic lattice on which they stand farthest apart, vacancies
/// drawn by lot, each molecule turned at random.
///
/// Molecules have the geometry of their model. None overlap, but hydrogens of two may be as near as 0.08 nm, so that
/// the heat of a first run is far above the temperature: use the minimizer before.
///
/// **Velocities.** Molecules of a rigid model move as rigid bodies: velocities of Maxwell and Boltzmann without what
/// bonds would feel, which is what constraints leave of them, scaled so that momentum is 0 and
///
///     2 K / (6 N - 3) = k_B T
///
/// of N molecules, to rounding; where constraints are missing, the other 3 N degrees of freedom are cold. Those of a
/// flexible model are those of `set_temperature`.
///
/// **Topology.** Types O and H with Lennard-Jones kinds, by the rules of Lorentz and Berthelot; molecules 1, 2, ...;
/// bonds and angles; charges; no pair forces within a molecule. Particles are named O_1, H1_1, H2_1, O_2, ...
struct WaterBox {
  WaterModel model = WaterModel::spce;
  std::int64_t molecules = 0;
  double density = 0;                        ///< [mass/length^3]
  std::optional<double> hydrogen_mass = {};  ///< of each hydrogen, taken from its oxygen; default: 1.008 u [mass]
  std::optional<double> temperature = {};    ///< default: all rest
  std::int64_t seed = 1;

  static constexpr auto describe() {
    return part<WaterBox>(
        "water_box", "water of three sites in a cubic periodic box, each molecule turned at random",
        source("BerendsenGrigeraStraatsma1987, JorgensenChandrasekhar1983, WuTepperVoth2006, MacKerell1998"),
        field<&WaterBox::model>("model", "1", "spce and tip3p are rigid, spc_fw and tip3p_flexible are flexible"),
        field<&WaterBox::molecules>("molecules", "1", "number of molecules").required("512"),
        field<&WaterBox::density>("density", "density", "mass per volume").required("\"0.997 g/cm^3\""),
        field<&WaterBox::hydrogen_mass>("hydrogen_mass", "mass",
                                        "of each hydrogen, taken from its oxygen; default: 1.008 u"),
        field<&WaterBox::temperature>("temperature", "temperature",
                                      "temperature of the velocities; without it they are 0"),
        field<&WaterBox::seed>("seed", "1", "seed of vacancies, orientations and velocities"));
  }
  void check() const;
  /// @throws Error  as `check`; for reduced units, and for hydrogens that leave their oxygen no mass
  /// @cost O(n)
  ParticleSystem<double> build(const UnitSystem& units = unit_system("molecular")) const;
};

}  // namespace noether
