// A moonlet in a disc: the propeller that it makes of tracers, what one encounter is worth to the last digits, and how
// far passages are excited, beside the closed form for distant ones.
#include "engine/simulation.hpp"
#include "engine/sphere_columns.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/shearing_sheet.hpp"
#include "io/bodies.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/ring_monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using namespace noether;

// Units: Omega and G are 1, and so is the Hill radius (G m/(3 Omega^2))^(1/3) of the moonlet.
constexpr double moonlet_mass = 3, moonlet_radius = 0.5;

void write(const char* name, const std::string& text) { std::ofstream(name) << text; }

/// Of tracers that pass a moonlet without a size: from x = b and 40 b ahead to 40 b behind.
ParticleSystem<double> stream(const std::vector<double>& parameters) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("moonlet", moonlet_mass, {0, 0, 0}, {0, 0, 0});
  for (const double b : parameters) s.add("", 0, {b, 40 * b, 0}, {0, -1.5 * b, 0});
  return s;
}
constexpr double passage = 80 / 1.5;

Simulation<double> passing(const std::vector<double>& parameters, const char* method, double steps) {
  ShearingSheet sheet(Gravity{});
  return {stream(parameters), compose(std::move(sheet), *schemes::find(method)), passage / steps};
}

/// The path of every tracer.
struct Paths {
  std::vector<std::vector<Vec3<double>>> of;

  void observe(const Snapshot<double>& now) {
    of.resize(static_cast<std::size_t>(now.state().size()));
    for (Index i = 0; i < now.state().size(); ++i)
      of[static_cast<std::size_t>(i)].push_back(now.state().positions()[i]);
  }
};

/// Which tracers turn back, as on horseshoes, and which pass; their paths, for the picture.
void tell_encounters() {
  std::vector<double> parameters;
  for (int k = 10; k <= 100; ++k) parameters.push_back(0.04 * k);
  Simulation sim = passing(parameters, "verlet_aba", 8000);
  auto& paths = sim.every(10, Paths{});
  if (!sim.run(8000).ok()) return;
  double first_that_passes = 0, last_that_turns = 0;
  std::string drawn;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const std::vector<Vec3<double>>& path = paths.of[k + 1];
    if (path.back()[1] > 0) last_that_turns = parameters[k];
    if (path.back()[1] < 0 && first_that_passes == 0) first_that_passes = parameters[k];
    if (k % 5 != 0) continue;
    for (const Vec3<double>& x : path) {
      if (std::abs(x[1]) < 20) drawn += fmt::format("{:.3f},{:.3f}\n", x[0], x[1]);
    }
    drawn += "\n\n";
  }
  write("paths.csv", drawn);
  fmt::print("the first tracer that passes has b = {:.2f}, the last that turns back {:.2f}\n", first_that_passes,
             last_that_turns);
}

/// How far passages are excited: the amplitude E of the epicycle that a tracer has afterwards.
void tell_passages() {
  const double closed = 8.0 / 9 * (2 * std::cyl_bessel_k(0.0, 2.0 / 3) + std::cyl_bessel_k(1.0, 2.0 / 3));
  const std::vector<double> parameters = {5, 10, 20, 40};
  Simulation sim = passing(parameters, "aba_8_6_4", 4000);
  if (!sim.run(4000).ok()) return;
  const ParticleSystem<double> s = sim.particles();
  fmt::print("E b^2/(G m), where Goldreich and Tremaine have {:.4f}:", closed);
  std::vector<double> amplitudes;
  std::string drawn;
  double moved = 0;  // how far guiding centres are, in units of what Jacobi's constant says
  for (Index i = 1; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    const double w = v[1] + 1.5 * x[0], b = parameters[static_cast<std::size_t>(i - 1)];
    amplitudes.push_back(std::hypot(v[0], 2 * w));
    fmt::print(" {:.4f} at b = {},", amplitudes.back() * b * b / moonlet_mass, b);
    drawn += fmt::format("{},{:.5f}\n", b, amplitudes.back());
    moved += (x[0] + 2 * w - b) * 1.5 * b / (amplitudes.back() * amplitudes.back()) / 4;
  }
  write("passages.csv", drawn);
  fmt::print(" slope {:.3f}\n", std::log2(amplitudes[3] / amplitudes[2]));
  fmt::print("they have moved away by {:.3f} of 2 E^2/(3 b)\n", moved);
}

