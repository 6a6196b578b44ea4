#include "monitors/monitors.hpp"

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace noether {
namespace {

/// Three bodies of different masses, off the origin and moving as a whole; nothing is symmetric.
template <class Real> ParticleSystem<Real> three_bodies() {
  ParticleSystem<Real> s;
  const auto vector = [](double x, double y, double z) { return Vec3<Real>(Real(x), Real(y), Real(z)); };
  s.add("first", Real(1), vector(0.5, 0.25, 0), vector(0.125, 0, 0.5));
  s.add("second", Real(0.125), vector(1.5, 0.25, 0), vector(0.125, 1, 0.5));
  s.add("third", Real(0.0625), vector(0.5, -1.75, 0.5), vector(0.875, 0, 0.25));
  return s;
}

template <class Real> Simulation<Real> run_of(ParticleSystem<Real> s, double dt = 1.0 / 64) {
  return Simulation<Real>(std::move(s), compose(test::kinetic_potential<Real>(Gravity{}), schemes::verlet), dt);
}

/// A particle on a spring.
ParticleSystem<double> oscillator() {
  ParticleSystem<double> s;
  s.add("bob", 1, {1, 0, 0}, {0, 0, 0});
  return s;
}

/// A force of nothing that counts how often it was asked, and how often for its energy.
struct Counting {
  struct Counts {
    int all = 0, energy = 0;
  };
  std::shared_ptr<Counts> counts = std::make_shared<Counts>();
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& /*s*/) const {
    ++counts->all;
    counts->energy += out.wants_energy() ? 1 : 0;
  }
};

bool same(const MonitorReport& a, const MonitorReport& b) {
  return a.first == b.first && a.last == b.last && a.worst == b.worst && a.rms == b.rms && a.slope == b.slope &&
         a.slope_error == b.slope_error && a.scale == b.scale && a.samples == b.samples && a.reason == b.reason &&
         a.note == b.note;
}

std::vector<std::string> names_of(const std::vector<Series>& all) {
  std::vector<std::string> names;
  for (const Series& series : all) names.push_back(series.name);
  return names;
}

/// What the engine promises as "to rounding" for so many flows.
double rounding(double flows) { return 8 * 0x1p-53 * std::sqrt(flows); }

}  // namespace

TEMPLATE_TEST_CASE("monitors see the closed forms of the start", "[monitors]", double, Quad) {
  auto sim = run_of(three_bodies<TestType>());
  auto& energy = sim.every(1, Energy{});
  auto& momentum = sim.every(1, Momentum{});
  auto& angular = sim.every(1, AngularMomentum{});
  CHECK(sim.run(0).ok());

  const double kinetic = (0.265625 + 0.125 * 1.265625 + 0.0625 * 0.828125) / 2;
  const double potential = -0.125 - 0.0625 / std::sqrt(4.25) - 0.0078125 / std::sqrt(5.25);
  const std::vector<Series> series = energy.series();
  CHECK(series[1].values[0] == kinetic);
  CHECK(std::abs(series[2].values[0] - potential) < 1e-16);
  CHECK(std::abs(energy.total() - kinetic - potential) < 1e-16);
  CHECK(momentum.value() == std::array<double, 3>{0.1953125, 0.125, 0.578125});
  CHECK(angular.value() == std::array<double, 3>{0.11328125, -0.32421875, 0.248046875});
}

TEST_CASE("monitors offer the quantities that files promise", "[monitors]") {
  auto sim = run_of(three_bodies<double>());
  auto& energy = sim.every(1, Energy{});
  auto& momentum = sim.every(1, Momentum{});
  auto& angular = sim.every(1, AngularMomentum{});
  auto& center = sim.every(1, CenterOfMass{});
  CHECK(sim.run(1).ok());
  CHECK(names_of(energy.series()) == std::vector<std::string>{"total", "kinetic", "potential", "relative_error"});
  CHECK(names_of(momentum.series()) == std::vector<std::string>{"value", "relative_error"});
  CHECK(names_of(angular.series()) == std::vector<std::string>{"value", "relative_error", "direction_error"});
  CHECK(names_of(center.series()) == std::vector<std::string>{"position", "velocity"});
  for (const auto& series : {energy.series(), momentum.series(), angular.series(), center.series()}) {
    for (const Series& one : series) {
      CAPTURE(one.name);
      CHECK(one.values.size() == (one.shape.empty() ? 1U : 3U));
    }
  }
}

