/// The loop that walks every scheme: merging, stage times, pending stages, correctors, refusals.

#include "integrators/composition.hpp"

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

namespace noether {
namespace {

using test::outer_G;

auto gravity() { return test::kinetic_potential(Gravity{.G = outer_G}); }

template <class H> std::string refusal(const H& hamiltonian, const Scheme& scheme) {
  try {
    compose(hamiltonian, scheme);
  } catch (const SchemeMismatch& e) {
    return e.what();
  }
  return "accepted";
}

/// Keeps the stage times at which it was asked.
struct Clocked {
  std::vector<double>* times;
  static ForceClaims claims() { return {.time_dependent = true}; }
  void add_to(ForceSink<double>& /*out*/, const ParticleSystem<double>& s) const { times->push_back(s.time()); }
};

/// Stage times of two steps of length 8 from time 0, and of the look after them.
std::vector<double> stage_times(const Scheme& scheme) {
  std::vector<double> times;
  Simulation run(test::outer_planets(), compose(test::kinetic_potential(Clocked{&times}), scheme), 8.0);
  CHECK(run.run(2).ok());
  run.particles();
  return times;
}

/// Letters of the stages in order.
template <class H> std::string letters(const Composition<H>& composition) {
  std::string all;
  for (const auto& stage : composition.stages()) all += stage.letter;
  return all;
}

ParticleSystem<double> glider(double v) {
  ParticleSystem<double> s;
  s.add("glider", 1, {0, 0, 0}, {v, 0, 0});
  return s;
}

/// Verlet as a processed method: half a kick, then n times drift and kick, then half a kick back.
Scheme processed_verlet() {
  Scheme scheme = alternating({.name = "processed_verlet", .order = {2}}, 'A', list(1_q), list(1_q));
  scheme.before.push_back({'B', 0.5_q});
  scheme.after.push_back({'B', -0.5_q});
  return scheme;
}

/// Largest |x - y| / |x| over all particles.
double difference(const ParticleSystem<double>& a, const ParticleSystem<double>& b) {
  double worst = 0;
  for (Index i = 0; i < a.size(); ++i) {
    const double dx = norm2(a.positions()[i] - b.positions()[i]) / norm2(a.positions()[i]);
    const double dv = norm2(a.velocities()[i] - b.velocities()[i]) / norm2(a.velocities()[i]);
    worst = std::max({worst, std::sqrt(dx), std::sqrt(dv)});
  }
  return worst;
}

constexpr double ulp = 0x1p-52;

}  // namespace

TEST_CASE("a run makes as many kicks as its scheme claims: equal neighbors are merged across steps", "[composition]") {
  const std::int64_t n = 11;
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(scheme->name);
    Simulation run(test::outer_planets(), compose(gravity(), *scheme), 1.0);
    CHECK(run.run(n).ok());
    // The half kick that the first step begins with is the one that is pending at the end.
    CHECK(run.evaluations().force == n * scheme->evaluations());
    run.particles();
    CHECK(run.evaluations().force == n * scheme->evaluations());
  }
}

TEST_CASE("merging stages changes nothing but rounding", "[composition]") {
  const double dt = 20;
  for (const char* name : {"verlet", "verlet_aba", "blanes_moan_s6", "yoshida_6", "symplectic_euler_a"}) {
    const Scheme& scheme = *schemes::find(name);
    CAPTURE(name);
    auto hamiltonian = gravity();
    ParticleSystem<double> walked = test::outer_planets();
    hamiltonian.bind(walked);
    for (int n = 0; n < 10; ++n) {
      for (const Stage& stage : scheme.word) {
        hamiltonian.flow(stage.letter, walked, static_cast<double>(stage.weight) * dt);
      }
    }
    Simulation run(test::outer_planets(), compose(gravity(), scheme), dt);
    CHECK(run.run(10).ok());
    CHECK(difference(walked, run.particles()) < 64 * ulp * std::sqrt(10.0 * static_cast<double>(scheme.word.size())));
  }
}

