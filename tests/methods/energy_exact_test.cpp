/// Line integral methods: what they keep, to what order they are accurate, and what they refuse.

#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/linear_drag.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/methods/kept_invariants.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/nonseparable_oscillator.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/drivers.hpp"
#include "tests/support/planets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace noether;

namespace {

struct HenonHeilesSystem {
  Index size() const { return 2; }
  std::vector<double> start() const { return {0.18, 0.18, 0.18, 0.18}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    const Real& x = q[0];
    const Real& y = q[1];
    return (p[0] * p[0] + p[1] * p[1] + x * x + y * y) / Real(2) + x * x * y - y * y * y / Real(3);
  }
};
const std::vector<double> henon_heiles_end = {0.11993689527827192962, 0.28094312807732175410, 0.15064847361074464179,
                                              0.16753367027286670230};

/// Six masses between walls, on springs with energies d^2 / 2 + d^4 / 2.
struct QuarticChain {
  Index size() const { return 6; }
  std::vector<double> start() const {
    std::vector<double> y(12, 0.0);
    for (std::size_t i = 0; i < 6; ++i) y[i] = 1.2 * std::sin(std::numbers::pi * static_cast<double>(i + 1) / 7);
    return y;
  }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    Real sum(0);
    for (Index i = 0; i <= 6; ++i) {
      const Real d = (i < 6 ? q[i] : Real(0)) - (i > 0 ? q[i - 1] : Real(0)), d2 = d * d;
      sum += d2 / Real(2) + d2 * d2 / Real(2);
    }
    for (Index i = 0; i < 6; ++i) sum += p[i] * p[i] / Real(2);
    return sum;
  }
};
const std::vector<double> chain_end = {-0.28119088077519108458, -0.60369692769557840907, -0.91304794824857870870,
                                       -0.91304794824857870870, -0.60369692769557840907, -0.28119088077519108458};

/// H = p^2 / 2 + q^nu / nu.
struct Monomial {
  int nu = 4;
  Index size() const { return 1; }
  std::vector<double> start() const { return {1, 0.3}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    Real power(1);
    for (int k = 0; k < nu; ++k) power *= q[0];
    return p[0] * p[0] / Real(2) + power / Real(nu);
  }
};

/// An orbit of e = 0.6 about a fixed centre, from its pericenter.
struct Orbit {
  Index size() const { return 2; }
  std::vector<double> start() const { return {0.4, 0, 0, 2}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) / Real(2) - Real(1) / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
};
struct OrbitalMomentum {
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    return q[0] * p[1] - q[1] * p[0];
  }
};
/// One component of Laplace's vector, which points to the pericenter.
struct Laplace {
  Index axis = 0;
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& p) const {
    const Real turned = axis == 0 ? p[1] : -p[0];
    return turned * OrbitalMomentum()(q, p) - q[axis] / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
};
LineInvariants laplace() {
  return {.own = {invariant("L", OrbitalMomentum{}), invariant("A_x", Laplace{0}), invariant("A_y", Laplace{1})}};
}

/// A mass on a spring of length 1 in the plane.
struct Spring {
  double k = 100;
  Index size() const { return 2; }
  std::vector<double> start() const { return {1.02, 0, 0, 1}; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    const Real longer = sqrt(q[0] * q[0] + q[1] * q[1]) - Real(1);
    return (p[0] * p[0] + p[1] * p[1]) / Real(2) + Real(k / 2) * longer * longer;
  }
};

struct Figures {
  double error = 0, worst = 0;  ///< of what is compared, as a length; of its worst component
  double energy = 0;            ///< largest change of H
  std::vector<double> end;
  std::int64_t evaluations = 0;
};

