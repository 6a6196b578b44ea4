/// Sites of bodies in lanes: where each body alone has them, to the bit.

#include "engine/sites.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <random>

namespace noether {
namespace {

/// Runs of bodies of one, two, three and five sites, with points between them, whose lengths are no multiples of eight.
ParticleSystem<double> mixture() {
  ParticleSystem<double> s(unit_system("reduced"));
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  const auto random = [&] { return Vec3<double>(normal(generator), normal(generator), normal(generator)); };
  Bodies bodies;
  for (const int sites : {3, 1, 3, 5, 2, 3}) {
    std::vector<BodySite> of_body;
    for (int k = 0; k < sites; ++k) of_body.push_back({.place = random(), .mass = 1.0 + k});
    const RigidBody body =
        sites == 1 ? ellipsoid("e", 1, {3, 2, 1}) : body_of_sites("b", of_body, sites == 2 ? true : false);
    for (int k = 0; k < 11 * sites; ++k) {
      const Vec3<double> turn = random();
      add_body(s, bodies, body, {.x = 3 * random(), .orientation = {normal(generator), turn[0], turn[1], turn[2]}});
    }
    s.add("point", 1, random(), random());
  }
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  return s;
}

}  // namespace

TEST_CASE("sites in lanes stand where each body alone has them", "[engine][lanes][bodies]") {
  ParticleSystem<double> s = mixture();
  for (const bool periodic : {false, true}) {
    if (periodic) s.set_box(Box::periodic({4, 5, 3}));
    for (const SimdLevel level : test::all_levels()) {
      const test::AtLevel at(level);
      const Sites<double> sites(s);
      Index wrong = 0, outside = 0;
      for (Index i = 0; i < s.size(); ++i) {
        const BodyKind* kind = s.bodies()->kind(i);
        const Mat3<double> r = rotation_matrix<double>(std::as_const(s).column<BodyOrientation>()[i]);
        REQUIRE(sites.first(i + 1) - sites.first(i) == (kind == nullptr ? 1 : static_cast<Index>(kind->sites.size())));
        for (Index a = sites.first(i); a < sites.first(i + 1); ++a) {
          const Vec3<double> arm =
              kind == nullptr ? Vec3<double>(Vec3<double>::Zero())
                              : to_space<double>(r, kind->sites[static_cast<std::size_t>(a - sites.first(i))].place);
          Vec3<double> x = std::as_const(s).positions()[i] + arm;
          Vec3<std::int32_t> images = Vec3<std::int32_t>::Zero();
          if (periodic) {
            images = std::as_const(s).images()[i];
            for (int k = 0; k < 3; ++k) {
              x[k] = s.box().on_grid(k, x[k]);
              s.box().wrap(k, x[k], images[k]);
            }
            outside += images == Vec3<std::int32_t>(std::as_const(s).images()[i]) ? 0 : 1;
            wrong += images == Vec3<std::int32_t>(sites.particles().images()[a]) ? 0 : 1;
          }
          wrong += sites.arm(a) == arm && x == Vec3<double>(sites.particles().positions()[a]) ? 0 : 1;
        }
      }
      CHECK(wrong == 0);
      CHECK((outside > 20) == periodic);  // sites in other cells than their bodies
    }
  }
}

}  // namespace noether
