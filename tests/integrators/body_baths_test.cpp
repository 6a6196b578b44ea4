/// Heat baths over rigid bodies: temperatures of flights and of turns, the distributions of spins, energies and
/// directions, against closed forms.

#include "integrators/langevin.hpp"
#include "integrators/velocity_rescaling.hpp"
#include "monitors/temperature.hpp"
#include "monitors/turning.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/normal_bins.hpp"
#include "tests/support/rigid_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::turning;

constexpr double bath_warmth = 0.7;

/// So many bodies of one kind at rest, far from each other.
ParticleSystem<double> crowd_of(const RigidBody& body, int count) {
  ParticleSystem<double> s(unit_system("reduced"));
  Bodies bodies;
  for (int k = 0; k < count; ++k) {
    // Turned in all ways, so that body axes and axes of space are not the same.
    const double a = k;
    add_body(s, bodies, body,
             {.x = {10. * k, 0, 0}, .orientation = {std::cos(a), std::sin(a), std::cos(3 * a), std::sin(5 * a)}});
  }
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  return s;
}

/// Sites in the shape of SPC/E water, in units of its own.
RigidBody water_body() {
  return body_of_sites("water", {{.place = {0, 0, 0}, .mass = 15.9994},
                                 {.place = {0.8165, 0.5774, 0}, .mass = 1.00794},
                                 {.place = {-0.8165, 0.5774, 0}, .mass = 1.00794}});
}
RigidBody needle_body() {
  return body_of_sites("needle", {{.place = {0, 0, 0}, .mass = 2}, {.place = {0.3, 0.4, 1.2}, .mass = 1}}, true);
}

AnyHamiltonian<double> in_langevin(ForceField<double> forces, double friction, Rotor rotor = Rotor::exact) {
  return Langevin(AnyHamiltonian<double>(turning(std::move(forces), {.rotor = rotor})),
                  {.temperature = bath_warmth, .friction = friction, .seed = 11});
}

/// What a crowd has in a bath: mean kinetic energies for each degree of freedom, each in units of k T/2.
struct Warmth {
  std::array<double, 3> flight{}, turn{};
  std::array<test::NormalBins, 3> spins;
  double along_line = 0;  ///< the largest spin about a line, which has none
  long samples = 0;
};

Warmth warmth_of(const ParticleSystem<double>& start, ForceField<double> forces, double step, double friction,
                 Rotor rotor, int looks) {
  const Vec3<double> inertia = start.column<BodyInertia>()[0];
  const auto bins = [&](int k) { return test::NormalBins(inertia[k] > 0 ? inertia[k] * bath_warmth : 1); };
  Warmth found{.spins = {bins(0), bins(1), bins(2)}};
  Simulation sim(start, compose(in_langevin(std::move(forces), friction, rotor), schemes::verlet), step);
  REQUIRE(sim.run(20).ok());
  for (int look = 0; look < looks; ++look) {
    REQUIRE(sim.run(5).ok());
    const ParticleSystem<double>& s = sim.particles();
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> in_body = test::in_body_of(s, i), v = s.velocities()[i];
      for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        found.flight[at] += s.masses()[i] * v[k] * v[k] / bath_warmth;
        if (!(inertia[k] > 0)) {
          found.along_line = std::max(found.along_line, std::abs(in_body[k]));
          continue;
        }
        found.turn[at] += in_body[k] * in_body[k] / inertia[k] / bath_warmth;
        found.spins[at].add(in_body[k]);
      }
      ++found.samples;
    }
  }
  for (int k = 0; k < 3; ++k) {
    found.flight[static_cast<std::size_t>(k)] /= static_cast<double>(found.samples);
    found.turn[static_cast<std::size_t>(k)] /= static_cast<double>(found.samples);
  }
  return found;
}

/// Whether each degree of freedom has k T/2: the mean of n squares of normal deviates has the variance 2/n.
void check_equipartition(const Warmth& found, const Vec3<double>& inertia) {
  const double sigma = std::sqrt(2 / static_cast<double>(found.samples));
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k, found.flight[k], found.turn[k], sigma);
    CHECK(std::abs(found.flight[k] - 1) < 4 * sigma);
    if (!(inertia[static_cast<Index>(k)] > 0)) continue;
    CHECK(std::abs(found.turn[k] - 1) < 4 * sigma);
    CHECK(found.spins[k].chi_square() < 131.7);  // 63 degrees of freedom: above it once in a million times
  }
}

}  // namespace

TEST_CASE("each way to fly and to turn has k T/2 in a bath, spins are normal along each principal axis",
          "[integrators][body_baths]") {
  // exp(-friction times the time between looks) = e^-10: looks are independent of each other.
  for (const Rotor rotor : {Rotor::exact, Rotor::axes}) {
    for (const RigidBody& body : {water_body(), needle_body()}) {
      CAPTURE(body.name, static_cast<int>(rotor));
      const Warmth found = warmth_of(crowd_of(body, 300), {}, 0.5, 4, rotor, 20);
      check_equipartition(found, body.inertia);
      // Turns about one axis after the other carry some of it off the plane, by the order of their error.
      if (rotor == Rotor::exact) CHECK(found.along_line < 1e-14);
    }
  }
}

