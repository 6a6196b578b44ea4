/// Line integral methods that keep several invariants: those of forces, those that a system names, and a program's own,
/// by sweeps and by Newton's iteration.

#include "forces/springs.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/methods/hbvm.hpp"
#include "integrators/systems/kerr.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

using namespace noether;

namespace {

/// q x p in the plane.
struct PlaneMomentum {
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    return q[0] * p[1] - q[1] * p[0];
  }
};
struct PericenterX {
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    return p[1] * PlaneMomentum()(q, p) - q[0] / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
};

/// An orbit of e = 0.6 from its pericenter, which says what it keeps.
struct NamingOrbit {
  static constexpr auto describe() { return part<NamingOrbit>("naming_orbit", "an orbit that names its invariants"); }
  Index size() const { return 2; }
  std::vector<double> start() const { return {0.4, 0, 0, 2}; }
  std::vector<NamedInvariant> invariants() const {
    return {invariant("angular_momentum", PlaneMomentum{}), invariant("pericenter", PericenterX{})};
  }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) / Real(2) - Real(1) / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
};

/// A mass on a spring of length 1 in the plane, of stiffness k.
struct StiffSpring {
  double k = 1e4;
  Index size() const { return 2; }
  std::vector<double> start() const { return {1.02, 0, 0, 1}; }
  std::vector<NamedInvariant> invariants() const { return {invariant("angular_momentum", PlaneMomentum{})}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    const Real longer = sqrt(q[0] * q[0] + q[1] * q[1]) - Real(1);
    return (p[0] * p[0] + p[1] * p[1]) / Real(2) + Real(k / 2) * longer * longer;
  }
};

/// How far two functions of the plane end from where they began.
struct Kept {
  double momentum = 0, pericenter = 0, energy = 0;
};
template <class Real, class S>
Kept kept_over(const S& system, const char* name, const MethodOptions& options, double h, int steps) {
  auto field = std::make_unique<CanonicalMotion<S, Real>>(system);
  ParticleSystem<Real> s = initial_state(system).template as<Real>();
  field->bind(s);
  Vector<Real> y;
  field->gather(s, y);
  const MethodChoice choice = method(name, options);
  auto stepper = make_method<Real>(*choice.info, choice.options);
  stepper->bind(*field);
  const auto values = [&] {
    const Vector<Real> q = y.head(2), p = y.tail(2);
    return std::array<Real, 3>{PlaneMomentum()(q, p), PericenterX()(q, p), field->hamiltonian(Real(0), y)};
  };
  const auto before = values();
  for (int k = 0; k < steps; ++k) {
    const StepResult made = stepper->step(*field, Real(k * h), y, h);
    INFO((made.failure ? made.failure->message : ""));
    REQUIRE_FALSE(made.failure);
  }
  const auto after = values();
  const auto off = [&](std::size_t k) { return std::abs(static_cast<double>(after[k] - before[k])); };
  return {off(0), off(1), off(2)};
}

/// Five masses on stiff linear springs, which counts how often H is evaluated over dual numbers of dual numbers: by
/// products with the derivative of its rates.
struct CountingChain {
  std::int64_t* products;
  Index size() const { return 5; }
  std::vector<double> start() const { return {0.1, 0, 0, 0, 0, 0, 0, 0.2, 0, 0}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    if constexpr (std::is_same_v<Real, Dual<Dual<double, 1>, 4>>) ++*products;
    Real sum(0);
    for (Index i = 0; i < q.size(); ++i) {
      const Real d = q[i] - (i > 0 ? q[i - 1] : Real(0));
      sum += p[i] * p[i] / Real(2) + Real(2000) * d * d;
    }
    return sum;
  }
};

/// What Newton's iteration takes for a step of 1, h omega = 121.
struct NewtonWork {
  Index rows = 0;
  std::int64_t evaluations = 0, products = 0;
};
NewtonWork work_of(int nodes, int coefficients, std::optional<JacobianForm> form) {
  std::int64_t products = 0;
  CanonicalMotion<CountingChain, double> field(CountingChain{&products});
  const ParticleSystem<double> s = initial_state(CountingChain{&products});
  field.bind(s);
  Vector<double> y;
  field.gather(s, y);
  const std::string name = fmt::format("hbvm_{}_{}", nodes, coefficients);
  Hbvm<double> stepper(*method(name).info, {.jacobian = form}, nodes, coefficients);
  stepper.bind(field);
  products = 0;
  const StepResult made = stepper.step(field, 0, y, 1);
  REQUIRE_FALSE(made.failure);
  return {stepper.matrix_rows(), field.evaluations().force, products};
}

LineInvariants named(std::vector<std::string> names) { return {.invariants = std::move(names)}; }

}  // namespace