TEST_CASE("a stage is pending exactly where the word ends with the letter it begins with", "[composition]") {
  for (const Scheme* scheme : schemes::all()) {
    auto composition = compose(gravity(), *scheme);
    ParticleSystem<double> s = test::outer_planets();
    s.clock() = Clock<double>::fixed(0, 1);
    composition.bind(s);
    composition.advance(s, {.steps = 1});
    CAPTURE(scheme->name);
    CHECK(s.phase().pending == (scheme->word.front().letter == scheme->word.back().letter));
    CHECK(s.phase().opened);
    CHECK(s.clock().step() == 1);
    CHECK(s.time() == 1);
  }
}

TEST_CASE("forces see the time that the drifts before them have reached", "[composition]") {
  using Times = std::vector<double>;
  CHECK(stage_times(schemes::verlet) == Times{0, 8, 16});
  CHECK(stage_times(schemes::verlet_aba) == Times{4, 12});
  CHECK(stage_times(schemes::symplectic_euler_a) == Times{0, 8});
  CHECK(stage_times(schemes::symplectic_euler_b) == Times{8, 16});
  const Times ruth = stage_times(schemes::ruth_3);
  REQUIRE(ruth.size() == 6);
  CHECK(ruth[1] == 8 * (2.0 / 3));
  CHECK(ruth[3] == 8);
}

TEST_CASE("an oscillating field is integrated with the order of the scheme", "[composition]") {
  // x'' = cos(w t) has the solution x = (1 - cos w t)/w^2; autonomous schemes would show order 1.
  const double w = 0.9, T = 10;
  for (const auto& [name, order] :
       {std::pair{"verlet", 2}, {"verlet_aba", 2}, {"yoshida_4", 4}, {"blanes_moan_s6", 4}}) {
    std::array<double, 2> errors{};
    for (const int k : {0, 1}) {
      const std::int64_t n = 64 << k;
      const OscillatingField field{.acceleration = {1, 0, 0}, .omega = w};
      Simulation run(glider(0), compose(test::kinetic_potential(field), *schemes::find(name)),
                     T / static_cast<double>(n));
      CHECK(run.run(n).ok());
      errors[static_cast<std::size_t>(k)] =
          std::abs(std::as_const(run.particles()).positions()[0][0] - (1 - std::cos(w * T)) / (w * w));
    }
    CAPTURE(name, errors[0], errors[1]);
    CHECK(std::abs(std::log2(errors[0] / errors[1]) - order) < 0.2);
  }
}

TEST_CASE("settling completes a copy and leaves the run alone", "[composition]") {
  auto composition = compose(gravity(), schemes::verlet);
  ParticleSystem<double> s = test::outer_planets(), copy = s;
  composition.settle(s, copy, {}, std::nullopt, true);
  CHECK(test::same_bits(s, copy));
  s.clock() = Clock<double>::fixed(0, 40);
  composition.bind(s);
  composition.advance(s, {.steps = 3});
  const ParticleSystem<double> raw = s;
  composition.settle(s, copy, {.energy = true}, std::nullopt, true);
  CHECK(test::same_bits(s, raw));
  CHECK(s.phase() == raw.phase());
  CHECK(copy.phase() == Phase{});
  CHECK_FALSE(test::same_bits(s, copy));
  CHECK_THROWS_WITH(composition.settle(s, copy, {}, 1.0, true), "a composition can stop at whole steps only");
}

TEST_CASE("a look and the next kick share one evaluation of the forces", "[composition]") {
  std::vector<double> times;
  struct Look {
    void observe(const Snapshot<double>& now) const { now.state(); }
  };
  Simulation run(test::outer_planets(), compose(test::kinetic_potential(Clocked{&times}), schemes::verlet), 8.0);
  run.every(1, Look{});
  CHECK(run.run(10).ok());
  CHECK(times.size() == 11);
}

TEST_CASE("a processed method is its conjugate: Verlet from symplectic Euler", "[composition]") {
  const std::int64_t n = 50;
  Simulation processed(test::outer_planets(), compose(gravity(), processed_verlet()), 40.0);
  Simulation verlet(test::outer_planets(), compose(gravity(), schemes::verlet), 40.0);
  CHECK(processed.run(n).ok());
  CHECK(verlet.run(n).ok());
  CHECK(difference(processed.particles(), verlet.particles()) < 64 * ulp * std::sqrt(3.0 * n));
}

