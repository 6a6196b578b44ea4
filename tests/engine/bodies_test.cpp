/// Rigid bodies: what they are made of, where they begin, and what is refused.

#include "engine/bodies.hpp"
#include "engine/make_rigid.hpp"
#include "engine/sites.hpp"
#include "engine/topology.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

BodySite site(double mass, const Vec3<double>& place) { return {.place = place, .mass = mass}; }

std::string refusal(const auto& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.message();
  }
  return "none";
}

}  // namespace

TEST_CASE("moments follow from semi-axes and from sites", "[engine][bodies]") {
  const RigidBody rock = ellipsoid("rock", 5, {1, 2, 3});
  CHECK(rock.inertia == Vec3<double>(13, 10, 5));
  CHECK(rock.warning.empty());
  // A tilted dumbbell with a third mass: moments and axes by hand are those of the tensor.
  const std::vector<BodySite> sites = {site(1, {1, 1, 0}), site(1, {-1, -1, 0}), site(2, {0, 0, 0.5})};
  const RigidBody body = body_of_sites("body", sites);
  CHECK(body.mass == 4);
  CHECK((body.center - Vec3<double>(0, 0, 0.25)).norm() < 1e-16);
  Mat3<double> tensor = Mat3<double>::Zero();
  for (const BodySite& one : sites) {
    const Vec3<double> d = one.place - body.center;
    tensor += one.mass * (d.squaredNorm() * Mat3<double>::Identity() - d * d.transpose());
  }
  const Mat3<double> axes = rotation_matrix<double>(body.axes);
  CHECK((axes * body.inertia.asDiagonal() * axes.transpose() - tensor).cwiseAbs().maxCoeff() < 1e-14);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK((axes * body.sites[k].place + body.center - sites[k].place).norm() < 1e-15);
  }
  // Axes that are principal already stay as they are.
  const RigidBody square =
      body_of_sites("square", {site(1, {1, 0, 0}), site(1, {-1, 0, 0}), site(3, {0, 1, 0}), site(3, {0, -1, 0})});
  CHECK(square.axes == Quaternion<double>(1, 0, 0, 0));
  CHECK(square.inertia == Vec3<double>(6, 2, 8));
}

TEST_CASE("a body begins where and as it is told", "[engine][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("point", 1, {9, 0, 0}, {0, 0, 0});
  const RigidBody rock = body_of_inertia("rock", 2, {1, 2, 2.5});
  const double half = std::sqrt(0.5);
  const Quaternion<double> about_z(half, 0, 0, half);  // x of the body is y of space
  const Index a = add_body(
      s, rock,
      {.x = {1, 0, 0}, .v = {0, 1, 0}, .orientation = 3 * about_z, .angular_velocity = Vec3<double>(0.1, 0.2, 0)});
  const Index b = add_body(s, rock, {.spin_period = 2});
  CHECK(a == 1);
  CHECK(s.bodies()->kind(0) == nullptr);
  CHECK(s.bodies()->kinds.size() == 1);  // bodies of one kind share it
  CHECK((Vec3<double>(std::as_const(s).column<BodySpin>()[a]) - Vec3<double>(-0.4, 0.1, 0)).norm() < 1e-15);
  CHECK(std::abs(norm_defect<double>(std::as_const(s).column<BodyOrientation>()[a])) < 3e-16);
  CHECK((Vec3<double>(std::as_const(s).column<BodySpin>()[b]) - Vec3<double>(0, 0, 2.5 * std::acos(-1.0))).norm() <
        1e-15);
  CHECK(turning_freedoms(s) == 6);
  CHECK(std::abs(turning_energy_of(s) - (0.1 * 0.1 / 2 + 0.2 * 0.2 + 2.5 / 2 * std::pow(std::acos(-1.0), 2))) < 1e-14);
  const ParticleSystem<Quad> wide = s.as<Quad>();
  CHECK(wide.bodies() == s.bodies());
  CHECK(std::abs(static_cast<double>(turning_energy_of(wide)) - turning_energy_of(s)) < 1e-14);
  ParticleSystem<double> copy(unit_system("reduced"));
  copy.assign_state(s);
  CHECK(copy.bodies() == s.bodies());
}

