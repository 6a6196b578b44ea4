/// What stands around an integrator: what it does not change goes through, its state is saved as it describes itself.

#include "integrators/wrapped.hpp"

#include "engine/simulation.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/all_schemes.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/energy_projection.hpp"
#include "tests/support/planets.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::around;
using test::EnergyProjection;

ParticleSystem<double> start() {
  ParticleSystem<double> s;
  s.add("one", 1, {0.1, 0.2, 0}, {0.3, -0.1, 0});
  return s;
}

AnyIntegrator<double> splitting(const Scheme& scheme = schemes::verlet) {
  return compose(test::kinetic_potential(HenonHeiles{}), scheme);
}
AnyIntegrator<double> adaptive() { return test::classical_over(HenonHeiles{}, method("dop853", {.rtol = 1e-5})); }

/// Changes nothing.
struct Plain : Wrapped<AnyIntegrator<double>> {
  using Wrapped<AnyIntegrator<double>>::Wrapped;
};
/// Forgets that a run may be asked for its action.
struct Careless : Plain {
  using Plain::Plain;
  Advance advance(ParticleSystem<double>& s, const Span& span) { return integrator_.advance(s, span); }
};
struct Careful : Careless {
  using Careless::Careless;
  bool has_action() const { return false; }
};

/// Counts the steps that go through it.
struct Counting : Wrapped<AnyIntegrator<double>> {
  using Wrapped<AnyIntegrator<double>>::Wrapped;
  static constexpr auto describe() {
    return part<Counting>("counting", "counts steps", field<&Counting::by>("by", "1"),
                          state<&Counting::count>("count"));
  }
  Advance advance(ParticleSystem<double>& s, const Span& span) {
    const Advance made = integrator_.advance(s, span);
    count += by * made.steps;
    return made;
  }
  bool has_action() const { return false; }

  std::int64_t by = 1, count = 0;
};

/// Makes a v + b of every velocity along x after each step.
struct Linear : Wrapped<AnyIntegrator<double>> {
  Linear(AnyIntegrator<double> inside, double a_, double b_) : Wrapped(std::move(inside)), a(a_), b(b_) {}
  Advance advance(ParticleSystem<double>& s, const Span& span) {
    Span one = span;
    one.steps = 1;
    const Advance made = integrator_.advance(s, one);
    ParticleSystem<double> now = s;
    integrator_.settle(s, now, {}, std::nullopt, true);
    const Vec3<double> v = now.velocities()[0];
    now.velocities().set(0, {a * v[0] + b, v[1], v[2]});
    continue_from(now, s);
    return made;
  }
  bool has_action() const { return false; }

  double a, b;
};

/// A letter that counts drifts, and writes nothing to be saved.
struct Drifts : Wrapped<AnyHamiltonian<double>> {
  using Wrapped<AnyHamiltonian<double>>::Wrapped;
  static constexpr auto describe() { return part<Drifts>("drifts", "counts drifts", state<&Drifts::count>("count")); }
  void flow(char letter, ParticleSystem<double>& s, const double& h) {
    if (letter == 'A') ++count;
    hamiltonian_.flow(letter, s, h);
  }

  std::int64_t count = 0;
};

}  // namespace

TEST_CASE("what changes nothing is the integrator inside it, bit for bit", "[integrators][wrapped]") {
  for (const bool free : {false, true}) {
    AnyIntegrator<double> bare = free ? adaptive() : splitting(schemes::yoshida_4);
    AnyIntegrator<double> wrapped = Plain(free ? adaptive() : splitting(schemes::yoshida_4));
    CHECK(wrapped.has_action() == bare.has_action());
    CHECK(wrapped.claims().method == bare.claims().method);
    CHECK(wrapped.claims().symplectic == bare.claims().symplectic);
    const Clock<double> clock = free ? Clock<double>::free(0) : Clock<double>::fixed(0, 0.1);
    Simulation<double> one(start(), bare, clock), other(start(), wrapped, clock);
    REQUIRE(one.run(50).ok());
    REQUIRE(other.run(50).ok());
    CHECK(test::same_bits(one.particles(), other.particles()));
    CHECK(one.evaluations().force == other.evaluations().force);
    const SavedRun saved = other.save();
    SavedState inside;
    for (const auto& [name, array] : saved.parts.at("integrator")) {
      REQUIRE(name.starts_with("inside/"));
      inside[name.substr(7)] = array;
    }
    CHECK(one.save().parts.at("integrator") == inside);
  }
}

