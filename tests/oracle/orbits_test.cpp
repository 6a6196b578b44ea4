#include "integrators/all_schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

double distance_from(const PhasePoint<Quad>& m, Quad x, Quad y, Quad u, Quad v) {
  return distance(m, PhasePoint<Quad>{Vec3<Quad>(x, y, Quad(0)), Vec3<Quad>(u, v, Quad(0))});
}

ParticleSystem<Quad> henon_heiles(Quad x, Quad y, Quad u, Quad v) {
  ParticleSystem<Quad> s;
  s.add("star", 1, Vec3<Quad>(x, y, Quad(0)), Vec3<Quad>(u, v, Quad(0)));
  return s;
}

TEST_CASE("two orbits of Henon and Heiles end where the references end", "[oracle]") {
  const auto hamiltonian = kinetic_potential<Quad>(HenonHeilesField{});
  const auto a = henon_heiles(0.18_q, 0.18_q, 0.18_q, 0.18_q), b = henon_heiles(0.1_q, 0_q, 0_q, 0.5_q);
  const auto near_a = [](const PhasePoint<Quad>& m) {
    return distance_from(m, 0.1199368952782719296202_q, 0.2809431280773217541052_q, 0.1506484736107446417959_q,
                         0.1675336702728667023031_q);
  };
  const auto near_b = [](const PhasePoint<Quad>& m) {
    return distance_from(m, -0.0401942378760688167944_q, 0.6790169217720216421347_q, 0.03845092895185983450203_q,
                         0.04859483155300364224311_q);
  };
  // The references have 22 digits; the second orbit is chaotic and amplifies its start by some 1e4.
  CHECK(near_a(henon_heiles_flow(motion_of(a), 20)) < 1e-21);
  CHECK(near_b(henon_heiles_flow(motion_of(b), 100)) < 1e-21);
  CHECK(near_a(motion_of(run(hamiltonian, schemes::sofroniou_spaletta_10_s35, a, 0.0625, 320))) < 1e-18);
  CHECK(near_b(motion_of(run(hamiltonian, schemes::sofroniou_spaletta_10_s35, b, 0.0625, 1600))) < 1e-15);
  const auto working = kinetic_potential(HenonHeilesField{});
  const auto start = particle_in_plane(0.18, 0.18, 0.18, 0.18);
  const auto end = run(working, schemes::sofroniou_spaletta_10_s35, start, 0.125, 160);
  CHECK(near_a(motion_of(end.as<Quad>())) < 1e-14);
}

TEST_CASE("one Kepler arc of any length is the closed form of the two-body problem", "[oracle]") {
  const auto start = kepler_pair(0.6, 1.0);
  for (const double dt : {0.01, 1.0, 7.0, -20.0, 1000.0}) {
    const auto exact = kepler_motion(start.as<Quad>(), Quad(dt));
    const double ulps = 32 * (1 + std::fabs(dt));  // an ulp of mu or of the axis is an ulp of the phase per radian
    const auto end = run(wisdom_holman({}), schemes::verlet, start, dt, 1);
    INFO("dt " << dt);
    CHECK(distance(relative_motion(end.as<Quad>()), exact) < ulps * 0x1p-53);
    const auto wide = run(wisdom_holman<Quad>({}), schemes::verlet, start.as<Quad>(), dt, 1);
    CHECK(distance(relative_motion(wide), exact) < ulps * 0x1p-113);
  }
}

TEST_CASE("ten turns of an orbit of eccentricity 0.6 in double end on the closed form", "[oracle]") {
  const auto start = kepler_pair(0.6, 1.0);
  const double dt = 0x1p-4;
  const auto end = run(kinetic_potential(Gravity{}), schemes::sofroniou_spaletta_10_s35, start, dt, 1000);
  CHECK(distance(relative_motion(end.as<Quad>()), kepler_motion(start.as<Quad>(), Quad(1000) * Quad(dt))) < 1e-11);
}

