#pragma once
/// Units and unit systems: every unit as an exact ratio in SI, and its value in each system, rounded once.
///
///     using namespace noether::units::solar;
///     const double step = 100 * day, region = 100 * au;
///
/// A value in a unit system is number times constant. Text ("100 day", numbers/quantity.hpp) reads the same table, so
/// that a scene and a program agree to the bit.

#include "numbers/real.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace noether {

/// Exponents of the base quantities; an angle is a plain number.
struct Dimension {
  int length = 0, mass = 0, time = 0, charge = 0, temperature = 0;

  constexpr bool operator==(const Dimension&) const = default;

  friend constexpr Dimension operator*(const Dimension& a, const Dimension& b) {
    return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.charge + b.charge, a.temperature + b.temperature};
  }
  friend constexpr Dimension operator/(const Dimension& a, const Dimension& b) {
    return {a.length - b.length, a.mass - b.mass, a.time - b.time, a.charge - b.charge, a.temperature - b.temperature};
  }
};

/// The n-th power of a dimension, n of any sign.
/// @throws never
constexpr Dimension power(const Dimension& d, int n) {
  return {n * d.length, n * d.mass, n * d.time, n * d.charge, n * d.temperature};
}

namespace dimensions {
inline constexpr Dimension none{};
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension mass{.mass = 1};
inline constexpr Dimension time{.time = 1};
inline constexpr Dimension charge{.charge = 1};
inline constexpr Dimension temperature{.temperature = 1};
inline constexpr Dimension velocity = length / time;
inline constexpr Dimension acceleration = velocity / time;
inline constexpr Dimension force = mass * acceleration;
inline constexpr Dimension energy = force * length;
inline constexpr Dimension frequency = none / time;
inline constexpr Dimension density = mass / power(length, 3);
inline constexpr Dimension pressure = energy / power(length, 3);
}  // namespace dimensions

namespace units {

/// A positive number as a quotient, exact for every unit of the table (113 bits each).
struct Ratio {
  Quad numerator = 1, denominator = 1;

