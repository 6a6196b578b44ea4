// Methods in extended phase space: figures of Tao's oscillator and of geodesics, orders, what is kept and what is told.

#include "integrators/methods/extended_space.hpp"
#include "forces/external_fields.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/systems/kerr.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/nonseparable_oscillator.hpp"
#include "integrators/systems/schwarzschild.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace noether;
using Catch::Matchers::WithinRel;

namespace {

/// Error of Tao's oscillator at t = 10, of q or p, and the worst relative error of its energy.
std::array<double, 2> error_of_oscillator(const MethodChoice& choice, int steps) {
  const NonseparableOscillator system;
  Simulation run(initial_state(system), classical(system, choice), 10.0 / steps);
  Energy& energy = run.every(1, Energy());
  const Outcome outcome = run.run(steps);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  const auto& y = run.particles().variables();
  return {std::max(std::abs(y[0] + 2.4022383131008272595), std::abs(y[1] - 0.69060950745725347076)), energy.worst()};
}

/// A body in the plane, coupled to its own speed: the energy does not separate, and L is kept.
struct Turning {
  Index size() const { return 2; }
  std::vector<double> start() const { return {1, 0.2, -0.3, 0.8}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return (q[0] * q[0] + q[1] * q[1] + Real(1)) * (p[0] * p[0] + p[1] * p[1] + Real(1)) / Real(2);
  }
};

/// The final variables of a system after so many steps up to a time.
template <class Real, class S>
std::vector<Real> end_of(const S& system, const MethodChoice& choice, double time, int steps) {
  Simulation<Real> run(initial_state(system).template as<Real>(),
                       Classical<Real>(std::make_unique<CanonicalMotion<S, Real>>(system), choice), time / steps);
  const Outcome outcome = run.run(steps);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  return run.particles().variables();
}

}  // namespace

TEST_CASE("Tao's method on his oscillator has the errors that an independent program found", "[extended_space]") {
  struct Row {
    const char* method;
    int steps;
    double error;
  };
  for (const Row& row : {Row{"tao_2", 10000, 7.256e-6}, Row{"tao_2", 20000, 1.815e-6}, Row{"tao_4", 10000, 1.665e-8},
                         Row{"tao_4", 20000, 1.041e-9}}) {
    CAPTURE(row.method, row.steps);
    const auto [error, energy] = error_of_oscillator(method(row.method, TaoOptions{.omega = 20}), row.steps);
    CHECK_THAT(error, WithinRel(row.error, 0.03));
  }
  CHECK_THAT(error_of_oscillator(method("tao_2", TaoOptions{.omega = 20}), 10000)[1], WithinRel(6.24e-6, 0.03));
}

TEST_CASE("the semiexplicit method on Tao's oscillator has the errors that an independent program found",
          "[extended_space]") {
  const auto [error, energy] = error_of_oscillator(method("semiexplicit_2"), 2000);
  CHECK_THAT(error, WithinRel(1.523e-4, 0.03));
  CHECK_THAT(energy, WithinRel(1.46e-5, 0.03));
  CHECK_THAT(error_of_oscillator(method("semiexplicit_2"), 4000)[0], WithinRel(3.808e-5, 0.03));
}

TEST_CASE("methods in extended space have the order of their composition", "[extended_space]") {
  for (const int order : {2, 4, 6, 8}) {
    for (const char* family : {"tao_", "semiexplicit_"}) {
      const std::string name = family + std::to_string(order);
      if (methods::find(name) == nullptr) continue;  // of Tao's there are two orders
      CAPTURE(name);
      MethodChoice choice = method(name);
      if (name[0] == 't') choice.options.own = TaoOptions{.omega = 12};
      const int steps = order < 6 ? 200 : order == 6 ? 60 : 12;
      const auto truth = end_of<Quad>(Turning{}, method("gauss_8", {.adaptive = false}), 1, 100);
      std::array<double, 2> errors{};
      for (const int halved : {0, 1}) {
        const auto end = end_of<Quad>(Turning{}, choice, 1, steps << halved);
        double& worst = errors[static_cast<std::size_t>(halved)];
        for (std::size_t k = 0; k < end.size(); ++k) {
          worst = std::max(worst, std::abs(static_cast<double>(end[k] - truth[k])));
        }
      }
      CAPTURE(errors[0], errors[1]);
      CHECK(std::abs(std::log2(errors[0] / errors[1]) - order) < 0.15);
    }
  }
}

TEST_CASE("the semiexplicit method keeps quadratic invariants, Tao's nearly", "[extended_space]") {
  const auto momentum = [](const std::vector<double>& y) { return y[0] * y[3] - y[1] * y[2]; };
  const double before = momentum(Turning{}.start());
  for (const char* name : {"semiexplicit_2", "semiexplicit_4"}) {
    CAPTURE(name);
    CHECK(std::abs(momentum(end_of<double>(Turning{}, method(name), 20, 400)) - before) < 2e-14);
  }
  const double lost = std::abs(momentum(end_of<double>(Turning{}, method("tao_2"), 20, 4000)) - before);
  CHECK(lost > 1e-9);
  CHECK(lost < 1e-4);
}

