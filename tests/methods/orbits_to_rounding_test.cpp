/// Errors at rounding on twelve systems of two to ten bodies, against orbits made by other code in extended precision.

#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace noether;

namespace {

/// A file of tests/data/orbits: starts that differ by 1e-10, and where they lead.
struct Orbits {
  struct Start {
    ParticleSystem<double> begin;
    std::vector<Vec3<Quad>> end;
  };

  static constexpr std::size_t few = 4, all = 16;  ///< starts of fast tests, and of a file

  double G = 0, until = 0, step = 0;
  Index about = -1;  ///< errors are those of the bodies behind this one, about it; -1: of all
  std::vector<Start> starts;

  /// The first `wanted` starts of the file.
  Orbits(const std::string& name, std::size_t wanted) {
    std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/orbits/" + name + ".txt");
    std::string text, line;
    while (std::getline(file, line) && !line.starts_with(fmt::format("# start {}:", wanted))) {
      if (line[0] != '#') text += line + '\n';
    }
    std::istringstream in(text);
    Index bodies = 0;
    std::size_t count = 0;
    in >> G >> until >> step >> bodies >> about >> count;
    std::vector<double> masses(static_cast<std::size_t>(bodies));
    for (double& m : masses) in >> m;
    REQUIRE(count == all);
    while (starts.size() < wanted) {
      Start start;
      for (Index i = 0; i < bodies; ++i) {
        Vec3<double> x, v;
        Vec3<Quad> end;
        for (int axis = 0; axis < 3; ++axis) in >> x[axis];
        for (int axis = 0; axis < 3; ++axis) in >> v[axis];
        for (int axis = 0; axis < 3; ++axis) {
          double high = 0, low = 0;
          in >> high >> low;
          end[axis] = Quad(high) + Quad(low);
        }
        start.begin.add("body " + std::to_string(i), masses[static_cast<std::size_t>(i)], x, v);
        start.end.push_back(end);
      }
      starts.push_back(std::move(start));
    }
    REQUIRE(in);
  }

  /// Root of sums of squares of distances from the truth, divided by that of positions.
  double error(const Start& start, const ParticleSystem<double>& s) const {
    const auto relative = [&](Index i, const auto& of) {
      Vec3<Quad> x = of(i);
      if (about >= 0) x -= of(about);
      return x;
    };
    Quad off = 0, size = 0;
    for (Index i = about + 1; i < s.size(); ++i) {
      const Vec3<Quad> right = relative(i, [&](Index k) { return start.end[static_cast<std::size_t>(k)]; });
      const Vec3<Quad> reached = relative(i, [&](Index k) { return Vec3<Quad>(s.positions()[k].cast<Quad>()); });
      off += norm2(Vec3<Quad>(reached - right));
      size += norm2(right);
    }
    return std::sqrt(static_cast<double>(off / size));
  }

  /// The median of these starts, an even number, by steps of one length or of the method's own choice.
  double median(const char* name, bool fixed) const {
    std::vector<double> errors;
    for (const Start& start : starts) {
      const auto used = test::classical_over(Gravity{.G = G}, method(name, {.adaptive = !fixed}));
      Simulation run = fixed ? Simulation(start.begin, used, step) : Simulation(start.begin, used);
      const Outcome outcome = fixed ? run.run(std::lround(until / step)) : run.run_until(until);
      REQUIRE(outcome.ok());
      errors.push_back(error(start, run.particles()));
    }
    std::sort(errors.begin(), errors.end());
    return (errors[errors.size() / 2 - 1] + errors[errors.size() / 2]) / 2;
  }
};

/// Medians of the 16 starts of each file by IAS15 of rebound 5.2.2 with its defaults: tests/data/orbits/ias15.py.
struct OrbitsOfIas15 {
  const char* name;
  double of_ias15;
  bool fixed;        ///< whether steps of a twelfth of the shortest period meet it as well: none is very eccentric
  double times = 1;  ///< how many times nearer to the truth the methods have to end
};
constexpr OrbitsOfIas15 orbits_of_ias15[] = {
    {"outer_planets", 2.86e-12, true}, {"solar_system", 4.75e-13, false}, {"chain_of_7", 9.36e-12, true},
    {"chain_of_5", 1.47e-11, true},    {"triple", 2.48e-12, false},       {"eccentric", 1.57e-12, false},
    {"circumbinary", 5.85e-12, false}, {"equal_binary", 2.25e-12, false}, {"moons", 2.31e-9, true, 100},
    {"ten_bodies", 5.52e-13, true},    {"two_bodies", 1.91e-11, false},   {"double_binary", 3.09e-12, false}};

/// Whether the median of the first `starts` starts is at most IAS15's of all.
void check_median(const OrbitsOfIas15& system, std::size_t starts, const char* name, bool fixed) {
  const double median = Orbits(system.name, starts).median(name, fixed);
  CAPTURE(system.name, name, fixed, fmt::format("{:.2e}", median));
  CHECK(median * system.times <= system.of_ias15);
  CHECK(median > 1e-16);  // a truth, not the method itself
}

}  // namespace

// Moons of a giant have to end a hundred times nearer to the truth than IAS15: nearer than rounding of their positions
// allows.
TEST_CASE("adaptive gauss_8 ends no farther from the truth than IAS15 on twelve systems", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) check_median(system, Orbits::few, "gauss_8", false);
}

TEST_CASE("adaptive gauss_radau_15 ends no farther from the truth than IAS15 on twelve systems", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) check_median(system, Orbits::few, "gauss_radau_15", false);
}

TEST_CASE("adaptive gauss_7 and gauss_6 do so too", "[orbits][slow]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    for (const char* name : {"gauss_7", "gauss_6"}) check_median(system, Orbits::few, name, false);
  }
}

TEST_CASE("gauss_8 with a twelfth of the shortest period does so on five of them", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    if (system.fixed) check_median(system, Orbits::few, "gauss_8", true);
  }
}

TEST_CASE("gauss_8 and gauss_radau_15 do so by the median of all sixteen starts", "[orbits][slow]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    for (const char* name : {"gauss_8", "gauss_radau_15"}) check_median(system, Orbits::all, name, false);
    if (system.fixed) check_median(system, Orbits::all, "gauss_8", true);
  }
}