  friend constexpr Ratio operator*(const Ratio& a, const Ratio& b) {
    return {a.numerator * b.numerator, a.denominator * b.denominator};
  }
  friend constexpr Ratio operator/(const Ratio& a, const Ratio& b) { return a * Ratio{b.denominator, b.numerator}; }
  constexpr double rounded() const { return static_cast<double>(numerator / denominator); }
};

/// digits x 10^exponent, exact up to 10^48.
constexpr Ratio decimal(std::int64_t digits, int exponent = 0) {
  const Quad scale = Quad::from(noether::detail::power_of_ten(exponent < 0 ? -exponent : exponent));
  return exponent < 0 ? Ratio{Quad(digits), scale} : Ratio{Quad(digits) * scale, Quad(1)};
}

/// The n-th power, n of any sign.
constexpr Ratio power(const Ratio& r, int n) {
  Ratio result;
  for (int i = 0; i < (n < 0 ? -n : n); ++i) result = n < 0 ? result / r : result * r;
  return result;
}

/// One unit: what users type in a scene, its name in C++, its dimension, its value in SI.
struct Definition {
  std::string_view symbol, constant;
  Dimension dimension;
  Ratio si;
};

/// pi to 113 bits; the only unit that is no ratio of integers is the degree.
inline constexpr Quad pi = 3.14159265358979323846264338327950288_q;

/// All units. The year is Julian (365.25 day); Msun is the nominal solar GM over the CODATA G, to its six digits;
/// u, e and the mole are CODATA 2018.
/// @source Codata2018, IauB2of2012, IauB3of2015
inline constexpr std::array definitions = {
    Definition{"s", "second", dimensions::time, decimal(1)},
    Definition{"min", "minute", dimensions::time, decimal(60)},
    Definition{"hour", "hour", dimensions::time, decimal(3600)},
    Definition{"day", "day", dimensions::time, decimal(86400)},
    Definition{"yr", "year", dimensions::time, decimal(31557600)},
    Definition{"kyr", "kyr", dimensions::time, decimal(31557600, 3)},
    Definition{"Myr", "Myr", dimensions::time, decimal(31557600, 6)},
    Definition{"Gyr", "Gyr", dimensions::time, decimal(31557600, 9)},
    Definition{"fs", "fs", dimensions::time, decimal(1, -15)},
    Definition{"ps", "ps", dimensions::time, decimal(1, -12)},
    Definition{"ns", "ns", dimensions::time, decimal(1, -9)},
    Definition{"m", "meter", dimensions::length, decimal(1)},
    Definition{"cm", "cm", dimensions::length, decimal(1, -2)},
    Definition{"km", "km", dimensions::length, decimal(1, 3)},
    Definition{"au", "au", dimensions::length, decimal(149597870700)},
    Definition{"nm", "nm", dimensions::length, decimal(1, -9)},
    Definition{"angstrom", "angstrom", dimensions::length, decimal(1, -10)},
    Definition{"kg", "kg", dimensions::mass, decimal(1)},
    Definition{"g", "gram", dimensions::mass, decimal(1, -3)},
    Definition{"Msun", "Msun", dimensions::mass, decimal(198841, 25)},
    Definition{"u", "u", dimensions::mass, decimal(166053906660, -38)},
    Definition{"K", "K", dimensions::temperature, decimal(1)},
    Definition{"deg", "degree", dimensions::none, Ratio{pi, Quad(180)}},
    Definition{"rad", "radian", dimensions::none, decimal(1)},
    Definition{"kJ/mol", "kJ_per_mol", dimensions::energy, decimal(1000) / decimal(602214076, 15)},
    Definition{"J", "joule", dimensions::energy, decimal(1)},
    Definition{"e", "e", dimensions::charge, decimal(1602176634, -28)},
    Definition{"C", "coulomb", dimensions::charge, decimal(1)},
    Definition{"g/cm^3", "g_per_cm3", dimensions::density, decimal(1000)},
};

/// The definition of a symbol, or null.
/// @throws never
constexpr const Definition* find(std::string_view symbol) {
  for (const Definition& unit : definitions) {
    if (unit.symbol == symbol) return &unit;
  }
  return nullptr;
}

/// The units of one system in SI.
///
/// Energy has an entry of its own: in the molecular system it is the kJ/mol, which is u nm^2/ps^2 but for the molar
/// mass constant, 1 g/mol to 3.4e-10 (less than two of its standard deviations), here taken as exact.
struct Scale {
  Ratio length, mass, time, charge, energy;
};

inline constexpr Scale solar_scale{find("au")->si, find("Msun")->si, find("day")->si, find("e")->si,
                                   find("Msun")->si* power(find("au")->si, 2) / power(find("day")->si, 2)};
inline constexpr Scale molecular_scale{find("nm")->si, find("u")->si, find("ps")->si, find("e")->si,
                                       find("kJ/mol")->si};
inline constexpr Scale si_scale{};

/// The value of a unit in a system, correctly rounded.
/// @throws never
constexpr double value(const Definition& unit, const Scale& scale) {
  const Dimension& d = unit.dimension;
  if (d == dimensions::energy) return (unit.si / scale.energy).rounded();
  const Ratio one = power(scale.length, d.length) * power(scale.mass, d.mass) * power(scale.time, d.time) *
                    power(scale.charge, d.charge);
  return (unit.si / one).rounded();
}
constexpr double value(std::string_view symbol, const Scale& scale) { return value(*find(symbol), scale); }

/// The constant of gravitation 6.6743e-11 m^3 kg^-1 s^-2 [length^3/mass/time^2].
/// @source Codata2018
constexpr double gravitation(const Scale& s) {
  return (decimal(66743, -15) * s.mass * power(s.time, 2) / power(s.length, 3)).rounded();
}

/// Boltzmann's constant 1.380649e-23 J/K, exact [energy/temperature].
/// @source Codata2018
constexpr double boltzmann(const Scale& s) { return (decimal(1380649, -29) / s.energy).rounded(); }

/// The factor of Coulomb's law 1/(4 pi epsilon_0) with epsilon_0 = 8.8541878128e-12 C^2/J m [energy length/charge^2].
/// @source Codata2018
constexpr double electric(const Scale& s) {
  return (power(s.charge, 2) / (Ratio{Quad(4) * pi} * decimal(88541878128, -22) * s.energy * s.length)).rounded();
}

/// Lengths in au, times in days, masses in solar masses, temperatures in K.
namespace solar {
inline constexpr double second = value("s", solar_scale), minute = value("min", solar_scale),
                        hour = value("hour", solar_scale), day = value("day", solar_scale);
inline constexpr double year = value("yr", solar_scale), kyr = value("kyr", solar_scale),
                        Myr = value("Myr", solar_scale), Gyr = value("Gyr", solar_scale);
inline constexpr double fs = value("fs", solar_scale), ps = value("ps", solar_scale), ns = value("ns", solar_scale);
inline constexpr double meter = value("m", solar_scale), cm = value("cm", solar_scale), km = value("km", solar_scale),
                        au = value("au", solar_scale);
inline constexpr double nm = value("nm", solar_scale), angstrom = value("angstrom", solar_scale);
inline constexpr double kg = value("kg", solar_scale), gram = value("g", solar_scale),
                        Msun = value("Msun", solar_scale), u = value("u", solar_scale);
inline constexpr double K = value("K", solar_scale), degree = value("deg", solar_scale),
                        radian = value("rad", solar_scale);
inline constexpr double kJ_per_mol = value("kJ/mol", solar_scale), joule = value("J", solar_scale);
inline constexpr double e = value("e", solar_scale), coulomb = value("C", solar_scale);
inline constexpr double g_per_cm3 = value("g/cm^3", solar_scale);
/// Gauss's constant squared, k = 0.01720209895 [au^3/Msun/day^2].
/// @source Iau1976
inline constexpr double G = power(decimal(1720209895, -11), 2).rounded();
inline constexpr double k_B = boltzmann(solar_scale);
inline constexpr double coulomb_constant = electric(solar_scale);
}  // namespace solar

/// Lengths in nm, times in ps, masses in u, energies in kJ/mol, charges in e, temperatures in K.
namespace molecular {
inline constexpr double second = value("s", molecular_scale), minute = value("min", molecular_scale),
                        hour = value("hour", molecular_scale), day = value("day", molecular_scale);
inline constexpr double year = value("yr", molecular_scale), kyr = value("kyr", molecular_scale),
                        Myr = value("Myr", molecular_scale), Gyr = value("Gyr", molecular_scale);
inline constexpr double fs = value("fs", molecular_scale), ps = value("ps", molecular_scale),
                        ns = value("ns", molecular_scale);
inline constexpr double meter = value("m", molecular_scale), cm = value("cm", molecular_scale),
                        km = value("km", molecular_scale), au = value("au", molecular_scale);
inline constexpr double nm = value("nm", molecular_scale), angstrom = value("angstrom", molecular_scale);
inline constexpr double kg = value("kg", molecular_scale), gram = value("g", molecular_scale),
                        Msun = value("Msun", molecular_scale), u = value("u", molecular_scale);
inline constexpr double K = value("K", molecular_scale), degree = value("deg", molecular_scale),
                        radian = value("rad", molecular_scale);
inline constexpr double kJ_per_mol = value("kJ/mol", molecular_scale), joule = value("J", molecular_scale);
inline constexpr double e = value("e", molecular_scale), coulomb = value("C", molecular_scale);
inline constexpr double g_per_cm3 = value("g/cm^3", molecular_scale);
inline constexpr double G = gravitation(molecular_scale);
inline constexpr double k_B = boltzmann(molecular_scale);
inline constexpr double coulomb_constant = electric(molecular_scale);
}  // namespace molecular

/// Lengths in m, times in s, masses in kg, energies in J, charges in C, temperatures in K.
namespace si {
inline constexpr double second = value("s", si_scale), minute = value("min", si_scale), hour = value("hour", si_scale),
                        day = value("day", si_scale);
inline constexpr double year = value("yr", si_scale), kyr = value("kyr", si_scale), Myr = value("Myr", si_scale),
                        Gyr = value("Gyr", si_scale);
inline constexpr double fs = value("fs", si_scale), ps = value("ps", si_scale), ns = value("ns", si_scale);
inline constexpr double meter = value("m", si_scale), cm = value("cm", si_scale), km = value("km", si_scale),
                        au = value("au", si_scale);
inline constexpr double nm = value("nm", si_scale), angstrom = value("angstrom", si_scale);
inline constexpr double kg = value("kg", si_scale), gram = value("g", si_scale), Msun = value("Msun", si_scale),
                        u = value("u", si_scale);
inline constexpr double K = value("K", si_scale), degree = value("deg", si_scale), radian = value("rad", si_scale);
inline constexpr double kJ_per_mol = value("kJ/mol", si_scale), joule = value("J", si_scale);
inline constexpr double e = value("e", si_scale), coulomb = value("C", si_scale);
inline constexpr double g_per_cm3 = value("g/cm^3", si_scale);
inline constexpr double G = gravitation(si_scale);
inline constexpr double k_B = boltzmann(si_scale);
inline constexpr double coulomb_constant = electric(si_scale);
}  // namespace si

}  // namespace units

