/// Neighbor lists against all pairs, wherever the particles are.

#include "neighbors/neighbor_list.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/liquid.hpp"

#include <random>

namespace noether {
namespace {

/// Particles at random places in a box, or around some centres in it.
ParticleSystem<double> random_particles(Index n, const Vec3<double>& edges, bool periodic, int clusters,
                                        unsigned seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  std::vector<Vec3<double>> centres;
  for (int k = 0; k < clusters; ++k) {
    centres.emplace_back(uniform() * edges[0], uniform() * edges[1], uniform() * edges[2]);
  }
  ParticleSystem<double> s;
  if (periodic) s.set_box(Box::periodic(edges));
  for (Index i = 0; i < n; ++i) {
    Vec3<double> x(uniform() * edges[0], uniform() * edges[1], uniform() * edges[2]);
    if (clusters > 0) x = centres[static_cast<std::size_t>(i % clusters)] + x / edges.maxCoeff() * 2;
    s.add("", 1, x, {uniform() - 0.5, uniform() - 0.5, uniform() - 0.5});
  }
  return s;
}

}  // namespace

TEST_CASE("no pair in range is missing or listed twice", "[neighbors]") {
  const bool periodic = GENERATE(true, false);
  const int clusters = GENERATE(0, 5);
  const Vec3<double> edges = GENERATE(
      values<Vec3<double>>({{10, 10, 10}, {40, 2, 1}, {1e4, 1e4, 1e4}, {0.7, 0.9, 30}, {3, 3, 3}, {1e-3, 5, 5}}));
  for (const Index n : {0, 1, 2, 9, 150}) {
    auto s = random_particles(n, edges, periodic, clusters, 3);
    NeighborList list(1.1, {.verify = true});
    const double images = 8 * (1 + 2.4 / edges[0]) * (1 + 2.4 / edges[1]) * (1 + 2.4 / edges[2]);
    if (periodic && images > 2000) continue;
    CHECK_NOTHROW(list.update(s));
    for (int step = 0; step < 8; ++step) {
      s.advance_positions(0.07);
      CHECK_NOTHROW(list.update(s));
    }
  }
}

TEST_CASE("particles on borders and on a lattice have all their neighbors", "[neighbors]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({4, 4, 4}));
  for (const double x : {0.0, 1.0, 2.0, 3.0, std::nextafter(4.0, 0.0)}) {
    for (const double y : {0.0, 2.0, std::nextafter(4.0, 0.0)}) s.add("", 1, {x, y, 0}, {0, 0, 0});
  }
  NeighborList list(1.0000001, {.skin = 0.3, .verify = true});
  CHECK_NOTHROW(list.update(s));
}

TEST_CASE("a particle a million box lengths away has the neighbors of its image", "[neighbors][extremes]") {
  auto s = test::liquid(2, 0.8, 1);
  const Vec3<double> far = s.positions()[0] + 1e6 * s.box().edges();
  s.add("", 1, far + Vec3<double>(0.3, 0.2, 0.1), {0, 0, 0});
  NeighborList list(1.5, {.verify = true});
  CHECK_NOTHROW(list.update(s));
}

TEST_CASE("a particle far away in open space costs the others nothing", "[neighbors][extremes]") {
  auto s = random_particles(3000, Vec3<double>::Constant(12), false, 0, 5);
  s.add("", 1, {1e9, -1e12, 3}, {0, 0, 0});
  s.add("", 1, {1e300, 0, 0}, {0, 0, 0});
  NeighborList list(1.2);
  list.update(s);
  CHECK(list.statistics().pairs < 100);
  CHECK_NOTHROW(list.verify(s));
}

TEST_CASE("a list lasts until somebody has moved by half of the skin", "[neighbors]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({8, 8, 8}));
  s.add("", 1, {7.9, 1, 1}, {1, 0, 0});
  s.add("", 1, {5, 1, 1}, {0, 0, 0});
  NeighborList list(1.0, {.skin = 0.5, .verify = true});
  list.update(s);
  CHECK(list.statistics().searches == 1);
  s.advance_positions(0.24);  // across the face of the box
  list.update(s);
  CHECK(list.statistics().searches == 1);
  s.advance_positions(0.02);
  list.update(s);
  CHECK(list.statistics().searches == 2);
}

TEST_CASE("a list of a fixed schedule is searched by it alone, and misses who has come from afar", "[neighbors]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({8, 8, 8}));
  s.add("", 1, {1, 1, 1}, {1, 0, 0});
  s.add("", 1, {4, 1, 1}, {0, 0, 0});
  NeighborList fixed(1.0, {.skin = 0.5, .renewal = 6}), safe(1.0, {.skin = 0.5});
  for (int update = 0; update < 13; ++update) {
    CAPTURE(update);
    fixed.update(s);
    safe.update(s);
    CHECK(fixed.statistics().searches == 1 + update / 6);
    CHECK_NOTHROW(safe.verify(s));
    // In range from the fifth step on; those found at the sixth stay near.
    if (update == 5) CHECK_THROWS_WITH(fixed.verify(s), Catch::Contains("0 times up to 1 from particle"));
    if (update != 5) CHECK_NOTHROW(fixed.verify(s));
    if (update < 5) s.advance_positions(0.45);
    if (update > 5) s.advance_positions(0.01);
    if (update == 5) s.advance_positions(0.01);
  }
  CHECK_THROWS_WITH((NeighborOptions{.renewal = -1}.check()), Catch::Contains("is not a valid number of steps"));
}

TEST_CASE("searches between two sorts find everybody", "[neighbors]") {
  const bool periodic = GENERATE(true, false);
  const int clusters = GENERATE(0, 7);
  const Vec3<double> edges = GENERATE(values<Vec3<double>>({{9, 9, 9}, {30, 6, 7}}));
  auto s = random_particles(400, edges, periodic, clusters, 11);
  NeighborList list(1.1, {.skin = 0.3, .verify = true});
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int step = 0; step < 120; ++step) {  // walks, across the faces of the box too
    for (Index i = 0; i < s.size(); ++i) s.velocities().set(i, {normal(random), normal(random), normal(random)});
    s.advance_positions(0.03);
    REQUIRE_NOTHROW(list.update(s));
  }
  const NeighborStatistics& known = list.statistics();
  CAPTURE(known.searches, known.sorts);
  CHECK(known.sorts > 5);
  CHECK(known.searches > 1.5 * static_cast<double>(known.sorts));
}

