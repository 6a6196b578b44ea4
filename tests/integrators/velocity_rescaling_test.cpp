// Stochastic velocity rescaling: the distribution of the kinetic energy, its relaxation, what is conserved, its bits.

#include "integrators/velocity_rescaling.hpp"

#include "constraints/constraint_residual.hpp"
#include "engine/simulation.hpp"
#include "forces/springs.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "monitors/monitors.hpp"
#include "monitors/temperature.hpp"
#include "numbers/chi_squared.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/settings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace noether {
namespace {

constexpr double warmth = 0.7;

using Bath = VelocityRescaling<AnyHamiltonian<double>>;

/// Particles of unequal masses that move, and drift together.
ParticleSystem<double> movers(Index n) {
  ParticleSystem<double> s;
  for (Index i = 0; i < n; ++i) {
    const auto k = static_cast<double>(i);
    s.add("", 1 + 0.5 * k, {1.3 * k, 0.2 * k * k, -0.4 * k}, {std::cos(k), std::sin(2 * k), 0.3 - 0.1 * k});
  }
  return s;
}

template <class... Fs> Bath bath(const VelocityRescalingOptions& options, Fs... forces) {
  return Bath(test::kinetic_potential(std::move(forces)...), options);
}

/// The chance of a chi-squared deviate of these degrees (even ones, or 1) to be above x.
double chance_above(std::int64_t degrees, double x) {
  if (degrees == 1) return std::erfc(std::sqrt(x / 2));
  double term = std::exp(-x / 2), sum = term;
  for (std::int64_t k = 1; k < degrees / 2; ++k) sum += term *= x / 2 / static_cast<double>(k);
  return sum;
}

/// The greatest distance of the distribution of samples from an exact one, times the root of their number: above 1.95
/// once in a thousand times.
double kolmogorov(std::vector<double> samples, const std::function<double(double)>& above_of) {
  std::sort(samples.begin(), samples.end());
  const auto n = static_cast<double>(samples.size());
  double worst = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double below = 1 - above_of(samples[k]);
    worst = std::max(
        {worst, std::abs(below - static_cast<double>(k) / n), std::abs(below - static_cast<double>(k + 1) / n)});
  }
  return worst * std::sqrt(n);
}

/// Kinetic energy about the center of mass, or of all motion.
double heat_in(const ParticleSystem<double>& s, bool about_center) {
  double mass = 0, kinetic = 0;
  Vec3<double> momentum = Vec3<double>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> v = s.velocities()[i];
    mass += s.masses()[i];
    momentum += s.masses()[i] * v;
    kinetic += s.masses()[i] * norm2(v) / 2;
  }
  return about_center ? kinetic - norm2(momentum) / mass / 2 : kinetic;
}

/// Kinetic energies of a run, one a step.
std::vector<double> energies(Bath hamiltonian, const char* letters, const ParticleSystem<double>& start, double dt,
                             int steps, bool about_center) {
  auto integrator = compose(std::move(hamiltonian), word(letters));
  auto s = start;
  s.clock() = Clock<double>::fixed(0, dt);
  integrator.bind(s);
  auto settled = s;
  std::vector<double> all;
  for (int k = 0; k < steps; ++k) {
    integrator.advance(s, {.steps = 1});
    integrator.settle(s, settled, {}, std::nullopt, true);
    all.push_back(heat_in(settled, about_center));
  }
  return all;
}

/// Mean, variance, and correlation of neighbors.
struct EnergyMoments {
  double mean = 0, variance = 0, correlation = 0;
  explicit EnergyMoments(const std::vector<double>& x) {
    const auto n = static_cast<double>(x.size());
    for (const double one : x) mean += one / n;
    for (const double one : x) variance += (one - mean) * (one - mean) / n;
    for (std::size_t k = 1; k < x.size(); ++k) correlation += (x[k] - mean) * (x[k - 1] - mean) / n / variance;
  }
};

