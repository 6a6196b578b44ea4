/// run(2n) equals run(n) + save + load + run(n), bit for bit, for every scheme over both Hamiltonians.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>

using namespace noether;

namespace {

template <class Real> struct Run {
  Simulation<Real> simulation;
  Energy* energy;
  AngularMomentum* angular;
  CenterOfMass* center;
  ClosestApproach* closest;
};

template <class Real> Run<Real> make_run(const AnyIntegrator<Real>& integrator) {
  Simulation<Real> simulation(test::outer_planets<Real>(), integrator, 40.0);
  auto& energy = simulation.every(3, Energy{});
  auto& angular = simulation.every(5, AngularMomentum{});
  auto& center = simulation.every(7, CenterOfMass{});
  simulation.every(2, Elements{});
  auto& closest = simulation.every(4, ClosestApproach{});
  simulation.stop_when(farther_than(1e6), 6);
  simulation.stop_when(closer_than(1e-9), 1);
  return {std::move(simulation), &energy, &angular, &center, &closest};
}

std::string figures(const MonitorReport& report) {
  const auto text = [](const std::optional<double>& x) { return x ? fmt::format("{}", *x) : std::string("-"); };
  return fmt::format("{} {} {} {} {} {} {}", text(report.first), text(report.last), text(report.worst),
                     text(report.rms), text(report.slope), text(report.slope_error), report.samples);
}

/// Runs 2n steps at once and in two halves with everything rebuilt in between.
template <class Real> void check_restart(const AnyIntegrator<Real>& integrator, std::int64_t n) {
  auto whole = make_run<Real>(integrator);
  REQUIRE(whole.simulation.run(2 * n).ok());

  auto first = make_run<Real>(integrator);
  REQUIRE(first.simulation.run(n).ok());
  const SavedRun saved = first.simulation.save();
  auto second = make_run<Real>(integrator);
  second.simulation.restore(saved);
  REQUIRE(second.simulation.run(n).ok());

  CHECK(test::same_bits(whole.simulation.particles(), second.simulation.particles()));
  if (whole.simulation.claims().second_words)
    CHECK(test::same_low_words(whole.simulation.particles(), second.simulation.particles()));
  CHECK(figures(whole.energy->report()) == figures(second.energy->report()));
  CHECK(figures(whole.angular->report()) == figures(second.angular->report()));
  CHECK(figures(whole.center->report()) == figures(second.center->report()));
  CHECK(whole.closest->report().note == second.closest->report().note);
  CHECK(figures(whole.closest->report()) == figures(second.closest->report()));
  CHECK(whole.simulation.evaluations().force == second.simulation.evaluations().force);
  CHECK(whole.simulation.evaluations().kepler == second.simulation.evaluations().kepler);
}

template <class Real> void check_all_hamiltonians(const Scheme& scheme, std::int64_t n) {
  const Gravity gravity{.G = test::outer_G};
  for (const bool compensated : {false, true}) {
    CAPTURE(scheme.name, compensated);
    check_restart<Real>(compose(test::kinetic_potential<Real>(gravity), scheme, {.compensated = compensated}), n);
    check_restart<Real>(compose(test::wisdom_holman<Real>({.G = test::outer_G}), scheme, {.compensated = compensated}),
                        n);
    const auto democratic = test::wisdom_holman<Real>({.G = test::outer_G, .coordinates = Coordinates::democratic});
    if (scheme.scheme_class != SchemeClass::rkn) {
      check_restart<Real>(compose(democratic, scheme, {.compensated = compensated}), n);
    }
    if (scheme.is_composition() || scheme.exact.find('B') == std::string_view::npos) {
      for (const Coordinates coordinates : {Coordinates::whds, Coordinates::barycentric}) {
        if (scheme.scheme_class == SchemeClass::rkn) continue;
        const auto scaled = test::wisdom_holman<Real>({.G = test::outer_G, .coordinates = coordinates});
        check_restart<Real>(compose(scaled, scheme, {.compensated = compensated}), n);
      }
    }
    const auto driven = test::wisdom_holman<Real>({.G = test::outer_G}, UniformField{.acceleration = {1e-8, 0, 2e-8}},
                                                  OscillatingField{.acceleration = {1e-7, 0, 2e-7}, .omega = 0.03});
    check_restart<Real>(compose(driven, scheme, {.compensated = compensated}), n);
    if (scheme.has_negative_steps()) continue;
    const LinearDrag drag{.rate = 1e-4};
    const auto inertial = test::kinetic_potential<Real>(gravity);
    check_restart<Real>(compose(test::damped(inertial, drag), scheme, {.compensated = compensated}), n);
    check_restart<Real>(compose(test::damped(driven, drag), scheme, {.compensated = compensated}), n);
  }
}

}  // namespace