/// A run of `steps` steps to `time`, of what `method` does to a system.
template <class S>
Figures figures(const S& system, const MethodChoice& choice, double time, double steps,
                const std::vector<double>& end) {
  Simulation run(initial_state(system), classical(system, choice), time / steps);
  const Energy& energy = run.every(1, Energy());
  const Outcome outcome = run.run(static_cast<std::int64_t>(steps));
  INFO(outcome.message);
  REQUIRE(outcome.ok());
  Figures found{0, 0, energy.worst() * std::abs(energy.total()), run.particles().variables(), run.evaluations().force};
  for (std::size_t i = 0; i < end.size(); ++i) {
    found.error = std::hypot(found.error, found.end[i] - end[i]);
    found.worst = std::max(found.worst, std::abs(found.end[i] - end[i]));
  }
  return found;
}

/// The error and slope of a row of the literature, and what it changes of the energy: 0 for rounding.
template <class S>
void check_row(const S& system, const char* name, double h, double time, const std::vector<double>& end, double error,
               double slope, double energy) {
  const Figures coarse = figures(system, method(name), time, time / h, end);
  const Figures fine = figures(system, method(name), time, 2 * time / h, end);
  CAPTURE(name, coarse.worst, fine.worst, coarse.energy);
  CHECK(std::abs(coarse.worst / error - 1) < 0.02);
  CHECK(std::abs(std::log2(coarse.worst / fine.worst) - slope) < 0.1);
  if (energy == 0) {
    CHECK(coarse.energy < 1e-13);
  } else {
    CHECK(std::abs(coarse.energy / energy - 1) < 0.08);
  }
}

}  // namespace

TEST_CASE("line integral methods on the well of Henon and Heiles: order 2 S, and the energy where nodes are enough",
          "[energy_exact]") {
  const HenonHeilesSystem well;
  const auto row = [&](const char* name, double error, double slope, double energy) {
    check_row(well, name, 0.5, 20, henon_heiles_end, error, slope, energy);
  };
  row("avf", 8.582e-2, 2.01, 0);
  row("avf_4", 2.793e-3, 3.92, 0);
  row("hbvm_1_1", 7.946e-2, 2.00, 8.8e-4);
  row("hbvm_2_1", 8.582e-2, 2.01, 0);
  row("hbvm_2_2", 4.705e-4, 3.97, 5.4e-6);
  row("hbvm_3_2", 4.972e-4, 3.97, 0);
  row("hbvm_3_3", 1.931e-6, 5.96, 4e-8);
  row("hbvm_5_3", 2.083e-6, 5.97, 0);
}

TEST_CASE("the quartic chain is exact from 2 K >= 4 S on, and not before", "[energy_exact]") {
  const QuarticChain chain;
  const double energy = CanonicalMotion<QuarticChain, double>(chain).hamiltonian(
      0, Eigen::Map<const Vector<double>>(chain.start().data(), 12));
  const auto row = [&](const char* name, double error, double slope, double relative) {
    check_row(chain, name, 0.2, 20, chain_end, error, slope, relative * energy);
  };
  row("hbvm_1_1", 1.748e-2, 2.00, 4.6e-4);
  row("hbvm_2_1", 1.686e-2, 2.00, 0);
  row("hbvm_2_2", 2.391e-5, 3.99, 1.0e-6);
  row("hbvm_3_2", 2.433e-5, 3.99, 3.9e-10);
  row("hbvm_4_2", 2.433e-5, 3.99, 0);
}

TEST_CASE("a power of degree nu is exact from 2 K >= nu S on, and not before", "[energy_exact][claims]") {
  const auto change = [](int nu, const char* name) { return figures(Monomial{nu}, method(name), 50, 100, {}).energy; };
  CHECK(std::abs(std::log10(change(4, "hbvm_2_2") / 1.1e-4)) < 0.1);
  CHECK(std::abs(std::log10(change(4, "hbvm_3_2") / 4.7e-7)) < 0.1);
  CHECK(change(4, "hbvm_4_2") < 5e-15);
  CHECK(std::abs(std::log10(change(4, "hbvm_5_3") / 3.2e-11)) < 0.1);
  CHECK(change(4, "hbvm_6_3") < 5e-15);
  CHECK(std::abs(std::log10(change(6, "hbvm_5_2") / 4.1e-11)) < 0.1);
  CHECK(change(6, "hbvm_6_2") < 2e-14);
}

