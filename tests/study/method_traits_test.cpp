/// Every method is held to what it claims, and to docs/methods.md.

#include "study/methods_page.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

using namespace noether;

namespace {

constexpr std::size_t limit_column = 9;

/// Rows of docs/methods.md by name; cells without the blanks around them.
const std::map<std::string, std::vector<std::string>>& rows_of_the_page() {
  static const auto rows = [] {
    std::map<std::string, std::vector<std::string>> made;
    std::ifstream page(NOETHER_SOURCE_DIR "/docs/methods.md");
    for (std::string line; std::getline(page, line);) {
      if (line.rfind("| ", 0) != 0) continue;
      std::vector<std::string> cells;
      std::istringstream parts(line.substr(1));
      for (std::string cell; std::getline(parts, cell, '|');) {
        const auto first = cell.find_first_not_of(' ');
        cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
      }
      made.emplace(cells.front(), cells);
    }
    return made;
  }();
  return rows;
}

/// Whether two cells say the same: a number to 1e-3, or 5 % where it tells of rounding in a solver, with the same words
/// after it, anything else letter by letter.
bool same_limit(const std::string& a, const std::string& b) {
  if (a == b) return true;
  std::istringstream left(a), right(b);
  double x = 0, y = 0;
  if (!(left >> x) || !(right >> y)) return false;
  std::string words, other;
  std::getline(left, words);
  std::getline(right, other);
  return std::abs(x - y) < (words.empty() ? 1e-3 : 0.05 * x) && words == other;
}

void check_method(const KnownMethod& known) {
  const MeasuredMethod method = measured_method(known);
  INFO(method.name << ": " << fmt::format("{}", fmt::join(method.differences(), "; ")));
  CHECK(method.differences().empty());
  INFO("docs/methods.md is written by ./noether list methods --measured > docs/methods.md");
  const auto row = rows_of_the_page().find(method.name);
  CHECK((row != rows_of_the_page().end()));
  if (row == rows_of_the_page().end()) return;
  const std::vector<std::string> cells = cells_of(method);
  REQUIRE(row->second.size() == cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    CAPTURE(k, cells[k], row->second[k]);
    CHECK((k == limit_column ? same_limit(cells[k], row->second[k]) : cells[k] == row->second[k]));
  }
}

/// Methods whose steps are dear where their stability is looked for by runs.
bool is_dear(const KnownMethod& known) {
  return known.info != nullptr && known.info->family == "multistep" && known.info->evaluations == 0 &&
         known.info->fixed;
}

std::vector<std::string> differences(const Scheme& scheme) {
  return measured_method({.scheme = &scheme}).differences();
}

}  // namespace

TEST_CASE("every scheme does what it claims, and what docs/methods.md says of it", "[methods][slow]") {
  for (const KnownMethod& known : all_known_methods()) {
    if (known.scheme != nullptr) check_method(known);
  }
}

TEST_CASE("every classical method does what it claims, and what docs/methods.md says of it", "[methods][slow]") {
  for (const KnownMethod& known : all_known_methods()) {
    if (known.info != nullptr && !is_dear(known)) check_method(known);
  }
}

TEST_CASE("multistep methods that iterate do what they claim, and what docs/methods.md says of them",
          "[methods][slow]") {
  for (const KnownMethod& known : all_known_methods()) {
    if (is_dear(known)) check_method(known);
  }
}

TEST_CASE("docs/methods.md has a row for every method and for nothing else, and each says what it is for",
          "[methods]") {
  std::vector<std::string> names = {"method"};
  for (const KnownMethod& known : all_known_methods()) {
    CAPTURE(std::string(known.name()));
    names.emplace_back(known.name());
    CHECK((known.scheme != nullptr ? !known.scheme->use.empty()
                                   : !(known.info->use.empty() && known.info->summary.empty())));
  }
  for (const MethodInfo* info : methods::of_rotations()) names.emplace_back(info->name);
  std::sort(names.begin(), names.end());
  std::vector<std::string> rows;
  for (const auto& [name, cells] : rows_of_the_page()) rows.push_back(name);
  CHECK(rows == names);
}

TEST_CASE("a wrong claim of a scheme is seen", "[methods]") {
  Scheme wrong = schemes::verlet;
  wrong.order.classical = 4;
  wrong.stability_limit = 1.998;
  CHECK(differences(wrong) ==
        std::vector<std::string>{"order: claims 4, measured 2", "stability limit: claims 1.998, measured 2"});
  wrong = schemes::verlet;
  wrong.word = schemes::symplectic_euler_a.word;
  REQUIRE(differences(wrong).size() == 1);
  CHECK(differences(wrong).front().rfind("order: claims 2, measured 0.99", 0) == 0);
  wrong = schemes::pefrl;
  wrong.word = schemes::verlet.word;
  CHECK(differences(wrong) ==
        std::vector<std::string>{"order: claims 4, measured 2", "stability limit: claims 2.989, measured 2"});
}

TEST_CASE("a wrong claim of a classical method is seen", "[methods]") {
  MethodInfo wrong = *methods::find("rk4");
  wrong.evaluations = 5;
  wrong.stability_limit = 3;
  CHECK(measured_method({.info = &wrong}).differences() ==
        std::vector<std::string>{"evaluations: claims 5, measured 4", "stability limit: claims 3, measured 2.828"});
  wrong = *methods::find("heun");
  wrong.make = methods::find("trapezoidal")->make;
  wrong.make_quad = methods::find("trapezoidal")->make_quad;
  wrong.name = "trapezoidal";
  CHECK(measured_method({.info = &wrong}).differences() ==
        std::vector<std::string>{"evaluations: claims 2, measured nothing", "stability limit: claims 0, measured inf"});
}

TEST_CASE("what a method keeps is measured, not taken from its claims", "[methods]") {
  const MethodTraits midpoint = measured_traits({.info = methods::find("implicit_midpoint")}),
                     trapezoidal = measured_traits({.info = methods::find("trapezoidal")}),
                     rk4 = measured_traits({.info = methods::find("rk4")});
  CHECK(midpoint.symplectic);
  CHECK_FALSE(trapezoidal.symplectic);
  CHECK((midpoint.reversible && trapezoidal.reversible && !rk4.reversible));
  CHECK((midpoint.angular_momentum && !trapezoidal.angular_momentum && !rk4.angular_momentum));
  CHECK((trapezoidal.energy == EnergyError::bounded && rk4.energy == EnergyError::drifts));
}