TEMPLATE_TEST_CASE("gravity keeps momentum and angular momentum to rounding", "[monitors]", double, Quad) {
  auto sim = run_of(three_bodies<TestType>());
  auto& momentum = sim.every(10, Momentum{});
  auto& angular = sim.every(10, AngularMomentum{});
  auto& center = sim.every(10, CenterOfMass{});
  CHECK(sim.run(1000).ok());
  const double unit = static_cast<double>(std::numeric_limits<TestType>::epsilon()) / 0x1p-52;
  CHECK(momentum.worst() <= rounding(2000) * unit);
  CHECK(angular.worst() <= rounding(2000) * unit);
  CHECK(angular.worst_direction() <= rounding(2000) * unit * 4);
  CHECK(center.worst() <= rounding(2000) * unit * 8);
}

TEST_CASE("a field from outside is seen as a change of momentum", "[monitors]") {
  const UniformField field{.acceleration = {0, 0.5, 0}};
  Simulation sim(oscillator(), compose(test::kinetic_potential(field), schemes::verlet), 0.25);
  auto& momentum = sim.every(4, Momentum{});
  CHECK(sim.run(8).ok());
  CHECK(momentum.value() == std::array<double, 3>{0, 1, 0});
}

TEST_CASE("the energy error is relative to the larger of |E0| and a thousandth of T0 + |U0|", "[monitors]") {
  // A parabola: E0 = 0, T0 = |U0| = 1.
  ParticleSystem<double> s;
  s.add("sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("comet", 0.5, {0.5, 0, 0}, {0, 2, 0});
  auto sim = run_of(std::move(s));
  auto& energy = sim.every(1, Energy{});
  CHECK(sim.run(1).ok());
  CHECK(energy.scale() == 1e-3 * 2);

  auto bound = run_of(three_bodies<double>());
  auto& other = bound.every(1, Energy{});
  CHECK(bound.run(64).ok());
  CHECK(*other.scale() == std::abs(*other.report().first));
  CHECK(other.series()[3].values[0] == (other.total() - *other.report().first) / *other.scale());
}

TEST_CASE("the energy error of Verlet falls with the square of the step", "[monitors]") {
  const auto worst = [](double dt, std::int64_t steps) {
    auto sim = run_of(three_bodies<Quad>(), dt);
    auto& energy = sim.every(1, Energy{});
    CHECK(sim.run(steps).ok());
    return energy.worst();
  };
  const double order = std::log2(worst(1.0 / 128, 256) / worst(1.0 / 256, 512));
  CHECK(std::abs(order - 2) < 0.02);
}

TEST_CASE("a direction is told only where there is one", "[monitors]") {
  ParticleSystem<double> s;
  s.add("left", 1, {-1, 0, 0}, {0, 0, 0});
  s.add("right", 1, {1, 0, 0}, {0.5, 0, 0});
  auto sim = run_of(std::move(s));
  auto& angular = sim.every(1, AngularMomentum{});
  CHECK(sim.run(2).ok());
  CHECK(std::isnan(angular.series()[2].values[0]));
  CHECK(angular.worst_direction() == 0);
  CHECK(angular.worst() == 0);
  CHECK(angular.report().note.empty());
}

TEST_CASE("tracers alone have no center of mass, and that shows", "[monitors]") {
  ParticleSystem<double> s;
  s.add("dust", 0, {-1, 0, 0}, {0, 0, 0});
  auto sim = run_of(std::move(s));
  auto& center = sim.every(1, CenterOfMass{});
  CHECK(sim.run(2).ok());
  CHECK(std::isnan(center.worst()));
  CHECK(std::isnan(center.series()[0].values[0]));
}

TEST_CASE("a direction that turns is told, as the closed form says", "[monitors]") {
  // Thrown along y in a field along z: L = (g t^2 / 2, -g t, 1). Verlet is exact here.
  ParticleSystem<double> s;
  s.add("thrown", 1, {1, 0, 0}, {0, 1, 0});
  Simulation sim(std::move(s),
                 compose(test::kinetic_potential(UniformField{.acceleration = {0, 0, 0.5}}), schemes::verlet), 0.125);
  auto& angular = sim.every(1, AngularMomentum{});
  CHECK(sim.run(8).ok());
  const Quad change = sqrt(Quad(0.3125));  // of (1/4, -1/2, 0); every number before it is a double
  CHECK(angular.worst_direction() == static_cast<double>(atan2(change, Quad(1))));
  CHECK(angular.worst() == static_cast<double>(change));
  CHECK(angular.report().note == "direction within 0.51 rad; not conserved by the forces or the method of this run");
}

TEST_CASE("an energy that is 0 because nothing has mass says nothing, and says so", "[monitors]") {
  ParticleSystem<double> s;
  s.add("Earth", 1, {0, 0, 0}, {0, 0, 0});
  s.add("satellite", 0, {1, 0, 0}, {0, 1, 0});
  Simulation sim(s, compose(test::kinetic_potential(Gravity{}), schemes::verlet), 0.1);
  const auto& energy = sim.every(1, Energy{});
  CHECK(sim.run(20).ok());
  const MonitorReport report = energy.report();
  CHECK(report.worst == 0);
  CHECK(report.note ==
        "no massive particle moves or is pulled, so the energy says nothing about tracers: watch elements");
  s.velocities().set(0, {0.1, 0, 0});
  Simulation moving(s, compose(test::kinetic_potential(Gravity{}), schemes::verlet), 0.1);
  const auto& told = moving.every(1, Energy{});
  CHECK(moving.run(20).ok());
  CHECK(told.report().note.empty());
}

TEST_CASE("a dissipative run has an energy but no error of it, and says why", "[monitors]") {
  const auto damped = test::damped(test::kinetic_potential(HarmonicField{.k = 1}), LinearDrag{.rate = 0.125});
  Simulation sim(oscillator(), compose(damped, schemes::verlet), 0.125);
  auto& energy = sim.every(1, Energy{});
  CHECK(sim.run(80).ok());
  const MonitorReport report = energy.report();
  CHECK(*report.last < *report.first);
  CHECK(report.samples == 81);
  CHECK((!report.worst && !report.rms && !report.slope && !report.slope_error));
  CHECK(report.reason == "the run is dissipative: its energy changes, so it has no energy error");
  CHECK(std::isnan(energy.worst()));
}

TEST_CASE("a driven run has an energy but no error of it, and says why", "[monitors]") {
  const OscillatingField drive{.acceleration = {1, 0, 0}, .omega = 2};
  Simulation sim(oscillator(), compose(test::kinetic_potential(drive), schemes::verlet), 0.125);
  auto& energy = sim.every(1, Energy{});
  CHECK(sim.run(8).ok());
  CHECK(energy.report().reason == "a force depends on time: the energy changes, so it has no energy error");
  CHECK(!energy.report().worst);
}

TEST_CASE("a monitor that is not attached costs nothing", "[monitors]") {
  Counting bare, watched;
  Simulation without(oscillator(), compose(test::kinetic_potential(bare), schemes::verlet), 0.125);
  CHECK(without.run(100).ok());
  CHECK(bare.counts->energy == 0);
  CHECK(bare.counts->all == 101);  // a kick each step, and one to settle the end, which is looked at for finite values

  Simulation with(oscillator(), compose(test::kinetic_potential(watched), schemes::verlet), 0.125);
  with.every(10, Energy{});
  CHECK(with.run(100).ok());
  CHECK(watched.counts->energy == 11);
}

TEST_CASE("monitors report the same after save and load as without", "[monitors][restart]") {
  const auto attach = [](Simulation<double>& sim) {
    sim.every(3, Energy{});
    sim.every(5, Momentum{});
    sim.every(5, AngularMomentum{});
    sim.every(7, CenterOfMass{});
  };
  const auto reports = [](Simulation<double>& sim) {
    std::vector<MonitorReport> all;
    sim.for_each_monitor([&](const std::string&, auto& monitor) { all.push_back(*monitor.report()); });
    return all;
  };
  const auto start = [] { return run_of(three_bodies<double>()); };
  auto whole = start(), first = start(), second = start();
  for (auto* sim : {&whole, &first, &second}) attach(*sim);
  CHECK(whole.run(600).ok());
  CHECK(first.run(245).ok());
  second.restore(first.save());
  CHECK(second.run(355).ok());
  const auto a = reports(whole), b = reports(second);
  REQUIRE(a.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    CHECK(same(a[k], b[k]));
  }
}

}  // namespace noether