TEST_CASE("forces and torques leave the temperature of a bath as it is", "[integrators][body_baths]") {
  // Springs hold the centres and twist the bodies: h omega < 0.2, so that what OBABO does to velocities, nothing to
  // those of oscillators and some (h omega)^2/10 to others, is below the 1 % of the statistics.
  ForceField<double> springs = test::on_sites(HarmonicField{.k = 3});
  ParticleSystem<double> s(unit_system("reduced"));
  Bodies bodies;
  for (int k = 0; k < 300; ++k) add_body(s, bodies, water_body(), {.orientation = {1, 0.1 * k, 0.3, -0.2}});
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  check_equipartition(warmth_of(s, springs, 0.1, 20, Rotor::exact, 20), water_body().inertia);
}

TEST_CASE("tops in a bath lean as Langevin's function says, and their points stay", "[integrators][body_baths]") {
  // exp(-m g l cos/k T) over all directions: with a = m g l/k T the mean of cos is - L(a), L = coth a - 1/a, that of
  // its square 1 - 2 L/a; three degrees of freedom are left to each top.
  const Vec3<double> center(0.2, 0.3, 0.5);
  const double length = std::sqrt(norm2(center)), a = 2 * length / bath_warmth, lean = 1 / std::tanh(a) - 1 / a;
  const ParticleSystem<double> start = crowd_of(top("top", 2, {2, 1.5, 1.2}, center), 200);
  Simulation sim(start, compose(in_langevin(test::weight_on_sites(), 1), schemes::verlet), 0.1);
  auto& temperature = sim.every(100, Temperature{});
  REQUIRE(sim.run(200).ok());
  const int looks = 12;
  double sum = 0;
  for (int look = 0; look < looks; ++look) {
    REQUIRE(sim.run(100).ok());
    const ParticleSystem<double>& s = sim.particles();
    for (Index i = 0; i < s.size(); ++i) {
      sum += to_space<double>(test::matrix_of(s, i), center)[2] / length;
      CHECK(s.positions()[i] == start.positions()[i]);
      CHECK(s.velocities()[i] == Vec3<double>::Zero());
    }
  }
  CHECK(temperature.degrees_of_freedom() == 3 * 200);
  const double samples = 200. * looks, variance = 1 - 2 * lean / a - lean * lean;
  CHECK(std::abs(sum / samples + lean) < 4 * std::sqrt(variance / samples));
}

TEST_CASE("a bath that rescales draws the kinetic energy of bodies by all that fly and turn",
          "[integrators][body_baths]") {
  // Three bodies, of which one is a line: 6 + 6 + 5 degrees of freedom, less 3 of the centre of mass where momentum is
  // kept. 2 K/k T is then chi squared of f: mean f, variance 2 f.
  const auto start = [] {
    ParticleSystem<double> s(unit_system("reduced"));
    add_body(s, water_body(), {.v = {0.3, 0, 0}, .spin = Vec3<double>(1, 2, 3)});
    add_body(s, water_body(), {.v = {0, 0.2, 0}, .spin = Vec3<double>(-1, 1, 0.5)});
    add_body(s, needle_body(), {.v = {0, 0, 1}, .spin = Vec3<double>(0.8, -0.6, 0)});
    return s;
  };
  for (const bool field : {false, true}) {
    CAPTURE(field);
    const double freedom = field ? 17 : 14;
    ForceField<double> forces;
    if (field) forces = test::on_sites(HarmonicField{.k = 1e-9});
    VelocityRescaling<AnyHamiltonian<double>> bath(AnyHamiltonian<double>(turning(std::move(forces))),
                                                   {.temperature = bath_warmth, .relaxation_time = 1, .seed = 5});
    Simulation sim(start(), compose(std::move(bath), schemes::verlet), 8);  // e^-8 is left from look to look
    auto& temperature = sim.every(1, Temperature{});
    double mean = 0, square = 0;
    const int looks = 4000;
    REQUIRE(sim.run(2).ok());
    for (int look = 0; look < looks; ++look) {
      REQUIRE(sim.run(1).ok());
      const double kinetic = temperature.value() * freedom / 2;
      mean += kinetic / looks;
      square += kinetic * kinetic / looks;
    }
    CHECK(temperature.degrees_of_freedom() == static_cast<std::int64_t>(freedom));
    const double expected = freedom * bath_warmth / 2, variance = freedom * bath_warmth * bath_warmth / 2;
    CHECK(std::abs(mean - expected) < 4 * std::sqrt(variance / looks));
    // A gamma variable of shape f/2 has a fourth moment of 3 + 12/f variances.
    CHECK(std::abs((square - mean * mean) / variance - 1) < 4 * std::sqrt((2 + 12 / freedom) / looks));
  }
}

}  // namespace noether
