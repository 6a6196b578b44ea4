#include "constraints/partition.hpp"
#include "constraints/angle.hpp"
#include "constraints/surfaces.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/refusal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

using Indices = std::vector<Index>;

Indices listed(std::span<const Index> numbers) { return {numbers.begin(), numbers.end()}; }

/// Particles of these masses, anywhere.
ParticleSystem<double> particles_of(const std::vector<double>& masses) {
  ParticleSystem<double> s;
  for (std::size_t k = 0; k < masses.size(); ++k) {
    const double t = static_cast<double>(k);
    s.add(std::to_string(k), masses[k], {t, std::sin(t), std::cos(2 * t)}, {0, 0, 0});
  }
  return s;
}

/// The three distances of a rigid water.
void add_water(ConstraintSet& set, const ParticleSystem<double>& s, const std::array<Index, 3>& atoms,
               double bond = 0.1) {
  set.add(s, Distance{bond}, {atoms[0], atoms[1]});
  set.add(s, Distance{bond}, {atoms[0], atoms[2]});
  set.add(s, Distance{0.1633}, {atoms[1], atoms[2]});
}

/// Everything that a partition tells.
struct Told {
  std::vector<Indices> particles, components, places;
  std::vector<std::vector<Partition::Member>> constraints;
  Indices kind, equations;

  bool operator==(const Told&) const = default;
};
Told told(const Partition& parts) {
  Told all;
  for (Index c = 0; c < parts.components(); ++c) {
    all.particles.push_back(listed(parts.particles(c)));
    all.constraints.emplace_back(parts.constraints(c).begin(), parts.constraints(c).end());
    all.kind.push_back(parts.kind(c));
  }
  for (Index k = 0; k < parts.kinds(); ++k) {
    all.components.push_back(listed(parts.components_of(k)));
    all.places.push_back(listed(parts.places(k)));
    all.equations.push_back(parts.equations(k));
  }
  return all;
}

/// Two molecules of one kind, or of two.
Index kinds_of_two(const ConstraintSet& set, const ParticleSystem<double>& s) {
  const Partition parts(set, s.masses());
  REQUIRE(parts.components() == 2);
  return parts.kinds();
}

TEST_CASE("an empty set has no components; particles that nothing ties belong to none", "[constraints][partition]") {
  const auto s = particles_of({1, 2, 3});
  const Partition parts(ConstraintSet(), s.masses());
  CHECK(parts.components() == 0);
  CHECK(parts.kinds() == 0);
  CHECK(parts.component_of(2) == -1);
  CHECK(Partition().components() == 0);
  ConstraintSet set;
  set.add(s, Distance{}, {0, 2});
  const Partition one(set, s.masses());
  CHECK(listed(one.particles(0)) == Indices{0, 2});
  CHECK(one.component_of(0) == 0);
  CHECK(one.component_of(1) == -1);
}

TEST_CASE("a chain is one component, in whatever order its links are added", "[constraints][partition]") {
  constexpr Index links = 2000;
  const auto s = particles_of(std::vector<double>(links + 1, 14));
  Indices order(links);
  for (Index i = 0; i < links; ++i) order[static_cast<std::size_t>(i)] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937_64(5));
  ConstraintSet set;
  for (const Index i : order) set.add(s, Distance{1.5}, {i, i + 1});
  const Partition parts(set, s.masses());
  REQUIRE(parts.components() == 1);
  CHECK(parts.particles(0).size() == links + 1);
  CHECK(parts.equations(0) == links);
  for (Index i = 0; i < links; ++i) {
    const Partition::Member& member = parts.constraints(0)[static_cast<std::size_t>(i)];
    REQUIRE(order[static_cast<std::size_t>(member.constraint)] == i);
    REQUIRE(member.equation == member.constraint);
    REQUIRE(parts.places(0)[static_cast<std::size_t>(2 * i + 1)] == i + 1);
  }
}