TEST_CASE("the word before the run is applied once, the word after it on what users see only", "[composition]") {
  struct Both {
    std::vector<ParticleSystem<double>>*mapped, *state;
    void observe(const Snapshot<double>& now) const {
      mapped->push_back(now.mapped());
      state->push_back(now.state());
    }
  };
  std::vector<ParticleSystem<double>> mapped, state;
  Simulation run(test::outer_planets(), compose(gravity(), processed_verlet()), 40.0);
  run.every(10, Both{&mapped, &state});
  CHECK(run.run(20).ok());
  REQUIRE(mapped.size() == 3);
  CHECK(test::same_bits(state[0], test::outer_planets()));

  auto hamiltonian = gravity();
  for (std::size_t k : {1U, 2U}) {
    ParticleSystem<double> corrected = mapped[k];
    hamiltonian.bind(corrected);
    hamiltonian.flow('B', corrected, -20.0);
    CHECK(test::same_bits(corrected, state[k]));
    CHECK(difference(mapped[k], state[k]) > 1e-6);
  }
  // The composed map leads from one mapped point to the next.
  ParticleSystem<double> walked = mapped[1];
  hamiltonian.bind(walked);
  for (int n = 0; n < 10; ++n) {
    hamiltonian.flow('A', walked, 40.0);
    hamiltonian.flow('B', walked, 40.0);
  }
  walked.clock() = mapped[2].clock();
  CHECK(test::same_bits(walked, mapped[2]));
}

TEST_CASE("a processed run saved and restored does not begin anew", "[composition]") {
  const auto make = [] { return Simulation(test::outer_planets(), compose(gravity(), processed_verlet()), 40.0); };
  auto whole = make(), first = make(), second = make();
  CHECK(whole.run(20).ok());
  CHECK(first.run(9).ok());
  second.restore(first.save());
  CHECK(second.run(11).ok());
  CHECK(test::same_bits(whole.particles(), second.particles()));
}

TEST_CASE("schemes that do not fit a Hamiltonian are refused by name", "[composition]") {
  const auto democratic = test::wisdom_holman({.G = outer_G, .coordinates = Coordinates::democratic});
  CHECK(refusal(gravity(), word("BAOAB")) == "scheme 'BAOAB' uses the letter O, but 'kinetic_potential' has only AB");
  const auto in_field =
      test::wisdom_holman({.G = outer_G, .coordinates = Coordinates::democratic}, HarmonicField{.k = 1e-9});
  CHECK(refusal(in_field, schemes::ruth_3) ==
        "scheme 'ruth_3' needs exact flows, but part B of 'wisdom_holman' is a symmetric map of order 2; "
        "use 'verlet', a composition of its steps such as 'yoshida_4', or a scheme made for it such as 'abah_8_6_4'");
  CHECK(refusal(democratic, schemes::srkn14a) ==
        "scheme 'srkn14a' is a Runge-Kutta-Nystroem splitting and keeps its order only where {B,{B,{B,A}}} = 0, which "
        "'wisdom_holman' does not guarantee; use a general scheme such as 'blanes_moan_s10'");
  const auto damped = test::damped(gravity(), {.rate = 0.1});
  CHECK(refusal(damped, schemes::yoshida_4) ==
        "scheme 'yoshida_4' steps backwards, but part D of 'damped' is irreversible; use a scheme with forward steps "
        "only, such as 'verlet' or 'mclachlan_2_s2'");
  CHECK(refusal(damped, schemes::verlet) == "accepted");
  CHECK(refusal(gravity(), schemes::srkn14a) == "accepted");
  CHECK(refusal(test::wisdom_holman({.G = outer_G}), schemes::srkn14a) == "accepted");
}

TEST_CASE("the schemes that refusals propose are accepted where they are proposed", "[composition]") {
  const auto democratic = test::wisdom_holman({.G = outer_G, .coordinates = Coordinates::democratic});
  for (const char* name : {"yoshida_6", "abah_10_6_4"}) {
    CAPTURE(name);
    REQUIRE(schemes::find(name) != nullptr);
    CHECK(refusal(democratic, *schemes::find(name)) == "accepted");
  }
  for (const char* name : {"verlet", "mclachlan_2_s2"}) {
    CAPTURE(name);
    REQUIRE(schemes::find(name) != nullptr);
    CHECK(refusal(test::damped(gravity(), {.rate = 0.1}), *schemes::find(name)) == "accepted");
  }
}

