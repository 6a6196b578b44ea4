/// The builder of a patch of a ring: as many spheres as it should have, of the radii it should, nowhere in each other.

#include "scene/ring_patch.hpp"
#include "engine/simulation.hpp"
#include "engine/sphere_columns.hpp"
#include "integrators/shearing_sheet.hpp"
#include "io/inspect.hpp"
#include "scene/run.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/ring_spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace noether {
namespace {

/// A patch without overlaps: what a run refuses otherwise, and here a search by pairs.
void check_room(const ParticleSystem<double>& s) {
  const auto& radii = s.column<BodyRadius>();
  double nearest = 2;
  for (Index i = 0; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const Vec3<double> d = s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[j]));
      nearest = std::min(nearest, d.norm() / (radii[i] + radii[j]));
    }
    CHECK(std::abs(s.unwrapped(i)[2]) + radii[i] <= s.box().edges()[2] / 2 * (1 + 1e-12));
  }
  CHECK(nearest >= 1);
  auto copy = s;
  auto sheet = test::sheet_of_spheres({}, {});
  sheet.bind(copy);
}

double mass_of(const ParticleSystem<double>& s) { return s.masses().all().sum(); }

}  // namespace

TEST_CASE("a patch of a ring has its surface density, radii and velocities", "[ring_patch]") {
  const RingPatch wanted{.size = {60, 40, 40},
                         .Omega = 0.5,
                         .smallest = 0.25,
                         .largest = 2,
                         .exponent = 3,
                         .density = 0.5,
                         .surface_density = 0.4,
                         .dispersion = 0.3,
                         .seed = 7};
  const auto s = wanted.build();
  check_room(s);
  const double biggest = 4 * std::numbers::pi / 3 * 8 * 0.5;
  CHECK(mass_of(s) >= 0.4 * 2400);
  CHECK(mass_of(s) <= 0.4 * 2400 + biggest);
  REQUIRE(s.size() > 700);
  // The share of radii below r is (1 - (r/a)^-2)/(1 - (b/a)^-2); Kolmogorov's distance stays below 1.63/sqrt(n), once
  // in a hundred seeds not. Dispersions have errors of 1/sqrt(2 n).
  std::vector<double> radii(s.column<BodyRadius>().begin(), s.column<BodyRadius>().end());
  std::sort(radii.begin(), radii.end());
  const auto n = static_cast<double>(radii.size());
  double distance = 0;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double share = (1 - std::pow(radii[k] / 0.25, -2)) / (1 - std::pow(8, -2));
    distance = std::max(distance, std::abs(share - (static_cast<double>(k) + 0.5) / n));
  }
  CHECK(distance <= 1.63 / std::sqrt(n));
  Vec3<double> momentum(0, 0, 0), squares(0, 0, 0);
  for (Index i = 0; i < s.size(); ++i) {
    Vec3<double> u = s.velocities()[i];
    u[1] += 0.75 * s.unwrapped(i)[0];
    momentum += s.masses()[i] * u;
    squares += u.cwiseProduct(u);
    const double r = s.column<BodyRadius>()[i];
    CHECK(std::abs(s.masses()[i] - 4 * std::numbers::pi / 3 * r * r * r * 0.5) <= 1e-14 * s.masses()[i]);
  }
  CHECK(momentum.cwiseAbs().maxCoeff() <= 1e-10 * mass_of(s));
  for (int k = 0; k < 3; ++k) CHECK(std::abs(std::sqrt(squares[k] / n) / 0.3 - 1) <= 4 / std::sqrt(2 * n));
}

TEST_CASE("patches are thin and thick, of spheres alike and over a factor of 100", "[ring_patch]") {
  const auto thin =
      RingPatch{.size = {100, 100, 40}, .Omega = 1, .smallest = 0.5, .density = 1, .optical_depth = 0.01}.build();
  check_room(thin);
  CHECK(thin.size() == 128);  // 0.01 100 100/(pi/4) = 127.3
  const auto thick =
      RingPatch{.size = {10, 8, 60}, .Omega = 1, .smallest = 0.5, .density = 1, .optical_depth = 3}.build();
  check_room(thick);
  CHECK(thick.size() == 306);  // 305.6
  const auto wide = RingPatch{.size = {40, 30, 60},
                              .Omega = 1,
                              .smallest = 0.05,
                              .largest = 5,
                              .exponent = 2.5,
                              .density = 1,
                              .particles = 600}
                        .build();
  check_room(wide);
  CHECK(wide.size() == 600);
  CHECK(wide.column<BodyRadius>()[0] > 20 * wide.column<BodyRadius>()[599]);
}