TEST_CASE("geodesics of Schwarzschild and Kerr come to where extended precision has them", "[extended_space]") {
  for (const char* name : {"semiexplicit_8", "gauss_8"}) {
    CAPTURE(name);
    const MethodChoice choice = method(name, MethodOptions{});
    const auto fixed = [&] {
      MethodChoice same = choice;
      if (std::string(name) == "gauss_8") same.options.adaptive = false;
      return same;
    }();
    const auto plane = end_of<double>(Schwarzschild{}, fixed, 200, 800);
    CHECK(std::abs(plane[1] - 10.8276821334232157023) < 2e-11);
    CHECK(std::abs(plane[2] - 6.50893545759483309682) < 2e-12);
    CHECK(std::abs(plane[4] - 0.02103916216278501971) < 2e-12);
    const auto turned = end_of<double>(Kerr{}, fixed, 200, 1600);
    CHECK(std::abs(turned[1] - 6.17820090440825918106) < 5e-11);
    CHECK(std::abs(turned[2] - 1.23821294463033183565) < 5e-11);
    CHECK(std::abs(turned[3] - 12.2006075682855197649) < 5e-11);
    CHECK(std::abs(turned[5] + 0.1787215340809045311) < 5e-11);
    CHECK(std::abs(turned[6] + 0.9261278892073340009) < 5e-11);
  }
  CHECK(std::abs(Schwarzschild{}.start()[3] + 0.95987195326598988334) < 1e-15);
  CHECK(std::abs(Kerr{}.start()[4] + 0.93592805280606083772) < 1e-15);
}

TEST_CASE("copies that part are told before their numbers are", "[extended_space][extremes]") {
  const NonseparableOscillator system;
  Simulation weak(initial_state(system), classical(system, method("tao_2", TaoOptions{.omega = 1e-3})), 1e-3);
  const Outcome outcome = weak.run(10000);
  CHECK(outcome.kind == Outcome::Kind::solver_failure);
  CHECK_THAT(outcome.message, Catch::Contains("the copies of the state are"));
  CHECK_THAT(outcome.message, Catch::Contains("omega = 0.001 is too small"));
  // A bond that turns by several radians a step: right to its own error, or told.
  for (const double omega : {1.0, 100.0, 1e4}) {
    CAPTURE(omega);
    Simulation run(initial_state(system), classical(system, method("tao_2", TaoOptions{.omega = omega})), 1e-3);
    Energy& energy = run.every(1, Energy());
    if (run.run(10000).ok()) CHECK(energy.worst() < 0.2);
  }
}

TEST_CASE("a bond that nobody gave is twice the largest second derivative of the energy", "[extended_space]") {
  // At the start of the oscillator d^2 H/dp^2 = 10.
  const double by_itself = error_of_oscillator(method("tao_2"), 10000)[0],
               given = error_of_oscillator(method("tao_2", TaoOptions{.omega = 20}), 10000)[0];
  CHECK_THAT(by_itself, WithinRel(given, 1e-6));
}

TEST_CASE("what methods in extended space cannot do is refused in one line", "[extended_space]") {
  const auto made = [](const char* name, TaoOptions options) {
    return classical(NonseparableOscillator{}, method(name, options));
  };
  CHECK_THROWS_WITH(made("tao_2", {.omega = 0}),
                    Catch::Contains("omega = 0 is not a valid rate of the copies about each other"));
  CHECK_THROWS_WITH(made("tao_2", {.omega = -1}), Catch::Contains("omega = -1 is not a valid rate"));
  const auto composed = [](const char* name, const std::string& composition) {
    return classical(NonseparableOscillator{}, method(name, SemiexplicitOptions{.composition = composition}));
  };
  CHECK_THROWS_WITH(composed("semiexplicit_4", "yoshida_6"),
                    Catch::Contains("composition = \"yoshida_6\" has order 6, but method 'semiexplicit_4' order 4"));
  CHECK_THROWS_WITH(composed("semiexplicit_4", "yoshida4"), Catch::Contains("yoshida_4"));
  CHECK_THROWS_WITH(composed("semiexplicit_4", "ruth_3"), Catch::Contains("is not a symmetric composition"));
  auto rates = classical(Lorenz{}, method("semiexplicit_2"));
  auto s = initial_state(Lorenz{});
  s.clock() = Clock<double>::fixed(0, 0.1);
  CHECK_THROWS_WITH(rates.bind(s), Catch::Contains("method 'semiexplicit_2' is for an energy H(q, p), but 'lorenz'"));
  auto dragged = test::classical_over(as_force(LinearDrag{.rate = 0.1}), method("tao_2"));
  ParticleSystem<double> one;
  one.add("bob", 1, {1, 0, 0}, {0, 1, 0});
  one.clock() = Clock<double>::fixed(0, 0.1);
  CHECK_THROWS_WITH(dragged.bind(one), Catch::Contains("is for an energy H(q, p)"));
}
