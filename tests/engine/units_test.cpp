#include "numbers/units.hpp"

#include "numbers/error.hpp"
#include "numbers/real.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace noether {
namespace {

struct ExactRow {
  std::string_view symbol;
  double solar, molecular, si;
};

/// Each value computed with Python's exact fractions from the SI definitions and rounded once.
const std::vector<ExactRow> exact_units = {
    {"s", 1.1574074074074073e-05, 1000000000000.0, 1.0},
    {"min", 0.0006944444444444445, 60000000000000.0, 60.0},
    {"hour", 0.041666666666666664, 3600000000000000.0, 3600.0},
    {"day", 1.0, 8.64e+16, 86400.0},
    {"yr", 365.25, 3.15576e+19, 31557600.0},
    {"kyr", 365250.0, 3.15576e+22, 31557600000.0},
    {"Myr", 365250000.0, 3.15576e+25, 31557600000000.0},
    {"Gyr", 365250000000.0, 3.15576e+28, 3.15576e+16},
    {"fs", 1.1574074074074075e-20, 0.001, 1e-15},
    {"ps", 1.1574074074074074e-17, 1.0, 1e-12},
    {"ns", 1.1574074074074074e-14, 1000.0, 1e-09},
    {"m", 6.684587122268445e-12, 1000000000.0, 1.0},
    {"cm", 6.684587122268446e-14, 10000000.0, 0.01},
    {"km", 6.684587122268446e-09, 1000000000000.0, 1000.0},
    {"au", 1.0, 1.495978707e+20, 149597870700.0},
    {"nm", 6.684587122268445e-21, 1.0, 1e-09},
    {"angstrom", 6.684587122268445e-22, 0.1, 1e-10},
    {"kg", 5.029143888835803e-31, 6.022140762081123e+26, 1.0},
    {"g", 5.0291438888358035e-34, 6.022140762081123e+23, 0.001},
    {"Msun", 1.0, 1.1974484912729725e+57, 1.98841e+30},
    {"u", 8.3510898989645e-58, 1.0, 1.6605390666e-27},
    {"e", 1.0, 1.0, 1.602176634e-19},
    {"C", 6.241509074460762e+18, 6.241509074460762e+18, 1.0},
    {"kJ/mol", 2.7856068380997216e-64, 1.0, 1.6605390671738467e-21},
    {"J", 1.6775316481055055e-43, 6.02214076e+20, 1.0},
    {"g/cm^3", 1683721.6548954938, 602.2140762081123, 1000.0},
    {"K", 1.0, 1.0, 1.0},
    {"rad", 1.0, 1.0, 1.0},
    {"deg", 0.017453292519943295, 0.017453292519943295, 0.017453292519943295},
};

TEST_CASE("every unit is the exact ratio of the definitions, rounded once", "[units]") {
  REQUIRE(exact_units.size() == units::definitions.size());
  for (const ExactRow& row : exact_units) {
    INFO(row.symbol);
    REQUIRE(units::find(row.symbol) != nullptr);
    CHECK(units::value(row.symbol, units::solar_scale) == row.solar);
    CHECK(units::value(row.symbol, units::molecular_scale) == row.molecular);
    CHECK(units::value(row.symbol, units::si_scale) == row.si);
  }
}

TEST_CASE("constants of nature are those of CODATA 2018, and of Gauss in the solar system", "[units]") {
  CHECK(units::solar::G == 2.959122082855911e-04);
  CHECK(units::molecular::G == 1.108293589220838e-34);
  CHECK(units::si::G == 6.6743e-11);
  CHECK(units::solar::k_B == 2.316082392425218e-66);
  CHECK(units::molecular::k_B == 0.00831446261815324);  // the gas constant in kJ/mol/K
  CHECK(units::si::k_B == 1.380649e-23);
  CHECK(units::solar::coulomb_constant == 2.5870659726489333e-82);
  CHECK(units::molecular::coulomb_constant == 138.93545764438204);
  CHECK(units::si::coulomb_constant == 8987551792.2611713);  // by 40 digits 8987551792.26117215895...
}

TEST_CASE("the units of a system are one in it, and their multiples have no rounding", "[units]") {
  namespace solar = units::solar;
  namespace molecular = units::molecular;
  namespace si = units::si;
  STATIC_REQUIRE(solar::au == 1.0);
  STATIC_REQUIRE(solar::day == 1.0);
  STATIC_REQUIRE(solar::Msun == 1.0);
  STATIC_REQUIRE(solar::year == 365.25);
  STATIC_REQUIRE(molecular::nm == 1.0);
  STATIC_REQUIRE(molecular::ps == 1.0);
  STATIC_REQUIRE(molecular::u == 1.0);
  STATIC_REQUIRE(molecular::e == 1.0);
  STATIC_REQUIRE(molecular::kJ_per_mol == 1.0);
  STATIC_REQUIRE(molecular::fs == 0.001);
  STATIC_REQUIRE(molecular::angstrom == 0.1);
  STATIC_REQUIRE(si::km == 1000.0);
  STATIC_REQUIRE(si::u == 1.66053906660e-27);
  STATIC_REQUIRE(si::e == 1.602176634e-19);
  STATIC_REQUIRE(si::Msun == 1.98841e30);
}

TEST_CASE("expressions of programs have the values that they say", "[units]") {
  {
    using namespace units::solar;
    CHECK(100 * day == 100.0);
    CHECK(10'000 * year == 3652500.0);
    CHECK(1e6 * year == 365250000.0);
    CHECK(60'330 * km == 60330.0 * 6.684587122268446e-09);
    CHECK(600 * second == 600.0 * 1.1574074074074073e-05);
  }
  {
    using namespace units::molecular;
    CHECK(2 * fs == 0.002);
    CHECK(1 / ps == 1.0);
    CHECK(300 * K == 300.0);
    CHECK(0.997 * g_per_cm3 == 0.997 * 602.2140762081123);
  }
}

/// The value of an energy of mass 1 and velocity 1 in the system's own energy unit.
double mechanical_energy(const units::Scale& s) {
  return (s.mass * units::power(s.length, 2) / units::power(s.time, 2) / s.energy).rounded();
}

TEST_CASE("a mass times a velocity squared is an energy of the same system", "[units]") {
  CHECK(mechanical_energy(units::solar_scale) == 1.0);
  CHECK(mechanical_energy(units::si_scale) == 1.0);
  // In kJ/mol up to the molar mass constant of CODATA 2018, 0.99999999965(30) g/mol.
  CHECK(mechanical_energy(units::molecular_scale) == 0.9999999996544214);
}

TEST_CASE("unit systems are found by name and stay where they are", "[units]") {
  CHECK(&unit_system("solar") == &unit_system("solar"));
  CHECK(unit_system("solar").G == units::solar::G);
  CHECK(unit_system("molecular").energy == "kJ/mol");
  CHECK(unit_system("si").charge == "C");
  CHECK(unit_system("reduced").G == 1.0);
  CHECK(unit_system("reduced").k_B == 1.0);
  CHECK(unit_system("reduced").is_reduced());
  CHECK_FALSE(unit_system("si").is_reduced());
}

std::string message_of(std::string_view name) {
  try {
    unit_system(name);
  } catch (const Error& error) {
    CHECK(error.exit_code() == 2);
    CHECK(error.value() == name);
    return error.what();
  }
  return "no error";
}

TEST_CASE("an unknown unit system is refused with a proposal", "[units]") {
  CHECK(message_of("solr") == "unknown unit system 'solr'; did you mean 'solar'?");
  CHECK(message_of("imperial") == "unknown unit system 'imperial'; expected one of: solar, molecular, si, reduced");
}

TEST_CASE("dimensions multiply, divide and take powers", "[units]") {
  STATIC_REQUIRE(dimensions::velocity == Dimension{.length = 1, .time = -1});
  STATIC_REQUIRE(dimensions::energy == Dimension{.length = 2, .mass = 1, .time = -2});
  STATIC_REQUIRE(power(dimensions::velocity, -2) == Dimension{.length = -2, .time = 2});
  STATIC_REQUIRE(dimensions::energy / dimensions::force == dimensions::length);
  STATIC_REQUIRE(dimensions::energy != dimensions::force);
}

TEST_CASE("an error knows its place in the input and its exit code", "[error]") {
  const SceneError placed("unknown key 'stepp'",
                          {.file = "a.toml", .line = 14, .key = "integrator.stepp", .value = "1"});
  CHECK(std::string(placed.what()) == "a.toml:14: unknown key 'stepp'");
  CHECK(placed.message() == "unknown key 'stepp'");
  CHECK(placed.file() == "a.toml");
  CHECK(placed.line() == 14);
  CHECK(placed.key() == "integrator.stepp");
  CHECK(placed.value() == "1");
  CHECK(std::string(Error("no place").what()) == "no place");
  CHECK(std::string(FileError("cannot be read", {.file = "run.h5"}).what()) == "run.h5: cannot be read");
  CHECK(placed.exit_code() == 2);
  CHECK(SchemeMismatch("").exit_code() == 2);
  CHECK(MissingColumn("").exit_code() == 2);
  CHECK(FileError("").exit_code() == 3);
  CHECK(LogicError("").exit_code() == 4);
}

TEST_CASE("a broken expectation throws, and its message is built only then", "[error]") {
  int built = 0;
  const auto message = [&] {
    ++built;
    return std::string("n must be positive");
  };
  NOETHER_EXPECTS(1 + 1 == 2, message());
  CHECK(built == 0);
  const auto break_it = [&] { NOETHER_EXPECTS(1 + 1 == 3, message()); };
  CHECK_THROWS_AS(break_it(), LogicError);
  CHECK(built == 1);
}

}  // namespace
}  // namespace noether
