/// Monitors of rings against numbers found otherwise: by hand, from the energy, and from what contacts have cost.

#include "monitors/ring_monitors.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/shearing_sheet.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/ring_spheres.hpp"

#include <cmath>
#include <numbers>

namespace noether {
namespace {

/// A monitor that has looked at particles of a sheet at a time.
template <class M> M seen(const ParticleSystem<double>& s, double Omega, double time, const M& asked) {
  Simulation<double> sim(s, compose(test::sheet<double>({.Omega = Omega}), schemes::verlet), 0.125, time);
  auto& monitor = sim.every(1, asked);
  REQUIRE(sim.run(0).ok());
  return monitor;
}

/// Particles on the shear with given velocities about it.
ParticleSystem<double> on_shear(double Omega, const std::vector<Vec3<double>>& x, const std::vector<Vec3<double>>& u) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic({8, 4, 16}));
  for (std::size_t k = 0; k < x.size(); ++k) s.add("", 1, x[k], {u[k][0], u[k][1] - 1.5 * Omega * x[k][0], u[k][2]});
  return s;
}

}  // namespace

TEST_CASE("the dispersion of velocities is about the shear and the mean", "[ring_monitors]") {
  // About (1, 2, 3): squares 4, 1 and 9/4 on the average. Cells further out in x have another shear.
  const auto s = on_shear(0.5, {{1, 1, 0}, {3, 2, 0}, {14, 3, 0.5}, {-7, 1, 0.5}},
                          {{3, 3, 4.5}, {-1, 1, 4.5}, {3, 1, 1.5}, {-1, 3, 1.5}});
  const auto monitor = seen(s, 0.5, 0, VelocityDispersion(0.5));
  CHECK(monitor.components()[0] == 2);
  CHECK(monitor.components()[1] == 1);
  CHECK(monitor.components()[2] == 1.5);
  CHECK(std::abs(monitor.value() - std::sqrt(4 + 1 + 2.25)) <= 1e-15);
  CHECK_THROWS_WITH(VelocityDispersion(0).check(),
                    "Omega = 0 is not a valid angular velocity of the frame; a number above 0 is expected");
}

TEST_CASE("the filling factor is the area of the middle plane in spheres", "[ring_monitors]") {
  auto s = on_shear(1, {{1, 1, 0}, {3, 2, 0.3}, {5, 3, -0.4}, {7, 1, 0.75}}, std::vector<Vec3<double>>(4, {0, 0, 0}));
  CHECK_THROWS_WITH(
      seen(s, 1, 0, FillingFactor{}),
      Catch::Contains("monitor 'filling_factor' needs radii, which the particles of this scene do not have"));
  s.add_column<BodyRadius>().all().setConstant(0.5);
  // Circles of radii 0.5, 0.4 and 0.3, and one sphere that does not reach down.
  const double exact = std::numbers::pi * (0.25 + 0.16 + 0.09) / 32;
  CHECK(std::abs(seen(s, 1, 0, FillingFactor{}).value() - exact) <= 1e-15);
  s.set_box(Box::open());
  CHECK_THROWS_WITH(
      seen(s, 1, 0, FillingFactor{}),
      "monitor 'filling_factor' needs a periodic box, because it divides by the area; give the particles a box");
}

TEST_CASE("viscosity of particles and of gravity", "[ring_monitors]") {
  // Carried by particles: by hand.
  const auto two = on_shear(0.5, {{1, 1, 0}, {11, 2, 0}}, {{3, 3, 0}, {-1, 1, 0}});
  CHECK(std::abs(seen(two, 0.5, 0, Viscosity(0.5)).local() - 2 / (3 * 0.5 * 2) * (9 - 1)) <= 1e-15);

  // By gravity: sum dx F_y is how the potential energy changes while the images and all places slide on,
  // dU/d(3 Omega t/2) at the same (x, y + 3 Omega t x/2), of the energy that the Hamiltonian itself has.
  const double Omega = 0.75, time = 1.3, G = 2, softening = 0.05;
  auto patch = test::patch({.count = 30, .speed = 0, .Omega = Omega});
  const auto potential = [&](double t) {
    ParticleSystem<double> s(unit_system("reduced"));
    s.set_box(patch.box());
    for (Index i = 0; i < patch.size(); ++i) {
      Vec3<double> x = std::as_const(patch).positions()[i];
      x[1] -= 1.5 * Omega * (t - time) * x[0];
      s.add("", patch.masses()[i], x, {0, 0, 0});
    }
    s.clock() = Clock<double>::fixed(t, 0.1);
    auto sheet = test::sheet<double>({.Omega = Omega, .Omega_z = 0}, Gravity{.G = G, .softening = softening});
    sheet.bind(s);
    double tides = 0;
    for (Index i = 0; i < s.size(); ++i)
      tides += s.masses()[i] * HillFrame{Omega, 0}.potential(Vec3<double>(std::as_const(s).positions()[i]));
    return sheet.energy(s).potential - tides;
  };
  // So near no other image of a particle becomes the nearest one in between, where the slope would jump.
  const double h = 1e-5;
  const double slope =
      (8 * (potential(time + h) - potential(time - h)) - potential(time + 2 * h) + potential(time - 2 * h)) /
      (12 * h * 1.5 * Omega);
  const auto monitor = seen(patch, Omega, time, Viscosity(Omega, G, softening));
  const double exact = 2 / (3 * Omega * patch.masses().all().sum()) * slope;
  INFO(exact << " " << monitor.gravitational());
  CHECK(std::abs(exact) > 0.01);
  CHECK(std::abs(monitor.gravitational() - exact) <= 1e-6 * std::abs(exact));

  auto open = two;
  open.set_box(Box::open());
  CHECK_THROWS_WITH(
      seen(open, 0.5, 0, Viscosity(0.5)),
      "monitor 'viscosity' needs a periodic box, because momentum goes round in it; give the particles a box");
}

