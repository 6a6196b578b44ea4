/// What every method keeps, measured and compared with what it claims, over every Hamiltonian.

#include "forces/oblateness.hpp"
#include "integrators/damped.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/problems.hpp"

namespace noether {
namespace {

using namespace noether::test;

struct Kept {
  double momentum, angular_momentum, energy, reversibility;
};

Vec3<Quad> momentum_of(const ParticleSystem<Quad>& s) {
  Vec3<Quad> sum = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) sum += s.masses()[i] * s.velocities()[i];
  return sum;
}
Vec3<Quad> angular_momentum_of(const ParticleSystem<Quad>& s) {
  Vec3<Quad> sum = Vec3<Quad>::Zero();
  for (Index i = 0; i < s.size(); ++i) {
    sum += s.masses()[i] * cross(Vec3<Quad>(s.positions()[i]), Vec3<Quad>(s.velocities()[i]));
  }
  return sum;
}

double change_between(const Vec3<Quad>& a, const Vec3<Quad>& b) {
  return std::sqrt(static_cast<double>(norm2(Vec3<Quad>(a - b))));
}

/// Twenty steps forth, and back again.
template <class I> Kept measured(const I& integrator, const ParticleSystem<double>& start, double dt) {
  Simulation<Quad> sim(start.as<Quad>(), integrator, dt);
  const ParticleSystem<Quad> before = sim.particles();
  I probe = integrator;
  ParticleSystem<Quad> bound = before;
  bound.clock() = Clock<Quad>::fixed(0, dt);
  probe.bind(bound);
  const Quad energy = probe.energy(bound).total();
  REQUIRE(sim.run(20).ok());
  const ParticleSystem<Quad> after = sim.particles();
  ParticleSystem<Quad> there = after;
  there.clock() = Clock<Quad>::fixed(0, dt);
  I other = integrator;
  other.bind(there);
  Kept kept{};
  kept.momentum = change_between(momentum_of(after), momentum_of(before));
  kept.angular_momentum = change_between(angular_momentum_of(after), angular_momentum_of(before));
  kept.energy = std::fabs(static_cast<double>(other.energy(there).total() - energy));
  sim.change_step(-dt);
  REQUIRE(sim.run(20).ok());
  kept.reversibility = distance_of_states(sim.particles(), before);
  return kept;
}

/// 113 bits leave 1e-30 of what is kept; what is not kept shows at these steps by far more.
constexpr double kept_to = 1e-27, lost_from = 1e-22;

void compare(double error, bool claimed, const char* what) {
  INFO(what << ": 10^" << std::log10(error) << (claimed ? ", claimed" : ", not claimed"));
  CHECK((claimed ? error < kept_to : error > lost_from));
}

template <class H> void check_kept(const H& hamiltonian, const ParticleSystem<double>& start, double dt) {
  for (const Scheme* scheme : schemes::all()) {
    std::optional<Composition<H>> integrator;
    try {
      integrator.emplace(hamiltonian, *scheme);
    } catch (const SchemeMismatch&) {
      continue;
    }
    const IntegratorClaims claims = integrator->claims();
    INFO(scheme->name << " over " << claims.hamiltonian);
    // Nobody can keep all three (Ge and Marsden 1988).
    CHECK_FALSE((claims.symplectic && claims.energy_exact && claims.keeps_momentum && claims.keeps_angular_momentum));
    const Kept kept = measured(*integrator, start, dt);
    compare(kept.momentum, claims.keeps_momentum, "momentum");
    compare(kept.angular_momentum, claims.keeps_angular_momentum, "angular momentum");
    compare(kept.energy, claims.energy_exact, "energy");
    compare(kept.reversibility, claims.reversible, "way back");
  }
}

TEST_CASE("every method keeps what it claims, and no more, over drifts and kicks", "[conservation][claims]") {
  check_kept(kinetic_potential<Quad>(Gravity{.G = 1.0}), planets(0.1, 2), 0.1);
  check_kept(kinetic_potential<Quad>(Gravity{.G = 1.0}, HarmonicField{0.3}), planets(0.1, 2), 0.1);
  check_kept(kinetic_potential<Quad>(Gravity{.G = 1.0}, UniformField{{0.1, 0.2, -0.3}}), planets(0.1, 2), 0.1);
}

TEST_CASE("every method keeps what it claims, and no more, over Kepler arcs", "[conservation][claims]") {
  for (const Coordinates coordinates :
       {Coordinates::jacobi, Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    check_kept(wisdom_holman<Quad>({.coordinates = coordinates}), planets(0.01, 2), 0.3);
    // Weak, as the planets are light: bodies keep their order, by which Jacobi coordinates go.
    const HarmonicField around{0.01};
    check_kept(wisdom_holman<Quad>({.coordinates = coordinates}, around), planets(0.01, 2), 0.3);
    const Oblateness flattened{.J2 = 0.1, .radius = 0.3};
    check_kept(wisdom_holman<Quad>({.coordinates = coordinates}, flattened), planets(0.01, 2), 0.3);
  }
}

TEST_CASE("every method keeps what it claims, and no more, under constraints", "[conservation][claims][constraints]") {
  const Mechanism bars = free_chain(3), pendulum = double_pendulum(), chain = hanging_chain(3);
  check_kept(KineticPotential<Gravity, Quad, ConstraintSet>(Gravity{.G = 0.5}, bars.constraints), bars.particles, 0.1);
  check_kept(hamiltonian_of<Quad>(pendulum), pendulum.particles, 0.02);
  // Held at the origin: no momentum, but angular momentum is kept.
  check_kept(KineticPotential<Gravity, Quad, ConstraintSet>(Gravity{.G = 2}, chain.constraints), chain.particles, 0.05);
}

TEST_CASE("what drag takes away is claimed by nobody", "[conservation][claims]") {
  const auto damped = test::damped(kinetic_potential<Quad>(Gravity{.G = 1.0}), {.rate = 0.1});
  const auto integrator = compose(damped, schemes::verlet);
  const IntegratorClaims claims = integrator.claims();
  CHECK_FALSE((claims.symplectic || claims.reversible || claims.keeps_momentum || claims.keeps_angular_momentum));
  const Kept kept = measured(integrator, planets(0.1, 2), 0.1);
  CHECK(kept.momentum > lost_from);
  CHECK(kept.angular_momentum > lost_from);
}

}  // namespace
}  // namespace noether
