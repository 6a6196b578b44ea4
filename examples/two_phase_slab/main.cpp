// A liquid slab between its vapour: surface tension and density across the box, by monitors of this program's own.
#include "engine/simulation.hpp"
#include "engine/statistics.hpp"
#include "forces/lennard_jones.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "io/digest.hpp"
#include "io/structure.hpp"
#include "io/trajectory.hpp"
#include "monitors/pressure.hpp"
#include "monitors/temperature.hpp"
#include "scene/builders.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace noether;

constexpr double melted = 50;  // time from which on there is a liquid to be averaged over

/// The tension of a flat surface across z, of which a slab has two: gamma = L_z/2 (P_zz - (P_xx + P_yy)/2).
struct SurfaceTension {
  SeriesStatistics values;

  static Request wanted() { return {.virial = true}; }
  void observe(const Snapshot<double>& now) {
    if (now.time() < melted) return;
    const ParticleSystem<double>& s = now.state();
    Mat3<double> stress = *now.virial();
    for (Index i = 0; i < s.size(); ++i) {
      stress += s.masses()[i] * s.velocities()[i] * s.velocities()[i].transpose();
    }
    const Vec3<double> p = stress.diagonal() / s.box().volume();
    values.add(now.time(), s.box().edges()[2] / 2 * (p[2] - (p[0] + p[1]) / 2));
  }
};

/// The density by distance from the middle of the slab, in shells of 1: both halves of the box count.
struct Profile {
  std::array<double, 20> counts{};
  double looks = 0, area = 0;

  void observe(const Snapshot<double>& now) {
    if (now.time() < melted) return;
    const ParticleSystem<double>& s = now.state();
    const double length = s.box().edges()[2], turn = 2 * std::numbers::pi / length;
    double sine = 0, cosine = 0;  // of the slab's place on a circle: the box has no end
    for (Index i = 0; i < s.size(); ++i) {
      sine += std::sin(turn * s.positions()[i][2]);
      cosine += std::cos(turn * s.positions()[i][2]);
    }
    const double middle = std::atan2(sine, cosine) / turn;
    for (Index i = 0; i < s.size(); ++i) {
      const double z = std::remainder(s.positions()[i][2] - middle, length);
      const auto shell = static_cast<std::size_t>(std::abs(z));
      if (shell < counts.size()) counts[shell] += 1;
    }
    looks += 1;
    area = s.box().edges()[0] * s.box().edges()[1];
  }
  double density(std::size_t shell) const { return counts[shell] / (2 * area * looks); }
};

int main() {
  ParticleSystem atoms = io::read_structure(
      "slab.xyz", {.units = &unit_system("reduced"), .file_units = "lj", .types = {{.type = "A", .mass = 1}}});
  set_temperature(atoms, 0.8, 1);

  const LennardJonesForce pairs{.cutoff = 2.5, .cutoff_style = Cutoff::shifted, .epsilon = 1.0, .sigma = 1.0};
  auto bath = Langevin(KineticPotential(pairs), {.temperature = 0.8, .friction = 0.2, .seed = 1});
  Simulation sim(std::move(atoms), compose(std::move(bath), word("BAOAB")), 0.005);
  auto& temperature = sim.every(20, Temperature{});
  auto& pressure = sim.every(20, Pressure{});
  auto& tension = sim.every(20, SurfaceTension{});
  auto& profile = sim.every(20, Profile{});
  sim.every(500, io::TrajectoryWriter{"run.h5"});

  const Outcome outcome = sim.run(60'000);
  fmt::print("{}: temperature {:.3f}, mean pressure {:.4f}\n", outcome, temperature.value(), pressure.mean());
  fmt::print("surface tension {:.2f} +- {:.2f}\n", tension.values.mean(), tension.values.mean_error().value_or(0));
  fmt::print("density from the middle of the slab to the middle of the vapour, in steps of 1:\n");
  for (std::size_t k = 0; k < profile.counts.size(); ++k) fmt::print(" {:.3f}", profile.density(k));
  fmt::print("\n{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
