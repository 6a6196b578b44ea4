/// What every method and scheme keeps where its steps are projected, and a claim about projections that is printed.

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/projected.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/kepler_pair.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace noether {
namespace {

/// Every method and every scheme that can move a pair, by steps of one length where it has both.
std::vector<AnyIntegrator<double>> every_integrator(std::vector<std::string>& refused) {
  std::vector<AnyIntegrator<double>> all;
  const AnyHamiltonian<double> pair = test::kinetic_potential(Gravity{});
  for (const Scheme* scheme : schemes::all()) {
    try {
      all.emplace_back(compose(pair, *scheme));
    } catch (const SchemeMismatch& error) {
      refused.push_back(error.message());
    }
  }
  for (const MethodInfo* info : methods::all()) {
    MethodOptions options;
    if (info->fixed && info->adaptive) options.adaptive = false;
    all.emplace_back(test::classical_over(Gravity{}, MethodChoice{info, options}));
    if (!info->fixed || !info->adaptive) continue;
    all.emplace_back(test::classical_over(Gravity{}, MethodChoice{info, {}}));
  }
  return all;
}

Vec3<double> linear_momentum_of_pair(const ParticleSystem<double>& s) {
  return s.masses()[0] * Vec3<double>(s.velocities()[0]) + s.masses()[1] * Vec3<double>(s.velocities()[1]);
}

/// Twenty steps of a pair that drifts and turns about the origin. @return "" or the reason of a refusal
std::string keeps_its_invariants(const AnyIntegrator<double>& bare, const ProjectionOptions& options) {
  ParticleSystem<double> start = test::pairs::kepler_pair(0.3);
  for (Index i = 0; i < 2; ++i) {
    start.velocities().set(i, Vec3<double>(start.velocities()[i]) + Vec3<double>(0.1, -0.2, 0.3));
    start.positions().set(i, Vec3<double>(start.positions()[i]) + Vec3<double>(0.2, 0.1, -0.4));
  }
  const bool free = bare.claims().clock == ClockMode::free;
  std::optional<Simulation<double>> sim;
  try {
    sim.emplace(start, AnyIntegrator<double>(projected(bare, options)),
                free ? Clock<double>::free(0) : Clock<double>::fixed(0, 0.04));
  } catch (const SchemeMismatch& error) {
    return error.message();
  }
  const Outcome outcome = sim->run(20);
  INFO(outcome.message);
  CHECK(outcome.ok());
  const ParticleSystem<double>& s = sim->particles();
  if (options.has(Invariant::energy))
    CHECK(std::abs(test::pairs::energy_of(s) - test::pairs::energy_of(start)) < 2e-14);
  if (options.has(Invariant::momentum))
    CHECK((linear_momentum_of_pair(s) - linear_momentum_of_pair(start)).norm() < 2e-14);
  if (options.has(Invariant::angular_momentum)) {
    CHECK((test::pairs::angular_momentum_of_pair(s) - test::pairs::angular_momentum_of_pair(start)).norm() < 2e-14);
  }
  return "";
}

/// Symplectic Euler that differs by coordinate: kick before drift in x, drift before kick in y and z. It is symplectic,
/// but not the same in a turned frame.
class MixedEuler {
 public:
  using real = double;

  explicit MixedEuler(AnyHamiltonian<double> hamiltonian) : hamiltonian_(std::move(hamiltonian)) {}
  IntegratorClaims claims() const {
    return {.method = "mixed_euler",
            .hamiltonian = "gravity",
            .order = 1,
            .symplectic = true,
            .keeps_angular_momentum = false};
  }
  void bind(ParticleSystem<double>& s) {
    hamiltonian_.bind(s);
    a_ = VectorColumn<double>(s.size());
  }
  Advance advance(ParticleSystem<double>& s, const Span& span) {
    const double h = s.clock().dt();
    for (std::int64_t n = 0; n < span.steps; ++n) {
      drift(s, {0, h, h});
      hamiltonian_.accelerations(s, a_);
      for (Index i = 0; i < s.size(); ++i) {
        s.velocities().set(i, Vec3<double>(Vec3<double>(s.velocities()[i]) + h * Vec3<double>(a_[i])));
      }
      drift(s, {h, 0, 0});
      s.clock().tick(0);
    }
    return {.steps = span.steps};
  }
  void settle(const ParticleSystem<double>& raw, ParticleSystem<double>& out, Request, std::optional<double>, bool) {
    out.assign_state(raw);
  }
  EnergyTerms<double> energy(const ParticleSystem<double>& s) { return hamiltonian_.energy(s); }
  void accelerations(const ParticleSystem<double>& s, VectorColumn<double>& a) { hamiltonian_.accelerations(s, a); }
  Evaluations evaluations() const { return hamiltonian_.evaluations(); }

 private:
  static void drift(ParticleSystem<double>& s, const Vec3<double>& h) {
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
      s.positions().set(i, Vec3<double>(x[0] + h[0] * v[0], x[1] + h[1] * v[1], x[2] + h[2] * v[2]));
    }
  }

  AnyHamiltonian<double> hamiltonian_;
  VectorColumn<double> a_;
};

/// The largest error of the energy of the relative motion, which is -1/2, at every fifth step.
double worst_energy_of_relative_motion(AnyIntegrator<double> integrator, int steps) {
  const ParticleSystem<double> start = test::pairs::kepler_pair();
  Simulation<double> sim(start, std::move(integrator), test::pairs::turn / 500);
  const double before = test::pairs::energy_of(start);
  double worst = 0;
  for (int n = 0; n < steps; n += 5) {
    REQUIRE(sim.run(5).ok());
    worst = std::max(worst, std::abs(test::pairs::energy_of(sim.particles()) / before - 1) / 2);
  }
  return worst;
}

}  // namespace

