/// Charges in fields: closed forms, orders over schemes, what is bounded for long times, against 40 digits
/// (docs/theory/fields.md).

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/damped.hpp"
#include "monitors/charges.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace noether {
namespace {

using test::banana_v;
using test::banana_x;
using test::in_field;
using test::one_charge;
using test::ring_v;
using test::ring_x;
using test::trap;

const double pi = std::acos(-1.0);
const Vec3<double> trap_x(10, 0, 0), trap_v(100, 0, 100);

ParticleSystem<double> after(ParticleSystem<double> start, AnyIntegrator<double> by, double h, std::int64_t steps) {
  Simulation sim(std::move(start), std::move(by), h);
  REQUIRE(sim.run(steps).ok());
  return sim.particles();
}
double apart(const ParticleSystem<double>& s, const Vec3<double>& x, int dimensions = 3) {
  double worst = 0;
  for (int k = 0; k < dimensions; ++k) worst = std::max(worst, std::abs(s.positions()[0][k] - x[k]));
  return worst;
}
AnyIntegrator<double> ring_by(const std::string& scheme, ChargedParticlesOptions options = {}) {
  return compose(in_field(test::RingField{}, options), *schemes::find(scheme));
}

}  // namespace

TEST_CASE("Penning trap: the closed form, and Boris's errors", "[integrators][charges]") {
  const Vec3<double> exact(-2.1480882398033808477, -9.6822103837776453613, 8.69258487535745569082);
  const auto error = [&](const std::string& scheme, ChargedParticlesOptions options, double h) {
    return apart(after(one_charge(trap_x, trap_v), compose(in_field(trap, options), *schemes::find(scheme)), h,
                       std::llround(1 / h)),
                 exact);
  };
  const ChargedParticlesOptions boris{.rotation = Rotation::boris};
  CHECK(std::abs(error("verlet_aba", boris, 1.0 / 160) - 0.21112) <= 1e-4);
  CHECK(std::abs(error("verlet_aba", boris, 1.0 / 320) - 0.052586) <= 1e-5);
  CHECK(std::abs(error("verlet_aba", boris, 1.0 / 640) - 0.013133) <= 1e-5);
  CHECK(error("kahan_li_8_s17", {}, 1.0 / 160) < 1e-11);
  // Methods for q'' = f(t, q, v) take fields as forces, as they are and by their Hamiltonian.
  ForceField<double> forces;
  forces.add(InField(trap));
  const ParticleSystem<double> s =
      after(one_charge(trap_x, trap_v), classical(forces, method("gauss_8", {.adaptive = false})), 0.01, 100);
  CHECK(apart(s, exact) < 1e-12);
}

TEST_CASE("uniform fields: Boris's steps as they are, the exact helix at any step", "[integrators][charges]") {
  const UniformElectromagnetic crossed{.E = {0.05, 0, 0}, .B = {0, 0, 1}};
  const ParticleSystem<double> s = after(
      one_charge({0, 0, 0}, {0.2, 0.1, 0.3}),
      compose(in_field(crossed, {.rotation = Rotation::boris}), schemes::verlet_aba, {.compensated = true}), 0.3, 1000);
  CHECK(apart(s, {0.39185970817676212465, -15.263276232193861418, 90}) < 1e-12);
  CHECK(std::abs(s.velocities()[0][1] + 0.2918597081767621246) < 1e-13);
  // The velocity of the exact helix after one turn of h omega = 2 pi is the one it had.
  const ParticleSystem<double> turned =
      after(one_charge({0, 0, 0}, {0.2, 0.1, 0.3}), compose(in_field(crossed), schemes::verlet_aba), 2 * pi, 100);
  CHECK((Vec3<double>(turned.velocities()[0]) - Vec3<double>(0.2, 0.1, 0.3)).norm() < 1e-13);
}

TEST_CASE("the drift in a gradient", "[integrators][charges]") {
  const GradientField field{.B0 = 1, .gradient = 0.1};
  const double period = 6.29503115316200067492;
  Simulation sim(one_charge({0, 0, 0}, {0.5, 0, 0}), compose(in_field(field), *schemes::find("kahan_li_8_s17")),
                 period / 64);
  REQUIRE(sim.run(64).ok());
  CHECK(std::abs(sim.particles().positions()[0][0]) < 1e-12);
  CHECK(std::abs(std::abs(sim.particles().positions()[0][1]) / 0.07891040588748642383 - 1) <= 1e-11);
}