TEST_CASE("what contacts and particles transport pays for what contacts cost", "[ring_monitors]") {
  // K = sum m (v_x^2 + u_y^2 + v_z^2 + Omega_z^2 z^2)/2 gains 3 Omega/2 times what is transported, and loses the heat.
  const double Omega = 1, step = 0.005;
  auto start = test::patch({.count = 60, .edges = {12, 10, 40}, .thickness = 3, .speed = 1});
  Simulation<double> sim(start, compose(test::sheet_of_spheres({}, {.restitution = 0.5}), schemes::verlet), step);
  auto& monitor = sim.every(1, Viscosity(Omega));
  const auto energy = [&](const ParticleSystem<double>& s) {
    double sum = 0;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> v = s.velocities()[i], x = s.unwrapped(i);
      const double w = v[1] + 1.5 * Omega * x[0];
      sum += s.masses()[i] / 2 * (v[0] * v[0] + w * w + v[2] * v[2] + Omega * Omega * x[2] * x[2]);
    }
    return sum;
  };
  REQUIRE(sim.run(1).ok());
  const double mass = start.masses().all().sum(), at_first = energy(sim.particles());
  double local = 0, collisional = 0, before = monitor.local();
  const double heat_before = sim.particles().column<ContactHeat>().all().sum();
  for (int k = 0; k < 3000; ++k) {
    REQUIRE(sim.run(1).ok());
    local += (before + monitor.local()) / 2 * step;
    collisional += monitor.collisional() * step;
    before = monitor.local();
  }
  const auto end = sim.particles();
  const double gained = 2.25 * Omega * Omega * mass * (local + collisional),
               heat = end.column<ContactHeat>().all().sum() - heat_before;
  INFO(local << " " << collisional << " " << heat << " " << energy(end) - at_first << " contacts "
             << end.column<ContactCount>().all().sum() / 2);
  CHECK(collisional > 0);
  CHECK(heat > 10 * std::abs(energy(end)) * 0.1);
  CHECK(std::abs(gained - heat - (energy(end) - at_first)) <= 0.01 * heat);
}

TEST_CASE("wakes of known waves have their contrast and pitch", "[ring_monitors]") {
  // Sites of a lattice moved along k by a sin: waves n k of amplitude J_n(a |k|), Bessel functions, and no other.
  const Vec3<double> edges(8, 4, 16);
  constexpr int across = 48, along = 24;
  for (const double time : {0.0, 0.7}) {
    const double Omega = 0.5, slide = 1.5 * Omega * time * edges[0], turn = 2 * std::numbers::pi;
    const double ky = turn * 1 / edges[1], kx = (turn * 2 + ky * slide) / edges[0], k = std::hypot(kx, ky), a = 0.4 / k;
    ParticleSystem<double> s(unit_system("reduced"));
    s.set_box(Box::periodic(edges));
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < along; ++j) {
        const double x = edges[0] * i / across, y = edges[1] * j / along, moved = a * std::sin(kx * x + ky * y);
        Vec3<double> at(x + moved * kx / k, y + moved * ky / k, 0);
        const double cells = std::floor(at[0] / edges[0]);  // whose images have slid
        s.add("", 1, {at[0] - cells * edges[0], at[1] + cells * slide, 0}, {0, 0, 0});
      }
    }
    const double shortest = turn / (1.5 * k), n = across * along;
    // P of all waves but this one is - 1/n.
    double sum = 0, difference = 0, product = 0;
    for (int q = -20; q <= 20; ++q) {
      for (int p = -60; p <= 60; ++p) {
        const double y = turn * q / edges[1], x = (turn * p + y * slide) / edges[0], k2 = x * x + y * y;
        if ((p == 0 && q == 0) || std::sqrt(k2) > 1.5 * k) continue;
        const bool it = std::abs(std::abs(x) - kx) < 1e-9 && std::abs(std::abs(y) - ky) < 1e-9 && x * y > 0;
        const double power = (it ? std::pow(std::cyl_bessel_j(1, 0.4), 2) : 0) - 1 / n;
        sum += power;
        difference += power * (x * x - y * y) / k2;
        product += power * 2 * x * y / k2;
      }
    }
    const auto monitor = seen(s, Omega, time, Wakes(Omega, shortest));
    INFO("at time " << time);
    CHECK(std::abs(monitor.contrast() - std::sqrt(sum)) <= 1e-10);
    CHECK(std::abs(monitor.pitch() - std::atan2(product, difference) / 2) <= 1e-10);
    CHECK(std::abs(monitor.pitch() - std::atan2(ky, kx)) <= 0.1);
  }
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic(edges));
  s.add("", 1, {1, 1, 0}, {0, 0, 0});
  CHECK_THROWS_WITH(seen(s, 1, 0, Wakes(1, 0.01)),
                    Catch::Contains("shortest = 0.01 would count 1005310 waves; a length above 0.0317 is expected"));
  CHECK_THROWS_WITH(Wakes(1, 0).check(), "shortest = 0 is not the length of a wave; a length above 0 is expected");
}

}  // namespace noether