TEST_CASE("who leaves the box finds those that come towards him, before the next sort too", "[neighbors]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({20, 20, 20}));
  const int axis = GENERATE(0, 1, 2);
  const double side = GENERATE(-1, 1);
  Vec3<double> leaving = Vec3<double>::Constant(10), coming = leaving, velocity = Vec3<double>::Zero();
  leaving[axis] = side < 0 ? 0.001 : 19.999;
  coming[axis] = side < 0 ? 20 - 1.9 : 1.9;
  velocity[axis] = side;
  s.add("", 1, leaving, velocity);
  s.add("", 1, coming, -velocity);
  NeighborList list(1.0, {.skin = 0.3, .verify = true});
  for (int step = 0; step < 120; ++step) {
    CAPTURE(step);
    REQUIRE_NOTHROW(list.update(s));
    s.advance_positions(0.01);
  }
  CHECK(list.statistics().searches > list.statistics().sorts);
}

TEST_CASE("beams through each other miss nobody, whatever the box", "[neighbors]") {
  const Vec3<double> edges = GENERATE(values<Vec3<double>>({{14, 14, 14}, {30, 8, 9}, {3, 3.9, 1.95}}));
  auto s = random_particles(90, edges, true, 0, 21);
  for (Index i = 0; i < s.size(); ++i) {
    s.velocities().set(i, i % 2 == 0 ? Vec3<double>(1, 0.3, -0.5) : Vec3<double>(-1, -0.4, 0.6));
  }
  NeighborList list(1.1, {.skin = 0.3, .verify = true});
  for (int step = 0; step < 80; ++step) {
    REQUIRE_NOTHROW(list.update(s));
    s.advance_positions(0.04);
  }
  CHECK(list.statistics().searches > 15);
}

