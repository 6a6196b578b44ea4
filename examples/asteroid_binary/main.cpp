// The two halves of asteroid 1999 KW4 for a year, by their moments of inertia and by their mass points: a fast oblate
// one, and a long one that librates as it goes round. A surface of section shows how else the long one could turn.
#include "engine/bodies.hpp"
#include "engine/given_orbit.hpp"
#include "engine/simulation.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"
#include "io/body_sites.hpp"
#include "io/digest.hpp"
#include "io/trajectory.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/spin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>
#include <vector>

using namespace noether;

const double km = 1000, hour = 3600, year = 365.25 * 24 * hour, pi = std::acos(-1.0);
const double mean_motion = 2 * pi / (17.1 * hour);
const BodyState locked{.spin_period = 17.4 * hour};  // nearly as long as its orbit

/// Alpha, and Beta at its pericenter.
ParticleSystem<double> both(BodyState of_beta, double a = 2.548 * km) {
  const UnitSystem& si = unit_system("si");
  const RigidBody alpha = body_of_sites("Alpha", io::read_body_sites("alpha.csv", si));
  const RigidBody beta = body_of_sites("Beta", io::read_body_sites("beta.csv", si));
  ParticleSystem<double> rocks(si);
  add_body(rocks, alpha, {.spin_period = 2.7645 * hour});
  std::tie(of_beta.x, of_beta.v) = state_of_orbit({.a = a, .e = 0.01}, si.G * (alpha.mass + beta.mass));
  add_body(rocks, beta, of_beta);
  move_to_barycenter(rocks);
  return rocks;
}

Simulation<double> going_round(ParticleSystem<double> rocks, Figure degree, const char* method, double step) {
  ForceField<double> pull;
  pull.add(GravityOfBodies{.degree = degree});
  const AnyHamiltonian<double> turning(Rotating<AnyHamiltonian<double>>(KineticPotential{pull}));
  return {std::move(rocks), compose(turning, *schemes::find(method)), step};
}

/// How Beta looks away from Alpha, and how it turns once each orbit: where the line from Alpha crosses the first axis
/// of space, by lines between two looks.
struct Libration {
  struct Turn {
    double time, angle, rate;  ///< of the long axis from the line, modulo pi; in mean motions
  };
  double most = 0, distances = 0, looks = 0;
  std::vector<Turn> rounds;
  double y = 0;
  Turn before{};

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    const Vec3<double> line = s.positions()[1] - s.positions()[0];
    const Vec3<double> axis = rotation_matrix<double>(s.column<BodyOrientation>()[1]).col(0);
    const Turn here{now.time(), std::atan(cross<double>(line, axis)[2] / dot(line, axis)),
                    s.column<BodySpin>()[1][2] / s.column<BodyInertia>()[1][2] / mean_motion};
    if (line[0] > 0 && y < 0 && line[1] >= 0) {
      const double part = y / (y - line[1]), turned = std::remainder(here.angle - before.angle, pi);
      rounds.push_back({before.time + part * (here.time - before.time),
                        std::remainder(before.angle + part * turned, pi),
                        before.rate + part * (here.rate - before.rate)});
    }
    most = std::max(most, std::abs(here.angle));
    distances += line.norm();
    ++looks;
    y = line[1];
    before = here;
  }

  /// How long an orbit takes, and how long a libration: its angle and rate go round their means, less than once from
  /// one orbit to the next.
  std::pair<double, double> periods() const {
    if (rounds.empty()) return {0, 0};
    const double n = static_cast<double>(rounds.size());
    double angle = 0, rate = 0, librations = 0;
    for (const Turn& turn : rounds) {
      angle += turn.angle / n;
      rate += turn.rate / n;
    }
    const auto phase = [&](const Turn& turn) { return std::atan2(angle - turn.angle, turn.rate - rate) / (2 * pi); };
    for (std::size_t k = 1; k < rounds.size(); ++k) {
      const double more = phase(rounds[k - 1]) - phase(rounds[k]);
      librations += more - std::floor(more);
    }
    const double time = rounds.back().time - rounds.front().time;
    return {time / (n - 1), time / librations};
  }
};

