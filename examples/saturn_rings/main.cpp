// A patch of Saturn's A ring: spheres of ice that attract each other gather in wakes, which come apart again. How far
// apart these are and how they lean is found from what surrounds a sphere on average, by a monitor of this program.
#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/shearing_sheet.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/ring_monitors.hpp"
#include "scene/ring_patch.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

using namespace noether;

constexpr double pi = std::numbers::pi, degree = pi / 180;
constexpr double Omega = 1.394e-4;  // 125 000 km from Saturn, in the inner A ring
constexpr double orbit = 2 * pi / Omega, grown = 2 * orbit;
constexpr double edge = 180, radius = 1.67, density = 450, depth = 0.4;
constexpr double per_area = 4.0 / 3 * radius * density * depth;  // mass

/// How many spheres there are at (x, y) from a sphere, in units of the mean: over the whole box, in cells of 4 m.
struct Surroundings {
  static constexpr int cells = 45, middle = cells / 2;
  static constexpr double cell = edge / cells;
  std::array<std::array<double, cells>, cells> pairs{};
  double expected = 0;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const double slid = 1.5 * Omega * edge * now.time();
    for (Index i = 0; i < s.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        Vec3<double> d = s.positions()[i] - s.positions()[j];
        d[1] += slid * std::nearbyint(d[0] / edge);  // of the image that is nearest in x
        const long x = std::lround(std::remainder(d[0], edge) / cell),
                   y = std::lround(std::remainder(d[1], edge) / cell);
        if (std::abs(x) > middle || std::abs(y) > middle) continue;
        pairs[static_cast<std::size_t>(middle + x)][static_cast<std::size_t>(middle + y)] += 1;
        pairs[static_cast<std::size_t>(middle - x)][static_cast<std::size_t>(middle - y)] += 1;
      }
    }
    const double n = static_cast<double>(s.size());
    expected += n * (n - 1) / (cells * cells);
  }
  /// At a place, by lines between four cells.
  double at(double x, double y) const {
    const double p = x / cell + middle, q = y / cell + middle;
    const auto a = static_cast<std::size_t>(p), b = static_cast<std::size_t>(q);
    const double f = p - std::floor(p), g = q - std::floor(q);
    return ((1 - f) * ((1 - g) * pairs[a][b] + g * pairs[a][b + 1]) +
            f * ((1 - g) * pairs[a + 1][b] + g * pairs[a + 1][b + 1])) /
           expected;
  }
  /// Mean of a line 60 m long that leans by an angle and crosses y = 0 at x: crests trail, so outer parts lag.
  double along(double lean, double x) const {
    double sum = 0;
    for (int k = -30; k <= 30; ++k) sum += at(x - k * std::sin(lean), k * std::cos(lean)) / 61;
    return sum;
  }
  /// How the crests lean: the line through the middle that has most on it.
  double lean() const {
    double best = 0;
    for (int k = 1; k < 600; ++k) {
      if (along(0.1 * degree * k, 0) > along(best, 0)) best = 0.1 * degree * k;
    }
    return best;
  }
  /// How far along x the next crest is, beyond the trough.
  double next_crest(double lean) const {
    double x = 0;
    while (x < 60 && along(lean, x + 1) <= along(lean, x)) x += 1;
    while (x < 60 && along(lean, x + 1) >= along(lean, x)) x += 1;
    return x;
  }
};

/// Appends where spheres are to a file, for the picture.
struct Places {
  std::FILE* file;

  void observe(const Snapshot<double>& now) const {
    const ParticleSystem<double>& s = now.state();
    fmt::print(file, "# {:.2f} orbits\n", now.time() / orbit);
    for (Index i = 0; i < s.size(); ++i) {
      fmt::print(file, "{:.2f},{:.2f},{}\n", s.positions()[i][0], s.positions()[i][1], radius);
    }
    fmt::print(file, "\n\n");
  }
};

void write(const Surroundings& surroundings, const char* name) {
  std::FILE* file = std::fopen(name, "w");
  if (file == nullptr) return;
  for (std::size_t q = 0; q < Surroundings::cells; ++q) {
    for (std::size_t p = 0; p < Surroundings::cells; ++p) {
      const auto place = [](std::size_t k) {
        return Surroundings::cell * (static_cast<double>(k) - Surroundings::middle);
      };
      fmt::print(file, "{},{},{:.3f}\n", place(p), place(q), surroundings.pairs[p][q] / surroundings.expected);
    }
    fmt::print(file, "\n");
  }
  std::fclose(file);
}

int main() {
  const RingPatch patch{
      .size = {edge, edge, edge}, .Omega = Omega, .smallest = radius, .density = density, .optical_depth = depth};
  ParticleSystem spheres = patch.build(unit_system("si"));
  const double G = spheres.units().G, pull = G * per_area,
               hill = std::cbrt(2 * G * spheres.masses()[0] / 3) / std::pow(Omega, 2.0 / 3);
  ShearingSheet sheet(Gravity{}, {.Omega = Omega});
  sheet.add_spheres({.restitution = 0.32, .restitution_exponent = -0.234, .restitution_speed = 0.01});
  Simulation sim(std::move(spheres), compose(std::move(sheet), schemes::verlet_aba), 450);

  const Schedule later{.steps = 20, .after = grown};
  auto& dispersion = sim.every(later, VelocityDispersion(Omega));
  auto& filling = sim.every(later, FillingFactor{});
  auto& viscosity = sim.every(later, Viscosity(Omega, G));
  auto& wakes = sim.every(later, Wakes(Omega, 30));
  auto& surroundings = sim.every(later, Surroundings{});
  std::FILE* places = std::fopen("places.csv", "w");
  if (places == nullptr) return 1;
  sim.every(100, Places{places});
  sim.every(50, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(500);
  std::fclose(places);
  write(surroundings, "surroundings.csv");
  fmt::print("{}: {} spheres, velocity dispersion {:.3f} mm/s, filling factor {:.3f}, Q = {:.2f}\n", outcome,
             sim.particles().size(), dispersion.mean() * 1000, filling.mean(),
             dispersion.components()[0] * Omega / (3.36 * pull));
  const std::array<double, 3> parts = viscosity.means();
  const double lean = surroundings.lean();
  fmt::print(
      "viscosity {:.1f} cm^2/s: by motion {:.1f}, at contacts {:.1f}, by gravity {:.1f}; by Daisaka's fit {:.1f}\n",
      (parts[0] + parts[1] + parts[2]) * 1e4, parts[0] * 1e4, parts[1] * 1e4, parts[2] * 1e4,
      26 * std::pow(hill / (2 * radius), 5) * pull * pull / std::pow(Omega, 3) * 1e4);
  fmt::print(
      "about a sphere, crests lean by {:.1f} degrees, and the next one is at {:.0f} m; Toomre's wave is {:.0f} m\n",
      lean / degree, surroundings.next_crest(lean), 4 * pi * pi * pull / (Omega * Omega));
  fmt::print("density contrast at the end {:.2f}, with crests at {:.1f} degrees\n", wakes.contrast(),
             wakes.pitch() / degree);
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
