/// Multiple time steps by the method respa: what becomes of its word, its order, its evaluations, its step on two
/// springs against the closed form, constraints, restarts, and what it refuses.

#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/settings.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace noether {
namespace {

using Catch::Matchers::Contains;

/// U = sum m (x^2 y - y^3/3): what Henon and Heiles have beside springs. It counts how often it is evaluated.
struct Cubic {
  std::shared_ptr<int> calls = std::make_shared<int>(0);

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    ++*calls;
    for (Index i = 0; i < s.size(); ++i) {
      const Real x = s.positions()[i][0], y = s.positions()[i][1];
      out.acceleration(i, Vec3<Real>(-Real(2) * x * y, -x * x + y * y, Real(0)));
      if (out.wants_energy()) out.energy(s.masses()[i] * (x * x * y - y * y * y / Real(3)));
    }
  }
};
/// A spring to the origin that counts how often it is evaluated.
struct CountedSpring {
  double k = 1;
  std::shared_ptr<int> calls = std::make_shared<int>(0);

  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    ++*calls;
    HarmonicField{k}.add_to(out, s);
  }
};

AnyForce<double> in_kick(AnyForce<double> force, char letter) { return force.in_kick(letter); }

/// Henon and Heiles with the spring in kicks B and the cubic terms in kicks C.
ForceField<double> parted_field() {
  ForceField<double> field;
  field.add(HarmonicField{1});
  field.add(in_kick(Cubic{}, 'C'));
  return field;
}
ParticleSystem<double> start() { return test::particle_in_plane(0, 0.1, 0.35, 0.05); }

ForceField<double> two_springs(double fast, double slow) {
  ForceField<double> field;
  field.add(HarmonicField{fast});
  field.add(in_kick(HarmonicField{slow}, 'C'));
  return field;
}

std::string letters_of(const ForceField<double>& field, const CompositionOptions& options) {
  const FittedWord fitted = fitted_word(schemes::respa, KineticPotential(field).claims(), "kinetic_potential", options);
  std::string letters;
  for (const Stage& stage : fitted.stages) letters += stage.letter;
  return letters;
}

/// Half the trace of a step on two springs, for Verlet's inner steps in closed form: n turns by theta, where
/// cos theta = 1 - (Omega h/n)^2/2, between two halves of a kick by the slow spring.
double half_trace(double fast, double slow, double h, int n) {
  const double inner = h / n, theta = std::acos(1 - fast * inner * inner / 2), w = std::sin(theta) / inner;
  return std::cos(n * theta) - slow * h / (2 * w) * std::sin(n * theta);
}

/// Where a particle on two springs is after some steps.
std::array<double, 2> after(double fast, double slow, double h, int n, std::int64_t steps, double x, double v) {
  Simulation run(test::particle_in_plane(x, 0, v, 0),
                 compose(KineticPotential(two_springs(fast, slow)), schemes::respa, {.inner_steps = {n}}), h);
  REQUIRE(run.run(steps).ok());
  return {run.particles().positions()[0][0], run.particles().velocities()[0][0]};
}

}  // namespace

TEST_CASE("respa has inner steps of faster kicks between halves of slower ones", "[respa]") {
  const ForceField<double> two = parted_field();
  ForceField<double> three = parted_field();
  three.add(in_kick(HarmonicField{1e-3}, 'E'));
  CHECK(letters_of(two, {.inner_steps = {1}}) == "CBABC");
  CHECK(letters_of(two, {.inner_steps = {3}}) == "CBABABABC");
  CHECK(letters_of(three, {.inner_steps = {2, 2}}) == "ECBABABCBABABCE");
  CHECK(letters_of(test::field_of(HarmonicField{1}), {}) == "BAB");
  const FittedWord fitted = fitted_word(schemes::respa, KineticPotential(two).claims(), "", {.inner_steps = {2}});
  REQUIRE(fitted.stages.size() == 7);
  const std::array<double, 7> weights = {0.5, 0.25, 0.5, 0.5, 0.5, 0.25, 0.5};
  for (std::size_t k = 0; k < 7; ++k) CHECK(static_cast<double>(fitted.stages[k].weight) == weights[k]);
}

