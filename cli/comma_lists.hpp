#pragma once
/// Lists on the command line, parted by commas, and numbers that must make sense.

#include "numbers/units.hpp"

#include <string>
#include <vector>

namespace noether {

/// The parts of "a, b,c", blanks about them left out. @throws Error  for an empty list or an empty part
std::vector<std::string> texts_in(const std::string& list, const std::string& option);
/// Times above 0 of a list such as "50 day,100 day" [time]. @throws Error
std::vector<double> times_in(const std::string& list, const std::string& option, const UnitSystem& units);
/// Numbers of a list such as "1e-6,1e-9". @throws Error
std::vector<double> numbers_in(const std::string& list, const std::string& option);

// What is wrong with the text of a number, for the argument parser; "" if nothing. A count may be written as 1e4: it is
// read as a double.
std::string wrong_count(const std::string& text);
std::string wrong_seconds(const std::string& text);
std::string wrong_folder(const std::string& text);

}  // namespace noether
