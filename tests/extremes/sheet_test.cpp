/// Patches of hard spheres that are thin and thick, of sizes over a factor 100, elastic and without any rebound, and in
/// boxes as small as they may be. The oracles are conservation laws: momentum turns as that of one free particle, in
/// open space the energy in the turning frame and what contacts have cost make a constant, in a box the balance (5) of
/// docs/theory/shearing_sheet.md holds, and no two spheres overlap by a search through all pairs and images.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/shearing_sheet.hpp"
#include "monitors/ring_monitors.hpp"
#include "scene/ring_patch.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/contacts_by_pairs.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/ring_spheres.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace noether::test {

namespace {

ParticleSystem<double> patch_of_depth(double depth) {
  if (depth < 0.1)
    return RingPatch{.size = {100, 100, 40}, .Omega = 1, .smallest = 0.5, .density = 1, .optical_depth = depth}.build();
  return RingPatch{.size = {6, 5, 60}, .Omega = 1, .smallest = 0.5, .density = 1, .optical_depth = depth}.build();
}

/// Radii from 0.05 to 5, masses over a factor of a million.
ParticleSystem<double> patch_of_sizes() {
  return RingPatch{.size = {50, 40, 80},
                   .Omega = 1,
                   .smallest = 0.05,
                   .largest = 5,
                   .exponent = 1,
                   .density = 1,
                   .particles = 160,
                   .seed = 3}
      .build();
}

/// sum m (u^2 + z^2)/2 about the shear of a sheet of Omega = 1.
double energy_about_shear(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> v = s.velocities()[i], x = s.unwrapped(i);
    const double w = v[1] + 1.5 * x[0];
    sum += s.masses()[i] / 2 * (v[0] * v[0] + w * w + v[2] * v[2] + x[2] * x[2]);
  }
  return sum;
}

/// What the terms of the energy in the turning frame add up to without their signs: what rounding is measured by.
double size_of_energy(const ParticleSystem<double>& s) {
  double sum = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> v = s.velocities()[i], x = s.unwrapped(i);
    sum += s.masses()[i] / 2 * (v.squaredNorm() + 3 * x[0] * x[0] + x[2] * x[2]);
  }
  return sum;
}

struct Ended {
  ParticleSystem<double> particles;
  double coldest = 0, hottest = 0;  ///< dispersion of velocities at the start and the end
};

/// A run of a patch, and what holds at the end of each.
Ended checked_run(const ParticleSystem<double>& start, const HardSpheres& law, double h, int steps) {
  const bool boxed = start.box().is_periodic();
  auto sheet = sheet_of_spheres({}, law);
  Simulation<double> sim(start, compose(sheet, schemes::verlet), h);
  const auto& dispersion = sim.every(1, VelocityDispersion(1));
  Viscosity* viscosity = boxed ? &sim.every(1, Viscosity(1)) : nullptr;
  REQUIRE(sim.run(0).ok());
  const double at_first = dispersion.value(), mass = start.masses().all().sum();
  double local = 0, before = boxed ? viscosity->local() : 0;
  for (int k = 0; k < steps; ++k) {
    const Outcome outcome = sim.run(1);
    INFO(to_text(outcome));
    REQUIRE(outcome.ok());
    if (!boxed) continue;
    local += (before + viscosity->local()) / 2 * h;
    before = viscosity->local();
  }
  Ended ended{sim.particles(), at_first, dispersion.value()};
  const auto& end = ended.particles;
  CHECK(std::isfinite(ended.hottest));
  CHECK(deepest_overlap(end, 1) <= 1e-12);
  const SheetMomentum momentum(start, 1);
  CHECK((SheetMomentum(end, 1).sum - momentum.turned(h * steps, 1)).cwiseAbs().maxCoeff() <= 1e-13 * momentum.size);

  const double heat = end.column<ContactHeat>().all().sum();
  if (law.restitution == 1) CHECK(std::abs(heat) <= 1e-12 * energy_about_shear(end));
  if (law.restitution < 1) CHECK(heat > 0);
  if (boxed) {
    // The mean of two looks stands for what particles carry between them: right to h for each contact.
    const double carried = 2.25 * mass * local, by_contacts = 1.5 * end.column<ContactTransport>().all().sum();
    const double gained = energy_about_shear(end) - energy_about_shear(start);
    CAPTURE(gained, carried, by_contacts, heat);
    CHECK(std::abs(gained + heat - carried - by_contacts) <=
          0.005 * (std::abs(carried) + std::abs(by_contacts) + heat));
  } else {
    CHECK(std::abs(sheet.energy(end).total() + heat - sheet.energy(start).total()) <= 1e-13 * size_of_energy(end));
  }
  return ended;
}