/// A choice of units and the constants of nature in it.
struct UnitSystem {
  std::string_view name;
  /// Symbols of the units that numbers stand in; "1" in the reduced system.
  std::string_view length, mass, time, charge, temperature, energy;
  double G;                           ///< constant of gravitation [length^3/mass/time^2]
  double k_B;                         ///< Boltzmann's constant [energy/temperature]
  double coulomb_constant;            ///< factor of Coulomb's law [energy length/charge^2]
  std::optional<units::Scale> scale;  ///< its units in SI; none in the reduced system, which takes bare numbers

  /// Whether numbers stand for themselves, without units.
  /// @throws never
  bool is_reduced() const noexcept { return !scale.has_value(); }
};

/// The speed of light 299792458 m/s, exact [length/time]; none in the reduced system.
/// @throws never
inline std::optional<double> speed_of_light(const UnitSystem& system) noexcept {
  if (!system.scale) return {};
  return (units::decimal(299792458, 0) * system.scale->time / system.scale->length).rounded();
}

/// The unit system of a name: solar, molecular, si or reduced (G = k_B = 1). The reference stays valid.
/// @throws Error if there is none, with a proposal
const UnitSystem& unit_system(std::string_view name);

/// All unit systems, in the order solar, molecular, si, reduced.
/// @throws never
const std::array<UnitSystem, 4>& unit_systems() noexcept;

}  // namespace noether