TEST_CASE("orders of schemes over the exact helix and over Boris's steps", "[integrators][charges]") {
  // HeEtAl2015's field; largest error of x, y and their velocities at t = 20.
  const Vec3<double> exact(-0.04766154128255657713, -1.196145211610466656979645, 0),
      speed(-0.1157153160848213522, 0.00168682408841279561, 0);
  const auto error = [&](const std::string& scheme, ChargedParticlesOptions options, double h) {
    const ParticleSystem<double> s =
        after(one_charge(ring_x, ring_v), ring_by(scheme, options), h, std::llround(20 / h));
    double worst = 0;
    for (int k = 0; k < 2; ++k) {
      worst = std::max({worst, std::abs(s.positions()[0][k] - exact[k]), std::abs(s.velocities()[0][k] - speed[k])});
    }
    return worst;
  };
  struct Row {
    std::string scheme;
    ChargedParticlesOptions options;
    double h, error, slope;
  };
  const ChargedParticlesOptions boris{.rotation = Rotation::boris};
  for (const Row& row : {Row{"verlet_aba", boris, 0.2, 0.01041, 2}, Row{"verlet_aba", {}, 0.2, 9.53e-4, 2},
                         Row{"yoshida_4", {}, 0.2, 1.064e-5, 4}, Row{"blanes_moan_s6", {}, 0.5, 1.49e-6, 4},
                         Row{"srkn6b", {}, 0.5, 1.764e-6, 4}}) {
    CAPTURE(row.scheme);
    const double first = error(row.scheme, row.options, row.h), second = error(row.scheme, row.options, row.h / 2);
    CHECK(std::abs(first / row.error - 1) <= 0.03);
    CHECK(std::abs(std::log2(first / second) - row.slope) <= 0.1);
  }
  for (const char* scheme : {"mclachlan_sb3a_m4", "mclachlan_sb3a_m5"}) {
    CHECK(std::abs(std::log2(error(scheme, {}, 0.25) / error(scheme, {}, 0.125)) - 4) <= 0.1);
  }
  // A composition of whole Boris steps has order 4; the tables print it.
  const double first = error("yoshida_4", boris, 0.2), second = error("yoshida_4", boris, 0.1);
  CHECK(std::abs(std::log2(first / second) - 4) <= 0.3);
  CHECK(ring_by("yoshida_4", boris).claims().order == 4);
}

TEST_CASE("schemes that a rotation does not carry are refused by name", "[integrators][charges]") {
  const ChargedParticlesOptions boris{.rotation = Rotation::boris};
  for (const char* name : {"srkn11b", "srkn14a", "okunbor_skeel_6_13", "mclachlan_atela_4"}) {
    CHECK_THROWS_WITH(ring_by(name), Catch::Contains("Nystroem"));
  }
  CHECK_THROWS_WITH(ring_by("blanes_moan_s6", boris), Catch::Contains("needs exact flows"));
  CHECK_THROWS_WITH(ring_by("srkn6b", boris), Catch::Contains("needs exact flows"));
  CHECK(ring_by("srkn6b").claims().order == 4);
  CHECK_FALSE(ring_by("verlet_aba").claims().symplectic);
  CHECK(ring_by("verlet_aba").claims().reversible);
  ForceField<double> forces;
  forces.add(InField(test::RingField{}));
  CHECK_THROWS_AS(KineticPotential(forces), SchemeMismatch);
  const auto options = [](ChargedParticlesOptions of) { of.check(); };
  CHECK_THROWS_WITH(options({.cycles = 3}), Catch::Contains("hyper_boris"));
  CHECK_THROWS_WITH(options({.rotation = Rotation::hyper_boris, .gyrophase_order = 3}), Catch::Contains("even number"));
  CHECK_THROWS_WITH(options({.c = 1.0}), Catch::Contains("relativistic"));
  CHECK_THROWS_WITH(options({.rotation = Rotation::boris, .relativistic = Relativistic::vay}), Catch::Contains("slow"));
}

