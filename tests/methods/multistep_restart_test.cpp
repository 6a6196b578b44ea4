/// Methods with a past go on bit for bit when they are saved and loaded, in their start and later.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/classical.hpp"
#include "monitors/monitors.hpp"
#include "tests/methods/motions.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

using namespace noether;

namespace {

struct RestartChoice {
  const char* name;
  MethodOptions options = {};
};

std::vector<RestartChoice> restart_choices() {
  std::vector<RestartChoice> list;
  for (const char* name :
       {"adams_bashforth_1", "adams_bashforth_2", "adams_bashforth_3", "adams_bashforth_4", "adams_bashforth_5",
        "adams_bashforth_6", "adams_moulton_1", "adams_moulton_2", "adams_moulton_3", "adams_moulton_4",
        "adams_moulton_5", "adams_moulton_6", "stormer_cowell_12", "stormer_cowell_13", "stormer_cowell_14"}) {
    list.push_back({name});
  }
  for (const char* name : {"adams_pece", "dprkn_12"}) {
    list.push_back({name, {.adaptive = false}});
    list.push_back({name, {.rtol = 1e-9, .atol = 1e-9}});
  }
  list.push_back({"gragg_bulirsch_stoer", {.rtol = 1e-9, .atol = 1e-9}});
  return list;
}

/// Goes `steps` steps, fixed or the method's own.
template <class Real> void go_on(Method<Real>& method, VectorField<Real>& f, Real& t, Vector<Real>& y, int steps) {
  for (int n = 0; n < steps; ++n) {
    const StepResult made = method.step(f, t, y, 0.015625);
    REQUIRE(!made.failure);
    t += Real(made.h);
  }
}

template <class Real> void check_method_restart(const RestartChoice& choice, int before, int after) {
  CAPTURE(choice.name, choice.options.adaptive.value_or(true), before, after);
  auto f = test::kepler<Real>();
  const auto whole = test::make<Real>(choice.name, choice.options);
  whole->bind(f);
  Vector<Real> y = test::kepler_start<Real>(Real(0.3)), z = y;
  Real t(0), s(0);
  go_on(*whole, f, t, y, before + after);

  const auto first = test::make<Real>(choice.name, choice.options);
  first->bind(f);
  go_on(*first, f, s, z, before);
  SavedState saved;
  first->save(saved, "method/");
  const auto second = test::make<Real>(choice.name, choice.options);
  second->bind(f);
  second->load(saved, "method/");
  go_on(*second, f, s, z, after);

  CHECK(s == t);
  for (Index i = 0; i < y.size(); ++i) CHECK(y[i] == z[i]);
}

}  // namespace

TEST_CASE("methods with a past go on bit for bit from any step of their start, and later", "[methods]") {
  for (const RestartChoice& choice : restart_choices()) {
    for (int before = 0; before <= 16; ++before) check_method_restart<double>(choice, before, 20);
    check_method_restart<double>(choice, 60, 60);
    for (const int before : {1, 7, 20}) check_method_restart<Quad>(choice, before, 15);
  }
}

TEST_CASE("a simulation with a multistep method goes on bit for bit and as if nobody had looked", "[methods]") {
  for (const char* name : {"adams_bashforth_5", "adams_moulton_4", "stormer_cowell_13"}) {
    const auto make = [&](int cadence) {
      Simulation<double> simulation(test::outer_planets(),
                                    test::classical_over(Gravity{.G = test::outer_G}, method(name)), 20.0);
      if (cadence > 0) simulation.every(cadence, Energy{});
      return simulation;
    };
    for (const int n : {5, 40}) {
      CAPTURE(name, n);
      auto whole = make(0), watched = make(3), first = make(0), second = make(0);
      REQUIRE(whole.run(2 * n).ok());
      REQUIRE(watched.run(2 * n).ok());
      CHECK(test::same_bits(whole.particles(), watched.particles()));
      REQUIRE(first.run(n).ok());
      second.restore(first.save());
      REQUIRE(second.run(n).ok());
      CHECK(test::same_bits(whole.particles(), second.particles()));
      CHECK(whole.evaluations().force == second.evaluations().force);
    }
  }
}

TEST_CASE("a simulation with steps of the method's choice goes on bit for bit, watched or not", "[methods]") {
  for (const char* name : {"adams_pece", "gragg_bulirsch_stoer", "dprkn_12"}) {
    const auto make = [&](bool watched) {
      Simulation<double> simulation(
          test::outer_planets(),
          test::classical_over(Gravity{.G = test::outer_G}, method(name, {.rtol = 1e-11, .atol = 1e-13})));
      if (watched) simulation.every_time(777, Energy{});
      return simulation;
    };
    CAPTURE(name);
    auto whole = make(false), watched = make(true), first = make(true), second = make(true);
    REQUIRE(whole.run_until(40000).ok());
    REQUIRE(watched.run_until(40000).ok());
    CHECK(test::same_bits(whole.particles(), watched.particles()));
    CHECK(whole.evaluations().force == watched.evaluations().force);
    REQUIRE(first.run_until(17000).ok());
    second.restore(first.save());
    REQUIRE(second.run_until(40000).ok());
    CHECK(test::same_bits(whole.particles(), second.particles()));
    CHECK(whole.evaluations().force == second.evaluations().force);
  }
}

TEST_CASE("a change of the step starts a multistep method again, and no error comes of it", "[methods]") {
  for (const RestartChoice& choice : restart_choices()) {
    if (choice.options.rtol) continue;
    auto f = test::oscillator<double>();
    const auto method = test::make<double>(choice.name, choice.options);
    method->bind(f);
    Vector<double> y(2);
    y << 1, 0;
    double t = 0;
    for (const double h : {0.01, 0.005, 0.01}) {
      for (int n = 0; n < 30; ++n) {
        method->step(f, t, y, h);
        t += h;
      }
    }
    const int order = std::min(method->claims().order, 7);
    CAPTURE(choice.name, y[0] - std::cos(t));
    CHECK(std::abs(y[0] - std::cos(t)) < std::pow(0.01, order) + 1e-14);
  }
}