TEST_CASE("respa with two inner steps has the bits of the word that spells them, with one those of verlet", "[respa]") {
  const auto end = [](const Scheme& scheme, const CompositionOptions& options) {
    Simulation run(start(), compose(KineticPotential(parted_field()), scheme, options), 0.1);
    REQUIRE(run.run(100).ok());
    return run.particles();
  };
  CHECK(test::same_bits(end(schemes::respa, {.inner_steps = {2}}), end(word("CBABBABC"), {})));
  CHECK(test::same_bits(end(schemes::respa, {.inner_steps = {1}}), end(schemes::verlet, {})));
}

TEST_CASE("respa is of order 2, and goes back the way it came", "[respa]") {
  ForceField<double> together;
  together.add(HarmonicField{1}).add(Cubic{});
  Simulation fine(start(), compose(KineticPotential(together), schemes::yoshida_8), 0.01);  // right to 1e-12
  REQUIRE(fine.run(960).ok());
  const Vec3<double> truth = fine.particles().positions()[0];
  for (const InnerSteps& inner : {InnerSteps{2}, InnerSteps{5}}) {
    CAPTURE(inner.text());
    const auto error = [&](double h) {
      Simulation run(start(), compose(KineticPotential(parted_field()), schemes::respa, {.inner_steps = inner}), h);
      REQUIRE(run.run(std::lround(9.6 / h)).ok());
      return std::sqrt(norm2(Vec3<double>(run.particles().positions()[0] - truth)));
    };
    CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - 2) < 0.05);
    CHECK(std::abs(std::log2(error(0.05) / error(0.025)) - 2) < 0.05);
  }
  const auto made = [](const ParticleSystem<double>& s, double h) {
    return Simulation(s, compose(KineticPotential(parted_field()), schemes::respa, {.inner_steps = {3}}), h);
  };
  auto there = made(start(), 0.1);
  REQUIRE(there.run(200).ok());
  auto back = made(there.particles(), -0.1);
  REQUIRE(back.run(200).ok());
  CHECK(std::sqrt(norm2(Vec3<double>(back.particles().positions()[0] - start().positions()[0]))) < 1e-12);
}

TEST_CASE("each kick is evaluated once where particles have moved, whatever stands between", "[respa]") {
  const CountedSpring fast{1};
  const Cubic slow;
  ForceField<double> field;
  field.add(fast).add(in_kick(slow, 'C'));
  Simulation run(start(), compose(KineticPotential(field), schemes::respa, {.inner_steps = {4}}), 0.1);
  REQUIRE(run.run(1).ok());
  const int fast_before = *fast.calls, slow_before = *slow.calls;
  const std::int64_t before = run.evaluations().force;
  REQUIRE(run.run(50).ok());
  CHECK(*fast.calls - fast_before == 200);
  CHECK(*slow.calls - slow_before == 50);
  CHECK(run.evaluations().force - before == 250);
}

TEST_CASE("a step of respa on two springs has the trace of the closed form", "[respa]") {
  for (const auto& [fast, slow] : {std::pair(1.0, 0.1), std::pair(1.0, 2.0), std::pair(400.0, 1.0)}) {
    for (const int n : {1, 2, 3, 8, 20}) {
      for (const double share : {0.1, 0.7, 1.3, 1.9}) {  // of h Omega/n; 2 is the limit of inner steps
        const double h = share * n / std::sqrt(fast);
        const double trace = after(fast, slow, h, n, 1, 1, 0)[0] + after(fast, slow, h, n, 1, 0, 1)[1];
        const double expected = half_trace(fast, slow, h, n);
        CAPTURE(fast, slow, n, h, expected);
        CHECK(std::abs(trace / 2 - expected) < 1e-12 * (1 + std::abs(expected)));
      }
    }
  }
}

TEST_CASE("at half the period of the fast spring a slow kick resonates, as fast as the closed form says", "[respa]") {
  // Omega = 1, slow spring 0.05, 20 inner steps: stable at 2.9 and beyond pi, not at 3.08.
  const double slow = 0.05;
  CHECK(std::abs(half_trace(1, slow, 2.9, 20)) < 1);
  CHECK(std::abs(half_trace(1, slow, 3.2, 20)) < 1);
  const double trace = std::abs(half_trace(1, slow, 3.08, 20)), rate = std::log(trace + std::sqrt(trace * trace - 1));
  REQUIRE(trace > 1.001);
  const auto size = [&](double h, std::int64_t steps) {
    const auto [x, v] = after(1, slow, h, 20, steps, 1, 0.3);
    return std::hypot(x, v);
  };
  CHECK(std::abs(std::log(size(3.08, 400) / size(3.08, 200)) / 200 - rate) < 1e-6);
  for (const double h : {2.9, 3.2}) {
    CHECK(size(h, 400) < 3);
    CHECK(size(h, 4000) < 3);
  }
}