TEST_CASE("a Hamiltonian with quadratic kinetic energy only is demanded by Nystroem schemes", "[composition]") {
  struct Quartic : KineticPotential<Gravity> {
    using KineticPotential::KineticPotential;
    std::string name() const { return "quartic"; }
    HamiltonianClaims claims() const {
      HamiltonianClaims claims = KineticPotential::claims();
      claims.quadratic_kinetic = false;
      return claims;
    }
  };
  const Quartic quartic(Gravity{.G = outer_G});
  CHECK(refusal(quartic, schemes::srkn14a) ==
        "scheme 'srkn14a' is a Runge-Kutta-Nystroem splitting and keeps its order only where {B,{B,{B,A}}} = 0, which "
        "'quartic' does not guarantee; use a general scheme such as 'blanes_moan_s10'");
  CHECK(refusal(quartic, schemes::blanes_moan_s10) == "accepted");
}

TEST_CASE("drag stands at both ends of a word, and in the middle of a symplectic Euler", "[composition]") {
  const auto damped = test::damped(gravity(), {.rate = 0.1});
  CHECK(letters(compose(damped, schemes::verlet)) == "DBABD");
  CHECK(letters(compose(damped, schemes::verlet_aba)) == "DABAD");
  CHECK(letters(compose(damped, schemes::symplectic_euler_a)) == "BDA");
  CHECK(letters(compose(damped, schemes::symplectic_euler_b)) == "ADB");
  CHECK(letters(compose(damped, word("BADAB"))) == "BADAB");
  CHECK(letters(compose(gravity(), schemes::verlet)) == "BAB");
  const auto claims = compose(damped, schemes::verlet).claims();
  CHECK(claims.dissipative);
  CHECK_FALSE(claims.symplectic);
}

TEST_CASE("drag without forces is exact for any step", "[composition]") {
  for (const char* name : {"verlet", "symplectic_euler_a"}) {
    Simulation run(
        glider(3),
        compose(test::damped(test::kinetic_potential(HarmonicField{.k = 0}), {.rate = 0.5}), *schemes::find(name)),
        0.25);
    CHECK(run.run(80).ok());
    const double expected = static_cast<double>(Quad(3) * exp(Quad(-10)));
    // 81 factors, each rounded once with its product.
    CHECK(std::abs(run.particles().velocities()[0][0] - expected) < 2 * 81 * ulp * expected);
  }
  CHECK_THROWS_WITH(test::damped(gravity(), {.rate = -1}),
                    "a drag rate of -1.000000 would drive the motion instead of damping it; give 0 or more");
}

TEST_CASE("compensated sums are right to half an ulp after any number of steps", "[composition]") {
  const double v = 0.1, dt = 0.1;
  const std::int64_t n = 100'000;
  const Quad exact = Quad(n) * Quad(v * dt);
  std::array<double, 2> errors{};
  for (const bool compensated : {false, true}) {
    Simulation run(glider(v),
                   compose(test::kinetic_potential(HarmonicField{.k = 0}), schemes::symplectic_euler_a,
                           {.compensated = compensated}),
                   dt);
    CHECK(run.run(n).ok());
    const double x = std::as_const(run.particles()).positions()[0][0];
    errors[compensated ? 1 : 0] = static_cast<double>(abs(Quad(x) - exact) / exact);
  }
  CHECK(errors[1] <= ulp / 2);
  CHECK(errors[0] > 100 * ulp);
}

TEST_CASE("a composition claims what its scheme and its Hamiltonian are", "[composition]") {
  const auto claims = compose(gravity(), schemes::blanes_moan_s6).claims();
  CHECK(claims.method == "blanes_moan_s6");
  CHECK(claims.hamiltonian == "kinetic_potential");
  CHECK(claims.order == 4);
  CHECK(claims.clock == ClockMode::fixed);
  CHECK(claims.symplectic);
  CHECK(claims.energy);
  CHECK_FALSE(claims.time_dependent);
  std::vector<double> times;
  CHECK(compose(test::kinetic_potential(Clocked{&times}), schemes::verlet).claims().time_dependent);
}

}  // namespace noether