TEST_CASE("sums of squares of normal deviates have their distribution", "[velocity_rescaling]") {
  for (const std::int64_t degrees :
       {std::int64_t{1}, std::int64_t{2}, std::int64_t{4}, std::int64_t{10}, std::int64_t{100}}) {
    std::vector<double> samples;
    for (std::uint32_t place = 0; place < 20'000; ++place) {
      samples.push_back(chi_squared(degrees, [&](std::uint32_t k) { return philox({k, place, 7, 0}, {1, 2}); }));
    }
    CAPTURE(degrees);
    CHECK(kolmogorov(samples, [&](double x) { return chance_above(degrees, x); }) < 1.95);
    CHECK(kolmogorov(samples, [&](double x) { return chance_above(degrees, 1.1 * x); }) >
          1.95);  // the test of the test
  }
  CHECK(chi_squared(0, [](std::uint32_t) { return std::array<std::uint32_t, 4>{}; }) == 0);
  // An odd number, which the sums above leave out, by its first two moments: 3 and 6.
  std::vector<double> three;
  for (std::uint32_t place = 0; place < 100'000; ++place) {
    three.push_back(chi_squared(3, [&](std::uint32_t k) { return philox({k, place, 9, 0}, {1, 2}); }));
  }
  CHECK(std::abs(EnergyMoments(three).mean - 3) < 4 * std::sqrt(6.0 / 1e5));
  CHECK(std::abs(EnergyMoments(three).variance - 6) < 4 * std::sqrt((12 * 8 * 3.0 + 2 * 36) / 1e5));
}

TEST_CASE("the kinetic energy of free particles is canonical and relaxes in its time, at any step",
          "[velocity_rescaling]") {
  struct Case {
    Index particles;
    double step;
    const char* letters;
  };
  for (const Case& one : {Case{2, 0.5, "BAV"}, Case{2, 3, "VBABV"}, Case{3, 0.1, "BAV"}, Case{12, 1, "VBABV"}}) {
    CAPTURE(one.particles, one.step, one.letters);
    const std::int64_t freedom = 3 * one.particles - 3;
    constexpr int steps = 40'000;
    const auto all = energies(bath({.temperature = warmth, .relaxation_time = 2, .seed = 5}), one.letters,
                              movers(one.particles), one.step, steps, true);
    const std::vector<double> late(all.begin() + 400, all.end());
    const EnergyMoments moments(late);
    // Gamma of shape f/2 and scale warmth; the correlation of two steps is c = exp(-h/tau), that of squares about c^2.
    const double shape = static_cast<double>(freedom) / 2, c = std::exp(-one.step / 2);
    const double independent = steps * (1 - c) / (1 + c);
    CHECK(std::abs(moments.mean - shape * warmth) < 4 * warmth * std::sqrt(shape / independent));
    CHECK(std::abs(moments.variance / (shape * warmth * warmth) - 1) < 4 * std::sqrt((2 + 6 / shape) / independent));
    CHECK(std::abs(moments.correlation - c) < 4 * std::sqrt(2 / independent));
    if (freedom % 2 != 0) continue;
    std::vector<double> apart;  // eight relaxation times from one to the next
    for (std::size_t k = 0; k < late.size(); k += static_cast<std::size_t>(1 + 16 / one.step)) apart.push_back(late[k]);
    CHECK(kolmogorov(apart, [&](double kinetic) { return chance_above(freedom, 2 * kinetic / warmth); }) < 1.95);
  }
}

TEST_CASE("particles that feel forces have the canonical kinetic energy too, in a field and along constraints",
          "[velocity_rescaling]") {
  // In a field momentum is not kept: all 3 N degrees of freedom, the coupling to potential energy by the field.
  const auto in_field =
      energies(bath({.temperature = warmth, .relaxation_time = 0.5, .seed = 8}, HarmonicField{.k = 2}), "VBABV",
               movers(3), 0.05, 100'000, false);
  const EnergyMoments field(in_field);
  CHECK(std::abs(field.mean / (4.5 * warmth) - 1) < 0.02);
  CHECK(std::abs(field.variance / (4.5 * warmth * warmth) - 1) < 0.06);
  // A chain of eight hanging from a fixed point: eight constraints of 24.
  const test::Mechanism chain = test::hanging_chain(8);
  Simulation<double> sim(
      chain.particles,
      compose(Bath(test::hamiltonian_of(chain), {.temperature = 5, .relaxation_time = 0.1, .seed = 1}),
              schemes::verlet),
      0.01);
  ConstraintResidual residual;
  residual.watch(chain.constraints);
  const ConstraintResidual& violated = sim.every(10, residual);
  const Temperature& temperature = sim.every(50, Temperature{});
  REQUIRE(sim.run(50 * 600).ok());
  CHECK(*violated.report().worst < 1e-14);
  CHECK(temperature.degrees_of_freedom() == 24 - 8);
  CHECK(std::abs(*temperature.report().rms / 5 - 1) < 0.1);
}

constexpr VelocityRescalingOptions lively{.temperature = 1, .relaxation_time = 1, .seed = 2};

/// Four on springs.
Bath on_springs(const VelocityRescalingOptions& options = lively) {
  return bath(options, HarmonicBond{.k = 20, .length = 1, .tied = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}});
}

