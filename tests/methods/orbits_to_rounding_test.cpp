/// Errors at rounding on ten systems of two to ten bodies, against orbits made by other code in extended precision.

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

  double G = 0, until = 0, step = 0;
  Index about = -1;  ///< errors are those of the bodies behind this one, about it; -1: of all
  std::vector<Start> starts;

  explicit Orbits(const std::string& name) {
    std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/orbits/" + name + ".txt");
    std::string text, line;
    while (std::getline(file, line)) {
      if (line[0] != '#') text += line + '\n';
    }
    std::istringstream in(text);
    Index bodies = 0;
    int count = 0;
    in >> G >> until >> step >> bodies >> about >> count;
    std::vector<double> masses(static_cast<std::size_t>(bodies));
    for (double& m : masses) in >> m;
    for (int k = 0; k < count; ++k) {
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
    REQUIRE(starts.size() == 4);
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

  /// The median of all starts, by steps of one length or of the method's own choice.
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
    return (errors[1] + errors[2]) / 2;
  }
};

/// Medians of 16 starts by IAS15 of rebound 5.2.2 with its defaults; tests/data/orbits/README.md says how they were
/// found.
struct OrbitsOfIas15 {
  const char* name;
  double of_ias15;
  bool fixed;  ///< whether steps of a twelfth of the shortest period meet it as well: none is very eccentric
};
constexpr OrbitsOfIas15 orbits_of_ias15[] = {{"outer_planets", 3.9e-12, true}, {"solar_system", 3.9e-13, false},
                                             {"chain_of_7", 9.7e-12, true},    {"chain_of_5", 1.3e-11, true},
                                             {"triple", 1.8e-12, false},       {"eccentric", 1.5e-12, false},
                                             {"circumbinary", 5.6e-12, false}, {"equal_binary", 1.6e-12, false},
                                             {"moons", 1.9e-9, true},          {"ten_bodies", 8.7e-13, true}};

}  // namespace

TEST_CASE("adaptive gauss_8 ends no farther from the truth than IAS15 on ten systems", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    const double median = Orbits(system.name).median("gauss_8", false);
    CAPTURE(system.name, fmt::format("{:.2e}", median));
    CHECK(median <= system.of_ias15);
    CHECK(median > 1e-16);  // a truth, not the method itself
  }
}

TEST_CASE("adaptive gauss_radau_15 ends no farther from the truth than IAS15 on ten systems", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    const double median = Orbits(system.name).median("gauss_radau_15", false);
    CAPTURE(system.name, fmt::format("{:.2e}", median));
    CHECK(median <= system.of_ias15);
    CHECK(median > 1e-16);
  }
}

TEST_CASE("adaptive gauss_7 and gauss_6 do so too", "[orbits][slow]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    for (const char* name : {"gauss_7", "gauss_6"}) {
      const double median = Orbits(system.name).median(name, false);
      CAPTURE(name, system.name, fmt::format("{:.2e}", median));
      CHECK(median <= system.of_ias15);
    }
  }
}

TEST_CASE("gauss_8 with a twelfth of the shortest period does so on five of them", "[orbits]") {
  for (const OrbitsOfIas15& system : orbits_of_ias15) {
    if (!system.fixed) continue;
    const double median = Orbits(system.name).median("gauss_8", true);
    CAPTURE(system.name, fmt::format("{:.2e}", median));
    CHECK(median <= system.of_ias15);
  }
}

TEST_CASE("moons of a giant are a hundred times nearer to the truth than rounding of their positions allows",
          "[orbits]") {
  const Orbits moons("moons");
  CHECK(moons.median("gauss_8", false) < 1.9e-11);
  CHECK(moons.median("gauss_8", true) < 1.9e-11);
  CHECK(moons.median("gauss_radau_15", false) < 1.9e-11);
}
