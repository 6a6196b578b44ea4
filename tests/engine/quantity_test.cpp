#include "numbers/quantity.hpp"

#include "numbers/error.hpp"
#include "tests/support/catch.hpp"

#include <bit>
#include <clocale>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace noether {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Symbol, dimension and C++ constant of every unit in one system.
struct Constant {
  std::string_view symbol;
  Dimension dimension;
  double value;
};

#define NOETHER_CONSTANTS(system)                                                                                   \
  using namespace units::system;                                                                                    \
  return {                                                                                                          \
    {"s", dimensions::time, second}, {"min", dimensions::time, minute}, {"hour", dimensions::time, hour},           \
        {"day", dimensions::time, day}, {"yr", dimensions::time, year}, {"kyr", dimensions::time, kyr},             \
        {"Myr", dimensions::time, Myr}, {"Gyr", dimensions::time, Gyr}, {"fs", dimensions::time, fs},               \
        {"ps", dimensions::time, ps}, {"ns", dimensions::time, ns}, {"m", dimensions::length, meter},               \
        {"cm", dimensions::length, cm}, {"km", dimensions::length, km}, {"au", dimensions::length, au},             \
        {"nm", dimensions::length, nm}, {"angstrom", dimensions::length, angstrom}, {"kg", dimensions::mass, kg},   \
        {"g", dimensions::mass, gram}, {"Msun", dimensions::mass, Msun}, {"u", dimensions::mass, u},                \
        {"K", dimensions::temperature, K}, {"deg", dimensions::none, degree}, {"rad", dimensions::none, radian},    \
        {"kJ/mol", dimensions::energy, kJ_per_mol}, {"J", dimensions::energy, joule}, {"e", dimensions::charge, e}, \
        {"C", dimensions::charge, coulomb}, {                                                                       \
      "g/cm^3", dimensions::density, g_per_cm3                                                                      \
    }                                                                                                               \
  }

std::vector<Constant> solar_constants() { NOETHER_CONSTANTS(solar); }
std::vector<Constant> molecular_constants() { NOETHER_CONSTANTS(molecular); }
std::vector<Constant> si_constants() { NOETHER_CONSTANTS(si); }

#undef NOETHER_CONSTANTS