/// How long a small libration takes by the second degree, where the orbit answers by Hill's equations: x, the square of
/// its frequency in mean motions, is k (1 - g (x + 3)/(1 - x)), k = 3 G m_A (B - A)/(C r^3 n^2), g = C/(mu r^2).
double libration_by_theory(double orbit, double r) {
  const ParticleSystem<double> s = both({});
  const Vec3<double> moments = s.column<BodyInertia>()[1];
  const double m_a = s.masses()[0], m_b = s.masses()[1], n = 2 * pi / orbit;
  const double k = 3 * s.units().G * m_a * (moments[1] - moments[0]) / (moments[2] * r * r * r * n * n);
  const double g = moments[2] / (m_a * m_b / (m_a + m_b) * r * r);
  double x = k;
  for (int round = 0; round < 50; ++round) x = k * (1 - g * (x + 3) / (1 - x));
  return orbit / std::sqrt(x);
}

/// The pull on Beta and the torque on it, leaning by 20 degrees: by how much sites differ from the second degree.
std::pair<double, double> difference_by_sites(double distance) {
  const double half = pi / 18;
  const ParticleSystem<double> s = both({.orientation = {std::cos(half), 0, 0, std::sin(half)}}, distance / 0.99);
  VectorColumn<double> pull[2] = {VectorColumn<double>(2), VectorColumn<double>(2)}, torque[2] = {pull[0], pull[0]};
  for (const int k : {0, 1}) {
    ForceSink<double> sink(pull[k], s, {});
    sink.set_torques(torque[k]);
    GravityOfBodies{.degree = k == 0 ? Figure::second_degree : Figure::sites}.add_to(sink, s);
  }
  const auto apart = [](const VectorColumn<double>* of) {
    return (of[1][1] - of[0][1]).norm() / Vec3<double>(of[0][1]).norm();
  };
  return {apart(pull), apart(torque)};
}

/// Angle and rate of Beta's turn once each orbit, from many starts: a surface of section.
void write_section(const char* file) {
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) return;
  fmt::print(out, "angle,rate,start\n");
  for (int start = 0; start < 24; ++start) {
    const Vec3<double> rate(0, 0, (0.1 + 0.1 * start) * mean_motion);
    Simulation sim = going_round(both({.angular_velocity = rate}), Figure::second_degree, "srkn6b", 0.4 * hour);
    const auto& libration = sim.every(1, Libration{});
    if (!sim.run(6400).ok()) break;  // 150 orbits
    for (const auto& [time, angle, turn] : libration.rounds) fmt::print(out, "{:.4f},{:.4f},{}\n", angle, turn, start);
  }
  std::fclose(out);
}

void tell(const char* way, const Libration& of) {
  const auto [orbit, libration] = of.periods();
  fmt::print("by {:<14} Beta looks away by at most {:.3f} degrees, goes round in {:.4f} h, librates in {:.3f} h\n", way,
             of.most * 180 / pi, orbit / hour, libration / hour);
}

/// The same year by mass points.
Libration libration_by_sites() {
  Simulation sim = going_round(both(locked), Figure::sites, "srkn14a", 0.2 * hour);
  auto& libration = sim.every(1, Libration{});
  const Outcome outcome = sim.run_until(year);
  if (!outcome.ok()) fmt::print("{}\n", outcome);
  return libration;
}

int main() {
  Simulation sim = going_round(both(locked), Figure::second_degree, "srkn14a", 0.2 * hour);
  auto& energy = sim.every(10, Energy{});
  auto& momentum = sim.every(10, AngularMomentum{});
  auto& spin = sim.every(10, Spin{"Beta"});
  auto& elements = sim.every(10, Elements{});
  auto& libration = sim.every(1, Libration{});
  sim.every(30, io::TrajectoryWriter{"run.h5"});
  const Outcome outcome = sim.run_until(year);
  fmt::print("{}: energy within {:.1e}, angular momentum within {:.1e}\n", outcome, energy.worst(),
             *momentum.report().worst);
  fmt::print("its orbit now: a = {:.4f} km, e = {:.4f}; it turns once in {:.3f} h\n", elements.of(1).a / km,
             elements.of(1).e, 2 * pi / std::abs(spin.rate()[2]) / hour);

  tell("second degree", libration);
  fmt::print("Hill's equations say that small librations take {:.3f} h\n",
             libration_by_theory(libration.periods().first, libration.distances / libration.looks) / hour);
  tell("mass points", libration_by_sites());
  for (const double distance : {2.523 * km, 5.046 * km, 10.092 * km}) {
    const auto [pull, torque] = difference_by_sites(distance);
    fmt::print("at {:6.3f} km mass points change the pull by {:.1e}, the torque by {:.1e}\n", distance / km, pull,
               torque);
  }
  write_section("section.csv");
  fmt::print("{}\n", io::digest(sim.particles()));
  return exit_code(outcome);
}
