#include "io/trajectory_layout.hpp"

#include "numbers/quantity.hpp"

#include <algorithm>
#include <numeric>

namespace noether::io {

Index rows_per_chunk(Index numbers_per_row, Index wanted) {
  const Index bytes = 8 * std::max<Index>(numbers_per_row, 1);
  const Index whole_pages = 4096 / std::gcd(Index{4096}, bytes);
  const Index enough = (wanted + bytes - 1) / bytes;
  const Index rows = (enough + whole_pages - 1) / whole_pages * whole_pages;
  return rows * bytes <= (1 << 20) ? rows : std::max<Index>(1, (1 << 20) / bytes);
}

std::string unit_in_words(const std::string& dimension, const UnitSystem& units) {
  if (const std::size_t comma = dimension.find(", "); comma != std::string::npos) {
    return unit_in_words(dimension.substr(0, comma), units) + ", " + unit_in_words(dimension.substr(comma + 2), units);
  }
  if (dimension == "angle") return "rad";
  try {
    return unit_of(parse_dimension(dimension), units);
  } catch (const Error&) {
    return dimension;
  }
}

}  // namespace noether::io