void check_constants(const std::vector<Constant>& constants, const UnitSystem& system) {
  REQUIRE(constants.size() == units::definitions.size());
  for (const Constant& unit : constants) {
    INFO(unit.symbol << " in " << system.name);
    const std::string symbol(unit.symbol);
    CHECK(same_bits(parse_quantity("10000 " + symbol, unit.dimension, system), 10'000 * unit.value));
    CHECK(same_bits(parse_quantity("0.997 " + symbol, unit.dimension, system), 0.997 * unit.value));
    CHECK(same_bits(parse_quantity("-3.3e-7" + symbol, unit.dimension, system), -3.3e-7 * unit.value));
    CHECK(same_bits(unit_value(symbol, system), unit.value));
  }
}

const UnitSystem& solar = unit_system("solar");
const UnitSystem& molecular = unit_system("molecular");
const UnitSystem& si = unit_system("si");
const UnitSystem& reduced = unit_system("reduced");

TEST_CASE("a quantity in text has the bits of number times constant, for every unit and system", "[quantity]") {
  check_constants(solar_constants(), solar);
  check_constants(molecular_constants(), molecular);
  check_constants(si_constants(), si);
}

TEST_CASE("compound units are evaluated from left to right, as C++ does", "[quantity]") {
  using namespace units::solar;
  const double numbers[] = {1, 3, 0.1, 29.78, 1e-3, 12345.678};
  for (const double number : numbers) {
    const std::string text = format_number(number);
    CHECK(same_bits(parse_quantity(text + " km/s", dimensions::velocity, solar), number * km / second));
    CHECK(same_bits(parse_quantity(text + " au/day", dimensions::velocity, solar), number * au / day));
    CHECK(same_bits(parse_quantity(text + "/min", dimensions::frequency, solar), number / minute));
    CHECK(same_bits(parse_quantity(text + " 1/min", dimensions::frequency, solar), number / minute));
    CHECK(same_bits(parse_quantity(text + " min^-1", dimensions::frequency, solar), number / minute));
    CHECK(same_bits(parse_quantity(text + " kg m/s^2", dimensions::force, solar),
                    number * kg * meter / (second * second)));
    CHECK(same_bits(parse_quantity(text + " kg * m / s / s", dimensions::force, solar),
                    number * kg * meter / second / second));
    CHECK(same_bits(parse_quantity(text + " kJ/mol/km^2", dimensions::energy / power(dimensions::length, 2), solar),
                    number * kJ_per_mol / (km * km)));
    CHECK(same_bits(parse_quantity(text + " km^3/s^2", parse_dimension("length^3/time^2"), solar),
                    number * (km * km * km) / (second * second)));
  }
}

TEST_CASE("a unit read once converts as text does", "[quantity]") {
  const Unit unit = parse_unit("km/s", solar);
  CHECK(unit.dimension == dimensions::velocity);
  int differs_from_product = 0;
  for (int i = 1; i <= 200; ++i) {
    const double number = 0.37 * i;
    const double text = parse_quantity(format_number(number) + " km/s", dimensions::velocity, solar);
    CHECK(same_bits(unit.times(number), text));
    if (!same_bits(number * unit_value("km/s", solar), text)) ++differs_from_product;
  }
  CHECK(differs_from_product > 0);  // why `times` exists
}

TEST_CASE("numbers are decimal, signed, with exponents, whatever the locale", "[quantity]") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  CHECK(parse_quantity("1e6", dimensions::none, si) == 1e6);
  CHECK(parse_quantity("+2.5 m", dimensions::length, si) == 2.5);
  CHECK(parse_quantity("-.5 m", dimensions::length, si) == -0.5);
  CHECK(parse_quantity("  1.5E+3 m ", dimensions::length, si) == 1500.0);
  CHECK(parse_quantity("0.1 m", dimensions::length, si) == 0.1);
  CHECK(parse_quantity("3e", dimensions::charge, molecular) == 3.0);  // three elementary charges
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("the reduced system takes bare numbers of any dimension, and angles", "[quantity]") {
  CHECK(parse_quantity("0.005", dimensions::time, reduced) == 0.005);
  CHECK(parse_quantity("2.5", dimensions::length, reduced) == 2.5);
  CHECK(same_bits(parse_quantity("30 deg", dimensions::none, reduced), 30 * units::si::degree));
}

std::string refusal(std::string_view text, const Dimension& expected, const UnitSystem& system) {
  try {
    return format_number(parse_quantity(text, expected, system));
  } catch (const Error& error) {
    CHECK(error.exit_code() == 2);
    return error.what();
  }
}

TEST_CASE("a missing or wrong unit is refused and the right one shown", "[quantity]") {
  CHECK(refusal("100", dimensions::time, solar) == "'100' has no unit; a time is expected, such as '100 day'");
  CHECK(refusal(" 100 ", dimensions::time, molecular) == "'100' has no unit; a time is expected, such as '100 ps'");
  CHECK(refusal("3 au", dimensions::time, solar) == "'3 au' is a length; a time is expected, such as '3 day'");
  CHECK(refusal("3 au", dimensions::velocity, solar) ==
        "'3 au' is a length; a velocity is expected, such as '3 au/day'");
  CHECK(refusal("3 au", dimensions::none, solar) == "'3 au' is a length; a plain number is expected, such as '3'");
  CHECK(refusal("3 deg", dimensions::length, si) == "'3 deg' is an angle; a length is expected, such as '3 m'");
  CHECK(refusal("3 ps", dimensions::frequency, molecular) ==
        "'3 ps' is a time; a frequency is expected, such as '3/ps'");
  CHECK(refusal("3 nm", dimensions::energy, molecular) ==
        "'3 nm' is a length; an energy is expected, such as '3 kJ/mol'");
  CHECK(refusal("1 kJ/mol", parse_dimension("length^3/time^2"), si) ==
        "'1 kJ/mol' is an energy; a quantity of dimension length^3/time^2 is expected, such as '1 m^3/s^2'");
  CHECK(refusal("100 day", dimensions::time, reduced) ==
        "'100 day' has a unit; reduced units are plain numbers, such as '100'");
}

TEST_CASE("an unknown unit is refused with a proposal", "[quantity]") {
  CHECK(refusal("100 dya", dimensions::time, solar) == "unknown unit 'dya' in '100 dya'; did you mean 'day'?");
  // Never a unit of another dimension: 'm', 'mas' and 'min' are as near as 'ms'.
  CHECK(refusal("10 ma", dimensions::time, solar) == "unknown unit 'ma' in '10 ma'; did you mean 'ms'?");
  CHECK(refusal("10 ma", dimensions::length, solar) == "unknown unit 'ma' in '10 ma'; did you mean 'm'?");
  CHECK(refusal("3 km/dya", dimensions::velocity, solar) == "unknown unit 'dya' in '3 km/dya'; did you mean 'day'?");
  CHECK(refusal("3 kmm/day", dimensions::velocity, solar) == "unknown unit 'kmm' in '3 kmm/day'; did you mean 'km'?");
  CHECK(refusal("2 MSUN", dimensions::mass, solar) == "unknown unit 'MSUN' in '2 MSUN'; did you mean 'Msun'?");
  CHECK(refusal("2 secnods", dimensions::time, si) == "unknown unit 'secnods' in '2 secnods'; did you mean 'second'?");
  CHECK(refusal("2 kJ", dimensions::energy, si) == "unknown unit 'kJ' in '2 kJ'; did you mean 'kJ/mol'?");
  CHECK(
      refusal("2 furlongs", dimensions::length, si) ==
      "unknown unit 'furlongs' in '2 furlongs'; expected one of: m, cm, km, au, nm, angstrom, Rsun, Rearth, Rjup, pc, "
      "kpc, Mpc, ly, mm, um, pm, bohr");
}

TEST_CASE("no unit of another dimension is proposed, and angles only where an angle is expected", "[quantity]") {
  const std::string time = "; a time is expected, such as '1 day'", mass = "; a mass is expected, such as '1 Msun'";
  // Angles have no dimension, so that they would fit beside any unit.
  CHECK(refusal("1 solar day", dimensions::time, solar) == "unknown unit 'solar' in '1 solar day'" + time);
  CHECK(refusal("1 kg kk", dimensions::mass, solar) == "unknown unit 'kk' in '1 kg kk'" + mass);
  CHECK(refusal("1 kg/mass", dimensions::mass, solar) == "unknown unit 'mass' in '1 kg/mass'" + mass);
  // Other words are unknown too: only what a mass may be made of is proposed, not solRad.
  CHECK(refusal("1 solar mass", dimensions::mass, solar) == "unknown unit 'solar' in '1 solar mass'" + mass);
  CHECK(refusal("1 kmm/dya", dimensions::velocity, solar) == "unknown unit 'kmm' in '1 kmm/dya'; did you mean 'km'?");
  // No unit is a velocity: neither C nor Mpc.
  for (const std::string word : {"c", "mph", "knots"}) {
    CHECK(refusal("1 " + word, dimensions::velocity, solar) ==
          "unknown unit '" + word + "' in '1 " + word + "'; a velocity is expected, such as '1 au/day'");
  }
  CHECK(refusal("1 dge", dimensions::none, si) ==
        "unknown unit 'dge' in '1 dge'; a plain number is expected, such as '1'");
  CHECK_THROWS_WITH(parse_angle("1 dge", si), "unknown unit 'dge' in '1 dge'; did you mean 'deg'?");
  CHECK_THROWS_WITH(parse_unit("Mj", "mass", solar), "unknown unit 'Mj'; did you mean 'Mjup'?");
  CHECK_THROWS_WITH(parse_unit("solar mass", "mass", solar),
                    "unknown unit 'solar' in 'solar mass'; a unit of mass is expected, such as 'Msun'");
  CHECK_THROWS_WITH(parse_unit("dge", "angle", solar), "unknown unit 'dge'; did you mean 'deg'?");
  CHECK_THROWS_WITH(parse_unit("ma", "length", solar), "unknown unit 'ma'; did you mean 'm'?");
  CHECK_THROWS_WITH(parse_unit("ma", "time", solar), "unknown unit 'ma'; did you mean 'ms'?");
  CHECK(parse_unit("km", "mass", solar).dimension == dimensions::length);  // for the caller to refuse
}

TEST_CASE("names of units in English, plurals and AU are the units that they name", "[quantity]") {
  const auto same = [](std::string_view words, std::string_view symbol, const Dimension& dimension) {
    CAPTURE(words);
    for (const UnitSystem* system : {&solar, &molecular, &si}) {
      CHECK(same_bits(parse_quantity(words, dimension, *system), parse_quantity(symbol, dimension, *system)));
    }
  };
  for (const auto& [words, symbol] :
       std::vector<std::pair<std::string_view, std::string_view>>{{"3 seconds", "3 s"},
                                                                  {"3 second", "3 s"},
                                                                  {"3 minutes", "3 min"},
                                                                  {"3 hours", "3 hour"},
                                                                  {"3 h", "3 hour"},
                                                                  {"3 hr", "3 hour"},
                                                                  {"3 days", "3 day"},
                                                                  {"3 years", "3 yr"},
                                                                  {"3 year", "3 yr"},
                                                                  {"3 yrs", "3 yr"},
                                                                  {"3 femtoseconds", "3 fs"},
                                                                  {"3 picoseconds", "3 ps"}}) {
    same(words, symbol, dimensions::time);
  }
  same("3 AU", "3 au", dimensions::length);
  same("3 meters", "3 m", dimensions::length);
  same("3 kilometers", "3 km", dimensions::length);
  same("3 angstroms", "3 angstrom", dimensions::length);
  same("3 parsecs", "3 pc", dimensions::length);
  same("3 kilograms", "3 kg", dimensions::mass);
  same("3 grams", "3 g", dimensions::mass);
  same("3 kilometers/second", "3 km/s", dimensions::velocity);
  same("3/years", "3/yr", dimensions::frequency);
  CHECK(parse_angle("3 degrees", solar) == parse_angle("3 deg", solar));
  CHECK(parse_angle("3 radians", reduced) == 3);
  CHECK(refusal("3 hours", dimensions::length, solar) == "'3 hours' is a time; a length is expected, such as '3 au'");
  CHECK(refusal("3 dayss", dimensions::time, solar) == "unknown unit 'dayss' in '3 dayss'; did you mean 'day'?");
}

TEST_CASE("masses and radii of planets and the parsec are the IAU's", "[quantity]") {
  // Python's exact fractions of the nominal values, and mpmath's pi, rounded once.
  CHECK(unit_value("Mjup", solar) == 0.0009545942339693249);
  CHECK(unit_value("Mearth", solar) == 3.0034893488507934e-06);
  CHECK(unit_value("Mjup", si) == 1.8981247207669455e+27);
  CHECK(unit_value("Mearth", si) == 5.972168256148406e+24);
  CHECK(unit_value("Rsun", si) == 695700000.0);
  CHECK(unit_value("Rjup", si) == 71492000.0);
  CHECK(unit_value("Rearth", si) == 6378100.0);
  CHECK(unit_value("Rsun", solar) == 0.004650467260962157);
  CHECK(unit_value("pc", solar) == 206264.80624709636);
  CHECK(unit_value("pc", si) == 3.085677581491367e+16);
  CHECK(unit_value("kpc", si) == 3.085677581491367e+19);
}

TEST_CASE("what is not a quantity is refused", "[quantity]") {
  const std::string joined = "; units are joined by '*', '/' or a space, as in 'kg m/s^2'";
  CHECK(refusal("", dimensions::time, solar) == "'' is empty; a time is expected, such as '1 day'");
  CHECK(refusal("day", dimensions::time, solar) ==
        "'day' does not begin with a number; a time is expected, such as '1 day'");
  CHECK(refusal("+-1 day", dimensions::time, solar) ==
        "'+-1 day' does not begin with a number; a time is expected, such as '1 day'");
  CHECK(refusal("inf day", dimensions::time, solar) == "'inf day' is not finite; a time is expected, such as '1 day'");
  CHECK(refusal("-nan", dimensions::none, solar) == "'-nan' is not finite; a plain number is expected, such as '1'");
  CHECK(refusal("1e999 s", dimensions::time, si) ==
        "'1e999 s' is outside the range of numbers, about 1e-308 to 1e308; a time is expected, such as '1 s'");
  CHECK(refusal("1e300 Gyr", dimensions::time, molecular) == "'1e300 Gyr' is too large for the molecular system");
  CHECK(refusal("3 day!", dimensions::time, solar) == "unexpected '!' in '3 day!'" + joined);
  CHECK(refusal("10_000 yr", dimensions::time, solar) == "unexpected '_' in '10_000 yr'" + joined);
  CHECK(refusal("1,5 yr", dimensions::time, solar) == "unexpected ',' in '1,5 yr'" + joined);
  CHECK(refusal("1 yr 3 day", dimensions::time, solar) == "unexpected '3' in '1 yr 3 day'" + joined);
  CHECK(refusal("3 au/", dimensions::length, solar) == "unexpected end in '3 au/'" + joined);
  CHECK(refusal("3 m^x", dimensions::length, si) ==
        "bad power in '3 m^x'; expected a whole number from -9 to 9, as in 'm^2'");
}

TEST_CASE("a bad unit of a column is refused", "[quantity]") {
  CHECK_THROWS_WITH(parse_unit("au/dya", solar), "unknown unit 'dya' in 'au/dya'; did you mean 'day'?");
  CHECK_THROWS_WITH(parse_unit("dya", solar), "unknown unit 'dya'; did you mean 'day'?");
  CHECK_THROWS_WITH(parse_unit("", solar), "empty unit; expected one such as 'km/s', or '1' for a plain number");
  CHECK_THROWS_WITH(
      parse_unit("au", reduced),
      "unit 'au' in the reduced unit system, where numbers have no units; leave the unit out, or choose solar, "
      "molecular or si");
  CHECK(parse_unit("1", reduced).dimension == dimensions::none);
  CHECK(unit_value("1/day", si) == 1.0 / 86400.0);
}

TEST_CASE("dimensions in words are read and written", "[quantity]") {
  CHECK(parse_dimension("1") == dimensions::none);
  CHECK(parse_dimension("angle") == dimensions::none);
  CHECK(parse_dimension("length^3/time^2") == Dimension{.length = 3, .time = -2});
  CHECK(parse_dimension("1/time") == dimensions::frequency);
  CHECK(parse_dimension("mass*velocity^2") == dimensions::energy);
  CHECK(parse_dimension("energy / length") == dimensions::force);
  CHECK(to_text(dimensions::none) == "1");
  CHECK(to_text(dimensions::velocity) == "velocity");
  CHECK(to_text(parse_dimension("length^3/mass/time^2")) == "length^3/mass/time^2");
  CHECK(to_text(power(dimensions::charge, -2)) == "1/charge^2");
  CHECK_THROWS_WITH(parse_dimension("lenght"), "unknown dimension 'lenght'; did you mean 'length'?");
}

TEST_CASE("dimensions and their units read back, for all small exponents", "[quantity]") {
  for (int code = 0; code < 5 * 5 * 5 * 3; ++code) {
    const Dimension d{
        .length = code % 5 - 2, .mass = code / 5 % 5 - 2, .time = code / 25 % 5 - 2, .charge = code / 125 - 1};
    CHECK(parse_dimension(to_text(d)) == d);
    for (const UnitSystem* system : {&solar, &molecular, &si}) {
      const Unit unit = parse_unit(unit_of(d, *system), *system);
      CHECK(unit.dimension == d);
      CHECK(unit.times(1.0) == 1.0);  // numbers stand in these units
    }
  }
}

TEST_CASE("numbers are written in the shortest form that reads back", "[quantity]") {
  CHECK(format_number(0.1) == "0.1");
  CHECK(format_number(100) == "100");
  CHECK(format_number(-0.0) == "-0");
  CHECK(format_number(1.0 / 3.0) == "0.3333333333333333");
  CHECK(format_number(2.959122082855911e-04) == "0.0002959122082855911");
  CHECK(format_number(5e-324) == "5e-324");
  CHECK(format_number(std::numeric_limits<double>::max()) == "1.7976931348623157e+308");
  CHECK(format_number(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(format_number(-std::numeric_limits<double>::quiet_NaN()) == "nan");
}

TEST_CASE("the list of units holds every unit and the constants of nature", "[quantity]") {
  const std::vector<UnitRow> rows = list_units();
  REQUIRE(rows.size() == units::definitions.size() + 36 + 3);
  const UnitRow& year = rows.at(4);
  CHECK(year.symbol == "yr");
  CHECK(year.constant == "year");
  CHECK(year.dimension == "time");
  CHECK(year.solar == 365.25);
  CHECK(year.si == 31557600.0);
  CHECK_FALSE(year.reduced.has_value());
  const UnitRow& gravitation = rows.at(rows.size() - 3);
  CHECK(gravitation.symbol == "G");
  CHECK(parse_dimension(gravitation.dimension) == parse_dimension("force length^2/mass^2"));
  CHECK(gravitation.solar == units::solar::G);
  CHECK(gravitation.reduced == 1.0);
  for (const UnitRow& row : rows) CHECK_NOTHROW(parse_dimension(row.dimension));
}

}  // namespace
}  // namespace noether
