/// Periodic boxes: the grid of positions, wrapping, images.

#include "engine/box.hpp"

#include "engine/particle_system.hpp"
#include "engine/saved_state.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace noether {
namespace {

const Vec3<double> edges(10, 7.3, 1e-3);

ParticleSystem<double> gas(Index n, double speed) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  ParticleSystem<double> s;
  s.set_box(Box::periodic(edges));
  for (Index i = 0; i < n; ++i) {
    Vec3<double> x, v;
    for (int k = 0; k < 3; ++k) {
      x[k] = 3 * edges[k] * uniform(random);
      v[k] = speed * edges[k] * uniform(random);
    }
    s.add("", 1, x, v);
  }
  return s;
}

bool in_box_on_grid(const ParticleSystem<double>& s) {
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i];
    for (int k = 0; k < 3; ++k) {
      const double units = x[k] / s.box().spacing(k);
      if (!(x[k] >= 0 && x[k] < edges[k] && units == std::floor(units))) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("the grid of a box is one unit in the last place of its edge", "[box]") {
  const Box box = Box::periodic(edges);
  CHECK(box.is_periodic());
  CHECK(box.volume() == edges[0] * edges[1] * edges[2]);
  for (int k = 0; k < 3; ++k) {
    CHECK(box.spacing(k) == std::nextafter(edges[k], 1e9) - edges[k]);
  }
  CHECK_FALSE(Box::open().is_periodic());
}

TEST_CASE("an edge that is no length is refused", "[box]") {
  CHECK_THROWS_WITH(Box::periodic({1, -2, 3}), "an edge of the box is -2; a length above 0 is expected");
  CHECK_THROWS_WITH(Box::periodic({1, 0, 3}), "an edge of the box is 0; a length above 0 is expected");
  CHECK_THROWS(Box::periodic({1, std::numeric_limits<double>::infinity(), 3}));
  CHECK_THROWS(Box::periodic({std::nan(""), 1, 3}));
}

TEST_CASE("the shortest image is exact for positions in the box", "[box]") {
  const auto s = gas(200, 0);
  const Box& box = s.box();
  for (Index i = 1; i < s.size(); ++i) {
    const Vec3<double> d = s.positions()[i] - s.positions()[0];
    const Vec3<double> near = box.minimum_image(d), back = box.minimum_image(Vec3<double>(-d));
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(near[k]) <= edges[k] / 2);
      CHECK((near[k] == d[k] || near[k] == d[k] - edges[k] || near[k] == d[k] + edges[k]));
      CHECK((near[k] == -back[k] || std::abs(near[k]) == edges[k] / 2));
      const Quad exact = Quad(d[k]) - Quad(edges[k]) * round((Quad(d[k]) - Quad(near[k])) / Quad(edges[k]));
      CHECK(Quad(near[k]) == exact);
    }
  }
}

TEST_CASE("particles start inside the box, and their images tell where they came from", "[box]") {
  const auto s = gas(200, 0);
  CHECK(in_box_on_grid(s));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double given = 3 * edges[k] * uniform(random);
      CHECK(std::abs(s.unwrapped(i)[k] - given) <= 2 * s.box().spacing(k));
      static_cast<void>(uniform(random));  // the velocity
    }
  }
}

TEST_CASE("coordinates are brought in together as each alone, to the bit", "[box][lanes]") {
  std::mt19937_64 random(11);
  for (const double edge : {10.0, 7.3, 1e-3, 4.0, std::nextafter(8.0, 0.0)}) {
    const Box box = Box::periodic({edge, edge, edge});
    std::uniform_real_distribution<double> inside(0, edge), around(-3 * edge, 3 * edge);
    std::vector<double> given = {
        0,     -0.0,         edge,    std::nextafter(edge, 0.0),        -0.4 * box.spacing(0), 0.5 * box.spacing(0),
        1e300, std::nan(""), -1e-300, 0.5 * edge + 0.5 * box.spacing(0)};
    for (int k = 0; k < 200; ++k) given.push_back(k % 31 == 5 ? around(random) : inside(random));
    for (const SimdLevel level : test::all_levels()) {
      const test::AtLevel at(level);
      std::vector<double> x = given;
      std::vector<std::int32_t> images(given.size(), 7);
      box.bring_in(0, x.data(), images.data(), static_cast<Index>(x.size()));
      for (std::size_t i = 0; i < given.size(); ++i) {
        double alone = box.on_grid(0, given[i]);
        std::int32_t image = 7;
        box.wrap(0, alone, image);
        INFO("edge " << edge << ", " << given[i]);
        CHECK((x[i] == alone || (std::isnan(x[i]) && std::isnan(alone))));
        CHECK((images[i] == image && !(x[i] == 0 && std::signbit(x[i]))));
      }
    }
  }
}

TEST_CASE("a drift and its way back end in the same place, bit for bit, however fast it is", "[box]") {
  const double speed = GENERATE(0.01, 0.3, 1.0, 20.0);
  auto s = gas(300, speed);
  const auto start = s;
  for (int n = 0; n < 50; ++n) s.advance_positions(0.37);
  CHECK(in_box_on_grid(s));
  CHECK(s.positions().all() != start.positions().all());
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> far = start.unwrapped(i) + 50 * 0.37 * Vec3<double>(s.velocities()[i]);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(s.unwrapped(i)[k] - far[k]) <= 1e-13 * edges[k] * (1 + 20 * speed));
  }
  for (int n = 0; n < 50; ++n) s.advance_positions(-0.37);
  CHECK(s.positions().all() == start.positions().all());
  CHECK(s.images().all() == start.images().all());
}

TEST_CASE("where the box is cut does not change how far a particle moves", "[box]") {
  const Box box = Box::periodic(Vec3<double>::Constant(10));
  for (const double x : {0.0, 3.25, 9.999}) {
    ParticleSystem<double> s;
    s.set_box(box);
    s.add("a", 1, {x, 0, 0}, {0.123456789, 0, 0});
    const double from = s.positions()[0][0];
    for (int n = 0; n < 100; ++n) s.advance_positions(0.777);
    const double moved = s.images().component(0)[0] * 10.0 + (s.positions()[0][0] - from);
    CHECK(moved == 100 * box.on_grid(0, 0.777 * 0.123456789));
  }
}

TEST_CASE("a position out of all bounds becomes no number", "[box]") {
  ParticleSystem<double> s;
  s.set_box(Box::periodic(Vec3<double>::Ones()));
  s.add("a", 1, {0, 0, 0}, {1e30, 1, 1});
  s.advance_positions(1);
  CHECK(std::isnan(s.positions()[0][0]));
  CHECK(s.positions()[0][1] == 0);
}

TEST_CASE("box and images survive a checkpoint, a copy and another number type", "[box]") {
  auto s = gas(20, 0.4);
  s.advance_positions(2);
  const auto back = load_particles<double>(save_particles(s));
  ParticleSystem<double> copy;
  copy.assign_state(s);
  const auto wide = s.as<Quad>();
  CHECK(back.box() == s.box());
  CHECK(back.positions().all() == s.positions().all());
  CHECK(back.images().all() == s.images().all());
  CHECK(copy.images().all() == s.images().all());
  CHECK(wide.box() == s.box());
  CHECK(wide.images().all() == s.images().all());
  for (Index i = 0; i < s.size(); ++i) CHECK(static_cast<double>(wide.positions()[i][1]) == s.positions()[i][1]);
}

}  // namespace noether