namespace {

/// How far the derivative M of one step from `start()` is from M^T J M = J, by differences in 113 bits.
template <class S> double symplectic_defect(const S& system, const char* name, double h) {
  CanonicalMotion<S, Quad> field(system);
  const ParticleSystem<Quad> s = initial_state(system).template as<Quad>();
  field.bind(s);
  Vector<Quad> start;
  field.gather(s, start);
  const Index n = start.size();
  const Quad apart = 1e-10;
  const auto moved = [&](Index j, const Quad& by) {
    Vector<Quad> y = start;
    y[j] += by;
    const auto stepper = make_method<Quad>(*method(name).info, {});
    stepper->bind(field);
    REQUIRE_FALSE(stepper->step(field, Quad(0), y, h).failure);
    return y;
  };
  Matrix<Quad> M(n, n), J = Matrix<Quad>::Zero(n, n);
  for (Index j = 0; j < n; ++j) M.col(j) = (moved(j, apart) - moved(j, -apart)) / (apart + apart);
  for (Index i = 0; i < n / 2; ++i) {
    J(i, n / 2 + i) = Quad(1);
    J(n / 2 + i, i) = Quad(-1);
  }
  const Matrix<Quad> off = M.transpose() * J * M - J;
  double worst = 0;
  for (Index k = 0; k < off.size(); ++k) worst = std::max(worst, std::abs(static_cast<double>(off.data()[k])));
  return worst;
}

}  // namespace

TEST_CASE("C22: the average vector field keeps the energy at any step, at orders 2 and 4, and is not symplectic",
          "[energy_exact][claims]") {
  const HenonHeilesSystem well;
  const auto slope = [&](const char* name) {
    const auto error = [&](double h) { return figures(well, method(name), 20, 20 / h, henon_heiles_end).error; };
    return std::log2(error(0.25) / error(0.125));
  };
  CHECK(std::abs(slope("avf") - 2) < 0.02);
  CHECK(std::abs(slope("avf_4") - 4) < 0.05);
  for (const double h : {0.1, 0.5, 1.0}) {
    CHECK(figures(well, method("avf"), 100 * h, 100, {}).energy < 5e-15);
    CHECK(figures(well, method("avf_4"), 100 * h, 100, {}).energy < 5e-15);
  }
  CHECK(symplectic_defect(well, "hbvm_1_1", 0.2) < 1e-18);  // the midpoint rule, by which the measure is measured
  CHECK(symplectic_defect(well, "avf", 0.2) > 1e-5);
  CHECK(symplectic_defect(well, "avf_4", 0.2) > 1e-7);
}

TEST_CASE("C23: the order of HBVM is 2 S, whatever the number of nodes", "[energy_exact][claims]") {
  const Monomial quartic{4};
  const std::vector<double> end = figures(quartic, method("hbvm_8_8"), 10, 400, {}).end;
  const auto slope = [&](const char* name) {
    return std::log2(figures(quartic, method(name), 10, 100, end).error /
                     figures(quartic, method(name), 10, 200, end).error);
  };
  CHECK(std::abs(slope("hbvm_4_2") - 4) < 0.05);
  CHECK(std::abs(slope("hbvm_16_2") - 4) < 0.05);
  CHECK(std::abs(slope("hbvm_6_3") - 6) < 0.1);
}