TEST_CASE("respa keeps constraints to rounding, at order 2", "[respa]") {
  const test::Mechanism mechanism = test::double_pendulum();
  const auto run_of = [&](double h) {
    ForceField<double> field;
    field.add(test::weight).add(in_kick(HarmonicField{2}, 'C'));
    return Simulation(
        mechanism.particles,
        compose(test::kinetic_potential_over(field, mechanism.constraints), schemes::respa, {.inner_steps = {3}}), h);
  };
  const auto end = [&](double h) {
    auto run = run_of(h);
    REQUIRE(run.run(std::lround(1.6 / h)).ok());
    const Vec3<double> elbow = run.particles().positions()[0], hand = run.particles().positions()[1];
    CHECK(std::abs(std::sqrt(norm2(elbow)) - 2) < 1e-13);
    CHECK(std::abs(std::sqrt(norm2(Vec3<double>(hand - elbow))) - 3) < 1e-13);
    return hand;
  };
  const auto apart = [](const Vec3<double>& a, const Vec3<double>& b) { return std::sqrt(norm2(Vec3<double>(a - b))); };
  const Vec3<double> coarse = end(0.02), middle = end(0.01), fine = end(0.005);
  CHECK(std::abs(std::log2(apart(coarse, middle) / apart(middle, fine)) - 2) < 0.1);
}

TEST_CASE("runs by respa go on after any step, by as many inner steps only", "[respa]") {
  const auto made = [](const InnerSteps& inner) {
    ForceField<double> field = parted_field();
    field.add(in_kick(HarmonicField{1e-2}, 'D'));
    return Simulation(start(), compose(KineticPotential(field), schemes::respa, {.inner_steps = inner}), 0.2);
  };
  auto whole = made({3, 2});
  REQUIRE(whole.run(40).ok());
  for (const std::int64_t steps : {0, 1, 17, 39}) {
    auto first = made({3, 2}), second = made({3, 2});
    REQUIRE(first.run(steps).ok());
    second.restore(first.save());
    REQUIRE(second.run(40 - steps).ok());
    CHECK(test::same_bits(second.particles(), whole.particles()));
    CHECK(second.evaluations().force == whole.evaluations().force);
  }
  auto other = made({2, 2});
  CHECK_THROWS_WITH(other.restore(whole.save()),
                    Contains("the saved run has inner_steps = [3, 2], but this one has inner_steps = [2, 2]"));
}

TEST_CASE("inner steps are refused where their number is not that of the kicks, or the method has none", "[respa]") {
  const auto refusal = [](const ForceField<double>& field, const Scheme& scheme, const CompositionOptions& options) {
    try {
      compose(KineticPotential(field), scheme, options);
    } catch (const SchemeMismatch& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  CHECK(refusal(parted_field(), schemes::respa, {}) ==
        "method 'respa' has inner_steps = [], but the forces of 'kinetic_potential' are in the kicks B, C; give 1 "
        "number: the steps of B in one of C");
  CHECK(refusal(test::field_of(HarmonicField{1}), schemes::respa, {.inner_steps = {4}}) ==
        "method 'respa' has inner_steps = [4], but the forces of 'kinetic_potential' are in the kick B; give kick = "
        "\"C\" in the table of a slow force, or take inner_steps out");
  CHECK(refusal(parted_field(), schemes::yoshida_4, {.inner_steps = {4}}) ==
        "inner_steps = [4] is for method 'respa', not for 'yoshida_4'; take it out");
  CHECK(refusal(parted_field(), word("CBABC"), {.inner_steps = {4}}) ==
        "inner_steps = [4] is for method 'respa', not for 'CBABC'; take it out");
  CHECK_THAT(refusal(parted_field(), schemes::respa, {.kernel = StepKernel::lazy, .inner_steps = {4}}),
             Contains("is not for method 'respa'"));
  CHECK_THROWS_WITH((InnerSteps{4, 0}), Contains("inner_steps = 0 is not a valid number of steps"));
  CHECK_THROWS_WITH((InnerSteps{1, 1, 1, 1}), Contains("inner_steps = [1, 1, 1] and more is too long a list"));
  CHECK_THROWS_WITH((InnerSteps{40, 26}), Contains("are too many steps of the fastest forces in one of the slowest"));
  CHECK(InnerSteps{40, 25}.all() == 1000);
}

}  // namespace noether
