/// The same bits for any cadence, number of threads, assembly and division of a run.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "monitors/monitors.hpp"
#include "numbers/parallel.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/settings.hpp"

using namespace noether;

namespace {

constexpr double G = test::outer_G;

template <class I>
ParticleSystem<double> final_state(ParticleSystem<double> particles, const I& integrator, double dt, std::int64_t steps,
                                   std::int64_t cadence, std::int64_t piece = 0) {
  Simulation simulation(std::move(particles), integrator, dt);
  if (cadence > 0) {
    simulation.every(cadence, Energy{});
    simulation.every(cadence + 1, AngularMomentum{});
  }
  for (std::int64_t done = 0; done < steps;) {
    const std::int64_t next = piece > 0 ? std::min(piece, steps - done) : steps;
    REQUIRE(simulation.run(next).ok());
    done += next;
  }
  return simulation.particles();
}

template <class I> void check_cadences(const I& integrator) {
  const auto bare = final_state(test::outer_planets(), integrator, 50.0, 210, 0);
  for (const std::int64_t cadence : {1, 7, 100}) {
    CAPTURE(cadence);
    CHECK(test::same_bits(bare, final_state(test::outer_planets(), integrator, 50.0, 210, cadence)));
  }
  CHECK(test::same_bits(bare, final_state(test::outer_planets(), integrator, 50.0, 210, 0, 13)));
  CHECK_FALSE(test::same_bits(bare, final_state(test::outer_planets(), integrator, 50.0, 209, 0)));
}

template <class Make> void check_threads(const Make& final_particles) {
  std::optional<ParticleSystem<double>> one;
  for (const int n : {1, 2, 3, 8}) {
    const test::Threads threads(n);
    const auto result = final_particles();
    CAPTURE(n);
    if (!one) one = result;
    CHECK(test::same_bits(*one, result));
  }
}

}  // namespace

TEST_CASE("outputs do not change the trajectory, nor does dividing a run", "[determinism]") {
  for (const char* name : {"verlet", "verlet_aba", "symplectic_euler_b", "blanes_moan_s6", "yoshida_8", "srkn14a"}) {
    CAPTURE(name);
    check_cadences(compose(test::kinetic_potential(Gravity{.G = G}), *schemes::find(name)));
    check_cadences(compose(test::kinetic_potential(Gravity{.G = G}), *schemes::find(name), {.compensated = true}));
  }
  for (const char* name : {"verlet", "verlet_aba", "saba_3", "aba_10_6_4", "abah_8_4_4"}) {
    CAPTURE(name);
    check_cadences(compose(test::wisdom_holman({.G = G}), *schemes::find(name)));
  }
  check_cadences(compose(test::wisdom_holman({.G = G, .coordinates = Coordinates::democratic}), schemes::abah_8_6_4));
}

TEST_CASE("any number of threads gives the same bits", "[determinism]") {
  check_threads([] {
    return final_state(test::cloud(300),
                       compose(test::kinetic_potential(Gravity{.G = 1, .softening = 0.05}), schemes::verlet), 0.01, 12,
                       5);
  });
  for (const Coordinates coordinates : {Coordinates::jacobi, Coordinates::democratic}) {
    check_threads([&] {
      return final_state(test::planets_with_tracers(400),
                         compose(test::wisdom_holman({.G = G, .coordinates = coordinates}), schemes::verlet_aba), 20.0,
                         12, 5);
    });
  }
}

TEST_CASE("matrix-free implicit steps have the same bits for any number of threads", "[determinism]") {
  for (const char* name : {"newmark", "bdf_2", "simo_tarnow_wong", "gonzalez"}) {
    check_threads([&] {
      return final_state(test::cloud(300),
                         test::classical_over(Gravity{.G = 1, .softening = 0.05},
                                              method(name, {.jacobian = JacobianForm::matrix_free})),
                         0.01, 4, 0);
    });
  }
}

TEST_CASE("steps too stiff for sweeps have the same bits for any number of threads", "[determinism]") {
  struct Way {
    const char* name;
    Index n;
    JacobianForm form;
  };
  for (const Way& way : {Way{"implicit_midpoint", 260, JacobianForm::matrix_free},
                         Way{"implicit_midpoint", 70, JacobianForm::dense}, Way{"gauss_4", 20, JacobianForm::dense}}) {
    CAPTURE(way.name, way.n);
    check_threads([&] {
      MethodOptions options{.jacobian = way.form};
      if (methods::find(way.name)->adaptive) options.adaptive = false;
      Simulation simulation(test::cloud(way.n), test::classical_over(HarmonicField{1e4}, method(way.name, options)),
                            0.1);
      REQUIRE(simulation.run(4).ok());
      REQUIRE(simulation.evaluations().jacobian >= 3);
      return simulation.particles();
    });
  }
}

TEST_CASE("the energy of many bodies has the same bits for any number of threads", "[determinism]") {
  std::optional<double> one;
  for (const int n : {1, 2, 3, 8}) {
    const test::Threads threads(n);
    Simulation simulation(test::cloud(300),
                          compose(test::kinetic_potential(Gravity{.G = 1, .softening = 0.05}), schemes::verlet), 0.01);
    auto& energy = simulation.every(1, Energy{});
    REQUIRE(simulation.run(3).ok());
    if (!one) one = energy.total();
    CHECK(*one == energy.total());
  }
}

TEST_CASE("forces known to the compiler and erased ones give the same bits", "[determinism]") {
  const Gravity gravity{.G = G};
  const Oblateness flat{.J2 = 0.01, .J4 = -1e-4, .radius = 0.5, .axis = {0.1, 0, 1}, .G = G};
  const UniformField field{.acceleration = {1e-9, 2e-9, 0}};
  ForceField forces;
  forces.add(gravity).add(flat).add(field);
  for (const char* name : {"verlet", "blanes_moan_s10"}) {
    const Scheme& scheme = *schemes::find(name);
    const auto program =
        final_state(test::outer_planets(), compose(KineticPotential(Sum(gravity, flat, field)), scheme), 30, 100, 9);
    const AnyHamiltonian<double> erased(KineticPotential<ForceField<double>>{forces});
    CHECK(test::same_bits(program, final_state(test::outer_planets(), compose(erased, scheme), 30, 100, 0)));
  }
  const auto program =
      final_state(test::outer_planets(), compose(WisdomHolman({.G = G}), schemes::aba_10_6_4), 30, 100, 9);
  const AnyHamiltonian<double> erased(WisdomHolman<double>({.G = G}));
  CHECK(test::same_bits(program, final_state(test::outer_planets(), compose(erased, schemes::aba_10_6_4), 30, 100, 0)));
}