TEST_CASE("with as many nodes as coefficients it is Gauss's method, of particles and of variables", "[energy_exact]") {
  const NonseparableOscillator oscillator;
  for (const auto& [name, same] : {std::pair("hbvm_1_1", "implicit_midpoint"), std::pair("hbvm_2_2", "gauss_2"),
                                   std::pair("hbvm_3_3", "gauss_3"), std::pair("hbvm_8_8", "gauss_8")}) {
    CAPTURE(name);
    const MethodOptions options = methods::find(same)->adaptive ? MethodOptions{.adaptive = false} : MethodOptions{};
    const auto a = figures(oscillator, method(name), 2, 100, {}).end;
    const auto b = figures(oscillator, method(same, options), 2, 100, {}).end;
    CHECK(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) < 1e-12);
    const auto planets = [](const MethodChoice& choice) {
      Simulation run(test::outer_planets(), test::classical_over(Gravity{.G = test::outer_G}, choice), 20.0);
      REQUIRE(run.run(50).ok());
      return run.particles();
    };
    const ParticleSystem<double> here = planets(method(name)), there = planets(method(same, options));
    for (Index i = 0; i < here.size(); ++i) {
      CHECK(norm2(Vec3<double>(here.positions()[i] - there.positions()[i])) < 1e-25);
    }
  }
}

TEST_CASE("nodes are taken until rounding where H is not a polynomial", "[energy_exact]") {
  CHECK(figures(NonseparableOscillator{}, method("hbvm_3"), 10, 1000, {}).energy < 1e-12);
  const double period = 2 * std::numbers::pi;
  for (const auto& [name, steps] : {std::pair("avf", 200.0), std::pair("hbvm_2", 100.0), std::pair("hbvm_3", 60.0)}) {
    CAPTURE(name);
    CHECK(figures(Orbit{}, method(name), 3 * period, 3 * steps, {}).energy < 3e-14);
  }
  // With eight nodes always, long steps past the pericenter lose it.
  CHECK(figures(Orbit{}, method("hbvm_8_2"), 3 * period, 90, {}).energy > 1e-13);
  CHECK(figures(Orbit{}, method("hbvm_2"), 3 * period, 90, {}).energy < 3e-14);
}

TEST_CASE("line integrals keep several invariants, at the same order and not nearer", "[energy_exact]") {
  const double period = 2 * std::numbers::pi;
  const auto error = [&](const char* name, const LineInvariants& kept, double steps) {
    return figures(Orbit{}, method(name, kept), 3 * period, 3 * steps, {0.4, 0}).error;
  };
  struct Row {
    const char* name;
    double steps, alone, laplace, slope;
  };
  for (const Row& row : {Row{"avf", 200, 9.407e-3, 8.721e-3, 2.0}, Row{"hbvm_2", 100, 5.332e-7, 9.597e-5, 3.97},
                         Row{"hbvm_3", 60, 1.848e-6, 3.794e-6, 5.88}}) {
    CAPTURE(row.name);
    CHECK(std::abs(error(row.name, {}, row.steps) / row.alone - 1) < 0.05);
    const double coarse = error(row.name, laplace(), row.steps), fine = error(row.name, laplace(), 2 * row.steps);
    CHECK(std::abs(coarse / row.laplace - 1) < 0.05);
    CHECK(std::abs(std::log2(coarse / fine) - row.slope) < 0.1);
    const Figures kept = figures(Orbit{}, method(row.name, laplace()), 3 * period, 3 * row.steps, {});
    const Vector<double> end = Eigen::Map<const Vector<double>>(kept.end.data(), 4);
    CHECK(kept.energy < 3e-14);
    CHECK(std::abs(OrbitalMomentum()(Vector<double>(end.head(2)), Vector<double>(end.tail(2))) - 0.8) < 3e-14);
    CHECK(std::abs(Laplace{0}(Vector<double>(end.head(2)), Vector<double>(end.tail(2))) - 0.6) < 3e-14);
    CHECK(std::abs(Laplace{1}(Vector<double>(end.head(2)), Vector<double>(end.tail(2)))) < 3e-14);
  }
}