struct Errors {
  double position = 0, jacobi = 0;
};

/// Of the relative motion of two bodies with G (m_1 + m_2) = 1 that meet at b = 2.5, after a time of 30.
Errors errors_of_encounter(double step, const char* method) {
  const Vec3<double> exact(2.15445219053169441925, -102.32007031846431272, 0);  // by a program with 30 digits
  const double m1 = 0.25, m2 = 0.75, reduced = m1 * m2;
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("one", m1, {-1.875, -9, 0}, {0, 2.8125, 0});
  s.add("other", m2, {0.625, 3, 0}, {0, -0.9375, 0});
  ShearingSheet sheet(Gravity{});
  Simulation sim(std::move(s), compose(std::move(sheet), *schemes::find(method)), step);
  auto& energy = sim.every(1, Energy{});
  if (!sim.run(std::lround(30 / step)).ok()) return {};
  const ParticleSystem<double> end = sim.particles();
  return {(end.positions()[1] - end.positions()[0] - exact).norm(),
          energy.worst() * energy.scale().value_or(1) / reduced};
}

void tell_errors() {
  const Errors coarse = errors_of_encounter(0.02, "verlet_aba"), fine = errors_of_encounter(0.01, "verlet_aba");
  fmt::print("an encounter at b = 2.5 errs by {:.2e} with steps of 0.02, by {:.2e} with 0.01: slope {:.2f}\n",
             coarse.position, fine.position, std::log2(coarse.position / fine.position));
  fmt::print("its Jacobi energy is within {:.2e}; aba_8_6_4 errs by {:.0e}\n", coarse.jacobi,
             errors_of_encounter(0.02, "aba_8_6_4").position);
}

/// Tracers of a disc whose places at the end would be even, and the moonlet, a sphere.
ParticleSystem<double> disc() {
  ParticleSystem<double> s = io::read_bodies("disc.csv", {.units = &unit_system("reduced")});
  s.add("moonlet", moonlet_mass, {0, 0, 0}, {0, 0, 0});
  s.add_column<BodyRadius>()[s.size() - 1] = moonlet_radius;
  return s;
}

/// How many tracers there are downstream of the moonlet, on both sides, 10 to 30 from it, in units of their mean.
double share_in(const ParticleSystem<double>& s, double from, double to) {
  double count = 0;
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i] * (s.positions()[i][0] > 0 ? 1 : -1);
    if (x[0] > from && x[0] < to && x[1] < -10 && x[1] > -30) count += 1;
  }
  return count / (2 * 20 * (to - from)) / (6000 / (14.0 * 120));
}

int main() {
  ShearingSheet sheet(Gravity{});
  sheet.add_spheres({.restitution = 0.5});
  Simulation sim(disc(), compose(std::move(sheet), schemes::verlet_aba), 0.05);
  auto& dispersion = sim.every(40, VelocityDispersion(1));
  sim.every(400, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run(1600);
  const ParticleSystem<double> s = sim.particles();
  Index fallen = 0;
  for (Index i = 0; i < s.size() - 1; ++i) fallen += s.positions()[i].norm() < 1 ? 1 : 0;
  fmt::print("{}: {} tracers, {} of them in the Hill sphere; velocity dispersion {:.3f}\n", outcome, s.size() - 1,
             fallen, dispersion.value());
  fmt::print("downstream of it, of a mean of 1:");
  for (const double x : {0.0, 1.5, 3.0, 4.5})
    fmt::print(" {:.2f} at x = {} to {},", share_in(s, x, x + 1.5), x, x + 1.5);
  fmt::print(" as far as 30\n");
  std::string drawn;
  for (Index i = 0; i < s.size() - 1; ++i) {
    drawn += fmt::format("{:.3f},{:.3f}\n", s.positions()[i][0], s.positions()[i][1]);
  }
  write("disc_at_the_end.csv", drawn);
  tell_encounters();
  tell_passages();
  tell_errors();
  fmt::print("{}\n", io::digest(s));
  return exit_code(outcome);
}
