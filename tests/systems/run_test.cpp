// Runs of systems without particles: refusals, faults, restarts, edits.

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/lorenz.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/temperature.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <vector>

using namespace noether;

namespace {

/// y' = y^2: infinite at t = 1 / y(0). No names, no description.
struct Explosion {
  Index size() const { return 2; }
  std::vector<double> start() const { return {-1, 1}; }
  template <class Real> void rates(const Real& /*t*/, const Vector<Real>& y, Vector<Real>& dy) const {
    for (Index i = 0; i < 2; ++i) dy[i] = y[i] * y[i];
  }
};
struct Named : Explosion {
  std::vector<std::string> names() const { return {"calm", "wild"}; }
};

struct Seen {
  std::vector<double>* times;
  std::vector<double>* values;
  void observe(const Snapshot<double>& now) const {
    times->push_back(now.time());
    values->push_back(now.state().variables()[0]);
  }
};

Simulation<double> lorenz(const char* name, double step) {
  return {initial_state(Lorenz{}), classical(Lorenz{}, method(name)), step};
}
Simulation<double> lorenz() { return {initial_state(Lorenz{}), classical(Lorenz{}, method("dop853"))}; }

}  // namespace

TEST_CASE("monitors and stops of particles are refused for a system, before the first step", "[system_run]") {
  auto run = lorenz("rk4", 0.01);
  const auto refusal = [](const std::string& name) {
    return "monitor '" + name + "' watches particles, but system 'lorenz' has only variables";
  };
  CHECK_THROWS_WITH(run.every(1, Energy{}), refusal("energy"));
  CHECK_THROWS_WITH(run.every(1, Momentum{}), refusal("momentum"));
  CHECK_THROWS_WITH(run.every(1, AngularMomentum{}), refusal("angular_momentum"));
  CHECK_THROWS_WITH(run.every(1, CenterOfMass{}), refusal("center_of_mass"));
  CHECK_THROWS_WITH(run.every(1, Elements{}), refusal("elements"));
  CHECK_THROWS_WITH(run.every(1, ClosestApproach{}), refusal("closest_approach"));
  CHECK_THROWS_WITH(run.every(1, Temperature{}), refusal("temperature"));
  CHECK_THROWS_WITH(run.every(1, ShadowHamiltonian<double>{}), refusal("shadow_hamiltonian"));
  CHECK_THROWS_WITH(run.stop_when(farther_than(1), 1),
                    "stop 'escape' watches distances of particles, but system 'lorenz' has only variables");
  CHECK_THROWS_WITH(run.stop_when(closer_than(1), 1),
                    "stop 'collision' watches distances of particles, but system 'lorenz' has only variables");
  int monitors = 0;
  run.for_each_monitor([&](const std::string&, AnyMonitor<double>&) { ++monitors; });
  CHECK(monitors == 0);
  CHECK(run.run(3).ok());
}

TEST_CASE("variables go to methods for them, and particles to methods for those", "[system_run]") {
  const auto kick = compose(test::kinetic_potential(Gravity{}), schemes::verlet);
  CHECK_THROWS_WITH(Simulation(initial_state(Lorenz{}), kick, 0.01),
                    "method 'verlet' moves particles, but it was given the variables of a system of first order; use a "
                    "method for y' = f, such as 'dop853' or 'rodas_5p'");
  CHECK_THROWS_WITH(Simulation(initial_state(Lorenz{}), classical(Gravity{}, method("rk4")), 0.01),
                    "method 'rk4' moves particles, but it was given the variables of a system of first order; use a "
                    "method for y' = f, such as 'dop853' or 'rodas_5p'");
  CHECK_THROWS_WITH(Simulation(test::outer_planets(), classical(Lorenz{}, method("rk4")), 0.01),
                    "system 'lorenz' has variables, but it was given particles");
  CHECK_THROWS_WITH(Simulation(ParticleSystem<double>(), classical(Lorenz{}, method("rk4")), 0.01),
                    "there are no particles; a run needs at least one");
  ParticleSystem<double> both = test::outer_planets();
  both.set_variables({1, 2, 3});
  CHECK_THROWS_WITH(Simulation(both, classical(Lorenz{}, method("rk4")), 0.01),
                    "there are particles as well as variables; a run is of particles or of a first-order system");
  CHECK_THROWS_WITH(Simulation(initial_state(HeatLine{}), classical(Lorenz{}, method("rk4")), 0.01),
                    "system 'lorenz' has 3 variables, but it was given 50 and 0 particles");
  CHECK_THROWS_WITH(initial_state(Lorenz{}, {1, 2}),
                    "system 'lorenz' has 3 variables, but there are 2 values to start from");
}