TEST_CASE("a particle far away in open space leaves others their neighbors", "[neighbors][extremes]") {
  const int axis = GENERATE(0, 1, 2);
  const double far = GENERATE(1e8, -1e12, 1e14, -9e299);
  ParticleSystem<double> s;
  Vec3<double> alone = Vec3<double>::Zero();
  alone[axis] = far;
  s.add("", 1, alone, {0, 0, 0});
  const auto pairs = random_particles(250, Vec3<double>::Constant(24), false, 0, 13);
  for (Index i = 0; i < pairs.size(); ++i) {
    Vec3<double> other = pairs.positions()[i];
    s.add("", 1, other, {0, 0, 0});
    other[axis] += 1.3 * (1 - 1e-7);  // just in the skin
    s.add("", 1, other, {0, 0, 0});
  }
  NeighborList list(1.0, {.skin = 0.3, .verify = true});
  CHECK_NOTHROW(list.update(s));
}

TEST_CASE("pairs at the end of the skin are listed, wherever they are and whichever way they look", "[neighbors]") {
  const bool periodic = GENERATE(true, false);
  const double edge = GENERATE(8.0, 250.0, 4e4, 3e7);
  const auto ends = random_particles(300, Vec3<double>::Constant(edge), false, 0, 17);
  ParticleSystem<double> s;
  if (periodic) s.set_box(Box::periodic(Vec3<double>::Constant(edge)));
  for (Index i = 0; i < ends.size(); ++i) {
    const Vec3<double> way = ends.velocities()[i];
    s.add("", 1, ends.positions()[i], {0, 0, 0});
    s.add("", 1, ends.positions()[i] + way * (1.3 * (1 - 1e-12) / way.norm()), {0, 0, 0});
  }
  NeighborList list(1.0, {.skin = 0.3, .verify = true});
  CHECK_NOTHROW(list.update(s));
}

TEST_CASE("a list lasts to the last bit of the skin: nobody who went half of it is missing", "[neighbors]") {
  // Two particles whose ways along a line are half of the skin each, to a few units in the last place.
  const bool periodic = GENERATE(true, false);
  const double skin = 0.3, range = 1.1;
  int lasted = 0;
  for (int ulps = -6; ulps <= 6; ++ulps) {
    for (const double start : {0.2, 4.9, 8.7}) {
      const double half = skin / 2 + ulps * (periodic ? 0x1p-49 : 0x1p-54);
      ParticleSystem<double> s;
      if (periodic) s.set_box(Box::periodic({9, 9, 9}));
      s.add("", 1, {start, 4, 4}, {half, 0, 0});
      s.add("", 1, {start + range + 2 * half, 4, 4}, {-half, 0, 0});
      NeighborList list(range, {.skin = skin, .verify = true});
      list.update(s);
      s.advance_positions(1);
      CHECK_NOTHROW(list.update(s));
      lasted += list.statistics().searches == 1 ? 1 : 0;
    }
  }
  CHECK(lasted > 10);
  CHECK(lasted < 39);
}

TEST_CASE("a box too small for its range says what to do", "[neighbors]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic({0.05, 0.05, 0.05}));
  s.add("", 1, {0, 0, 0}, {0, 0, 0});
  NeighborList list(1.0);
  CHECK_THROWS_WITH(list.update(s), Catch::Contains("repeat the cell, or take a shorter cutoff"));
}

TEST_CASE("what is no number has no neighbors and stops no search", "[neighbors][extremes]") {
  auto s = random_particles(200, Vec3<double>::Constant(6), true, 0, 9);
  s.positions().component(1)[17] = std::nan("");
  NeighborList list(1.0);
  list.update(s);
  list.update(s);
  CHECK_NOTHROW(list.verify(s));
}

TEST_CASE("what becomes no number ends the life of a list, and others keep their neighbors", "[neighbors][extremes]") {
  auto s = random_particles(200, Vec3<double>::Constant(6), true, 0, 9);
  NeighborList list(1.0, {.skin = 0.3});
  list.update(s);
  s.advance_positions(0.4);  // too far
  s.positions().component(1)[s.size() - 2] = std::nan("");
  s.velocities().set(s.size() - 1, {0, 0, 0});
  s.moved();
  list.update(s);
  CHECK(list.statistics().searches == 2);
  CHECK_NOTHROW(list.verify(s));
}

}  // namespace noether