TEST_CASE("an action is told by what goes through alone", "[integrators][wrapped]") {
  STATIC_REQUIRE(detail::action_follows<Plain>());
  STATIC_REQUIRE_FALSE(detail::action_follows<Careless>());
  STATIC_REQUIRE(detail::action_follows<Careful>());
  STATIC_REQUIRE(detail::action_follows<AnyIntegrator<double>>());
  AnyIntegrator<double> plain = Plain(splitting()), careful = Careful(splitting());
  CHECK(plain.has_action());
  CHECK_FALSE(careful.has_action());
}

TEST_CASE("state and fields around an integrator are saved as they are described", "[integrators][wrapped]") {
  const auto run = [](std::int64_t by) {
    Counting counting(splitting());
    counting.by = by;
    return Simulation<double>(start(), counting, 0.1);
  };
  Simulation<double> whole = run(2), resumed = run(2), other = run(3);
  REQUIRE(whole.run(5).ok());
  const SavedRun saved = whole.save();
  CHECK(std::get<std::vector<std::int64_t>>(saved.parts.at("integrator").at("count")) == std::vector<std::int64_t>{10});
  resumed.restore(saved);
  REQUIRE(resumed.run(5).ok());
  CHECK(std::get<std::vector<std::int64_t>>(resumed.save().parts.at("integrator").at("count")) ==
        std::vector<std::int64_t>{20});
  CHECK_THROWS_WITH(other.restore(saved),
                    "the saved run was made with counting(by = 2), but this one has counting(by = 3)");
}

TEST_CASE("state around a Hamiltonian is saved as it is described", "[integrators][wrapped]") {
  const auto run = [] {
    return Simulation<double>(start(), compose(Drifts(test::kinetic_potential(HenonHeiles{})), schemes::verlet), 0.1);
  };
  Simulation<double> whole = run(), resumed = run();
  REQUIRE(whole.run(5).ok());
  const SavedRun saved = whole.save();
  resumed.restore(saved);
  CHECK(resumed.save().parts == saved.parts);
  bool found = false;
  for (const auto& [name, array] : saved.parts.at("integrator")) {
    if (!name.ends_with("/count")) continue;
    found = true;
    CHECK(std::get<std::vector<std::int64_t>>(array) == std::vector<std::int64_t>{5});
  }
  CHECK(found);
}

TEST_CASE("a decorator from outside holds the energy, in programs and in 113 bits", "[integrators][wrapped]") {
  const auto worst = [](AnyIntegrator<double> integrator, const Clock<double>& clock) {
    Simulation<double> sim(start(), std::move(integrator), clock);
    auto& energy = sim.every(1, Energy());
    REQUIRE(sim.run(200).ok());
    return energy.report().worst;
  };
  const auto fixed = Clock<double>::fixed(0, 0.1), free = Clock<double>::free(0);
  CHECK(worst(around(EnergyProjection{.steps = 1}, splitting()), fixed) < 1e-14);
  CHECK(worst(splitting(), fixed) > 1e-6);
  CHECK(worst(around(EnergyProjection{.steps = 1}, adaptive()), free) < 1e-14);
  CHECK(worst(adaptive(), free) > 1e-9);

  auto wide =
      around(EnergyProjection{.steps = 3}, compose(test::kinetic_potential<Quad>(HenonHeiles{}), schemes::verlet));
  const ParticleSystem<Quad> s = start().as<Quad>(), after = test::run(wide, s, 0.1, 9);
  CHECK(abs(wide.energy(after).total() - wide.energy(s).total()) < Quad(1e-30));
  CHECK(wide.times() == 3);
  CHECK(abs(wide.added()) > Quad(1e-8));
}

TEST_CASE("of two decorators the inner one comes first", "[integrators][wrapped]") {
  const auto end = [](AnyIntegrator<double> integrator) {
    return test::run(integrator, start(), 0.1, 1).velocities()[0][0];
  };
  const double bare = end(splitting());
  CHECK(end(Linear(Linear(splitting(), 1, 0.5), 2, 0)) == 2 * (bare + 0.5));
  CHECK(end(Linear(Linear(splitting(), 2, 0), 1, 0.5)) == 2 * bare + 0.5);
}

}  // namespace noether