TEST_CASE("orientations have any length but 0, a top any moments that its place allows", "[engine][bodies]") {
  for (const double length : {1e-300, 1e-9, 1e-3, 1., 7., 1e300}) {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, body_of_inertia("a", 1, {1, 2, 2}), {.orientation = length * Quaternion<double>(1, 2, 0, 0)});
    const Quaternion<double> q = std::as_const(s).column<BodyOrientation>()[0];
    CHECK((q - Quaternion<double>(1, 2, 0, 0) / std::sqrt(5)).norm() < 3e-16);
  }
  CHECK(top("ball", 2, {1, 1, 0.5}, {0, 0, 0.5}).warning.empty());
  CHECK(top("about its centre", 1, {1, 1, 0.5}, {0, 0, 1}).warning.find("no mass with its centre at [0, 0, 1]") == 0);
}

TEST_CASE("kinds of many bodies are collected before the particles get them", "[engine][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  Bodies bodies;
  for (int k = 0; k < 3; ++k) add_body(s, bodies, ellipsoid(std::to_string(k), 1, {1, 2, 3}), {});
  CHECK(s.bodies() == nullptr);
  s.set_bodies(std::make_shared<const Bodies>(bodies));
  CHECK(s.bodies()->kinds.size() == 1);
  CHECK(s.bodies()->kind_of == std::vector<int>{0, 0, 0});
  CHECK(BodyKind{.sites = {site(1, {1, 0, 0}), site(0, {0, 1, 0})}}.massive_sites() == 1);
}

TEST_CASE("molecules are those of bonds, or of numbers", "[engine][topology]") {
  Topology t;
  t.molecules = {3, 3, 0, 3, 0, 7};
  t.bonds = {{{4, 2}, 0}, {{5, 4}, 0}};
  CHECK(molecules_by_number(t, 6) == std::vector<Index>{0, 0, 2, 0, 4, 5});
  CHECK(molecules_by_bonds(t, 6) == std::vector<Index>{0, 1, 2, 3, 2, 2});
}

TEST_CASE("sites stand where their body does, wrapped as particles are", "[engine][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, body_of_sites("body", {site(1, {1, 0, 0}), site(1, {-1, 0, 0}), site(1, {0, 1, 0}), site(1, {0, -1, 0})}),
           {.x = {4.5, 0.5, 0}, .orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}});
  s.set_box(Box::periodic({5, 5, 5}));
  Sites<double> sites(s);
  const auto at = [&](Index k) { return Vec3<double>(sites.particles().unwrapped(k)); };
  CHECK((at(0) - Vec3<double>(4.5, 1.5, 0)).norm() < 1e-14);
  CHECK((at(2) - Vec3<double>(3.5, 0.5, 0)).norm() < 1e-14);
  CHECK((at(3) - Vec3<double>(5.5, 0.5, 0)).norm() < 1e-14);
  for (Index k = 0; k < 4; ++k) {
    const Vec3<double> x = sites.particles().positions()[k];
    CHECK((x.minCoeff() >= -2.5 && x.maxCoeff() < 5));
  }
  const Vec3<double> first = at(3);
  sites.follow(s);
  sites.follow(s);
  CHECK(at(3) == first);  // images are not counted twice
  CHECK(sites.particles().topology()->exclusions.size() == 6);
}