TEST_CASE("rigid waters are all of one kind, in however their particles are numbered", "[constraints][partition]") {
  constexpr Index waters = 100;
  SECTION("molecule by molecule") {
    std::vector<double> masses;
    for (Index w = 0; w < waters; ++w) masses.insert(masses.end(), {16, 1, 1});
    const auto s = particles_of(masses);
    ConstraintSet set;
    for (Index w = 0; w < waters; ++w) add_water(set, s, {3 * w, 3 * w + 1, 3 * w + 2});
    const Partition parts(set, s.masses());
    REQUIRE(parts.components() == waters);
    REQUIRE(parts.kinds() == 1);
    CHECK(parts.components_of(0).size() == waters);
    CHECK(parts.equations(0) == 3);
    CHECK(listed(parts.places(0)) == Indices{0, 1, 0, 2, 1, 2});
    CHECK(listed(parts.particles(7)) == Indices{21, 22, 23});
    CHECK(parts.constraints(7)[1] == Partition::Member{0, 22, 22});
    CHECK(parts.component_of(23) == 7);
  }
  SECTION("all oxygens first, then a hydrogen of each, then the other") {
    std::vector<double> masses(waters, 16);
    masses.resize(3 * waters, 1);
    const auto s = particles_of(masses);
    ConstraintSet set;
    for (Index w = waters; w-- > 0;) add_water(set, s, {w, waters + w, 2 * waters + w});
    const Partition parts(set, s.masses());
    REQUIRE(parts.components() == waters);
    CHECK(parts.kinds() == 1);
    CHECK(listed(parts.particles(7)) == Indices{7, waters + 7, 2 * waters + 7});
    CHECK(parts.constraints(7)[0].constraint == 3 * (waters - 1 - 7));
  }
}

TEST_CASE("molecules that differ in a length, a mass, a pattern or a type are of two kinds",
          "[constraints][partition]") {
  const auto s = particles_of({16, 1, 1, 16, 1, 1});
  SECTION("equal ones: one kind") {
    ConstraintSet set;
    add_water(set, s, {0, 1, 2});
    add_water(set, s, {3, 4, 5});
    CHECK(kinds_of_two(set, s) == 1);
  }
  SECTION("the last bit of a length") {
    ConstraintSet set;
    add_water(set, s, {0, 1, 2});
    add_water(set, s, {3, 4, 5}, std::nextafter(0.1, 1));
    CHECK(kinds_of_two(set, s) == 2);
  }
  SECTION("the last bit of a mass") {
    const auto heavy = particles_of({16, 1, 1, 16, 1, std::nextafter(1.0, 2)});
    ConstraintSet set;
    add_water(set, heavy, {0, 1, 2});
    add_water(set, heavy, {3, 4, 5});
    CHECK(kinds_of_two(set, heavy) == 2);
  }
  SECTION("who is tied to whom") {
    ConstraintSet set;
    set.add(s, Distance{1}, {0, 1}).add(s, Distance{1}, {0, 2});
    set.add(s, Distance{1}, {3, 4}).add(s, Distance{1}, {4, 5});
    CHECK(kinds_of_two(set, s) == 2);
  }
  SECTION("which of two lengths stands where") {
    ConstraintSet set;
    set.add(s, Distance{1}, {0, 1}).add(s, Distance{2}, {0, 2});
    set.add(s, Distance{2}, {3, 4}).add(s, Distance{1}, {3, 5});
    CHECK(kinds_of_two(set, s) == 2);
  }
  SECTION("an angle in the place of a distance") {
    ConstraintSet set;
    set.add(s, Distance{1}, {0, 1}).add(s, Distance{1}, {0, 2}).add(s, Angle{1.9}, {1, 0, 2});
    set.add(s, Distance{1}, {3, 4}).add(s, Distance{1}, {3, 5}).add(s, Distance{1.6}, {4, 5});
    CHECK(kinds_of_two(set, s) == 2);
  }
  SECTION("one more particle, or one constraint less") {
    ConstraintSet set;
    add_water(set, s, {0, 1, 2});
    set.add(s, Distance{0.1}, {3, 4});
    CHECK(kinds_of_two(set, s) == 2);
    set.add(s, Distance{0.1}, {3, 5});
    CHECK(kinds_of_two(set, s) == 2);
    set.add(s, Distance{0.1633}, {4, 5});
    CHECK(kinds_of_two(set, s) == 1);
  }
}