TEST_CASE("Laplace's vector stands where it is over 1e5 orbits", "[energy_exact][.nightly]") {
  Simulation run(initial_state(Orbit{}), classical(Orbit{}, method("hbvm_2", laplace())), 2 * std::numbers::pi / 60);
  REQUIRE(run.run(6'000'000).ok());
  const Vector<double> end = Eigen::Map<const Vector<double>>(run.particles().variables().data(), 4);
  const Vector<double> q = end.head(2), p = end.tail(2);
  CHECK(std::abs(std::atan2(Laplace{1}(q, p), Laplace{0}(q, p))) < 1e-11);
}

TEST_CASE("energy, momentum and angular momentum of planets are kept together by their names", "[energy_exact]") {
  const LineInvariants both{.invariants = {"energy", "angular_momentum"}};
  Simulation run(test::outer_planets(), test::classical_over(Gravity{.G = test::outer_G}, method("hbvm_2", both)),
                 100.0);
  CHECK(run.claims().energy_exact);
  CHECK(run.claims().keeps_angular_momentum);
  const Energy& energy = run.every(1, Energy());
  const AngularMomentum& spin = run.every(1, AngularMomentum());
  const Momentum& momentum = run.every(1, Momentum());
  REQUIRE(run.run(200).ok());
  CHECK(energy.worst() < 1e-14);
  CHECK(spin.worst() < 1e-14);
  CHECK(momentum.worst() < 1e-14);
  Simulation alone(test::outer_planets(), test::classical_over(Gravity{.G = test::outer_G}, method("hbvm_2")), 100.0);
  const AngularMomentum& lost = alone.every(1, AngularMomentum());
  CHECK_FALSE(alone.claims().keeps_angular_momentum);
  REQUIRE(alone.run(200).ok());
  CHECK(lost.worst() > 1e-12);
}

TEST_CASE("on stiff springs Newton's iteration solves for S n coefficients, whatever the number of nodes",
          "[energy_exact]") {
  const MethodOptions matrix_free{.jacobian = JacobianForm::matrix_free};
  const auto run = [&](const char* name, const MethodOptions& options) {
    Simulation sim(initial_state(Spring{1e4}), classical(Spring{1e4}, method(name, options)), 0.05);
    const Energy& energy = sim.every(1, Energy());
    const Outcome outcome = sim.run(100);
    INFO(outcome.message);
    REQUIRE(outcome.ok());
    CHECK(energy.worst() < 1e-12);
    CHECK(sim.evaluations().jacobian > 0);
    return sim.particles().variables();
  };
  const auto dense = run("hbvm_2", {}), free = run("hbvm_2", matrix_free);
  CHECK(std::abs(dense[0] - free[0]) < 1e-8);
  run("avf", {});
}

TEST_CASE("a step at h omega = 50 that has no solution near it ends the run with its name",
          "[energy_exact][extremes]") {
  for (const char* name : {"avf", "hbvm_2"}) {
    CAPTURE(name);
    Simulation run(initial_state(Spring{1e6}), classical(Spring{1e6}, method(name)), 0.05);
    const Outcome outcome = run.run(400);
    CHECK(outcome.kind == Outcome::Kind::solver_failure);
    CHECK(outcome.message.find("do not converge with a step of 0.05; give a shorter one") != std::string::npos);
    CHECK(run.step() == 0);
    CHECK(run.particles().variables() == Spring{}.start());
  }
}

