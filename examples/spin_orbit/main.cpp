// Mercury librates in its resonance of three turns in two orbits; Hyperion, of another shape on its orbit, tumbles.
#include "engine/bodies.hpp"
#include "engine/given_orbit.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/rotating.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/spin.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace noether;

const double pi = std::acos(-1.0);

/// Kepler arcs with spins: gravity beside that of point masses in the kicks.
AnyHamiltonian<double> planet_that_turns() {
  ForceField<double> figure;
  figure.add(GravityOfBodies{.point_masses = false});
  return AnyHamiltonian<double>(Rotating<AnyHamiltonian<double>>(WisdomHolman<double, ForceField<double>>({}, figure)));
}

/// A satellite of a mass of 1 about one of no size, on an orbit of period 2 pi, at its pericenter: its long axis at an
/// angle from the line, turning `rate` times as fast as it goes round on the average.
ParticleSystem<double> satellite(double e, double asphericity, double angle, double rate) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("planet", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  const double size2 = 1e-10, m = 1e-9;  // small beside the orbit, and light
  const auto [x, v] = state_of_orbit({.a = 1, .e = e}, 1 + m);
  const Vec3<double> moments = m * size2 * Vec3<double>(1 - asphericity, 1, 1);
  add_body(s, body_of_inertia("moon", m, moments),
           {.x = x,
            .v = v,
            .orientation = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
            .angular_velocity = Vec3<double>(0, 0, rate)});
  return s;
}

/// Angle and rate of Hyperion's turn: a row for each look.
struct Section {
  std::FILE* out;
  int start;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const Mat3<double> r = rotation_matrix<double>(s.column<BodyOrientation>()[1]);
    const double angle = std::fmod(std::atan2(r(1, 0), r(0, 0)) + 2 * pi, pi);  // the axis has no front
    fmt::print(out, "{:.5f},{:.5f},{}\n", angle, s.column<BodySpin>()[1][2] / s.column<BodyInertia>()[1][2], start);
  }
};

/// The same at each pericenter, from many starts: a surface of section.
void write_section(const char* file) {
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) return;
  fmt::print(out, "angle,rate,start\n");
  for (int start = 0; start < 15; ++start) {
    // e = 0.1, (B - A)/C = 0.264 (WisdomPealeMignard1984): the regions of 1:1, 1:2 and 3:2 have grown together.
    const double rate = 0.3 + 0.18 * start;
    Simulation sim(satellite(0.1, 0.264, 0.3, rate), compose(planet_that_turns(), *schemes::find("aba_8_6_4")),
                   2 * pi / 40);
    sim.every(40, Section{out, start});
    if (!sim.run(200 * 40).ok()) break;
  }
  std::fclose(out);
}

/// When the angle of the resonance passes 0, by lines between two looks.
struct Passages {
  Spin spin;
  double before = 0, at = 0;
  std::vector<double> times = {};

  void observe(const Snapshot<double>& now) {
    spin.observe(now);
    if (before * spin.angle() < 0) times.push_back(at + (now.time() - at) * before / (before - spin.angle()));
    before = spin.angle();
    at = now.time();
  }
  double period() const {
    if (times.size() < 2) return 0;
    return 2 * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  }
};

int main() {
  const UnitSystem& solar = unit_system("solar");
  const double km = unit_value("km", solar);
  ParticleSystem<double> s(solar);
  s.add("Sun", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  const RigidBody mercury = ellipsoid("Mercury", 1.66012e-7, {2440.53 * km, 2440 * km, 2439 * km});
  const double day = unit_value("day", solar);
  const auto [x, v] = state_of_orbit({.P = 87.969 * day, .e = 0.2056}, solar.G * (1 + mercury.mass));
  add_body(s, mercury,
           {.x = x, .v = v, .orientation = {std::cos(0.05), 0, 0, std::sin(0.05)}, .spin_period = 58.646 * day});

  Simulation sim(std::move(s), compose(planet_that_turns(), *schemes::find("aba_8_6_4")), 4 * day);
  auto& energy = sim.every(1, Energy{});
  sim.every(1, AngularMomentum{});
  Spin resonance{"Mercury"};
  resonance.resonance = {3, 2};
  auto& passages = sim.every(1, Passages{resonance});
  auto& spin = sim.every(5, std::move(resonance));
  sim.every(50, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(21920 * day);
  fmt::print("{}: energy within {:.1e}\n", outcome, energy.worst());
  fmt::print("theta - 3/2 M of Mercury now: {:.4f} rad; its obliquity {:.1e}\n", spin.angle(), spin.obliquity());
  const double e = 0.2056, year = 365.25 * day, squash = (mercury.inertia[1] - mercury.inertia[0]) / mercury.inertia[2];
  const double h = 7 * e / 2 - 123 * std::pow(e, 3) / 16 + 489 * std::pow(e, 5) / 128;
  fmt::print("it librates in {:.2f} yr; small librations take 1/sqrt(3 (B - A)/C H(e)) orbits, {:.2f} yr\n",
             passages.period() / year, 87.969 * day / std::sqrt(3 * squash * h) / year);
  write_section("section.csv");
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
