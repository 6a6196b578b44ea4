#include "cli/comma_lists.hpp"

#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace noether {

namespace {

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || read != end || !std::isfinite(value)) return {};
  return value;
}

}  // namespace

std::vector<std::string> texts_in(const std::string& list, const std::string& option) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t comma = std::min(list.find(',', begin), list.size());
    const std::size_t first = list.find_first_not_of(' ', begin);
    std::string part = first < comma ? list.substr(first, comma - first) : "";
    while (part.ends_with(' ')) part.pop_back();
    if (part.empty()) throw Error(fmt::format("{} '{}': a part of the list is empty", option, list));
    parts.push_back(std::move(part));
    begin = comma + 1;
  }
  return parts;
}

std::vector<double> times_in(const std::string& list, const std::string& option, const UnitSystem& units) {
  std::vector<double> times;
  for (const std::string& part : texts_in(list, option)) {
    double time = 0;
    try {
      time = parse_quantity(part, dimensions::time, units);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", option, error.message()));
    }
    if (!(time > 0)) throw Error(fmt::format("{} '{}' is not a time above 0", option, part));
    times.push_back(time);
  }
  return times;
}

std::vector<double> numbers_in(const std::string& list, const std::string& option) {
  std::vector<double> numbers;
  for (const std::string& part : texts_in(list, option)) {
    const auto number = number_in(part);
    if (!number) throw Error(fmt::format("{}: '{}' is not a number", option, part));
    numbers.push_back(*number);
  }
  return numbers;
}

std::string wrong_count(const std::string& text) {
  const auto number = number_in(text);
  if (!number || *number < 1 || *number != std::floor(*number)) {
    return fmt::format("'{}' is not a whole number above 0", text);
  }
  return *number > 1e6 ? fmt::format("'{}' is more than 1000000", text) : "";
}

std::string wrong_seconds(const std::string& text) {
  const auto number = number_in(text);
  if (number && *number > 0) return "";
  return fmt::format("'{}' is not a number of seconds above 0", text);
}

std::string wrong_folder(const std::string& text) { return text.empty() ? "the name of the folder is empty" : ""; }

}  // namespace noether