TEST_CASE("the figure-eight closes after its period, and after a third of it the bodies have changed places",
          "[oracle]") {
  const double period = 6.32591398;
  const auto start = figure_eight();
  const auto hamiltonian = kinetic_potential(Gravity{});
  const auto after = [&](const Scheme& scheme, long steps, double turns) {
    return run(hamiltonian, scheme, start, turns * period / static_cast<double>(steps), steps);
  };
  CHECK(distance(after(schemes::sofroniou_spaletta_10_s35, 120, 1), start) < 2e-7);  // the start has 8 digits
  const auto third = after(schemes::sofroniou_spaletta_10_s35, 40, 1.0 / 3);
  for (Index i = 0; i < 3; ++i) {
    CHECK(distance(motion_of(third, i), motion_of(start, (i + 2) % 3)) < 2e-7);
  }
  std::vector<ErrorPoint> points;
  for (const long n : {400, 800, 1600}) {
    points.push_back({period / static_cast<double>(n), distance(after(schemes::verlet, n, 1), start)});
  }
  INFO(to_text(points));
  CHECK(std::fabs(fitted_slope(points) - 2) < 0.2);
}

constexpr double G = 2.95912208286e-4;

/// Sun and outer planets, as printed by Hairer, Lubich and Wanner.
ParticleSystem<double> outer_solar_system() {
  ParticleSystem<double> p(unit_system("solar"));
  p.add("Sun", 1.00000597682, {0, 0, 0}, {0, 0, 0});
  p.add("Jupiter", 0.000954786104043, {-3.5023653, -3.8169847, -1.5507963}, {0.00565429, -0.00412490, -0.00190589});
  p.add("Saturn", 0.000285583733151, {9.0755314, -3.0458353, -1.6483708}, {0.00168318, 0.00483525, 0.00192462});
  p.add("Uranus", 0.0000437273164546, {8.3101420, -16.2901086, -7.2521278}, {0.00354178, 0.00137102, 0.00055029});
  p.add("Neptune", 0.0000517759138449, {11.4707666, -25.7294829, -10.8169456}, {0.00288930, 0.00114527, 0.00039677});
  p.add("Pluto", 1 / 1.3e8, {-15.5387357, -25.2225594, -3.1902382}, {0.00276725, -0.00170702, -0.00136504});
  return p;
}

/// Where the bodies are after 10000 days, from tests/data/outer_solar_system.
ParticleSystem<Quad> outer_solar_system_after() {
  auto s = outer_solar_system().as<Quad>();
  std::ifstream file(NOETHER_SOURCE_DIR "/tests/data/outer_solar_system/after_10000_days.txt");
  std::string line;
  Index i = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name, number;
    words >> name;
    REQUIRE(name == s.name(i));
    for (int d = 0; d < 6; ++d) {
      REQUIRE(words >> number);
      (d < 3 ? s.positions() : s.velocities())[i][d % 3] = parse_quad(number);
    }
    ++i;
  }
  REQUIRE(i == s.size());
  return s;
}

TEST_CASE("the outer planets are where independent integrations put them after 10000 days", "[oracle][slow]") {
  const auto exact = outer_solar_system_after();
  const auto start = outer_solar_system();
  const auto error = [&](const auto& end) { return distance(end.template as<Quad>(), exact); };
  const auto jacobi = wisdom_holman({.G = G}),
             democratic = wisdom_holman({.G = G, .coordinates = Coordinates::democratic});
  CHECK(error(run(jacobi, schemes::aba_10_6_4, start, 100, 100)) < 2e-12);
  CHECK(error(run(democratic, schemes::abah_10_6_4, start, 50, 200)) < 2e-12);
  const auto gravity = kinetic_potential<Quad>(Gravity{.G = G});
  const auto at_step = [&](double dt, long n) {
    return distance(run(gravity, schemes::sofroniou_spaletta_10_s35, start.as<Quad>(), dt, n), exact);
  };
  // The reference has 28 digits: the errors go on falling with order 10 far below those of a double.
  CHECK(at_step(20, 500) < 1e-20);
  const std::vector<ErrorPoint> points = {{50, at_step(50, 200)}, {40, at_step(40, 250)}, {25, at_step(25, 400)}};
  INFO(to_text(points));
  CHECK(std::fabs(fitted_slope(points) - 10) < 0.2);
}

}  // namespace
}  // namespace noether