TEST_CASE("what a system names is kept by its name, in 113 bits too", "[line_invariants]") {
  const double h = 2 * std::numbers::pi / 100;
  const auto kept = [&](const LineInvariants& wanted) {
    return kept_over<double>(NamingOrbit{}, "hbvm_2", {.own = wanted}, h, 40);
  };
  const Kept energy = kept({}), both = kept(named({"energy", "pericenter"})),
             all = kept(named({"energy", "angular_momentum"})), turned = kept(named({"angular_momentum"}));
  CHECK(energy.energy < 1e-14);
  CHECK(energy.pericenter > 1e-9);
  CHECK(both.energy < 1e-13);
  CHECK(both.pericenter < 1e-13);
  CHECK(all.momentum < 1e-13);
  CHECK(all.energy < 1e-13);
  CHECK(turned.momentum < 1e-13);
  const Kept wide = kept_over<Quad>(NamingOrbit{}, "hbvm_2", {.own = named({"energy", "angular_momentum"})}, h, 10);
  CHECK(wide.energy < 1e-29);
  CHECK(wide.momentum < 1e-29);
}

TEST_CASE("a fall about a black hole that turns keeps Carter's constant by its name", "[line_invariants]") {
  const Kerr hole;
  const auto carter_lost = [&](std::vector<std::string> names) {
    Simulation<double> run(initial_state(hole), classical(hole, method("hbvm_2", named(std::move(names)))), 0.5);
    const auto carter = [&] {
      const auto y = Eigen::Map<const Vector<double>>(run.particles().variables().data(), 8);
      return CarterConstant{hole}(Vector<double>(y.head(4)), Vector<double>(y.tail(4)));
    };
    const double before = carter();
    const Energy& energy = run.every(1, Energy{});
    REQUIRE(run.run(200).ok());
    CHECK(energy.worst() < 1e-13);
    return std::abs(carter() / before - 1);
  };
  CHECK(carter_lost({"energy"}) > 1e-10);
  CHECK(carter_lost({"energy", "carter"}) < 1e-13);
}

TEST_CASE("what no field has is refused by its name", "[line_invariants][messages]") {
  const auto refusal = [](const std::string& name) -> std::string {
    try {
      Simulation(initial_state(NamingOrbit{}), classical(NamingOrbit{}, method("hbvm_2", named({"energy", name}))),
                 0.1);
    } catch (const SchemeMismatch& error) {
      CHECK(error.key() == "invariants");
      return error.message();
    }
    return "";
  };
  CHECK(refusal("angular_momentum") == "");
  CHECK(refusal("pericentre") ==
        "method 'hbvm_2' cannot keep 'pericentre' of 'naming_orbit', which has none of that name; did you mean "
        "'pericenter'?");
}

TEST_CASE("on stiff springs Newton's iteration keeps the angular momentum too", "[line_invariants]") {
  for (const auto form : {JacobianForm::dense, JacobianForm::matrix_free}) {
    const MethodOptions options{.jacobian = form, .own = named({"energy", "angular_momentum"})};
    for (const char* name : {"hbvm_2", "hbvm_3"}) {
      CAPTURE(name);
      const Kept kept = kept_over<double>(StiffSpring{}, name, options, 0.05, 200);  // h omega = 5
      CHECK(kept.energy < 1e-11);
      CHECK(kept.momentum < 1e-12);
    }
  }
}

TEST_CASE("forces keep energy, momentum and angular momentum by Newton's iteration over q and v", "[line_invariants]") {
  ParticleSystem<double> s;
  s.add("a", 1, {0, 0, 0}, {0.1, 0.2, 0});
  s.add("b", 2, {1, 0.02, 0}, {0, -0.3, 0.1});
  s.add("c", 1, {0.5, 0.9, 0.1}, {-0.1, 0.1, 0});
  const HarmonicBond springs{.k = 1e3, .length = 1, .tied = {{0, 1}, {1, 2}, {0, 2}}};
  Simulation run(s, test::classical_over(springs, method("hbvm_2", named({"energy", "angular_momentum"}))), 0.1);
  const Energy& energy = run.every(1, Energy{});
  const AngularMomentum& spin = run.every(1, AngularMomentum{});
  const Momentum& momentum = run.every(1, Momentum{});
  const Outcome outcome = run.run(100);
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  CHECK(run.evaluations().jacobian > 0);
  CHECK(energy.worst() < 1e-12);
  CHECK(spin.worst() < 1e-12);
  CHECK(momentum.worst() < 1e-13);
}

TEST_CASE("Newton's iteration solves for S coefficients of each variable, whatever the number of nodes",
          "[line_invariants]") {
  for (const int S : {1, 2, 3}) {
    const NewtonWork least = work_of(S, S, {});
    const std::int64_t direct = work_of(S, S, JacobianForm::matrix_free).products;
    CAPTURE(S, direct);
    for (const int K : {S, 2 * S, 8, 16}) {
      CAPTURE(K);
      const NewtonWork dense = work_of(K, S, {}), free = work_of(K, S, JacobianForm::matrix_free);
      CHECK(dense.rows == 10 * S);
      CHECK(free.rows == 10 * S);
      // H is quadratic, so all K have the same equations. K counts where H is evaluated, and once where a step begins,
      CHECK((dense.evaluations - 1) % K == 0);
      CHECK((dense.evaluations - 1) / K < 2 * (least.evaluations - 1) / S);
      // and not in the matrix: one J of n columns, or S products with J, each of three H, in one with the matrix.
      CHECK(dense.products == 10 * 3);
      CHECK(free.products % (3 * S) == 0);
      CHECK(free.products < 2 * direct);
    }
  }
}