TEST_CASE("mixed molecules stand together by kind, which are numbered by the first of each",
          "[constraints][partition]") {
  // dumbbell, water, free, dumbbell, bar of three, water
  const auto s = particles_of({2, 2, 16, 1, 1, 5, 2, 2, 3, 4, 3, 16, 1, 1});
  ConstraintSet set;
  add_water(set, s, {11, 12, 13});
  set.add(s, Distance{2}, {6, 7});
  add_rigid_bar(set, s, {8, 9, 10});
  add_water(set, s, {2, 3, 4});
  set.add(s, Distance{2}, {0, 1});
  const Partition parts(set, s.masses());
  REQUIRE(parts.components() == 5);
  REQUIRE(parts.kinds() == 3);
  CHECK(listed(parts.components_of(0)) == Indices{0, 2});
  CHECK(listed(parts.components_of(1)) == Indices{1, 4});
  CHECK(listed(parts.components_of(2)) == Indices{3});
  CHECK(parts.kind(4) == 1);
  CHECK(parts.equations(2) == 4);
  CHECK(listed(parts.places(2)) == Indices{0, 2, 0, 1, 2});
  // Of the bar its three equations come after those of all nine distances.
  REQUIRE(parts.constraints(3).size() == 2);
  CHECK(parts.constraints(3)[0] == Partition::Member{0, 4, 4});
  CHECK(parts.constraints(3)[1] == Partition::Member{1, 0, 9});
}

TEST_CASE("the order in which constraints are added changes their numbers and nothing else",
          "[constraints][partition]") {
  const auto s = particles_of({16, 1, 1, 16, 1, 1, 2, 2, 16, 1, 1});
  struct Bond {
    double length;
    std::array<Index, 2> ends;
  };
  std::vector<Bond> bonds = {{3, {6, 7}}};
  for (const Index w : {0, 3, 8}) {
    const double length = w == 8 ? 0.2 : 0.1;
    bonds.push_back({length, {w, w + 1}});
    bonds.push_back({length, {w, w + 2}});
    bonds.push_back({0.15, {w + 1, w + 2}});
  }
  const auto partition_of = [&] {
    ConstraintSet set;
    for (const Bond& bond : bonds) set.add(s, Distance{bond.length}, bond.ends);
    Told all = told(Partition(set, s.masses()));
    for (auto& constraints : all.constraints) {
      for (Partition::Member& member : constraints) {
        const Bond& bond = bonds[static_cast<std::size_t>(member.constraint)];
        member = {0, bond.ends[0] * 100 + bond.ends[1], 0};  // what is at that number
      }
    }
    return all;
  };
  const Told first = partition_of();
  CHECK(first.kind == Indices{0, 0, 1, 2});
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(bonds.begin(), bonds.end(), random);
    REQUIRE(partition_of() == first);
  }
}

TEST_CASE("single particles: a fixed one, some on equal surfaces, some on the same two", "[constraints][partition]") {
  const auto s = particles_of(std::vector<double>(6, 1));
  ConstraintSet set;
  set.add(s, OnSphere{.radius = 2}, {0}).add(s, OnSphere{.radius = 2}, {1}).add(s, OnSphere{.radius = 3}, {2});
  set.add(s, Fixed{}, {3});
  const OnPlane across_x{.point = std::array{1.0, 0.0, 0.0}, .normal = {1, 0, 0}};
  const OnPlane across_y{.point = std::array{0.0, 2.0, 0.0}, .normal = {0, 1, 0}};
  set.add(s, across_x, {4}).add(s, across_y, {4}).add(s, across_y, {5}).add(s, across_x, {5});
  const Partition parts(set, s.masses());
  REQUIRE(parts.components() == 6);
  CHECK(told(parts).kind == Indices{0, 0, 1, 2, 3, 3});
  CHECK(parts.equations(2) == 3);
  CHECK(listed(parts.places(3)) == Indices{0, 0});
  // The planes of both stand in one order.
  CHECK(parts.constraints(5)[0].constraint == 3 - parts.constraints(4)[0].constraint);
}

