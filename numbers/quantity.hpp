#pragma once
/// Quantities in text: "100 day", "0.997 g/cm^3", "3 au/day", and dimensions in words: "length^3/time^2".
///
/// A quantity is number times the constant of numbers/units.hpp, compound units from left to right, as C++ evaluates
/// them, and to the same bits:
///
///     "3 km/s"         3 * km / second
///     "1/ps"           1 / ps
///     "5 kJ/mol/nm^2"  5 * kJ_per_mol / (nm * nm)
///
/// Units are joined by '*' or a space, '/', and raised by '^n'. "kJ/mol" and "g/cm^3" are units of their own.

#include "numbers/units.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// A unit read once, to convert many numbers, such as a column "vx [au/day]".
struct Unit {
  /// One step of the conversion: a multiplication, or a division.
  struct Factor {
    double value;
    bool divides;
  };

  Dimension dimension;
  std::vector<Factor> factors;

  /// The number in the unit system the unit was read for, from left to right.
  /// @throws never
  double times(double number) const noexcept;
};

/// Reads a unit such as "au/day", "1/day", "kg m/s^2".
///
/// Powers are written "s^-1", "s**-1" or "s-1". The reduced system knows "1" and angles only.
/// @throws Error for an unknown unit (with a proposal) or what is not a unit
Unit parse_unit(std::string_view text, const UnitSystem& system);

/// The same for numbers of a dimension, in words as `parse_dimension` reads them: no unit of another one is proposed.
///
/// The unit may have another dimension nevertheless.
/// @throws Error as parse_unit
Unit parse_unit(std::string_view text, std::string_view dimension, const UnitSystem& system);

/// The value of one of a unit, such as 1000 for "km" in si.
///
/// To convert numbers use `Unit::times`, which agrees with text to the bit: number * unit_value may round otherwise.
/// @throws Error as parse_unit
double unit_value(std::string_view unit, const UnitSystem& system);

/// The value of a quantity in a unit system.
///
/// A plain number is read where the expected dimension is none, or the system is reduced. Numbers are decimal, with
/// an optional sign and exponent, and do not depend on the locale.
/// @throws Error for a missing, unknown or wrong unit, and for what is not a finite number
double parse_quantity(std::string_view text, const Dimension& expected, const UnitSystem& system);

/// The value of an angle [rad]. Degrees or radians: without a unit it would be a guess, except in the reduced system,
/// where all numbers are bare.
/// @throws Error as parse_quantity
double parse_angle(std::string_view text, const UnitSystem& system);

/// A quantity of a dimension as text that can be read: "1 day", "1/day", "1" in the reduced system.
/// @throws std::bad_alloc
std::string example_of(const Dimension& dimension, std::string_view number, const UnitSystem& system);

/// Reads a dimension in words: 1, angle, length, time, mass, charge, temperature, velocity, acceleration, force,
/// energy, frequency, density, pressure, and their products, quotients and powers.
/// @throws Error for an unknown word (with a proposal)
Dimension parse_dimension(std::string_view text);

/// A dimension in words that `parse_dimension` reads: "velocity", "length^3/time^2"; "1" for none.
/// @throws std::bad_alloc
std::string to_text(const Dimension& dimension);

/// The unit that numbers of a dimension stand in: "au/day" for a velocity in the solar system.
///
/// `parse_unit` reads it; "1" for none and for the reduced system.
/// @throws std::bad_alloc
std::string unit_of(const Dimension& dimension, const UnitSystem& system);

/// The shortest decimal that reads back to the same double; "inf", "-inf" and "nan" for what is no number.
/// @throws std::bad_alloc
std::string format_number(double value);

/// One row of `noether list units`: a unit or a constant of nature and its value in each system.
struct UnitRow {
  std::string symbol;     ///< what scenes write; the name of a constant: "G", "k_B", "coulomb_constant"
  std::string constant;   ///< its name in C++
  std::string dimension;  ///< in words
  std::optional<double> solar, molecular, si, reduced;  ///< empty where a system does not have it
};

/// All units in the order of their table, then the constants of nature.
/// @throws std::bad_alloc
std::vector<UnitRow> list_units();

}  // namespace noether