TEST_CASE("a variable that is not finite ends the run at the last whole step, with its place and its name",
          "[system_run]") {
  Simulation nameless(initial_state(Explosion{}), classical(Explosion{}, method("rk4")), 0.1);
  const Outcome outcome = nameless.run(1000);
  CHECK(outcome.kind == Outcome::Kind::diverged);
  CHECK(outcome.quantity == "y[1]");
  CHECK(outcome.message == "variable y[1] is not finite");
  CHECK(!outcome.particle);
  CHECK(std::isfinite(nameless.particles().variables()[1]));
  CHECK(nameless.step() == outcome.step);
  Simulation named(initial_state(Named{}), classical(Named{}, method("rk4")), 0.1);
  CHECK(to_text(named.run(1000)) ==
        "diverged at step " + std::to_string(outcome.step) + ": variable 'wild', y[1], is not finite");
}

TEST_CASE("a system's run that is saved and restored goes on with the same bits", "[system_run]") {
  for (const bool adaptive : {false, true}) {
    auto whole = adaptive ? lorenz() : lorenz("rk4", 0.01);
    auto half = adaptive ? lorenz() : lorenz("rk4", 0.01);
    auto other = adaptive ? lorenz() : lorenz("rk4", 0.01);
    REQUIRE(whole.run(200).ok());
    REQUIRE(half.run(100).ok());
    other.restore(half.save());
    CHECK(other.particles().variable_names() == std::vector<std::string>{"x", "y", "z"});
    REQUIRE(other.run(100).ok());
    CHECK(other.time() == whole.time());
    CHECK(other.particles().variables() == whole.particles().variables());
  }
}

TEST_CASE("a saved run of another system is refused", "[system_run]") {
  auto run = lorenz("rk4", 0.01);
  Simulation other(initial_state(HeatLine{.points = 4}), classical(HeatLine{.points = 4}, method("rk4")), 0.01);
  CHECK_THROWS_WITH(other.restore(run.save()), "the saved run has 3 variables, but this one has 4");
  Simulation changed(initial_state(Lorenz{}), classical(Lorenz{.rho = 27}, method("rk4")), 0.01);
  CHECK_THROWS_WITH(
      changed.restore(run.save()),
      "the saved run was made with lorenz(sigma = 10, rho = 28, beta = 2.6666666666666665), but this one has "
      "lorenz(sigma = 10, rho = 27, beta = 2.6666666666666665)");
}

TEST_CASE("saved states carry variables and their names exactly; those of particles are as they were", "[system_run]") {
  ParticleSystem<double> s;
  s.set_variables({0.1, -0.0, 1e-310}, {"a", "b", "c"});
  const ParticleSystem<double> back = load_particles<double>(save_particles(s));
  CHECK(back.variables() == s.variables());
  CHECK(std::signbit(back.variables()[1]));
  CHECK(back.variable_names() == s.variable_names());
  ParticleSystem<Quad> wide = s.as<Quad>();
  wide.variables()[0] += Quad(1e-30);
  CHECK(load_particles<Quad>(save_particles(wide)).variables() == wide.variables());
  CHECK(load_particles<Quad>(save_particles(wide)).variable_name(2) == "c");

  const SavedState particles = save_particles(test::outer_planets());
  CHECK(particles.count("variables") == 0);
  CHECK(load_particles<double>(particles).variables().empty());
  SavedState broken = save_particles(s);
  broken["variable_names"] = std::vector<std::string>{"a"};
  CHECK_THROWS_WITH(load_particles<double>(broken), "the saved state has 3 variables and names for 1");
}

TEST_CASE("variables may be changed between steps, and outputs by time change nothing", "[system_run]") {
  auto run = lorenz("rk4", 0.01);
  REQUIRE(run.run(10).ok());
  run.edit([](ParticleSystem<double>& s) { s.variables() = {2, 3, 4}; });
  REQUIRE(run.run(10).ok());
  Simulation fresh(initial_state(Lorenz{}, {2, 3, 4}), classical(Lorenz{}, method("rk4")), 0.01);
  REQUIRE(fresh.run(10).ok());
  CHECK(run.particles().variables() == fresh.particles().variables());

  std::vector<double> times, values;
  auto watched = lorenz(), alone = lorenz();
  watched.every_time(0.125, Seen{&times, &values});
  REQUIRE(watched.run_until(1).ok());
  REQUIRE(alone.run_until(1).ok());
  CHECK(watched.particles().variables() == alone.particles().variables());
  REQUIRE(times.size() == 9);
  for (std::size_t k = 0; k < times.size(); ++k) CHECK(times[k] == 0.125 * static_cast<double>(k));
  CHECK(values.back() == watched.particles().variables()[0]);
}

TEST_CASE("a system runs in extended precision, beyond what doubles can tell", "[system_run]") {
  const HeatLine line{.points = 4, .diffusivity = 0.05};
  Simulation<Quad> run(initial_state(line).as<Quad>(),
                       Classical<Quad>(std::make_unique<SystemMotion<HeatLine, Quad>>(line),
                                       method("dop853", {.rtol = 1e-20, .atol = 1e-22})));
  REQUIRE(run.run_until(0.5).ok());
  // A sine stays a sine: its decay is one factor for all points.
  const auto& y = run.particles().variables();
  const std::vector<double> begin = line.start();
  const Quad factor = y[0] / Quad(begin[0]);
  CHECK(std::abs(static_cast<double>(factor) / std::exp(-0.5 * line.rate_of(1)) - 1) < 1e-13);
}