/// The mean square of the relative error of the conserved energy, over seeds and a time of 40.
double conserved_error(double dt) {
  double squares = 0;
  for (std::int64_t seed = 0; seed < 20; ++seed) {
    Simulation<double> sim(
        movers(4), compose(on_springs({.temperature = 1, .relaxation_time = 1, .seed = seed}), schemes::verlet), dt);
    const Energy& energy = sim.every(1, Energy{});
    REQUIRE(sim.run_until(40).ok());
    CHECK(energy.report().note.find("of the energy less the heat that the bath has given") != std::string::npos);
    squares += energy.rms() * energy.rms();
  }
  return std::sqrt(squares / 20);
}

TEST_CASE("the energy less the heat of the bath is conserved to the order of the word, and exactly where no forces act",
          "[velocity_rescaling]") {
  const double coarse = conserved_error(0.01), fine = conserved_error(0.005), finest = conserved_error(0.0025);
  CAPTURE(coarse, fine, finest);
  CHECK(std::abs(coarse / fine - 4) < 0.8);
  CHECK(std::abs(fine / finest - 4) < 0.8);
  // Free particles: what they have is what they were given, at looks that complete a word and at others.
  for (const char* letters : {"BAV", "VBABV"}) {
    Simulation<double> sim(movers(4), compose(bath(lively), word(letters)), 0.5);
    const Energy& energy = sim.every(1, Energy{});
    REQUIRE(sim.run(2000).ok());
    CHECK(energy.worst() < 1e-13);
    CHECK(energy.series().back().name == "conserved");
    CHECK(std::abs(energy.total() - energy.conserved()) > 0.1);
  }
  // A run whose step is changed goes on from what completed a step, and so does its heat.
  Simulation<double> changed(movers(4), compose(bath(lively), word("VBABV")), 0.5);
  const Energy& after = changed.every(1, Energy{});
  for (const double step : {0.25, 0.125, 0.5}) {
    REQUIRE(changed.run(10).ok());
    changed.change_step(step);
  }
  REQUIRE(changed.run(10).ok());
  CHECK(after.worst() < 1e-13);
  // Drag takes energy that nobody counts.
  const Bath damped(test::damped(test::kinetic_potential(), {.rate = 0.1}), lively);
  CHECK_FALSE(damped.claims().counts_heat);
}

TEST_CASE("rescaling keeps momentum and what molecules do not feel of it", "[velocity_rescaling]") {
  Simulation<double> sim(movers(4), compose(on_springs(), schemes::verlet), 0.02);
  const Momentum& momentum = sim.every(10, Momentum{});
  REQUIRE(sim.run(2000).ok());
  CHECK(momentum.worst() < 1e-14);
  CHECK(sim.claims().keeps_momentum);
  CHECK_FALSE(sim.claims().keeps_angular_momentum);
}