TEST_CASE("zeros of two signs are two parameters", "[constraints][partition]") {
  const auto s = particles_of({1, 1});
  ConstraintSet set;
  set.add(s, OnSphere{.center = {0.0, 0, 0}, .radius = 1}, {0})
      .add(s, OnSphere{.center = {-0.0, 0, 0}, .radius = 1}, {1});
  CHECK(kinds_of_two(set, s) == 2);
}

/// z = a x^2, of which nobody can tell the a.
struct Silent {
  double a = 1;
  static constexpr std::size_t particles = 1;
  static std::string name() { return "silent"; }
  template <class Real> Real value(const Points<Real, 1>& x) const { return x[0][2] - Real(a) * x[0][0] * x[0][0]; }
};

/// The same, of which one of two numbers is told.
struct HalfSilent {
  double a = 1, b = 0;
  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<HalfSilent>("half_silent", "tells one of its parameters", field<&HalfSilent::a>("a", "1"));
  }
  template <class Real> Real value(const Points<Real, 1>& x) const { return x[0][2] - Real(a) * x[0][0] - Real(b); }
};

/// With room for a number that nobody tells.
struct WithRoom {
  double a = 1;
  bool upwards = true;
  static constexpr std::size_t particles = 1;
  static constexpr auto describe() {
    return part<WithRoom>("with_room", "may have another parameter", field<&WithRoom::a>("a", "1"),
                          field<&WithRoom::upwards>("upwards", "1"));
  }
  template <class Real> Real value(const Points<Real, 1>& x) const { return x[0][2] - Real(upwards ? a : -a); }
};

/// Without any.
struct OnFloor {
  static constexpr std::size_t particles = 1;
  static std::string name() { return "on_floor"; }
  template <class Real> Real value(const Points<Real, 1>& x) const { return x[0][2]; }
};

TEST_CASE("a constraint that does not tell all of its parameters is equal to no other", "[constraints][partition]") {
  const auto s = particles_of({1, 1});
  ConstraintSet silent, half, room, none;
  silent.add(s, Silent{}, {0}).add(s, Silent{}, {1});
  half.add(s, HalfSilent{}, {0}).add(s, HalfSilent{}, {1});
  room.add(s, WithRoom{}, {0}).add(s, WithRoom{}, {1});
  none.add(s, OnFloor{}, {0}).add(s, OnFloor{}, {1});
  CHECK(kinds_of_two(silent, s) == 2);
  CHECK(kinds_of_two(half, s) == 2);
  CHECK(kinds_of_two(room, s) == 2);
  CHECK(kinds_of_two(none, s) == 1);
}

TEST_CASE("masses in 113 bits part kinds too; a constraint beyond the particles is named", "[constraints][partition]") {
  const auto s = particles_of({2, 1, 2, 1});
  ConstraintSet set;
  set.add(s, Distance{1}, {0, 1}).add(s, Distance{1}, {2, 3});
  auto exact = s.as<Quad>();
  CHECK(Partition(set, exact.masses()).kinds() == 1);
  exact.masses()[3] += std::numeric_limits<Quad>::epsilon();
  CHECK(Partition(set, exact.masses()).kinds() == 2);
  CHECK(refusal_of([&] {
          Partition(set, particles_of({2, 1, 2}).masses());
        }) == "distance ties particle 3, but there are 3");
}

}  // namespace
}  // namespace noether