TEST_CASE("every method keeps what its steps are projected onto, or is refused by name", "[integrators][projected]") {
  using enum Invariant;
  std::vector<std::string> refused;
  const std::vector<AnyIntegrator<double>> all = every_integrator(refused);
  REQUIRE(all.size() > 100);
  for (const AnyIntegrator<double>& bare : all) {
    const IntegratorClaims claims = bare.claims();
    CAPTURE(claims.method, static_cast<int>(claims.clock));
    for (const std::vector<Invariant>& onto :
         {std::vector{energy}, std::vector{momentum}, std::vector{angular_momentum},
          std::vector{energy, momentum, angular_momentum}}) {
      CHECK(keeps_its_invariants(bare, {.onto = onto}) == "");
    }
    CHECK(keeps_its_invariants(bare, {.onto = {energy}, .how = Projection::oblique, .moves = Moves::velocities}) == "");
    const bool can = claims.clock == ClockMode::fixed && claims.memory == Memory::none;
    const std::string symmetric =
        keeps_its_invariants(bare, {.onto = {energy, angular_momentum}, .how = Projection::symmetric});
    CHECK((symmetric == "") == can);
    if (!can) CHECK(symmetric.find("'" + claims.method + "'") != std::string::npos);
  }
}

TEST_CASE(
    "C20: onto the angular momentum few iterations are enough, and the energy gets worse after a base that is not "
    "invariant",
    "[integrators][projected][claims]") {
  const auto onto = [](AnyIntegrator<double> base) {
    return projected(std::move(base), {.onto = {Invariant::angular_momentum}, .tolerance = 2e-14});
  };
  const AnyHamiltonian<double> pair = test::kinetic_potential(Gravity{});
  const int turns = 20, steps = 500 * turns;
  const double bare = worst_energy_of_relative_motion(MixedEuler(pair), steps),
               held = worst_energy_of_relative_motion(onto(MixedEuler(pair)), steps);
  CAPTURE(bare, held);
  CHECK(bare > 0.055);
  CHECK(bare < 0.068);
  CHECK(held > 0.4);
  CHECK(held < 0.6);
  const auto mean = [&](AnyIntegrator<double> base) {
    Simulation<double> sim(test::pairs::kepler_pair(), onto(std::move(base)), test::pairs::turn / 500);
    REQUIRE(sim.run(steps).ok());
    return sim.evaluations().projection.mean();
  };
  CHECK(mean(test::classical_over(Gravity{}, method("rk4"))) < 0.7);
  CHECK(mean(test::classical_over(Gravity{}, method("euler"))) < 2.2);  // 1.1 over 200 turns: it spirals out
  CHECK(mean(compose(pair, schemes::verlet)) < 0.01);
}

}  // namespace noether