TEST_CASE("patches that cannot be are refused", "[ring_patch]") {
  const RingPatch good{.size = {10, 8, 20}, .Omega = 1, .smallest = 0.5, .density = 1, .optical_depth = 0.2};
  const auto refused = [](RingPatch patch, const auto& change) {
    change(patch);
    static_cast<void>(patch.build());
  };
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.optical_depth.reset(); }),
                    "none is given of surface_density, optical_depth and particles; give one of them");
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.particles = 4; }),
                    "more than one is given of surface_density, optical_depth and particles; give one of them");
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.largest = 0.25; }),
                    "largest = 0.25 is below the smallest radius, 0.5");
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.smallest = 0; }),
                    "smallest = 0 is not a valid radius; a number above 0 is expected");
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.size[1] = -8; }),
                    Catch::Contains("is not a box; three lengths above 0 are expected"));
  CHECK_THROWS_WITH(refused(good, [](RingPatch& p) { p.optical_depth = 30; }),
                    Catch::Contains("has no room for spheres of all 3056 radii without overlaps; make it larger"));
}

TEST_CASE("Omega is told once, in the Hamiltonian, and another one is refused", "[ring_patch]") {
  const auto scene = [](const std::string& of_builder, const std::string& of_monitors) {
    return "units = 'si'\n[particles]\ntype = 'ring_patch'\nsize = ['10 m', '8 m', '20 m']\nsmallest = '0.5 m'\n"
           "density = '400 kg/m^3'\noptical_depth = 0.3\n" +
           of_builder +
           "[hamiltonian]\ntype = 'shearing_sheet'\nOmega = '1.5e-4 1/s'\n[[hamiltonian.force]]\n"
           "type = 'hard_spheres'\nrestitution = 0.5\n[integrator]\nmethod = 'verlet'\nstep = '100 s'\nsteps = 20\n"
           "[[every]]\ntype = 'velocity_dispersion'\nsteps = 1\n" +
           of_monitors + "[[every]]\ntype = 'viscosity'\nsteps = 1\n" + of_monitors +
           "[[every]]\ntype = 'wakes'\nsteps = 1\nshortest = '3 m'\n" + of_monitors;
  };
  const auto series = [](const std::string& text) {
    Simulation<double> sim = assemble(read_scene(text, "scene.toml"));
    REQUIRE(sim.run(20).ok());
    std::vector<std::string> all;  // with all digits; a wave without contrast has no pitch
    sim.for_each_monitor([&](const std::string& /*name*/, const AnyMonitor<double>& monitor) {
      for (const Series& one : monitor.series()) {
        for (const double value : one.values) all.push_back(fmt::format("{}", value));
      }
    });
    return all;
  };
  // Left out, the same, and the same in other units.
  const std::string said = "Omega = '1.5e-4 1/s'\n", in_hours = "Omega = '0.54 1/hour'\n";
  const auto expected = series(scene(said, said));
  REQUIRE(expected.size() == 10);  // 4 of the dispersion and of the viscosity, 2 of the wakes
  CHECK(std::stod(expected[0]) > 0);
  CHECK(series(scene("", "")) == expected);
  CHECK(series(scene("", in_hours)).size() == 10);
  // The scene as it is stored says it once.
  const std::string stored = read_scene(scene("", ""), "scene.toml").effective_toml;
  CHECK(stored.find("Omega") == stored.rfind("Omega"));
  CHECK(series(stored)[0] == expected[0]);

  const auto refusal = [&](const std::string& of_builder, const std::string& of_monitors) {
    return test::refusal_of([&] { read_scene(scene(of_builder, of_monitors), "scene.toml"); });
  };
  const std::string other = "Omega = '1.5e-3 1/s'\n";
  CHECK(refusal(other, "") ==
        "Omega = \"1.5e-3 1/s\" differs from the Omega = \"1.5e-4 1/s\" in line 11 of the sheet; give it "
        "once, in [hamiltonian]");
  CHECK(refusal("", other) ==
        "Omega = \"1.5e-3 1/s\" differs from the Omega = \"1.5e-4 1/s\" in line 10 of the sheet; give it "
        "once, in [hamiltonian]");
  CHECK_THROWS_WITH(RingPatch({.size = {10, 8, 20}, .smallest = 0.5, .density = 1, .optical_depth = 0.2}).build(),
                    "the angular velocity of the frame is missing; give Omega, or use the Hamiltonian "
                    "'shearing_sheet'");
}