TEST_CASE("what keeps no energy is refused in one line", "[energy_exact]") {
  const auto refusal = [](auto&& make) -> std::string {
    try {
      make();
    } catch (const SchemeMismatch& error) {
      return error.message();
    }
    return "";
  };
  const std::string remedy = "; use 'gauss_4' or another method for y' = f";
  CHECK(refusal([] { Simulation(initial_state(Lorenz{}), classical(Lorenz{}, method("avf")), 0.01); }) ==
        "method 'avf' keeps the energy, but system 'lorenz' has rates, and no energy that they keep" + remedy);
  CHECK(refusal([] {
          Simulation(test::outer_planets(),
                     test::classical_over(test::field_of(Gravity{.G = test::outer_G}, DragForce{{.rate = 1e-9}}),
                                          method("hbvm_4_2")),
                     20.0);
        }) == "method 'hbvm_4_2' keeps the energy, but a force of this run is dissipative" + remedy);
  CHECK(refusal([] {
          Simulation(initial_state(Orbit{}),
                     classical(Orbit{}, method("hbvm_2", LineInvariants{.invariants = {"angular_momentum"}})), 0.01);
        }) ==
        "method 'hbvm_2' cannot keep 'angular_momentum' of '', which names no invariants; expected one of: energy");
  CHECK_THROWS_WITH(method("hbvm_2_3"),
                    "method 'hbvm_2_3' has 2 nodes for 3 coefficients; at least as many nodes are "
                    "expected, as in 'hbvm_6_3'");
  CHECK_THROWS_WITH(method("hbvm_9"), "method 'hbvm_9' has 9 coefficients; up to 8 are possible, order 16");
  CHECK_THROWS_WITH(method("hbvm_65_2"), "method 'hbvm_65_2' has 65 nodes; up to 64 are possible, as in 'hbvm_64_2'");
  const std::vector<std::string> twice = {"energy", "energy"};
  CHECK_THROWS_WITH(test::classical_over(Gravity{}, method("hbvm_2", LineInvariants{.invariants = twice})),
                    "invariants = [\"energy\", \"energy\"] has energy twice; give it once");
}

namespace {

/// H = p^2 / (2 m) + cos q: q' and p' of sizes that have nothing to do with each other.
struct LightPendulum {
  double m = 1e-12;
  Index size() const { return 1; }
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    using std::cos;
    return p[0] * p[0] / Real(2 * m) - cos(q[0]);
  }
};

/// Of a body on a circle and a tracer, q = (x, x, y, y, z, z): what the tracer turns with.
struct TracersMomentum {
  template <class Real> Real operator()(const Vector<Real>& q, const Vector<Real>& v) const {
    return q[1] * v[3] - q[3] * v[1];
  }
};

}  // namespace

TEST_CASE("rates of coordinates and of momenta ask for nodes each by themselves", "[energy_exact]") {
  for (const char* name : {"avf", "avf_4", "hbvm_2", "hbvm_3"}) {
    CAPTURE(name);
    const LightPendulum light;  // a third of a turn to and fro in 8e-6
    Simulation run(initial_state(light, {2, 0}), classical(light, method(name)), 4e-7);
    const Energy& energy = run.every(1, Energy{});
    REQUIRE(run.run(200).ok());
    CHECK(energy.worst() < 1e-13);
  }
}

TEST_CASE("a program's own invariants stand beside the energy, those of tracers too", "[energy_exact]") {
  ParticleSystem<double> s;
  s.add("star", 1, {0, 0, 0}, {0, 0, 0});
  s.add("tracer", 0, {1, 0, 0}, {0, 1.2, 0});
  const auto momentum = [](const ParticleSystem<double>& of) {
    const Vec3<double> x = of.positions()[1], v = of.velocities()[1];
    return x[0] * v[1] - x[1] * v[0];
  };
  const MethodOptions own{.own = LineInvariants{.own = {invariant("L", TracersMomentum{})}}};
  Simulation run(s, test::classical_over(Gravity{.G = 1}, method("hbvm_2", own)), 0.2);
  REQUIRE(run.run(100).ok());
  CHECK(std::abs(momentum(run.particles()) / 1.2 - 1) < 1e-13);
  // The energy of a pair of masses, too.
  ParticleSystem<double> pair;
  pair.add("a", 0.5, {0.5, 0, 0}, {0, 0.6, 0});
  pair.add("b", 0.5, {-0.5, 0, 0}, {0, -0.6, 0});
  Simulation both(pair, test::classical_over(Gravity{.G = 1}, method("hbvm_2", own)), 0.2);
  const Energy& energy = both.every(1, Energy{});
  REQUIRE(both.run(100).ok());
  CHECK(energy.worst() < 1e-13);
  CHECK(both.claims().energy_exact);
}
