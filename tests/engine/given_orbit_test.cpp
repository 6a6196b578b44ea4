// Orbits by period, pericenter, true anomaly, longitudes and time of the pericenter, against an own solution in 60
// digits (Python's mpmath: r = q (1 + e)/(1 + e cos f), Kepler's equation by bisection, Barker's in closed form) and
// against printed values.

#include "engine/given_orbit.hpp"
#include "engine/orbital_elements.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace noether {
namespace {

using State = std::pair<Vec3<double>, Vec3<double>>;

/// The largest difference, in units of the last place of 1, over the size of the vector.
double ulps(const Vec3<double>& found, const std::array<double, 3>& expected) {
  const Vec3<double> right(expected[0], expected[1], expected[2]);
  return std::sqrt(norm2(Vec3<double>(found - right)) / norm2(right)) / 0x1p-53;
}

struct Case {
  const char* name;
  GivenOrbit orbit;
  double mu;
  std::array<double, 3> x, v;
  double bound;  ///< ulps
};

const std::vector<Case> cases = {
    {"period",
     {.P = 4, .e = 0.3, .inc = 0.5, .Omega = 1.25, .omega = -0.75, .M = 2},
     1.5,
     {-0.8711477368575203, 0.14703768743990583, 0.476960355468613},
     {-0.44451657273749723, -1.0082443275511683, 0.056770338368761955},
     8},
    {"distance of the pericenter",
     {.q = 0.25, .e = 0.9375, .inc = 2.5, .Omega = 0.5, .omega = 3, .M = 0.125},
     2,
     {0.2680250072568395, 1.1639474578706093, -0.6670624936006202},
     {0.9451287178324829, 1.162405626032571, -0.42355272506942476},
     8},
    {"true anomaly near the apocenter",
     {.a = 3, .e = 0.96875, .inc = 0.25, .Omega = 4, .omega = 1, .f = 3.125},
     1,
     {-1.4592846239784119, 5.567008164275101, -1.2111453636225515},
     {-0.0787141735735787, 0.015035936687567142, -0.017720531972872246},
     16},
    {"true anomaly near the asymptote of a hyperbola",
     {.a = -3, .e = 1.5, .inc = 0.25, .Omega = 4, .omega = 1, .f = -2.25},
     1,
     {-58.58041974964855, 23.535254703426407, -15.248375293613032},
     {0.5320131916699183, -0.2457708031057618, 0.14382783012480935},
     64},
    {"true anomaly on a parabola",
     {.q = 0.5, .e = 1, .inc = 1.75, .Omega = 4, .omega = 1, .f = 2},
     1,
     {1.0757252769516217, 1.3114095234320273, 0.23783395114696182},
     {0.7029262189092277, 0.6912341822117245, -0.44248882812764917},
     8},
    {"a parabola long after its pericenter",
     {.q = 0.5, .e = 1, .inc = 1.75, .Omega = 4, .omega = 1, .T = -1000},
     1,
     {84.99128289457772, 63.53379757103172, -125.82686685543091},
     {0.05426279371332953, 0.0384660071530749, -0.08790187890481939},
     8},
    {"a parabola shortly before its pericenter",
     {.q = 0.5, .e = 1, .inc = 1.75, .Omega = 4, .omega = 1, .T = 0.125},
     1,
     {-0.3362644883550765, -0.3176048042953748, 0.25882549455932286},
     {0.6844035411852858, 1.1765021942755904, 1.3859181338115292},
     8},
    {"time of the pericenter of an ellipse",
     {.a = 2, .e = 0.5, .inc = 0.25, .Omega = 4, .omega = 1, .T = 3.5},
     1,
     {-1.9659578887435034, 0.7385669714475914, -0.5031771539068872},
     {0.08496332558721297, -0.6355281730776641, 0.12248991804287855},
     8},
    {"time of the pericenter of a hyperbola",
     {.q = 1.5, .e = 2.5, .inc = 0.25, .Omega = 4, .omega = 1, .T = -7.5},
     1,
     {7.899756031321344, 3.943429203599678, 0.8684070816807039},
     {0.851352541777461, 0.7060098705361126, 0.04668336675462048},
     8},
    {"an ellipse that is nearly a parabola",
     {.q = 0.5, .e = 1 - 0x1p-40, .inc = 0.25, .Omega = 4, .omega = 1, .T = -30},
     1,
     {1.360593465175489, 15.226366675404254, -2.2783947484221545},
     {-0.03215005981092373, 0.35233435604608826, -0.06501831338503915},
     16},
    {"a hyperbola that is nearly a parabola",
     {.q = 0.5, .e = 1 + 0x1p-40, .inc = 0.25, .Omega = 4, .omega = 1, .T = -30},
     1,
     {1.360593465242276, 15.226366675492203, -2.2783947484239273},
     {-0.03215005980884671, 0.35233435605028296, -0.0650183133853379},
     16},
};

TEST_CASE("every way of giving an orbit gives its state to rounding", "[orbital_elements][given_orbit]") {
  for (const Case& one : cases) {
    CAPTURE(one.name);
    const State state = state_of_orbit(one.orbit, one.mu);
    CHECK(ulps(state.first, one.x) <= one.bound);
    CHECK(ulps(state.second, one.v) <= one.bound);
  }
}

TEST_CASE("the six usual elements have the bits of state_from_elements", "[orbital_elements][given_orbit]") {
  for (const double e : {0.0, 0.0167, 0.97}) {
    const State given =
        state_of_orbit({.a = 1.5, .e = e, .inc = 0.3, .Omega = 1.1, .omega = 2.7, .M = 5.9}, 2.9591220828559e-4);
    const State direct = state_from_elements<double>({1.5, e, 0.3, 1.1, 2.7, 5.9}, 2.9591220828559e-4);
    CHECK(given.first == direct.first);
    CHECK(given.second == direct.second);
  }
  const State bare = state_of_orbit({.a = 2}, 1), circle = state_from_elements<double>({2, 0, 0, 0, 0, 0}, 1);
  CHECK(bare.first == circle.first);
  CHECK(bare.second == circle.second);
}

TEST_CASE("longitudes are sums: pomega = Omega + omega, l = pomega + M", "[orbital_elements][given_orbit]") {
  // All sums are exact in binary.
  const State direct = state_from_elements<double>({1, 0.25, 0.5, 1.25, 0.5, 2.5}, 1);
  for (const GivenOrbit& orbit :
       {GivenOrbit{.a = 1, .e = 0.25, .inc = 0.5, .Omega = 1.25, .pomega = 1.75, .M = 2.5},
        GivenOrbit{.a = 1, .e = 0.25, .inc = 0.5, .Omega = 1.25, .omega = 0.5, .l = 4.25},
        GivenOrbit{.a = 1, .e = 0.25, .inc = 0.5, .Omega = 1.25, .pomega = 1.75, .l = 4.25}}) {
    const State state = state_of_orbit(orbit, 1);
    CHECK(state.first == direct.first);
    CHECK(state.second == direct.second);
  }
}

TEST_CASE("true anomaly and distance of comets are those printed in a textbook", "[orbital_elements][given_orbit]") {
  // Meeus, Astronomical Algorithms, chapters 34 and 35: q, e, days since the pericenter; degrees and au, as printed.
  struct Comet {
    double q, e, days, degrees, r;
  };
  const double mu = 0.01720209895 * 0.01720209895;
  for (const Comet& one :
       {Comet{1.487469, 1, 112.5642, 66.78862, 2.133911}, Comet{0.921326, 1, 138.4783, 102.74426, 2.364192},
        Comet{0.1, 0.987, 254.9, 164.50029, 4.063777}, Comet{0.123456, 0.99997, -30.47, 221.91190, 0.965053},
        Comet{3.363943, 1.05731, 1237.1, 109.40598, 10.668551}, Comet{0.5871018, 0.9672746, 20, 52.85331, 0.729116}}) {
    const State state = state_of_orbit({.q = one.q, .e = one.e, .T = -one.days}, mu);
    const double turn = 360,
                 degrees = std::atan2(state.first[1], state.first[0]) / units::value("deg", units::si_scale);
    CAPTURE(one.q, one.e);
    CHECK(std::abs(degrees + (degrees < 0 ? turn : 0) - one.degrees) < 0.6e-5);
    CHECK(std::abs(std::sqrt(norm2(state.first)) - one.r) < 0.6e-6);
  }
}

TEST_CASE("the Gaussian year is the period at one astronomical unit", "[orbital_elements][given_orbit]") {
  const State state = state_of_orbit({.P = 365.2568983263281}, 0.01720209895 * 0.01720209895);
  CHECK(std::abs(state.first[0] - 1) < 4e-16);
  CHECK(std::abs(state.second[1] - 0.01720209895) < 1e-17);
}

std::string refusal(const GivenOrbit& orbit, double mu = 1) {
  try {
    state_of_orbit(orbit, mu);
  } catch (const Error& error) {
    return error.key() + ": " + error.what();
  }
  return "";
}

TEST_CASE("orbits that are given twice, not at all or not in this way are refused", "[orbital_elements][messages]") {
  CHECK(refusal({.e = 0.5}) == "a: the orbit has no size; give a, P or q");
  CHECK(refusal({.a = 1, .P = 2}) == "P: P = 2 is given together with a; give only one of a, P or q");
  CHECK(refusal({.a = 1, .omega = 1, .pomega = 2}) ==
        "pomega: pomega = 2 is given together with omega; give only one of omega or pomega");
  CHECK(refusal({.a = 1, .M = 1, .T = 3}) == "T: T = 3 is given together with M; give only one of M, f, l or T");
  CHECK(refusal({.P = -1}) == "P: P = -1 is not a valid period; a time above 0 is expected");
  CHECK(refusal({.q = 0}) == "q: q = 0 is not a valid pericenter distance; a length above 0 is expected");
  CHECK(refusal({.q = 1, .e = -0.5}) == "e: e = -0.5 is not a valid eccentricity; 0 or more is expected");
  CHECK(refusal({.P = 1, .e = 1.5}) == "P: P = 1 is a period, but only an ellipse, e < 1, has one; give a or q");
  CHECK(refusal({.a = 1, .e = 1}) ==
        "e: e = 1 is a parabola, which has no semi-major axis; give q, its pericenter distance");
  CHECK(refusal({.q = 1, .e = 1, .M = 0.5}) == "M: M = 0.5 has no meaning on a parabola, e = 1; give f or T");
  CHECK(refusal({.q = 1, .e = 1, .l = 0.5}) == "l: l = 0.5 has no meaning on a parabola, e = 1; give f or T");
  CHECK(refusal({.q = 1, .e = 2, .f = 2.25}) ==
        "f: f = 2.25 lies beyond the asymptote of this orbit; less than 120 deg is expected");
  CHECK(refusal({.a = 1}, 0) == "mass: an orbit about G m = 0 is impossible; a mass above 0 is expected");
  CHECK(refusal({.a = 1, .f = std::nan("")}) == "f: f = nan is not finite; a finite number is expected");
}

TEST_CASE("an orbit may be about a body or about the barycenter of several", "[orbital_elements][given_orbit]") {
  ParticleSystem<double> s;
  s.add("A", 3, {0.125, 0.2, 0.3}, {1, 2, 3});
  s.add("B", 1, {4.125, 0.2, 0.3}, {1, 6, 3});
  s.add("tracer", 0, {9, 9, 9}, {9, 9, 9});
  const OrbitCenter one = center_of(s, {1});
  CHECK(one.mass() == 1);
  CHECK(one.x() == s.positions()[1]);
  CHECK(one.v() == s.velocities()[1]);
  const OrbitCenter two = center_of(s, {0, 2, 1});
  CHECK(two.mass() == 4);
  CHECK(two.x() == Vec3<double>(1.125, 0.2, 0.3));
  CHECK(two.v() == Vec3<double>(1, 3, 3));
  s.add("dust", 0, {1, 1, 1}, {0, 0, 0});
  CHECK_THROWS_WITH(center_of(s, {2, 3}), "these bodies have no mass, so they have no barycenter");
}

}  // namespace
}  // namespace noether