/// How many pairs of the patch of depth 1 are nearer to contact than a share of its distance, through their nearest
/// images.
int touching_pairs(const ParticleSystem<double>& s, double share) {
  int pairs = 0;
  const Vec3<double> edges = s.box().edges();
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      Vec3<double> d = s.positions()[j] - s.positions()[i];
      const double cells = std::nearbyint(d[0] / edges[0]);
      d -= Vec3<double>(cells * edges[0], -1.5 * s.time() * edges[0] * cells, 0);
      for (const int k : {1, 2}) d[k] -= edges[k] * std::nearbyint(d[k] / edges[k]);
      if (d.norm() < (1 + share) * (s.column<BodyRadius>()[i] + s.column<BodyRadius>()[j])) ++pairs;
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("patches of optical depths 0.01 to 3, elastic to without rebound, keep what they must", "[extremes]") {
  for (const double depth : {0.01, 3.0}) {
    const auto start = patch_of_depth(depth);
    double hotter = 1e300;
    for (const double restitution : {1.0, 0.5, 0.0}) {
      CAPTURE(depth, restitution);
      const bool thin = depth < 0.1;
      const Ended end = checked_run(start, {.restitution = restitution}, thin ? 0.05 : 0.02, thin ? 300 : 100);
      CHECK(total_contacts(end.particles) > (thin ? 10 : 500));
      // Elastic spheres have no state of rest in a shear, they only heat up; the more is lost the colder it stays.
      if (restitution == 1) CHECK(end.hottest > end.coldest);
      CHECK(end.hottest < hotter);
      hotter = end.hottest;
      auto open = start;
      open.set_box(Box::open());
      checked_run(open, {.restitution = restitution}, 0.05, 60);
    }
    if (depth == 3) CHECK(hotter < 2);  // a layer of spheres that stick: a few Omega r, the shear across them
  }
}

TEST_CASE("spheres that gravity presses together without rebound come to rest in aggregates", "[extremes]") {
  const double h = 0.02;
  const int steps = 100;
  const auto start = patch_of_depth(1);
  const auto end = run(sheet_of_spheres({}, {.restitution = 0}, Gravity{.G = 3}), schemes::verlet, start, h, steps);
  // Each sphere lies against two others on the average: a share of 0.01 of a radius apart, what a kick of h and the
  // slowest rebound leave. Two of 39 pairs do at random.
  CAPTURE(total_contacts(end));
  CHECK(touching_pairs(start, 0.01) < 5);
  CHECK(touching_pairs(end, 0.01) >= end.size());
  CHECK(deepest_overlap(end, 1) <= 1e-12);
  const SheetMomentum momentum(start, 1);
  CHECK((SheetMomentum(end, 1).sum - momentum.turned(h * steps, 1)).cwiseAbs().maxCoeff() <= 1e-13 * momentum.size);

  // Without a slowest rebound they would touch infinitely often, which has a name.
  const HardSpheres endless{.restitution = 0, .minimum_rebound = 1e-30};
  Simulation<double> sim(start, compose(sheet_of_spheres({}, endless, Gravity{.G = 3}), schemes::verlet), h);
  const Outcome outcome = sim.run(steps);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK(outcome.message.find("spheres pile up: they touch more than 1000 times each in one flow") != std::string::npos);
  CHECK(deepest_overlap(sim.particles(), 1) <= 1e-9);
}

TEST_CASE("spheres of sizes over a factor 100 keep what they must", "[extremes]") {
  const auto start = patch_of_sizes();
  const auto radii = start.column<BodyRadius>().all();
  REQUIRE(radii.maxCoeff() >= 90 * radii.minCoeff());
  for (const double restitution : {1.0, 0.0}) {
    CAPTURE(restitution);
    const Ended end = checked_run(start, {.restitution = restitution}, 0.02, 150);
    CHECK(total_contacts(end.particles) > 50);
    auto open = start;
    open.set_box(Box::open());
    checked_run(open, {.restitution = restitution}, 0.05, 60);
  }
}

TEST_CASE("boxes of a few radii are right, or refused with the edges that they need", "[extremes]") {
  const auto in_a_box = [](double edge) {
    return patch(
        {.count = 4, .edges = {edge, edge, edge}, .smallest = 0.5, .largest = 0.5, .thickness = 1, .speed = 1.5});
  };
  for (const double edge : {2.5, 3.0}) {
    for (const double restitution : {1.0, 0.0}) {
      CAPTURE(edge, restitution);
      const Ended end = checked_run(in_a_box(edge), {.restitution = restitution}, 0.0025, 4000);
      CHECK(total_contacts(end.particles) > 30);
    }
  }
  // Along one axis alone or along all, each step is that of a search through all images. In the shortest boxes
  // images along z are met too, which have a middle of their own.
  for (const int axis : {0, 1, 2, 3}) {
    Vec3<double> edges = Vec3<double>::Constant(axis < 3 ? 6 : 2.5);
    if (axis < 3) edges[axis] = 2.5;
    CAPTURE(edges);
    const SearchedRun run = searched_run(patch({.count = axis < 3 ? 20 : 6,
                                                .edges = edges,
                                                .smallest = 0.5,
                                                .largest = 0.5,
                                                .thickness = 2.5,
                                                .speed = 1.5}),
                                         {.restitution = 0.9}, 0.02, 400);
    CAPTURE(run.contacts, run.contacts_above);
    CHECK(run.wrong_steps == 0);
    CHECK(run.contacts > 30);
    CHECK(run.worst <= 1e-10);
    if (axis >= 2) CHECK(run.contacts_above > 5);
  }
  // From two radii, where a sphere fills the box, to just below five.
  for (const double radii : {2.0, 2.1, 3.0, 4.0, 4.999}) {
    for (const int axis : {0, 1, 2, 3}) {
      Vec3<double> edges = Vec3<double>::Constant(axis < 3 ? 6 : radii / 2);
      if (axis < 3) edges[axis] = radii / 2;
      CAPTURE(edges);
      ParticleSystem<double> small(unit_system("reduced"));
      small.set_box(Box::periodic(edges));
      small.add("", 1, {0.5, 0.5, 0}, {0, 0, 0});
      small.add_column<BodyRadius>()[0] = 0.5;
      CHECK_THROWS_WITH(
          run(sheet_of_spheres({}, {}), schemes::verlet, small, 0.1, 1),
          fmt::format("the box has an edge of {}, but a sphere of radius 0.5 could meet two images of another one in "
                      "less than 5 radii; make each edge 2.5 or more",
                      radii / 2));
    }
  }
}

}  // namespace noether::test
