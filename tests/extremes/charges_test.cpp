/// Charges where steps see nothing of the gyration, at the speed of light, in fields that are infinite or zero: right,
/// or a named end.

#include "tests/support/charges.hpp"
#include "engine/simulation.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/k_symplectic.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

namespace noether {
namespace {

using test::in_field;
using test::one_charge;

struct End {
  Outcome outcome;
  double energy_error;
  Vec3<double> x, v;
};

End end_of(ParticleSystem<double> s, AnyIntegrator<double> by, double h, std::int64_t steps) {
  Simulation sim(std::move(s), std::move(by), h);
  auto& energy = sim.every(1, Energy{});
  const Outcome outcome = sim.run(steps);
  return {outcome, energy.worst(), sim.particles().positions()[0], sim.particles().velocities()[0]};
}

}  // namespace

TEST_CASE("angles of a step from 1e-8 to 1e9: speeds are kept", "[extremes][charges]") {
  for (const ChargedParticlesOptions& options :
       {ChargedParticlesOptions{}, ChargedParticlesOptions{.rotation = Rotation::boris},
        ChargedParticlesOptions{.rotation = Rotation::hyper_boris, .cycles = 5, .gyrophase_order = 8}}) {
    for (const double B : {1e-8, 1.0, 1e3, 1e9}) {
      CAPTURE(B, static_cast<int>(options.rotation));
      const End end = end_of(
          one_charge({0.3, 0.2, 0.1}, {0.3, -0.4, 1.2}),
          compose(in_field(UniformElectromagnetic{.B = {0.6 * B, 0, 0.8 * B}}, options), schemes::verlet_aba), 1, 1000);
      REQUIRE(end.outcome.ok());
      CHECK(end.energy_error < 1e-12);
      CHECK(std::abs(dot(end.v, Vec3<double>(0.6, 0, 0.8)) / 1.14 - 1) <= 1e-11);
    }
  }
}

TEST_CASE("without a charge, without a field, and with other forces alone", "[extremes][charges]") {
  const End neutral = end_of(one_charge({5, 0, 0}, {0.1, 0.2, 0.3}, 0),
                             compose(in_field(MagneticDipole{.moment = {0, 0, 1e6}}), schemes::verlet_aba), 0.5, 100);
  CHECK((neutral.v - Vec3<double>(0.1, 0.2, 0.3)).norm() == 0);
  const End free = end_of(one_charge({5, 0, 0}, {0.1, 0.2, 0.3}),
                          compose(in_field(UniformElectromagnetic{}), *schemes::find("blanes_moan_s6")), 0.5, 100);
  CHECK((free.v - Vec3<double>(0.1, 0.2, 0.3)).norm() == 0);
}

TEST_CASE("on the axis of a dipole and of a mirror, and in the middle of one, where nothing is finite",
          "[extremes][charges]") {
  const MagneticDipole dipole{.moment = {0, 0, 10}};
  for (const Rotation rotation : {Rotation::exact, Rotation::boris}) {
    const End along = end_of(one_charge({0, 0, 2}, {0, 0, 0.1}),
                             compose(in_field(dipole, {.rotation = rotation}), schemes::verlet_aba), 0.1, 100);
    REQUIRE(along.outcome.ok());
    CHECK(std::abs(along.x[2] / 3 - 1) <= 1e-14);
    CHECK(std::hypot(along.x[0], along.x[1]) == 0);
    const End center = end_of(one_charge({0, 0, 1.125}, {0, 0, -0.25}),
                              compose(in_field(dipole, {.rotation = rotation}), schemes::verlet_aba), 1, 100);
    CHECK_FALSE(center.outcome.ok());
    CHECK_THAT(to_text(center.outcome), Catch::Contains("not finite"));
  }
  const MagneticMirror mirror{.B0 = 5, .radius = 1, .distance = 3};
  const End through =
      end_of(one_charge({0, 0, -4}, {0, 0, 1}), compose(in_field(mirror), schemes::verlet_aba), 0.01, 800);
  REQUIRE(through.outcome.ok());
  CHECK(std::abs(through.x[2] / 4 - 1) <= 1e-12);
  // Gauss's method takes derivatives there too.
  ForceField<double> forces;
  forces.add(InField(mirror));
  const End gauss = end_of(one_charge({0, 0, -1}, {0.01, 0, 0.1}),
                           classical(forces, method("gauss_4", {.adaptive = false})), 0.01, 200);
  CHECK(gauss.outcome.ok());
  CHECK(gauss.energy_error < 1e-12);
}

TEST_CASE("electric fields above c B: gamma grows without an end, and the energy is kept", "[extremes][charges]") {
  for (const Relativistic how : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
    CAPTURE(static_cast<int>(how));
    const UniformElectromagnetic field{.E = {0, 3, 0}, .B = {0, 0, 1}};
    const End end =
        end_of(one_charge({0, 0, 0}, {0, 0, 0}),
               compose(in_field(field, {.relativistic = how, .c = 1.0}), schemes::verlet_aba), 0.01, 20'000);
    REQUIRE(end.outcome.ok());
    CHECK(end.v.norm() < 1);
    CHECK(end.v.norm() > 0.99999);
    CHECK(end.energy_error < 1e-3);
  }
}

TEST_CASE("gamma of a million, turned by a thousand radians a step", "[extremes][charges]") {
  const double v = 0.9999999999995;
  for (const Relativistic how : {Relativistic::boris, Relativistic::vay, Relativistic::higuera_cary}) {
    CAPTURE(static_cast<int>(how));
    const UniformElectromagnetic field{.B = {0, 0, 1e9}};
    const End end = end_of(one_charge({0, 0, 0}, {v, 0, 0}),
                           compose(in_field(field, {.relativistic = how, .c = 1.0}), schemes::verlet_aba), 1, 1000);
    REQUIRE(end.outcome.ok());
    // Vay's step goes by way of u + v x Omega h/2, in which an angle of 1e3 takes three digits.
    CHECK(end.energy_error < (how == Relativistic::vay ? 1e-8 : 1e-11));
    CHECK(std::abs(end.v.norm() / v - 1) <= 1e-15);
  }
}

TEST_CASE("one direction after the other, beyond what its steps resolve", "[extremes][charges]") {
  // X Y Z with h omega = 3 is past its limit of 2: the speed grows, and the run ends by name or is not believed.
  const AnyHamiltonian<double> h = [] {
    ForceField<double> forces;
    forces.add(InField(UniformElectromagnetic{.B = {0, 0, 1}}));
    return KSymplectic<ForceField<double>>(std::move(forces));
  }();
  const End inside = end_of(one_charge({0, 0, 0}, {1, 0, 0}), compose(h, schemes::verlet), 1.9, 10'000);
  REQUIRE(inside.outcome.ok());
  CHECK(inside.energy_error < 20);
  const End outside = end_of(one_charge({0, 0, 0}, {1, 0, 0}), compose(h, schemes::verlet), 2.1, 10'000);
  CHECK_FALSE(outside.outcome.ok());
}

}  // namespace noether