TEST_CASE("bodies that cannot be are refused, and odd ones told", "[engine][bodies]") {
  CHECK(refusal([] { body_of_inertia("a", 0, {1, 1, 1}); }) == "the mass of body 'a' is 0; a mass above 0 is expected");
  CHECK(refusal([] {
          body_of_inertia("a", 1, {1, -1, 1});
        }) ==
        "the moments of inertia of body 'a' are [1, -1, 1]; three above 0 are expected, or one of 0 for a body in a "
        "line");
  CHECK(refusal([] { body_of_inertia("a", 1, {0, 0, 1}); }).find("three above 0") != std::string::npos);
  CHECK(refusal([] {
          body_of_inertia("a", 1, {1, 2, 0});
        }) == "the moments of inertia of body 'a' are [1, 2, 0]; a body in a line has two that are equal");
  CHECK(refusal([] { body_of_inertia("a", 1, {2, 2, 0}); }) == "none");
  CHECK(body_of_inertia("top", 1, {2, 1, 2. / 3}).warning.find("no mass has the moments of inertia") == 0);
  CHECK(refusal([] {
          ellipsoid("a", 1, {1, 0, 1});
        }) == "the semi-axes of body 'a' are [1, 0, 1]; three lengths above 0 are expected");
  CHECK(refusal([] {
          body_of_sites("a", {site(1, {0, 0, 0})});
        }) == "body 'a' has 1 site; two or more are expected, or its moments of inertia");
  const std::vector<BodySite> line = {site(1, {0, 0, 0}), site(1, {1, 2, 3})};
  CHECK(refusal([&] { body_of_sites("a", line); }) ==
        "the sites of body 'a' are in a line, so it has only two moments of inertia; give linear = true if that is "
        "meant");
  const RigidBody rod = body_of_sites("a", line, true);
  CHECK(turning_freedoms<double>(rod.inertia) == 2);
  CHECK(std::abs(rod.inertia.maxCoeff() - 7) < 1e-14);
  CHECK(refusal([&] {
          body_of_sites("a", {site(1, {0, 0, 0}), site(1, {1, 0, 0}), site(1, {0, 1, 0})}, true);
        }) == "the sites of body 'a' are not in a line, though linear = true says so; take it out");
  ParticleSystem<double> s(unit_system("reduced"));
  const RigidBody body = body_of_inertia("a", 1, {1, 2, 2});
  CHECK(refusal([&] {
          add_body(s, body, {.orientation = {0, 0, 0, 0}});
        }).find("four numbers that are not all 0") != std::string::npos);
  CHECK(refusal([&] { add_body(s, body, {.spin = Vec3<double>(0, 0, 1), .spin_period = 2}); }).find("more than once") !=
        std::string::npos);
  CHECK(refusal([&] { add_body(s, body, {.spin_period = 0}); }).find("a time other than 0 is expected") !=
        std::string::npos);
  CHECK(s.size() == 0);
}

TEST_CASE("a line has no spin about itself", "[engine][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  const RigidBody rod = body_of_inertia("rod", 1, {0, 2, 2});
  CHECK(refusal([&] { add_body(s, rod, {.spin = Vec3<double>(1, 0, 0.1)}); }) ==
        "body 'rod' is a line, and has no spin about it; a spin across it is expected");
  const Index i = add_body(s, rod, {.spin = Vec3<double>(1e-12, 0, 1)});
  CHECK(std::as_const(s).column<BodySpin>()[i] == Vec3<double>(0, 0, 1));
}

TEST_CASE("molecules over half of their box are unfolded along bonds", "[engine][bodies]") {
  ParticleSystem<double> s(unit_system("reduced"));
  Topology chain;
  for (Index k = 0; k < 6; ++k) {
    s.add("bead", 1, {0.5 * static_cast<double>(k), k == 5 ? 0.3 : 0, 0}, {0, 0, 0});
    if (k > 0) chain.bonds.push_back({{k - 1, k}, 0});
  }
  s.set_topology(std::make_shared<const Topology>(chain));
  s.set_box(Box::periodic({4, 4, 4}));
  const ParticleSystem<double> body = make_rigid(s);
  REQUIRE(body.size() == 1);
  const auto& sites = body.bodies()->kind(0)->sites;
  CHECK(std::abs((sites[0].place - sites[5].place).norm() - std::hypot(2.5, 0.3)) < 1e-14);
  CHECK(body.masses()[0] == 6);
}

}  // namespace noether