TEST_CASE("energies in a ring field are bounded for 20 000 steps by Boris, and not by rk4", "[integrators][charges]") {
  const double h = pi / 10;
  const auto worst = [&](AnyIntegrator<double> by, double step) {
    std::array<double, 2> tenths{};
    const auto steps = static_cast<std::int64_t>(std::llround(20'000 * h / step));
    Simulation sim(one_charge(ring_x, ring_v), std::move(by), step);
    auto& energy = sim.every(1, Energy{});
    for (std::int64_t k = 1; k <= steps; ++k) {
      REQUIRE(sim.run(1).ok());
      const MonitorReport report = energy.report();
      const double error = std::abs(*report.last / *report.first - 1);
      if (10 * k <= steps) tenths[0] = std::max(tenths[0], error);
      if (10 * k > 9 * steps) tenths[1] = std::max(tenths[1], error);
    }
    return tenths;
  };
  const auto boris = worst(ring_by("verlet_aba", {.rotation = Rotation::boris}), h);
  CHECK(std::abs(boris[0] / 2.3418e-4 - 1) <= 0.02);
  CHECK(std::abs(boris[1] / 2.3418e-4 - 1) <= 0.02);
  ForceField<double> forces;
  forces.add(InField(test::RingField{}));
  const auto rk4 = worst(classical(forces, method("rk4")), h);
  CHECK(std::abs(rk4[0] / 0.0197 - 1) <= 0.02);
  CHECK(std::abs(rk4[1] / 0.157 - 1) <= 0.02);
}

TEST_CASE("a tokamak banana: energy to rounding, canonical momentum bounded, where it turns",
          "[integrators][charges]") {
  // 3000 steps of pi/10: mu swings at the particle, and ten times less at the gyrocentre.
  const ChargeMotion motion{.fields = {AnyForce<double>(InField(Tokamak{}))}, .c = {}};
  CanonicalMomentum around;
  around.watch(motion);
  MagneticMoment at_center, at_particle;
  at_particle.at = MomentPlace::particle;
  at_center.watch(motion);
  at_particle.watch(motion);
  Simulation sim(one_charge(banana_x, banana_v),
                 compose(in_field(Tokamak{}, {.rotation = Rotation::boris}), schemes::verlet_aba), pi / 10);
  auto& p = sim.every(10, around);
  auto& center = sim.every(1, at_center);
  auto& particle = sim.every(1, at_particle);
  auto& energy = sim.every(10, Energy{});
  REQUIRE(sim.run(3000).ok());
  CHECK(std::abs(particle.swing() / 4.45e-3 - 1) <= 0.05);
  CHECK(std::abs(center.swing() / 3.57e-4 - 1) <= 0.05);
  CHECK(energy.worst() < 3e-14);
  CHECK(p.worst() * *p.scale() < 1.6e-9);
  // To t = 100 against 40 digits.
  ForceField<double> forces;
  forces.add(InField(Tokamak{}));
  const ParticleSystem<double> s =
      after(one_charge(banana_x, banana_v), classical(forces, method("gauss_8", {.adaptive = false})), 0.5, 200);
  CHECK(apart(s, {1.04979220062781825555, 0.04263226303858243548, -0.0002300356929474953}) < 1e-14);
  CHECK(std::abs(s.velocities()[0][2] + 0.0014195630158925646) < 1e-15);
}

TEST_CASE("1e5 gyrations of a banana", "[integrators][charges][nightly]") {
  Simulation sim(one_charge(banana_x, banana_v),
                 compose(in_field(Tokamak{}, {.rotation = Rotation::boris}), schemes::verlet_aba), pi / 10);
  CanonicalMomentum around;
  around.watch({.fields = {AnyForce<double>(InField(Tokamak{}))}, .c = {}});
  auto& energy = sim.every(1, Energy{});
  double least = 10, most = 0;
  std::array<double, 2> tenths{};
  auto& p = sim.every(1, around);
  double reference = 0;
  for (std::int64_t k = 1; k <= 2'000'000; ++k) {
    REQUIRE(sim.run(1).ok());
    const Vec3<double> x = sim.particles().positions()[0];
    const double R = std::hypot(x[0], x[1]);
    least = std::min(least, R);
    most = std::max(most, R);
    if (k == 1) reference = *p.report().first;
    const double error = std::abs(p.last() - reference);
    if (k <= 200'000) tenths[0] = std::max(tenths[0], error);
    if (k > 1'800'000) tenths[1] = std::max(tenths[1], error);
  }
  CHECK(energy.worst() < 5e-13);
  CHECK(std::abs(tenths[0] / 1.4294e-9 - 1) <= 0.01);
  CHECK(std::abs(tenths[1] / 1.4295e-9 - 1) <= 0.01);
  CHECK(std::abs(least - 1.00739) <= 1e-5);
  CHECK(std::abs(most - 1.08527) <= 1e-5);
}

TEST_CASE("a dipole holds a charge between its mirror points", "[integrators][charges]") {
  const MagneticDipole dipole{.moment = {0, 0, 1000}};
  Simulation sim(one_charge({5, 0, 0}, {0, 0.6, 0.8}),
                 compose(in_field(dipole, {.rotation = Rotation::boris}), schemes::verlet_aba), 0.02);
  MagneticMoment moment;
  moment.watch({.fields = {AnyForce<double>(InField(dipole))}, .c = {}});
  auto& energy = sim.every(1, Energy{});
  auto& mu = sim.every(1, moment);
  double highest = 0;
  for (int k = 0; k < 2000; ++k) {
    REQUIRE(sim.run(50).ok());
    highest = std::max(highest, std::abs(sim.particles().positions()[0][2]));
  }
  CHECK(energy.worst() < 5e-14);
  CHECK(highest <= 1.8951);
  CHECK(highest > 1.85);
  CHECK(mu.turns() > 10);
  CHECK(mu.bounce_period() > 0);
}

TEST_CASE("relativistic charges: gyration, force-free fields, energies, digits at gamma = 1e6",
          "[integrators][charges]") {
  const auto by = [](Relativistic how, auto field) {
    return compose(in_field(field, {.relativistic = how, .c = 1.0}), schemes::verlet_aba);
  };
  for (const double gamma : {2.0, 20.0, 1e6}) {
    CAPTURE(gamma);
    // 1 - v is not a double at gamma = 1e6; what follows is measured by the gamma that the start has.
    const double v = std::sqrt((1 - 1 / gamma) * (1 + 1 / gamma)), own = 1 / std::sqrt((1 - v) * (1 + v));
    const UniformElectromagnetic along{.B = {0, 0, 1}};
    for (const Relativistic how : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
      Simulation sim(one_charge({0, 0, 0}, {v, 0, 0}), by(how, along), 0.01 * own);
      auto& energy = sim.every(10, Energy{});
      REQUIRE(sim.run(1000).ok());
      CHECK(std::abs(*energy.report().first / (own - 1) - 1) <= 1e-9);
      CHECK(energy.worst() < 1e-13);
      CHECK(sim.claims().order == 2);
    }
  }
  const double v = std::sqrt(1 - 1.0 / 400);
  const UniformElectromagnetic free{.E = {-v, 0, 0}, .B = {0, 0, 1}};
  for (const Relativistic how : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
    const ParticleSystem<double> s = after(one_charge({0, 0, 0}, {0, v, 0}), by(how, free), 1, 1000);
    const double off = std::abs(s.positions()[0][0]);
    if (how == Relativistic::boris) CHECK(off > 0.1);
    if (how != Relativistic::boris) CHECK(off < 1e-10);
  }
  CHECK_THROWS_WITH(Simulation(one_charge({0, 0, 0}, {1, 0, 0}), by(Relativistic::vay, free), 1),
                    Catch::Contains("as fast as light"));
  CHECK_THROWS_WITH(Simulation(one_charge({0, 0, 0}, {0, 0, 0}),
                               compose(in_field(free, {.relativistic = Relativistic::vay}), schemes::verlet_aba), 1),
                    Catch::Contains("speed of light"));
}

TEST_CASE("monitors see fields at the time of the look, and gamma to all digits", "[integrators][charges]") {
  // Along E0 nothing changes in space: m v + q A is kept, with A of each moment.
  const PlaneWave wave{.E0 = {0.3, 0, 0}, .direction = {0, 0, 1}, .omega = 3, .c = 2};
  const auto worst = [&](double h) {
    Simulation sim(one_charge({0.1, 0, 0}, {0.1, 0.2, 0}), compose(in_field(wave), schemes::verlet_aba), h);
    CanonicalMomentum along;
    along.axis = {1, 0, 0};
    along.symmetry = SpaceSymmetry::translation;
    along.watch({.fields = {AnyForce<double>(InField(wave))}, .c = {}});
    auto& p = sim.every(1, along);
    REQUIRE(sim.run_until(4).ok());
    return p.worst() * *p.scale();
  };
  CHECK(std::abs(std::log2(worst(0.02) / worst(0.01)) - 2) <= 0.1);
  CHECK(worst(0.01) < 1e-4);
  // gamma = 1e6 in a uniform field: what is kept is kept to rounding.
  const UniformElectromagnetic field{.B = {0, 0, 1e3}};
  const ChargeMotion motion{.fields = {AnyForce<double>(InField(field))}, .c = 1.0};
  Simulation fast(one_charge({0, 1e3, 0}, {0.9999999999995, 0, 0}),  // about the origin: u/(q B) = 1e3
                  compose(in_field(field, {.relativistic = Relativistic::higuera_cary, .c = 1.0}), schemes::verlet_aba),
                  1);
  CanonicalMomentum around;
  MagneticMoment moment;
  around.watch(motion);
  moment.watch(motion);
  auto& J = fast.every(10, around);
  auto& mu = fast.every(10, moment);
  REQUIRE(fast.run(1000).ok());
  CHECK(mu.worst() < 1e-12);
  CHECK(J.worst() < 1e-6);
}

TEST_CASE("where no magnetic field is there is no magnetic moment to tell", "[integrators][charges]") {
  const UniformElectromagnetic electric{.E = {1, 0, 0}};
  Simulation sim(one_charge({0, 0, 0}, {0, 0, 0}), compose(in_field(electric), schemes::verlet_aba), 0.1);
  MagneticMoment moment;
  moment.watch({.fields = {AnyForce<double>(InField(electric))}, .c = {}});
  auto& mu = sim.every(1, moment);
  REQUIRE(sim.run(20).ok());
  CHECK(mu.report().samples == 0);
  CHECK_THAT(mu.report().note, Catch::Contains("no magnetic field"));
}

TEST_CASE("what relativistic charges do not keep, or cannot have beside them, is said", "[integrators][charges]") {
  const AnyHamiltonian<double> fast = in_field(UniformElectromagnetic{}, {.relativistic = Relativistic::vay, .c = 1.0});
  CHECK_FALSE(fast.claims().keeps_momentum);
  CHECK_FALSE(fast.claims().keeps_angular_momentum);
  CHECK_THROWS_WITH(Damped<AnyHamiltonian<double>>(fast, LinearDrag{0.1}), Catch::Contains("u = gamma v"));
}

TEST_CASE("relativistic motion in a constant electric field is a hyperbola", "[integrators][charges]") {
  const UniformElectromagnetic field{.E = {1, 0, 0}};
  for (const Relativistic how : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
    const auto error = [&](double h) {
      const ParticleSystem<double> s = after(
          one_charge({0, 0, 0}, {0, 0, 0}),
          compose(in_field(field, {.relativistic = how, .c = 1.0}), schemes::verlet_aba), h, std::llround(10 / h));
      return std::abs(s.positions()[0][0] - (std::sqrt(101.0) - 1));
    };
    CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - 2) <= 0.05);
  }
}

TEST_CASE("other forces stand beside fields, and slow charges without a field move as by kicks",
          "[integrators][charges]") {
  const auto particles = [] {
    ParticleSystem<double> s(unit_system("reduced"));
    s.add_column<Charge>();
    s.add("a", 1, {0, 0, 0}, {0.1, 0, 0});
    s.add("b", 0.5, {1, 0, 0}, {0, 0.9, 0.1});
    s.column<Charge>()[0] = 1;
    return s;
  };
  ForceField<double> gravity;
  gravity.add(Gravity{});
  Simulation kicked(particles(), compose(KineticPotential(gravity), schemes::verlet_aba), 0.01);
  gravity.add(InField(UniformElectromagnetic{}));
  Simulation turned(particles(), compose(ChargedParticles<ForceField<double>>(gravity), schemes::verlet_aba), 0.01);
  REQUIRE(kicked.run(100).ok());
  REQUIRE(turned.run(100).ok());
  for (const Index i : {0, 1}) {
    CHECK((Vec3<double>(kicked.particles().positions()[i]) - Vec3<double>(turned.particles().positions()[i])).norm() <
          1e-14);
  }
  CHECK(turned.evaluations().force == 100);
}

}  // namespace noether