#if NOETHER_HDF5
namespace {

/// A patch of a few spheres and its viscosity, looked at in the two steps of a run.
std::string watched_patch(const std::string& of_hamiltonian, const std::string& forces,
                          const std::string& of_monitor = "") {
  return "units = 'si'\n[particles]\ntype = 'ring_patch'\nsize = ['10 m', '8 m', '20 m']\nsmallest = '0.5 m'\n"
         "density = '400 kg/m^3'\noptical_depth = 0.3\n[hamiltonian]\ntype = 'shearing_sheet'\nOmega = '1.5e-4 "
         "1/s'\n" +
         of_hamiltonian + forces +
         "[integrator]\nmethod = 'verlet'\nstep = '100 s'\nsteps = 2\n[[every]]\ntype = 'trajectory'\nsteps = 1\n"
         "[[every]]\ntype = 'viscosity'\nsteps = 1\n" +
         of_monitor;
}

/// What a run leaves: its digest, the viscosity as run.h5 has it, and the scene in that file.
struct StoredRun {
  std::string digest, scene;
  std::map<std::string, std::vector<double>> viscosity;
  double by_gravity() const { return viscosity.at("gravitational").at(1); }
};

StoredRun stored_run(const std::string& text) {
  const test::ScratchFolder folder;
  const RunReport report =
      run(read_scene(text, folder / "scene.toml"), {.out = folder / "out", .handle_signals = false});
  REQUIRE(report.outcome.ok());
  StoredRun stored{report.digest, io::info(folder / "out" / "run.h5").scene_toml, {}};
  for (const io::MonitorSeries& one : io::read_monitors(folder / "out" / "run.h5")) {
    for (const auto& [name, values] : one.quantities) stored.viscosity[name] = values.second;
  }
  stored.viscosity.at("value").erase(stored.viscosity.at("value").begin());  // not a number: before any contact
  stored.viscosity.at("collisional").erase(stored.viscosity.at("collisional").begin());
  return stored;
}

const std::string pull = "[[hamiltonian.force]]\ntype = 'gravity'\n",
                  no_pull = "[[hamiltonian.force]]\ntype = 'hard_spheres'\nrestitution = 0.5\n",
                  constant = "G = '6.6743e-11 m^3/kg/s^2'\n";

}  // namespace

TEST_CASE("the viscosity of a patch has the part of the gravity that acts", "[ring_patch]") {
  // The figure of a monitor that is told everything is checked in tests/engine/ring_monitors_test.cpp.
  const double given = stored_run(watched_patch(constant, pull, constant)).by_gravity();
  CHECK(given != 0);
  CHECK(stored_run(watched_patch(constant, pull)).by_gravity() == given);
  CHECK(std::abs(stored_run(watched_patch("", pull)).by_gravity() / given - 1) <= 1e-9);  // G of the units

  const std::string soft = "softening = '2 m'\n";
  const double softened = stored_run(watched_patch("", pull + soft, constant + soft)).by_gravity();
  CHECK(std::abs(softened / given - 1) > 0.01);
  CHECK(std::abs(stored_run(watched_patch("", pull + soft)).by_gravity() / softened - 1) <= 1e-9);

  // A constant alone attracts nothing; one of the monitor's own says what gravity would do.
  CHECK(stored_run(watched_patch("", no_pull)).by_gravity() == 0);
  CHECK(stored_run(watched_patch(constant, no_pull)).by_gravity() == 0);
  CHECK(stored_run(watched_patch("G = '1e-11 m^3/kg/s^2'\n", no_pull)).by_gravity() == 0);
  CHECK(std::abs(stored_run(watched_patch("", no_pull, constant)).by_gravity() / given - 1) <= 0.05);
}

TEST_CASE("the scene that a file stores has the viscosity of its run", "[ring_patch]") {
  const std::string other = "G = '5e-11 m^3/kg/s^2'\n";
  for (const std::string& text :
       {watched_patch("", no_pull), watched_patch(constant, no_pull), watched_patch("", no_pull, other),
        watched_patch("", pull), watched_patch(other, pull), watched_patch("", pull + "softening = '2 m'\n")}) {
    const StoredRun first = stored_run(text), again = stored_run(first.scene);
    CAPTURE(text, first.scene);
    REQUIRE(first.viscosity.size() == 4);
    CHECK(again.digest == first.digest);
    CHECK(again.viscosity == first.viscosity);
    CHECK(again.scene == first.scene);
  }
}
#endif

}  // namespace noether