TEST_CASE("a run saved, rebuilt and restored goes on bit for bit, for every scheme over every Hamiltonian",
          "[restart]") {
  for (const Scheme* scheme : schemes::all()) check_all_hamiltonians<double>(*scheme, 37);
}

TEST_CASE("the same in Quad", "[restart]") {
  for (const char* name : {"verlet", "symplectic_euler_a", "aba_10_6_4", "abah_8_6_4"}) {
    check_all_hamiltonians<Quad>(*schemes::find(name), 8);
  }
}

TEST_CASE("runs with correctors and kernels go on bit for bit", "[restart]") {
  const StepKernel kernels[] = {StepKernel::plain, StepKernel::modified, StepKernel::composed, StepKernel::lazy};
  for (const StepKernel kernel : kernels) {
    for (const bool compensated : {false, true}) {
      CAPTURE(static_cast<int>(kernel), compensated);
      const CompositionOptions options{.compensated = compensated,
                                       .corrector = 17,
                                       .kernel = kernel,
                                       .second_corrector = kernel != StepKernel::plain};
      const auto arcs = test::wisdom_holman({.G = test::outer_G});
      check_restart<double>(compose(arcs, schemes::verlet_aba, options), 20);
      check_restart<double>(compose(arcs, schemes::verlet, options), 20);
    }
  }
  const auto arcs = test::wisdom_holman({.G = test::outer_G});
  check_restart<double>(compose(arcs, schemes::saba_3, {.kernel = StepKernel::modified}), 20);
  Simulation plain(test::outer_planets(), compose(arcs, schemes::verlet_aba), 40.0);
  Simulation corrected(test::outer_planets(), compose(arcs, schemes::verlet_aba, {.corrector = 7}), 40.0);
  CHECK_THROWS_WITH(corrected.restore(plain.save()),
                    "the saved run has no corrector or kernel, but this one has corrector = 7");
  CHECK_THROWS_WITH(plain.restore(corrected.save()),
                    "the saved run has corrector = 7, but this one has no corrector or kernel");
}

TEST_CASE("runs of states of two words go on with the bits of both, and with every report", "[restart][two words]") {
  const Gravity gravity{.G = test::outer_G};
  const OscillatingField wind{.acceleration = {1e-9, 0, 2e-9}, .omega = 0.003};
  for (const char* name : {"encke_gauss_8", "wide_gauss_8"}) {
    CAPTURE(name);
    for (const std::int64_t n : {1, 23}) {
      check_restart<double>(test::classical_over(test::field_of(gravity), method(name)), n);
      check_restart<double>(test::classical_over(test::field_of(gravity, wind), method(name)), n);
    }
  }
}

TEST_CASE("a restored run of another scheme, step or set of particles is refused", "[restart]") {
  const auto gravity = test::kinetic_potential(Gravity{.G = test::outer_G});
  Simulation run(test::outer_planets(), compose(gravity, schemes::verlet), 40.0);
  CHECK(run.run(3).ok());
  const SavedRun saved = run.save();

  Simulation other_scheme(test::outer_planets(), compose(gravity, schemes::verlet_aba), 40.0);
  CHECK_THROWS_WITH(other_scheme.restore(saved),
                    "the saved run was made by method 'verlet', but this one uses 'verlet_aba'");
  Simulation other_force(
      test::outer_planets(),
      compose(test::kinetic_potential(Gravity{.G = test::outer_G, .softening = 0.5}), schemes::verlet), 40.0);
  CHECK_THROWS_WITH(other_force.restore(saved),
                    "the saved run was made with gravity(G = 0.000295912208286, softening = 0), but this one has "
                    "gravity(G = 0.000295912208286, softening = 0.5)");
  Simulation compensated(test::outer_planets(), compose(gravity, schemes::verlet, {.compensated = true}), 40.0);
  CHECK_THROWS_WITH(compensated.restore(saved), "the saved run sums without compensation, but this one with it");
  Simulation other_step(test::outer_planets(), compose(gravity, schemes::verlet), 20.0);
  CHECK_THROWS_WITH(other_step.restore(saved), "the saved run has a step of 40, but this one has 20");
  auto fewer = test::outer_planets();
  fewer.remove(5);
  Simulation other_particles(std::move(fewer), compose(gravity, schemes::verlet), 40.0);
  CHECK_THROWS_WITH(other_particles.restore(saved), "the saved run has different particles from this one");
  Simulation more_monitors(test::outer_planets(), compose(gravity, schemes::verlet), 40.0);
  more_monitors.every(1, Energy{});
  CHECK_THROWS_WITH(more_monitors.restore(saved), "the saved run has no part 'energy'; it was made with other parts");
}