TEST_CASE("a run with rescaled velocities goes on bit for bit, observed or not, and on any number of threads",
          "[velocity_rescaling]") {
  ParticleSystem<double> start;
  for (Index i = 0; i < 1500; ++i) {
    const auto k = static_cast<double>(i);
    start.add("", 1, {std::sin(k), std::cos(3 * k), 0.1}, {std::cos(k), 0.2, std::sin(2 * k)});
  }
  const auto make = [&](const char* letters) {
    return Simulation<double>(start, compose(bath(lively, HarmonicField{.k = 2}), word(letters)), 0.1);
  };
  for (const char* letters : {"VBABV", "BAVAB", "ABVBA", "BAV", "VABAVABAV"}) {
    CAPTURE(letters);
    Simulation<double> whole = make(letters);
    const Energy& all = whole.every(4, Energy{});
    REQUIRE(whole.run(30).ok());
    for (const int threads : {1, 2, 3, 8}) {
      const test::Threads some(threads);
      Simulation<double> first = make(letters);
      first.every(1, Temperature{});
      first.every(4, Energy{});
      REQUIRE(first.run(11).ok());
      const SavedRun saved = first.save();
      Simulation<double> second = make(letters);
      second.every(1, Temperature{});
      const Energy& later = second.every(4, Energy{});
      second.restore(saved);
      REQUIRE(second.run(19).ok());
      CHECK(test::same_bits(whole.particles(), second.particles()));
      CHECK(all.worst() == later.worst());
      CHECK(all.conserved() == later.conserved());
    }
  }
  Simulation<double> one = make("VBABV"),
                     other(start,
                           compose(bath({.temperature = 1, .relaxation_time = 1, .seed = 3}, HarmonicField{.k = 2}),
                                   word("VBABV")),
                           0.1);
  REQUIRE(one.run(5).ok());
  REQUIRE(other.run(5).ok());
  CHECK_FALSE(test::same_bits(one.particles(), other.particles()));
  CHECK_THROWS_AS(other.restore(one.save()), Error);
}

TEST_CASE("rescaling that cannot be is refused by name, and particles that rest or drift together stay so",
          "[velocity_rescaling]") {
  CHECK(test::refusal_of([&] { bath({.temperature = -1, .relaxation_time = 1}); }) ==
        "temperature = -1 is not a valid temperature; 0 or more is expected");
  CHECK(test::refusal_of([&] { bath({.temperature = 1, .relaxation_time = 0}); }) ==
        "relaxation_time = 0 is not a valid time; a time above 0 is expected");
  CHECK(
      test::refusal_of([&] { Simulation<double>(movers(1), compose(bath(lively), schemes::verlet), 0.1); }) ==
      "no degree of freedom is left to have a temperature beside the motion of the center of mass; take the thermostat "
      "out");
  CHECK(test::refusal_of([&] { compose(bath(lively), schemes::yoshida_4); }).find("part V of 'velocity_rescaling'") !=
        std::string::npos);
  const Bath planets(test::wisdom_holman({.G = test::outer_G}), lively);
  CHECK(test::refusal_of([&] {
          Simulation<double>(test::outer_planets(), compose(planets, schemes::verlet), 10);
        }).find("'wisdom_holman' uses its own coordinates") == 0);
  auto tracers = movers(2);
  tracers.add("dust", 0, {1, 0, 0}, {0, 0, 0});
  CHECK(test::refusal_of([&] { Simulation<double>(tracers, compose(bath(lively), schemes::verlet), 0.1); }) ==
        "'dust' has no mass, so it has no temperature; give it a mass, or take the thermostat out");
  Bath alone = bath(lively);
  auto s = movers(2);
  CHECK_THROWS_AS(alone.flow('V', s, 0.1), LogicError);
  ParticleSystem<double> resting;
  for (int k = 0; k < 3; ++k) resting.add("", 1, {1.0 * k, 0, 0}, {0, 0, 0});
  Simulation<double> sim(resting, compose(bath(lively), schemes::verlet), 0.1);
  REQUIRE(sim.run(10).ok());
  for (Index i = 0; i < 3; ++i) CHECK(norm2(Vec3<double>(sim.particles().velocities()[i])) == 0);
  // Particles that drift together have no motion of their own but rounding.
  for (const Vec3<double>& drift : {Vec3<double>(0.3, 0.1, 0.7), Vec3<double>(1e3 / 3, -0.1, 1e-5)}) {
    ParticleSystem<double> together;
    for (const double mass : {12.0, 16.0, 1.1}) together.add("", mass, {mass, 0, 0}, drift);
    Simulation<double> on(together, compose(bath(lively), schemes::verlet), 0.1);
    REQUIRE(on.run(10).ok());
    for (Index i = 0; i < 3; ++i) CHECK(Vec3<double>(on.particles().velocities()[i]) == drift);
  }
}

}  // namespace
}  // namespace noether
