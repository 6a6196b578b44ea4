#include "numbers/unit_words.hpp"

#include <array>

namespace noether {

namespace {

/// Another word for a unit of the table; plurals are made of `constant` and of these.
struct Alias {
  std::string_view word, symbol;
};
constexpr std::array aliases = {
    Alias{"h", "hour"},
    Alias{"hr", "hour"},
    Alias{"hrs", "hour"},
    Alias{"yrs", "yr"},
    Alias{"AU", "au"},
    Alias{"parsec", "pc"},
    Alias{"kilometer", "km"},
    Alias{"centimeter", "cm"},
    Alias{"nanometer", "nm"},
    Alias{"femtosecond", "fs"},
    Alias{"picosecond", "ps"},
    Alias{"nanosecond", "ns"},
    Alias{"kilogram", "kg"},
    Alias{"kelvin", "K"},
    // As astropy, VizieR, catalogs and files of molecules have them.
    Alias{"sec", "s"},
    Alias{"d", "day"},
    Alias{"solMass", "Msun"},
    Alias{"M_sun", "Msun"},
    Alias{"M_Sun", "Msun"},
    Alias{"Msol", "Msun"},
    Alias{"MSun", "Msun"},
    Alias{"M\xE2\x98\x89", "Msun"},
    Alias{"M\xE2\x8A\x99", "Msun"},
    Alias{"earthMass", "Mearth"},
    Alias{"M_earth", "Mearth"},
    Alias{"M_Earth", "Mearth"},
    Alias{"MEarth", "Mearth"},
    Alias{"M\xE2\x8A\x95", "Mearth"},
    Alias{"jupiterMass", "Mjup"},
    Alias{"M_jup", "Mjup"},
    Alias{"M_Jup", "Mjup"},
    Alias{"MJup", "Mjup"},
    Alias{"Mjupiter", "Mjup"},
    Alias{"solRad", "Rsun"},
    Alias{"R_sun", "Rsun"},
    Alias{"R_Sun", "Rsun"},
    Alias{"RSun", "Rsun"},
    Alias{"earthRad", "Rearth"},
    Alias{"R_earth", "Rearth"},
    Alias{"jupiterRad", "Rjup"},
    Alias{"R_jup", "Rjup"},
    Alias{"lyr", "ly"},
    Alias{"arcsecond", "arcsec"},
    Alias{"arcminute", "arcmin"},
    Alias{"\xC2\xB0", "deg"},
    Alias{"Angstrom", "angstrom"},
    Alias{"\xC3\x85", "angstrom"},
    Alias{"\xE2\x84\xAB", "angstrom"},
    Alias{"picometer", "pm"},
    Alias{"millimeter", "mm"},
    Alias{"Bohr", "bohr"},
    Alias{"a_0", "bohr"},
    Alias{"amu", "u"},
    Alias{"Da", "u"},
    Alias{"dalton", "u"},
    Alias{"Dalton", "u"},
    Alias{"mole", "mol"},
    Alias{"Kcal", "kcal"},
    Alias{"electronvolt", "eV"},
    Alias{"Hartree", "hartree"},
    Alias{"E_h", "hartree"},
    Alias{"newton", "N"},
    Alias{"volt", "V"},
    Alias{"tesla", "T"},
    Alias{"pascal", "Pa"},
    Alias{"millisecond", "ms"},
    Alias{"microsecond", "us"},
    Alias{"\xC2\xB5s", "us"},
    Alias{"\xCE\xBCs", "us"},
    Alias{"\xC2\xB5m", "um"},
    Alias{"\xCE\xBCm", "um"},
};

/// GM of a planet over that of the Sun, both nominal, in solar masses.
constexpr units::Ratio of_msun(std::int64_t digits, int exponent) {
  return units::find("Msun")->si * units::decimal(digits, exponent) / units::decimal(13271244);
}

constexpr Dimension voltage = dimensions::energy / dimensions::charge;
constexpr Dimension magnetic_field{.mass = 1, .time = -1, .charge = -1};

/// Units that texts alone have: programs ask `unit_value` for them. Masses of planets are to Msun as the nominal GM
/// are, 3.986004e14 and 1.2668653e17 to 1.3271244e20 m^3/s^2; radii are nominal, those of planets equatorial; the
/// parsec is 648000/pi au, the light-year one of a Julian year, the calorie the thermochemical one; bohr and hartree
/// are CODATA 2018.
/// @source Codata2018, IauB2of2015, IauB3of2015
constexpr std::array text_units = {
    units::Definition{"Mearth", "", dimensions::mass, of_msun(3986004, -5)},
    units::Definition{"Mjup", "", dimensions::mass, of_msun(12668653, -3)},
    units::Definition{"Rsun", "", dimensions::length, units::decimal(6957, 5)},
    units::Definition{"Rearth", "", dimensions::length, units::decimal(63781, 2)},
    units::Definition{"Rjup", "", dimensions::length, units::decimal(71492, 3)},
    units::Definition{"pc", "", dimensions::length, units::Ratio{648000 * Quad(149597870700), units::pi}},
    units::Definition{"kpc", "", dimensions::length, units::Ratio{648000000 * Quad(149597870700), units::pi}},
    units::Definition{"Mpc", "", dimensions::length, units::Ratio{648000000000 * Quad(149597870700), units::pi}},
    units::Definition{"ly", "", dimensions::length, units::decimal(9460730472580800)},
    units::Definition{"mm", "", dimensions::length, units::decimal(1, -3)},
    units::Definition{"um", "", dimensions::length, units::decimal(1, -6)},
    units::Definition{"pm", "", dimensions::length, units::decimal(1, -12)},
    units::Definition{"bohr", "", dimensions::length, units::decimal(529177210903, -22)},
    units::Definition{"ms", "", dimensions::time, units::decimal(1, -3)},
    units::Definition{"us", "", dimensions::time, units::decimal(1, -6)},
    units::Definition{"arcmin", "", dimensions::none, units::Ratio{units::pi, Quad(10800)}},
    units::Definition{"arcsec", "", dimensions::none, units::Ratio{units::pi, Quad(648000)}},
    units::Definition{"mas", "", dimensions::none, units::Ratio{units::pi, Quad(648000000)}},
    units::Definition{"kcal/mol", "", dimensions::energy, units::decimal(4184) / units::decimal(602214076, 15)},
    units::Definition{"eV", "", dimensions::energy, units::decimal(1602176634, -28)},
    units::Definition{"meV", "", dimensions::energy, units::decimal(1602176634, -31)},
    units::Definition{"hartree", "", dimensions::energy, units::decimal(43597447222071, -31)},
    units::Definition{"erg", "", dimensions::energy, units::decimal(1, -7)},
    units::Definition{"keV", "", dimensions::energy, units::decimal(1602176634, -25)},
    units::Definition{"MeV", "", dimensions::energy, units::decimal(1602176634, -22)},
    units::Definition{"GeV", "", dimensions::energy, units::decimal(1602176634, -19)},
    units::Definition{"V", "", voltage, units::decimal(1)},
    units::Definition{"kV", "", voltage, units::decimal(1, 3)},
    units::Definition{"MV", "", voltage, units::decimal(1, 6)},
    units::Definition{"T", "", magnetic_field, units::decimal(1)},
    units::Definition{"mT", "", magnetic_field, units::decimal(1, -3)},
    units::Definition{"uT", "", magnetic_field, units::decimal(1, -6)},
    units::Definition{"N", "", dimensions::force, units::decimal(1)},
    units::Definition{"Pa", "", dimensions::pressure, units::decimal(1)},
    units::Definition{"bar", "", dimensions::pressure, units::decimal(1, 5)},
    units::Definition{"atm", "", dimensions::pressure, units::decimal(101325)},
};

}  // namespace

const units::Definition* find_unit(std::string_view symbol) noexcept {
  if (const units::Definition* const unit = units::find(symbol)) return unit;
  for (const units::Definition& unit : text_units) {
    if (unit.symbol == symbol) return &unit;
  }
  return nullptr;
}

std::string_view symbol_of(std::string_view word) noexcept {
  if (find_unit(word) != nullptr) return word;
  const bool plural = word.size() > 2 && word.ends_with('s');
  for (const std::string_view name : {word, plural ? word.substr(0, word.size() - 1) : word}) {
    for (const Alias& alias : aliases) {
      if (alias.word == name) return alias.symbol;
    }
    for (const units::Definition& unit : units::definitions) {
      if (unit.constant == name && name.size() > 2) return unit.symbol;
    }
  }
  return word;
}

std::vector<std::string> symbols_of_units() {
  std::vector<std::string> known;
  for (const units::Definition& unit : units::definitions) known.emplace_back(unit.symbol);
  for (const units::Definition& unit : text_units) known.emplace_back(unit.symbol);
  return known;
}

std::vector<std::string> words_for_units() {
  std::vector<std::string> words;
  for (const Alias& alias : aliases) words.emplace_back(alias.word);
  for (const units::Definition& unit : units::definitions) {
    if (unit.constant.find('_') == std::string_view::npos) words.emplace_back(unit.constant);
  }
  return words;
}

std::span<const units::Definition> units_of_texts() noexcept { return text_units; }

}  // namespace noether
